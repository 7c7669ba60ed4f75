//! The water of the shaders is that of the scene: heights and slopes of each kind against float64.

use crate::common::{Binder, Probe, assert_quiet, gpu};
use glam::{DVec2, DVec3};
use nephroid::{
    passes::water::Water,
    scene::{Relief, Ripple, Scene, Shape},
    truth::trace::{Ray, Space, mask},
};

/// `sine-water` under other water, 2 m by 2 m.
fn under(sheet: &str) -> Scene {
    let text = std::fs::read_to_string("scenes/sine-water.toml").unwrap();
    let from = text.find("[objects.water.sine]").unwrap();
    let to = from + text[from..].find("[objects.floor]").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.toml");
    std::fs::write(&file, format!("{}{sheet}\n{}", &text[..from], &text[to..])).unwrap();
    Scene::load(file.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{error}"))
}

const RECTANGLE: &str = "center = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\n";

/// Places that no grid has, the centre, a corner, and one beyond.
fn places() -> Vec<[f32; 2]> {
    let spread = (0..4000).map(|k| {
        let at = DVec2::new(0.754_877_666 * f64::from(k), 0.569_840_291 * f64::from(k)).fract() * 2.0 - 1.0;
        at.as_vec2().to_array()
    });
    spread.chain([[0.0, 0.0], [-1.0, -1.0], [1.0, 1.0]]).collect()
}

/// Largest errors of height, m, and slope, of what the shaders make of the scene's water.
fn errors(scene: &Scene, traced: bool, expected: impl Fn(DVec2) -> (f64, DVec2)) -> [f64; 2] {
    let gpu = gpu();
    let plan = &mut nephroid::gpu::Plan::default();
    let water = if traced { Water::as_traced(plan, scene) } else { Water::of(plan, scene) };
    let defines: Vec<(String, String)> = {
        let pass = water.expect("water").provide(plan.pass("probe"));
        pass.dispatch("probe.comp", [1, 1, 1], 1);
        plan.passes[0].defines.clone()
    };
    let defines: Vec<(&str, &str)> = defines.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    let probe = Probe {
        includes: &["shared/water.glsl"],
        input: "vec2 at;",
        output: "float height; vec2 slope; uint inside;",
        body: "r.height = water_height(q.at); r.slope = water_gradient(q.at); r.inside = uint(water_inside(q.at));",
        defines: &defines,
        ..Default::default()
    };
    let inputs = places();
    let outputs: Vec<[f32; 4]> = probe.run_with(&gpu, &inputs, |plan| -> Binder {
        let water = if traced { Water::as_traced(plan, scene) } else { Water::of(plan, scene) }.expect("water");
        Box::new(move |pass| water.provide(pass))
    });
    assert_quiet(&gpu);
    let mut most = [0.0_f64; 2];
    for (at, [height, x, y, inside]) in inputs.iter().zip(outputs) {
        let at = DVec2::from(at.map(f64::from));
        let (z, slope) = expected(at);
        assert_eq!(inside.to_bits(), 1, "{at}");
        let error = [(f64::from(height) - z).abs(), (DVec2::new(x.into(), y.into()) - slope).length()];
        most = [0, 1].map(|k| if error[k].is_nan() { f64::INFINITY } else { most[k].max(error[k]) });
    }
    println!("height {:.1e} m, slope {:.1e}", most[0], most[1]);
    most
}

fn relief(scene: &Scene) -> Relief {
    let water = scene.objects.iter().find(|object| object.name == "water").unwrap();
    let Shape::Mesh { mesh, .. } = &water.shape else { panic!("no mesh") };
    mesh.sheet.as_ref().unwrap().relief.clone()
}

/// Rounding of phases up to 160 rad in the finest octave, of heights of 0.04 m and slopes of 1.4: measured 1.4e-7 m, 6.6e-6.
const WAVE: [f64; 2] = [4e-7, 2e-5];
/// Of phases up to 300 rad: measured 1.9e-8 m, 3.3e-7.
const SEA: [f64; 2] = [1e-7, 2e-6];

#[test]
fn a_wave_is_that_of_the_scene_also_long_after() {
    for time in ["0.7", "1e6"] {
        let scene = under(&format!("[objects.water.wave]\n{RECTANGLE}grid = 4\ntime = {time}\n"));
        let Relief::Wave(wave) = relief(&scene) else { panic!("no wave") };
        let found = errors(&scene, false, |at| (wave.height(at), wave.gradient(at)));
        assert!(found[0] < WAVE[0] && found[1] < WAVE[1], "{found:?} at {time} s");
    }
}

#[test]
fn a_sea_is_that_of_the_scene_also_when_it_is_scaled() {
    let sheet = format!("[objects.water.sea]\n{RECTANGLE}grid = 4\nshortest = 0.06\nlongest = 2\ntime = 1e6\n");
    let scene = under(&format!(
        "{sheet}[objects.water.motion]\nscale = [{{ time = 0, value = 1 }}, {{ time = 1, value = 3 }}]\n"
    ));
    let sea = |scene: &Scene| match relief(scene) {
        Relief::Sea(waves) => waves,
        _ => panic!("no sea"),
    };
    let (waves, scene) = (sea(&scene), scene.at(0.5));
    let later = sea(&scene);
    assert_ne!(waves, later, "it runs on");
    // Twice as long and as high, the same slopes.
    let found =
        errors(&scene, false, |at| (2.0 * Ripple::height(&later, 0.5 * at), Ripple::gradient(&later, 0.5 * at)));
    assert!(found[0] < SEA[0] && found[1] < SEA[1], "{found:?}");
}

/// The triangles of a coarse sheet: what the truth meets from above.
#[test]
fn traced_water_is_its_triangles() {
    let scene = under(&format!("[objects.water.wave]\n{RECTANGLE}grid = 9\n"));
    let space = Space::new(&scene);
    let found = errors(&scene, true, |at| {
        let ray = Ray { o: DVec3::new(at.x, 1.0, -at.y), d: DVec3::NEG_Y, left: None };
        let met = space.nearest(&ray, mask::SPECULAR).expect("water");
        // The sheet's v is −z.
        (met.p.y, DVec2::new(-met.ns.x, met.ns.z) / met.ns.y)
    });
    assert!(found[0] < WAVE[0] && found[1] < WAVE[1], "{found:?}");
}
