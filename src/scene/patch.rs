//! The receiver region, the extent about it, and the camera that sees just the region.
use glam::{DVec2, DVec3};

use super::{
    Camera, CameraKind, MaterialKind, Object, Region, Scene, Shape,
    error::SceneError,
    file::{Floats, PatchFile, RegionFile},
    locate::Key,
};

/// Sides may overhang by this share of the receiver: rounding of decimal numbers, and no more.
const OVERHANG: f64 = 1e-9;

/// Region and extent, both on the region's receiver.
pub fn regions(
    root: &Key,
    region: &RegionFile,
    extent: Option<&PatchFile>,
    unit: f64,
    scene: (&[Object], &[super::Material]),
) -> Result<(Region, Region), SceneError> {
    let key = root.key("region");
    let receiver = Receiver::find(&key, &region.receiver, scene)?;
    let inner = receiver.patch(&key, region.center, region.half, unit)?;
    let outer = match extent {
        Some(PatchFile { center, half: Some(half) }) => {
            receiver.patch(&root.key("extent"), center.unwrap_or(region.center), *half, unit)?
        }
        Some(PatchFile { center: Some(center), half: None }) => {
            let around = receiver.patch(&root.key("extent"), *center, region.half, unit)?;
            receiver.cut(Patch { half: 2.0 * inner.half, ..around })
        }
        Some(PatchFile { center: None, half: None }) | None => receiver.cut(Patch { half: 2.0 * inner.half, ..inner }),
    };
    Ok((receiver.region(inner), receiver.region(outer)))
}

/// A rectangle in the receiver's own metres from its centre.
#[derive(Clone, Copy)]
struct Patch {
    center: DVec2,
    half: DVec2,
}

struct Receiver {
    object: usize,
    center: DVec3,
    /// Half edges.
    u: DVec3,
    v: DVec3,
}

impl Receiver {
    fn find(key: &Key, name: &str, scene: (&[Object], &[super::Material])) -> Result<Receiver, SceneError> {
        let (objects, materials) = scene;
        let key = key.key("receiver");
        let object = key.resolve("an object", name, objects.iter().map(|object| object.name.as_str()))?;
        let diffuse = matches!(materials[objects[object].material].kind, MaterialKind::Diffuse { .. });
        match objects[object].shape {
            Shape::Quad { center, u, v } if diffuse => Ok(Receiver { object, center, u, v }),
            _ => Err(key.fault("a diffuse quad", format!("`{name}`, which is none"), "name one, or change the object")),
        }
    }

    fn patch(&self, key: &Key, center: Floats<2>, half: Floats<2>, unit: f64) -> Result<Patch, SceneError> {
        let center = DVec2::from(key.key("center").pair(center, unit, false)?);
        let half = DVec2::from(key.key("half").pair(half, unit, true)?);
        let (reach, limit) = (center.abs() + half, self.half());
        if reach.cmple(limit * (1.0 + OVERHANG)).all() {
            return Ok(Patch { center, half });
        }
        let expected = format!("a rectangle within the receiver's ±{} by ±{} m", limit.x, limit.y);
        let found = format!("one that reaches to {} by {} m", reach.x, reach.y);
        Err(key.key("half").fault(expected, found, "make the rectangle smaller or the receiver larger"))
    }

    fn half(&self) -> DVec2 {
        DVec2::new(self.u.length(), self.v.length())
    }

    fn cut(&self, patch: Patch) -> Patch {
        let limit = self.half();
        let (low, high) = ((patch.center - patch.half).max(-limit), (patch.center + patch.half).min(limit));
        Patch { center: 0.5 * (low + high), half: 0.5 * (high - low) }
    }

    fn region(&self, patch: Patch) -> Region {
        let (u, v) = (self.u.normalize(), self.v.normalize());
        Region {
            receiver: self.object,
            center: self.center + u * patch.center.x + v * patch.center.y,
            u: u * patch.half.x,
            v: v * patch.half.y,
        }
    }
}

/// Exactly the region, along its normal, from above everything in the scene, specular objects left out.
pub fn camera(scene: &Scene) -> Camera {
    let region = &scene.region;
    let normal = region.normal();
    let height_of = |[low, high]: [DVec3; 2]| {
        (0.5 * (low + high) - region.center).dot(normal) + 0.5 * (high - low).dot(normal.abs())
    };
    let highest = scene.objects.iter().filter_map(|o| o.shape.bounds()).map(height_of).fold(0.0, f64::max);
    let distance = highest + region.u.length() + region.v.length();
    Camera {
        kind: CameraKind::Orthographic { height: 2.0 * region.v.length(), width: Some(2.0 * region.u.length()) },
        position: region.center + normal * distance,
        target: region.center,
        up: region.v.normalize(),
        hides_specular: true,
    }
}
