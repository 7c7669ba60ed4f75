//! Normalisation, reflection, octahedral directions, absorption.
use super::{UNIT_ROUNDOFF, f32s, f64s, worst};
use crate::common::{Probe, gpu, random::Random};
use glam::DVec3;
use nephroid::optics;

/// A square, two sums, a root and a division.
const NORMALISED: f64 = 4.0 * UNIT_ROUNDOFF;
/// A dot product, a product and a difference of numbers up to two, then the normalisation.
const REFLECTED: f64 = 12.0 * UNIT_ROUNDOFF;
/// A division and a normalisation each way.
const OCTAHEDRAL: f64 = 12.0 * UNIT_ROUNDOFF;
/// `exp` is allowed 3 + 2|x| units in the last place by Vulkan; the exponent goes down to -20 here.
const ABSORBED: f64 = 2.0 * (3.0 + 2.0 * 20.0) * UNIT_ROUNDOFF;

const FALLBACK: [f32; 3] = [0.0, 0.0, 1.0];

fn normalise(inputs: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let probe = Probe {
        includes: &["shared/optics.glsl"],
        input: "vec3 v;",
        output: "vec3 y;",
        body: "r.y = safe_normalize(q.v, vec3(0, 0, 1));",
        ..Default::default()
    };
    probe.run(&gpu(), inputs)
}

#[test]
fn any_vector_with_a_direction_is_normalised() {
    let mut random = Random(1);
    let inputs: Vec<[f32; 3]> = (0..20_000).map(|i| f32s(random.direction() * 10f64.powi(i % 75 - 37))).collect();
    let outputs = normalise(&inputs);
    let error = worst(inputs.iter().zip(&outputs).map(|(v, y)| (f64s(*y) - f64s(*v).normalize()).length()));
    assert!(error <= NORMALISED, "{error:e}");
}

#[test]
fn vectors_without_a_direction_fall_back() {
    let (inf, nan) = (f32::INFINITY, f32::NAN);
    let none = [[0.0; 3], [-0.0; 3], [0.0, 1e-42, 0.0], [inf, 0.0, 0.0], [nan, 1.0, 0.0], [nan; 3], [0.0, -inf, inf]];
    for (v, y) in none.iter().zip(normalise(&none)) {
        assert_eq!(y, FALLBACK, "{v:?}");
    }
}

#[test]
fn mirrors_reflect() {
    let mut random = Random(2);
    let inputs: Vec<[[f32; 3]; 2]> = (0..20_000)
        .map(|_| [f32s(random.direction()), f32s(random.direction())])
        .chain([[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]], [[0.0, -1.0, 0.0], [0.0; 3]]])
        .collect();
    let probe = Probe {
        includes: &["shared/optics.glsl"],
        input: "vec3 d; vec3 n;",
        output: "vec3 y;",
        body: "r.y = reflect_ray(q.d, q.n);",
        ..Default::default()
    };
    let outputs: Vec<[f32; 3]> = probe.run(&gpu(), &inputs);
    let expected = inputs.iter().map(|[d, n]| optics::reflect(f64s(*d), f64s(*n)).normalize());
    let error = worst(expected.zip(&outputs).map(|(e, y)| (f64s(*y) - e).length()));
    assert!(error <= REFLECTED, "{error:e}");
}

#[test]
fn directions_survive_the_octahedron() {
    let mut random = Random(3);
    let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let inputs: Vec<[f32; 3]> = (0..20_000)
        .map(|_| f32s(random.direction()))
        .chain(axes.map(f32s))
        .chain([[0.6, 0.0, -0.8], [-0.0, 0.8, -0.6], [0.6, -0.8, 0.0]])
        .collect();
    let probe = Probe {
        includes: &["shared/octahedral.glsl"],
        input: "vec3 v;",
        output: "vec3 y; vec2 e; vec3 none;",
        body: "r.e = octahedral_encode(q.v); r.y = octahedral_decode(r.e);\
               r.none = octahedral_decode(octahedral_encode(vec3(0)));",
        ..Default::default()
    };
    let outputs: Vec<[f32; 8]> = probe.run(&gpu(), &inputs);
    let error = worst(inputs.iter().zip(&outputs).map(|(v, y)| (f64s([y[0], y[1], y[2]]) - f64s(*v)).length()));
    assert!(error <= OCTAHEDRAL, "{error:e}");
    assert!(outputs.iter().all(|y| y[3].abs() <= 1.0 && y[4].abs() <= 1.0 && y[5..] == [0.0, 0.0, 1.0]));
}

#[test]
fn glass_absorbs_by_length() {
    let mut random = Random(4);
    let inputs: Vec<[f32; 2]> = (0..5000)
        .map(|_| [random.within(0.0, 4.0) as f32, random.within(0.0, 5.0) as f32])
        .chain([[0.0, 1e30], [1e30, 0.0], [0.0, f32::INFINITY], [3.0, -1.0], [1e20, 1e20]])
        .collect();
    let probe = Probe {
        includes: &["shared/optics.glsl"],
        input: "float sigma; float len;",
        output: "vec3 y;",
        body: "r.y = absorb(vec3(q.sigma, 0.0, q.sigma), q.len);",
        ..Default::default()
    };
    let outputs: Vec<[f32; 3]> = probe.run(&gpu(), &inputs);
    let error = worst(inputs.iter().zip(&outputs).map(|([sigma, len], y)| {
        let expected = optics::transmittance(f64::from(*sigma), f64::from(len.max(0.0)));
        let absolute = (f64::from(y[0]) - expected).abs();
        if expected > 1e-30 { absolute / expected } else { absolute }
    }));
    assert!(error <= ABSORBED, "{error:e}");
    assert!(outputs.iter().all(|y| y[1] == 1.0 && y[0] == y[2]));
}
