//! The scene's arrays traversed on the CPU by obvhs, its boxes in float32 as they are, the shapes in float64.
use glam::{DMat3, DVec3, Vec3A};
use nephroid::{
    passes::accel::{
        GRID_ENTRIES, Instance, Node, SHAPE_BOX, SHAPE_CYLINDER, SHAPE_DISK, SHAPE_MESH, SHAPE_PARABOLOID, SHAPE_QUAD,
        SHAPE_SINE, SHAPE_SPHERE, SceneArrays,
    },
    scene::Canonical,
};
use obvhs::{
    bvh2::{Bvh2, node::Bvh2Node},
    faststack::HeapStack,
    ray::{Ray, RayHit},
};

/// The nearest hit, and the inner nodes opened on the way.
#[derive(Clone, Copy, Debug)]
pub struct CpuHit {
    /// Infinite for a miss.
    pub t: f64,
    pub instance: u32,
    pub primitive: u32,
    pub nodes: u32,
}

/// obvhs' own trees over the same nodes.
pub struct CpuScene<'a> {
    arrays: &'a SceneArrays,
    top: Bvh2,
    /// By the root they start at.
    meshes: std::collections::BTreeMap<u32, Bvh2>,
}

/// obvhs wants its root at 0: the nodes of a tree and all after it, their children moved down.
fn bvh(nodes: &[Node], tree: u32) -> Bvh2 {
    let root = tree + GRID_ENTRIES;
    let [origin, cell] = [0, 1].map(|k| nodes[tree as usize + k].corners.map(f32::from_bits));
    let node = |n: &Node| {
        let first = if n.count() == 0 { n.first().wrapping_sub(root) } else { n.first() };
        let corner = |cells: fn(u32) -> u32| {
            Vec3A::from_array(std::array::from_fn(|k| origin[k] + cell[k] * cells(n.corners[k]) as f32))
        };
        let around = obvhs::aabb::Aabb::new(corner(|c| c & 0xffff), corner(|c| c >> 16));
        Bvh2Node::new(around, n.count(), first)
    };
    Bvh2 { nodes: nodes[root as usize..].iter().map(node).collect(), ..Default::default() }
}

/// A ray in the space of an instance; d keeps the length that the map gives it, so t stays metres.
#[derive(Clone, Copy)]
pub struct LocalRay {
    pub o: DVec3,
    pub d: DVec3,
}

impl LocalRay {
    pub fn new(instance: &Instance, o: [f32; 3], d: [f32; 3]) -> Self {
        let [x, y, z] = instance.to_object.map(|row| row.map(f64::from));
        let m = DMat3::from_cols_array(&[x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]]).transpose();
        let (o, d) = (DVec3::from(o.map(f64::from)), DVec3::from(d.map(f64::from)));
        Self { o: m * o + DVec3::new(x[3], y[3], z[3]), d: m * d }
    }

    fn single(&self) -> Ray {
        Ray::new(self.o.as_vec3a(), self.d.as_vec3a(), 0.0, f32::INFINITY)
    }
}

fn positive(t: f64) -> f64 {
    if t > 0.0 { t } else { f64::INFINITY }
}

/// Signed sides of the ray to the three edges, in object units across the ray; all of one sign inside.
pub fn sides(ray: &LocalRay, corners: [DVec3; 3]) -> [f64; 3] {
    std::array::from_fn(|k| {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        let across = ray.d.cross(q - p);
        (p - ray.o).dot(across) / across.length().max(f64::MIN_POSITIVE)
    })
}

pub fn triangle(ray: &LocalRay, corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners;
    let n = (b - a).cross(c - a);
    let s = sides(ray, corners);
    let inside = s.iter().all(|s| *s >= 0.0) || s.iter().all(|s| *s <= 0.0);
    if inside { positive((a - ray.o).dot(n) / ray.d.dot(n)) } else { f64::INFINITY }
}

pub fn quad(ray: &LocalRay) -> f64 {
    let t = -ray.o.z / ray.d.z;
    let at = ray.o + ray.d * t;
    if at.x.abs() <= 1.0 && at.y.abs() <= 1.0 { positive(t) } else { f64::INFINITY }
}

/// One less the distance of the ray's line from the centre.
pub fn sphere_depth(ray: &LocalRay) -> f64 {
    1.0 - (ray.o - ray.d * (ray.o.dot(ray.d) / ray.d.length_squared())).length()
}

pub fn sphere(ray: &LocalRay) -> f64 {
    let (a, b) = (ray.d.length_squared(), ray.o.dot(ray.d));
    let half = 1.0 - (ray.o - ray.d * (b / a)).length_squared();
    if half < 0.0 {
        return f64::INFINITY;
    }
    let root = (half / a).sqrt();
    positive(-b / a - root).min(positive(-b / a + root))
}

/// The canonical shape of an instance, with the cut that the shaders read.
pub fn canonical_of(instance: &Instance) -> Canonical {
    let cut = f64::from(f32::from_bits(instance.detail));
    match instance.kind {
        SHAPE_BOX => Canonical::Box,
        SHAPE_DISK => Canonical::Disk,
        SHAPE_CYLINDER => Canonical::Cylinder { cut },
        SHAPE_PARABOLOID => Canonical::Paraboloid { cut },
        SHAPE_SINE => Canonical::Sine { wave: cut, phase: f64::from(instance.phase) },
        kind => panic!("kind {kind} is no canonical shape"),
    }
}

fn canonical(instance: &Instance, ray: &LocalRay) -> f64 {
    canonical_of(instance).meet(ray.o, ray.d, 0.0, false).unwrap_or(f64::INFINITY)
}

impl<'a> CpuScene<'a> {
    pub fn new(arrays: &'a SceneArrays) -> Self {
        let roots = arrays.instances.iter().filter(|i| i.kind == SHAPE_MESH).map(|i| i.detail);
        Self { arrays, top: bvh(&arrays.nodes, 0), meshes: roots.map(|r| (r, bvh(&arrays.nodes, r))).collect() }
    }

    pub fn corners(&self, primitive: u32) -> [DVec3; 3] {
        let t = &self.arrays.triangles[primitive as usize];
        [t.a, t.b, t.c].map(|v| DVec3::from(v.map(f64::from)))
    }

    pub fn is_mesh(&self, index: u32) -> bool {
        self.instance(index).kind == SHAPE_MESH
    }

    pub fn instance(&self, index: u32) -> &Instance {
        &self.arrays.instances[index as usize]
    }

    /// The nearest hit by `Bvh2::ray_traverse_dynamic` on both levels; `nodes` by [`opened`], which sees the same leaves.
    pub fn trace(&self, o: [f32; 3], d: [f32; 3]) -> CpuHit {
        let mut best = CpuHit { t: f64::INFINITY, instance: 0, primitive: 0, nodes: 0 };
        let world = Ray::new(o.into(), d.into(), 0.0, f32::INFINITY);
        let mut leaves = 0;
        let (mut stack, mut none) = (HeapStack::new_with_capacity(96), RayHit::none());
        self.top.ray_traverse_dynamic(&mut stack, world, &mut none, |node, ray, _| {
            leaves += 1;
            for index in node.first_index..node.first_index + node.prim_count {
                self.meet(index, o, d, &mut best);
            }
            ray.tmax = ray.tmax.min(best.t as f32);
            true
        });
        let mut again = CpuHit { t: f64::INFINITY, instance: 0, primitive: 0, nodes: 0 };
        let mut seen = 0;
        best.nodes += opened(&self.top, world, |node, tmax| {
            seen += 1;
            for index in node.first_index..node.first_index + node.prim_count {
                self.meet(index, o, d, &mut again);
            }
            *tmax = tmax.min(again.t as f32);
        });
        assert_eq!(leaves, seen, "the counting walk is not obvhs' walk");
        best
    }

    fn meet(&self, index: u32, o: [f32; 3], d: [f32; 3], best: &mut CpuHit) {
        let instance = self.instance(index);
        let ray = LocalRay::new(instance, o, d);
        let t = match instance.kind {
            SHAPE_SPHERE => sphere(&ray),
            SHAPE_QUAD => quad(&ray),
            kind if kind != SHAPE_MESH => canonical(instance, &ray),
            _ => return self.meet_mesh(index, &ray, best),
        };
        if t < best.t {
            *best = CpuHit { t, instance: index, primitive: 0, nodes: best.nodes };
        }
    }

    fn meet_mesh(&self, index: u32, ray: &LocalRay, best: &mut CpuHit) {
        let mesh = &self.meshes[&self.instance(index).detail];
        let mut single = ray.single();
        single.tmax = best.t as f32;
        let start = *best;
        let leaf = |node: &Bvh2Node, best: &mut CpuHit| {
            for primitive in node.first_index..node.first_index + node.prim_count {
                let t = triangle(ray, self.corners(primitive));
                if t < best.t {
                    *best = CpuHit { t, instance: index, primitive, nodes: best.nodes };
                }
            }
        };
        let mut leaves = 0;
        let (mut stack, mut none) = (HeapStack::new_with_capacity(96), RayHit::none());
        mesh.ray_traverse_dynamic(&mut stack, single, &mut none, |node, ray, _| {
            leaves += 1;
            leaf(node, best);
            ray.tmax = ray.tmax.min(best.t as f32);
            true
        });
        let (mut again, mut seen) = (start, 0);
        best.nodes += opened(mesh, single, |node, tmax| {
            seen += 1;
            leaf(node, &mut again);
            *tmax = tmax.min(again.t as f32);
        });
        assert_eq!(leaves, seen, "the counting walk is not obvhs' walk");
    }
}

/// Inner nodes opened by obvhs' walk, retold step by step from `Bvh2::ray_traverse_dynamic`, which does not count them.
fn opened(bvh: &Bvh2, mut ray: Ray, mut leaf: impl FnMut(&Bvh2Node, &mut f32)) -> u32 {
    let root = &bvh.nodes[0];
    if root.aabb().intersect_ray(&ray) >= ray.tmax {
        return 0;
    }
    if root.is_leaf() {
        leaf(root, &mut ray.tmax);
        return 0;
    }
    let (mut count, mut stack) = (0, vec![root.first_index]);
    while let Some(first) = stack.pop() {
        count += 1;
        let mut pair = [0, 1].map(|k| &bvh.nodes[(first + k) as usize]);
        let mut t = pair.map(|n| n.aabb().intersect_ray(&ray));
        if t[0] > t[1] {
            pair.swap(0, 1);
            t.swap(0, 1);
        }
        let mut inner = [None; 2];
        for k in 0..2 {
            if t[k] < ray.tmax {
                if pair[k].is_leaf() { leaf(pair[k], &mut ray.tmax) } else { inner[k] = Some(pair[k].first_index) }
            }
        }
        stack.extend(inner[1]);
        stack.extend(inner[0]);
    }
    count
}

/// A direction as the arrays keep it.
pub fn single(v: DVec3) -> [f32; 3] {
    Vec3A::from(v.as_vec3()).to_array()
}
