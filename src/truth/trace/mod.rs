//! Exact intersection in float64: analytic shapes as they are, meshes by their triangles, one hierarchy over all.
//!
//! Self-intersection has no scale: a ray knows the primitive that it starts on. That one is met again only at the far
//! end of a chord; others from [`APART`] of the coordinates on. Surfaces closer than that to each other (two
//! that coincide) count as one, the first in the scene's order: the truth's stated bias.

mod bvh;
mod interface;
mod media;
mod shape;

#[cfg(test)]
mod tests;

use bvh::Bvh;
use glam::DVec3;

use crate::scene::{Material, Object, Scene, Shape};
pub use interface::Bend;
pub use media::Media;
pub use shape::Ray;
use shape::{Meeting, Primitive};

/// What is nearer to a ray's start than this share of its coordinates is the same place: some thousand roundings.
pub const APART: f64 = 1e-12;

/// Which surfaces a ray can meet: bits, joined by `|`.
pub mod mask {
    /// Surfaces that scatter.
    pub const DIFFUSE: u8 = 1;
    /// Surfaces that refract or reflect.
    pub const SPECULAR: u8 = 2;
    /// All there is.
    pub const ALL: u8 = DIFFUSE | SPECULAR;
    /// Surfaces that scatter and are visible to the camera.
    pub const SEEN_DIFFUSE: u8 = 4;
    /// Surfaces that refract or reflect and are visible to the camera.
    pub const SEEN_SPECULAR: u8 = 8;
}

/// What a ray finds.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// From the ray's start, m.
    pub distance: f64,
    /// On the primitive, m.
    pub p: DVec3,
    /// Unit geometric normal of the outside.
    pub ng: DVec3,
    /// Unit interpolated normal, on the side of `ng`.
    pub ns: DVec3,
    /// Index into the scene's objects.
    pub object: usize,
    /// Index into the scene's materials.
    pub material: usize,
    primitive: u32,
}

impl Surface {
    /// The geometric normal on the side that a ray along `d` comes from.
    pub fn facing(&self, d: DVec3) -> DVec3 {
        if d.dot(self.ng) <= 0.0 { self.ng } else { -self.ng }
    }

    /// A ray that goes on from here.
    pub fn ray(&self, d: DVec3) -> Ray {
        Ray { o: self.p, d, left: Some(self.primitive) }
    }
}

#[derive(Debug)]
struct Part {
    primitive: Primitive,
    object: usize,
    mask: u8,
}

/// A scene ready for rays.
#[derive(Debug)]
pub struct Space<'a> {
    /// What it was made of.
    pub scene: &'a Scene,
    parts: Vec<Part>,
    bvh: Bvh,
    bounds: [DVec3; 2],
}

impl<'a> Space<'a> {
    /// Places every shape in the world and builds the hierarchy.
    pub fn new(scene: &'a Scene) -> Self {
        let parts: Vec<Part> = scene.objects.iter().enumerate().flat_map(|(k, o)| parts(scene, k, o)).collect();
        let boxes: Vec<_> = parts.iter().map(|p| p.primitive.bounds()).collect();
        let bounds = boxes.iter().copied().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or_default();
        Self { scene, parts, bvh: Bvh::over(&boxes), bounds }
    }

    /// The material of a surface.
    pub fn material(&self, surface: &Surface) -> &Material {
        &self.scene.materials[surface.material]
    }

    /// Centre and half-diagonal of the box about everything.
    pub fn ball(&self) -> (DVec3, f64) {
        (0.5 * (self.bounds[0] + self.bounds[1]), 0.5 * (self.bounds[1] - self.bounds[0]).length())
    }

    /// The first surface of `mask` along the ray; of several in one place the first in the scene's order.
    pub fn nearest(&self, ray: &Ray, mask: u8) -> Option<Surface> {
        let mut best: Option<(u32, Meeting)> = None;
        self.meetings(ray, mask, f64::INFINITY, |primitive, meeting| {
            let (held, t) = best.map_or((u32::MAX, f64::INFINITY), |(p, (t, _))| (p, t));
            if meeting.0 < t || (meeting.0 == t && primitive < held) {
                best = Some((primitive, meeting));
            }
            best.map_or(f64::INFINITY, |(_, (t, _))| t)
        });
        best.map(|(primitive, meeting)| self.surface(ray, primitive, meeting))
    }

    /// Whether anything of `mask` lies on the first `reach` metres, short of [`APART`] at the far end.
    pub fn blocked(&self, ray: &Ray, reach: f64, mask: u8) -> bool {
        let mut found = false;
        let end = reach - self.near(ray);
        self.meetings(ray, mask, end, |_, (t, _)| {
            found |= t < end;
            if found { 0.0 } else { end }
        });
        found
    }

    /// Calls `keep` with each meeting before the distance it last returned.
    fn meetings(&self, ray: &Ray, mask: u8, far: f64, mut keep: impl FnMut(u32, Meeting) -> f64) {
        let near = self.near(ray);
        self.bvh.walk(ray.o, ray.d, far, |index, far| {
            let part = &self.parts[index as usize];
            let met =
                if part.mask & mask == 0 { None } else { part.primitive.meet(ray, near, ray.left == Some(index)) };
            met.filter(|m| m.0 <= far).map_or(far, |m| keep(index, m))
        });
    }

    fn near(&self, ray: &Ray) -> f64 {
        if ray.left.is_some() { APART * ray.o.abs().max_element() } else { 0.0 }
    }

    fn surface(&self, ray: &Ray, primitive: u32, meeting: Meeting) -> Surface {
        let part = &self.parts[primitive as usize];
        let (p, ng, ns) = part.primitive.surface(ray, meeting);
        let material = self.scene.objects[part.object].material;
        Surface { distance: meeting.0, p, ng, ns, object: part.object, material, primitive }
    }
}

fn parts(scene: &Scene, index: usize, object: &Object) -> Vec<Part> {
    let (hidden, seen) = if scene.materials[object.material].is_specular() {
        (mask::SPECULAR, mask::SEEN_SPECULAR)
    } else {
        (mask::DIFFUSE, mask::SEEN_DIFFUSE)
    };
    let mask = hidden | if object.visible_to_camera { seen } else { 0 };
    primitives(&object.shape).into_iter().map(|primitive| Part { primitive, object: index, mask }).collect()
}

fn primitives(shape: &Shape) -> Vec<Primitive> {
    match shape {
        Shape::Sphere { center, radius } => vec![Primitive::Sphere(*center, *radius)],
        Shape::Quad { center, u, v } => vec![Primitive::Quad(*center, *u, *v)],
        Shape::Canonical { kind, to_world } => vec![Primitive::canonical(*kind, *to_world)],
        Shape::Mesh { mesh, to_world } => {
            let to_normal = to_world.matrix3.inverse().transpose();
            let point = |i: u32| to_world.transform_point3(mesh.positions[i as usize].as_dvec3());
            // Not made unit ones here: between vertices the mesh's own normals are mixed, and the mix is mapped. Where the map
            // stretches, the mix of mapped unit normals would be another surface's.
            let normal = |i: u32| to_normal * mesh.normals[i as usize].as_dvec3();
            mesh.triangles.iter().map(|t| Primitive::Triangle(t.map(point), t.map(normal))).collect()
        }
    }
}
