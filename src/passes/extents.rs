//! What views have to hold: the specular objects, the receiver's rectangles, everything.

use glam::{DVec2, DVec3};

use crate::{
    scene::{Object, Region, Scene, Shape},
    view::Extent,
};

/// Points and spheres of one object: spheres exact, meshes by their vertices, the rest by what holds them.
pub fn of_object(object: &Object) -> Extent {
    match &object.shape {
        Shape::Sphere { center, radius } => Extent { points: vec![], spheres: vec![(*center, *radius)] },
        Shape::Quad { center, u, v } => corners(*center, *u, *v),
        Shape::Canonical { kind, to_world } => {
            Extent { points: kind.hull().into_iter().map(|p| to_world.transform_point3(p)).collect(), spheres: vec![] }
        }
        Shape::Mesh { mesh, to_world } => {
            let used = mesh.triangles.iter().flatten().filter_map(|&i| mesh.positions.get(i as usize));
            Extent { points: used.map(|p| to_world.transform_point3(p.as_dvec3())).collect(), spheres: vec![] }
        }
    }
}

/// Points on an object's surface that show where it lies: of a sphere where its axes meet it.
pub fn points_on(object: &Object) -> Vec<DVec3> {
    let extent = of_object(object);
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let poles =
        extent.spheres.iter().flat_map(|&(center, radius)| axes.clone().map(move |axis| center + radius * axis));
    extent.points.iter().copied().chain(poles).collect()
}

fn corners(center: DVec3, u: DVec3, v: DVec3) -> Extent {
    Extent { points: [u + v, u - v, v - u, -u - v].map(|d| center + d).to_vec(), spheres: vec![] }
}

/// The corners of a rectangle on a receiver.
pub fn of_region(region: &Region) -> Extent {
    corners(region.center, region.u, region.v)
}

/// A rectangle that a method covers.
#[derive(Clone, Debug)]
pub struct Receiver {
    /// It.
    pub patch: Region,
    /// How far the quad that it lies on goes on beyond its sides −u, −v and +u, +v, m.
    pub beyond: [DVec2; 2],
}

impl Receiver {
    fn new(scene: &Scene, patch: &Region) -> Self {
        let beyond = match scene.objects.get(patch.receiver).map(|o| &o.shape) {
            Some(Shape::Quad { center, u, v }) => {
                let aside = patch.center - *center;
                let aside = DVec2::new(aside.dot(u.normalize_or_zero()), aside.dot(v.normalize_or_zero()));
                let slack = DVec2::new(u.length() - patch.u.length(), v.length() - patch.v.length());
                [(slack + aside).max(DVec2::ZERO), (slack - aside).max(DVec2::ZERO)]
            }
            _ => [DVec2::INFINITY; 2],
        };
        Self { patch: patch.clone(), beyond }
    }
}

/// What a camera may see lit: through `region` its rectangle alone; else the scene's extent, and every other diffuse quad
/// that cameras see, whole.
pub fn receivers(scene: &Scene, camera: &str) -> Vec<Receiver> {
    if camera == "region" {
        return vec![Receiver::new(scene, &scene.region)];
    }
    let others = scene.objects.iter().enumerate().filter_map(|(receiver, object)| match object.shape {
        Shape::Quad { center, u, v }
            if receiver != scene.extent.receiver
                && object.visible_to_camera
                && !scene.materials[object.material].is_specular() =>
        {
            Some(Region { receiver, center, u, v })
        }
        _ => None,
    });
    [scene.extent.clone()].into_iter().chain(others).map(|patch| Receiver::new(scene, &patch)).collect()
}

/// The objects that a camera may see lit: through `region` its receiver alone; else it and every other diffuse one that
/// cameras see, whatever its shape.
pub fn receiving(scene: &Scene, camera: &str) -> Vec<usize> {
    let diffuse = |object: &Object| object.visible_to_camera && !scene.materials[object.material].is_specular();
    let shown = |&k: &usize| k == scene.region.receiver || camera != "region" && diffuse(&scene.objects[k]);
    (0..scene.objects.len()).filter(shown).collect()
}

/// All objects that refract or reflect.
pub fn specular(scene: &Scene) -> Extent {
    objects(scene, |o| scene.materials[o.material].is_specular())
}

/// All objects that receive.
pub fn diffuse(scene: &Scene) -> Extent {
    objects(scene, |o| !scene.materials[o.material].is_specular())
}

/// All objects.
pub fn everything(scene: &Scene) -> Extent {
    objects(scene, |_| true)
}

fn objects(scene: &Scene, keep: impl Fn(&Object) -> bool) -> Extent {
    let mut all = Extent::default();
    scene.objects.iter().filter(|o| keep(o)).for_each(|o| all.join(&of_object(o)));
    all
}
