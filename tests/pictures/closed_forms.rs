//! Pictures and accounts against closed forms: the glass sphere, flat water, silhouettes.

use crate::common::{
    gpu,
    picture::{
        Picture, Pixels, account, flux_in_square, job_of, picture, pixels_of_map, rewritten, scene, worst, written,
    },
};
use glam::DVec3;
use nephroid::{
    gpu::Gpu,
    scene::Scene,
    truth::closed::{GlassSphere, Illumination, SphereCaustic, flat_water},
};
use std::f64::consts::PI;

/// Texels a side of the caustic map, and of one picture whose pixels are its texels.
const MAP: u32 = 512;
const PIXELS: u32 = pixels_of_map(MAP);

/// A splat of three texels and the bilinear look-up move light by up to two texels.
const BLUR: f64 = 2.0;
/// Share of the total by which the encircled flux may miss beyond the blur: the lattice of photons.
const ENCIRCLED: f64 = 0.002;
/// Map texels of an annulus that is wide beside the blur, and the share of its flux that may be wrong.
const ANNULUS: usize = 16;
const ANNULUS_ERROR: f64 = 0.01;
/// Dark annuli are judged against this share of the light without the sphere.
const DARK: f64 = 0.1;
/// Share of the flux through the region that may be lost or made.
const TOTAL: f64 = 0.001;
/// Share of what Fresnel sends on other paths; near grazing it changes within one photon's texel.
const OTHER_PATHS: f64 = 0.001;
/// Flat water is lit evenly, so only the beat of photons against the map's texels is left.
const WATER: f64 = 0.002;
/// Texels a side of the blocks over which flat water is judged, and how many from the border are left out: the splat's
/// and the look-up's reach.
const BLOCK: usize = 8;
const BORDER: usize = 4;
/// Lattice points in a circle of 128 texels' radius: measured in `silhouettes`, allowed by the same reason at any size.
const SILHOUETTE: f64 = 0.001;
/// How different another sphere's index, or its floor's distance, is, to be told apart.
const OTHER: f64 = 0.02;
/// Bins a texel of the radial histogram.
const BINS: f64 = 4.0;
/// Points along each edge of a pixel between which its flux is divided, to find how much lies inside a circle.
const SPLIT: usize = 3;

/// Flux within 0, 1, 2 … `bins` times `bin` metres of the region's centre.
fn encircled(picture: &Picture, pixels: &Pixels<'_>, bin: f64, bins: usize) -> Vec<f64> {
    let mut flux = vec![0.0; bins + 1];
    let share = pixels.area() / (SPLIT * SPLIT) as f64;
    for (index, e) in picture.mean("irradiance.caustic").into_iter().enumerate() {
        let (x, y) = (index % pixels.size[0] as usize, index / pixels.size[0] as usize);
        for k in 0..SPLIT * SPLIT {
            let within = |p: usize, k: usize| p as f64 + (k as f64 + 0.5) / SPLIT as f64;
            let r = (pixels.at(within(x, k % SPLIT), within(y, k / SPLIT)) - pixels.region.center).length();
            flux[((r / bin) as usize).min(bins)] += e * share;
        }
    }
    let mut sum = 0.0;
    let sums = flux[..bins].iter().map(|f| {
        sum += f;
        sum
    });
    std::iter::once(0.0).chain(sums).collect()
}

/// What of a picture of a caustic round the region's centre is wrong; `e0` is the region's mean irradiance without the
/// sphere.
fn faults(name: &str, picture: &Picture, scene: &Scene, truth: &SphereCaustic, e0: f64) -> Vec<String> {
    let pixels = Pixels { region: &scene.region, size: [PIXELS; 2] };
    let half = scene.region.u.length();
    let bin = 2.0 * half / f64::from(PIXELS) / BINS;
    let bins = (half / bin) as usize;
    let blur = (BLUR * BINS) as usize;
    let ours = encircled(picture, &pixels, bin, bins);
    let theirs = truth.table(&(0..=bins + blur).map(|k| k as f64 * bin).collect::<Vec<_>>());
    let total = flux_in_square(half, bin, |r| truth.encircled(r));

    // Between the radii of two bins both sides only grow, so that this holds for every radius.
    let beyond =
        (0..bins).flat_map(|k| [theirs[(k + 1).saturating_sub(blur)] - ours[k], ours[k + 1] - theirs[k + blur]]);
    let beyond = worst(beyond.map(|b| if b < 0.0 { 0.0 } else { b })) / total;
    let ring = ANNULUS * BINS as usize;
    let annuli = (0..bins / ring).map(|k| {
        let (a, b) = (k * ring, (k + 1) * ring);
        let (exact, area) = (theirs[b] - theirs[a], PI * bin * bin * (b * b - a * a) as f64);
        (ours[b] - ours[a] - exact).abs() / (exact + DARK * e0 * area)
    });
    let annulus = worst(annuli);
    let lost = worst([picture.sum("irradiance.caustic") * pixels.area() / total - 1.0]);
    println!("{name}: encircled {beyond:.5}, annulus {annulus:.5}, total {lost:.6}");
    let judged = [("encircled", beyond, ENCIRCLED), ("annulus", annulus, ANNULUS_ERROR), ("total", lost, TOTAL)];
    let wrong = judged.iter().filter(|(_, error, bound)| error > bound);
    wrong.map(|(what, error, bound)| format!("{what}: {error} of {bound}")).collect()
}

/// What the account says of the same light: Fresnel's share, and all that lands on the floor.
fn judge_account(name: &str, picture: &Picture, truth: &SphereCaustic, floor_half: f64) {
    let account = &picture.account;
    let other = truth.emitted() - truth.total() - truth.missed();
    let landed = flux_in_square(floor_half, 0.01, |r| truth.encircled(r));
    let ours = account.flux_w[1] + account.flux_w[7];
    println!(
        "{name}: emitted {:+.6}, other paths {:+.6}, landed {:+.6}",
        account.emitted_w() / truth.emitted() - 1.0,
        account.other_paths_w / other - 1.0,
        ours / landed - 1.0
    );
    assert!(
        (account.emitted_w() / truth.emitted() - 1.0).abs() <= SILHOUETTE,
        "{name}: emitted {}",
        account.emitted_w()
    );
    assert!(
        (account.other_paths_w - other).abs() <= OTHER_PATHS * truth.emitted(),
        "{name}: {}",
        account.other_paths_w
    );
    assert!((ours / landed - 1.0).abs() <= TOTAL, "{name}: {ours} W on the floor against {landed} W");
}

const SPHERE: [(&str, &str); 3] = [("light.side", "1024"), ("maps.side", "512"), ("eye.samples", "2")];
/// Half an edge of the floor of `glass-sphere`, m.
const FLOOR_HALF: f64 = 8.0;

fn sphere(gpu: &Gpu, floor: f64) {
    let center = format!("[0, {}, 0]", -floor);
    let scene = scene("glass-sphere", &[("objects.floor.quad.center", &center)]);
    let job = job_of(scene, &SPHERE, "region", [PIXELS; 2]);
    let picture = picture(gpu, &job);
    let truth = |ior, floor| {
        let glass = GlassSphere { radius: 1.0, ior, absorption: 0.0, floor };
        SphereCaustic::new(glass, Illumination::Parallel { irradiance: 1.0 }).unwrap()
    };
    let name = format!("glass-sphere, floor at {floor}");
    let found = faults(&name, &picture, &job.scene, &truth(1.5, floor), 1.0);
    assert!(found.is_empty(), "{name}: {found:?}");
    judge_account(&name, &picture, &truth(1.5, floor), FLOOR_HALF);
    // Another sphere's caustic must not pass for this one's.
    for (ior, floor) in [(1.5 + OTHER, floor), (1.5, floor * (1.0 + OTHER))] {
        assert!(!faults("  of another", &picture, &job.scene, &truth(ior, floor), 1.0).is_empty(), "{name}");
    }
}

#[test]
fn a_glass_spheres_caustic_under_the_sun() {
    let gpu = gpu();
    for floor in [1.2, 1.5, 2.0] {
        sphere(&gpu, floor);
    }
}

/// Flat water under a sun whose angle from the zenith has this cosine, on a picture of `pixels` map texels a side.
fn water(gpu: &Gpu, cosine: f64, absorption: f64, floor: f64, pixels: u32) {
    let direction = format!("[{}, {}, 0.0]", (1.0 - cosine * cosine).sqrt(), -cosine);
    let (absorbs, u, v) = (absorption.to_string(), format!("[{floor}, 0, 0]"), format!("[0, 0, -{floor}]"));
    let changed = [
        ("lights.sun.direction", direction.as_str()),
        ("materials.water.absorption", &absorbs),
        ("objects.floor.quad.u", &u),
        ("objects.floor.quad.v", &v),
    ];
    let picture = picture(gpu, &job_of(scene("flat-water", &changed), &SPHERE, "region", [pixels; 2]));
    let exact = flat_water(1.33, cosine, 1.0, absorption, 1.0);
    let caustic = picture.mean("irradiance.caustic");
    let n = pixels as usize;
    let total = caustic.iter().sum::<f64>() / (n * n) as f64 / exact - 1.0;
    let blocks = (n - 2 * BORDER) / BLOCK;
    let block = |k: usize| {
        let (x, y) = (BORDER + BLOCK * (k % blocks), BORDER + BLOCK * (k / blocks));
        let texels = (0..BLOCK * BLOCK).map(|t| caustic[(y + t / BLOCK) * n + x + t % BLOCK]);
        texels.sum::<f64>() / (BLOCK * BLOCK) as f64 / exact - 1.0
    };
    let worst = worst((0..blocks * blocks).map(block));
    let name = format!("flat-water, cosine {cosine:.2}, absorption {absorption}, floor ±{floor}");
    println!("{name}: total {total:+.6}, worst block {worst:.6} of {WATER}");
    assert!(total.abs() <= WATER, "{name}: total {total} off");
    assert!(worst <= WATER, "{name}: a block is {worst} off");
    if cosine == 1.0 {
        // Slanted, the sun also shines in below the sheet's edge.
        assert_eq!(picture.sum("irradiance.direct"), 0.0, "{name}: the water takes all of the sun's own light");
    }
}

#[test]
fn flat_water_is_lit_evenly() {
    let gpu = gpu();
    let slanted = 60f64.to_radians().cos();
    // The map ends with the floor, so that its texels are the picture's 512 pixels.
    for (cosine, absorption) in [(1.0, 0.0), (slanted, 0.0), (slanted, 0.5)] {
        water(&gpu, cosine, absorption, 1.0, MAP);
    }
    // A floor that goes on: the map has its margin, and 512 photons beat against 507 texels.
    water(&gpu, 1.0, 0.0, 1.5, PIXELS);
}

/// Steradians of a unit sphere seen from a point.
fn solid_angle(from: DVec3) -> f64 {
    2.0 * PI * (1.0 - (1.0 - 1.0 / from.length_squared()).sqrt())
}

#[test]
fn the_flux_emitted_is_that_through_the_silhouette() {
    let gpu = gpu();
    let suns = ["[0, -1, 0]", "[1, -1.2, 0.3]", "[0.2, -0.1, -1]"];
    let lamps = [DVec3::new(0.0, 4.0, 0.0), DVec3::new(2.5, 3.0, -1.0), DVec3::new(0.7, 0.8, 0.3), DVec3::Y * 1.01];
    let point = rewritten("glass-sphere", &[], "\n[lights.lamp.point]\nposition = [0, 9, 0]\nintensity = 2.0\n");
    for side in ["256", "512", "1024"] {
        let judge = |what: &str, scene: Scene, exact: f64| {
            let job = job_of(scene, &[("light.side", side)], "region", [8, 8]);
            let error = account(&gpu, &job).emitted_w() / exact - 1.0;
            println!("{what}, light.side {side}: {error:+.6}");
            assert!(error.abs() <= SILHOUETTE, "{what}: {error} off at light.side {side}");
        };
        for sun in suns {
            judge(sun, scene("glass-sphere", &[("lights.sun.direction", sun)]), PI);
        }
        for lamp in lamps {
            let mut scene = written(&point, &[]);
            scene.lights.retain(|l| l.name == "lamp");
            let nephroid::scene::LightKind::Point { position, .. } = &mut scene.lights[0].kind else { unreachable!() };
            *position = lamp;
            judge(&format!("{lamp}"), scene, 2.0 * solid_angle(lamp));
        }
    }
}
