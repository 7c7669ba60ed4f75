//! The convention of interpolated normals: they bend, the geometric normal decides the side, and what it takes is counted.
use super::{UNIT_ROUNDOFF, f32s, f64s, root_error, squared_cosine};
use crate::common::{Probe, gpu, random::Random};
use glam::DVec3;
use nephroid::optics;

/// As for a single refraction, normals flipped being free.
const DIRECTION: f64 = 8.0 * UNIT_ROUNDOFF;
/// cos² after refraction, from rounded dot products, times the index squared.
const SQUARED_COSINE: f64 = 8.0 * UNIT_ROUNDOFF;
/// Reflectance changes by at most 4 times the cosine of refraction, whose root is taken of no less than UNDECIDED here.
const REFLECTANCE: f64 = 4.0 * 8.0 * UNIT_ROUNDOFF * 1000.0;
/// Beside a plane that decides, float32 may decide otherwise.
const UNDECIDED: f64 = 1e-5;

/// d, geometric normal, interpolated normal, the two indices.
type Row = [f32; 11];

struct Answer {
    t: DVec3,
    passed: bool,
    fresnel: f64,
    bent: f32,
    mirrored: DVec3,
    mirror_bent: f32,
}

fn bend(rows: &[Row]) -> Vec<Answer> {
    let probe = Probe {
        includes: &["shared/interface.glsl"],
        input: "vec3 d; vec3 ng; vec3 ns; vec2 n;",
        output: "vec3 t; float passed; float fresnel; float bent; vec3 mirrored; float mirror_bent;",
        body: "Surface s; s.ng = q.ng; s.ns = q.ns; uint bent = 0u; uint mirror_bent = 0u; float unused;\
               bool passed = bend_refract(s, q.d, q.n.x, q.n.y, r.t, r.fresnel, bent);\
               bend_reflect(s, q.d, q.n.x, q.n.y, r.mirrored, unused, mirror_bent);\
               r.passed = passed ? 1.0 : 0.0; r.bent = float(bent); r.mirror_bent = float(mirror_bent);",
        ..Default::default()
    };
    let outputs: Vec<[f32; 10]> = probe.run(&gpu(), rows);
    let answer = |y: &[f32; 10]| Answer {
        t: f64s([y[0], y[1], y[2]]),
        passed: y[3] == 1.0,
        fresnel: y[4].into(),
        bent: y[5],
        mirrored: f64s([y[6], y[7], y[8]]),
        mirror_bent: y[9],
    };
    outputs.iter().map(answer).collect()
}

/// What the convention asks, in float64; `None` where a decision is too close for float32.
struct Expected {
    t: Option<DVec3>,
    k: f64,
    normal: DVec3,
    bent: f32,
    mirrored: DVec3,
    mirror_bent: f32,
}

fn expected(d: DVec3, ng: DVec3, ns: DVec3, eta: f64) -> Option<Expected> {
    let side = if d.dot(ng) <= 0.0 { 1.0 } else { -1.0 };
    let (g, n) = (ng * side, ns * side);
    let faces_away = d.dot(n) >= 0.0;
    let mut close = d.dot(ng).abs() < UNDECIDED || d.dot(n).abs() < UNDECIDED;
    let first = if faces_away { g } else { n };
    let through = optics::refract(d, first, eta);
    close |= through.is_some_and(|t| t.dot(g).abs() < UNDECIDED);
    let wrong_side = through.is_some_and(|t| t.dot(g) >= 0.0);
    let normal = if wrong_side { g } else { first };
    let mirrored = optics::reflect(d, first);
    close |= mirrored.dot(g).abs() < UNDECIDED;
    let mirror_wrong = mirrored.dot(g) <= 0.0;
    let k = squared_cosine(-d.dot(normal), eta);
    close |= k.abs() < UNDECIDED || squared_cosine(-d.dot(first), eta).abs() < UNDECIDED;
    (!close).then(|| Expected {
        t: optics::refract(d, normal, eta),
        k,
        normal,
        bent: f32::from(u8::from(faces_away || wrong_side)),
        mirrored: if mirror_wrong { optics::reflect(d, g) } else { mirrored },
        mirror_bent: f32::from(u8::from(faces_away || mirror_wrong)),
    })
}

fn rows() -> Vec<Row> {
    let mut random = Random(60);
    (0..40_000)
        .map(|i| {
            let ng = random.direction();
            let tilt = [0.05, 0.5, 1.5, 0.0][i % 4];
            let mut ns = (ng + random.direction() * tilt).normalize();
            if ns.dot(ng) < 0.0 {
                ns = -ns;
            }
            let along = ng.any_orthonormal_vector();
            let d = [random.direction(), (along + random.direction() * 0.1).normalize()][i / 4 % 2];
            let (from, to) = [(1.0, 1.5), (1.5, 1.0), (1.0, 1.0)][i / 8 % 3];
            let (d, ng, ns) = (f32s(d), f32s(ng), f32s(ns));
            [d[0], d[1], d[2], ng[0], ng[1], ng[2], ns[0], ns[1], ns[2], from, to]
        })
        .collect()
}

#[test]
fn the_geometric_normal_decides_the_side_and_is_counted() {
    let rows = rows();
    let (mut bent, mut close) = (0, 0);
    for (row, y) in rows.iter().zip(bend(&rows)) {
        let v = |k: usize| f64s([row[k], row[k + 1], row[k + 2]]);
        let (d, ng, ns) = (v(0), v(3), v(6));
        let eta = f64::from(row[9]) / f64::from(row[10]);
        assert!(y.t.is_finite() && y.mirrored.is_finite() && (0.0..=1.0).contains(&y.fresnel), "{row:?}");
        let Some(e) = expected(d, ng, ns, eta) else {
            close += 1;
            continue;
        };
        assert_eq!((y.passed, y.bent, y.mirror_bent), (e.t.is_some(), e.bent, e.mirror_bent), "{row:?}");
        bent += usize::from(e.bent > 0.0);
        let side = d.dot(ng).signum();
        assert!(y.mirrored.dot(ng) * side < 0.0, "{row:?}: mirrored through the surface");
        assert!((y.mirrored - e.mirrored.normalize()).length() <= DIRECTION, "{row:?}");
        let Some(t) = e.t else {
            assert_eq!(y.fresnel, 1.0, "{row:?}");
            continue;
        };
        assert!(y.t.dot(ng) * side > 0.0, "{row:?}: refracted to the side it came from");
        let allowed = DIRECTION * eta.max(1.0) + root_error(e.k, SQUARED_COSINE * eta.max(1.0).powi(2));
        assert!((y.t - t.normalize()).length() <= allowed, "{row:?}: {} for {t}", y.t);
        let reflectance = optics::fresnel(-d.dot(e.normal), row[9].into(), row[10].into());
        assert!((y.fresnel - reflectance).abs() <= REFLECTANCE, "{row:?}: {} for {reflectance}", y.fresnel);
    }
    assert!(bent > 2000 && close < rows.len() / 50, "{bent} bent, {close} too close to call");
}

/// Where both normals are one, nothing is ever counted, not even at exact grazing.
#[test]
fn flat_surfaces_count_nothing() {
    let mut random = Random(61);
    let rows: Vec<Row> = (0..5000)
        .map(|i| {
            let (n, d) = (f32s(random.direction()), f32s(random.direction()));
            let (n, d) = if i % 10 == 0 { ([0.0, 1.0, 0.0], [0.6, 0.0, 0.8]) } else { (n, d) };
            [d[0], d[1], d[2], n[0], n[1], n[2], n[0], n[1], n[2], 1.0, 1.5]
        })
        .collect();
    for (row, y) in rows.iter().zip(bend(&rows)) {
        assert_eq!((y.passed, y.bent, y.mirror_bent), (true, 0.0, 0.0), "{row:?}");
    }
}
