//! Views: rays, projections, footprints, solid angles against their float64 twin.
use super::{UNIT_ROUNDOFF, f32s, f64s, worst};
use crate::common::{Probe, gpu, random::Random};
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};
use nephroid::view::{View, ViewData, basis};

/// A dozen operations on coordinates of up to twenty metres, relative to the window.
const POSITION: f64 = 100.0 * UNIT_ROUNDOFF;
/// Unit directions: a weighted sum of three unit vectors, then normalised.
const DIRECTION: f64 = 5.0 * UNIT_ROUNDOFF;
/// Some twenty operations, cosines down to a thousandth from dot products of rounded vectors.
const AREA: f64 = 20.0 * UNIT_ROUNDOFF + 4.0 * UNIT_ROUNDOFF / LEAST_COSINE;
const LEAST_COSINE: f64 = 1e-2;
/// Asked of the quadrature at 16 texels a side of a 90° view; what is left is its fourth-order term.
const SOLID_ANGLE: f64 = 1e-5;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Case {
    view: ViewData,
    xy: [f32; 2],
    p: [f32; 3],
    n: [f32; 3],
    size: [i32; 2],
    texel: [i32; 2],
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Answer {
    o: [f32; 3],
    d: [f32; 3],
    seen: f32,
    xy: [f32; 2],
    clip: [f32; 4],
    area: f32,
    angle: f32,
}

fn ask(cases: &[Case]) -> Vec<Answer> {
    let probe = Probe {
        includes: &["shared/view.glsl"],
        input: "View view; vec2 xy; vec3 p; vec3 n; ivec2 size; ivec2 texel;",
        output: "vec3 o; vec3 d; float seen; vec2 xy; vec4 clip; float area; float angle;",
        body: "view_ray(q.view, q.xy, r.o, r.d);\
               bool seen = view_project(q.view, q.p, r.xy); r.seen = seen ? 1.0 : 0.0;\
               r.clip = view_clip(q.view, q.p);\
               r.area = view_texel_area(q.view, q.size, r.xy, q.p, q.n);\
               r.angle = view_texel_solid_angle(q.view, q.size, q.texel);",
        ..Default::default()
    };
    probe.run(&gpu(), cases)
}

/// The view that the shader has: every number rounded to float32 first.
fn rounded(view: &View) -> View {
    let d = view.data();
    let (low, high) = (DVec2::new(d.x0.into(), d.y0.into()), DVec2::new(d.x1.into(), d.y1.into()));
    let (origin, right, up, forward) = (f64s(d.origin), f64s(d.right), f64s(d.up), f64s(d.forward));
    View {
        origin,
        right,
        up,
        forward,
        low,
        high,
        near: d.near.into(),
        far: d.far.into(),
        perspective: view.perspective,
    }
}

fn random_view(random: &mut Random, perspective: bool) -> View {
    let forward = random.direction();
    let (right, up) = basis(forward);
    let high = DVec2::new(random.within(0.2, 1.5), random.within(0.2, 1.5));
    let low = DVec2::new(random.within(-1.5, 0.1), random.within(-1.5, 0.1));
    let origin = random.direction() * 5.0;
    let near = if perspective { random.within(0.0, 0.5) } else { random.within(-4.0, 0.5) };
    rounded(&View { origin, right, up, forward, low, high, near, far: 20.0, perspective })
}

/// Cases whose point lies on the ray through `xy`, at a random depth.
fn cases(seed: u64) -> Vec<(View, Case)> {
    let mut random = Random(seed);
    (0..4000)
        .map(|i| {
            let view = random_view(&mut random, i % 2 == 0);
            let xy = [random.unit() as f32, random.unit() as f32];
            let (o, d) = view.ray(DVec2::new(xy[0].into(), xy[1].into()));
            let p = f32s(o + d * random.within(0.5, 10.0));
            let along = if view.perspective { f64s(p) - view.origin } else { view.forward };
            let n = loop {
                let n = random.direction();
                if n.dot(along.normalize()).abs() > LEAST_COSINE {
                    break f32s(n);
                }
            };
            (view, Case { view: view.data(), xy, p, n, size: [640, 480], texel: [0, 0] })
        })
        .collect()
}

#[test]
fn rays_and_projections_agree_with_float64() {
    let cases = cases(40);
    let answers = ask(&cases.iter().map(|c| c.1).collect::<Vec<_>>());
    let errors = cases.iter().zip(&answers).map(|((view, case), a)| {
        let (o, d) = view.ray(DVec2::new(case.xy[0].into(), case.xy[1].into()));
        let at = view.project(f64s(case.p)).expect("the point lies on a ray");
        assert_eq!(a.seen, 1.0);
        let window = (view.high - view.low).min_element();
        let scale = if view.perspective { (f64s(case.p) - view.origin).dot(view.forward).min(1.0) } else { 1.0 };
        let projected = (DVec2::new(a.xy[0].into(), a.xy[1].into()) - at).length() * window * scale;
        // Clip space: the same place, y downwards, and depth from 0 to 1.
        let [x, y, depth, w] = a.clip.map(f64::from);
        let clip = (DVec2::new(x / w, y / w) * 0.5 + 0.5 - at).length() * window * scale;
        assert!((-POSITION..=1.0).contains(&(depth / w)), "{depth} / {w}");
        let start = (f64s(a.o) - o).length();
        let turn = (f64s(a.d) - d.normalize()).length();
        (projected.max(clip).max(start), turn)
    });
    let (places, turns): (Vec<f64>, Vec<f64>) = errors.unzip();
    assert!(worst(places.clone()) <= POSITION, "{:e}", worst(places));
    assert!(worst(turns.clone()) <= DIRECTION, "{:e}", worst(turns));
}

#[test]
fn what_lies_before_the_near_plane_is_not_seen() {
    let mut random = Random(41);
    let inputs: Vec<Case> = (0..500)
        .flat_map(|i| {
            let view = random_view(&mut random, i % 2 == 0);
            let behind = view.origin + view.forward * (view.near - 0.01);
            let odd = [f32s(behind), [f32::NAN; 3], [f32::INFINITY, 0.0, 0.0]];
            odd.map(|p| Case { view: view.data(), xy: [0.5; 2], p, n: [0.0, 1.0, 0.0], size: [4; 2], texel: [0; 2] })
        })
        .collect();
    for (case, a) in inputs.iter().zip(ask(&inputs)) {
        assert_eq!(a.seen, 0.0, "{:?}", case.p);
        assert!(a.xy.iter().all(|x| x.is_finite()));
    }
}

/// The footprint by differences: the rays a millitexel around meet the plane in a quadrilateral of this area.
fn footprint(view: &View, case: &Case) -> f64 {
    const STEP: f64 = 1e-3;
    let (p, n) = (f64s(case.p), f64s(case.n));
    let at = view.project(p).expect("seen");
    let size = DVec2::new(case.size[0].into(), case.size[1].into());
    let corner = |x: f64, y: f64| {
        let (o, d) = view.ray(at + DVec2::new(x, y) * STEP * 0.5 / size);
        o + d * ((p - o).dot(n) / d.dot(n))
    };
    let (a, b, c, d) = (corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0));
    0.5 * (c - a).cross(d - b).length() / (STEP * STEP)
}

#[test]
fn footprints_agree_with_differences() {
    let cases = cases(42);
    let answers = ask(&cases.iter().map(|c| c.1).collect::<Vec<_>>());
    let error = worst(cases.iter().zip(&answers).map(|((view, case), a)| {
        let expected = footprint(view, case);
        (f64::from(a.area) - expected).abs() / expected
    }));
    assert!(error <= AREA, "{error:e}");
}

#[test]
fn footprints_without_bound_stay_finite() {
    let mut random = Random(43);
    let mut inputs = Vec::new();
    for i in 0..1000 {
        let view = random_view(&mut random, i % 2 == 0);
        let p = view.origin + view.forward * [3.0, 0.0, 1e-20, -1.0][i % 4];
        let n = if i % 8 < 4 { view.right } else { DVec3::ZERO };
        inputs.push(Case { view: view.data(), xy: [0.5; 2], p: f32s(p), n: f32s(n), size: [4096; 2], texel: [0; 2] });
    }
    for (case, a) in inputs.iter().zip(ask(&inputs)) {
        assert!(a.area > 0.0 && a.area.is_finite(), "{:?}: {}", case.p, a.area);
    }
}

/// Ω of the rectangle (0, 0)–(x, y) at unit distance, exact.
fn corner_angle(x: f64, y: f64) -> f64 {
    (x * y).atan2((1.0 + x * x + y * y).sqrt())
}

#[test]
fn solid_angles_of_texels_agree_with_the_closed_form() {
    let (right, up) = basis(DVec3::NEG_Z);
    let view = rounded(&View {
        origin: DVec3::ZERO,
        right,
        up,
        forward: DVec3::NEG_Z,
        low: DVec2::splat(-1.0),
        high: DVec2::splat(1.0),
        near: 0.1,
        far: 10.0,
        perspective: true,
    });
    for side in [16, 64, 1024] {
        let texels = (0..side * side).step_by((side * side / 256) as usize).map(|i| [i % side, i / side]);
        let data = view.data();
        let inputs: Vec<Case> = texels
            .map(|texel| Case {
                view: data,
                xy: [0.5; 2],
                p: [0.0, 0.0, -1.0],
                n: [0.0, 0.0, 1.0],
                size: [side; 2],
                texel,
            })
            .collect();
        let error = worst(inputs.iter().zip(ask(&inputs)).map(|(case, a)| {
            let edge = |k: i32| 2.0 * f64::from(k) / f64::from(side) - 1.0;
            let ([x0, y0], [x1, y1]) = (case.texel.map(edge), case.texel.map(|k| edge(k + 1)));
            let expected = corner_angle(x1, y1) - corner_angle(x0, y1) - corner_angle(x1, y0) + corner_angle(x0, y0);
            (f64::from(a.angle) - expected).abs() / expected
        }));
        assert!(error <= SOLID_ANGLE, "{side}: {error:e}");
    }
}
