//! Settings at other values than they come with.

use crate::{
    FLOAT32, PAPER, SUN,
    common::{
        gpu,
        picture::{Pixels, worst},
    },
    inverse::inverse,
    model::Model,
    off, shown, waves,
};

/// What a metre of water takes by `waves.absorbed` is what the scene's water takes that absorbs as much.
#[test]
fn a_share_of_each_metre_is_an_absorption() {
    let gpu = gpu();
    let slanting = ("scene.lights.sun.directional.direction", "[0.6, -1, 0.2]");
    let absorption = (-0.7_f64.ln()).to_string();
    for variant in ["inverse", "pixel", "shortcut", "texture", "vertex"] {
        let of = |set: (&str, &str)| {
            shown(&gpu, &inverse("sine-water", &[slanting, ("waves.variant", variant), set], "region", [12, 12])).0
        };
        let absorbed = of(("waves.absorbed", "0.3"));
        let same = of(("scene.materials.water.absorption", &absorption));
        let clear = of(("waves.absorbed", "0"));
        let off = worst(absorbed.iter().zip(&same).map(|(a, b)| a - b));
        let kept = absorbed.iter().sum::<f64>() / clear.iter().sum::<f64>();
        println!("{variant}: off {off:.1e}, kept {kept:.4}");
        assert!(off < 1e-6, "{variant}: {off:e}");
        // 0.8 m of it, at most a fifth longer where light is bent by 30°.
        assert!((0.70..0.77).contains(&kept), "{variant}: {kept}");
    }
}

#[test]
fn the_sun_map_has_the_edge_and_the_distance_that_are_set() {
    let (gpu, size, width) = (gpu(), [32, 32], SUN.to_string());
    for variant in ["pixel", "shortcut"] {
        let set = [("waves.variant", variant), ("waves.sun_width", &width), ("waves.sun_edge", "0.4")];
        let distance = (variant == "shortcut").then_some(("waves.sun_distance", "1.3"));
        let job = waves(PAPER, &[&set, distance.as_slice()].concat(), "region", size);
        let mut model = Model::of(&job.scene, SUN);
        (model.edge, model.distance) = (0.4, 1.3);
        let pixels = Pixels { region: &job.scene.region, size };
        let of = |p| if variant == "pixel" { model.pixel(p) } else { model.shortcut(p) };
        let off = off(&shown(&gpu, &job).0, &Model::of_pixels(&pixels, of));
        println!("{variant}: {off:.1e}");
        assert!(off <= FLOAT32, "{variant}: {off:e}");
    }
}

/// A floor seen at a low angle: one probe has the longer side of a pixel's footprint all round, sixteen the footprint.
#[test]
fn more_probes_are_nearer_to_the_mean_of_a_pixel_seen_aslant() {
    let gpu = gpu();
    let low = [
        ("scene.objects.water.visible_to_camera", "false"),
        ("scene.cameras.main.pinhole.position", "[0.0, -0.6, 0.55]"),
        ("scene.cameras.main.pinhole.target", "[0.0, -0.8, 0.0]"),
        ("scene.cameras.main.pinhole.fov_y", "12"),
        ("waves.sun_width", "20"),
    ];
    let of = |set: &[(&str, &str)]| shown(&gpu, &waves(PAPER, &[&low[..], set].concat(), "main", [12, 12])).0;
    let mean = of(&[("eye.samples", "8")]);
    let [one, sixteen] = ["1", "16"].map(|probes| {
        let texture = of(&[("waves.variant", "texture"), ("waves.side", "256"), ("waves.anisotropy", probes)]);
        (texture.iter().zip(&mean).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / mean.len() as f64).sqrt()
    });
    println!("one probe {one:.2e}, sixteen {sixteen:.2e}");
    assert!(sixteen < 0.5 * one, "{one:e} {sixteen:e}");
}
