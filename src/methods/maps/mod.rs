#![doc = include_str!("README.md")]
//! Based on: C. Wyman, *Hierarchical Caustic Maps*, I3D 2008. Differs: exact tracer, own receiving view, weights that
//! sum to one. Not implemented: its gathers `copy`, `hierarchical`, `combine` and `varying`.

use glam::DVec2;

use super::{Job, Method, Planned, Provided, Slot};
use crate::{
    gpu::{Blend, BufferId, Draw, Feature, Format, ImageId, Lifetime, Resource, Topology},
    passes::{
        PlanError,
        eye::SurfaceProvider,
        light::{self, Column, Emission},
    },
    settings::{Choice, Setting, Whole},
    view::{View, ViewData},
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
    words: &["fetch"],
    doc: "fetch: an instanced draw over the photons, without a copy (section 4)",
};

static SETTINGS: &[Setting] = &[Setting::Whole(&SIDE), Setting::Whole(&SPLAT_SIZE), Setting::Choice(&GATHER)];

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

    fn stages(&self) -> &'static [&'static str] {
        &["maps/gather"]
    }

    fn plan(&self, job: &mut Job<'_>) -> Result<Box<dyn Planned>, PlanError> {
        let side = job.settings.whole(&SIDE);
        let diameter = job.settings.whole(&SPLAT_SIZE);
        let views = receiving_views(job, side, diameter);
        let layers = views.len() as u32;
        Ok(Box::new(PlannedMaps {
            side,
            diameter,
            lights: views.iter().map(|v| v.light).collect(),
            map: job.plan.image_array("maps/map", [side, side], layers, Format::Rgba32f, Lifetime::Frame),
            views: job.plan.upload("maps/views", &views),
            drawn: vec![false; views.len()],
        }))
    }
}

/// Any receiver, or any light (`ANY` of `glsl/maps/views.glsl`).
const ANY: u32 = u32::MAX;

/// A layer of the map as the shaders read it (`MapView` of `glsl/maps/views.glsl`).
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of the shader
pub struct MapView {
    pub view: ViewData,
    pub receiver: u32,
    pub light: u32,
}

/// Views that receive: one over the receiver's rectangle, which all lights share and which holds that receiver's light
/// alone; in `shared` mode each light's own view, which holds whatever it sees, as in the paper.
///
/// A margin of half a splat and a texel keeps every splat whole that reaches into the rectangle. Where the receiver
/// ends before, so does the map, and splats cut there are normalised: no light leaks over the receiver's edge.
fn receiving_views(job: &Job<'_>, side: u32, diameter: u32) -> Vec<MapView> {
    if job.settings.choice(&light::VIEW) == "shared" {
        let of = |e: &Emission| MapView { view: e.view.data(), receiver: ANY, light: e.light as u32 };
        // Bands that are traced apart share their light's layer.
        return job.emissions.iter().filter(|e| matches!(e.band, None | Some(0))).map(of).collect();
    }
    let r = job.receiver;
    let full = (0.5 * f64::from(diameter) + 1.0).min(0.25 * f64::from(side));
    let half = DVec2::new(r.u.length(), r.v.length());
    let view = View::of_rectangle(r.center, r.u, r.v, margins(half, job.beyond, side, full), job.everything);
    vec![MapView { view: view.data(), receiver: r.receiver as u32, light: ANY }]
}

/// Margins (m) of `full` texels on each side of a rectangle, less where the receiver ends before; with them the
/// rectangle takes `side` texels each way. The size of a texel follows from the margins and they from it: a texel that
/// is too large makes the next one too large by at most half as much, so that repeating it settles.
fn margins(half: DVec2, beyond: [DVec2; 2], side: u32, full: f64) -> [DVec2; 2] {
    const ROUNDS: u32 = 60;
    let mut texel = DVec2::ZERO;
    for _ in 0..ROUNDS {
        let [low, high] = beyond.map(|b| b.min(full * texel));
        texel = (2.0 * half + low + high) / f64::from(side);
    }
    beyond.map(|b| b.min(full * texel))
}

struct PlannedMaps {
    side: u32,
    diameter: u32,
    /// Of each layer.
    lights: Vec<u32>,
    map: ImageId,
    views: BufferId,
    drawn: Vec<bool>,
}

/// Push constants of `glsl/maps/gather_fetch.vert` and `splat.frag`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct GatherPush {
    side: i32,
    diameter: f32,
    layer: u32,
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
        let layer = self.lights.iter().position(|&l| l == ANY || l == light).unwrap_or(0) as u32;
        let first = !std::mem::replace(&mut self.drawn[layer as usize], true);
        let push = GatherPush { side: self.side as i32, diameter: self.diameter as f32, layer };
        job.plan
            .pass(&name_of("maps/gather"))
            .with(job.photons.fetch(&[Column::Hit, Column::Flux]))
            .with([self.views()])
            .push(&push)
            .target(self.map, layer, first.then_some([0.0; 4]), Blend::Add)
            .draw(
                &["maps/gather_fetch.vert", "maps/splat.frag"],
                Topology::Points,
                vec![Draw { vertices: n, first_vertex: 0, instances: n, first_instance: 0 }],
            );
    }

    fn provide(&self) -> Provided {
        let reads = vec![("maps_map", Resource::Image(self.map)), self.views()];
        Provided { surface: Some(SurfaceProvider { file: "maps/surface.glsl", reads }), deposits: vec![self.map] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few sums and quotients of numbers of order one.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn margins_end_with_the_receiver() {
        let half = DVec2::new(1.0, 2.0);
        let none = [DVec2::ZERO; 2];
        assert_eq!(margins(half, none, 64, 2.5), none, "no receiver beyond, no margin");
        let [low, high] = margins(half, [DVec2::INFINITY; 2], 64, 2.5);
        assert!((low - half * 5.0 / 59.0).length() < ROUNDING && low == high, "59 texels of 64 see the rectangle");
        // On one side 0.01 m are left, on the other the whole margin: 61.5 texels see 2.01 m.
        let [low, high] = margins(half, [DVec2::splat(0.01), DVec2::INFINITY], 64, 2.5);
        assert!((high.x - 2.5 * 2.01 / 61.5).abs() < ROUNDING && low.x == 0.01, "{low} {high}");
        let [low, high] = margins(half, [DVec2::INFINITY; 2], 1, 0.25);
        assert!((low + high - 2.0 * half).length() < ROUNDING, "of a single texel half sees the rectangle");
    }
}
