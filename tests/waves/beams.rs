//! `waves.variant=inverse` under lights that have a place: their beams, and the pictures that they project.

use glam::DVec3;
use nephroid::{
    gpu::Gpu,
    methods,
    optics::fresnel,
    renderer::{Job, Providers},
    scene::{LightKind, Scene},
};

use crate::{
    common::{
        gpu,
        picture::{Pixels, job_of, picture, png, worst},
    },
    inverse::{INVERSE, judged, light},
};

const SIZE: [u32; 2] = [64, 64];
/// m above the water, its depth, and its index.
const HEIGHT: f64 = 1.2;
const DEPTH: f64 = 1.0;
const IOR: f64 = 1.33;
/// W/sr
const INTENSITY: f64 = 5.0;

/// `inverse` of the flat water under one lamp at 0.1 m beside its middle.
fn under(kind: &str) -> Job {
    let text = Scene::load("flat-water", &[]).unwrap().source.text;
    let (above, _) = text.split_once("[lights.sun.directional]").expect("its sun");
    let lamp = format!("[lights.lamp.{kind}\nposition = [0.1, {HEIGHT}, 0.0]\nintensity = {INTENSITY}\n");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("slide.png"), slide()).unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, format!("{above}{lamp}")).unwrap();
    let scene = Scene::load(path.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{error}"));
    let providers = Providers::of(methods::find("waves").expect("waves is a method"));
    Job { providers, ..job_of(scene, &[INVERSE, ("eye.samples", "1")], "region", SIZE) }
}

/// Other colours at each corner.
fn slide() -> Vec<u8> {
    png(2, &[[250, 60, 20], [40, 200, 60], [90, 120, 250], [200, 200, 60]])
}

/// Rings of light about the foot of a lamp: rays at θ land at r = h tan θ + D tan θt, and share out I sin θ dθ over r dr. W/m² where
/// it sends alike everywhere, and the direction in which the light leaves it.
fn rings(job: &Job) -> Vec<(f64, DVec3)> {
    let landing = |a: f64| HEIGHT * a.tan() + DEPTH * (a.sin() / IOR).asin().tan();
    let at = |away: DVec3| {
        let r = away.length();
        let (mut low, mut high) = (0.0, 1.5);
        for _ in 0..60 {
            let middle: f64 = 0.5 * (low + high);
            if landing(middle) < r { low = middle } else { high = middle }
        }
        let slope = (landing(low + 1e-5) - landing(low - 1e-5)) / 2e-5;
        let spread = if r > 1e-6 { low.sin() / r } else { 1.0 / slope };
        let e = INTENSITY * (1.0 - fresnel(low.cos(), 1.0, IOR)) * spread / slope;
        (e, low.sin() * away.normalize_or_zero() - low.cos() * DVec3::Y)
    };
    let pixels = Pixels { region: &job.scene.region, size: job.size };
    pixels.centres().map(|p| at(p - DVec3::new(0.1, -DEPTH, 0.0))).collect()
}

#[test]
fn a_lamp_over_flat_water_is_its_rings() {
    let job = under("point]");
    let exact: Vec<f64> = rings(&job).into_iter().map(|(e, _)| e).collect();
    // Triangles of rays are as large as pixels here, each evenly lit: less than 1e-3 of a pixel, and none of the whole.
    let [relmse, energy] = judged(&light(&gpu(), &job), &exact, 1.0);
    println!("relmse {relmse:.1e}, energy {energy}");
    assert!(relmse < 1e-6 && (energy - 1.0).abs() < 1e-4, "{relmse:e}, {energy}");
}

/// Of each band, the lamp's rings times what it sends in the direction of their light: measured 3.9e-3 of the brightest, since
/// triangles of rays are evenly lit and as large as pixels.
#[test]
fn a_beam_and_its_picture_arrive_below_the_water() {
    let gpu = gpu();
    let with_edge = "spot]\ndirection = [0.1, -1, 0]\ninner = 5\nouter = 35";
    let with_slide = "spot]\ndirection = [0.1, -1, 0]\nouter = 60\nimage = \"slide.png\"";
    for kind in [with_edge, with_slide] {
        let off = off_rings(&gpu, &under(kind));
        println!("{kind}: {off:.1e}");
        assert!(off < 1.2e-2, "{kind}: {off:e}");
    }
}

/// The worst band of all pixels, over the brightest.
fn off_rings(gpu: &Gpu, job: &Job) -> f64 {
    let kind = &job.scene.lights[0].kind;
    assert!(matches!(kind, LightKind::Spot { .. }));
    let exact: Vec<f64> = rings(job).into_iter().flat_map(|(e, d)| (e * kind.share(d)).to_array()).collect();
    let shown = picture(gpu, job);
    let found = shown.layer("irradiance.caustic");
    worst(found.iter().zip(&exact).map(|(a, b)| f64::from(*a) - b)) / worst(exact)
}
