//! What stands in the way of light to the water and below it, so that no ray asks where nothing does.

use glam::DVec3;

use crate::{
    passes::water::Water,
    scene::{Canonical, LightKind, Object, Scene, Shape},
};

/// Whether something may stand between a light and the water: what reaches above its lowest point, or the water itself, where it
/// is steeper than the light is low.
pub fn shades(scene: &Scene, water: &Water) -> bool {
    let n = water.frame.normal();
    let (lowest, steepest) = lowest_and_steepest(&scene.objects[water.object].shape);
    let above = |object: &Object| depths_of(object, water).is_some_and(|[least, _]| -least > lowest);
    let stands_low = |kind: &LightKind| {
        ways(kind, water).iter().any(|(d, aside)| {
            let elevation = (-d.dot(n)).clamp(-1.0, 1.0).asin() - aside;
            elevation <= 0.0 || elevation.tan() <= steepest
        })
    };
    others(scene, water).any(above) || scene.lights.iter().any(|light| stands_low(&light.kind))
}

/// Least and greatest depth of all receivers below the water's plane, m.
pub fn depths(scene: &Scene, water: &Water) -> [f64; 2] {
    let diffuse = |object: &&Object| !scene.materials[object.material].is_specular();
    let all = others(scene, water).filter(diffuse).filter_map(|object| depths_of(object, water));
    all.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or_default()
}

fn depths_of(object: &Object, water: &Water) -> Option<[f64; 2]> {
    let n = water.frame.normal();
    let [low, high] = object.shape.bounds()?;
    let middle = (water.frame.center - 0.5 * (low + high)).dot(n);
    let half = 0.5 * (high - low).dot(n.abs());
    Some([middle - half, middle + half])
}

/// The classes of objects that may stand between the water and a receiver; none where all there is is one flat receiver.
pub fn blocks(scene: &Scene, water: &Water) -> Option<&'static str> {
    let mut others_than_water = others(scene, water);
    match (others_than_water.next(), others_than_water.next()) {
        (None, _) | (Some(Object { shape: Shape::Quad { .. }, .. }), None) => None,
        _ if others(scene, water).any(|object| scene.materials[object.material].is_specular()) => Some("MASK_ALL"),
        _ => Some("MASK_DIFFUSE"),
    }
}

fn others<'s>(scene: &'s Scene, water: &Water) -> impl Iterator<Item = &'s Object> {
    let object = water.object;
    scene.objects.iter().enumerate().filter(move |(k, _)| *k != object).map(|(_, object)| object)
}

/// Directions in which light travels to the water's corners, and how far it spreads about them, rad.
fn ways(kind: &LightKind, water: &Water) -> Vec<(DVec3, f64)> {
    match kind {
        LightKind::Directional { direction, .. } => vec![(*direction, 0.0)],
        LightKind::Sun { direction, radius, .. } => vec![(*direction, *radius)],
        _ => {
            let (from, frame) = (kind.position().unwrap_or_default(), &water.frame);
            let corners = [frame.u + frame.v, frame.u - frame.v, frame.v - frame.u, -frame.u - frame.v];
            let size = match kind {
                LightKind::Lamp { face, .. } => face.u.length() + face.v.length(),
                _ => 0.0,
            };
            let way = |corner: DVec3| {
                let way = frame.center + corner - from;
                (way.normalize_or_zero(), (size / way.length()).min(1.0).asin())
            };
            corners.map(way).to_vec()
        }
    }
}

/// Least height over the rectangle, m, and the greatest slope.
fn lowest_and_steepest(shape: &Shape) -> (f64, f64) {
    match shape {
        Shape::Canonical { kind: Canonical::Sine { wave, .. }, to_world } => {
            let amplitude = to_world.matrix3.z_axis.length();
            (-amplitude, amplitude * wave / to_world.matrix3.x_axis.length())
        }
        Shape::Mesh { mesh, to_world } => {
            let lowest = mesh.positions.iter().fold(0.0_f32, |least, p| least.min(p.z));
            let slope = |n: &glam::Vec3| f64::from(n.truncate().length() / n.z);
            let steepest = mesh.normals.iter().map(slope).fold(0.0, f64::max);
            (f64::from(lowest) * to_world.matrix3.z_axis.length(), steepest)
        }
        _ => (0.0, 0.0),
    }
}
