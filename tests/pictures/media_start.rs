//! Light and sight that start inside a medium: it absorbs from there to the first surface, whatever that surface is.

use crate::common::{
    assert_quiet, gpu,
    picture::{Picture, job_of, picture, rewritten, scene, worst, written},
};
use glam::{DVec2, DVec3};
use nephroid::{
    gpu::{Gpu, Sources},
    optics::fresnel,
    passes::{extents, eye},
    renderer::{Frame, Job, Renderer},
    scene::{MaterialKind, Scene},
    truth::closed::{direct_parallel, direct_point, flat_water},
};
use std::f64::consts::PI;

const SIZE: [u32; 2] = [24, 24];
const SMALL: [(&str, &str); 2] = [("light.side", "256"), ("maps.side", "128")];
/// Positions, a distance's exponential and a few products in float32.
const ROUNDING: f64 = 2e-5;
/// The mean of a map over a part of the floor: the lattice of photons.
const LATTICE: f64 = 0.005;
/// As [`LATTICE`]; photons of six faces are sparser, and splats blur where total reflection sets in.
const MIRRORED: f64 = 0.01;
/// Directions traced in float32 that the sphere bends, and branches below 10⁻⁴ that are left.
const TRACED: f64 = 2e-4;
/// Flux through a dielectric at one texel of solid angle each, float32 sums of 64.
const SUMS: f64 = 1e-4;
/// What the floor sends back (`white`).
const ALBEDO: f64 = 0.8;
/// 1/m
const ABSORPTION: [f64; 3] = [3.0, 1.0, 0.25];
const TINT: &str = "[3.0, 1.0, 0.25]";

/// Where each pixel's ray meets the plane y = `floor`, and its length, m.
fn seen(job: &Job, floor: f64) -> Vec<(DVec3, f64)> {
    let camera = job.camera().unwrap();
    let view = eye::view(camera, job.size, &extents::everything(&job.scene));
    let [w, h] = job.size;
    let at = |k: u32| DVec2::new(f64::from(k % w) + 0.5, f64::from(k / w) + 0.5) / DVec2::new(w.into(), h.into());
    let pixels = (0..w * h).map(|k| view.ray(at(k)));
    pixels.map(|(o, d)| (o + d * ((floor - o.y) / d.y), (view.origin.y - floor) / -d.y)).collect()
}

/// The worst share by which a layer's bands differ from what is expected at each pixel.
fn differs(picture: &Picture, layer: &str, exact: impl Fn(usize, usize) -> f64) -> f64 {
    worst(picture.layer(layer).iter().enumerate().map(|(k, v)| f64::from(*v) / exact(k / 3, k % 3) - 1.0))
}

/// `flat-water`, tinted, the eye 0.2 m below its surface; under the sun, or under a lamp of 2 W/sr in the water.
fn under_water(lamp: Option<DVec3>, more: &str) -> Scene {
    let text = rewritten("flat-water", &[("absorption = 0.0", &format!("absorption = {TINT}"))], more);
    let place = lamp.unwrap_or_default();
    let point = format!("\n[lights.lamp.point]\nposition = [{}, {}, {}]\nintensity = 2.0\n", place.x, place.y, place.z);
    let mut scene = written(&(text + &point), &[]);
    scene.lights.retain(|light| (light.name == "lamp") == lamp.is_some());
    let camera = scene.cameras.get_mut("main").unwrap();
    (camera.position, camera.target) = (DVec3::new(0.1, -0.2, 0.2), DVec3::new(0.05, -1.0, -0.1));
    scene
}

#[test]
fn an_eye_under_water_sees_the_floor_through_the_water() {
    let job = job_of(under_water(None, ""), &SMALL, "main", SIZE);
    let (picture, seen) = (picture(&gpu(), &job), seen(&job, -1.0));
    let irradiance = picture.layer("irradiance.caustic");
    let way = |pixel: usize, band: usize| ALBEDO / PI * (-ABSORPTION[band] * seen[pixel].1).exp();
    let error = differs(&picture, "caustic", |p, b| f64::from(irradiance[3 * p + b]) * way(p, b));
    println!("radiance of what the map holds: {error:.1e}");
    assert!(error <= ROUNDING, "{error}");
    for (band, absorption) in ABSORPTION.into_iter().enumerate() {
        let exact = flat_water(1.33, 1.0, 1.0, absorption, 1.0);
        let theirs: f64 = (0..seen.len()).map(|p| exact * way(p, band)).sum();
        let ours: f64 = picture.layer("radiance").iter().skip(band).step_by(3).map(|v| f64::from(*v)).sum();
        println!("band {band}: {:+.5} of {LATTICE}", ours / theirs - 1.0);
        assert!((ours / theirs - 1.0).abs() <= LATTICE, "band {band}: {ours} for {theirs}");
    }
}

#[test]
fn a_lamp_under_water_lights_the_floor_through_the_water() {
    let lamp = DVec3::new(-0.3, -0.4, 0.1);
    let job = job_of(under_water(Some(lamp), ""), &SMALL, "main", SIZE);
    let (picture, seen) = (picture(&gpu(), &job), seen(&job, -1.0));
    let e = |pixel: usize, band: usize| {
        let p = seen[pixel].0;
        direct_point(lamp, 2.0, p, DVec3::Y) * (-ABSORPTION[band] * (p - lamp).length()).exp()
    };
    let left = |pixel: usize, band: usize| ALBEDO / PI * (-ABSORPTION[band] * seen[pixel].1).exp();
    let irradiance = differs(&picture, "irradiance.direct", e);
    let radiance = differs(&picture, "direct", |p, b| e(p, b) * left(p, b));
    println!("irradiance {irradiance:.1e}, radiance {radiance:.1e}");
    assert!(irradiance <= ROUNDING && radiance <= ROUNDING, "{irradiance} {radiance}");
}

/// A mirror beside the lamp: its light's first surface is no interface. The water above reflects too: two images.
#[test]
fn a_mirror_under_water_is_lit_through_the_water() {
    let wall = "\n[objects.wall]\nmaterial = \"silver\"\n[objects.wall.quad]\ncenter = [0.8, -0.5, 0]\nu = [0, 0, 1]\n\
                v = [0, 0.5, 0]\n[materials.silver.mirror]\nreflectance = 0.9\n";
    let lamp = DVec3::new(0.4, -0.5, 0.1);
    let set = [SMALL[0], SMALL[1], ("light.paths", "reflect-1")];
    let job = job_of(under_water(Some(lamp), wall), &set, "main", SIZE);
    let (picture, seen) = (picture(&gpu(), &job), seen(&job, -1.0));
    let from = |image: DVec3, p: DVec3, band: usize| {
        direct_point(image, 2.0, p, DVec3::Y) * (-ABSORPTION[band] * (p - image).length()).exp()
    };
    let (beside, above) = (DVec3::new(1.2, -0.5, 0.1), DVec3::new(0.4, 0.5, 0.1));
    for band in 0..3 {
        let exact = |p: DVec3| {
            let cosine = (above - p).normalize().y;
            0.9 * from(beside, p, band) + fresnel(cosine, 1.33, 1.0) * from(above, p, band)
        };
        let theirs: f64 = seen.iter().map(|(p, _)| exact(*p)).sum();
        let ours: f64 = picture.layer("irradiance.caustic").iter().skip(band).step_by(3).map(|v| f64::from(*v)).sum();
        println!("band {band}: {:+.5} of {MIRRORED}", ours / theirs - 1.0);
        assert!((ours / theirs - 1.0).abs() <= MIRRORED, "band {band}: {ours} for {theirs}");
    }
}

#[test]
fn an_eye_at_the_centre_of_a_ball_looks_out_through_its_glass() {
    let changed = [
        ("materials.glass.absorption", TINT),
        ("lights.sun.direction", "[1.0, -0.5, 0.0]"),
        ("cameras.main.pinhole.position", "[0, 0, 0]"),
        ("cameras.main.pinhole.target", "[-0.5, -1.5, 0]"),
        ("cameras.main.pinhole.fov_y", "20"),
    ];
    let job = job_of(scene("glass-sphere", &changed), &SMALL, "main", SIZE);
    let picture = picture(&gpu(), &job);
    let floor = ALBEDO / PI * direct_parallel(DVec3::new(1.0, -0.5, 0.0).normalize(), DVec3::Y, 1.0);
    // Out at right angles, or after two reflections of 4 %, each one diameter on; radiance grows by the index squared.
    let exact = |_, band: usize| {
        let once = (-ABSORPTION[band]).exp();
        floor * 0.96 * 2.25 * once * (1.0 + 0.04f64.powi(2) * once.powi(4))
    };
    let error = differs(&picture, "direct", exact);
    println!("floor through the glass: {error:.1e}");
    assert!(error <= TRACED, "{error}");
}

#[test]
fn a_lamp_at_the_centre_of_a_ball_loses_to_the_glass_on_its_first_way() {
    let text = rewritten("glass-sphere", &[("absorption = 0.0", "absorption = 0.7")], "");
    let mut scene = written(&(text + "\n[lights.lamp.point]\nposition = [0, 0, 0]\nintensity = 1.0\n"), &[]);
    scene.lights.retain(|light| light.name == "lamp");
    let set = [SMALL[0], SMALL[1], ("light.paths", "transmit-1")];
    let account = picture(&gpu(), &job_of(scene, &set, "region", SIZE)).account;
    let left = (-0.7f64).exp();
    for (what, ours, exact) in [
        ("absorbed", account.flux_w[5], 4.0 * PI * (1.0 - left)),
        ("reflected", account.other_paths_w, 4.0 * PI * 0.04 * left),
    ] {
        println!("{what}: {:+.1e} of {SUMS}", ours / exact - 1.0);
        assert!((ours / exact - 1.0).abs() <= SUMS, "{what}: {ours} for {exact}");
    }
}

/// Every layer's bits, with shaders of one's own.
fn bits(gpu: &Gpu, job: &Job, sources: Sources) -> Vec<u32> {
    let mut renderer = Renderer::with_sources(gpu, job, sources).unwrap();
    renderer.frame(&Frame::default()).unwrap();
    let layers = renderer.layers().unwrap();
    assert_quiet(gpu);
    layers.iter().flat_map(|layer| layer.data().iter().map(|v| v.to_bits()).collect::<Vec<_>>()).collect()
}

/// The shipped shaders with one function's answer replaced by "all passes".
fn clear(file: &str, answer: &str) -> Sources {
    let mut sources = Sources::default();
    let text = sources.text(file).unwrap().to_owned();
    assert!(text.contains(answer), "{file} holds no {answer}");
    sources.replace(file, text.replace(answer, "return vec3(1.0);"));
    sources
}

const MEDIUM: (&str, &str) = (
    "shared/transport.glsl",
    "return medium == MEDIUM_AIR ? vec3(1.0) : absorb(scene_materials.data[medium].absorption, metres);",
);
const EYE: (&str, &str) = ("eye/medium.glsl", "return medium_transmits(innermost(frame.data.eye_media), metres);");

/// With nothing that absorbs, media change no bit; nor does the eye's own medium where the eye is in air.
#[test]
fn what_does_not_absorb_changes_no_bit() {
    let gpu = gpu();
    for name in ["glass-sphere", "flat-water"] {
        let of = |absorption: &str| {
            let mut scene = scene(name, &[]);
            for material in &mut scene.materials {
                if let MaterialKind::Dielectric { absorption: a, .. } = &mut material.kind {
                    *a = [absorption.parse().unwrap(); 3];
                }
            }
            job_of(scene, &SMALL, "main", SIZE)
        };
        let (none, some) = (bits(&gpu, &of("0"), Sources::default()), bits(&gpu, &of("2"), Sources::default()));
        assert_eq!(none, bits(&gpu, &of("0"), clear(MEDIUM.0, MEDIUM.1)), "{name}");
        assert_eq!(some, bits(&gpu, &of("2"), clear(EYE.0, EYE.1)), "{name}, tinted");
        assert_ne!(none, some, "{name}: what absorbs shows");
    }
}
