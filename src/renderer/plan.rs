//! From a job to a plan: which passes the scene needs, and which it does not.

use std::time::Instant;

use super::{Job, RenderError};
use crate::{
    gpu::{BufferId, ImageId, Lifetime, Phase, Plan},
    methods::{self, Method, Slot},
    passes::{
        PlanError,
        accel::{SceneArrays, Trees},
        account, extents,
        eye::{self, EyeLayers, EyeScene, FrameData},
        lamps::Lamps,
        light,
        scene::SceneBuffers,
    },
    view::Extent,
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
    let photons = photon_passes(&mut plan, job, (&arrays, &buffers), &everything)?;
    let from =
        EyeScene { scene, arrays: &arrays, buffers: &buffers, lamps: &lamps, frame, camera, size: job.size, samples };
    let provided = photons.provided.as_ref().and_then(|p| p.surface.as_ref());
    let layers = eye::passes(&mut plan, &from, settings, provided);
    Ok(Planned {
        plan,
        frame,
        layers,
        accounts: photons.accounts,
        tally: photons.provided.as_ref().and_then(|p| p.tally),
        deposits: photons.provided.map(|p| p.deposits).unwrap_or_default(),
        photon_bytes: photons.bytes_each,
        plan_ms: start.elapsed().as_secs_f64() * 1e3,
        trees: Trees::default(),
    })
}

#[derive(Default)]
struct PhotonPasses {
    provided: Option<methods::Provided>,
    accounts: Vec<BufferId>,
    bytes_each: u64,
}

/// The part of a frame that photons make; empty, with its reason, where the scene cannot show a caustic.
fn photon_passes(
    plan: &mut Plan,
    job: &Job,
    (arrays, buffers): (&SceneArrays, &SceneBuffers),
    everything: &Extent,
) -> Result<PhotonPasses, PlanError> {
    let (scene, settings) = (&*job.scene, &job.settings);
    if let Some(method) = job.providers.medium.filter(|m| !m.slots().contains(&Slot::Medium)) {
        return Err(PlanError::Refused {
            what: format!("--medium {}", method.name()),
            reason: "it does not fill the slot medium".into(),
            remedy: "media are not built yet".into(),
        });
    }
    let class = light::paths(scene, settings);
    let receivers = extents::receivers(scene, &job.camera);
    let seen = extents::receiving(scene, &job.camera);
    let emissions = light::emissions(scene, settings, &receivers[0].patch)?;
    let reason = match job.providers.surface {
        None => Some("no method was asked for"),
        Some(_) if scene.lights.is_empty() => Some("there is no light"),
        Some(_) if !scene.has_specular() => Some("nothing in the scene is specular"),
        Some(_) if emissions.is_empty() => Some("no light with any power reaches a specular object that has a surface"),
        Some(_) => None,
    };
    let (Some(method), None) = (job.providers.surface, reason) else {
        let stages = job.providers.surface.map(|m| m.stages()).unwrap_or_default();
        for name in ["light/photons"].iter().chain(stages).chain(&["eye/surface", "light/account"]) {
            plan.leave_out(name, reason.unwrap_or_default());
        }
        return Ok(PhotonPasses::default());
    };
    let most = || emissions.iter().map(light::Emission::most).fold(0.0, f64::max);
    let half = method.halves(settings).then(most);
    let photons =
        light::photon_buffer(plan, settings, class, &method.columns(settings), half, &light::sides(&emissions));
    let views: Vec<_> = emissions.iter().map(|e| e.view.data()).collect();
    let views = plan.upload("light/views", &views);
    let bench = light::Bench { scene, arrays, buffers, settings, class, emissions: &emissions, views, base: "light" };
    let tracer = light::Tracer::plan(plan, &bench)?;
    let mut work = methods::Job {
        plan,
        settings,
        scene,
        receivers: &receivers,
        seen: &seen,
        size: job.size,
        everything,
        emissions: &emissions,
        photons: &photons[0],
        bench: &bench,
        tracer: &tracer,
    };
    let mut planned = method.plan(&mut work)?;
    let mut accounts = Vec::new();
    for (index, emission) in emissions.iter().enumerate() {
        let name_of = |base: &str| light::view_name(base, scene, &emissions, index);
        let own = photons.iter().find(|photons| photons.side == emission.side).unwrap_or(&photons[0]);
        work.photons = own;
        let tracing = light::Tracing { scene: buffers, views, tracer: &tracer, class, photons: own, emission, index };
        tracer.images(work.plan, &bench, Phase::Frame, index);
        light::photons(work.plan, &name_of("light/photons"), &tracing);
        planned.gather(&mut work, index, &name_of);
        tracer.images(work.plan, &bench, Phase::Account, index);
        let name = name_of("light/account");
        accounts.push(account::account(work.plan, &name, &tracing, &planned.capture()));
    }
    Ok(PhotonPasses { provided: Some(planned.provide()), accounts, bytes_each: photons[0].bytes_each() })
}
