//! `waves.variant=inverse` through an eye in perspective: one eye sample has its pixel's mean wherever it is in the picture.

use crate::{
    common::gpu,
    inverse::{inverse, judged, light},
};

/// A view of 100° from 0.5 m above the floor, whose corner is twice as far from the eye as it is deep: a place as large as that
/// distance makes it would cover four pixels there.
const WIDE: [(&str, &str); 4] = [
    ("scene.objects.water.visible_to_camera", "false"),
    ("scene.cameras.main.pinhole.position", "[0.05, -0.3, 0.0]"),
    ("scene.cameras.main.pinhole.target", "[0.0, -0.8, 0.0]"),
    ("scene.cameras.main.pinhole.fov_y", "100"),
];

/// Against 4 × 4 samples a pixel, each with the mean of its own part: measured 7e-9, for places are parts of a flat floor.
#[test]
fn a_wide_view_has_the_means_of_its_pixels() {
    let gpu = gpu();
    let of = |samples| {
        light(&gpu, &inverse("sine-water", &[&WIDE[..], &[("eye.samples", samples)]].concat(), "main", [48, 48]))
    };
    let [relmse, energy] = judged(&of("1"), &of("4"), 1.0);
    println!("relmse {relmse:.2e}, energy {energy:.5}");
    assert!(relmse < 3e-8 && (energy - 1.0).abs() < 1e-4, "{relmse:e} {energy}");
}
