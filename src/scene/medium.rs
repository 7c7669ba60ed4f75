//! Which medium holds a point.
use glam::DVec3;

use super::{Camera, Canonical, MaterialKind, Mesh, Object, Scene, Shape};

/// Winding number from which a point is inside: half-way between the outside's 0 and the inside's 1.
const INSIDE: f64 = 0.5;

/// How tightly a shape's medium holds a point: the lesser, the further in.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Hold {
    /// Half the diagonal of a closed shape's box, m.
    Closed(f64),
    /// Depth below an open interface, m.
    Open(f64),
}

impl Scene {
    /// The medium at a point (m): an index into [`Scene::materials`]; `None` in air.
    ///
    /// A dielectric sphere holds what is nearer to its centre than its radius, a box what is within its sides. A mesh holds what its
    /// triangles wind round by more than a half (Van Oosterom and Strackee 1983, "The solid angle of a plane triangle",
    /// eq. 8). A quad, a disk or a sheet is an open interface: it holds what lies behind it, on the side that its normal points
    /// away from, and within its outline as seen along the normal, however deep.
    ///
    /// Of several the innermost counts: closed shapes before open interfaces; of closed shapes the one with the
    /// smallest box, which is the inner one wherever two are nested; of interfaces the nearest; then the first by name.
    /// A point on a sphere or an open interface is outside; on a mesh's surface rounding decides. A point that is not finite is in
    /// air.
    pub fn medium_at(&self, p: DVec3) -> Option<usize> {
        self.media_at(p).pop()
    }

    /// All media about a point, the outermost first, as [`Self::medium_at`] orders them.
    pub fn media_at(&self, p: DVec3) -> Vec<usize> {
        self.media_within(p, |_| true)
    }

    /// The media about an eye at a point (m), for which only what the camera sees is there; the outermost first.
    pub fn media_of_eye(&self, camera: &Camera, p: DVec3) -> Vec<usize> {
        self.media_within(p, |object| object.visible_to_camera && !camera.hides_specular)
    }

    fn media_within(&self, p: DVec3, counts: impl Fn(&Object) -> bool) -> Vec<usize> {
        let media = self.objects.iter().filter(|object| counts(object)).filter_map(|object| {
            let material = self.materials.get(object.material)?;
            matches!(material.kind, MaterialKind::Dielectric { .. }).then_some(())?;
            Some((hold(&object.shape, p)?, object.material))
        });
        let mut held: Vec<(Hold, usize)> = media.collect();
        // The first by name is the innermost of several in one place: the sort is stable, and reversed.
        held.sort_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(std::cmp::Ordering::Equal));
        held.into_iter().rev().map(|(_, material)| material).collect()
    }
}

/// How the shape holds the point, if it does.
fn hold(shape: &Shape, p: DVec3) -> Option<Hold> {
    let [low, high] = shape.bounds()?;
    let closed = Hold::Closed(0.5 * (high - low).length());
    match shape {
        Shape::Sphere { center, radius } => ((p - *center).length() < *radius).then_some(closed),
        Shape::Canonical { kind, to_world } => match kind {
            Canonical::Box => (to_world.inverse().transform_point3(p).abs().max_element() < 1.0).then_some(closed),
            Canonical::Disk => {
                let at = to_world.inverse().transform_point3(p);
                (at.z < 0.0 && at.truncate().length() <= 1.0).then_some(Hold::Open(-at.z * to_world.z_axis.length()))
            }
            Canonical::Sine { .. } => {
                let at = to_world.inverse().transform_point3(p);
                let depth = (kind.foot(at).0.z - at.z) * to_world.matrix3.z_axis.length();
                (depth > 0.0 && at.truncate().abs().max_element() <= 1.0).then_some(Hold::Open(depth))
            }
            // Refused as dielectrics: open shells bound nothing.
            Canonical::Cylinder { .. } | Canonical::Paraboloid { .. } => None,
        },
        Shape::Quad { center, u, v } => {
            let way = p - *center;
            let depth = -way.dot(u.cross(*v).normalize_or_zero());
            let within = |edge: DVec3| way.dot(edge).abs() <= edge.length_squared();
            (depth > 0.0 && within(*u) && within(*v)).then_some(Hold::Open(depth))
        }
        Shape::Mesh { mesh, to_world } if mesh.sheet.is_some() => {
            let depth = mesh.depth_below(to_world.inverse().transform_point3(p))?;
            Some(Hold::Open(depth * to_world.matrix3.z_axis.length()))
        }
        Shape::Mesh { mesh, to_world } => {
            // Outside its box a closed mesh winds round nothing; most points are spared the sum.
            let boxed = p.cmpge(low).all() && p.cmple(high).all();
            (boxed && winding(mesh, to_world.inverse().transform_point3(p)) > INSIDE).then_some(closed)
        }
    }
}

/// How often the triangles wind round a point in the mesh's own units: the sum of their signed solid angles over 4π.
/// Finite for a finite point: on a corner, an edge or in the plane of a triangle its angle is one of the limits.
fn winding(mesh: &Mesh, p: DVec3) -> f64 {
    let solid_angle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize].as_dvec3() - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    mesh.triangles.iter().map(solid_angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{DAffine3, DQuat, Vec3};

    use super::*;
    use crate::scene::Material;

    /// m: far beyond float64's rounding of coordinates of order one, and next to a surface.
    const BESIDE: f64 = 1e-9;

    /// `glass-sphere` (unit sphere at the origin, radius one) with other objects in the ball's place, each of its own
    /// dielectric of which the index is the object's.
    fn of(shapes: Vec<Shape>) -> Scene {
        let mut scene = Scene::load("glass-sphere", &[]).unwrap();
        let kind = MaterialKind::Dielectric { ior: [1.5; 3], absorption: [0.0; 3] };
        scene.materials = (0..shapes.len()).map(|k| Material { name: k.to_string(), kind: kind.clone() }).collect();
        let object = |(k, shape)| Object { name: format!("{k}"), shape, material: k, visible_to_camera: true };
        scene.objects = shapes.into_iter().enumerate().map(object).collect();
        scene
    }

    fn sphere(center: DVec3, radius: f64) -> Shape {
        Shape::Sphere { center, radius }
    }

    /// A level square, its medium below.
    fn sheet(height: f64, half: f64) -> Shape {
        Shape::Quad { center: DVec3::Y * height, u: DVec3::X * half, v: DVec3::NEG_Z * half }
    }

    /// The cube [-1, 1]³; with a `notch`, its corner (1, 1, 1) is pressed in to the point given.
    fn cube(notch: Vec3) -> Mesh {
        let corner = |k: u32| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) * 2.0 - 1.0;
        let mut positions: Vec<Vec3> = (0..8).map(corner).collect();
        positions[7] = notch;
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [7, 3, 2, 6], [0, 2, 3, 1], [7, 6, 4, 5]];
        let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
        Mesh { file: String::new(), normals: vec![Vec3::Y; 8], positions, triangles, coordinates: vec![], sheet: None }
    }

    #[test]
    fn a_sphere_holds_its_inside() {
        let scene = of(vec![sphere(DVec3::new(1.0, 2.0, 3.0), 0.5)]);
        let at = |y: f64| scene.medium_at(DVec3::new(1.0, 2.0 + y, 3.0));
        assert_eq!([at(0.0), at(0.5 - BESIDE), at(-0.5 + BESIDE)], [Some(0); 3]);
        assert_eq!([at(0.5), at(0.5 + BESIDE), at(f64::NAN), at(f64::INFINITY)], [None; 4]);
    }

    #[test]
    fn an_open_interface_holds_what_lies_behind_it() {
        let scene = of(vec![sheet(0.5, 2.0)]);
        let at = |x: f64, y: f64| scene.medium_at(DVec3::new(x, y, -1.0));
        assert_eq!([at(0.0, 0.5 - BESIDE), at(2.0, -3.0), at(-2.0 + BESIDE, -1e6)], [Some(0); 3]);
        assert_eq!([at(0.0, 0.5), at(0.0, 1.0), at(2.0 + BESIDE, 0.0), at(0.0, f64::NAN)], [None; 4]);
    }

    #[test]
    fn a_mesh_holds_what_it_winds_round() {
        let turned = DAffine3::from_scale_rotation_translation(
            DVec3::splat(3.0),
            DQuat::from_rotation_z(0.7) * DQuat::from_rotation_x(-0.4),
            DVec3::new(5.0, -2.0, 1.0),
        );
        let scene = of(vec![Shape::Mesh { mesh: Arc::new(cube(Vec3::ONE)), to_world: turned }]);
        let at = |x: f64, y: f64, z: f64| scene.medium_at(turned.transform_point3(DVec3::new(x, y, z)));
        let near = 1.0 - BESIDE;
        assert_eq!([at(0.0, 0.0, 0.0), at(near, 0.3, 0.2), at(near, near, near), at(-near, 0.0, near)], [Some(0); 4]);
        let beyond = 1.0 + BESIDE;
        assert_eq!([at(beyond, 0.3, 0.2), at(beyond, beyond, beyond), at(0.0, -beyond, 0.0)], [None; 3]);
        assert_eq!([at(3.0, 0.0, 0.0), at(f64::NAN, 0.0, 0.0), at(f64::NEG_INFINITY, 0.0, 0.0)], [None; 3]);
    }

    #[test]
    fn a_dent_is_outside_though_in_the_box() {
        let mesh = Arc::new(cube(Vec3::splat(-0.5)));
        let scene = of(vec![Shape::Mesh { mesh, to_world: DAffine3::IDENTITY }]);
        assert_eq!(scene.medium_at(DVec3::splat(-0.6)), Some(0));
        assert_eq!([scene.medium_at(DVec3::splat(-0.4)), scene.medium_at(DVec3::splat(0.9))], [None; 2]);
    }

    #[test]
    fn winding_is_one_inside_none_outside_and_finite_on_the_surface() {
        /// Twelve arctangents.
        const ROUNDING: f64 = 1e-14;
        let mesh = cube(Vec3::ONE);
        assert!((winding(&mesh, DVec3::new(0.3, -0.9, 0.1)) - 1.0).abs() < ROUNDING);
        assert!(winding(&mesh, DVec3::new(1.3, -0.9, 0.1)).abs() < ROUNDING);
        let on = [DVec3::ONE, DVec3::new(1.0, 1.0, 0.2), DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 0.3, -0.6)];
        for p in on {
            let w = winding(&mesh, p);
            assert!((-ROUNDING..=1.0 + ROUNDING).contains(&w), "{p}: {w}");
        }
    }

    fn canonical(kind: Canonical, stretch: DVec3, at: DVec3) -> Shape {
        let turn = DQuat::from_rotation_y(0.5);
        Shape::Canonical { kind, to_world: DAffine3::from_scale_rotation_translation(stretch, turn, at) }
    }

    #[test]
    fn a_box_holds_what_is_within_its_sides_and_a_disk_what_is_below_it() {
        let (stretch, at) = (DVec3::new(2.0, 1.0, 0.5), DVec3::new(0.3, 1.0, 0.0));
        let boxed = of(vec![canonical(Canonical::Box, stretch, at)]);
        let pane = of(vec![canonical(Canonical::Disk, DVec3::splat(2.0), at)]);
        let turned = |p: DVec3| at + DQuat::from_rotation_y(0.5) * p;
        for (scale, inside) in [(0.0, true), (1.0 - BESIDE, true), (1.0 + BESIDE, false)] {
            for corner in [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::ONE] {
                assert_eq!(boxed.medium_at(turned(corner * stretch * scale)).is_some(), inside, "{corner} {scale}");
            }
        }
        assert_eq!(pane.medium_at(turned(DVec3::new(1.9, 0.0, -5.0))), Some(0));
        for outside in [DVec3::new(2.1, 0.0, -5.0), DVec3::new(1.5, 1.5, -5.0), DVec3::Z * BESIDE, DVec3::ZERO] {
            assert_eq!(pane.medium_at(turned(outside)), None, "{outside}");
        }
    }

    #[test]
    fn the_innermost_medium_counts() {
        let mesh = Shape::Mesh { mesh: Arc::new(cube(Vec3::ONE)), to_world: DAffine3::IDENTITY };
        let scene =
            of(vec![sheet(8.0, 9.0), sphere(DVec3::ZERO, 3.0), mesh, sphere(DVec3::ZERO, 0.5), sheet(5.0, 9.0)]);
        let at = |y: f64| scene.medium_at(DVec3::Y * y);
        assert_eq!([at(9.0), at(6.0), at(4.0)], [None, Some(0), Some(4)]);
        assert_eq!([at(2.0), at(0.9), at(0.4), at(-0.9), at(-4.0)], [Some(1), Some(2), Some(3), Some(2), Some(4)]);
    }

    #[test]
    fn only_dielectrics_hold_a_medium_and_an_eye_only_what_it_sees() {
        let mut scene = of(vec![sphere(DVec3::ZERO, 1.0)]);
        let mut camera = scene.cameras["main"].clone();
        assert_eq!(scene.media_of_eye(&camera, DVec3::ZERO).pop(), Some(0));
        camera.hides_specular = true;
        assert_eq!(scene.media_of_eye(&camera, DVec3::ZERO).pop(), None);
        camera.hides_specular = false;
        scene.objects[0].visible_to_camera = false;
        assert_eq!(scene.media_of_eye(&camera, DVec3::ZERO).pop(), None);
        assert_eq!(scene.medium_at(DVec3::ZERO), Some(0));
        scene.materials[0].kind = MaterialKind::Mirror { reflectance: [1.0; 3] };
        assert_eq!(scene.medium_at(DVec3::ZERO), None);
    }
}
