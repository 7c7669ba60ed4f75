//! Which media lie about a point.

use glam::DVec3;

use super::{Ray, Space, mask};
use crate::scene::{Canonical, MaterialKind, Shape};

/// Media that can lie about a point at once; more are treated as if the innermost of these went on.
const NESTED: usize = 16;
/// A direction along which few scenes have edges.
const ASIDE: DVec3 = DVec3::new(0.36, 0.48, 0.8);
/// Surfaces that a search for media crosses before it is given up: caught between surfaces of one place.
const CROSSED: usize = 1 << 12;

/// The media about a point, outermost first, by material. A material twice is one medium: where two shapes of one
/// material touch or overlap there is no interface between them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Media {
    held: [u32; NESTED],
    depth: usize,
}

impl Media {
    /// The one that light travels through, by material; of none, air.
    pub fn innermost(&self) -> Option<usize> {
        self.depth.checked_sub(1).map(|top| self.held[top] as usize)
    }

    /// Whether a material is among them.
    pub fn holds(&self, material: usize) -> bool {
        self.held[..self.depth].contains(&(material as u32))
    }

    /// On the inside of a surface of this material.
    pub fn entered(mut self, material: usize) -> Self {
        if self.depth < NESTED {
            self.held[self.depth] = material as u32;
            self.depth += 1;
        }
        self
    }

    /// On its outside.
    pub fn left(mut self, material: usize) -> Self {
        if let Some(at) = self.held[..self.depth].iter().rposition(|m| *m as usize == material) {
            self.held.copy_within(at + 1..self.depth, at);
            self.depth -= 1;
        }
        self
    }
}

impl Space<'_> {
    /// The media about a point: of closed shapes those that a ray from there leaves without having entered, the first
    /// one left the innermost; outside them the open interfaces that the point lies behind, the nearest the innermost.
    pub fn media(&self, p: DVec3) -> Media {
        let closed = self.closed_about(p);
        let mut open = self.open_about(p);
        open.sort_by(|a, b| b.0.total_cmp(&a.0));
        let outermost_first = open.into_iter().map(|(_, material)| material).chain(closed.into_iter().rev());
        outermost_first.fold(Media::default(), |media, material| media.entered(material))
    }

    /// Materials of closed shapes, innermost first.
    fn closed_about(&self, p: DVec3) -> Vec<usize> {
        let mut ray = Ray { o: p, d: ASIDE.normalize(), left: None };
        let (mut about, mut entered) = (vec![], Media::default());
        for _ in 0..CROSSED {
            let Some(surface) = self.nearest(&ray, mask::SPECULAR) else { break };
            let object = &self.scene.objects[surface.object];
            let dielectric = matches!(self.material(&surface).kind, MaterialKind::Dielectric { .. });
            if dielectric && !is_open(&object.shape) {
                let outwards = ray.d.dot(surface.ng) > 0.0;
                match (outwards, entered.holds(surface.material)) {
                    (false, _) => entered = entered.entered(surface.material),
                    (true, true) => entered = entered.left(surface.material),
                    (true, false) => about.push(surface.material),
                }
            }
            ray = surface.ray(ray.d);
        }
        about
    }

    /// Depth below open interfaces, and their materials.
    fn open_about(&self, p: DVec3) -> Vec<(f64, usize)> {
        let one = |object: &crate::scene::Object| {
            matches!(self.scene.materials[object.material].kind, MaterialKind::Dielectric { .. }).then_some(())?;
            Some((depth_below(&object.shape, p)?, object.material))
        };
        self.scene.objects.iter().filter_map(one).collect()
    }
}

fn is_open(shape: &Shape) -> bool {
    match shape {
        Shape::Quad { .. } | Shape::Canonical { kind: Canonical::Disk | Canonical::Sine { .. }, .. } => true,
        Shape::Mesh { mesh, .. } => mesh.sheet.is_some(),
        _ => false,
    }
}

/// How deep a point lies below an open interface, within its outline as seen along the normal.
fn depth_below(shape: &Shape, p: DVec3) -> Option<f64> {
    let (center, u, v, round) = match shape {
        Shape::Quad { center, u, v } => (*center, *u, *v, false),
        Shape::Canonical { kind: Canonical::Disk, to_world } => {
            (to_world.translation, to_world.matrix3.x_axis, to_world.matrix3.y_axis, true)
        }
        Shape::Canonical { kind: Canonical::Sine { wave, phase }, to_world } => {
            let at = to_world.inverse().transform_point3(p);
            let depth = ((wave * at.x + phase).sin() - at.z) * to_world.matrix3.z_axis.length();
            return (depth > 0.0 && at.truncate().abs().max_element() <= 1.0).then_some(depth);
        }
        Shape::Mesh { mesh, to_world } => {
            let depth = mesh.depth_below(to_world.inverse().transform_point3(p))?;
            return Some(depth * to_world.matrix3.z_axis.length());
        }
        _ => return None,
    };
    let way = p - center;
    let depth = -way.dot(u.cross(v).normalize_or_zero());
    let (x, y) = (way.dot(u) / u.length_squared(), way.dot(v) / v.length_squared());
    let within = if round { x * x + y * y <= 1.0 } else { x.abs() <= 1.0 && y.abs() <= 1.0 };
    (depth > 0.0 && within).then_some(depth)
}
