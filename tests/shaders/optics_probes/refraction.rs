//! Snell's law: random incidence, index near one, grazing, and both sides of the critical angle.
use super::{UNIT_ROUNDOFF, f32s, f64s, root_error, squared_cosine, worst};
use crate::common::{Probe, gpu, random::Random};
use glam::DVec3;
use nephroid::optics;

/// Directions: two products of unit vectors, a sum and a normalisation, times the index where it is above one.
const DIRECTION: f64 = 6.0 * UNIT_ROUNDOFF;
/// cos θ comes from a dot product of rounded unit vectors; so much is cos²θ after refraction off, times the index squared.
const SQUARED_COSINE: f64 = 8.0 * UNIT_ROUNDOFF;

const INDICES: [f64; 9] = [1.0, 1.000_000_2, 1.0001, 1.01, 1.33, 1.5, 2.42, 1.0 / 1.33, 1.0 / 1.5];

fn refract(inputs: &[[f32; 7]]) -> Vec<([f32; 3], bool)> {
    let probe = Probe {
        includes: &["shared/optics.glsl"],
        input: "vec3 d; vec3 n; float eta;",
        output: "vec3 t; float passed;",
        body: "bool passed = refract_ray(q.d, q.n, q.eta, r.t); r.passed = passed ? 1.0 : 0.0;",
        ..Default::default()
    };
    let outputs: Vec<[f32; 4]> = probe.run(&gpu(), inputs);
    outputs.iter().map(|o| ([o[0], o[1], o[2]], o[3] == 1.0)).collect()
}

fn row(d: DVec3, n: DVec3, eta: f64) -> [f32; 7] {
    let (d, n) = (f32s(d), f32s(n));
    [d[0], d[1], d[2], n[0], n[1], n[2], eta as f32]
}

/// A direction that meets `n` under the angle of cosine `cos_i`, in a random plane.
fn incident(random: &mut Random, n: DVec3, cos_i: f64) -> DVec3 {
    let along = n.any_orthonormal_vector();
    let turned = glam::DQuat::from_axis_angle(n, random.within(0.0, std::f64::consts::TAU)) * along;
    turned * (1.0 - cos_i * cos_i).sqrt() - n * cos_i
}

/// Checks every row against float64 and returns how many were totally reflected.
fn check(inputs: &[[f32; 7]]) -> usize {
    let mut reflected = 0;
    for (input, (t, passed)) in inputs.iter().zip(refract(inputs)) {
        let (d, n) = (f64s([input[0], input[1], input[2]]), f64s([input[3], input[4], input[5]]));
        let eta = f64::from(input[6]);
        let uncertain = SQUARED_COSINE * eta.max(1.0).powi(2);
        let k = squared_cosine((-d.dot(n)).clamp(0.0, 1.0), eta);
        assert!(f64s(t).is_finite(), "{input:?}");
        if k.abs() > uncertain {
            assert_eq!(passed, k > 0.0, "{input:?}: cos² = {k:e}");
        }
        if !passed {
            reflected += 1;
            continue;
        }
        // Beyond the critical angle by less than the rounding, the shader refracts along the surface.
        let expected = optics::refract(d, n, eta).unwrap_or_else(|| (eta * d + eta * -d.dot(n) * n).normalize());
        let error = (f64s(t) - expected.normalize()).length();
        let allowed = DIRECTION * eta.max(1.0) + root_error(k, uncertain);
        assert!(error <= allowed, "{input:?}: {error:e} above {allowed:e}");
    }
    reflected
}

#[test]
fn random_incidence_obeys_snell() {
    let mut random = Random(10);
    let inputs: Vec<[f32; 7]> = (0..50_000)
        .map(|i| {
            let n = random.direction();
            let cos_i = random.unit();
            row(incident(&mut random, n, cos_i), n, INDICES[i % INDICES.len()])
        })
        .collect();
    let reflected = check(&inputs);
    assert!(reflected > inputs.len() / 20, "{reflected}: glass to air reflects totally from 42 degrees on");
}

#[test]
fn grazing_incidence() {
    let mut random = Random(11);
    let inputs: Vec<[f32; 7]> = (0..9000)
        .map(|i| {
            let n = random.direction();
            let cos_i = [0.0, 1e-12, 1e-7, 1e-5, 1e-3][i % 5];
            row(incident(&mut random, n, cos_i), n, INDICES[(i / 5) % INDICES.len()])
        })
        .chain(INDICES.map(|eta| row(DVec3::X, DVec3::Y, eta)))
        .collect();
    check(&inputs);
}

#[test]
fn both_sides_of_the_critical_angle() {
    let mut random = Random(12);
    let steps = [-1e-3, -1e-5, -1e-6, 0.0, 1e-6, 1e-5, 1e-3];
    let inputs: Vec<[f32; 7]> = (0..7000)
        .map(|i| {
            let eta: f64 = [1.0001, 1.33, 1.5, 2.42][(i / 7) % 4];
            let n = random.direction();
            let critical = (1.0 - 1.0 / (eta * eta)).sqrt();
            row(incident(&mut random, n, (critical + steps[i % 7]).clamp(0.0, 1.0)), n, eta)
        })
        .collect();
    let reflected = check(&inputs);
    assert!(reflected > inputs.len() / 4 && reflected < inputs.len() * 3 / 4, "{reflected}");
}

#[test]
fn an_index_of_one_bends_nothing() {
    let mut random = Random(13);
    let inputs: Vec<[f32; 7]> = (0..5000)
        .map(|i| {
            let n = random.direction();
            let cos_i = [0.0, 1e-6, 1e-3, 0.3, 1.0][i % 5];
            row(incident(&mut random, n, cos_i), n, 1.0)
        })
        .collect();
    // Only the normalisation of an already rounded direction is left.
    let error = worst(inputs.iter().zip(refract(&inputs)).map(|(i, (t, passed))| {
        assert!(passed, "{i:?}");
        (f64s(t) - f64s([i[0], i[1], i[2]]).normalize()).length()
    }));
    assert!(error <= 4.0 * UNIT_ROUNDOFF, "{error:e}");
}

#[test]
fn zero_vectors_give_finite_answers() {
    for (t, _) in
        refract(&[row(DVec3::ZERO, DVec3::Y, 0.7), row(DVec3::X, DVec3::ZERO, 0.7), row(DVec3::ZERO, DVec3::ZERO, 1.0)])
    {
        assert!(t.iter().all(|x| x.is_finite()), "{t:?}");
    }
}
