//! The photons of every view, kept side by side: what a method would take, and nothing made of it.

use glam::DVec3;

use crate::{
    gpu::{Format, ImageId, Lifetime, Resource},
    methods::{Method, Planned, Provided, Slot},
    passes::{
        PlanError, Work,
        light::{self, Column, Job, Taker, Wanted},
    },
    renderer::{Dump, RenderError, Renderer},
};

/// Invocations along one side of the dispatch's work groups.
const GROUP: u32 = 8;

/// Columns that are kept, the names of their images and of the shader's.
const KEPT: [(Column, &str, &str); 3] = [
    (Column::Hit, "tracers/hit", "kept_hit"),
    (Column::Flux, "tracers/flux", "kept_flux"),
    (Column::Exit, "tracers/exit", "kept_exit"),
];

/// Where a photon was at the end, and how it came there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// How it ended (`glsl/shared/photon.glsl`), 0 where none was emitted.
    pub status: usize,
    /// m, where it arrived.
    pub hit: DVec3,
    /// m, on the last specular surface.
    pub exit: DVec3,
    /// W, mean of the bands, where it arrived.
    pub flux: f64,
}

/// Takes the place of a method in a job.
pub struct Keep;

impl Method for Keep {
    fn name(&self) -> &'static str {
        "tracers"
    }

    fn title(&self) -> &'static str {
        "photons, kept as the tracer left them"
    }

    fn paper(&self) -> &'static str {
        "none"
    }

    fn slots(&self) -> &'static [Slot] {
        &[Slot::Surface]
    }

    fn stages(&self) -> &'static [&'static str] {
        &["light/photons", "tracers/keep", "light/account"]
    }

    fn plan(&self, work: &mut Work<'_>) -> Result<Planned, PlanError> {
        let wanted = Wanted { columns: KEPT.map(|(column, ..)| column).to_vec(), halves: false, blocks: 0 };
        Ok(Planned::of(light::shoot(work, &wanted, Keeping::begin)?, |_| Provided::default()))
    }
}

struct Keeping {
    images: [ImageId; 3],
}

impl Keeping {
    fn begin(job: &mut Job<'_>) -> Result<Self, PlanError> {
        let (side, layers) = (job.photons.side, job.emissions.len() as u32);
        if job.emissions.iter().any(|emission| emission.side != side) {
            return Err(PlanError::Refused {
                what: "a comparison of tracers with lights that have a size beside others that have none".into(),
                reason: "their views are not as fine, and texels are held against texels".into(),
                remedy: "set light.area_samples=1, or compare each light in a scene of its own".into(),
            });
        }
        let image = |name| job.work.plan.image_array(name, [side; 2], layers, Format::Rgba32f, Lifetime::Frame);
        Ok(Self { images: KEPT.map(|(_, name, _)| name).map(image) })
    }
}

impl Taker for Keeping {
    fn capture(&self) -> (&'static str, Vec<(&'static str, Resource)>) {
        ("tracers/takes_all.glsl", Vec::new())
    }

    fn gather(&mut self, job: &mut Job<'_>, view: usize, name_of: &dyn Fn(&str) -> String) {
        let groups = job.photons.side.div_ceil(GROUP);
        let pass =
            job.work.plan.pass(&name_of("tracers/keep")).with(job.photons.fetch(&KEPT.map(|(column, ..)| column)));
        let stored = KEPT.iter().zip(self.images).fold(pass, |pass, ((_, _, name), image)| pass.store(name, image));
        stored.push(&(view as i32)).dispatch("tracers/keep.comp", [groups, groups, 1], GROUP * GROUP);
    }
}

/// What the last frame left, view by view.
pub fn ends(renderer: &Renderer) -> Result<Vec<Vec<End>>, RenderError> {
    let read = |at: usize| renderer.dump(KEPT[at].1).map(layers);
    let (hit, flux, exit) = (read(0)?, read(1)?, read(2)?);
    let views = hit.iter().zip(&flux).zip(&exit);
    let texels = |((hit, flux), exit): ((&Vec<f32>, &Vec<f32>), &Vec<f32>)| {
        let texels = hit.chunks_exact(4).zip(flux.chunks_exact(4)).zip(exit.chunks_exact(4));
        texels.map(|((hit, flux), exit)| end(hit, flux, exit)).collect()
    };
    Ok(views.map(texels).collect())
}

fn end(hit: &[f32], flux: &[f32], exit: &[f32]) -> End {
    let point = |texel: &[f32]| DVec3::new(texel[0].into(), texel[1].into(), texel[2].into());
    let mean = point(flux).element_sum() / 3.0;
    End { status: exit[3] as usize, hit: point(hit), exit: point(exit), flux: mean }
}

fn layers(dump: Dump) -> Vec<Vec<f32>> {
    match dump {
        Dump::Image { layers, .. } => layers,
        Dump::Buffer(_) => Vec::new(), // no image of this room's is a buffer
    }
}
