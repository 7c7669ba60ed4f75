//! The caustic itself: where its light lies, and whether all of it is there.

use super::{Check, render};
use crate::common::picture::{Picture, Pixels, flux_in_square, job_of, pixels_of_map, scene, worst};
use glam::DVec3;
use nephroid::{
    gpu::{Gpu, Sources},
    metrics::{Pair, bare_irradiance, relmse},
    renderer::Job,
    truth::{
        Estimator, Goal, Run, Task,
        closed::{GlassSphere, Illumination, SphereCaustic},
        trace::Space,
    },
};
use std::{ops::ControlFlow, sync::OnceLock};

/// Flux inside circles below the glass sphere, by closed form.
pub static SPHERE: Check = Check { name: "glass sphere's encircled flux", bound: ENCIRCLED, figure: encircled };
/// The flux-weighted centre of that caustic, which lies on the axis; in texels of the map.
pub static CENTRE: Check = Check { name: "centre of the caustic", bound: OFF_CENTRE, figure: off_centre };
/// Flux in the finished map against that of the photons it took.
pub static DEPOSITED: Check = Check { name: "deposited is what was valid", bound: SHARE, figure: deposited };
/// The judged figure of the bunny's caustic against the float64 truth.
pub static TRUTH: Check = Check { name: "relMSE against the truth", bound: RELMSE, figure: against_truth };

/// Of the region's flux. Measured 1.0e-3; allowed four times that, for splat and look-up move light across a circle.
const ENCIRCLED: f64 = 4e-3;
/// Texels. Measured 4e-6, for photons, map and pixels lie evenly about the axis; allowed the beat of lattices that do not.
const OFF_CENTRE: f64 = 0.02;
/// Measured 4e-7; allowed what `energy` allows: float32 sums in texels, weights that sum to one.
const SHARE: f64 = 0.001;
/// Measured 2.9e-3, of which 1.5e-3 are the truth's own noise; allowed three times that, for splats blur the folds.
const RELMSE: f64 = 0.01;

/// Texels a side of the map, and pixels that are its texels.
const MAP: u32 = 128;
const PIXELS: u32 = pixels_of_map(MAP);
const SMALL: [(&str, &str); 3] = [("light.side", "256"), ("maps.side", "128"), ("eye.samples", "1")];
/// The circles' radii, m.
const RADII: [f64; 3] = [0.25, 0.5, 1.0];
/// m about the axis within which the centre is sought.
const WITHIN: f64 = 1.0;

fn sphere_job() -> Job {
    job_of(scene("glass-sphere", &[]), &SMALL, "region", [PIXELS; 2])
}

/// Each pixel's place from the axis (m) and its flux (W).
fn lit(picture: &Picture, job: &Job) -> Vec<(DVec3, f64)> {
    let pixels = Pixels { region: &job.scene.region, size: job.size };
    let flux = picture.mean("irradiance.caustic").into_iter().map(|e| e * pixels.area());
    pixels.centres().map(|p| p - job.scene.region.center).zip(flux).collect()
}

fn encircled(gpu: &Gpu, sources: &Sources) -> f64 {
    let job = sphere_job();
    let pixels = lit(&render(gpu, sources, &job), &job);
    let glass = GlassSphere { radius: 1.0, ior: 1.5, absorption: 0.0, floor: 1.5 };
    let truth = SphereCaustic::new(glass, Illumination::Parallel { irradiance: 1.0 }).expect("in its domain");
    let total = flux_in_square(1.5, 0.01, |r| truth.encircled(r));
    let within = |r: f64| pixels.iter().filter(|(p, _)| p.length() < r).map(|(_, flux)| flux).sum::<f64>();
    let circles = RADII.map(|r| within(r) - truth.encircled(r));
    worst(circles.into_iter().chain([within(f64::INFINITY) - total])) / total
}

fn off_centre(gpu: &Gpu, sources: &Sources) -> f64 {
    let job = sphere_job();
    let pixels = lit(&render(gpu, sources, &job), &job);
    let near = || pixels.iter().filter(|(p, _)| p.length() < WITHIN);
    let moment = near().map(|(p, flux)| *p * *flux).sum::<DVec3>();
    let texel = 2.0 * job.scene.region.u.length() / f64::from(PIXELS);
    moment.length() / near().map(|(_, flux)| flux).sum::<f64>() / texel
}

fn deposited(gpu: &Gpu, sources: &Sources) -> f64 {
    let picture = render(gpu, sources, &job_of(scene("glass-sphere", &[]), &SMALL, "region", [8, 8]));
    picture.energy.ratio.unwrap_or(f64::NAN) - 1.0
}

/// Interpolated normals, no symmetry, light from the side.
fn against_truth(gpu: &Gpu, sources: &Sources) -> f64 {
    static TRUTH: OnceLock<(Vec<f64>, f64)> = OnceLock::new();
    let set = [("light.side", "512"), ("maps.side", "256"), ("eye.samples", "3")];
    let job = job_of(scene("bunny", &[]), &set, "region", [72, 51]);
    let (reference, e0) = TRUTH.get_or_init(|| truth_of(&job));
    let picture = render(gpu, sources, &job);
    let image = picture.layer("irradiance.caustic").iter().map(|&v| f64::from(v)).collect();
    relmse(&Pair::new(3, image, reference.clone(), None).expect("pictures of one size"), *e0).value
}

/// The truth's caustic in the pixels of a job, and E₀.
fn truth_of(job: &Job) -> (Vec<f64>, f64) {
    let goal = Goal { photons: Some(400_000), noise: None };
    let (estimator, paths) = (Estimator::Photons, job.scene.paths);
    let task = Task { estimator, paths, camera: job.camera.clone(), size: job.size, seed: 1, goal };
    let space = Space::new(&job.scene);
    let mut run = Run::new(&space, &job.scene.cameras[&job.camera], &task);
    run.advance(4, |_, _| ControlFlow::Continue(()));
    let layers = run.layers().expect("the truth's layers");
    let caustic = layers.get("irradiance.caustic").expect("a caustic").data();
    (caustic.iter().map(|&v| f64::from(v)).collect(), bare_irradiance(&job.scene))
}
