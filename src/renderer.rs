//! Floor 4: plan → prepare → frame → read. Command line, lab and window are its clients.

mod moving;
mod plan;
mod read;
mod show;

use std::{sync::Arc, time::Instant};

use glam::DVec3;

use crate::{
    gpu::{Feature, FrameTimes, Gpu, GpuError, PassCounters, Phase, Plan, Program, Reused, Sources},
    methods::Method,
    names::NoSuch,
    passes::{
        PlanError, accel,
        account::{Account, AccountRow},
        extents,
        eye::{self, FrameData},
    },
    scene::{Camera, Scene},
    settings::{Setting, Settings},
    store::Store,
    view::View,
};

pub use moving::Moved;
pub use plan::{Planned, Providers, plan};
pub use read::{Counted, Dump, Energy, Unresolved, resource};
pub use show::LAYERS;

/// An error of rendering.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The scene, settings and method do not make a plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The method needs what the device lacks.
    #[error(
        "method '{method}' cannot run on {device}: it lacks {lacks} (nephroid devices shows which methods run where)"
    )]
    Lacks {
        /// The method.
        method: &'static str,
        /// The device.
        device: String,
        /// What is missing.
        lacks: String,
    },
    /// No camera or resource of that name.
    #[error(transparent)]
    Unknown(#[from] NoSuch),
}

/// What a frame is made for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Frame {
    /// Seconds.
    pub time: f64,
    /// Its number.
    pub index: u32,
    /// Seed of anything random.
    pub seed: u32,
    /// Another place to look from than the camera's; it must see the same objects. Where the camera's picture has no room
    /// for a sky (the plan says so), neither has this one.
    pub camera: Option<View>,
}

/// A scene and a method ready to be rendered again and again.
pub struct Renderer {
    gpu: Gpu,
    planned: Planned,
    program: Program,
    camera: Camera,
    eye: View,
    /// Where the eye was last, and in which media.
    eye_media: (DVec3, u32),
    /// At the time of the last frame.
    job: Job,
    trees: accel::Trees,
    moved: Moved,
    sources: Sources,
    store: Store,
    prepare_ms: Vec<(&'static str, f64)>,
}

/// What is rendered, and how.
#[derive(Clone)]
pub struct Job {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Who fills the slots.
    pub providers: Providers,
    /// The settings.
    pub settings: Settings,
    /// The camera's name.
    pub camera: String,
    /// Pixels.
    pub size: [u32; 2],
}

impl Job {
    /// The camera of that name, or an error that says which are near.
    pub fn camera(&self) -> Result<&Camera, RenderError> {
        Ok(self.scene.camera(&self.camera)?)
    }

    /// The same on a device.
    fn on(&self, gpu: &Gpu) -> Self {
        Self { settings: self.settings.on(gpu.info().is_software()), ..self.clone() }
    }

    /// Samples a pixel along each axis: the value in force of `eye.samples`.
    pub fn eye_samples(&self) -> u32 {
        let own = self.providers.surface.and_then(|method| method.eye_samples(&self.settings));
        let unsaid = self.settings.whole(&eye::SAMPLES) == 0;
        own.filter(|_| unsaid).unwrap_or_else(|| eye::samples(&self.settings, &self.camera, self.size))
    }
}

/// Every setting of every room, sorted as they are listed.
pub fn all_settings() -> Vec<Setting> {
    let rooms = [crate::passes::light::SETTINGS, crate::passes::eye::SETTINGS];
    let methods = crate::methods::ALL.iter().map(|m| m.settings());
    rooms.into_iter().chain(methods).flatten().copied().collect()
}

/// What a method needs and the device lacks.
pub fn lacks(method: &dyn Method, settings: &Settings, features: &[Feature]) -> Vec<&'static str> {
    method.needs(settings).iter().filter(|f| !features.contains(f)).map(|f| f.name()).collect()
}

impl Renderer {
    /// Plans and prepares; allocates and compiles exactly what the plan lists.
    pub fn new(gpu: &Gpu, job: &Job) -> Result<Self, RenderError> {
        Self::with_sources(gpu, job, Sources::default())
    }

    /// As [`Self::new`], with shaders of one's own in the place of some shipped ones.
    pub fn with_sources(gpu: &Gpu, job: &Job, sources: Sources) -> Result<Self, RenderError> {
        let job = &job.on(gpu);
        Self::prepare(gpu, job, plan(job)?, sources, Store::open(), None)
    }

    /// As [`Self::with_sources`], with the plan of this very job made before. What hangs on the kind of device is planned again.
    pub fn planned(gpu: &Gpu, job: &Job, planned: Planned, sources: Sources) -> Result<Self, RenderError> {
        let on = job.on(gpu);
        let hangs = |method: &&dyn Method| method.hangs_on_device(&on.settings, &on.scene);
        let again = on.settings != job.settings && on.providers.methods().iter().any(hangs);
        let planned = if again { plan(&on)? } else { planned };
        Self::prepare(gpu, &on, planned, sources, Store::open(), None)
    }

    /// Plans again for a changed job; what did not change is kept.
    pub fn replan(self, job: &Job) -> Result<Self, RenderError> {
        let Self { gpu, program, sources, store, .. } = self;
        let job = &job.on(&gpu);
        Self::prepare(&gpu, job, plan(job)?, sources, store, Some(&program))
    }

    fn prepare(
        gpu: &Gpu,
        job: &Job,
        mut planned: Planned,
        sources: Sources,
        store: Store,
        old: Option<&Program>,
    ) -> Result<Self, RenderError> {
        for method in job.providers.methods() {
            let lacks = lacks(method, &job.settings, &gpu.info().features);
            if !lacks.is_empty() {
                let device = gpu.info().label();
                return Err(RenderError::Lacks { method: method.name(), device, lacks: lacks.join(", ") });
            }
        }
        let start = Instant::now();
        let mut program = Program::new(gpu, planned.plan.clone(), &sources, &store, old)?;
        let program_ms = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        if program.passes(Phase::Prepare).next().is_some() {
            program.run(Phase::Prepare, &[])?;
        }
        let passes_ms = start.elapsed().as_secs_f64() * 1e3;
        let prepare_ms =
            vec![("prepare/plan", planned.plan_ms), ("prepare/program", program_ms), ("prepare/passes", passes_ms)];
        let (camera, eye, eye_media) = seen(job)?;
        let (gpu, job, moved, trees) = (gpu.clone(), job.clone(), Moved::default(), std::mem::take(&mut planned.trees));
        Ok(Self { gpu, planned, program, camera, eye, eye_media, job, trees, moved, sources, store, prepare_ms })
    }

    /// What is recorded every frame.
    pub fn plan(&self) -> &Plan {
        self.program.plan()
    }

    /// What preparing took, ms on the host: planning (trees included), compiling and allocating, passes.
    pub fn prepare_ms(&self) -> &[(&'static str, f64)] {
        &self.prepare_ms
    }

    /// What the last re-plan kept.
    pub fn reused(&self) -> Reused {
        self.program.reused()
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The scene, at the time of the last frame.
    pub fn scene(&self) -> &Scene {
        &self.job.scene
    }

    /// Stage names of a frame, in order: the rows of [`FrameTimes::passes`].
    pub fn stages(&self) -> Vec<String> {
        self.program.passes(Phase::Frame).map(|p| p.name.clone()).collect()
    }

    /// Renders a frame and waits for it. Where the scene moves and the time is another, it is moved before the frame's
    /// clock starts: see [`Self::moved`].
    pub fn frame(&mut self, frame: &Frame) -> Result<FrameTimes, RenderError> {
        self.move_to(frame.time)?;
        let data = self.frame_data(frame);
        Ok(self.program.run(Phase::Frame, &[(self.planned.frame, bytemuck::bytes_of(&data))])?)
    }

    /// Renders a frame and counts what each pass does, outside the timed frames.
    pub fn counters(&mut self, frame: &Frame) -> Result<Vec<(String, PassCounters)>, RenderError> {
        self.move_to(frame.time)?;
        let data = self.frame_data(frame);
        Ok(self.program.count(Phase::Frame, &[(self.planned.frame, bytemuck::bytes_of(&data))])?)
    }

    /// Counts every photon and every watt, outside the timed frames.
    pub fn account(&mut self) -> Result<Account, RenderError> {
        if self.planned.accounts.is_empty() {
            return Ok(Account::default());
        }
        self.program.run(Phase::Account, &[])?;
        let mut rows: Vec<AccountRow> = Vec::new();
        for &buffer in &self.planned.accounts {
            rows.append(&mut bytemuck::pod_collect_to_vec(&self.program.read_buffer(buffer)?));
        }
        Ok(Account::of(&rows))
    }

    fn frame_data(&mut self, frame: &Frame) -> FrameData {
        let eye = frame.camera.unwrap_or(self.eye);
        if self.eye_media.0 != eye.origin {
            let media = self.job.scene.media_of_eye(&self.camera, eye.origin);
            self.eye_media = (eye.origin, accel::packed_media(&media));
        }
        let (time, eye_media) = (frame.time as f32, self.eye_media.1);
        FrameData { eye: eye.data(), time, index: frame.index, seed: frame.seed, eye_media }
    }
}

/// The job's camera, its view, and the media about it.
fn seen(job: &Job) -> Result<(Camera, View, (DVec3, u32)), RenderError> {
    let camera = job.camera()?.clone();
    let eye = eye::view(&camera, job.size, &extents::everything(&job.scene));
    let media = accel::packed_media(&job.scene.media_of_eye(&camera, eye.origin));
    Ok((camera, eye, (eye.origin, media)))
}
