//! Photons for a method that takes them: every view in turn fills the photon buffer, and the method makes of it what it
//! does. One that takes none has none of this.

use super::{
    Bench, Blocks, Column, Emission, Photons, Tracer, Tracing, emissions, paths, photon_buffer, photons, sides,
    view_name,
};
use crate::{
    gpu::{BufferId, Phase, Resource},
    passes::{PlanError, Work, account::account},
    scene::Scene,
};

/// What a method plans with that takes photons.
pub struct Job<'a> {
    /// The plan being made, scene and picture.
    pub work: Work<'a>,
    /// The emission views, in the order in which they come.
    pub emissions: &'a [Emission],
    /// The photon buffer, filled anew for each view: the one of most photons, and in [`Taker::gather`] the view's own.
    pub photons: &'a Photons,
    /// What light is traced with, for a method that traces more of it.
    pub bench: &'a Bench<'a>,
    /// The tracer that fills the photon buffer.
    pub tracer: &'a Tracer,
    /// Where photons are not one a slot of the photon buffer.
    pub blocks: Option<&'a Blocks>,
}

/// A method that takes photons, being planned.
pub trait Taker {
    /// Which photons it takes: a file that defines `captured`, and what it reads.
    fn capture(&self) -> (&'static str, Vec<(&'static str, Resource)>);

    /// How it measures where photons land; asked of one that wants them in blocks.
    fn measure(&self) -> Measure {
        Measure::default()
    }

    /// Takes the photons of one view, which lie in the photon buffer after the pass before.
    fn gather(&mut self, job: &mut Job<'_>, view: usize, name_of: &dyn Fn(&str) -> String);
}

/// What `glsl/light/blocks.comp` asks of a method.
#[derive(Default)]
pub struct Measure {
    /// A file that defines `measured`.
    pub file: &'static str,
    /// What it reads.
    pub reads: Vec<(&'static str, Resource)>,
    /// Texels a side of what it measures in.
    pub side: f32,
    /// Texels that photons may lie apart, and those where light breaks.
    pub apart: [f32; 2],
}

/// The photons that a method asks for.
pub struct Wanted {
    /// The columns that it reads.
    pub columns: Vec<Column>,
    /// Whether it wants them all in float16.
    pub halves: bool,
    /// log2 of the side of blocks, each with photons as dense as it needs; 0: one photon a slot.
    pub blocks: u32,
}

/// Photons that are shot in every frame.
#[derive(Clone, Debug, Default)]
pub struct Shots {
    /// Buffers of their account.
    pub accounts: Vec<BufferId>,
    /// Bytes a photon.
    pub bytes_each: u64,
}

/// What became of the photons.
pub enum Shot<T> {
    /// They are shot, and taken by this.
    Taken(T, Shots),
    /// The scene cannot show a caustic: why. Nothing was planned.
    Nothing(&'static str),
}

/// The passes that photons are shot, traced, taken and accounted for by: `begin` makes images and buffers that all views
/// share.
pub fn shoot<T: Taker>(
    work: &mut Work<'_>,
    wanted: &Wanted,
    begin: impl FnOnce(&mut Job<'_>) -> Result<T, PlanError>,
) -> Result<Shot<T>, PlanError> {
    let Work { scene, settings, arrays, buffers, .. } = *work;
    let emissions = emissions(scene, settings, &work.receivers[0].patch)?;
    if let Some(reason) = nothing(scene, &emissions) {
        return Ok(Shot::Nothing(reason));
    }
    let class = paths(scene, settings);
    let plan = &mut *work.plan;
    let half = wanted.halves.then(|| emissions.iter().map(Emission::most).fold(0.0, f64::max));
    let all = photon_buffer(plan, settings, class, &wanted.columns, half, &sides(&emissions));
    let views: Vec<_> = emissions.iter().map(|e| e.view.data()).collect();
    let views = plan.upload("light/views", &views);
    let bench = Bench { scene, arrays, buffers, settings, class, emissions: &emissions, views, base: "light" };
    let tracer = Tracer::plan(plan, &bench)?;
    let blocks = match wanted.blocks {
        0 => None,
        levels => Some(Blocks::plan(plan, settings, &emissions, all[0].layers, levels)?),
    };
    let blocks = blocks.as_ref();
    let work = Work { plan, ..*work };
    let mut job = Job { work, emissions: &emissions, photons: &all[0], bench: &bench, tracer: &tracer, blocks };
    let mut taker = begin(&mut job)?;
    let mut accounts = Vec::new();
    for (index, emission) in emissions.iter().enumerate() {
        let name_of = |base: &str| view_name(base, scene, &emissions, index);
        let own = all.iter().find(|photons| photons.side == emission.side).unwrap_or(&all[0]);
        job.photons = own;
        let tracing = Tracing { scene: buffers, views, tracer: &tracer, class, photons: own, emission, index, blocks };
        tracer.images(job.work.plan, &bench, Phase::Frame, index);
        match blocks {
            Some(blocks) => blocks.photons(job.work.plan, &tracing, &taker, &name_of),
            None => photons(job.work.plan, &name_of("light/photons"), &tracing),
        }
        taker.gather(&mut job, index, &name_of);
        tracer.images(job.work.plan, &bench, Phase::Account, index);
        accounts.push(account(job.work.plan, &name_of("light/account"), &tracing, &taker.capture()));
    }
    Ok(Shot::Taken(taker, Shots { accounts, bytes_each: all[0].bytes_each() }))
}

/// Why no photon can come.
fn nothing(scene: &Scene, emissions: &[Emission]) -> Option<&'static str> {
    match () {
        () if scene.lights.is_empty() => Some("there is no light"),
        () if !scene.has_specular() => Some("nothing in the scene is specular"),
        () if emissions.is_empty() => Some("no light with any power reaches a specular object that has a surface"),
        () => None,
    }
}
