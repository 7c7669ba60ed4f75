//! One primitive: where a ray meets it, and what the surface is there.

use glam::{DAffine3, DVec2, DVec3};

use crate::scene::Canonical;

/// A ray; `d` is a unit vector.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// m
    pub o: DVec3,
    /// Unit direction of travel.
    pub d: DVec3,
    /// The primitive it starts on, which it meets again only at the far end of a chord.
    pub left: Option<u32>,
}

/// A primitive in world space.
#[derive(Clone, Debug)]
pub enum Primitive {
    /// Centre, radius.
    Sphere(DVec3, f64),
    /// Centre, half edges.
    Quad(DVec3, DVec3, DVec3),
    /// A canonical shape in its own space.
    Canonical(Box<Placed>),
    /// Corners, and the unit normals to interpolate.
    Triangle([DVec3; 3], [DVec3; 3]),
}

/// Where a canonical shape is.
#[derive(Clone, Debug)]
pub struct Placed {
    kind: Canonical,
    to_world: DAffine3,
    to_object: DAffine3,
}

/// Distance along the ray and, of quads and triangles, the place on the primitive.
pub type Meeting = (f64, DVec2);

impl Primitive {
    /// A canonical shape under a map.
    pub fn canonical(kind: Canonical, to_world: DAffine3) -> Self {
        Self::Canonical(Box::new(Placed { kind, to_world, to_object: to_world.inverse() }))
    }

    /// Smallest and largest corner of the box about it.
    pub fn bounds(&self) -> [DVec3; 2] {
        match self {
            Self::Sphere(c, r) => [*c - *r, *c + *r],
            Self::Quad(c, u, v) => [*c - u.abs() - v.abs(), *c + u.abs() + v.abs()],
            Self::Canonical(placed) => {
                let points = placed.kind.hull().into_iter().map(|p| placed.to_world.transform_point3(p));
                points.map(|p| [p; 2]).reduce(|[a, b], [p, _]| [a.min(p), b.max(p)]).unwrap_or_default()
            }
            Self::Triangle([a, b, c], _) => [a.min(*b).min(*c), a.max(*b).max(*c)],
        }
    }

    /// The first meeting after `near` metres. A ray that starts on this primitive starts at distance 0 exactly, so
    /// that no tolerance decides whether it meets it again.
    pub fn meet(&self, ray: &Ray, near: f64, starts_here: bool) -> Option<Meeting> {
        match self {
            Self::Sphere(c, _) if starts_here => chord(ray, *c).map(|t| (t, DVec2::ZERO)),
            Self::Sphere(c, r) => sphere(ray, *c, *r, near).map(|t| (t, DVec2::ZERO)),
            Self::Canonical(placed) => {
                let (o, d) = placed.local(ray);
                placed.kind.meet(o, d, near, starts_here).map(|t| (t, DVec2::ZERO))
            }
            _ if starts_here => None,
            Self::Quad(c, u, v) => quad(ray, *c, *u, *v, near),
            Self::Triangle(corners, _) => triangle(ray, corners, near),
        }
    }

    /// Point, unit geometric normal of the outside, unit interpolated normal on the same side.
    pub fn surface(&self, ray: &Ray, (t, at): Meeting) -> (DVec3, DVec3, DVec3) {
        match self {
            Self::Sphere(c, r) => {
                let n = (ray.o + t * ray.d - c).normalize_or(-ray.d);
                (c + r * n, n, n)
            }
            Self::Quad(c, u, v) => {
                let n = u.normalize().cross(v.normalize()).normalize();
                (c + at.x * u + at.y * v, n, n)
            }
            Self::Canonical(placed) => {
                let (o, d) = placed.local(ray);
                let (p, normal) = placed.kind.foot(o + t * d);
                let n = (placed.to_object.matrix3.transpose() * normal).normalize_or(-ray.d);
                (placed.to_world.transform_point3(p), n, n)
            }
            Self::Triangle([a, b, c], normals) => {
                let n = scaled_normal(*b - *a, *c - *a);
                let weights = [1.0 - at.x - at.y, at.x, at.y];
                let bent: DVec3 = weights.iter().zip(normals).map(|(w, n)| *w * *n).sum();
                let bent = bent.normalize_or(n);
                (a + at.x * (b - a) + at.y * (c - a), n, if bent.dot(n) < 0.0 { -bent } else { bent })
            }
        }
    }
}

impl Placed {
    /// The ray in the shape's own space; its direction keeps the length that the map gives it, so t stays metres.
    fn local(&self, ray: &Ray) -> (DVec3, DVec3) {
        (self.to_object.transform_point3(ray.o), self.to_object.transform_vector3(ray.d))
    }
}

/// The unit normal of two edges; their lengths are taken out first, so that small triangles keep their digits.
fn scaled_normal(u: DVec3, v: DVec3) -> DVec3 {
    u.normalize_or_zero().cross(v.normalize_or_zero()).normalize_or(DVec3::Y)
}

/// A ray that starts on the sphere leaves it, or crosses it along a chord of −2 (o − c)·d.
fn chord(ray: &Ray, c: DVec3) -> Option<f64> {
    let t = -2.0 * (ray.o - c).dot(ray.d);
    (t > 0.0).then_some(t)
}

/// By the closest approach: what is subtracted from r² is a square itself, not a difference of large numbers.
fn sphere(ray: &Ray, c: DVec3, r: f64, near: f64) -> Option<f64> {
    let oc = ray.o - c;
    let middle = -oc.dot(ray.d);
    let half2 = r * r - (oc + middle * ray.d).length_squared();
    if half2.is_nan() || half2 < 0.0 {
        return None;
    }
    let half = half2.sqrt();
    [middle - half, middle + half].into_iter().find(|t| *t > near)
}

fn quad(ray: &Ray, c: DVec3, u: DVec3, v: DVec3, near: f64) -> Option<Meeting> {
    let n = u.normalize().cross(v.normalize());
    let t = (c - ray.o).dot(n) / ray.d.dot(n);
    let on = ray.o + t * ray.d - c;
    let at = DVec2::new(on.dot(u) / u.length_squared(), on.dot(v) / v.length_squared());
    (t > near && t.is_finite() && at.abs().max_element() <= 1.0).then_some((t, at))
}

/// In the plane across the ray's largest axis, sheared so that the ray is a point (Woop, Benthin & Wald 2013,
/// "Watertight ray/triangle intersection"). A corner has the same coordinates there in every triangle that shares it,
/// and a difference of two rounded products never has the wrong sign, so no ray slips through between two triangles.
fn triangle(ray: &Ray, corners: &[DVec3; 3], near: f64) -> Option<Meeting> {
    let size = ray.d.abs();
    let z = if size.x > size.y.max(size.z) { 0 } else { 1 + usize::from(size.z > size.y) };
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    let (along_x, along_y) = (ray.d[x] / ray.d[z], ray.d[y] / ray.d[z]);
    let [a, b, c] = corners.map(|p| p - ray.o);
    let [fa, fb, fc] = [a, b, c].map(|q| DVec2::new(q[x] - along_x * q[z], q[y] - along_y * q[z]));
    let side = |p: DVec2, q: DVec2| p.x * q.y - p.y * q.x;
    let sides = [side(fb, fc), side(fc, fa), side(fa, fb)];
    let inside = sides.iter().all(|w| *w >= 0.0) || sides.iter().all(|w| *w <= 0.0);
    let sum: f64 = sides.iter().sum();
    if !inside || sum == 0.0 || !sum.is_finite() {
        return None;
    }
    let at = DVec2::new(sides[1], sides[2]) / sum;
    let t = (a + at.x * (b - a) + at.y * (c - a)).dot(ray.d);
    (t > near).then_some((t, at))
}
