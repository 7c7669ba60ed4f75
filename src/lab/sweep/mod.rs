//! A sweep: scenes × methods × settings, every point rendered, timed and held against its truth, and kept by content.
//!
//! What is kept under a point's key is never stale: the key is of everything that the point was made from, its scene as
//! resolved, the settings in force, the device, the reference, the shaders that its plan compiles, and this program: its
//! version, its compiler, its dependencies and a hash of its sources, but for those that only show (`scripts/build.rs`
//! lists them). A commit that touches none of these leaves every point as it is.
//! Each point is an entry of its own, replaced whole: a process may be killed at any moment, and shards share nothing
//! but the store and the locks of their host.

mod file;
mod host;
mod line;
mod merge;
mod point;
mod status;

use std::{collections::BTreeSet, io, path::PathBuf, sync::Arc};

use super::{LabError, Picture, Sequence, provenance::in_force, render_report::method_name};
use crate::{
    gpu::{Gpu, Sources},
    places::Folder,
    renderer::{self, Job, Planned, RenderError},
    scene::SceneError,
    store::{Key, Store},
    truth,
};

pub use host::Host;
pub use line::SCHEMA;
pub use merge::{Merged, merge};
pub use status::{State, Status};

/// What points are kept as in the store.
pub const POINTS: &str = "point";

/// What ends a sweep; a point that fails does not.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// What is written is wrong.
    #[error(transparent)]
    Written(#[from] SceneError),
    /// The store does not take a point, or cannot be written at all.
    #[error("cannot write to the store {}: {reason}; free or choose another by NEPHROID_CACHE", path.display())]
    Store {
        /// Its folder or the point's file.
        path: PathBuf,
        /// The system's.
        reason: io::Error,
    },
    /// No environment variable says where the store may be.
    #[error("there is no place for the store: set NEPHROID_CACHE to a folder")]
    NoStore,
    /// Stopped, or the host's locks cannot be had.
    #[error(transparent)]
    Lab(#[from] LabError),
}

/// What points are judged by.
#[derive(Clone)]
pub enum Reference {
    /// The truth from the store, or made.
    Auto,
    /// Nothing: times alone.
    None,
    /// A file.
    File {
        /// Its layers.
        picture: Arc<Picture>,
        /// Of its bytes.
        hash: String,
    },
}

/// One point as the sweep asks for it.
pub struct Spec {
    /// `none` for direct light alone.
    method: String,
    /// The keys of `[set]`, with this point's values.
    set: Vec<(String, String)>,
    job: Job,
    reference: Reference,
}

/// A sweep that has been read and checked.
pub struct Sweep {
    /// The stem of its file.
    pub name: String,
    /// As it was named.
    pub file: String,
    /// Points that are the same as one before, and are done with it.
    pub repeated: usize,
    points: Vec<Spec>,
    rounds: u32,
    layer: String,
    /// s
    seconds: f64,
    /// Frames whose flicker is measured.
    flicker: Option<Sequence>,
}

/// Which points of a sweep: those whose index, modulo `of`, is `index`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 0.
    pub index: usize,
    /// How many there are.
    pub of: usize,
}

impl Shard {
    /// Everything.
    pub const WHOLE: Self = Self { index: 0, of: 1 };

    /// Of so many points, its own.
    pub fn points(self, count: usize) -> impl Iterator<Item = usize> {
        (self.index..count).step_by(self.of)
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    /// `i/n`, from `1/n` to `n/n`.
    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || "expected I/N such as 1/4: the I-th of N shards, I from 1 to N".to_owned();
        let (index, of) = text.split_once('/').ok_or_else(expected)?;
        let number = |text: &str| text.parse::<u32>().ok().filter(|n| *n > 0).ok_or_else(expected);
        let (index, of) = (number(index)? as usize, number(of)? as usize);
        if index > of { Err(expected()) } else { Ok(Self { index: index - 1, of }) }
    }
}

impl Sweep {
    /// Reads a sweep file.
    ///
    /// # Errors
    /// [`SceneError`] at the file, line and key that are wrong, before anything is rendered.
    pub fn load(file: &str) -> Result<Self, SceneError> {
        file::load(file)
    }

    fn new(name: String, file: &str, mut points: Vec<Spec>, (rounds, layer, seconds): (u32, String, f64)) -> Self {
        let (all, mut seen) = (points.len(), BTreeSet::new());
        points.retain(|spec| seen.insert(spec.content()));
        let repeated = all - points.len();
        Self { name, file: file.to_owned(), repeated, points, rounds, layer, seconds, flicker: None }
    }

    /// Points that differ.
    pub fn count(&self) -> usize {
        self.points.len()
    }

    /// Point number `at` in words: scene, method and what it sets.
    pub fn words(&self, at: usize) -> String {
        let spec = &self.points[at];
        let set = spec.set.iter().map(|(key, value)| format!(" {key}={value}")).collect::<String>();
        format!("{} {}{set}", spec.job.scene.name, spec.method)
    }
}

impl Spec {
    /// What is rendered, and judged by what, whoever does it with which shaders.
    fn content(&self) -> String {
        let job = &self.job;
        let settings = serde_json::Value::Object(in_force(job)).to_string();
        let reference = match &self.reference {
            Reference::Auto => format!("auto {}", truth::VERSION),
            Reference::None => "none".to_owned(),
            Reference::File { hash, .. } => hash.clone(),
        };
        let (scene, method) = (&job.scene.source.hash, method_name(&job.providers));
        format!("{scene} {method} {settings} {} {:?} {reference}", job.camera, job.size)
    }
}

/// What a sweep is run with.
pub struct Bench<'a> {
    /// The sweep.
    pub sweep: &'a Sweep,
    /// The device.
    pub gpu: &'a Gpu,
    /// The shaders.
    pub sources: Sources,
    /// Where points are, and truths.
    pub store: Store,
}

impl Bench<'_> {
    /// A point's plan, or why there is none, and the key that the point is kept under.
    fn plan(&self, spec: &Spec) -> (Key, Result<Planned, RenderError>) {
        let planned = renderer::plan(&spec.job);
        let shaders = match &planned {
            Ok(planned) => self.sources.plan_key(&planned.plan).to_string(),
            Err(error) => error.to_string(),
        };
        let (device, sweep) = (self.gpu.info(), self.sweep);
        let timed = format!("{} {} {} {:?}", sweep.rounds, sweep.layer, sweep.seconds, sweep.flicker);
        let program = [SCHEMA, env!("CARGO_PKG_VERSION"), env!("NEPHROID_CODE"), env!("NEPHROID_RUSTC")];
        let about = [&spec.content(), &timed, &device.name, &device.driver, &device.api, &shaders];
        (Key::of(program.into_iter().chain(about.map(String::as_str))), planned)
    }
}

/// The store that points are kept in: the first place of all, and no other. Shards that silently wrote to different
/// places would never meet.
///
/// # Errors
/// [`SweepError::NoStore`].
pub fn store() -> Result<Store, SweepError> {
    let folder = Folder::Cache.candidates().into_iter().next().ok_or(SweepError::NoStore)?;
    Ok(Store::at(folder))
}

#[cfg(test)]
mod tests {
    use super::Shard;

    #[test]
    fn shards_part_all_points() {
        let shards: Vec<Shard> = ["1/3", "2/3", "3/3"].map(|text| text.parse().unwrap()).to_vec();
        let mut dealt: Vec<usize> = shards.iter().flat_map(|shard| shard.points(8)).collect();
        dealt.sort_unstable();
        assert_eq!(dealt, (0..8).collect::<Vec<_>>());
        for bad in ["", "1", "0/3", "4/3", "1/0", "-1/3", "1/3/5", "a/b", "1 / 3", "1/99999999999"] {
            assert!(bad.parse::<Shard>().unwrap_err().contains("1/4"), "{bad}");
        }
    }
}
