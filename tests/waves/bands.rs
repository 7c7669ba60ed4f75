//! Water that bends its bands apart: each band is what water of its index shows.

use crate::{
    common::{
        gpu,
        picture::{picture, worst},
    },
    inverse::inverse,
};

const INDICES: [&str; 3] = ["1.29", "1.33", "1.38"];

#[test]
fn each_band_is_that_of_water_of_its_index() {
    let gpu = gpu();
    // The disc of the sun, which `inverse` alone knows, is bent apart too.
    let sun = [
        ("scene.lights.sun.directional.direction", "[0.2, -1, 0.1]"),
        ("scene.lights.sun.directional.angular_diameter", "2"),
    ];
    for variant in ["inverse", "pixel", "texture", "vertex"] {
        let of = |ior: &str| {
            let set = [&sun[..], &[("waves.variant", variant), ("scene.materials.water.ior", ior)]].concat();
            picture(&gpu, &inverse("sine-water", &set, "region", [12, 12])).layer("irradiance.caustic").to_vec()
        };
        let apart = of(&format!("[{}]", INDICES.join(", ")));
        let alone = INDICES.map(of);
        let brightest = worst(apart.iter().map(|e| f64::from(*e)));
        let difference = |a: usize, b: usize| {
            let band = |of: &[f32], band: usize| -> Vec<f64> {
                of.chunks_exact(3).map(|pixel| f64::from(pixel[band])).collect()
            };
            worst(band(&apart, a).iter().zip(band(&alone[b], a)).map(|(x, y)| x - y)) / brightest
        };
        let off = [0, 1, 2].map(|k| difference(k, k));
        println!("{variant}: {off:?}; others' {:.1e}", difference(0, 2));
        assert!(off.iter().all(|off| *off < 1e-5), "{variant}: {off:?}");
        assert!(difference(0, 2) > 1e-2, "{variant}: bands differ");
    }
}
