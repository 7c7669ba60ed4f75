//! Varying splats (Wyman 2008, section 3.3): what is not bent has splats of the printed size; levels hold what they should.

use nephroid::gpu::Gpu;

use super::common::{
    gpu, job,
    picture::{Picture, picture},
};

/// Photons lie half a map's texels apart or less: nothing is dropped, and what is in no level is lost.
const KEPT: f64 = 1e-4;
/// Of the mean, with splats twice as wide as photons lie apart: what their sum is uneven by (measured 1 %).
const EVEN: f64 = 0.03;

fn rendered(gpu: &Gpu, scene: &str, set: &[(&str, &str)]) -> Picture {
    let all: Vec<_> = set.iter().copied().chain([("maps.side", "128"), ("eye.samples", "2")]).collect();
    picture(gpu, &job(scene, &all, "region", [64, 64]))
}

fn spread(picture: &Picture) -> (f64, f64) {
    let caustic = picture.mean("irradiance.caustic");
    let mean = caustic.iter().sum::<f64>() / caustic.len() as f64;
    let squares = caustic.iter().map(|v| (v / mean - 1.0).powi(2)).sum::<f64>() / caustic.len() as f64;
    (mean, squares.sqrt())
}
