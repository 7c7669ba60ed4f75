//! Scenes: what light meets, described once for every method, for the truth and for the eye.
//!
//! A scene is a TOML file (see `scenes/` for commented ones) or one of the [shipped](Scene::shipped) scenes. Units are
//! metres, W/m² for directional lights, W/sr for point lights and W/m²/sr for surfaces that shine; the file's `unit` scales every length in it.
//!
//! A closed dielectric shape holds its medium inside. A dielectric quad, disk, sine, heights, wave or sea is an open interface:
//! its medium lies on the side its normal points away from (water under the air). Other open shapes bound no medium. A
//! material *is* the identity of its medium: where two shapes of one material touch there is no interface, and nested
//! dielectrics can be told apart.
use std::{collections::BTreeMap, sync::Arc};

use glam::{DAffine3, DVec3, Vec2, Vec3};

mod area;
mod assets;
mod build;
mod canonical;
mod class;
mod deform;
mod edges;
mod error;
mod file;
mod flow;
mod format;
mod gltf;
mod imports;
mod index;
mod light;
mod load;
mod locate;
mod measure;
mod medium;
mod mesh;
mod models;
mod motion;
mod motion_files;
mod numbers;
mod obj;
mod object;
mod overrides;
mod patch;
mod picture;
mod schema;
mod sea;
mod sea_files;
mod shape_files;
mod sheet;
mod sheet_files;
mod shipped;
mod sine;
mod sky;
mod slide;
mod track;
mod wave;
mod written;

use crate::names::NoSuch;

pub use area::{Face, cap_height};
pub use canonical::{Canonical, WHOLE};
pub use class::{PathClass, PathClassError};
pub use error::{Place, SceneError};
pub use imports::Import;
pub use light::{Beam, Light, LightKind};
pub use models::Models;
pub use picture::{MOST_PIXELS, Picture, Texture};
pub use sea::{Ripple, Sea};
pub use sheet::{Relief, Sheet};
pub use sky::Sky;
pub use slide::Slide;
pub use wave::{Wave, WaveAt};
pub use written::Written;

/// A checked scene: every number is finite and in range, every name resolved, every length in metres.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Shipped name or file stem.
    pub name: String,
    /// One line for lists and reports.
    pub title: String,
    /// Where the scene came from.
    pub source: Source,
    /// What counts as this scene's caustic.
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
    /// What the eye sees where nothing is.
    pub sky: Option<Sky>,
    /// What of all this came from glTF files, sorted by name.
    pub imports: Vec<Import>,
    /// The time, s, at which all this is so; of a scene that stands still, 0.
    pub time: f64,
    motion: Option<Arc<motion::Motion>>,
    /// What is no fault, but must be known to whoever reads its pictures: dielectric meshes with holes, and what of a glTF
    /// file is left out.
    pub warnings: Vec<String>,
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
    /// BLAKE3 (hexadecimal) of `resolved`, of every mesh file and its buffers, and of the time where the scene moves.
    pub hash: String,
}

/// A rectangle on a receiver.
#[derive(Clone, Debug)]
pub struct Region {
    /// Index into [`Scene::objects`]: a diffuse quad.
    pub receiver: usize,
    /// m
    pub center: DVec3,
    /// Half edge, m.
    pub u: DVec3,
    /// Half edge, m, at right angles to `u`.
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

/// A shape and what it is made of.
#[derive(Clone, Debug)]
pub struct Object {
    /// As in the file; `IMPORT/NODE` of a glTF file.
    pub name: String,
    /// In the world, metres.
    pub shape: Shape,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// A hidden object still refracts, reflects and shadows.
    pub visible_to_camera: bool,
}

/// A surface, in metres.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Exact; never tessellated for tracing.
    Sphere {
        /// m
        center: DVec3,
        /// m, above zero.
        radius: f64,
    },
    /// A rectangle; its normal u × v points to the lit side.
    Quad {
        /// m
        center: DVec3,
        /// Half edge, m.
        u: DVec3,
        /// Half edge, m, at right angles to `u`.
        v: DVec3,
    },
    /// Exact; never tessellated for tracing.
    Canonical {
        /// Which one.
        kind: Canonical,
        /// From its own space: lengthens it along its axes, turns and moves it.
        to_world: DAffine3,
    },
    /// Triangles.
    Mesh {
        /// Shared by the objects that name the same file, or the same mesh of a glTF file.
        mesh: Arc<Mesh>,
        /// Scales, turns and moves; only nodes of a glTF file stretch, and nothing mirrors.
        to_world: DAffine3,
    },
}

impl Shape {
    /// Corners of a box about the shape, in world axes: the smallest, but for round shapes other than spheres, where it
    /// is up to 0.2 % wider; `None` for a mesh without triangles.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        match self {
            Shape::Sphere { center, radius } => Some([center - *radius, center + *radius]),
            Shape::Quad { center, u, v } => {
                let half = u.abs() + v.abs();
                Some([center - half, center + half])
            }
            Shape::Canonical { kind, to_world } => {
                let points = kind.hull().into_iter().map(|p| to_world.transform_point3(p));
                points.map(|p| [p; 2]).reduce(|[low, high], [p, _]| [low.min(p), high.max(p)])
            }
            Shape::Mesh { mesh, to_world } => mesh.bounds(|p| to_world.transform_point3(p)),
        }
    }
}

/// A triangle mesh in its own units. Every vertex belongs to a triangle.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// As the scene names it: a path, or `model:NAME` of the [`Models`] folder.
    pub file: String,
    /// In the file's own units.
    pub positions: Vec<Vec3>,
    /// Unit vectors, one a vertex: the file's, or the angle-weighted mean of the triangles about the vertex.
    pub normals: Vec<Vec3>,
    /// Indices of the vertices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Texture coordinates, one pair a vertex, (0, 0) at a picture's lower left; none where the file has none.
    pub coordinates: Vec<Vec2>,
    /// Of a height over a rectangle; the mesh is then an open interface, whose normal has z > 0.
    pub sheet: Option<Sheet>,
}

/// What a surface does to light, and which medium it bounds.
#[derive(Clone, Debug)]
pub struct Material {
    /// As in the file.
    pub name: String,
    /// What it does to light.
    pub kind: MaterialKind,
}

/// Colours are one number for each of the three bands.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialKind {
    /// Lambertian; the first one that a path meets is its receiver.
    Diffuse {
        /// Share of the flux sent back, 0 to 1.
        albedo: [f64; 3],
        /// By whose colours the albedo is multiplied.
        texture: Option<Texture>,
    },
    /// Smooth and clear.
    Dielectric {
        /// Index of refraction against vacuum, of each band.
        ior: [f64; 3],
        /// 1/m
        absorption: [f64; 3],
    },
    /// Smooth and opaque.
    Mirror {
        /// Share of the flux reflected, 0 to 1, at every angle.
        reflectance: [f64; 3],
    },
    /// A smooth metal: it reflects by Fresnel's equations and absorbs the rest.
    Conductor {
        /// Real part of its complex index against vacuum.
        eta: [f64; 3],
        /// Imaginary part (the extinction coefficient).
        k: [f64; 3],
    },
}

impl Material {
    /// Whether it bends the bands apart.
    pub fn is_dispersive(&self) -> bool {
        matches!(self.kind, MaterialKind::Dielectric { ior: [r, g, b], .. } if r != g || g != b)
    }

    /// Whether it refracts or reflects without scattering.
    pub fn is_specular(&self) -> bool {
        !matches!(self.kind, MaterialKind::Diffuse { .. })
    }
}

/// Looks along its own −Z, from `position` to `target`; `up` need not be perpendicular.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// How rays leave it.
    pub kind: CameraKind,
    /// m
    pub position: DVec3,
    /// A point on its axis, m.
    pub target: DVec3,
    /// Unit vector, upright in the picture.
    pub up: DVec3,
    /// Leaves out every specular object and its medium, so that the receiver is seen bare.
    pub hides_specular: bool,
}

/// How a camera's rays leave it.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraKind {
    /// From one point.
    Pinhole {
        /// Whole vertical field of view, degrees.
        fov_y: f64,
    },
    /// Along its axis.
    Orthographic {
        /// From the lower to the upper edge, m.
        height: f64,
        /// From edge to edge, m; without it, it follows from the picture's shape.
        width: Option<f64>,
    },
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

    /// Loads a scene again from what it said of itself: its name, [`Source::file`] and [`Source::overrides`]. Whether it
    /// still is the same, [`Source::hash`] says.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn load_again(name: &str, file: &str, overrides: &[(String, String)]) -> Result<Scene, SceneError> {
        let is_shipped = shipped::text(name).is_some_and(|(place, _)| place == file);
        load::load(if is_shipped { name } else { file }, overrides)
    }

    /// Name and title of every scene inside the program that methods are judged on, sorted by name.
    pub fn shipped() -> impl Iterator<Item = (&'static str, String)> {
        shipped::scenes().map(|(name, text)| (name, shipped::title(text)))
    }

    /// As [`Scene::shipped`], of the scenes that stand in for a paper's own.
    pub fn of_papers() -> impl Iterator<Item = (&'static str, String)> {
        shipped::papers().map(|(name, text)| (name, shipped::title(text)))
    }

    /// Triangles of meshes, and two of each quad; other shapes have none.
    pub fn triangles(&self) -> u64 {
        let of = |shape: &Shape| match shape {
            Shape::Mesh { mesh, .. } => mesh.triangles.len() as u64,
            Shape::Quad { .. } => 2,
            Shape::Sphere { .. } | Shape::Canonical { .. } => 0,
        };
        self.objects.iter().map(|object| of(&object.shape)).sum()
    }

    /// The scene format as a JSON schema (draft 2020-12), for editors.
    pub fn schema() -> serde_json::Value {
        schema::schema()
    }

    /// The camera of that name.
    ///
    /// # Errors
    /// Names the ones near it, or all.
    pub fn camera(&self, name: &str) -> Result<&Camera, NoSuch> {
        let known = || self.cameras.keys().map(String::as_str);
        self.cameras.get(name).ok_or_else(|| NoSuch::new("camera", name, known()))
    }

    /// Whether anything bends the bands apart; only then are they traced apart.
    pub fn is_dispersive(&self) -> bool {
        self.objects.iter().any(|object| self.materials[object.material].is_dispersive())
    }

    /// Whether anything refracts or reflects; without it there is no caustic.
    pub fn has_specular(&self) -> bool {
        self.objects.iter().any(|object| self.materials[object.material].is_specular())
    }
}
