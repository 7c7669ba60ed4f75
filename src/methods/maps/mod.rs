#![doc = include_str!("README.md")]
//! Based on: C. Wyman, *Hierarchical Caustic Maps*, I3D 2008. Differs: exact tracer, own receiving view, weights that
//! sum to one. Not implemented: its gathers `hierarchical`, `combine` and `varying`.

mod copied;
mod sums;
mod views;

use copied::{COPY, Vertices};
use sums::Fixed;

use super::{Job, Link, Method, Planned, Provided, Shown, Slot};
use crate::{
    gpu::{Blend, BufferId, Draw, Feature, Format, ImageId, Lifetime, Resource, Topology},
    passes::{PlanError, eye::SurfaceProvider, light::Column},
    settings::{Choice, Setting, Settings, Whole},
};

/// Texels along each side of the caustic map.
pub static SIDE: Whole = Whole {
    key: "maps.side",
    unit: "texels",
    default: 512,
    range: 1..=16384,
    doc: "texels along each side of the caustic map",
};

static SPLAT_SIZE: Whole = Whole {
    key: "maps.splat_size",
    unit: "texels",
    default: 3,
    range: 1..=63,
    doc: "diameter of a photon's Gaussian splat; its standard deviation is a quarter of it",
};

static GATHER: Choice = Choice {
    key: "maps.gather",
    default: "fetch",
    words: &["fetch", "copy"],
    doc: "fetch: each photon is fetched from where it was traced (section 4); copy: photons are first copied to vertices (2006)",
};

static RECEIVERS: Choice = Choice {
    key: "maps.receivers",
    default: "all",
    words: &["all", "region"],
    doc: "all: a layer of the map for each diffuse quad that the camera may see; region: for the region's receiver alone",
};

static SUM: Choice = Choice {
    key: "maps.sum",
    default: "fixed",
    words: &["fixed", "blend"],
    doc: "fixed: exact, in 64-bit fixed point (beyond 128 MiB of sums, blend); blend: drawn and blended in float32, as with maps.gather = copy always",
};

static SETTINGS: &[Setting] = &[
    Setting::Whole(&SIDE),
    Setting::Whole(&SPLAT_SIZE),
    Setting::Choice(&GATHER),
    Setting::Choice(&COPY),
    Setting::Choice(&SUM),
    Setting::Choice(&RECEIVERS),
];

static CHAIN: &[Link] = &[
    Link { shown: Shown::AllPaths, step: "", moved_by: &[] },
    Link { shown: Shown::PathClass, step: "path class", moved_by: &["light.paths"] },
    Link {
        shown: Shown::Landings,
        step: "tracer",
        moved_by: &["light.tracer", "light.view", "light.back", "light.total_reflection", "light.layers"],
    },
    Link {
        shown: Shown::Fine,
        step: "reconstruction",
        moved_by: &[
            "maps.side",
            "maps.splat_size",
            "maps.gather",
            "maps.copy",
            "maps.sum",
            "maps.receivers",
            "eye.samples",
        ],
    },
    Link { shown: Shown::AsAsked, step: "light.side", moved_by: &["light.side"] },
];

/// Hierarchical caustic maps.
pub struct Maps;

impl Method for Maps {
    fn name(&self) -> &'static str {
        "maps"
    }

    fn title(&self) -> &'static str {
        "photons splatted into a caustic map that is projected on the receivers"
    }

    fn paper(&self) -> &'static str {
        "C. Wyman, Hierarchical Caustic Maps, I3D 2008"
    }

    fn slots(&self) -> &'static [Slot] {
        &[Slot::Surface]
    }

    fn needs(&self) -> &'static [Feature] {
        &[Feature::Float32Blend, Feature::LargePoints]
    }

    fn settings(&self) -> &'static [Setting] {
        SETTINGS
    }

    fn columns(&self) -> &'static [Column] {
        &[Column::Hit, Column::Flux]
    }

    fn halves(&self, settings: &Settings) -> bool {
        copied::halves(settings)
    }

    fn stages(&self) -> &'static [&'static str] {
        &["maps/gather", "maps/resolve"]
    }

    fn chain(&self) -> &'static [Link] {
        CHAIN
    }

    fn plan(&self, job: &mut Job<'_>) -> Result<Box<dyn Planned>, PlanError> {
        let side = job.settings.whole(&SIDE);
        let diameter = job.settings.whole(&SPLAT_SIZE);
        let views = views::receiving(job, side, diameter);
        let layers = views.len() as u32;
        Ok(Box::new(PlannedMaps {
            side,
            diameter,
            map: job.plan.image_array("maps/map", [side, side], layers, Format::Rgba32f, Lifetime::Frame),
            views: job.plan.upload("maps/views", &views),
            fixed: sums::fixed(job, side, layers),
            vertices: Vertices::plan(job),
            drawn: false,
        }))
    }
}

struct PlannedMaps {
    side: u32,
    diameter: u32,
    map: ImageId,
    views: BufferId,
    fixed: Option<Fixed>,
    vertices: Option<Vertices>,
    drawn: bool,
}

/// Push constants of `glsl/maps/gather_fixed.comp`, `gather_fetch.vert`, `gather_copy.vert` and `splat.frag`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct GatherPush {
    side: i32,
    diameter: f32,
    light: u32,
}

impl PlannedMaps {
    fn views(&self) -> (&'static str, Resource) {
        ("maps_views", Resource::Buffer(self.views))
    }
}

impl Planned for PlannedMaps {
    fn capture(&self) -> (&'static str, Vec<(&'static str, Resource)>) {
        ("maps/capture.glsl", vec![self.views()])
    }

    fn gather(&mut self, job: &mut Job<'_>, view: usize, name_of: &dyn Fn(&str) -> String) {
        let n = job.photons.side;
        let light = job.emissions[view].light as u32;
        let push = GatherPush { side: self.side as i32, diameter: self.diameter as f32, light };
        if let Some(vertices) = &self.vertices {
            vertices.fill(job, &name_of("maps/copy"));
        }
        let pass = job.photons.define(job.plan.pass(&name_of("maps/gather"))).with([self.views()]).push(&push);
        let columns = job.photons.fetch(&[Column::Hit, Column::Flux]);
        if let Some(fixed) = &self.fixed {
            fixed.gather(pass.with(columns), [n, job.photons.layers()]);
            if view + 1 == job.emissions.len() {
                fixed.resolve(job, self.map, self.side);
            }
            return;
        }
        let first = !std::mem::replace(&mut self.drawn, true);
        let pass = pass.target_layers(self.map, first.then_some([0.0; 4]), Blend::Add);
        let (pass, shader, [vertices, instances]) = match &self.vertices {
            None => (pass.with(columns), "maps/gather_fetch.vert", [n, n * job.photons.layers()]),
            Some(copied) => {
                let pass = copied.attributes().into_iter().fold(pass, |pass, (b, format)| pass.attribute(b, format));
                (pass, "maps/gather_copy.vert", [(n * n).saturating_mul(job.photons.layers()), 1])
            }
        };
        pass.draw(
            &[shader, "maps/splat.frag"],
            Topology::Points,
            vec![Draw { vertices, first_vertex: 0, instances, first_instance: 0 }],
        );
    }

    fn provide(&self) -> Provided {
        let reads = vec![("maps_map", Resource::Image(self.map)), self.views()];
        Provided { surface: Some(SurfaceProvider { file: "maps/surface.glsl", reads }), deposits: vec![self.map] }
    }
}
