//! Views: the rectangle that an eye or a light looks through. Float64 twin of `glsl/shared/view.glsl`.

use glam::{DVec2, DVec3};

/// A rectangular view. Right-handed: `right × up = −forward`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The eye, or any point of an orthographic view's axis.
    pub origin: DVec3,
    /// Unit, towards growing x.
    pub right: DVec3,
    /// Unit, towards growing y (images have their first row at the top, the greatest y).
    pub up: DVec3,
    /// Unit, the direction looked in.
    pub forward: DVec3,
    /// Lower corner of the window: metres if orthographic, tangents if perspective.
    pub low: DVec2,
    /// Upper corner of the window.
    pub high: DVec2,
    /// Where rays begin, metres along `forward`.
    pub near: f64,
    /// Beyond everything, metres along `forward`.
    pub far: f64,
    /// Rays from one point, or parallel ones.
    pub perspective: bool,
}

/// A view as the shaders read it (`struct View` of `glsl/shared/view.glsl`, scalar layout).
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of `View`
pub struct ViewData {
    pub origin: [f32; 3],
    pub x0: f32,
    pub right: [f32; 3],
    pub x1: f32,
    pub up: [f32; 3],
    pub y0: f32,
    pub forward: [f32; 3],
    pub y1: f32,
    pub near: f32,
    pub far: f32,
    pub perspective: u32,
    pub pad: u32,
}

/// What a view must hold: points, and spheres seen exactly.
#[derive(Clone, Debug, Default)]
pub struct Extent {
    /// Points.
    pub points: Vec<DVec3>,
    /// Spheres: centre, radius.
    pub spheres: Vec<(DVec3, f64)>,
}

/// Widest half window of a fitted perspective view, as a tangent (76°); beyond it six cube faces serve better.
const WIDEST_TANGENT: f64 = 4.0;

/// Thinnest window, relative to what it looks at: an extent without area still gets a view without division by zero.
const THINNEST: f64 = 1e-6;

impl Extent {
    /// True if there is nothing to hold.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty() && self.spheres.is_empty()
    }

    /// Adds what another holds.
    pub fn join(&mut self, other: &Self) {
        self.points.extend(&other.points);
        self.spheres.extend(&other.spheres);
    }

    /// Least and greatest value along an axis.
    pub fn along(&self, axis: DVec3) -> (f64, f64) {
        let points = self.points.iter().map(|p| (p.dot(axis), 0.0));
        let spheres = self.spheres.iter().map(|(c, r)| (c.dot(axis), *r));
        points
            .chain(spheres)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (at, r)| (low.min(at - r), high.max(at + r)))
    }

    /// Centre and half-diagonal of the box about it.
    pub fn bounds(&self) -> (DVec3, f64) {
        let (x, y, z) = (self.along(DVec3::X), self.along(DVec3::Y), self.along(DVec3::Z));
        if x.0 > x.1 {
            return (DVec3::ZERO, 0.0);
        }
        let (low, high) = (DVec3::new(x.0, y.0, z.0), DVec3::new(x.1, y.1, z.1));
        (0.5 * (low + high), 0.5 * (high - low).length())
    }
}

impl View {
    /// An orthographic view along unit `forward` that just holds `content`; rays begin before `everything`.
    pub fn orthographic(forward: DVec3, content: &Extent, everything: &Extent) -> Self {
        let (right, up) = basis(forward);
        let (x, y) = (content.along(right), content.along(up));
        let (front, back) = content.along(forward);
        let (nearest, farthest) = everything.along(forward);
        let scale = (x.1 - x.0).max(y.1 - y.0).max(back - front).max(f64::MIN_POSITIVE);
        let centre = DVec2::new(0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1));
        let half = DVec2::new(x.1 - x.0, y.1 - y.0).max(DVec2::splat(THINNEST * scale)) * 0.5;
        // Depth is measured from the content, so that float32 keeps its digits where they count.
        let origin = centre.x * right + centre.y * up + front * forward;
        let near = nearest.min(front) - front - THINNEST * scale;
        let far = farthest.max(back) - front + THINNEST * scale;
        Self { origin, right, up, forward, low: -half, high: half, near, far, perspective: false }
    }

    /// A perspective view from `origin` that just holds `content`, or `None` if no one frustum does.
    pub fn perspective(origin: DVec3, content: &Extent, everything: &Extent) -> Option<Self> {
        let forward = (content.bounds().0 - origin).try_normalize()?;
        let (right, up) = basis(forward);
        let x = tangents(origin, forward, right, content)?;
        let y = tangents(origin, forward, up, content)?;
        let (low, high) = (DVec2::new(x.0, y.0), DVec2::new(x.1, y.1));
        let centre = 0.5 * (low + high);
        let half = (0.5 * (high - low)).max(DVec2::splat(0.5 * THINNEST));
        let far = far_end(origin, everything);
        Some(Self {
            origin,
            right,
            up,
            forward,
            low: centre - half,
            high: centre + half,
            near: 0.0,
            far,
            perspective: true,
        })
    }

    /// The six faces of the cube about `origin`.
    pub fn cube(origin: DVec3, everything: &Extent) -> [Self; 6] {
        let far = far_end(origin, everything);
        [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z].map(|forward| {
            let (right, up) = basis(forward);
            Self { origin, right, up, forward, low: -DVec2::ONE, high: DVec2::ONE, near: 0.0, far, perspective: true }
        })
    }

    /// The part of a perspective view's window that a cone from its origin touches (unit axis, half angle below 90°);
    /// `None` if they are apart.
    pub fn within_cone(mut self, axis: DVec3, half: f64) -> Option<Self> {
        for (k, side) in [self.right, self.up].into_iter().enumerate() {
            // In the plane of `forward` and `side` the cone is the outline of a circle of radius sin(half) at `flat`.
            let flat = DVec2::new(axis.dot(side), axis.dot(self.forward));
            let (middle, reach) = (flat.x.atan2(flat.y), half.sin() / flat.length());
            if reach >= 1.0 {
                continue; // the cone goes all round
            }
            let (low, high) = (middle - reach.asin(), middle + reach.asin());
            if low >= self.high[k].atan() || high <= self.low[k].atan() {
                return None;
            }
            // Within the window's angles, which have tangents.
            self.low[k] = low.max(self.low[k].atan()).tan();
            self.high[k] = high.min(self.high[k].atan()).tan();
        }
        Some(self)
    }

    /// The same window, with its rays beginning beyond everything.
    pub fn of_nothing(self) -> Self {
        let depth = self.far - self.near;
        Self { near: self.far + depth, far: self.far + 2.0 * depth, ..self }
    }

    /// An orthographic view of a rectangle (half edges `u`, `v`) along its normal, from the lit side, and of margins
    /// beyond its sides (−u, −v and +u, +v; metres). It sees all of `everything`, before and behind the rectangle.
    pub fn of_rectangle(center: DVec3, u: DVec3, v: DVec3, margins: [DVec2; 2], everything: &Extent) -> Self {
        let forward = -u.cross(v).normalize_or(DVec3::Y);
        let half = DVec2::new(u.length(), v.length());
        let (low, high) = (-half - margins[0], half + margins[1]);
        let (nearest, farthest) = everything.along(forward);
        let depth = center.dot(forward);
        let slack = half.max_element();
        let (near, far) = (nearest.min(depth) - depth - slack, farthest.max(depth) - depth + slack);
        let (right, up) = (u.normalize_or(DVec3::X), v.normalize_or(DVec3::Z));
        Self { origin: center, right, up, forward, low, high, near, far, perspective: false }
    }

    /// Where `p` is seen, each coordinate in 0..1 inside the window, y downwards; `None` before the near plane.
    pub fn project(&self, p: DVec3) -> Option<DVec2> {
        let q = p - self.origin;
        let z = q.dot(self.forward);
        if z.is_nan() || z < self.near || self.perspective && z <= 0.0 {
            return None;
        }
        let scale = if self.perspective { 1.0 / z } else { 1.0 };
        let w = DVec2::new(q.dot(self.right), q.dot(self.up)) * scale;
        let size = self.high - self.low;
        Some(DVec2::new((w.x - self.low.x) / size.x, (self.high.y - w.y) / size.y))
    }

    /// The ray through a point of the window (0..1, y downwards): origin on the near plane, unit direction.
    pub fn ray(&self, at: DVec2) -> (DVec3, DVec3) {
        let x = self.low.x + (self.high.x - self.low.x) * at.x;
        let y = self.high.y - (self.high.y - self.low.y) * at.y;
        let across = self.right * x + self.up * y;
        if self.perspective {
            let through = self.forward + across;
            (self.origin + through * self.near, through.normalize())
        } else {
            (self.origin + across + self.forward * self.near, self.forward)
        }
    }

    /// The view in float32.
    pub fn data(&self) -> ViewData {
        let f = |v: DVec3| v.as_vec3().to_array();
        ViewData {
            origin: f(self.origin),
            x0: self.low.x as f32,
            right: f(self.right),
            x1: self.high.x as f32,
            up: f(self.up),
            y0: self.low.y as f32,
            forward: f(self.forward),
            y1: self.high.y as f32,
            near: self.near as f32,
            far: self.far as f32,
            perspective: self.perspective.into(),
            pad: 0,
        }
    }
}

/// Right and up of a view along unit `forward`: level where there is a horizon, else with up along −z.
pub fn basis(forward: DVec3) -> (DVec3, DVec3) {
    let hint = if forward.y.abs() < 0.999 { DVec3::Y } else { DVec3::NEG_Z };
    let right = forward.cross(hint).normalize_or(DVec3::X);
    (right, right.cross(forward))
}

/// The farthest that anything lies from `origin`.
fn far_end(origin: DVec3, everything: &Extent) -> f64 {
    let (centre, radius) = everything.bounds();
    (centre - origin).length() + radius.max(THINNEST)
}

/// Least and greatest tangent of the content against `forward`, seen along `axis`; exact for spheres, whose outline in
/// the plane of `forward` and `axis` is that of a circle.
fn tangents(origin: DVec3, forward: DVec3, axis: DVec3, content: &Extent) -> Option<(f64, f64)> {
    let flat = |p: DVec3| DVec2::new((p - origin).dot(axis), (p - origin).dot(forward));
    let points = content.points.iter().map(|p| {
        let q = flat(*p);
        let angle = q.x.atan2(q.y);
        Some((angle, angle))
    });
    let spheres = content.spheres.iter().map(|(c, r)| {
        let q = flat(*c);
        let (distance, angle) = (q.length(), q.x.atan2(q.y));
        (distance > *r).then(|| (angle - (r / distance).asin(), angle + (r / distance).asin()))
    });
    let mut bounds = (f64::INFINITY, f64::NEG_INFINITY);
    let widest = WIDEST_TANGENT.atan();
    for interval in points.chain(spheres) {
        let (low, high) = interval?;
        if !(low >= -widest && high <= widest) {
            return None;
        }
        bounds = (bounds.0.min(low.tan()), bounds.1.max(high.tan()));
    }
    (bounds.0 <= bounds.1).then_some(bounds)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(center: DVec3, radius: f64) -> Extent {
        Extent { points: vec![], spheres: vec![(center, radius)] }
    }

    #[test]
    fn a_fitted_view_touches_a_sphere_on_all_sides() {
        let content = ball(DVec3::new(0.3, 1.0, -2.0), 0.7);
        for forward in [DVec3::NEG_Y, DVec3::X, DVec3::new(0.6, -0.8, 0.0)] {
            let view = View::orthographic(forward, &content, &content);
            assert!((view.high - view.low - DVec2::splat(1.4)).length() < 1e-12);
            let at = view.project(content.spheres[0].0).unwrap();
            assert!((at - DVec2::splat(0.5)).length() < 1e-12);
        }
        let view = View::perspective(DVec3::new(0.3, 4.0, -2.0), &content, &content).unwrap();
        let tangent = (0.7f64 / 3.0).asin().tan();
        assert!((view.high.x - tangent).abs() < 1e-12 && (view.low.y + tangent).abs() < 1e-12);
    }

    #[test]
    fn rays_and_projection_agree() {
        let content = ball(DVec3::ZERO, 1.0);
        let views = [
            View::orthographic(DVec3::new(0.0, -0.6, 0.8), &content, &content),
            View::perspective(DVec3::new(1.0, 3.0, 2.0), &content, &content).unwrap(),
            View::of_rectangle(DVec3::ZERO, DVec3::X, DVec3::NEG_Z, [DVec2::splat(0.1), DVec2::ZERO], &content),
        ];
        for view in views {
            assert!((view.right.cross(view.up) + view.forward).length() < 1e-12, "right-handed");
            for at in [DVec2::new(0.1, 0.9), DVec2::new(0.5, 0.5), DVec2::new(1.0, 0.0)] {
                let (o, d) = view.ray(at);
                let back = view.project(o + d * 3.7).unwrap();
                assert!((back - at).length() < 1e-12, "{view:?}");
            }
        }
    }

    #[test]
    fn a_light_inside_or_beside_its_object_has_no_one_frustum() {
        let content = ball(DVec3::ZERO, 1.0);
        assert!(View::perspective(DVec3::new(0.0, 0.5, 0.0), &content, &content).is_none());
        assert!(View::perspective(DVec3::ZERO, &content, &content).is_none());
        assert!(View::perspective(DVec3::new(0.0, 1.01, 0.0), &content, &content).is_none());
        let faces = View::cube(DVec3::ZERO, &content);
        for direction in [DVec3::new(0.3, 0.9, -0.2), DVec3::new(-0.7, 0.1, 0.2)] {
            let seen = faces
                .iter()
                .filter_map(|f| f.project(direction))
                .filter(|p| p.min_element() >= 0.0 && p.max_element() <= 1.0);
            assert_eq!(seen.count(), 1);
        }
    }

    #[test]
    fn a_cone_narrows_the_window_to_what_it_touches() {
        let view = View::cube(DVec3::ZERO, &ball(DVec3::ZERO, 9.0))[5]; // along -z
        let half = 0.1f64;
        let along = view.within_cone(DVec3::NEG_Z, half).unwrap();
        assert!((along.high - DVec2::splat(half.tan())).length() < 1e-12 && (along.low + along.high).length() < 1e-12);
        let aside = view.within_cone(DVec3::new(0.6, 0.0, -0.8), half).unwrap();
        let (low, high) = (aside.low.x.atan(), aside.high.x.atan());
        let expected = 0.75f64.atan();
        assert!((low - expected + half).abs() < 1e-12 && (high - expected - half).abs() < 1e-12, "{low} {high}");
        let reaches = view.within_cone(DVec3::new(0.72, 0.0, -0.694), 0.3).unwrap();
        assert!((reaches.high.x - 1.0).abs() < 1e-12, "the window ends before the cone");
        assert!(view.within_cone(DVec3::new(0.96, 0.0, -0.28), half).is_none());
    }

    #[test]
    fn a_flat_or_pointlike_extent_still_has_a_window() {
        let point = Extent { points: vec![DVec3::ONE], spheres: vec![] };
        let view = View::orthographic(DVec3::NEG_Y, &point, &point);
        assert!((view.high - view.low).min_element() > 0.0 && view.data().near.is_finite());
    }
}
