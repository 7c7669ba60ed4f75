//! Boxes, disks, tubes and bowls against float64: at random, past edges, grazing, along the axis, from the surface, from afar.
use super::{UNIT_ROUNDOFF, f32s, f64s};
use crate::common::{Probe, gpu, random::Random};
use glam::DVec3;

/// Roundings of a place, in units of the coordinates that take part.
const ROUNDINGS: f64 = 4.0;
/// A discriminant's error: a place's rounding times the steepest slope (√5) of a shape's equation, and its own.
const STEEPEST: f64 = 8.0;
/// As many may pass an edge too near to be told: most of those that graze from afar.
const UNTOLD: f64 = 0.3;
const RAYS: usize = 40_000;
/// Where the tubes and bowls below are cut.
const CUT: f64 = 0.25;

/// Radians of the sine from its middle to its side.
const WAVE: f64 = 9.0;
const PHASE: f64 = 0.7;

/// o, d
type Row = [f32; 6];

/// A crossing with the whole surface: where along the ray, and the unit normal there.
type Crossing = (f64, DVec3);

struct Case {
    name: &'static str,
    /// GLSL: the hit, and the place that it names.
    hit: &'static str,
    place: &'static str,
    /// Crossings in float64, and the least of what decides whether there are any, over |d|².
    crossings: fn(DVec3, DVec3) -> (Vec<Crossing>, f64),
    /// Of a direction, the part across what the surface is straight along.
    across: fn(DVec3) -> f64,
    /// How far inside the part that is there a place lies; negative outside.
    inside: fn(DVec3) -> f64,
    /// A place on the surface from two numbers in [−1, 1]; its edges and rim are among them.
    on: fn(f64, f64) -> DVec3,
}

fn flat(v: DVec3) -> DVec3 {
    v.with_z(0.0)
}

fn planes(o: DVec3, d: DVec3, axes: std::ops::Range<usize>, sides: &[f64]) -> (Vec<Crossing>, f64) {
    let one = |axis: usize, side: f64| ((side - o[axis]) / d[axis], DVec3::AXES[axis]);
    (axes.flat_map(|axis| sides.iter().map(move |side| one(axis, *side))).collect(), f64::INFINITY)
}

fn tube(o: DVec3, d: DVec3) -> (Vec<Crossing>, f64) {
    let (a, b) = (flat(d).length_squared(), flat(o).dot(d));
    let half = 1.0 - flat(o - d * (b / a)).length_squared();
    let root = (half / a).sqrt();
    let crossing = |t: f64| (t, flat(o + d * t));
    let all = if half >= 0.0 { vec![crossing(-b / a - root), crossing(-b / a + root)] } else { vec![] };
    (all, half)
}

fn bowl(o: DVec3, d: DVec3) -> (Vec<Crossing>, f64) {
    let near = o - d * (o.dot(d) / d.length_squared());
    let (a, h) = (flat(d).length_squared(), flat(near).dot(d) - 0.5 * d.z);
    let c = flat(near).length_squared() - near.z;
    let discriminant = h * h - a * c;
    let q = -(h + discriminant.sqrt().copysign(h));
    let start = -o.dot(d) / d.length_squared();
    let crossing = |t: f64| (start + t, (2.0 * flat(near + d * t) - DVec3::Z).normalize());
    let all = if discriminant >= 0.0 { vec![crossing(q / a), crossing(c / q)] } else { vec![] };
    (all, discriminant / d.length_squared())
}

/// By small steps through the sheet's box, roots by halves; what decides is the height where it turns, over the slope of
/// the steepest place.
fn wave(o: DVec3, d: DVec3) -> (Vec<Crossing>, f64) {
    const STEPS: usize = 2000;
    let height = |t: f64| o.z + d.z * t - (WAVE * (o.x + d.x * t) + PHASE).sin();
    let [mut from, mut to] = [f64::NEG_INFINITY, f64::INFINITY];
    for (axis, reach) in [1.3, 1.3, 1.01].into_iter().enumerate().filter(|(axis, _)| d[*axis] != 0.0) {
        let [a, b] = [-reach, reach].map(|side| (side - o[axis]) / d[axis]);
        [from, to] = [from.max(a.min(b)), to.min(a.max(b))];
    }
    if from >= to {
        return (vec![], f64::INFINITY);
    }
    let at = |k: usize| from + (to - from) * k as f64 / STEPS as f64;
    let heights: Vec<f64> = (0..=STEPS).map(|k| height(at(k))).collect();
    let mut all = vec![];
    for k in (0..STEPS).filter(|k| (heights[*k] < 0.0) != (heights[k + 1] < 0.0)) {
        let (mut low, mut high) = (at(k), at(k + 1));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (height(middle) < 0.0) == (heights[k] < 0.0) { low = middle } else { high = middle }
        }
        let slope = WAVE * (WAVE * (o.x + d.x * low) + PHASE).cos();
        all.push((low, DVec3::new(-slope, 0.0, 1.0).normalize()));
    }
    let turn = |w: &[f64]| w[1] - (w[2] - w[0]).powi(2) / (8.0 * (w[0] - 2.0 * w[1] + w[2]));
    let turns = heights.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) <= 0.0).map(|w| turn(w).abs());
    (all, turns.fold(f64::INFINITY, f64::min) / WAVE)
}

fn rest(p: DVec3, axis: usize) -> f64 {
    1.0 - (p.abs() * (1.0 - DVec3::AXES[axis])).max_element()
}

const CASES: [Case; 5] = [
    Case {
        name: "box",
        hit: "hit_box(ray, NO_HIT, k, uv)",
        place: "box_place(k, uv)",
        crossings: |o, d| planes(o, d, 0..3, &[-1.0, 1.0]),
        across: |d| flat(d).length(),
        inside: |p| {
            let axis = (0..3).fold(0, |best, k| if p[k].abs() > p[best].abs() { k } else { best });
            rest(p, axis)
        },
        on: |u, v| DVec3::new(1.0, u, v),
    },
    Case {
        name: "disk",
        hit: "hit_disk(ray, NO_HIT, uv)",
        place: "vec3(uv, 0.0)",
        crossings: |o, d| planes(o, d, 2..3, &[0.0]),
        across: |d| flat(d).length(),
        inside: |p| 1.0 - flat(p).length(),
        on: |u, v| flat(DVec3::new(u, v, 0.0)),
    },
    Case {
        name: "cylinder",
        hit: "hit_cylinder(ray, 0.25, NO_HIT, k, uv)",
        place: "vec3(cylinder_normal(k, uv.x).xy, uv.y)",
        crossings: tube,
        across: |d| flat(d).length(),
        inside: |p| p.z.min(1.0 - p.z).min(p.x - CUT),
        on: |u, v| DVec3::new((1.3 * u).cos(), (1.3 * u).sin(), 0.5 + 0.5 * v),
    },
    Case {
        name: "paraboloid",
        hit: "hit_paraboloid(ray, 0.25, NO_HIT, uv)",
        place: "vec3(uv, dot(uv, uv))",
        crossings: bowl,
        across: |d| flat(d).length(),
        inside: |p| (1.0 - flat(p).length()).min(p.x - CUT),
        on: |u, v| DVec3::new(u, v, u * u + v * v),
    },
    Case {
        name: "sine",
        hit: "hit_sine(ray, vec2(9.0, 0.7), NO_HIT, uv)",
        place: "vec3(uv, sin(9.0 * uv.x + 0.7))",
        crossings: wave,
        across: |d| d.x.abs(),
        inside: |p| rest(p, 2),
        on: |u, v| DVec3::new(u, v, (WAVE * u + PHASE).sin()),
    },
];

/// t (infinite for a miss) and place of each ray.
fn hits(case: &Case, rows: &[Row]) -> Vec<(f64, DVec3)> {
    let body = format!(
        "LocalRay ray = local_ray(q.o, q.d); uint k = 0u; vec2 uv = vec2(0.0); r.t = {}; r.place = {};\
         if (r.t == NO_HIT) r.t = 1.0 / 0.0;",
        case.hit, case.place
    );
    let probe = Probe {
        includes: &["shared/canonical.glsl", "shared/sine.glsl"],
        input: "vec3 o; vec3 d;",
        output: "float t; vec3 place;",
        body: &body,
        ..Default::default()
    };
    let outputs: Vec<[f32; 4]> = probe.run(&gpu(), rows);
    outputs.iter().map(|y| (y[0].into(), f64s([y[1], y[2], y[3]]))).collect()
}

fn row(o: DVec3, d: DVec3) -> Row {
    let (o, d) = (f32s(o), f32s(d));
    [o[0], o[1], o[2], d[0], d[1], d[2]]
}

/// In turn at random, tangent to the surface, along an axis, nearly along it; from places near, far and within, with
/// directions long and short.
fn rays(case: &Case, seed: u64) -> Vec<Row> {
    let mut random = Random(seed);
    let ray = |i: usize| {
        let on = (case.on)(random.within(-1.1, 1.1), random.within(-1.1, 1.1));
        let reach = [0.3, 1.5, 8.0, 1e4][i / 4 % 4];
        let d = match i % 4 {
            0 => random.direction(),
            1 => {
                let (_, n) = (case.crossings)(on - DVec3::new(0.3, 0.2, 0.7), DVec3::new(0.3, 0.2, 0.7)).0[0];
                (random.direction().cross(n) + n * random.within(-1e-3, 1e-3)).normalize_or(DVec3::X)
            }
            2 => DVec3::AXES[random.below(3)] * [1.0, -1.0][random.below(2)],
            _ => (DVec3::Z + 10f64.powi(-(random.below(6) as i32)) * random.direction()).normalize(),
        };
        row(on - d * reach, d * 10f64.powi(i as i32 / 16 % 7 - 3))
    };
    (0..RAYS).map(ray).collect()
}

/// What is wrong with a hit, or none; `Ok(false)` where float32 cannot tell.
fn judge(case: &Case, r: &Row, t: f64, place: DVec3) -> Result<bool, String> {
    let (o, d) = (f64s([r[0], r[1], r[2]]), f64s([r[3], r[4], r[5]]));
    let rounding = ROUNDINGS * UNIT_ROUNDOFF * (1.0 + o.length());
    let (crossings, decides) = (case.crossings)(o, d);
    let along = |(t, n): &Crossing| {
        // A tangent's crossings are lost in the root of the rounding, an inflection's in its cube root, as long as the ray
        // crosses the axis.
        let cosine = d.normalize().dot(*n).abs();
        let across = (case.across)(d.normalize());
        let allowed =
            2.0 * rounding / cosine.max((STEEPEST * rounding).powf(2.0 / 3.0) * across).max(f64::MIN_POSITIVE);
        (*t, allowed, (case.inside)(o + d * *t))
    };
    let mut all: Vec<_> = crossings.iter().map(along).filter(|c| c.0.is_finite()).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let told = |c: &&(f64, f64, f64)| c.2 > c.1 + rounding && c.0 * d.length() > c.1;
    let nearest = all.iter().find(told);
    if t.is_finite() {
        let hit = all.iter().find(|c| (t - c.0).abs() * d.length() <= c.1 && c.2 >= -c.1 - rounding);
        let tangent = decides.abs() < STEEPEST * rounding;
        let Some(hit) = hit else { return if tangent { Ok(false) } else { Err("hits what is not there".to_owned()) } };
        let beside = (place - o - d * hit.0).length();
        if beside > hit.1 + rounding {
            return Err(format!("names a place {beside:e} beside, {:e} allowed", hit.1));
        }
        // A root that float32 cannot tell from the far one's neighbour is not missed.
        let missed = nearest.is_some_and(|c| c.0 + c.1 / d.length() < t - hit.1 / d.length());
        let wrong = missed && !tangent;
        return if wrong { Err("misses a nearer crossing".to_owned()) } else { Ok(!missed) };
    }
    let clear = decides > STEEPEST * rounding;
    match nearest {
        Some(c) if clear => Err(format!("misses the crossing at {} ({:e} inside)", c.0, c.2)),
        Some(_) => Ok(false),
        None => Ok(all.iter().all(|c| c.2 < -c.1 || c.0 < 0.0)),
    }
}

#[test]
fn canonical_shapes_are_hit_where_they_are() {
    for (k, case) in CASES.iter().enumerate() {
        let rows = rays(case, 60 + k as u64);
        let (mut found, mut untold, mut wrong) = (0, 0, vec![]);
        for (r, (t, place)) in rows.iter().zip(hits(case, &rows)) {
            found += usize::from(t.is_finite());
            match judge(case, r, t, place) {
                Ok(told) => untold += usize::from(!told),
                Err(why) => wrong.push(format!("{r:?}: {t} {why}")),
            }
        }
        println!("{}: {found} hits, {untold} untold, {} wrong", case.name, wrong.len());
        assert!(wrong.is_empty(), "{}: {} wrong, such as {:#?}", case.name, wrong.len(), &wrong[..wrong.len().min(5)]);
        assert!(found > RAYS / 4 && (untold as f64) < UNTOLD * RAYS as f64, "{}", case.name);
    }
}

/// From inside a box every ray meets it, whatever edge or corner it is aimed at.
#[test]
fn no_ray_leaves_a_box_between_its_faces() {
    let mut random = Random(70);
    let rows: Vec<Row> = (0..RAYS)
        .map(|i| {
            let o = DVec3::new(random.within(-1.0, 1.0), random.within(-1.0, 1.0), random.within(-1.0, 1.0));
            // A corner, an edge, or beside one by roundings.
            let corner = DVec3::from([0, 1, 2].map(|_| [1.0, -1.0][random.below(2)]));
            let along = DVec3::AXES[random.below(3)] * random.within(0.0, 2.0) * [0.0, 1.0][i % 2];
            let beside = random.direction() * [0.0, 1e-7][i / 2 % 2];
            row(o, (corner - corner * along + beside - o) * [1.0, 1e-3][i / 4 % 2])
        })
        .collect();
    for (r, (t, place)) in rows.iter().zip(hits(&CASES[0], &rows)) {
        assert!(t.is_finite() && place.abs().max_element() == 1.0, "{r:?}: {t} {place}");
    }
}

#[test]
fn rays_without_direction_hit_nothing() {
    let rows = [row(DVec3::ZERO, DVec3::ZERO), row(DVec3::splat(0.5), DVec3::ZERO), row(DVec3::NAN, DVec3::X)];
    for case in &CASES[1..] {
        assert!(hits(case, &rows).iter().all(|(t, _)| t.is_infinite()), "{}", case.name);
    }
}
