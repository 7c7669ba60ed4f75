//! Boxes, disks, tubes and bowls through the whole renderer: against the truth, against closed forms, and vanishing.

use crate::common::{
    gpu,
    picture::{Pixels, job_of, picture, pixels_of_map, rewritten, scene, worst, written},
};
use glam::{DVec2, DVec3};
use nephroid::{
    optics::fresnel,
    passes::{extents, eye},
    scene::{PathClass, Scene},
    truth::{
        closed::SineWater,
        light::Photons,
        trace::{Ray, Space, mask},
    },
};
use rayon::prelude::*;
use std::f64::consts::TAU;

const SETTINGS: [(&str, &str); 3] = [("light.side", "512"), ("maps.side", "128"), ("eye.samples", "1")];
/// Flux of a class by 512² photons against the truth: the lattice at the shapes' outlines, and the truth's noise.
const FLUX: f64 = 0.005;
/// Photons of the truth: a class that holds a tenth of the light is known to one part in a thousand.
const CHUNKS: u64 = 32;
const PER_CHUNK: u64 = 1 << 16;
/// Below a slab every ray is bent alike: float32, and the beat of photons against texels.
const SLAB: f64 = 0.002;
/// Share of the region's flux that a box of index 1 may take or make, as in `null`.
const VANISHED: f64 = 0.001;

/// Flux that lands on anything diffuse, mean of the bands, W.
fn landed(scene: &Scene, class: PathClass) -> f64 {
    let space = Space::new(scene);
    let photons = Photons::new(&space, class, 5, PER_CHUNK);
    let of_chunk = |k: u64| photons.chunk(k, |_| {}).landed.element_sum() / 3.0;
    (0..CHUNKS).into_par_iter().map(of_chunk).sum::<f64>() / CHUNKS as f64
}

#[test]
fn every_class_carries_the_truths_flux() {
    let gpu = gpu();
    for class in [PathClass::Reflect1, PathClass::Transmit1, PathClass::Transmit2] {
        let mut scene = written(include_str!("../common/shapes.toml"), &[]);
        scene.paths = class;
        let exact = landed(&scene, class);
        let account = picture(&gpu, &job_of(scene, &SETTINGS, "main", [64; 2])).account;
        let ours = account.flux_w[1] + account.flux_w[7];
        println!("{class}: {ours:.5} W, {:+.5} of {FLUX}", ours / exact - 1.0);
        assert!((ours / exact - 1.0).abs() <= FLUX, "{class}: {ours} W for {exact} W");
    }
}

/// The ball of `glass-sphere` replaced.
fn instead_of_the_ball(name: &str, shape: &str, replaced: &[(&str, &str)]) -> Scene {
    let ball = "[objects.ball.sphere]\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0\n";
    let all: Vec<_> = replaced.iter().copied().chain([(ball, shape)]).collect();
    written(&rewritten(name, &all, ""), &[])
}

#[test]
fn below_a_slab_of_glass_light_is_dimmed_by_its_two_faces_and_its_depth() {
    let slab = "[objects.ball.box]\ncenter = [0.0, 0.0, 0.0]\nhalf = [1.0, 0.25, 1.0]\n";
    let scene = instead_of_the_ball("glass-sphere", slab, &[("absorption = 0.0", "absorption = 0.7")]);
    let exact = (1.0 - fresnel(1.0, 1.0, 1.5)).powi(2) * (-0.7f64 * 0.5).exp();
    let picture = picture(&gpu(), &job_of(scene, &SETTINGS, "region", [64; 2]));
    let pixels = Pixels { region: &picture.renderer.scene().region, size: [64; 2] };
    let caustic = picture.mean("irradiance.caustic");
    let below: Vec<f64> =
        pixels.centres().zip(&caustic).filter(|(p, _)| p.x.abs().max(p.z.abs()) < 0.9).map(|(_, e)| *e).collect();
    let mean = below.iter().sum::<f64>() / below.len() as f64;
    println!("below the slab {:+.5}", mean / exact - 1.0);
    assert!((mean / exact - 1.0).abs() <= SLAB, "{mean} for {exact}");
    let beside = pixels.centres().zip(&caustic).filter(|(p, _)| p.x.abs().max(p.z.abs()) > 1.1).map(|(_, e)| *e);
    assert_eq!(worst(beside), 0.0, "none beside it");
}

#[test]
fn a_box_of_index_one_vanishes() {
    let turned = "[objects.ball.box]\ncenter = [0.0, 0.0, 0.0]\nhalf = [0.5, 0.4, 0.6]\nrotate = [20, 30, 40]\n";
    let scene = instead_of_the_ball("null", turned, &[]);
    let set = [("light.side", "512"), ("maps.side", "128"), ("eye.samples", "4")];
    let picture = picture(&gpu(), &job_of(scene, &set, "region", [123; 2]));
    let mean = (picture.sum("irradiance.direct") + picture.sum("irradiance.caustic")) / (123.0 * 123.0);
    println!("region {:+.6}", mean - 1.0);
    assert!((mean - 1.0).abs() <= VANISHED, "{mean} W/m²");
    let lost = picture.account.flux_w[1] / picture.account.emitted_w() - 1.0;
    assert!(lost.abs() <= 1e-5, "{lost} of the light does not come through");
}

/// What the eye sees, pixel by pixel: the shape that a float64 ray through the pixel's middle meets first.
#[test]
fn the_eye_sees_each_shape_where_it_is() {
    const SIDE: u32 = 96;
    /// Pixels whose middle lies on an outline, of 9216.
    const OUTLINE: usize = 4;
    let scene = written(include_str!("../common/shapes.toml"), &[]);
    let cameras = [
        ("main", DVec3::new(0.0, 3.0, 6.0)),
        ("low", DVec3::new(-3.0, 0.3, 2.5)),
        ("inside", DVec3::new(0.0, 0.6, -0.5)),
    ];
    for (name, position) in cameras {
        let mut scene = scene.clone();
        let mut camera = scene.cameras["main"].clone();
        camera.position = position;
        scene.cameras.insert(name.to_owned(), camera.clone());
        let (space, view) = (Space::new(&scene), eye::view(&camera, [SIDE; 2], &extents::everything(&scene)));
        let specular = |pixel: u32| {
            let at = DVec2::new(f64::from(pixel % SIDE) + 0.5, f64::from(pixel / SIDE) + 0.5) / f64::from(SIDE);
            let (o, d) = view.ray(at);
            let seen = space.nearest(&Ray { o, d, left: None }, mask::ALL);
            seen.is_some_and(|s| space.material(&s).is_specular())
        };
        let expected: Vec<bool> = (0..SIDE * SIDE).map(specular).collect();
        let picture = picture(&gpu(), &job_of(scene.clone(), &SETTINGS, name, [SIDE; 2]));
        let mask = picture.layer("mask");
        let seen: Vec<bool> = mask.chunks(mask.len() / expected.len()).map(|m| m[0] > 0.5).collect();
        let differ = seen.iter().zip(&expected).filter(|(a, b)| a != b).count();
        println!("{name}: {differ} pixels differ");
        assert!(differ <= OUTLINE && seen.iter().any(|s| *s), "{name}: {differ} pixels differ");
    }
}

/// Strips of the floor under `sine-water`, across its waves, and the share of a strip's flux that may be wrong: a splat and
/// the look-up move light by two texels of 31 from a fold near its side.
const STRIPS: usize = 16;
const STRIP: f64 = 0.01;

#[test]
fn below_a_wave_each_strip_has_its_light() {
    const PIXELS: u32 = pixels_of_map(512);
    let set = [("light.side", "1024"), ("maps.side", "512"), ("eye.samples", "2")];
    let picture = picture(&gpu(), &job_of(scene("sine-water", &[]), &set, "region", [PIXELS; 2]));
    let water = SineWater::new(0.02, TAU / 0.5, 0.8, 1.33).unwrap();
    let (caustic, n) = (picture.mean("irradiance.caustic"), PIXELS as usize);
    // The light of a column of pixels, shared out among the strips that it overlaps.
    let mut flux = [0.0; STRIPS];
    for column in 0..n {
        let mean = (0..n).map(|row| caustic[row * n + column]).sum::<f64>() / n as f64;
        for (strip, sum) in flux.iter_mut().enumerate() {
            let [from, to] = [strip, strip + 1].map(|k| k as f64 / STRIPS as f64 * n as f64);
            *sum += mean * (to.min(column as f64 + 1.0) - from.max(column as f64)).max(0.0) / n as f64;
        }
    }
    let exact = |k: usize| {
        let [from, to] = [k, k + 1].map(|k| k as f64 / STRIPS as f64 - 0.5);
        water.flux(from, to)
    };
    let errors: Vec<f64> = flux.iter().enumerate().map(|(k, ours)| ours / exact(k) - 1.0).collect();
    println!("strips {errors:+.4?}");
    assert!(worst(errors) <= STRIP);
}
