//! The views that receive: each a layer of the map, or a window in one.

use glam::DVec2;

use super::{Axes, BIND, Job, RECEIVERS, SIDE, SPLAT_SIZE, windows};
use crate::{
    passes::{
        PlanError,
        extents::{self, Receiver},
        light::{self, Emission},
    },
    scene::{Light, Object, Scene, Shape},
    settings::Settings,
    view::{View, ViewData},
};

/// Any receiver, or any light (`ANY` of `glsl/maps/views.glsl`).
pub const ANY: u32 = u32::MAX;

/// Which sides of surfaces a view takes (`SIDES_…` of `glsl/maps/views.glsl`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// Those that face it.
    Facing,
    /// Those turned away from it.
    Away,
    /// Those that face it, by the square of the cosine.
    Shared,
}

/// A view of the map as the shaders read it (`MapView` of `glsl/maps/views.glsl`).
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of the shader
pub struct MapView {
    pub view: ViewData,
    pub receiver: u32,
    pub light: u32,
    pub layer: u32,
    pub sides: u32,
    pub low: [f32; 2],
    pub high: [f32; 2],
}

impl MapView {
    /// A view that has a layer to itself.
    fn whole(view: &View, receiver: u32, light: u32, layer: usize, sides: Sides) -> Self {
        let (low, high) = ([0.0; 2], [1.0; 2]);
        Self { view: view.data(), receiver, light, layer: layer as u32, sides: sides as u32, low, high }
    }
}

/// Views that receive: one over each receiver's rectangle, which all lights share and which holds that receiver's light
/// alone, and windows for what is no rectangle ([`windows`]); in `shared` mode those of [`shared`].
///
/// A margin of half a splat and a texel keeps every splat whole that reaches into the rectangle. Where the receiver
/// ends before, so does the map, and splats cut there are normalised: no light leaks over the receiver's edge.
pub fn receiving(job: &mut Job<'_>, axes: Axes<'_>, side: u32, diameter: u32) -> Vec<MapView> {
    if job.work.settings.choice(&light::VIEW) == "shared" {
        return shared(job);
    }
    let full = margin(side, diameter);
    let of = |(layer, Receiver { patch, beyond }): (usize, &Receiver)| {
        let half = DVec2::new(patch.u.length(), patch.v.length());
        let margins = margins(half, *beyond, side, full);
        let view = View::of_rectangle(patch.center, patch.u, patch.v, margins, job.work.everything);
        MapView::whole(&view, patch.receiver as u32, ANY, layer, Sides::Facing)
    };
    let count = if job.work.settings.choice(&RECEIVERS) == "region" { 1 } else { job.work.receivers.len() };
    let rectangles: Vec<_> = job.work.receivers[..count].iter().enumerate().map(of).collect();
    let windows = windows::of_shapes(job, axes, (side, full), rectangles.len());
    rectangles.into_iter().chain(windows).collect()
}

/// Layers of the map's image: `levels` for each that the views have.
///
/// # Errors
/// More than every device's images have.
pub fn layers(views: &[MapView], levels: u32) -> Result<u32, PlanError> {
    /// `maxImageArrayLayers` of every Vulkan 1.3 device, at least.
    const MOST: u32 = 256;
    let layers = views.iter().map(|view| view.layer + 1).max().unwrap_or(1) * levels;
    if layers <= MOST {
        return Ok(layers);
    }
    Err(PlanError::Refused {
        what: format!("a caustic map of {layers} layers"),
        reason: format!("not every device has images of more than {MOST}"),
        remedy: "set maps.bind=none, light.view=fitted or maps.receivers=region, or lower light.area_samples".into(),
    })
}

/// Layers of the map at most, whatever the camera, of splats that have windows and one level.
pub fn most_layers(scene: &Scene, settings: &Settings) -> u64 {
    /// Any but the region's sees all.
    const CAMERA: &str = "main";
    let seen = extents::receiving(scene, CAMERA);
    if settings.choice(&light::VIEW) == "shared" {
        let points = |light: &Light| if light.kind.has_area() { settings.whole(&light::AREA_SAMPLES) } else { 1 };
        let views: u64 = scene.lights.iter().map(|light| u64::from(points(light))).sum();
        return views * if settings.choice(&BIND) == "none" { 1 } else { 2 * seen.len() as u64 };
    }
    let rectangles = match settings.choice(&RECEIVERS) {
        "region" => 1,
        _ => extents::receivers(scene, CAMERA).len() as u64,
    };
    let side = settings.whole(&SIDE);
    rectangles + windows::most_layers(scene, settings, &seen, (side, margin(side, settings.whole(&SPLAT_SIZE))))
}

/// Texels about what a map shows.
fn margin(side: u32, diameter: u32) -> f64 {
    (0.5 * f64::from(diameter) + 1.0).min(0.25 * f64::from(side))
}

/// Each light's own view (or each of its points'), which holds whatever it sees, as in the paper. With `maps.bind =
/// receiver` one for each receiver and each of its sides, which holds its light alone.
fn shared(job: &Job<'_>) -> Vec<MapView> {
    // Bands and tiles that are traced apart share their light's layer.
    let lights = job.emissions.iter().filter(|e| e.begins_view());
    if job.work.settings.choice(&BIND) == "none" {
        let of = |(layer, e): (usize, &Emission)| MapView::whole(&e.view, ANY, e.lamp, layer, Sides::Facing);
        return lights.enumerate().map(of).collect();
    }
    let kinds = lights.flat_map(|e| job.work.seen.iter().flat_map(move |&r| sides(job, e, r).map(move |s| (e, r, s))));
    let of = |(layer, (e, receiver, sides)): (usize, (&Emission, usize, Sides))| {
        MapView::whole(&e.view, receiver as u32, e.lamp, layer, sides)
    };
    kinds.enumerate().map(of).collect()
}

/// The sides of a receiver that light can fall on, as a light's view sees them: of a quad its back where something
/// specular lies behind it.
fn sides(job: &Job<'_>, e: &Emission, receiver: usize) -> impl Iterator<Item = Sides> + use<> {
    let behind = match job.work.scene.objects.get(receiver) {
        Some(Object { shape: Shape::Quad { center, u, v }, .. }) => {
            let normal = u.cross(*v);
            let towards = if e.view.perspective { *center - e.view.origin } else { e.view.forward };
            job.work.scene.moves()
                || windows::lies_beyond(job.work.scene, *center, normal * towards.dot(normal).signum())
        }
        _ => true,
    };
    [Sides::Facing].into_iter().chain(behind.then_some(Sides::Away))
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
