//! Scenes: what light meets, described once for every method, for the truth and for the eye.
//!
//! A scene is a TOML file (see `scenes/` for commented ones) or one of the [shipped](Scene::shipped) scenes. Units are
//! metres, W/m² for directional lights and W/sr for point lights; the file's `unit` scales every length in it.
//!
//! A closed dielectric shape holds its medium inside. A dielectric quad is an open interface: its medium lies on the
//! side its normal points away from (flat water under the air). A material *is* the identity of its medium: where two
//! shapes of one material touch there is no interface, and nested dielectrics can be told apart.
use std::{collections::BTreeMap, fmt, str::FromStr, sync::Arc};

use glam::{DAffine3, DVec3, Vec3};

mod build;
mod error;
mod file;
mod load;
mod locate;
mod measure;
mod mesh;
mod obj;
mod object;
mod overrides;
mod patch;
mod shipped;

pub use error::{Place, SceneError};

/// A checked scene: every number is finite and in range, every name resolved, every length in metres.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Shipped name or file stem.
    pub name: String,
    pub title: String,
    pub source: Source,
    pub paths: PathClass,
    /// Where errors are judged.
    pub region: Region,
    /// What a caustic map covers for cameras other than `region`: twice the region, cut to the receiver, unless stated.
    pub extent: Region,
    /// Exposure of the PNG, in EV: linear values are multiplied by 2^exposure.
    pub exposure: f64,
    /// Always holds `main`, and `region`, which is made from the region.
    pub cameras: BTreeMap<String, Camera>,
    /// Sorted by name.
    pub objects: Vec<Object>,
    /// Sorted by name; the index is the identity of the medium.
    pub materials: Vec<Material>,
    /// Sorted by name.
    pub lights: Vec<Light>,
}

/// Where a scene came from: enough to make it again.
#[derive(Clone, Debug)]
pub struct Source {
    /// The file as the user named it, or the place of a shipped scene.
    pub file: String,
    /// The file's text, comments included.
    pub text: String,
    /// `(key, value)` as given, without the `scene.` prefix.
    pub overrides: Vec<(String, String)>,
    /// The scene as TOML with the overrides applied.
    pub resolved: String,
    /// BLAKE3 (hexadecimal) of `resolved` and of every mesh file.
    pub hash: String,
}

/// Which specular chains between light and receiver count as the caustic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PathClass {
    /// One mirror bounce.
    Reflect1,
    /// Through one surface: into water.
    Transmit1,
    /// Through two surfaces: into and out of glass.
    Transmit2,
    /// Every chain of 1 to this many specular events.
    All(u32),
}

impl PathClass {
    /// Longest chain that [`PathClass::All`] may name.
    pub const LONGEST: u32 = 64;
}

impl fmt::Display for PathClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PathClass::Reflect1 => f.write_str("reflect-1"),
            PathClass::Transmit1 => f.write_str("transmit-1"),
            PathClass::Transmit2 => f.write_str("transmit-2"),
            PathClass::All(events) => write!(f, "all:{events}"),
        }
    }
}

/// Why a text is no [`PathClass`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no path class: use reflect-1, transmit-1, transmit-2 or all:N with N from 1 to 64")]
pub struct PathClassError(pub String);

impl FromStr for PathClass {
    type Err = PathClassError;

    fn from_str(text: &str) -> Result<PathClass, PathClassError> {
        let events = |n: &str| n.parse().ok().filter(|n| (1..=PathClass::LONGEST).contains(n));
        match text {
            "reflect-1" => Some(PathClass::Reflect1),
            "transmit-1" => Some(PathClass::Transmit1),
            "transmit-2" => Some(PathClass::Transmit2),
            _ => text.strip_prefix("all:").and_then(events).map(PathClass::All),
        }
        .ok_or_else(|| PathClassError(text.to_owned()))
    }
}

/// A rectangle on a receiver.
#[derive(Clone, Debug)]
pub struct Region {
    /// Index into [`Scene::objects`]: a diffuse quad.
    pub receiver: usize,
    pub center: DVec3,
    /// Half edges, m, at right angles.
    pub u: DVec3,
    pub v: DVec3,
}

impl Region {
    /// Unit normal u × v, towards the lit side.
    pub fn normal(&self) -> DVec3 {
        self.u.cross(self.v).normalize()
    }

    /// m²
    pub fn area(&self) -> f64 {
        4.0 * self.u.cross(self.v).length()
    }
}

#[derive(Clone, Debug)]
pub struct Object {
    pub name: String,
    pub shape: Shape,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// A hidden object still refracts, reflects and shadows.
    pub visible_to_camera: bool,
}

#[derive(Clone, Debug)]
pub enum Shape {
    /// Exact; never tessellated for tracing.
    Sphere { center: DVec3, radius: f64 },
    /// Half edges `u`, `v` at right angles; the normal u × v points to the lit side.
    Quad { center: DVec3, u: DVec3, v: DVec3 },
    /// `to_world` scales evenly, turns and moves.
    Mesh { mesh: Arc<Mesh>, to_world: DAffine3 },
}

impl Shape {
    /// Smallest and largest corner of the box about the shape, in world axes; `None` for a mesh without triangles.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        match self {
            Shape::Sphere { center, radius } => Some([center - *radius, center + *radius]),
            Shape::Quad { center, u, v } => {
                let half = u.abs() + v.abs();
                Some([center - half, center + half])
            }
            Shape::Mesh { mesh, to_world } => mesh.bounds(|p| to_world.transform_point3(p)),
        }
    }
}

/// A triangle mesh in its own units. Every vertex belongs to a triangle.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// As the scene names it.
    pub file: String,
    pub positions: Vec<Vec3>,
    /// Unit vectors, one a vertex: the file's, or the angle-weighted mean of the triangles about the vertex.
    pub normals: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

#[derive(Clone, Debug)]
pub struct Material {
    pub name: String,
    pub kind: MaterialKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum MaterialKind {
    /// Lambertian; the first one a path meets is its receiver.
    Diffuse {
        albedo: [f64; 3],
    },
    /// Smooth; `absorption` in 1/m.
    Dielectric {
        ior: f64,
        absorption: [f64; 3],
    },
    Mirror {
        reflectance: [f64; 3],
    },
}

impl Material {
    pub fn is_specular(&self) -> bool {
        !matches!(self.kind, MaterialKind::Diffuse { .. })
    }
}

#[derive(Clone, Debug)]
pub struct Light {
    pub name: String,
    pub kind: LightKind,
}

#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// Unit `direction` of travel; `irradiance` in W/m² on a plane that faces the light.
    Directional { direction: DVec3, irradiance: [f64; 3] },
    /// `intensity` in W/sr, the same in every direction.
    Point { position: DVec3, intensity: [f64; 3] },
}

/// Looks along its own −Z, from `position` to `target`; `up` need not be perpendicular.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    pub kind: CameraKind,
    pub position: DVec3,
    pub target: DVec3,
    pub up: DVec3,
    /// Leaves out every specular object, so that the receiver is seen bare.
    pub hides_specular: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub enum CameraKind {
    /// Whole vertical field of view, degrees.
    Pinhole { fov_y: f64 },
    /// Metres seen from edge to edge; without a width it follows from the picture's shape.
    Orthographic { height: f64, width: Option<f64> },
}

impl Scene {
    /// Loads a shipped scene by name, or a file: anything with a slash in it, or ending in `.toml`.
    ///
    /// `overrides` are `(key, value)` pairs, such as `("materials.glass.dielectric.ior", "1.33")`, applied in order and
    /// then checked as if they stood in the file. A kind's name may be left out (`materials.glass.ior`). Values are
    /// TOML values; a bare word is a string.
    ///
    /// # Errors
    /// The first thing wrong, with its place, its key, what was expected, what was found and what to do.
    pub fn load(name_or_path: &str, overrides: &[(String, String)]) -> Result<Scene, SceneError> {
        load::load(name_or_path, overrides)
    }

    /// Name and title of every scene inside the program, sorted by name.
    pub fn shipped() -> impl Iterator<Item = (&'static str, String)> {
        shipped::scenes().map(|(name, text)| (name, shipped::title(text)))
    }

    /// Whether anything refracts or reflects; without it there is no caustic.
    pub fn has_specular(&self) -> bool {
        self.objects.iter().any(|object| self.materials[object.material].is_specular())
    }
}
