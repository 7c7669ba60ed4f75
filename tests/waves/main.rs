//! The method `waves`: each variant is what its equations say, and has an answer everywhere.

mod bands;
mod beams;
mod chosen;
#[path = "../common/mod.rs"]
mod common;
mod cross;
mod discs;
mod eye;
mod hard;
mod inverse;
mod model;
mod oblique;

use common::{
    gpu, job,
    picture::{Picture, Pixels, picture, worst},
};
use model::Model;
use nephroid::{
    methods,
    renderer::{Frame, Job, Providers, RenderError, Renderer, plan},
};

/// The paper's wave over its unit square.
const PAPER: &str = "scenes/papers/waves.toml";
const VARIANTS: [&str; 5] = ["listing", "pixel", "shortcut", "texture", "vertex"];
/// Degrees: wide enough that the sun map is smooth where most rays go.
const SUN: f64 = 20.0;
/// Of the map's peak: float32 slopes of 1 lose some 1e-6 where phases reach 160, arctangents and sines as much.
const FLOAT32: f64 = 1e-4;

fn waves(scene: &str, set: &[(&str, &str)], camera: &str, size: [u32; 2]) -> Job {
    // No ray is traced at the water here: the triangles that stand for it may be few.
    let coarse = if scene == PAPER { vec![("scene.objects.water.wave.grid", "8")] } else { Vec::new() };
    let set = [coarse, vec![("eye.samples", "1")], set.to_vec()].concat();
    let providers = Providers::of(methods::find("waves").expect("waves is a method"));
    Job { providers, ..job(scene, &set, camera, size) }
}

fn shown(gpu: &nephroid::gpu::Gpu, job: &Job) -> (Vec<f64>, Picture) {
    let picture = picture(gpu, job);
    (picture.mean("irradiance.caustic"), picture)
}

/// Largest difference, in parts of the map's peak, which is the sun's 1 W/m².
fn off(shown: &[f64], expected: &[f64]) -> f64 {
    assert!(expected.iter().any(|x| *x > 0.1), "there is something to see");
    worst(shown.iter().zip(expected).map(|(a, b)| a - b))
}

/// What a variant has a size of, if any: its mesh, or its target.
fn sized<'a>(variant: &str, mesh: &'a str, side: &'a str) -> Option<(&'static str, &'a str)> {
    match variant {
        "vertex" => Some(("waves.mesh", mesh)),
        "texture" => Some(("waves.side", side)),
        _ => None,
    }
}

#[test]
fn each_variant_is_its_equations() {
    let (gpu, size) = (gpu(), [48, 48]);
    let width = SUN.to_string();
    let texels_a_pixel = 0.6 / 48.0 * 256.0;
    for variant in VARIANTS {
        for time in ["0", "0.7"] {
            let set =
                [("waves.variant", variant), ("waves.sun_width", &width), ("scene.objects.water.wave.time", time)];
            let job = waves(PAPER, &[&set, sized(variant, "40", "256").as_slice()].concat(), "region", size);
            let (model, pixels) = (Model::of(&job.scene, SUN), Pixels { region: &job.scene.region, size });
            let expected = Model::of_pixels(&pixels, |p| match variant {
                "listing" => model.listing(p, 1.0),
                "shortcut" => model.shortcut(p),
                "texture" => model.texture(p, 256, f64::log2(texels_a_pixel)),
                "vertex" => model.vertex(p, 40),
                _ => model.pixel(p),
            });
            let off = off(&shown(&gpu, &job).0, &expected);
            println!("{variant} at {time} s: {off:.1e}");
            assert!(off <= FLOAT32, "{variant} at {time} s: {off:e}");
        }
    }
}

#[test]
fn the_texture_becomes_the_pixels_at_second_order() {
    let (gpu, size, width) = (gpu(), [160, 160], SUN.to_string());
    // Two octaves: the finest wave is 0.2 long where it is shortest, thirteen texels of the coarsest target.
    let of = |set: &[(&str, &str)]| {
        let set = [set, &[("waves.sun_width", width.as_str()), ("scene.objects.water.wave.octaves", "2")]].concat();
        shown(&gpu, &waves(PAPER, &set, "region", size)).0
    };
    let exact = of(&[]);
    let errors = ["64", "128", "256"].map(|side| {
        let texture = of(&[("waves.variant", "texture"), ("waves.side", side)]);
        (texture.iter().zip(&exact).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / exact.len() as f64).sqrt()
    });
    let orders = [errors[0] / errors[1], errors[1] / errors[2]].map(f64::log2);
    println!("errors {errors:?}, orders {orders:.2?}");
    // The sun map's edge has a bend, and the wave's tip a fold: a little less than 2 is seen.
    assert!(orders.iter().all(|order| *order > 1.85), "{errors:?}: {orders:?}");
}

#[test]
fn the_texture_costs_the_same_whatever_is_seen() {
    let gpu = gpu();
    let of = |variant, size| {
        let set = [&[("waves.variant", variant)], sized(variant, "64", "64").as_slice()].concat();
        let job = waves(PAPER, &set, "region", size);
        let mut renderer = Renderer::new(&gpu, &job).unwrap();
        renderer.frame(&Frame::default()).unwrap();
        let counters = renderer.counters(&Frame::default()).unwrap();
        let count = |stage: &str| counters.iter().find(|(name, _)| name == stage).map(|(_, counted)| *counted);
        let texels = count("waves/texture").and_then(|c| c.invocations);
        (texels, count("eye/surface").and_then(|c| c.fragments))
    };
    assert_eq!([of("texture", [16, 16]), of("texture", [64, 64])].map(|(texels, _)| texels), [Some(64 * 64); 2]);
    assert_eq!([of("pixel", [16, 16]), of("pixel", [64, 64])], [(None, Some(16 * 16)), (None, Some(64 * 64))]);
}

#[test]
fn what_cannot_be_is_refused_or_left_out_with_the_reason() {
    let refused = |set: &[(&str, &str)]| match plan(&waves(PAPER, set, "region", [8, 8])).map(|_| ()) {
        Err(RenderError::Plan(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let side = refused(&[("waves.variant", "texture"), ("waves.side", "100")]);
    assert!(side.contains("waves.side=100") && side.contains("use 64 or 128"), "{side}");
    for variant in ["inverse", "texture", "vertex"] {
        let screen = refused(&[("waves.variant", variant), ("waves.screen_depth", "on")]);
        assert!(screen.contains("no screen is known"), "{screen}");
    }
    for (variant, key, value) in [
        ("inverse", "waves.sun_width", "5"),
        ("inverse", "waves.sun_edge", "1"),
        ("listing", "waves.absorbed", "0.2"),
        ("pixel", "waves.mesh", "7"),
        ("vertex", "waves.side", "64"),
        ("pixel", "waves.anisotropy", "4"),
        ("shortcut", "waves.filter", "cubic"),
        ("pixel", "waves.sun_distance", "3"),
        ("texture", "waves.cells", "64"),
    ] {
        let unused = refused(&[("waves.variant", variant), (key, value)]);
        assert!(unused.contains(&format!("{key}={value} with waves.variant={variant}")), "{unused}");
        assert!(unused.contains(&format!("do not set {key}")), "{unused}");
    }
    for (scene, why) in [("glass-sphere", "no water"), ("diffuse", "no water"), ("gem", "no water")] {
        let plan = plan(&waves(scene, &[], "region", [8, 8])).unwrap().plan;
        let left = plan.left_out.iter().find(|left| left.name == "eye/surface").expect("it is said");
        assert!(left.reason.contains(why), "{scene}: {}", left.reason);
        assert!(plan.passes.iter().all(|pass| !pass.name.starts_with("waves")), "{scene}");
    }
    // Of a scene that moves, a light may have power later.
    let still = [("scene.objects.water.wave.speed", "0"), ("scene.lights.sun.directional.irradiance", "0")];
    let dark = plan(&waves(PAPER, &still, "region", [8, 8])).unwrap();
    assert!(dark.plan.left_out.iter().any(|left| left.reason.contains("no sun")));
}
