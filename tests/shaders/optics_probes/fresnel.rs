//! Fresnel's reflectance against float64 over all angles and indices.
use super::{UNIT_ROUNDOFF, root_error, squared_cosine};
use crate::common::{Probe, gpu, random::Random};
use nephroid::optics;

/// Relative: some twenty operations, two of them fourth powers of the amplitudes' denominators.
const RELATIVE: f64 = 12.0 * UNIT_ROUNDOFF;
/// cos²θ after refraction is off by the rounding of the index ratio and two products, times the index squared.
const SQUARED_COSINE: f64 = 2.0 * UNIT_ROUNDOFF;

fn fresnel(inputs: &[[f32; 3]]) -> Vec<f32> {
    let probe = Probe {
        includes: &["shared/optics.glsl"],
        input: "float cos_i; float n_from; float n_to;",
        output: "float y;",
        body: "r.y = fresnel(q.cos_i, q.n_from, q.n_to);",
        ..Default::default()
    };
    probe.run(&gpu(), inputs)
}

/// What an error of cos θ' means for the reflectance: the amplitudes are off by at most 4/(n cosθ + cosθ') times it.
fn conditioning(cos_i: f64, eta: f64, reflectance: f64) -> f64 {
    let k = squared_cosine(cos_i, eta);
    let uncertain = SQUARED_COSINE * eta.max(1.0).powi(2);
    let least = (eta * cos_i).min(cos_i) + eta.min(1.0) * k.max(0.0).sqrt();
    8.0 * reflectance.sqrt() * (root_error(k, uncertain) / least.max(f64::MIN_POSITIVE)).min(1.0)
}

fn check(inputs: &[[f32; 3]]) {
    for (input, y) in inputs.iter().zip(fresnel(inputs)) {
        let [cos_i, from, to] = input.map(f64::from);
        let expected = optics::fresnel(cos_i, from, to);
        let error = (f64::from(y) - expected).abs();
        let allowed = RELATIVE * expected + conditioning(cos_i, from / to, expected);
        assert!((0.0..=1.0).contains(&y) && error <= allowed, "{input:?}: {y:e} for {expected:e}, allowed {allowed:e}");
    }
}

#[test]
fn all_angles_and_indices() {
    let mut random = Random(20);
    let inputs: Vec<[f32; 3]> = (0..50_000)
        .map(|_| [random.unit(), random.within(1.0, 2.5), random.within(1.0, 2.5)].map(|x| x as f32))
        .collect();
    check(&inputs);
}

#[test]
fn the_usual_pairs_from_grazing_to_normal() {
    let pairs = [(1.0, 1.5), (1.5, 1.0), (1.0, 1.33), (1.33, 1.5), (1.0, 2.42), (2.42, 1.0)];
    let cosines = (0..=1000).map(|i| f64::from(i) / 1000.0).chain([1e-30, 1e-12, 1e-7, 1e-4, 0.999_999_9]);
    let inputs: Vec<[f32; 3]> =
        cosines.flat_map(|c| pairs.map(|(from, to)| [c as f32, from as f32, to as f32])).collect();
    check(&inputs);
}

/// Near index one the reflectance is (Δn/2)²: a form that subtracts amplitudes keeps none of its digits.
#[test]
fn index_near_one_keeps_its_digits() {
    for step in [2e-7f32, 1e-5, 1e-3] {
        let to = 1.0 + step;
        let y = f64::from(fresnel(&[[1.0, 1.0, to]])[0]);
        let expected = (f64::from(to - 1.0) / f64::from(to + 1.0)).powi(2);
        assert!((y - expected).abs() <= RELATIVE * expected, "{step}: {y:e} for {expected:e}");
    }
}

#[test]
fn edges_are_exact() {
    let critical = (1.0f64 - 1.0 / 2.25).sqrt() as f32;
    let rows: [([f32; 3], f32); 9] = [
        ([0.0, 1.0, 1.0], 0.0),
        ([0.5, 1.5, 1.5], 0.0),
        ([0.0, 1.0, 1.5], 1.0),
        ([0.0, 1.5, 1.0], 1.0),
        ([critical - 1e-6, 1.5, 1.0], 1.0),
        ([0.1, 1.5, 1.0], 1.0),
        ([-0.5, 1.0, 1.5], 1.0),
        ([1.0, 1.0, 1.5], 0.04),
        ([2.0, 1.0, 1.5], 0.04),
    ];
    let outputs = fresnel(&rows.map(|r| r.0));
    for ((input, expected), y) in rows.iter().zip(outputs) {
        assert!((y - expected).abs() <= RELATIVE as f32 * expected, "{input:?}: {y} for {expected}");
    }
    let below = fresnel(&[[critical + 1e-4, 1.5, 1.0]])[0];
    assert!(below < 1.0 && below > 0.5, "{below}");
}
