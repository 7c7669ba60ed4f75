//! Where a method's error comes from: a chain of pictures of which neighbours differ in one thing.
//!
//! Truth of all paths → truth of the class of paths that is traced → the tracer's landing points on a fine grid of light
//! samples, binned exactly → what the method makes of that grid → the picture as it comes. In the other order the
//! noise of binning and its removal by the splat would cancel, and neither step would mean anything. The steps sum to
//! the picture's whole difference from the truth.

mod landings;
mod report;
mod step;
mod truths;

use std::ops::ControlFlow;

use super::{
    LabError,
    picture::{Picture, REGION},
    reference::CAUSTIC,
};
use crate::{
    gpu::Gpu,
    methods::{Link, Method, Shown},
    metrics::{Fitted, bare_irradiance},
    passes::{
        PlanError,
        light::{self, SIDE},
    },
    renderer::{self, Frame, Job, Renderer},
    scene::PathClass,
    settings::SettingError,
    store::Store,
    truth::{Estimator, Goal, Standing, Task},
};

pub use report::{BudgetReport, write_budget};
use step::Shot;
pub use step::Step;

/// How a budget is made.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Light samples along each side of the fine grid.
    pub fine: u32,
    /// What is taken for all paths.
    pub all: PathClass,
    /// When a truth is done.
    pub goal: Goal,
    /// The most time for each truth, s.
    pub seconds: f64,
    /// Of the truths' photons.
    pub seed: u64,
}

/// Where a budget is.
pub enum Progress<'a> {
    /// A picture of the chain is begun.
    Begun(&'a str),
    /// A truth is being made; how far it is, once that is known.
    Truth(Option<Standing>),
}

type Watch<'w> = &'w mut dyn FnMut(&Progress) -> ControlFlow<()>;

/// The pictures of a chain and the steps between them.
pub struct Chain {
    /// Width and height of each picture.
    pub size: [usize; 2],
    /// The pictures, as the method declares them.
    pub shots: Vec<Shot>,
    /// From each picture to the next.
    pub steps: Vec<Step>,
    /// From the first picture to the last.
    pub whole: Step,
    /// Which pixels are judged: of the others, part is hidden by what stands on the region.
    pub judged: Vec<bool>,
    /// W/m²
    pub e0: f64,
    /// Of a picture that is right only up to a scale: the best one, against the first picture.
    pub fitted: Option<Fitted>,
}

impl Budget {
    /// Makes the chain of a method on the job's scene and settings, of pictures of the region. What the job says of
    /// providers and camera does not count.
    ///
    /// # Errors
    /// Those of planning and rendering, at `light.side` as asked and at `fine`; [`LabError::Interrupted`] when `watch`
    /// breaks off, and the truths made so far are kept.
    pub fn chain(
        &self,
        gpu: &Gpu,
        job: &Job,
        method: &'static dyn Method,
        store: &Store,
        watch: Watch,
    ) -> Result<Chain, LabError> {
        let mut job = Job { camera: REGION.to_owned(), ..job.clone() };
        job.providers = renderer::Providers::of(method);
        let mut fine = job.clone();
        fine.settings.set(&renderer::all_settings(), SIDE.key, &self.fine.to_string()).map_err(unfit)?;
        let (mut shots, mut judged) = (Vec::new(), vec![true; job.size[0] as usize * job.size[1] as usize]);
        let class = light::paths(&job.scene, &job.settings);
        for link in method.chain() {
            let named = title(link, self.all, class, self.sides(&job));
            if watch(&Progress::Begun(&named)).is_break() {
                return Err(LabError::Interrupted);
            }
            let picture = match link.shown {
                Shown::AllPaths => self.truth(&job, self.all, store, watch)?,
                Shown::PathClass => self.truth(&job, class, store, watch)?,
                device => {
                    let job = if device == Shown::AsAsked { &job } else { &fine };
                    if device == Shown::Landings {
                        shots.push(Shot::bare(link, landings::landings(gpu, job)?));
                        continue;
                    }
                    rendered(gpu, job)?
                }
            };
            judged.iter_mut().zip(picture.unmasked()?).for_each(|(kept, unmasked)| *kept &= unmasked);
            shots.push(Shot::of(link, &picture)?);
        }
        let chain = Chain::new(job.size.map(|n| n as usize), shots, judged, bare_irradiance(&job.scene));
        Ok(if job.providers.is_relative(&job.settings) { chain.fit() } else { chain })
    }

    /// Light samples along each side of the fine grid, and as asked; none where no photons are shot.
    fn sides(&self, job: &Job) -> Option<[u32; 2]> {
        job.providers.shoot().then(|| [self.fine, job.settings.whole(&SIDE)])
    }

    fn truth(&self, job: &Job, paths: PathClass, store: &Store, watch: Watch) -> Result<Picture, LabError> {
        let (camera, size) = (REGION.to_owned(), job.size);
        let task = Task { estimator: Estimator::Photons, paths, camera, size, seed: self.seed, goal: self.goal };
        truths::truth(&job.scene, &task, store, self.seconds, watch)
    }
}

/// A fine grid beyond what `light.side` may be.
fn unfit(error: SettingError) -> LabError {
    let (what, remedy) = ("the fine grid of light samples".to_owned(), "ask for another --fine".to_owned());
    renderer::RenderError::from(PlanError::Refused { what, reason: error.to_string(), remedy }).into()
}

/// The method's picture, once: nothing is timed.
fn rendered(gpu: &Gpu, job: &Job) -> Result<Picture, LabError> {
    let mut renderer = Renderer::new(gpu, job)?;
    renderer.frame(&Frame { time: job.scene.time, ..Frame::default() })?;
    let layers = renderer.layers()?;
    Ok(Picture { file: job.scene.name.clone(), layers, about: Default::default() })
}

/// What a picture of the chain is called.
pub(super) fn title(link: &Link, all: PathClass, class: PathClass, sides: Option<[u32; 2]>) -> String {
    let [fine, side] = sides.unwrap_or_default();
    match link.shown {
        Shown::AsAsked if sides.is_none() => "the picture".to_owned(),
        Shown::AllPaths => format!("truth of all paths ({all})"),
        Shown::PathClass => format!("truth of {class}"),
        Shown::Landings => format!("landings of {fine}² light samples, binned"),
        Shown::Fine => format!("reconstruction of {fine}²"),
        Shown::AsAsked => format!("the picture, of {side}²"),
    }
}
