//! Rays that go on from boxes, disks, tubes and bowls: none meets the place it leaves, and every chord is found.
use super::surface::placed;
use super::{f32s, f64s};
use crate::common::{Probe, cpu::LocalRay, cpu::canonical_of, gpu, picture::written, random::Random};
use glam::DVec3;
use nephroid::passes::{
    accel::{SHAPE_MESH, SHAPE_QUAD, SceneArrays},
    scene::SceneBuffers,
};

const RAYS: usize = 20_000;
/// A start off the surface moves the far end of a chord by that over the cosine; beyond a hundredth of it, something
/// else was met, or the ray was lost.
const CHORD: f64 = 0.01;
/// A chord shorter than this, over the coordinates, ends where it starts as far as float32 tells.
const SHORT: f64 = 1e-4;
/// What float64 takes for nothing, over the coordinates.
const EXACT: f64 = 1e-10;
/// Rays that pass an edge or a rim on another side than in float64: as many of 80,000 at most.
const EDGES: usize = 20;

#[derive(Clone, Copy)]
struct Left {
    p: DVec3,
    d: DVec3,
    instance: usize,
    t: f64,
    again: bool,
}

/// The mirrored and the inward ray of each first hit: where it starts, and what it meets of the shape that it leaves.
fn left(arrays: &SceneArrays, scene: &nephroid::scene::Scene, rays: &[[f32; 6]]) -> Vec<Left> {
    let probe = Probe {
        includes: &["shared/interface.glsl"],
        input: "vec3 o; vec3 d;",
        output: "vec3 p; vec3 d[2]; float instance; float t[2]; float again[2];",
        body: "r.p = vec3(0.0); r.instance = -1.0;\
               for (int k = 0; k < 2; k++) { r.d[k] = q.d; r.t[k] = -1.0; r.again[k] = 0.0; }\
               Hit hit;\
               if (trace(q.o, q.d, 1e30, MASK_ALL, hit)) {\
                 Surface s = surface_at(q.o, q.d, hit);\
                 r.p = s.p; r.instance = float(hit.instance);\
                 for (int k = 0; k < 2; k++) {\
                   vec3 d = reflect_ray(q.d, s.ng);\
                   if (k == 1 && !refract_ray(q.d, facing_normal(s, q.d), 1.0 / 1.5, d)) d = q.d;\
                   r.d[k] = d;\
                   Hit next;\
                   if (!trace(leave(s, d), d, 1e30, MASK_ALL, next)) continue;\
                   r.t[k] = next.t;\
                   r.again[k] = next.instance == hit.instance ? 1.0 : 0.0;\
                 }\
               }",
        ..Default::default()
    };
    let outputs: Vec<[f32; 14]> = probe.run_with(&gpu(), rays, |plan| {
        let buffers = SceneBuffers::upload(plan, scene, arrays);
        Box::new(move |pass| buffers.tracing(pass))
    });
    let of = |y: &[f32; 14]| {
        let (p, instance) = (f64s([y[0], y[1], y[2]]), y[9]);
        let one = |k: usize| Left {
            p,
            d: f64s([y[3 + 3 * k], y[4 + 3 * k], y[5 + 3 * k]]),
            instance: instance as usize,
            t: f64::from(y[10 + k]),
            again: y[12 + k] > 0.0,
        };
        (instance >= 0.0).then(|| [one(0), one(1)])
    };
    outputs.iter().filter_map(of).flatten().collect()
}

/// Rays at the shapes from about them, a third of them nearly level.
fn rays(scale: f64, shift: DVec3) -> Vec<[f32; 6]> {
    let mut random = Random(71);
    let ray = |i: usize| {
        let from =
            (random.direction() * DVec3::new(1.0, [0.02, 1.0, 1.0][i % 3], 1.0)).normalize() * 4.0 + DVec3::Y * 0.5;
        let target = DVec3::new(random.within(-2.0, 2.0), random.within(0.0, 1.2), random.within(-1.5, 1.8));
        let (o, d) = (f32s((from + shift) * scale), f32s((target - from).normalize()));
        [o[0], o[1], o[2], d[0], d[1], d[2]]
    };
    (0..RAYS).map(ray).collect()
}

#[test]
fn no_ray_meets_the_canonical_shape_it_leaves_but_at_its_chords_end() {
    let far = DVec3::new(80.0, 7.0, -90.0);
    let (mut chords, mut odd) = (0, vec![]);
    for (scale, shift) in [(1.0, DVec3::ZERO), (1e-3, DVec3::ZERO), (1e3, DVec3::ZERO), (1.0, far)] {
        let scene = placed(written(include_str!("../../common/shapes.toml"), &[]), scale, shift);
        let arrays = SceneArrays::build(&scene).unwrap();
        let size = scale * (4.0 + shift.length());
        for ray in left(&arrays, &scene, &rays(scale, shift)) {
            let instance = &arrays.instances[ray.instance];
            if [SHAPE_QUAD, SHAPE_MESH].contains(&instance.kind) {
                assert!(!ray.again, "a quad is met again");
                continue;
            }
            let (shape, local) = (canonical_of(instance), LocalRay::new(instance, f32s(ray.p), f32s(ray.d)));
            // The box's next face, or the other end of the chord, in float64 from the very place.
            let chord = shape.meet(shape.foot(local.o).0, local.d, EXACT * size, true);
            if chord.is_some_and(|chord| chord < SHORT * size) {
                continue; // across an edge
            }
            let before = chord.unwrap_or(f64::INFINITY) * (1.0 - CHORD);
            assert!(
                !ray.again || ray.t > SHORT * size || ray.t > before,
                "{shape:?} at {scale}, {shift}: met again at {} of {chord:?}",
                ray.t
            );
            let lost = chord.is_some_and(|chord| ray.t < 0.0 || ray.t > chord * (1.0 + CHORD));
            chords += usize::from(chord.is_some());
            if lost || ray.again && ray.t < before {
                odd.push(format!("{shape:?} at {scale}, {shift}: {} for {chord:?}", ray.t));
            }
        }
    }
    println!("{chords} chords, {} odd", odd.len());
    assert!(
        chords > RAYS && odd.len() <= EDGES,
        "{chords}: {} odd, such as {:#?}",
        odd.len(),
        &odd[..odd.len().min(9)]
    );
}
