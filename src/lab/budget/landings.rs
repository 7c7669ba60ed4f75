//! Where the tracer's photons land, binned exactly: no reconstruction, in the place of a method.

use crate::{
    gpu::{BufferId, Gpu, Resource},
    lab::picture::REGION,
    methods::{Method, Planned, Provided, Slot},
    passes::{
        PlanError, Work, eye,
        light::{self, Column, Job, Taker, Wanted},
    },
    renderer::{self, Dump, Frame, Providers, RenderError, Renderer},
};

/// Invocations along one side of the dispatch's work groups.
const GROUP: u32 = 8;
/// Words a pixel: three bands of 64 bits.
const WORDS: usize = 6;

/// Takes the place of a method in a job of the camera `region`; it bins into that picture's pixels.
struct Landings;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct BinPush {
    size: [i32; 2],
    receiver: u32,
}

impl Method for Landings {
    fn name(&self) -> &'static str {
        "landings"
    }

    fn title(&self) -> &'static str {
        "photons, binned where they land"
    }

    fn paper(&self) -> &'static str {
        "none"
    }

    fn slots(&self) -> &'static [Slot] {
        &[Slot::Surface]
    }

    fn stages(&self) -> &'static [&'static str] {
        &["light/photons", "budget/bin", "light/account"]
    }

    fn plan(&self, work: &mut Work<'_>) -> Result<Planned, PlanError> {
        let wanted = Wanted { columns: vec![Column::Hit, Column::Flux], halves: false, blocks: 0 };
        Ok(Planned::of(light::shoot(work, &wanted, Binning::begin)?, |_| Provided::default()))
    }
}

struct Binning {
    size: [u32; 2],
    view: BufferId,
    sums: BufferId,
    unit: BufferId,
}

impl Binning {
    fn begin(job: &mut Job<'_>) -> Result<Self, PlanError> {
        let view = eye::view(&job.work.scene.cameras[REGION], job.work.size, job.work.everything);
        let pixels = pixels(job.work.size);
        let unit = light::flux_unit(job.emissions);
        Ok(Self {
            size: job.work.size,
            view: job.work.plan.upload("budget/view", &[view.data()]),
            sums: job.work.plan.upload_once("budget/sums", &vec![0u32; WORDS * pixels]),
            unit: job.work.plan.upload("budget/unit", &[unit.recip() as f32, unit as f32]),
        })
    }
}

impl Taker for Binning {
    fn capture(&self) -> (&'static str, Vec<(&'static str, Resource)>) {
        ("tracers/takes_all.glsl", Vec::new())
    }

    fn gather(&mut self, job: &mut Job<'_>, _view: usize, name_of: &dyn Fn(&str) -> String) {
        let groups = job.photons.side.div_ceil(GROUP);
        let receiver = job.work.scene.region.receiver as u32;
        let push = BinPush { size: self.size.map(|n| n as i32), receiver };
        let pass = job.photons.define(job.work.plan.pass(&name_of("budget/bin")));
        let pass = pass.with(job.photons.fetch(&[Column::Hit, Column::Flux])).read("budget_view", self.view);
        let pass = pass.read("flux_unit", self.unit).write("flux_sums", self.sums).push(&push);
        pass.dispatch("budget/bin.comp", [groups, groups, job.photons.layers()], GROUP * GROUP);
    }
}

fn pixels([width, height]: [u32; 2]) -> usize {
    width as usize * height as usize
}

/// W/m² of each pixel of a picture of the region, three bands, rows from the top: the flux of the photons that land in it
/// over its area.
pub(super) fn landings(gpu: &Gpu, job: &renderer::Job) -> Result<Vec<f32>, RenderError> {
    let providers = Providers { surface: Some(&Landings), medium: None };
    let mut job = renderer::Job { providers, ..job.clone() };
    job.settings.set(&renderer::all_settings(), eye::SAMPLES.key, "1").expect("one eye sample a pixel is allowed");
    let pixels = pixels(job.size);
    let mut renderer = Renderer::new(gpu, &job)?;
    renderer.frame(&Frame { time: job.scene.time, ..Frame::default() })?;
    if !renderer.stages().iter().any(|stage| stage.starts_with("budget/bin")) {
        return Ok(vec![0.0; 3 * pixels]); // without light on anything specular nothing lands
    }
    let (Dump::Buffer(sums), Dump::Buffer(unit)) = (renderer.dump("budget/sums")?, renderer.dump("budget/unit")?)
    else {
        return Ok(Vec::new()); // no buffer of this room's is an image
    };
    let watts = f64::from(f32::from_bits(unit[1])) * pixels as f64 / job.scene.region.area();
    let word = |pair: &[u32]| u64::from(pair[0]) | u64::from(pair[1]) << 32;
    Ok(sums.chunks_exact(2).map(|pair| (word(pair) as f64 * watts) as f32).collect())
}
