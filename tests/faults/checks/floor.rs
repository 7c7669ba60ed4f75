//! Light on the receiver: direct, below flat water, and both together where a sphere must vanish.

use super::{Check, mean, render, under_a_lamp};
use crate::common::picture::{Pixels, job_of, pixels_of_map, rewritten, scene, worst, written};
use glam::DVec3;
use nephroid::{
    gpu::{Gpu, Sources},
    image::Layers,
    optics::fresnel,
    renderer::Providers,
    truth::closed::{direct_point, flat_water},
};
use std::{collections::BTreeMap, f64::consts::PI};

/// Irradiance below coloured water under a coloured, slanted sun, band by band, by closed form.
pub static FLAT_WATER: Check = Check { name: "flat water, band by band", bound: EVEN, figure: below_water };
/// Radiance of that floor seen straight through the water, by closed form.
pub static THROUGH_WATER: Check = Check { name: "floor seen through water", bound: EVEN, figure: through_water };
/// A sheet of clear water vanishes in an even sky: R L + (1 − R) / n² · n² L.
pub static EVEN_SKY: Check = Check { name: "water in an even sky", bound: SKY, figure: in_an_even_sky };
/// Caustic and shadowed direct light of a sphere of index 1 under a slanted sun, in the sun's own view.
pub static NULL: Check = Check { name: "null test", bound: VANISHED, figure: null };
/// Direct light of a lamp, by closed form, and darkness in the shadow.
pub static DIRECT: Check = Check { name: "direct light by hand", bound: ROUNDING, figure: direct };
/// Radiance in the EXR is irradiance times albedo over π.
pub static LINEAR: Check = Check { name: "radiance is E·ρ/π", bound: PRODUCTS, figure: linear };

/// Measured 3e-7, for two photons a texel and axis fit evenly; allowed a quarter of what `closed_forms` allows to blocks
/// where photons beat against texels.
const EVEN: f64 = 5e-4;
/// Of the region's flux. Measured 4e-4; allowed five times that, for photons stand for whole texels of the light's view.
const VANISHED: f64 = 2e-3;
/// Of the brightest point. Measured 3e-7; allowed what `null` allows to float32 positions and products.
const ROUNDING: f64 = 2e-5;
/// Of the brightest pixel. Measured 5e-8; allowed some ten roundings of float32.
const PRODUCTS: f64 = 1e-6;

/// Of the sky. Some ten roundings of float32, one of them of an n² of its inverse's square.
const SKY: f64 = 5e-6;

/// Texels a side of the maps here.
const MAP: u32 = 64;
const SMALL: [(&str, &str); 3] = [("light.side", "256"), ("maps.side", "64"), ONE];
/// What is known by hand is known at the middle of each pixel.
const ONE: (&str, &str) = ("eye.samples", "1");
/// Pixels left out along the border: the reach of splat and look-up.
const BORDER: usize = 4;
/// Radii on each side of a shadow's edge that are not judged: pixels that see both.
const EDGE: f64 = 0.05;

fn below_water(gpu: &Gpu, sources: &Sources) -> f64 {
    let (cosine, absorption, sun) = (0.5f64, [0.1, 0.4, 0.8], [3.0, 2.0, 1.0]);
    let direction = format!("[{}, {}, 0.0]", (1.0 - cosine * cosine).sqrt(), -cosine);
    let (absorbs, shines) = (format!("{absorption:?}"), format!("{sun:?}"));
    let changed = [
        ("lights.sun.direction", direction.as_str()),
        ("lights.sun.irradiance", &shines),
        ("materials.water.absorption", &absorbs),
    ];
    let picture = render(gpu, sources, &job_of(scene("flat-water", &changed), &SMALL, "region", [MAP; 2]));
    let n = MAP as usize;
    let inner = |k: &usize| [k / n, k % n].iter().all(|at| (BORDER..n - BORDER).contains(at));
    let error = |band: usize| {
        let values = (0..n * n).filter(inner).map(|k| f64::from(picture.layer("irradiance.caustic")[3 * k + band]));
        mean(&values.collect::<Vec<_>>()) / flat_water(1.33, cosine, 1.0, absorption[band], sun[band]) - 1.0
    };
    worst((0..3).map(error))
}

/// Upwards through the surface, radiance shrinks by n²: L = (1 − R) / n² · E ρ / π. The sky that it reflects is black.
fn through_water(gpu: &Gpu, sources: &Sources) -> f64 {
    let above =
        "\n[cameras.above.orthographic]\nposition = [0, 2, 0]\ntarget = [0, 0, 0]\nup = [0, 0, -1]\nheight = 1.5\n";
    let scene = written(&rewritten("flat-water", &[], above), &[]);
    let picture = render(gpu, sources, &job_of(scene, &SMALL, "above", [16; 2]));
    let passes = 1.0 - fresnel(1.0, 1.0, 1.33);
    let exact = passes / (1.33 * 1.33) * flat_water(1.33, 1.0, 1.0, 0.0, 1.0) * 0.8 / PI;
    mean(&picture.mean("radiance")) / exact - 1.0
}

/// The floor is moved aside: what goes into the water leaves the scene in it.
fn in_an_even_sky(gpu: &Gpu, sources: &Sources) -> f64 {
    let sky = [("sky.gradient.zenith", "2"), ("sky.gradient.horizon", "2"), ("objects.floor.center", "[1000, -1, 0]")];
    let mut job = job_of(scene("flat-water", &sky), &[ONE], "main", [16; 2]);
    job.providers = Providers::default();
    let picture = render(gpu, sources, &job);
    worst(picture.layer("sky").iter().map(|&l| f64::from(l) / 2.0 - 1.0))
}

fn null(gpu: &Gpu, sources: &Sources) -> f64 {
    let (sine, cosine) = 40f64.to_radians().sin_cos();
    let direction = format!("[{sine}, {}, 0.0]", -cosine);
    let scene = scene("null", &[("lights.sun.direction", &direction)]);
    let set = [SMALL[0], ("maps.side", "128"), ("light.view", "shared"), ("eye.samples", "2")];
    let picture = render(gpu, sources, &job_of(scene, &set, "region", [MAP; 2]));
    let both = picture.sum("irradiance.direct") + picture.sum("irradiance.caustic");
    both / (cosine * f64::from(MAP * MAP)) - 1.0
}

fn direct(gpu: &Gpu, sources: &Sources) -> f64 {
    let (lamp, intensity) = (DVec3::new(1.6, 5.0, 0.4), 50.0);
    let mut job = job_of(under_a_lamp("glass-sphere", &[], lamp.into(), intensity), &[ONE], "region", [MAP; 2]);
    job.providers = Providers::default();
    let picture = render(gpu, sources, &job);
    let pixels = Pixels { region: &job.scene.region, size: job.size };
    let irradiance = picture.mean("irradiance.direct");
    let unshadowed: Vec<_> = pixels.centres().map(|p| direct_point(lamp, intensity, p, DVec3::Y)).collect();
    let errors = pixels.centres().enumerate().filter_map(|(k, p)| {
        // The ball is the unit sphere: how near to its centre does the light pass?
        let offset = p.cross((p - lamp).normalize()).length();
        let lit = if offset > 1.0 { unshadowed[k] } else { 0.0 };
        ((offset - 1.0).abs() > EDGE).then_some(irradiance[k] - lit)
    });
    worst(errors) / worst(unshadowed.iter().copied())
}

/// In the file, as it is read again: whatever the scene's exposure, layers are in absolute units.
fn linear(gpu: &Gpu, sources: &Sources) -> f64 {
    let albedo = [0.8, 0.5, 0.2];
    let changed = [("materials.white.albedo", format!("{albedo:?}")), ("exposure", "2.0".to_owned())];
    let changed: Vec<_> = changed.iter().map(|(key, value)| (*key, value.as_str())).collect();
    let job = job_of(scene("glass-sphere", &changed), &SMALL, "region", [pixels_of_map(MAP); 2]);
    let picture = render(gpu, sources, &job);
    let file = picture.layers.to_exr(&BTreeMap::new()).expect("an EXR file");
    let (layers, _) = Layers::from_exr(&file).expect("the file is read again");
    let layer = |name: &str| layers.get(name).expect("a layer").data().to_vec();
    let (radiance, direct, caustic) = (layer("radiance"), layer("irradiance.direct"), layer("irradiance.caustic"));
    let peak = worst(radiance.iter().map(|&v| f64::from(v)));
    worst((0..radiance.len()).map(|k| {
        let e = f64::from(direct[k]) + f64::from(caustic[k]);
        (f64::from(radiance[k]) - e * albedo[k % 3] / PI) / peak
    }))
}
