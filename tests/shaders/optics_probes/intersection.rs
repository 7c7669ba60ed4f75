//! Boxes and the canonical shapes against float64.
use super::{UNIT_ROUNDOFF, f32s, f64s, root_error};
use crate::common::{Probe, gpu, random::Random};
use glam::{DVec2, DVec3};

/// Rays start up to this many radii away.
const REACH: f64 = 8.0;
/// Places: a few roundings of coordinates as large as the way to the shape.
const PLACE: f64 = 4.0 * UNIT_ROUNDOFF * REACH;
/// 1 − |nearest point|²: the point carries the rounding of the way to it.
const DISCRIMINANT: f64 = 2.0 * PLACE;
/// The same for a ray that starts on the sphere: half a dozen roundings of numbers of order one.
const NEAR: f64 = 6.0 * UNIT_ROUNDOFF;
/// An inverse off by a few roundings moves the whole way to a box by that share; so does nothing else of its size.
const SLAB: f64 = 8.0 * UNIT_ROUNDOFF;

/// o, d, and three corners for a triangle.
type Row = [f32; 15];

fn row(o: DVec3, d: DVec3, corners: [DVec3; 3]) -> Row {
    let mut row = [0.0; 15];
    for (k, v) in [o, d].into_iter().chain(corners).enumerate() {
        row[3 * k..3 * k + 3].copy_from_slice(&f32s(v));
    }
    row
}

fn part(row: &Row, k: usize) -> DVec3 {
    f64s([row[3 * k], row[3 * k + 1], row[3 * k + 2]])
}

/// t (infinite for a miss) and uv of each ray.
fn hits(call: &str, rows: &[Row]) -> Vec<(f64, DVec2)> {
    let body = format!(
        "LocalRay ray = local_ray(q.o, q.d); r.uv = vec2(0); r.t = {call}; if (r.t == NO_HIT) r.t = 1.0 / 0.0;"
    );
    let probe = Probe {
        includes: &["shared/intersect.glsl"],
        input: "vec3 o; vec3 d; vec3 a; vec3 b; vec3 c;",
        output: "float t; vec2 uv;",
        body: &body,
        ..Default::default()
    };
    let outputs: Vec<[f32; 3]> = probe.run(&gpu(), rows);
    outputs.iter().map(|y| (y[0].into(), DVec2::new(y[1].into(), y[2].into()))).collect()
}

const NO_CORNERS: [DVec3; 3] = [DVec3::ZERO; 3];

/// The crossings with the unit sphere, and the squared half chord.
fn sphere(o: DVec3, d: DVec3) -> (f64, f64, f64) {
    let (a, b) = (d.length_squared(), o.dot(d));
    let half = 1.0 - (o - d * (b / a)).length_squared();
    let root = (half.max(0.0) / a).sqrt();
    (-b / a - root, -b / a + root, half)
}

/// From far, near, inside, past the limb; directions long and short, as instances make them.
fn sphere_rows() -> Vec<Row> {
    let mut random = Random(50);
    (0..40_000)
        .map(|i| {
            let o = random.direction() * [REACH, 1.01, 0.5, 3.0][i % 4];
            // Where a tangent from o meets the plane through the centre; from inside there is none.
            let limb = random.direction().cross(o).normalize() / (1.0 - 1.0 / o.length_squared()).max(0.1).sqrt();
            let aim = [random.direction() * random.within(0.0, 1.3), limb, limb * (1.0 - 1e-3), limb * (1.0 + 1e-3)];
            row(o, (aim[i / 4 % 4] - o).normalize() * 10f64.powi(i as i32 / 16 % 7 - 3), NO_CORNERS)
        })
        .collect()
}

#[test]
fn spheres_are_hit_where_they_are() {
    let rows = sphere_rows();
    let (mut grazing, mut missed) = (0, 0);
    for (r, (t, _)) in rows.iter().zip(hits("hit_sphere(ray, NO_HIT)", &rows)) {
        let (o, d) = (part(r, 0), part(r, 1));
        let (near, far, half) = sphere(o, d);
        if half.abs() < DISCRIMINANT {
            grazing += 1; // a hit or a miss; where a hit, near the limb
            assert!(t.is_infinite() || ((o + d * t).length() - 1.0).abs() < DISCRIMINANT, "{r:?}: {t}");
            continue;
        }
        let expected = [near, far].into_iter().find(|t| *t > 0.0 && half > 0.0).unwrap_or(f64::INFINITY);
        missed += usize::from(expected.is_infinite());
        let allowed = PLACE + root_error(half, DISCRIMINANT);
        let error = if t == expected { 0.0 } else { (t - expected).abs() * d.length() };
        assert!(error <= allowed, "{r:?}: {t} for {expected}, {error:e} above {allowed:e}");
    }
    assert!(grazing > 1000 && missed > 5000, "{grazing} {missed}");
}

/// A chord from a point of the sphere itself: the near crossing is nothing, the far one 2 cosθ away.
#[test]
fn chords_inside_a_sphere_reach_the_other_side() {
    let mut random = Random(51);
    let rows: Vec<Row> = (0..10_000)
        .map(|_| {
            let n = random.direction();
            let d = (random.direction() - n * 1.0001).normalize();
            row(n * (1.0 - 1e-6), d, NO_CORNERS)
        })
        .collect();
    for (r, (t, _)) in rows.iter().zip(hits("hit_sphere(ray, NO_HIT)", &rows)) {
        let (_, far, half) = sphere(part(r, 0), part(r, 1));
        let allowed = NEAR + root_error(half, NEAR);
        assert!((t - far).abs() <= allowed, "{r:?}: {t} for {far}, allowed {allowed:e}");
    }
}

#[test]
fn quads_are_hit_inside_their_edges_only() {
    let mut random = Random(52);
    let rows: Vec<Row> = (0..20_000)
        .map(|i| {
            let target = DVec3::new(random.within(-1.5, 1.5), random.within(-1.5, 1.5), 0.0);
            let o = random.direction() * [REACH, 0.1][i % 2];
            row(o, (target - o).normalize() * [1.0, 1e-3][i / 2 % 2], NO_CORNERS)
        })
        .chain([row(DVec3::X * 0.5, DVec3::X, NO_CORNERS), row(DVec3::ZERO, DVec3::Z, NO_CORNERS)])
        .collect();
    let mut found = 0;
    for (r, (t, uv)) in rows.iter().zip(hits("hit_quad(ray, NO_HIT, r.uv)", &rows)) {
        let (o, d) = (part(r, 0), part(r, 1));
        let expected = -o.z / d.z;
        let at = o + d * expected;
        let reach = at.abs().truncate().max_element();
        // At grazing the way to the plane is long, and its rounding with it.
        let allowed = PLACE / d.normalize().z.abs();
        if (reach - 1.0).abs() <= allowed {
            continue;
        }
        let inside = expected > 0.0 && reach < 1.0;
        assert_eq!(t.is_finite(), inside, "{r:?}: {t}");
        if inside {
            found += 1;
            assert!((t - expected).abs() * d.length() <= allowed && (uv - at.truncate()).length() <= allowed, "{r:?}");
        }
    }
    assert!(found > 5000, "{found}");
}

/// Barycentric weights of the crossing of the plane (of a, b, c), and t.
fn triangle(o: DVec3, d: DVec3, [a, b, c]: [DVec3; 3]) -> (f64, DVec3) {
    let n = (b - a).cross(c - a);
    let t = (a - o).dot(n) / d.dot(n);
    let p = o + d * t;
    let weight = |u: DVec3, v: DVec3| (u - p).cross(v - p).dot(n) / n.length_squared();
    (t, DVec3::new(weight(b, c), weight(c, a), weight(a, b)))
}

#[test]
fn triangles_are_hit_where_they_are() {
    let mut random = Random(53);
    let mut rows = Vec::new();
    while rows.len() < 40_000 {
        let size = [2.0, 0.1, 0.01][rows.len() % 3];
        let middle = random.direction() * random.unit();
        let corners = [(); 3].map(|()| middle + random.direction() * size);
        let o = random.direction() * random.within(2.0, REACH);
        let aim = middle + random.direction() * size * random.unit();
        rows.push(row(o, (aim - o).normalize() * [1.0, 1e-3, 1e3][rows.len() / 3 % 3], corners));
    }
    let (mut found, mut ties) = (0, 0);
    for (r, (t, uv)) in rows.iter().zip(hits("hit_triangle(ray, q.a, q.b, q.c, NO_HIT, r.uv)", &rows)) {
        let (o, d, corners) = (part(r, 0), part(r, 1), [2, 3, 4].map(|k| part(r, k)));
        let (expected, weights) = triangle(o, d, corners);
        let [a, b, c] = corners;
        let n = (b - a).cross(c - a);
        let cosine = d.normalize().dot(n.normalize()).abs();
        // A place off by PLACE across the ray is off by so much in each weight: over the triangle's heights, as seen.
        let longest = (b - a).length().max((c - a).length()).max((c - b).length());
        let allowed = PLACE * longest / (n.length() * cosine);
        if weights.min_element().abs() <= allowed {
            ties += 1;
            continue;
        }
        let inside = expected > 0.0 && weights.min_element() > 0.0;
        assert_eq!(t.is_finite(), inside, "{r:?}: {t}, weights {weights}");
        if inside {
            found += 1;
            let place = a + (b - a) * uv.x + (c - a) * uv.y;
            let exact = o + d * expected;
            assert!((place - exact).length() <= 4.0 * PLACE / cosine, "{r:?}: {place} for {exact}");
            assert!((t - expected).abs() * d.length() <= 4.0 * PLACE / cosine, "{r:?}: {t} for {expected}");
        }
    }
    assert!(found > 5000 && ties < rows.len() / 20, "{found} found, {ties} ties");
}

/// Two triangles with a common edge, rays at the edge: each ray hits one of them, or both.
#[test]
fn no_ray_passes_between_neighbours() {
    let mut random = Random(54);
    let (mut left, mut right) = (Vec::new(), Vec::new());
    for i in 0..40_000 {
        let (a, b) = (random.direction(), random.direction());
        let middle = a.lerp(b, random.within(0.2, 0.8));
        let o = middle + random.direction() * [0.3, 5.0][i % 2];
        let forward = (middle - o).normalize();
        let side = forward.cross(b - a).normalize();
        let (c, d) = (middle + side * 0.3 + random.direction() * 0.1, middle - side * 0.3 + random.direction() * 0.1);
        left.push(row(o, forward, [a, b, c]));
        right.push(row(o, forward, [b, a, d]));
    }
    let call = "hit_triangle(ray, q.a, q.b, q.c, NO_HIT, r.uv)";
    let (l, r) = (hits(call, &left), hits(call, &right));
    let between: Vec<_> = left.iter().zip(l.iter().zip(&r)).filter(|(_, (l, r))| l.0.min(r.0).is_infinite()).collect();
    // An edge seen end-on has no sides: there the ray may pass before both.
    let lost = between.iter().filter(|(row, _)| {
        let edge = (part(row, 3) - part(row, 2)).normalize();
        edge.cross(part(row, 1)).length() > 1e-3
    });
    assert_eq!(lost.count(), 0, "of {} beside edges", between.len());
}

#[test]
fn triangles_without_area_and_rays_without_direction_hit_nothing() {
    let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
    let real = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let o = DVec3::new(0.2, 0.2, 3.0);
    let rows = [
        row(DVec3::new(0.5, 0.0, 3.0), DVec3::NEG_Z, line),
        row(o, DVec3::NEG_Z, [DVec3::X; 3]),
        row(o, DVec3::X, real),
        row(o, DVec3::Z, real),
        row(DVec3::new(-3.0, 0.2, 0.0), DVec3::X, real),
    ];
    for (r, (t, _)) in rows.iter().zip(hits("hit_triangle(ray, q.a, q.b, q.c, NO_HIT, r.uv)", &rows)) {
        assert!(t.is_infinite(), "{r:?}: {t}");
    }
}

/// A box is entered wherever float64 enters it, axis-aligned rays and rays inside a face among them.
#[test]
fn no_box_is_missed() {
    let mut random = Random(55);
    let rows: Vec<Row> = (0..40_000)
        .map(|i| {
            let (a, b) = (random.direction(), random.direction());
            let flat = [DVec3::ONE, DVec3::new(1.0, 0.0, 1.0)][i % 2];
            let (lo, hi) = (a.min(b) * flat, a.max(b) * flat);
            let inside = lo + (hi - lo) * DVec3::new(random.unit(), random.unit(), random.unit());
            let axis = DVec3::from_array(std::array::from_fn(|k| f64::from(u8::from(k == i / 2 % 3))));
            let d = if i % 3 == 0 { axis * [1.0, -1.0][i / 3 % 2] } else { random.direction() };
            let o = f64s(f32s(inside)) - d * random.within(2.0, REACH);
            row(o, d, [lo, hi, DVec3::ZERO])
        })
        .collect();
    let mut tested = 0;
    for (r, (t, _)) in rows.iter().zip(hits("enter_box(ray, q.a, q.b)", &rows)) {
        let (o, d, lo, hi) = (part(r, 0), part(r, 1), part(r, 2), part(r, 3));
        let slabs = |k: usize| {
            if d[k] == 0.0 {
                return if o[k] >= lo[k] && o[k] <= hi[k] { (f64::NEG_INFINITY, f64::INFINITY) } else { (1.0, 0.0) };
            }
            let (x, y) = ((lo[k] - o[k]) / d[k], (hi[k] - o[k]) / d[k]);
            (x.min(y), x.max(y))
        };
        let all = [0, 1, 2].map(slabs);
        let enter = all.iter().map(|s| s.0).fold(f64::NEG_INFINITY, f64::max);
        let leave = all.iter().map(|s| s.1).fold(f64::INFINITY, f64::min);
        // A ray that lies in a face meets the box with its skin only: either answer is right.
        let on_face = (0..3).any(|k| d[k] == 0.0 && (o[k] == lo[k] || o[k] == hi[k]) && lo[k] < hi[k]);
        if enter <= leave && leave >= 0.0 && !on_face {
            tested += 1;
            assert!((t - enter).abs() <= PLACE / d.abs().max_element() + SLAB * enter.abs(), "{r:?}: {t} for {enter}");
        }
    }
    assert!(tested > 20_000, "{tested}");
}
