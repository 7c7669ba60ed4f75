//! Rays a second through a mesh: the compute traversal on the device beside native obvhs on the host's cores.
//!
//! One JSON object a line on stdout. Two sets of 2²⁰ rays: `grid`, parallel as a light's; `random`, aimed at random
//! points of the box from a sphere about it; through the bunny that ships, and through one of sixteen times its triangles.
//! On a software device both run on the same cores, and their ratio means something; on a GPU it compares a device with a
//! host.
//!
//! What bounds it on lavapipe is probably loads: a step down the tree reads sixteen words of a storage buffer for each of eight
//! lanes. Measured on the bunny, as rays a second against the traversal as it is, grid and random, all in turn within one
//! run on a busy machine: nodes and triangles fetched as texels of four words (`texelFetch` of `RGBA32UI`), 1.24 to 1.27 and
//! 1.05 to 1.20; without the distance that drops a child put off, 0.75 and 0.77. Neither is built.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use glam::Vec3A;
use nephroid::{
    gpu::{Gpu, GpuError, GpuOptions, Lifetime, Phase, Plan, Program, Sources},
    passes::{accel::SceneArrays, scene::SceneBuffers},
    scene::{Mesh, Scene, Shape},
    store::Store,
};
use obvhs::{
    BvhBuildParams,
    bvh2::builder::build_bvh2_from_tris,
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
    let scene = Scene::load("bunny", &[])?;
    let gpu = Gpu::new(&GpuOptions::default())?;
    eprintln!("device: {}", gpu.info().label());
    of_scene(&gpu, "bunny", &scene)?;
    of_scene(&gpu, "bunny-fine", &finer(scene, 2))
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
    let triangles = world_triangles(scene);
    eprintln!("{scene_name}: {} triangles", triangles.len());
    for (name, rays) in [("grid", grid(&triangles)), ("random", random(&triangles))] {
        let (native, hits) = native(&triangles, &rays);
        let (device, device_hits) = device(gpu, scene, &rays)?;
        // Both saw the mesh (the device sees the floor too).
        assert!(device_hits >= hits && hits > rays.len() / 10, "{device_hits} hits on the device, {hits} natively");
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

fn world_triangles(scene: &Scene) -> Vec<Triangle> {
    let mut all = Vec::new();
    for object in &scene.objects {
        let Shape::Mesh { mesh, to_world } = &object.shape else { continue };
        let corner = |i: u32| to_world.transform_point3(mesh.positions[i as usize].as_dvec3()).as_vec3a();
        all.extend(mesh.triangles.iter().map(|t| Triangle { v0: corner(t[0]), v1: corner(t[1]), v2: corner(t[2]) }));
    }
    all
}

fn bounds(triangles: &[Triangle]) -> (Vec3A, Vec3A) {
    let points = triangles.iter().flat_map(|t| [t.v0, t.v1, t.v2]);
    points.fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)))
}

type Rays = Vec<[f32; 6]>;

fn ray(o: Vec3A, d: Vec3A) -> [f32; 6] {
    let d = d.normalize();
    [o.x, o.y, o.z, d.x, d.y, d.z]
}

fn grid(triangles: &[Triangle]) -> Rays {
    let (lo, hi) = bounds(triangles);
    let at = |k: usize| (k as f32 + 0.5) / SIDE as f32;
    let point = |x: usize, y: usize| lo + (hi - lo) * Vec3A::new(at(x), 0.5, at(y));
    let slant = Vec3A::new(-0.3, -1.0, 0.2);
    (0..SIDE * SIDE).map(|k| ray(point(k % SIDE, k / SIDE) - 3.0 * slant, slant)).collect()
}

fn random(triangles: &[Triangle]) -> Rays {
    let (lo, hi) = bounds(triangles);
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
fn native(triangles: &[Triangle], rays: &Rays) -> (Vec<f64>, usize) {
    let bvh = build_bvh2_from_tris(triangles, BvhBuildParams::medium_build(), &mut Duration::default());
    let ordered: Vec<RtTriangle> = bvh.primitive_indices.iter().map(|&i| (&triangles[i as usize]).into()).collect();
    let trace = |r: &[f32; 6]| {
        let ray = Ray::new_inf(Vec3A::new(r[0], r[1], r[2]), Vec3A::new(r[3], r[4], r[5]));
        let mut hit = RayHit::none();
        bvh.ray_traverse(ray, &mut hit, |ray, id| ordered[id].intersect(ray))
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
