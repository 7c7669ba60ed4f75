//! The views that receive: a layer of the map each.

use glam::DVec2;

use super::{Job, RECEIVERS};
use crate::{
    passes::{
        extents::Receiver,
        light::{self, Emission},
    },
    view::{View, ViewData},
};

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

/// Views that receive: one over each receiver's rectangle, which all lights share and which holds that receiver's light
/// alone; in `shared` mode each light's own view (or each of its points'), which holds whatever it sees, as in the paper.
///
/// A margin of half a splat and a texel keeps every splat whole that reaches into the rectangle. Where the receiver
/// ends before, so does the map, and splats cut there are normalised: no light leaks over the receiver's edge.
pub fn receiving(job: &Job<'_>, side: u32, diameter: u32) -> Vec<MapView> {
    if job.settings.choice(&light::VIEW) == "shared" {
        let of = |e: &Emission| MapView { view: e.view.data(), receiver: ANY, light: e.lamp };
        // Bands and tiles that are traced apart share their light's layer.
        return job.emissions.iter().filter(|e| e.begins_view()).map(of).collect();
    }
    let full = (0.5 * f64::from(diameter) + 1.0).min(0.25 * f64::from(side));
    let of = |Receiver { patch, beyond }: &Receiver| {
        let half = DVec2::new(patch.u.length(), patch.v.length());
        let margins = margins(half, *beyond, side, full);
        let view = View::of_rectangle(patch.center, patch.u, patch.v, margins, job.everything);
        MapView { view: view.data(), receiver: patch.receiver as u32, light: ANY }
    };
    let count = if job.settings.choice(&RECEIVERS) == "region" { 1 } else { job.receivers.len() };
    job.receivers[..count].iter().map(of).collect()
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
