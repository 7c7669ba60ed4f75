//! Splats that stand for several photons, or for what lies between them.

use super::{Check, render};
use crate::common::{
    job,
    picture::{Picture, job_of, scene, worst},
};
use nephroid::gpu::{Gpu, Sources};

/// Second moments of a map that is merged with exact books against those of one that is not.
pub static MOMENTS: Check = Check { name: "moments of the merged map", bound: MOMENT, figure: moments };
/// Flux that a merged map holds for each watt that arrives.
pub static BOOKS: Check = Check { name: "merged flux", bound: BOOK, figure: books };
/// Large splats drawn against the same ones summed.
pub static LARGE: Check = Check { name: "large splats", bound: DRAWN, figure: large };
/// How evenly ellipses light a floor through flat water.
pub static EVENLY: Check = Check { name: "evenness of ellipses", bound: UNEVEN, figure: evenly };

/// Texels². Measured 0.009: the variance of a sampled splat changes with where between texels it lies. Without their
/// covariance clusters lack 0.12.
const MOMENT: f64 = 0.02;
/// Measured 1e-8; allowed what sums of float32 in the pyramid may come to.
const BOOK: f64 = 1e-6;
/// Of the mean. Measured 2e-8; allowed the rounding of some hundred addends.
const DRAWN: f64 = 1e-6;
/// Of the mean. Measured 0.025; allowed what varying splats may come to (`tests/gathers/varying.rs`).
const UNEVEN: f64 = 0.07;

const MERGED: [(&str, &str); 4] =
    [("maps.merge", "exact"), ("maps.spread", "4"), ("light.side", "128"), ("maps.side", "64")];

fn render_of(gpu: &Gpu, sources: &Sources, set: &[(&str, &str)]) -> Picture {
    render(gpu, sources, &job("glass-sphere", set, "region", [16, 16]))
}

/// Variances of a map's flux along rows and columns, texels².
fn variances(picture: &Picture) -> [f64; 2] {
    let (map, side) = picture.map();
    let each = || (0..side * side).map(|at| ([at % side, at / side].map(|x| x as f64), f64::from(map[4 * at])));
    let total: f64 = each().map(|(_, flux)| flux).sum();
    [0, 1].map(|axis| {
        let moment =
            |about: f64, power| each().map(|(at, flux)| flux * (at[axis] - about).powi(power)).sum::<f64>() / total;
        moment(moment(0.0, 1), 2)
    })
}

fn moments(gpu: &Gpu, sources: &Sources) -> f64 {
    let merged = variances(&render_of(gpu, sources, &MERGED));
    let plain = variances(&render_of(gpu, &Sources::default(), &MERGED[2..]));
    worst(merged.iter().zip(plain).map(|(a, b)| a - b))
}

fn books(gpu: &Gpu, sources: &Sources) -> f64 {
    render_of(gpu, sources, &MERGED).energy.ratio.unwrap_or(f64::NAN) - 1.0
}

fn large(gpu: &Gpu, sources: &Sources) -> f64 {
    let of = |from: &str| {
        let set = [("maps.splat", "varying"), ("maps.raster_from", from), ("light.side", "41"), ("maps.side", "64")];
        render_of(gpu, sources, &set).mean("irradiance.caustic")
    };
    let (drawn, summed) = (of("8"), of("256"));
    let off = drawn.iter().zip(&summed).map(|(a, b)| (a - b).abs()).sum::<f64>();
    off / summed.iter().sum::<f64>()
}

fn evenly(gpu: &Gpu, sources: &Sources) -> f64 {
    let half = [("objects.water.quad.u", "[2.0, 0.0, 0.0]"), ("objects.water.quad.v", "[0.0, 0.0, -2.0]")];
    let set = [("maps.gather", "elliptic"), ("light.side", "37"), ("maps.side", "128")];
    let picture = render(gpu, sources, &job_of(scene("flat-water", &half), &set, "region", [61, 61]));
    // But for a border as wide as splats: what falls beside the floor is no photon of it.
    const BORDER: usize = 12;
    let (all, inner) = (picture.mean("irradiance.caustic"), BORDER..61 - BORDER);
    let seen: Vec<f64> = inner.clone().flat_map(|y| &all[y * 61..][inner.clone()]).copied().collect();
    let mean = super::mean(&seen);
    super::mean(&seen.iter().map(|v| (v / mean - 1.0).powi(2)).collect::<Vec<_>>()).sqrt()
}
