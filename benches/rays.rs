//! Rays a second through a scene: the compute traversal on the device beside native obvhs on the host's cores.
//!
//! One JSON object a line on stdout. Two sets of 2²⁰ rays: `grid`, parallel as a light's; `random`, aimed at random
//! points of the box about the specular objects from a sphere about it. Both sides trace the same scene: a tree over the
//! objects, then in each mesh its own; analytic shapes are met as what they are. On a software device both run on the same
//! cores, and their ratio means something; on a GPU it compares a device with a host.
//!
//! What bounds it on lavapipe is loads: each word of a storage buffer is a loop over eight lanes. Measured on the bunny, as
//! rays a second against what was before, grid and random, all in turn within one run: boxes in cells of a grid, 8 words a
//! step down for 16, 1.39 and 1.23 (built); nodes and triangles of 16 words fetched as texels of four (`texelFetch` of
//! `RGBA32UI`), 1.21 and 1.09, and on top of the cells 1.06 and 0.97 (not built); without the distance that drops a child
//! put off, 0.75 and 0.77; leaves of fewer triangles, 0.91 to 1.03.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use glam::{DAffine3, Vec3A};
use nephroid::{
    gpu::{Gpu, GpuError, GpuOptions, Lifetime, Phase, Plan, Program, Sources},
    passes::{accel::SceneArrays, scene::SceneBuffers},
    scene::{Canonical, Mesh, Object, Scene, Shape},
    store::Store,
};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{
        Bvh2,
        builder::{build_bvh2, build_bvh2_from_tris},
    },
    ray::{Ray, RayHit},
    rt_triangle::RtTriangle,
    triangle::Triangle,
};
use rayon::prelude::*;

const SIDE: usize = 1024;
const SAMPLES: usize = 5;

const SHADER: &str = "#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include \"shared/bvh.glsl\"
layout(local_size_x = 64) in;
layout(set = 0, binding = 20, scalar) readonly buffer Rays { float at[]; } rays;
layout(set = 0, binding = 21, scalar) writeonly buffer Found { float at[]; } found;
void main() {
    uint k = gl_GlobalInvocationID.x;
    vec3 o = vec3(rays.at[6 * k], rays.at[6 * k + 1], rays.at[6 * k + 2]);
    vec3 d = vec3(rays.at[6 * k + 3], rays.at[6 * k + 4], rays.at[6 * k + 5]);
    Hit hit;
    found.at[k] = trace(o, d, 1e30, MASK_ALL, hit) ? hit.t : -1.0;
}
";

fn main() {
    if let Err(error) = bench() {
        eprintln!("error: {error}");
        std::process::exit(1);
    }
}

fn bench() -> Result<(), Box<dyn std::error::Error>> {
    let bunny = Scene::load("bunny", &[])?;
    let gpu = Gpu::new(&GpuOptions::default())?;
    eprintln!("device: {}", gpu.info().label());
    of_scene(&gpu, "bunny", &bunny)?;
    of_scene(&gpu, "bunny-fine", &finer(bunny, 2))?;
    match Scene::load("bunny", &[("objects.bunny.mesh.file".to_owned(), "model:bunny".to_owned())]) {
        Ok(scene) => of_scene(&gpu, "model-bunny", &scene)?,
        Err(error) => eprintln!("model:bunny is left out: {error}"),
    }
    for name in ["gem", "room"] {
        of_scene(&gpu, name, &Scene::load(name, &[])?)?;
    }
    Ok(())
}

/// Each triangle of each mesh in four, so many times.
fn finer(mut scene: Scene, times: usize) -> Scene {
    for object in &mut scene.objects {
        let Shape::Mesh { mesh, .. } = &mut object.shape else { continue };
        for _ in 0..times {
            *mesh = Arc::new(split(mesh));
        }
    }
    scene
}

fn split(mesh: &Mesh) -> Mesh {
    let mut fine = Mesh { triangles: vec![], ..mesh.clone() };
    for &[a, b, c] in &mesh.triangles {
        let mut between = |i: u32, j: u32| {
            let (i, j) = (i as usize, j as usize);
            fine.positions.push(0.5 * (mesh.positions[i] + mesh.positions[j]));
            fine.normals.push((mesh.normals[i] + mesh.normals[j]).normalize_or(mesh.normals[i]));
            (fine.positions.len() - 1) as u32
        };
        let [ab, bc, ca] = [between(a, b), between(b, c), between(c, a)];
        fine.triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    fine
}

fn of_scene(gpu: &Gpu, scene_name: &str, scene: &Scene) -> Result<(), Box<dyn std::error::Error>> {
    let triangles =
        |object: &Object| if let Shape::Mesh { mesh, .. } = &object.shape { mesh.triangles.len() } else { 0 };
    eprintln!(
        "{scene_name}: {} objects, {} triangles",
        scene.objects.len(),
        scene.objects.iter().map(triangles).sum::<usize>()
    );
    let traced = Native::new(scene);
    let aim = specular_bounds(scene);
    for (name, rays) in [("grid", grid(aim)), ("random", random(aim))] {
        let (native, hits) = native(&traced, &rays);
        let (device, device_hits) = device(gpu, scene, &rays)?;
        // Float32 on both sides: edges are passed on either side.
        let apart = device_hits.abs_diff(hits);
        assert!(
            apart < rays.len() / 1000 && hits > rays.len() / 10,
            "{device_hits} hits on the device, {hits} natively"
        );
        let ratio: Vec<f64> = device.iter().zip(&native).map(|(d, n)| d / n).collect();
        line(&format!("rays/{scene_name}-{name}/device"), "million rays/s", &device);
        line(&format!("rays/{scene_name}-{name}/native"), "million rays/s", &native);
        line(&format!("rays/{scene_name}-{name}/device-to-native"), "ratio", &ratio);
    }
    Ok(())
}

fn line(name: &str, unit: &str, samples: &[f64]) {
    let median = nephroid::stats::median(samples);
    println!("{}", serde_json::json!({ "name": name, "unit": unit, "samples": samples, "median": median }));
}

/// Corners of the box about what bends light.
type Aim = (Vec3A, Vec3A);

fn specular_bounds(scene: &Scene) -> Aim {
    let specular = scene.objects.iter().filter(|object| scene.materials[object.material].is_specular());
    let boxes = specular.filter_map(|object| object.shape.bounds());
    let none = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
    boxes.fold(none, |(lo, hi), [low, high]| (lo.min(low.as_vec3a()), hi.max(high.as_vec3a())))
}

/// An object for the host: meshes as triangles of the world under a tree of their own.
enum Body {
    Sphere { center: Vec3A, radius: f32 },
    Quad { center: Vec3A, u: Vec3A, v: Vec3A },
    Canonical { kind: Canonical, to_object: DAffine3 },
    Mesh { tree: Bvh2, triangles: Vec<RtTriangle> },
}

/// A scene for the host.
struct Native {
    tree: Bvh2,
    /// In the order of the leaves.
    bodies: Vec<Body>,
}

impl Native {
    fn new(scene: &Scene) -> Self {
        let bounds = |object: &Object| {
            let [lo, hi] = object.shape.bounds()?;
            Some(Aabb::new(lo.as_vec3a(), hi.as_vec3a()))
        };
        let (objects, boxes): (Vec<_>, Vec<_>) = scene.objects.iter().filter_map(|o| Some((o, bounds(o)?))).unzip();
        let tree = build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut Duration::default());
        let bodies = tree.primitive_indices.iter().map(|&k| Body::new(&objects[k as usize].shape)).collect();
        Self { tree, bodies }
    }

    fn hit(&self, ray: Ray) -> f32 {
        let mut hit = RayHit::none();
        self.tree.ray_traverse(ray, &mut hit, |ray, k| self.bodies[k].hit(ray));
        hit.t
    }
}

impl Body {
    fn new(shape: &Shape) -> Self {
        match shape {
            Shape::Sphere { center, radius } => Self::Sphere { center: center.as_vec3a(), radius: *radius as f32 },
            Shape::Quad { center, u, v } => Self::Quad { center: center.as_vec3a(), u: u.as_vec3a(), v: v.as_vec3a() },
            Shape::Canonical { kind, to_world } => Self::Canonical { kind: *kind, to_object: to_world.inverse() },
            Shape::Mesh { mesh, to_world } => {
                let corner = |i: u32| to_world.transform_point3(mesh.positions[i as usize].as_dvec3()).as_vec3a();
                let triangle = |t: &[u32; 3]| Triangle { v0: corner(t[0]), v1: corner(t[1]), v2: corner(t[2]) };
                let all: Vec<_> = mesh.triangles.iter().map(triangle).collect();
                let tree = build_bvh2_from_tris(&all, BvhBuildParams::medium_build(), &mut Duration::default());
                let triangles = tree.primitive_indices.iter().map(|&k| (&all[k as usize]).into()).collect();
                Self::Mesh { tree, triangles }
            }
        }
    }

    /// Infinite for a miss.
    fn hit(&self, ray: &Ray) -> f32 {
        let ahead = |t: f32| if t > ray.tmin { t } else { f32::INFINITY };
        match self {
            Self::Sphere { center, radius } => {
                let (way, a) = (*center - ray.origin, ray.direction.length_squared());
                let middle = way.dot(ray.direction) / a;
                let half = ((radius * radius - (way - ray.direction * middle).length_squared()) / a).sqrt();
                if half.is_nan() { f32::INFINITY } else { ahead(middle - half).min(ahead(middle + half)) }
            }
            Self::Quad { center, u, v } => {
                let normal = u.cross(*v);
                let t = (*center - ray.origin).dot(normal) / ray.direction.dot(normal);
                let at = ray.origin + ray.direction * t - *center;
                let within = at.dot(*u).abs() <= u.length_squared() && at.dot(*v).abs() <= v.length_squared();
                if within { ahead(t) } else { f32::INFINITY }
            }
            Self::Canonical { kind, to_object } => {
                let o = to_object.transform_point3(ray.origin.as_dvec3());
                let d = to_object.transform_vector3(ray.direction.as_dvec3());
                kind.meet(o, d, 0.0, false).map_or(f32::INFINITY, |t| t as f32)
            }
            Self::Mesh { tree, triangles } => {
                let mut hit = RayHit::none();
                tree.ray_traverse(*ray, &mut hit, |ray, k| triangles[k].intersect(ray));
                hit.t
            }
        }
    }
}

type Rays = Vec<[f32; 6]>;

fn ray(o: Vec3A, d: Vec3A) -> [f32; 6] {
    let d = d.normalize();
    [o.x, o.y, o.z, d.x, d.y, d.z]
}

fn grid((lo, hi): Aim) -> Rays {
    let at = |k: usize| (k as f32 + 0.5) / SIDE as f32;
    let point = |x: usize, y: usize| lo + (hi - lo) * Vec3A::new(at(x), 0.5, at(y));
    let slant = Vec3A::new(-0.3, -1.0, 0.2);
    (0..SIDE * SIDE).map(|k| ray(point(k % SIDE, k / SIDE) - 3.0 * slant, slant)).collect()
}

fn random((lo, hi): Aim) -> Rays {
    let mut state = 1u64;
    let mut unit = || {
        // SplitMix64 (Steele, Lea, Flood 2014)
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
    };
    let mut vector = || Vec3A::new(unit(), unit(), unit());
    (0..SIDE * SIDE)
        .map(|_| {
            let target = lo + (hi - lo) * vector();
            let away = (vector() - 0.5).normalize_or(Vec3A::Y);
            ray(target + 3.0 * away, -away)
        })
        .collect()
}

/// Millions of rays a second in each sample, and the hits.
fn native(scene: &Native, rays: &Rays) -> (Vec<f64>, usize) {
    let trace = |r: &[f32; 6]| {
        let ray = Ray::new_inf(Vec3A::new(r[0], r[1], r[2]), Vec3A::new(r[3], r[4], r[5]));
        scene.hit(ray).is_finite()
    };
    let mut hits = 0;
    let rates = (0..SAMPLES)
        .map(|_| {
            let start = Instant::now();
            hits = rays.par_iter().with_min_len(4096).filter(|r| trace(r)).count();
            rays.len() as f64 / start.elapsed().as_secs_f64() * 1e-6
        })
        .collect();
    (rates, hits)
}

fn device(gpu: &Gpu, scene: &Scene, rays: &Rays) -> Result<(Vec<f64>, usize), Box<dyn std::error::Error>> {
    let mut sources = Sources::default();
    sources.replace("bench.comp", SHADER);
    let mut plan = Plan::default();
    let buffers = SceneBuffers::upload(&mut plan, scene, &SceneArrays::build(scene)?);
    let from = plan.upload("rays", rays);
    let to = plan.buffer("found", 4 * rays.len() as u64, Lifetime::Frame);
    let pass = buffers.tracing(plan.pass("bench/rays")).read("rays", from).write("found", to);
    pass.dispatch("bench.comp", [rays.len() as u32 / 64, 1, 1], 64);
    let mut program = Program::new(gpu, plan, &sources, &Store::open(), None)?;
    program.run(Phase::Frame, &[])?;
    let rate = |ms: f64| rays.len() as f64 / ms * 1e-3;
    let rates = (0..SAMPLES)
        .map(|_| Ok(rate(program.run(Phase::Frame, &[])?.span_ms)))
        .collect::<Result<Vec<_>, GpuError>>()?;
    let found: Vec<f32> = bytemuck::pod_collect_to_vec(&program.read_buffer(to)?);
    Ok((rates, found.iter().filter(|t| **t > 0.0).count()))
}
