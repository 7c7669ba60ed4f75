//! A truth in the making: chunks of an estimate, added in their order until the goal is met.

use rayon::prelude::*;
use std::ops::ControlFlow;

use super::{
    direct::{Direct, direct, judged},
    estimate::{BANDS, CHUNKS, Cells, Counts, Estimate, Estimator, Judged, PARTS},
    eye::Eye,
    light::Photons,
    trace::Space,
};
use crate::{
    image::{ImageError, Layers, Provenance},
    metrics::bare_irradiance,
    scene::{Camera, PathClass, Scene},
    store::Key,
};

/// Raised whenever the same task would give other numbers.
pub const VERSION: u32 = 3;

/// ε of the judged figure: (this share of E₀)².
const EPSILON: f64 = 0.1;
/// Photons of a chunk, at least and at most.
const PER_CHUNK: [u64; 2] = [1 << 10, 1 << 17];

/// What decides every bit of a truth.
#[derive(Clone, Debug)]
pub struct Task {
    /// By which of the two ways.
    pub estimator: Estimator,
    /// Which light paths are its caustic.
    pub paths: PathClass,
    /// Name of the scene's camera.
    pub camera: String,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Of everything random.
    pub seed: u64,
    /// When it is finished.
    pub goal: Goal,
}

/// When a truth is finished: by whichever comes first.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// This many photons, rounded up to whole chunks; of cells, a grid of so many.
    pub photons: Option<u64>,
    /// An estimated noise, as relMSE, of at most this; of cells, a change by the last doubling.
    pub noise: Option<f64>,
}

impl Task {
    /// Photons of a chunk: some [`CHUNKS`] of them, within bounds, so that few photons too have a noise to estimate.
    fn per_chunk(&self) -> u64 {
        (self.goal.photons.unwrap_or(u64::MAX) / (2 * CHUNKS)).clamp(PER_CHUNK[0], PER_CHUNK[1])
    }

    /// What the sums of this task are found by, however far they are: another noise asked for leaves them as they are.
    pub fn sums_key(&self, scene: &Scene) -> Key {
        let goal = Goal { noise: None, ..self.goal };
        Task { goal, ..self.clone() }.key(scene)
    }

    /// What a finished truth of this task is found by.
    pub fn key(&self, scene: &Scene) -> Key {
        let Self { estimator, paths, camera, size, seed, goal } = self;
        let scene = &scene.source.hash;
        Key::of([format!("{VERSION} {scene} {estimator} {paths} {camera} {size:?} {seed} {goal:?}")])
    }
}

/// Where a run stands.
#[derive(Clone, Copy, Debug)]
pub struct Standing {
    /// Photons so far; of cells, those of all grids.
    pub photons: u64,
    /// Estimated relMSE of a perfect image against the caustic so far; infinite while it is not known.
    pub noise: f64,
    /// How many more photons it will take, as far as can be told.
    pub missing: f64,
    /// The goal is met.
    pub finished: bool,
}

/// A truth in the making.
pub struct Run<'a> {
    task: &'a Task,
    size: [usize; 2],
    space: &'a Space<'a>,
    direct: Direct,
    caustic: Box<dyn Estimate + 'a>,
    e0: f64,
}

impl<'a> Run<'a> {
    /// Computes direct light, and sets up the estimate.
    pub fn new(space: &'a Space<'a>, camera: &Camera, task: &'a Task) -> Self {
        let run = Self::watched(space, camera, task, &mut |_| ControlFlow::Continue(()));
        run.expect("what nobody breaks off comes to its end")
    }

    /// As [`Self::new`]; `watch` is told the share of direct light that is done, and may break off: then `None`.
    pub fn watched(
        space: &'a Space<'a>,
        camera: &Camera,
        task: &'a Task,
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Option<Self> {
        let eye = Eye::new(camera, task.size);
        let direct = direct(space, &eye, task.seed, watch)?;
        let e0 = bare_irradiance(space.scene);
        let judged = Judged { pixels: judged(space, &eye, &direct.mask), epsilon: (EPSILON * e0).powi(2) };
        let caustic: Box<dyn Estimate + 'a> = match task.estimator {
            Estimator::Photons => {
                let photons = Photons::new(space, task.paths, task.seed, task.per_chunk() / PARTS);
                Box::new(Counts::new(space, eye, photons, judged))
            }
            Estimator::Cells => Box::new(Cells::new(space, eye, task.paths, &task.goal, judged)),
        };
        let size = task.size.map(|n| n as usize);
        Some(Self { task, size, space, direct, caustic, e0 })
    }

    /// Adds chunks, a group of `width` at a time on all cores, until the goal is met or `watch` breaks off.
    /// `watch` is told after every group. The result does not depend on `width`.
    pub fn advance(&mut self, width: usize, mut watch: impl FnMut(&Self, Standing) -> ControlFlow<()>) -> Standing {
        let mut standing = self.standing();
        while !standing.finished {
            let first = self.caustic.chunks();
            let chunks = first..first + width.max(1) as u64;
            let group: Vec<_> = chunks.into_par_iter().map(|k| self.caustic.chunk(k)).collect();
            for chunk in &group {
                self.caustic.add(chunk);
                // Looked at where it may have been met, and not more often: a look goes over all pixels.
                if self.caustic.may_be_finished(&self.task.goal) && self.standing().finished {
                    break;
                }
            }
            standing = self.standing();
            if watch(self, standing).is_break() {
                break;
            }
        }
        standing
    }

    /// Where it stands.
    pub fn standing(&self) -> Standing {
        self.caustic.standing(&self.task.goal)
    }

    /// Chunks so far.
    pub fn chunks(&self) -> u64 {
        self.caustic.chunks()
    }

    /// The sums so far, to go on from.
    pub fn checkpoint(&self) -> Vec<u8> {
        self.caustic.to_bytes()
    }

    /// Goes on from a checkpoint of the same task; false, and nothing changes, if the bytes are of another size.
    pub fn resume(&mut self, bytes: &[u8]) -> bool {
        self.caustic.resume(bytes)
    }

    /// The layers: both irradiances with the variances of their pixels, and the mask.
    ///
    /// # Errors
    /// [`ImageError`] without pixels.
    pub fn layers(&self) -> Result<Layers, ImageError> {
        let mut layers = Layers::new(self.size[0], self.size[1]);
        let narrow = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(|x| x as f32).collect::<Vec<_>>();
        // Finished before the first photon: there can be none.
        if !self.standing().finished || self.standing().photons > 0 {
            layers.push("irradiance.caustic", BANDS, narrow(&mut self.caustic.mean().into_iter()))?;
            layers.push("irradiance.caustic.variance", BANDS, narrow(&mut self.caustic.variance().into_iter()))?;
        }
        layers.push("irradiance.direct", BANDS, narrow(&mut self.direct.sums.mean()))?;
        layers.push("irradiance.direct.variance", BANDS, narrow(&mut self.direct.sums.variance()))?;
        layers.push("mask", 1, narrow(&mut self.direct.mask.iter().copied()))?;
        Ok(layers)
    }

    /// What the file says of itself: nothing in it differs between two runs of one task.
    pub fn provenance(&self) -> Provenance {
        let (scene, task, standing) = (self.space.scene, self.task, self.standing());
        let size = format!("{}x{}", task.size[0], task.size[1]);
        let entries = [
            ("kind", "truth".to_owned()),
            ("truth.version", VERSION.to_string()),
            ("scene.name", scene.name.clone()),
            ("scene.hash", scene.source.hash.clone()),
            ("scene.resolved", scene.source.resolved.clone()),
            ("time_s", scene.time.to_string()),
            ("estimator", task.estimator.to_string()),
            ("paths", task.paths.to_string()),
            ("camera", task.camera.clone()),
            ("size", size),
            ("seed", task.seed.to_string()),
            ("photons", standing.photons.to_string()),
            ("chunks", self.caustic.chunks().to_string()),
            ("noise.relmse", format!("{:e}", standing.noise)),
            ("e0", format!("{:e}", self.e0)),
            ("finished", standing.finished.to_string()),
        ];
        entries.into_iter().chain(self.caustic.about()).map(|(name, text)| (name.to_owned(), text)).collect()
    }
}
