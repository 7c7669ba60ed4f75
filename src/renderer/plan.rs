//! From a job to a plan: which passes the scene needs, and which it does not.

use std::time::Instant;

use super::{Job, RenderError};
use crate::{
    gpu::{BufferId, ImageId, Lifetime, Plan},
    methods::{self, Method, Provided, Slot},
    passes::{
        PlanError, Work,
        accel::{SceneArrays, Trees},
        extents,
        eye::{self, EyeLayers, FrameData},
        lamps::Lamps,
        light,
        scene::SceneBuffers,
    },
    settings::Settings,
};

/// Who fills each slot; nobody, if the frame shows direct light alone.
#[derive(Clone, Copy, Default)]
pub struct Providers {
    /// The slot `surface`.
    pub surface: Option<&'static dyn Method>,
    /// The slot `medium`.
    pub medium: Option<&'static dyn Method>,
}

impl Providers {
    /// One method for every slot it fills.
    pub fn of(method: &'static dyn Method) -> Self {
        let fills = |slot| method.slots().contains(&slot).then_some(method);
        Self { surface: fills(Slot::Surface), medium: fills(Slot::Medium) }
    }

    /// Whether photons are shot, where the scene can show what they make.
    pub fn shoot(&self) -> bool {
        self.methods().iter().any(|method| method.shoots())
    }

    /// Whether the slot `surface` is irradiance only up to a scale.
    pub fn is_relative(&self, settings: &Settings) -> bool {
        self.surface.is_some_and(|method| method.is_relative(settings))
    }

    /// The distinct methods.
    pub fn methods(&self) -> Vec<&'static dyn Method> {
        let mut all: Vec<&'static dyn Method> = Vec::new();
        for method in [self.surface, self.medium].into_iter().flatten() {
            if !all.iter().any(|m| m.name() == method.name()) {
                all.push(method);
            }
        }
        all
    }
}

/// A plan and what its client needs to know of it.
pub struct Planned {
    /// The plan.
    pub plan: Plan,
    /// The buffer written every frame.
    pub frame: BufferId,
    /// The picture's layers.
    pub layers: EyeLayers,
    /// Buffers of the photon account.
    pub accounts: Vec<BufferId>,
    /// Images that hold deposited flux.
    pub deposits: Vec<ImageId>,
    /// What the method counts itself.
    pub tally: Option<methods::Tally>,
    /// What the method leaves out.
    pub left_out: Option<methods::LeftOut>,
    /// Bytes a photon; 0 without photons.
    pub photon_bytes: u64,
    /// What planning took on the host, trees included, ms.
    pub plan_ms: f64,
    /// For another time.
    pub(super) trees: Trees,
}

/// Plans a frame. Needs no device.
pub fn plan(job: &Job) -> Result<Planned, RenderError> {
    let mut trees = Trees::default();
    let planned = plan_with(job, &mut trees)?;
    Ok(Planned { trees, ..planned })
}

/// As [`plan`], with the trees of the same scene at another time.
pub(super) fn plan_with(job: &Job, trees: &mut Trees) -> Result<Planned, RenderError> {
    let start = Instant::now();
    let camera = job.camera()?;
    let (scene, settings) = (&*job.scene, &job.settings);
    let mut arrays = SceneArrays::build_with(scene, trees).map_err(PlanError::from)?;
    let samples = job.eye_samples();
    let seen = [eye::light_samples(settings, samples * samples), samples * samples];
    let lamps = Lamps::of(scene, &arrays, settings.whole(&light::AREA_SAMPLES), seen)?;
    arrays.lights.clone_from(&lamps.all);
    let everything = extents::everything(scene);
    let mut plan = Plan { moves: scene.moves(), ..Plan::default() };
    let buffers = SceneBuffers::upload(&mut plan, scene, &arrays);
    let frame = plan.buffer("frame", size_of::<FrameData>() as u64, Lifetime::Frame);
    let mut work = Work {
        plan: &mut plan,
        settings,
        scene,
        arrays: &arrays,
        buffers: &buffers,
        frame,
        camera,
        receivers: &extents::receivers(scene, &job.camera),
        seen: &extents::receiving(scene, &job.camera),
        size: job.size,
        samples,
        everything: &everything,
    };
    let provided = method_passes(&job.providers, &mut work)?;
    let layers = eye::passes(&mut work, &lamps, provided.surface.as_ref());
    Ok(Planned {
        plan,
        frame,
        layers,
        accounts: provided.photons.accounts,
        tally: provided.tally,
        left_out: provided.left_out,
        deposits: provided.deposits,
        photon_bytes: provided.photons.bytes_each,
        plan_ms: start.elapsed().as_secs_f64() * 1e3,
        trees: Trees::default(),
    })
}

/// The passes of the method that fills the slot `surface`; none, with the reason, where there is no such method or the
/// scene cannot show what it makes.
fn method_passes(providers: &Providers, work: &mut Work<'_>) -> Result<Provided, PlanError> {
    if let Some(method) = providers.medium.filter(|m| !m.slots().contains(&Slot::Medium)) {
        return Err(PlanError::Refused {
            what: format!("--medium {}", method.name()),
            reason: "it does not fill the slot medium".into(),
            remedy: "media are not built yet".into(),
        });
    }
    let (stages, reason) = match providers.surface {
        None => ([].as_slice(), "no method was asked for"),
        Some(method) => match method.plan(work)? {
            methods::Planned::Provided(provided) => return Ok(provided),
            methods::Planned::LeftOut(reason) => (method.stages(), reason),
        },
    };
    stages.iter().chain(&["eye/surface"]).for_each(|name| work.plan.leave_out(name, reason));
    Ok(Provided::default())
}
