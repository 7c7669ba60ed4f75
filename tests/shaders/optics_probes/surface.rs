//! Where rays go on from: no surface is hit again by the ray that leaves it, at any scale and place of the scene.
use super::f32s;
use crate::common::{Probe, gpu, random::Random};
use glam::{DAffine3, DVec3};
use nephroid::{
    passes::{accel::SceneArrays, scene::SceneBuffers},
    scene::{Scene, Shape},
};

const RAYS: usize = 20_000;
/// The start is moved by this share of the coordinates at most: 16 roundings of each of half a dozen terms.
const OFFSET: f32 = 2e-5;
/// Metres at scale one: grazing hits lie some hundred times the coordinates' rounding (2⁻²⁴ of four metres) apart.
const SAME_PLACE: f64 = 1e-4;
/// At two scales a ray may pass an edge on two sides; so many of them at most are let off.
const TIES: usize = RAYS / 2000;

/// The scene, its lengths times `scale`, moved by `shift` (in scaled units).
fn moved(name: &str, scale: f64, shift: DVec3) -> Scene {
    placed(Scene::load(name, &[]).unwrap(), scale, shift)
}

pub fn placed(mut scene: Scene, scale: f64, shift: DVec3) -> Scene {
    for object in &mut scene.objects {
        match &mut object.shape {
            Shape::Sphere { center, radius } => {
                *center = (*center + shift) * scale;
                *radius *= scale;
            }
            Shape::Quad { center, u, v } => {
                *center = (*center + shift) * scale;
                *u *= scale;
                *v *= scale;
            }
            Shape::Mesh { to_world, .. } | Shape::Canonical { to_world, .. } => {
                let place =
                    DAffine3::from_scale_rotation_translation(DVec3::splat(scale), Default::default(), shift * scale);
                *to_world = place * *to_world;
            }
        }
    }
    scene
}

/// What came of a ray: hits a surface, leaves it along a mirrored and an inward direction.
#[derive(Clone, Copy)]
struct Track {
    t: f32,
    object: f32,
    eps: f32,
    place: f32,
    again: f32,
    inside: f32,
    curved: f32,
}

/// `again`: the outward ray meets the very primitive it left; `inside`: the inward one leaves a sphere before half a chord.
fn tracks(scene: &Scene, rays: &[[f32; 6]]) -> Vec<Track> {
    let arrays = SceneArrays::build(scene).unwrap();
    let probe = Probe {
        includes: &["shared/interface.glsl"],
        input: "vec3 o; vec3 d;",
        output: "float t; float object; float eps; float place; float again; float inside; float curved;",
        body: "r.t = -1.0; r.object = -1.0; r.eps = 0.0; r.place = 1.0; r.again = 0.0; r.inside = 1.0; r.curved = 0.0;\
               Hit hit;\
               if (trace(q.o, q.d, 1e30, MASK_ALL, hit)) {\
                 Surface s = surface_at(q.o, q.d, hit);\
                 r.t = hit.t; r.object = float(s.object); r.eps = s.eps;\
                 r.place = max(length(q.o), hit.t);\
                 vec3 out_d = reflect_ray(q.d, s.ng);\
                 Hit next;\
                 if (trace(leave(s, out_d), out_d, 1e30, MASK_ALL, next))\
                   r.again = next.instance == hit.instance && next.primitive == hit.primitive ? 1.0 : 0.0;\
                 Instance shape = scene_instances.data[hit.instance];\
                 vec3 in_d;\
                 if (shape.kind == SHAPE_SPHERE && refract_ray(q.d, facing_normal(s, q.d), 1.0 / 1.5, in_d)) {\
                   float radius = length(shape.to_world[0].xyz);\
                   float chord = 2.0 * radius * abs(dot(in_d, s.ng));\
                   r.curved = 1.0;\
                   r.inside = trace(leave(s, in_d), in_d, 1e30, MASK_SPECULAR, next) && next.t > 0.99 * chord\
                     && next.t < 1.01 * chord ? 1.0 : 0.0;\
                 }\
               }",
        ..Default::default()
    };
    let outputs: Vec<[f32; 7]> = probe.run_with(&gpu(), rays, |plan| {
        let buffers = SceneBuffers::upload(plan, scene, &arrays);
        Box::new(move |pass| buffers.tracing(pass))
    });
    let track =
        |y: &[f32; 7]| Track { t: y[0], object: y[1], eps: y[2], place: y[3], again: y[4], inside: y[5], curved: y[6] };
    outputs.iter().map(track).collect()
}

/// Rays at the middle of the scene from a sphere about it, some of them grazing a floor.
fn rays(scale: f64, shift: DVec3) -> Vec<[f32; 6]> {
    let mut random = Random(70);
    let ray = |i: usize| {
        let level = random.direction() * DVec3::new(1.0, [0.01, 1.0][i % 2], 1.0);
        let from = DVec3::new(level.x, level.y.abs(), level.z).normalize() * 4.0;
        let target = DVec3::Y * 0.5 + random.direction() * random.unit() * 1.2;
        let (o, d) = (f32s((from + shift) * scale), f32s((target - from).normalize()));
        [o[0], o[1], o[2], d[0], d[1], d[2]]
    };
    (0..RAYS).map(ray).collect()
}

#[test]
fn no_ray_meets_the_surface_it_leaves() {
    for name in ["glass-sphere", "bunny"] {
        for (scale, shift) in
            [(1.0, DVec3::ZERO), (1e-3, DVec3::ZERO), (1e3, DVec3::ZERO), (1.0, DVec3::new(80.0, 7.0, -90.0))]
        {
            let all = tracks(&moved(name, scale, shift), &rays(scale, shift));
            let hits = all.iter().filter(|y| y.t > 0.0).count();
            assert!(hits > RAYS / 3, "{name} at {scale}: {hits} hits");
            let again = all.iter().filter(|y| y.again > 0.0).count();
            assert_eq!(again, 0, "{name} at {scale}, {shift}: rays that meet the surface they leave");
            let lost = all.iter().filter(|y| y.inside == 0.0).count();
            assert_eq!(
                lost,
                0,
                "{name} at {scale}, {shift}: chords cut short, of {}",
                all.iter().filter(|y| y.curved > 0.0).count()
            );
            let far = all.iter().map(|y| y.eps / y.place).fold(0.0, f32::max);
            assert!(far <= OFFSET, "{name} at {scale}, {shift}: starts moved by {far:e} of the coordinates");
        }
    }
}

#[test]
fn a_scene_of_any_scale_is_hit_alike() {
    for name in ["glass-sphere", "bunny"] {
        let one = tracks(&moved(name, 1.0, DVec3::ZERO), &rays(1.0, DVec3::ZERO));
        for scale in [1e-3, 1e3] {
            let other = tracks(&moved(name, scale, DVec3::ZERO), &rays(scale, DVec3::ZERO));
            let differ = |(a, b): &(&Track, &Track)| {
                let t = f64::from(b.t) / scale;
                a.object != b.object || a.t > 0.0 && (t - f64::from(a.t)).abs() > SAME_PLACE
            };
            let odd = one.iter().zip(&other).filter(differ).count();
            assert!(odd <= TIES, "{name} at {scale}: {odd} rays hit something else");
        }
    }
}
