//! Light on its way to the receiver, judged by the account of photons alone.

use super::{Check, count, under_a_lamp};
use crate::common::picture::{job_of, scene};
use nephroid::{
    gpu::{Gpu, Sources},
    renderer::Job,
    scene::Scene,
};
use std::f64::consts::PI;

/// Flux through the sphere's silhouette, by closed form.
pub static EMITTED: Check = Check { name: "flux through the silhouette", bound: SILHOUETTE, figure: emitted };
/// Flux kept in a sphere with a lamp off its centre, by closed form.
pub static TOTAL_REFLECTION: Check = Check { name: "flux totally reflected", bound: CONE, figure: totally_reflected };
/// Flux that coloured glass takes from a lamp at its centre, by closed form.
pub static LAMP_IN_GLASS: Check = Check { name: "lamp in coloured glass", bound: ROUNDING, figure: absorbed };

/// Photons that the one-shot estimate of Wyman 2005 loses in the glass sphere, by its closed form.
pub static ONE_SHOT: Check = Check { name: "one-shot's false loss", bound: RING, figure: falsely_lost };

/// Measured 7e-4 of the photons: a ring of texels, a quarter of them on the wrong side, is 2e-3.
const RING: f64 = 2e-3;
/// Measured 5e-5; allowed what `closed_forms` allows to lattice points in a circle of 128 texels' radius.
const SILHOUETTE: f64 = 0.001;
/// Measured 2e-4 by 6 × 128² photons; allowed five times that, for the cone's edge cuts through texels.
const CONE: f64 = 0.001;
/// Measured 7e-8; allowed what `energy` allows to float32 products and sums of 64 photons.
const ROUNDING: f64 = 1e-5;

fn lamp_job(scene: Scene, side: &str) -> Job {
    job_of(scene, &[("light.side", side), ("maps.side", "16")], "region", [8, 8])
}

/// So near that the view of the sphere is wide: tangent 1.
fn emitted(gpu: &Gpu, sources: &Sources) -> f64 {
    let distance = 2f64.sqrt();
    let scene = under_a_lamp("glass-sphere", &[], [0.0, distance, 0.0], 1.0);
    let exact = 2.0 * PI * (1.0 - (1.0 - 1.0 / (distance * distance)).sqrt());
    count(gpu, sources, &lamp_job(scene, "256")).emitted_w() / exact - 1.0
}

/// Total reflection where 0.8 sin θ > 1/1.5, θ from the axis: a share cos asin(5/6) of all directions.
fn totally_reflected(gpu: &Gpu, sources: &Sources) -> f64 {
    let mut scene = under_a_lamp("glass-sphere", &[], [0.0, -0.8, 0.0], 1.0);
    scene.paths = "transmit-1".parse().expect("a class");
    let share = (1.0f64 - (5.0f64 / 6.0).powi(2)).sqrt();
    count(gpu, sources, &lamp_job(scene, "128")).flux_w[2] / (4.0 * PI * share) - 1.0
}

/// Of all photons a share of 0.2261, by quadrature (`tests/tracers/forms.rs`).
fn falsely_lost(gpu: &Gpu, sources: &Sources) -> f64 {
    let set = [("light.side", "256"), ("maps.side", "16"), ("light.tracer", "wyman2005")];
    let counts = count(gpu, sources, &job_of(scene("glass-sphere", &[]), &set, "region", [8, 8])).counts;
    counts[2] as f64 / counts[0] as f64 - 0.2261
}

/// Every ray goes one radius of glass.
fn absorbed(gpu: &Gpu, sources: &Sources) -> f64 {
    let absorption = [0.1, 0.4, 2.0f64];
    let tint = [("absorption = 0.0", "absorption = [0.1, 0.4, 2.0]")];
    let mut scene = under_a_lamp("glass-sphere", &tint, [0.0; 3], 1.0);
    scene.paths = "transmit-1".parse().expect("a class");
    let kept = absorption.iter().map(|a| 1.0 - (-a).exp()).sum::<f64>() / 3.0;
    count(gpu, sources, &lamp_job(scene, "32")).flux_w[5] / (4.0 * PI * kept) - 1.0
}
