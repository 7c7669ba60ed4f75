//! The smallest and the largest: one photon, sixteen million, scenes of a millimetre and of a kilometre.

use super::{DEPOSITED, ROUNDING, SILHOUETTE, SIZE, balanced, close, main_view};
use crate::common::{
    gpu,
    picture::{job_of, picture, scene},
};
use std::f64::consts::PI;

#[test]
fn one_photon_is_one_texel() {
    let set = [("light.side", "1"), ("maps.side", "128"), ("maps.splat_size", "1")];
    let picture = picture(&gpu(), &job_of(scene("glass-sphere", &[]), &set, "region", SIZE));
    balanced(&picture);
    assert_eq!(
        (picture.account.counts[..2].to_vec(), picture.account.counts[2..].iter().sum::<u64>()),
        (vec![1, 1], 0)
    );
    // The one sample stands for the whole window about the sphere and goes straight through.
    close("emitted", picture.energy.emitted_w, 4.0, ROUNDING);
    close("deposited", picture.energy.deposited_w, 4.0 * 0.96 * 0.96, ROUNDING);
    let (map, side) = picture.map();
    let lit: Vec<usize> = (0..side * side).filter(|k| map[4 * k] > 0.0).collect();
    assert_eq!(lit.len(), 1);
    let (x, y) = (lit[0] % side, lit[0] / side);
    assert!(x.abs_diff(side / 2) <= 1 && y.abs_diff(side / 2) <= 1, "texel {x}, {y} of {side}");
}

#[test]
fn sixteen_million_photons_into_a_small_map() {
    let set = [("light.side", "4096"), ("maps.side", "32")];
    let picture = picture(&gpu(), &job_of(scene("glass-sphere", &[]), &set, "region", [27, 27]));
    balanced(&picture);
    close("emitted", picture.energy.emitted_w, PI, SILHOUETTE);
    close("deposited", picture.energy.deposited_w, picture.energy.valid_w, DEPOSITED);
    let peak = picture.map().0.iter().copied().fold(0.0, f32::max);
    assert!(f64::from(peak) > 0.1 * picture.energy.deposited_w, "the focus lies in a few texels: {peak} W");
}

/// Metres of a unit of length. By powers of two every product and sum scales without rounding, so the picture is the
/// same to the bit; by powers of ten, positions round differently, photons move by 10⁻⁷ and a few cross the grid of
/// 1/256 texel that splats are snapped to, or a shadow's edge.
const EXACT_UNITS: [&str; 2] = ["0.0009765625", "1024.0"];
const ROUNDED_UNITS: [&str; 2] = ["0.001", "1000.0"];
/// Mean difference of the rounded ones as a share of the mean: measured 5·10⁻⁵; a single sample of 4,096 that changes
/// sides of a shadow's edge is 2·10⁻⁴.
const ROUNDED: f64 = 5e-4;

#[test]
fn a_scene_of_any_size_gives_the_same_picture() {
    let gpu = gpu();
    for name in ["glass-sphere", "bunny"] {
        let at = |unit: &str| main_view(&gpu, scene(name, &[("unit", unit)]));
        let one = at("1.0");
        for unit in EXACT_UNITS {
            let scaled = at(unit);
            assert_eq!(scaled.account.counts, one.account.counts, "{name} in units of {unit} m");
            for (a, b) in one.layers.iter().zip(scaled.layers.iter()) {
                assert!(a == b, "{name} in units of {unit} m: {} differs", a.name());
            }
        }
        for unit in ROUNDED_UNITS {
            let scaled = at(unit);
            for layer in ["radiance", "irradiance.direct", "irradiance.caustic"] {
                let (a, b) = (one.mean(layer), scaled.mean(layer));
                let difference = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum::<f64>() / a.iter().sum::<f64>();
                println!("{name} in units of {unit} m, {layer}: {difference:.2e} of {ROUNDED:e}");
                assert!(difference <= ROUNDED, "{name} in units of {unit} m: {layer} differs by {difference}");
            }
        }
    }
}
