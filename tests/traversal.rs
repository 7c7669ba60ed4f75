//! A million rays a scene through the shaders' traversal: the hits of obvhs on the CPU, and no more nodes opened.

mod common;

use common::{
    Probe,
    cpu::{CpuHit, CpuScene, LocalRay, canonical_of, sides, single, sphere_depth},
    gpu,
    random::Random,
};
use glam::{DAffine3, DQuat, DVec3};
use nephroid::{
    passes::{
        accel::{SHAPE_MESH, SHAPE_QUAD, SHAPE_SPHERE, SceneArrays},
        scene::SceneBuffers,
    },
    scene::{Canonical, Object, Scene, Shape, WHOLE},
};
use rayon::prelude::*;

const RAYS: usize = 1_000_000;
/// Asked; a child put off is dropped once something nearer is hit, so the shader opens fewer.
const NODES: f64 = 1.1;
/// Two hits this near each other are one place: 64 roundings of coordinates of up to ten metres.
const SAME_PLACE: f64 = 64.0 * 10.0 / 16_777_216.0;
/// A ray passes an edge this near, in coordinates of the object: it may pass on either side in float32.
const SAME_SIDE: f64 = 16.0 / 16_777_216.0;
/// Of grazing and aligned rays half are aimed at vertices, where six triangles meet; of random rays few pass an edge.
const TIES_AIMED: f64 = 0.15;
const TIES_RANDOM: f64 = 1e-3;

/// o, d
type Row = [f32; 6];

#[derive(Clone, Copy, Debug)]
struct GpuHit {
    t: f64,
    instance: u32,
    primitive: u32,
    nodes: u32,
}

fn on_device(scene: &Scene, arrays: &SceneArrays, rays: &[Row]) -> Vec<GpuHit> {
    let probe = Probe {
        includes: &["shared/bvh.glsl"],
        input: "vec3 o; vec3 d;",
        output: "float t; uint instance; uint primitive; uint nodes;",
        body: "Hit hit; bool found = trace(q.o, q.d, 1e30, MASK_ALL, hit);\
               r.t = found ? hit.t : -1.0; r.instance = hit.instance; r.primitive = hit.primitive; r.nodes = nodes_visited;",
        defines: &[("COUNT_NODES", "1")],
        ..Default::default()
    };
    let buffers = |plan: &mut nephroid::gpu::Plan| -> common::Binder {
        let buffers = SceneBuffers::upload(plan, scene, arrays);
        Box::new(move |pass| buffers.tracing(pass))
    };
    let outputs: Vec<[u32; 4]> = probe.run_with(&gpu(), rays, buffers);
    let hit = |y: &[u32; 4]| {
        let t = f64::from(f32::from_bits(y[0]));
        GpuHit { t: if t < 0.0 { f64::INFINITY } else { t }, instance: y[1], primitive: y[2], nodes: y[3] }
    };
    outputs.iter().map(hit).collect()
}

/// A point of a random triangle of a random mesh instance in the world, a corner or within; and the normal there.
fn mesh_point(arrays: &SceneArrays, random: &mut Random, corner: bool) -> (DVec3, DVec3) {
    let meshes: Vec<_> = arrays.instances.iter().filter(|i| i.kind == SHAPE_MESH).collect();
    let rows = meshes[random.below(meshes.len())].to_world.map(|r| r.map(f64::from));
    let map = |v: [f32; 3]| {
        let v = v.map(f64::from);
        DVec3::from(rows.map(|r| r[0] * v[0] + r[1] * v[1] + r[2] * v[2] + r[3]))
    };
    let t = arrays.triangles[random.below(arrays.triangles.len())];
    let (a, b, c) = (map(t.a), map(t.b), map(t.c));
    let (u, v) = if corner { (0.0, 0.0) } else { (0.5 * random.unit(), 0.5 * random.unit()) };
    (a + (b - a) * u + (c - a) * v, (b - a).cross(c - a).normalize_or(DVec3::Y))
}

/// In turn: at random through the scene, grazing a triangle, along an axis at a vertex or beside it.
fn rays(arrays: &SceneArrays) -> Vec<Row> {
    let mut random = Random(80);
    let ray = |i: usize| {
        let (o, d) = match i % 3 {
            0 => {
                let o = random.direction() * 4.0;
                (o, DVec3::Y * 0.5 + random.direction() * random.unit() * 1.5 - o)
            }
            1 => {
                let (p, n) = mesh_point(arrays, &mut random, i.is_multiple_of(2));
                let along = (random.direction().cross(n) + n * random.within(-1e-3, 1e-3)).normalize();
                (p - along * 3.0, along)
            }
            _ => {
                let (p, _) = mesh_point(arrays, &mut random, i.is_multiple_of(2));
                let axis = DVec3::AXES[random.below(3)] * [1.0, -1.0][random.below(2)];
                // Exactly the coordinates of a vertex, or one rounding beside.
                let p = if i.is_multiple_of(4) { p * (1.0 + random.within(-1e-7, 1e-7)) } else { p };
                (p * (1.0 - axis.abs()) - axis * 4.0, axis)
            }
        };
        let (o, d) = (single(o), single(d.normalize()));
        [o[0], o[1], o[2], d[0], d[1], d[2]]
    };
    (0..RAYS).map(ray).collect()
}

/// How a hit of one side only is explained.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Tie {
    /// Both found the same place: a shared edge or vertex, or surfaces that touch.
    Place,
    /// The ray passes the nearer one's edge, or a sphere's limb, closer than float32 tells.
    Edge,
}

/// How far inside its shape a ray hits, as a share of the coordinates that take part.
fn margin(scene: &CpuScene, row: &Row, instance: u32, primitive: u32) -> f64 {
    let shape = scene.instance(instance);
    let ray = LocalRay::new(shape, [row[0], row[1], row[2]], [row[3], row[4], row[5]]);
    let reach = ray.o.abs().max_element().max(1.0);
    if shape.kind == SHAPE_MESH {
        let corners = scene.corners(primitive);
        let s = sides(&ray, corners);
        let size = corners.iter().map(|c| c.abs().max_element()).fold(ray.o.abs().max_element(), f64::max);
        let least = s.into_iter().fold(f64::INFINITY, f64::min);
        let most = s.into_iter().fold(f64::NEG_INFINITY, f64::max);
        least.max(-most) / size
    } else if shape.kind == SHAPE_QUAD {
        let at = ray.o - ray.d * (ray.o.z / ray.d.z);
        (1.0 - at.x.abs().max(at.y.abs())) * (ray.d.z / ray.d.length()).abs() / reach
    } else if shape.kind == SHAPE_SPHERE {
        sphere_depth(&ray) / reach
    } else {
        // A ray moved by this much in any direction still hits, or the hit is at an edge.
        let moves = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        let hits = |by: DVec3| canonical_of(shape).meet(ray.o + by, ray.d, 0.0, false).is_some();
        let beside = moves.into_iter().all(|axis| hits(axis * 4.0 * SAME_SIDE * reach));
        if beside { f64::INFINITY } else { 0.0 }
    }
}

/// `Ok(None)` if both agree, the kind of tie, or what is wrong.
fn judge(scene: &CpuScene, row: &Row, g: &GpuHit, c: &CpuHit) -> Result<Option<Tie>, String> {
    let same_place = (g.t - c.t).abs() <= SAME_PLACE || g.t == c.t;
    // Primitives of one shape tell its faces apart: what is met at one place is one of them.
    let same =
        g.t.is_infinite() || g.instance == c.instance && (g.primitive == c.primitive || !scene.is_mesh(g.instance));
    if same_place {
        return Ok((!same).then_some(Tie::Place));
    }
    let (instance, primitive) = if g.t < c.t { (g.instance, g.primitive) } else { (c.instance, c.primitive) };
    let inside = margin(scene, row, instance, primitive);
    if inside.abs() <= SAME_SIDE || same && inside.abs() <= 64.0 * SAME_SIDE {
        return Ok(Some(Tie::Edge));
    }
    Err(format!("{row:?}: shader {g:?}, obvhs {c:?}, {inside:e} inside the nearer one"))
}

fn compare(name: &str, scene: &Scene) {
    let arrays = SceneArrays::build(scene).unwrap();
    let rays = rays(&arrays);
    let found = on_device(scene, &arrays, &rays);
    let cpu = CpuScene::new(&arrays);
    let expected: Vec<CpuHit> = rays.par_iter().map(|r| cpu.trace([r[0], r[1], r[2]], [r[3], r[4], r[5]])).collect();
    let verdicts: Vec<_> =
        rays.iter().zip(found.iter().zip(&expected)).map(|(r, (g, c))| judge(&cpu, r, g, c)).collect();
    let wrong: Vec<_> = verdicts.iter().filter_map(|v| v.as_ref().err()).collect();
    let tied = |aimed: bool, kinds: &[Tie]| {
        let of_kind = |v: &&Result<_, _>| matches!(v, Ok(Some(tie)) if kinds.contains(tie));
        let third = verdicts.iter().enumerate().filter(|(i, _)| (i % 3 != 0) == aimed).map(|(_, v)| v);
        third.filter(of_kind).count()
    };
    let [place, edge] = [Tie::Place, Tie::Edge].map(|t| tied(true, &[t]));
    let random = tied(false, &[Tie::Place, Tie::Edge]);
    let sum = |nodes: &mut dyn Iterator<Item = u32>| nodes.map(f64::from).sum::<f64>();
    let (ours, theirs) = (sum(&mut found.iter().map(|g| g.nodes)), sum(&mut expected.iter().map(|c| c.nodes)));
    let hits = expected.iter().filter(|c| c.t.is_finite()).count();
    println!(
        "{name}: {hits} hits of {RAYS}; ties: {random} of random rays; of aimed ones {place} of place, {edge} at edges; \
         nodes {:.1} a ray, {:.3} of obvhs'",
        ours / RAYS as f64,
        ours / theirs
    );
    assert!(wrong.is_empty(), "{name}: {} wrong, such as {:#?}", wrong.len(), &wrong[..wrong.len().min(5)]);
    assert!(hits > RAYS / 2, "{name}: {hits} hits are too few to tell");
    assert!((random as f64) < TIES_RANDOM * RAYS as f64 / 3.0, "{name}: {random} ties of random rays");
    let aimed = (place + edge) as f64;
    assert!(aimed < TIES_AIMED * RAYS as f64 * 2.0 / 3.0, "{name}: {aimed} ties of aimed rays");
    assert!(ours <= NODES * theirs, "{name}: {ours} nodes opened, obvhs {theirs}");
}

#[test]
fn rays_through_a_mesh_hit_what_obvhs_hits() {
    compare("bunny", &Scene::load("bunny", &[]).unwrap());
}

const SHAPES: [Canonical; 4] =
    [Canonical::Box, Canonical::Disk, Canonical::Cylinder { cut: -0.3 }, Canonical::Paraboloid { cut: WHOLE }];

/// Turned, stretched, mirrored and nested copies of the mesh among the analytic shapes.
fn crowd() -> Scene {
    let mut scene = Scene::load("bunny", &[]).unwrap();
    let mesh = scene.objects.iter().find(|o| matches!(o.shape, Shape::Mesh { .. })).unwrap().clone();
    let Shape::Mesh { mesh: shared, to_world } = &mesh.shape else { unreachable!("found as a mesh") };
    let mut random = Random(81);
    for i in 0..40 {
        let at = DVec3::new(random.within(-2.0, 2.0), random.within(0.0, 2.0), random.within(-2.0, 2.0));
        let turn = DQuat::from_axis_angle(random.direction(), random.within(0.0, 6.0));
        let size = random.within(0.1, 0.4);
        let stretch = DVec3::new(random.within(0.5, 2.0), random.within(0.5, 2.0), [1.0, -1.0][i % 2]) * size;
        let shape = match i % 5 {
            4 => Shape::Canonical {
                kind: SHAPES[i / 5 % 4],
                to_world: DAffine3::from_scale_rotation_translation(stretch, turn, at),
            },
            0 => Shape::Sphere { center: at, radius: size },
            1 => Shape::Quad { center: at, u: turn * DVec3::X * size, v: turn * DVec3::Y * size },
            _ => {
                let place = DAffine3::from_scale_rotation_translation(stretch, turn, at);
                Shape::Mesh { mesh: shared.clone(), to_world: place * *to_world }
            }
        };
        scene.objects.push(Object { name: format!("copy {i}"), shape, ..mesh.clone() });
    }
    scene
}

#[test]
fn rays_through_two_levels_hit_what_obvhs_hits() {
    compare("crowd", &crowd());
}
