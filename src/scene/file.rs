//! The scene file, version 1, as it is written: names unresolved, lengths in the file's own unit.
use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

pub use super::numbers::{Colour, Floats};
use super::{
    imports::ImportFile,
    index::IndexFile,
    motion_files::{LightMotionFile, ObjectMotionFile},
    schema,
    sea_files::SeaFile,
    shape_files::{BoxFile, CylinderFile, DiskFile, ParaboloidFile, SineFile},
    sheet_files::{HeightsFile, WaveFile},
    sky::SkyFile,
};

/// The one version there is.
pub const VERSION: i64 = 1;

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Of this format: 1.
    #[serde(rename = "version")]
    _version: i64,
    /// One line for lists and reports.
    pub title: String,
    /// Length of one unit of this file, m.
    #[serde(default = "one")]
    pub unit: f64,
    /// What counts as the caustic: `reflect-1`, `transmit-1`, `transmit-2`, or `all:N`, every chain of up to N specular events.
    #[schemars(extend("pattern" = "^(reflect-1|transmit-1|transmit-2|all:[0-9]+)$"))]
    pub paths: String,
    /// Of the picture, EV: linear values are multiplied by 2^exposure.
    #[serde(default)]
    pub exposure: f64,
    /// Where errors are judged.
    pub region: RegionFile,
    /// What a caustic map covers for cameras other than `region`.
    pub extent: Option<PatchFile>,
    /// `main` is needed; `region` is made from the region.
    pub cameras: BTreeMap<String, CameraFile>,
    /// Shapes, each with a material.
    pub objects: BTreeMap<String, ObjectFile>,
    /// What surfaces do to light; each is the identity of its medium.
    pub materials: BTreeMap<String, MaterialFile>,
    /// Together they light the scene.
    #[serde(default)]
    pub lights: BTreeMap<String, LightFile>,
    /// What is seen where nothing is; it lights nothing.
    pub sky: Option<SkyFile>,
    /// glTF files whose objects, materials, lights and cameras come along as `NAME/…`.
    #[serde(default)]
    pub imports: BTreeMap<String, ImportFile>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RegionFile {
    /// Name of an object: a diffuse quad.
    pub receiver: String,
    /// On the receiver, along its u and v.
    pub center: Floats<2>,
    /// Half edges.
    pub half: Floats<2>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatchFile {
    /// Else the region's.
    pub center: Option<Floats<2>>,
    /// Else twice the region's.
    pub half: Option<Floats<2>>,
}

/// Exactly one kind is given, as in the tables below.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = schema::one_kind)]
pub struct CameraFile {
    /// Its rays leave one point.
    pub pinhole: Option<PinholeFile>,
    /// Its rays leave along its axis.
    pub orthographic: Option<OrthographicFile>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PinholeFile {
    /// The eye.
    pub position: Floats<3>,
    /// A point on the camera's axis.
    pub target: Floats<3>,
    /// Upright in the picture.
    #[serde(default = "upwards")]
    pub up: Floats<3>,
    /// Leave out specular objects, so that the receiver is seen bare.
    #[serde(default)]
    pub hides_specular: bool,
    /// Whole vertical field of view, degrees.
    pub fov_y: f64,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OrthographicFile {
    /// On its axis.
    pub position: Floats<3>,
    /// A point on its axis.
    pub target: Floats<3>,
    /// Upright in the picture.
    #[serde(default = "upwards")]
    pub up: Floats<3>,
    /// Leave out specular objects, so that the receiver is seen bare.
    #[serde(default)]
    pub hides_specular: bool,
    /// From the lower to the upper edge.
    pub height: f64,
    /// From edge to edge; without it, it follows from the picture's shape.
    pub width: Option<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = schema::one_kind)]
pub struct ObjectFile {
    /// Name of one of the materials.
    pub material: String,
    /// A hidden object still refracts, reflects and shadows.
    #[serde(default = "yes")]
    pub visible_to_camera: bool,
    /// Closed.
    pub sphere: Option<SphereFile>,
    /// A rectangle, an open interface.
    pub quad: Option<QuadFile>,
    /// Closed.
    pub r#box: Option<BoxFile>,
    /// An open interface.
    pub disk: Option<DiskFile>,
    /// An open tube, or an arc of it.
    pub cylinder: Option<CylinderFile>,
    /// An open bowl, or an off-axis part of it.
    pub paraboloid: Option<ParaboloidFile>,
    /// A sine wave over a rectangle, an open interface.
    pub sine: Option<SineFile>,
    /// A picture as heights over a rectangle, an open interface.
    pub heights: Option<HeightsFile>,
    /// The wave function of rendered water (GPU Gems, 2004), an open interface.
    pub wave: Option<WaveFile>,
    /// A sea by an ocean's spectrum, an open interface.
    pub sea: Option<SeaFile>,
    /// Triangles of a file.
    pub mesh: Option<MeshFile>,
    /// Keys in time.
    pub motion: Option<ObjectMotionFile>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SphereFile {
    /// In lengths of the file.
    pub center: Floats<3>,
    /// In lengths of the file.
    pub radius: f64,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuadFile {
    /// Of the rectangle.
    pub center: Floats<3>,
    /// Half edge.
    pub u: Floats<3>,
    /// Half edge, at right angles to u; u × v points to the lit side.
    pub v: Floats<3>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    /// Path of an OBJ or glTF file, or `model:NAME` of the models folder.
    pub file: String,
    /// Longest side of its bounding box.
    pub fit: f64,
    /// Of its bounding box.
    pub center: Floats<3>,
    /// Degrees about x, then y, then z.
    #[serde(default)]
    pub rotate: Floats<3>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = schema::one_kind)]
pub struct MaterialFile {
    /// Lambertian: a receiver.
    pub diffuse: Option<DiffuseFile>,
    /// Smooth and clear.
    pub dielectric: Option<DielectricFile>,
    /// Reflects a share of the light at every angle.
    pub mirror: Option<MirrorFile>,
    /// A smooth metal.
    pub conductor: Option<ConductorFile>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DiffuseFile {
    /// Share of the light sent back, 0 to 1; with a texture, by what its colours are multiplied.
    pub albedo: Option<Colour>,
    /// A PNG or an EXR, which the surface shows.
    pub texture: Option<String>,
    /// How often the picture is there along each coordinate of the surface.
    pub repeat: Option<Floats<2>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DielectricFile {
    /// Index of refraction against vacuum.
    pub ior: IndexFile,
    /// 1/m.
    #[serde(default)]
    pub absorption: Colour,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MirrorFile {
    /// Share of the light reflected, 0 to 1.
    pub reflectance: Colour,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConductorFile {
    /// Real part of its complex index.
    pub eta: Colour,
    /// Imaginary part of its complex index.
    pub k: Colour,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = schema::one_kind)]
pub struct LightFile {
    /// Parallel light.
    pub directional: Option<DirectionalFile>,
    /// Light from a point, alike on all sides.
    pub point: Option<PointFile>,
    /// Light from a point within a cone.
    pub spot: Option<SpotFile>,
    /// Light from one side of a rectangle, which itself is not seen.
    pub quad: Option<QuadLightFile>,
    /// Light from one side of a disk, which itself is not seen.
    pub disk: Option<DiskLightFile>,
    /// Keys in time.
    pub motion: Option<LightMotionFile>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DirectionalFile {
    /// The way that the light travels.
    pub direction: Floats<3>,
    /// Of a plane that faces the light, W/m².
    pub irradiance: Colour,
    /// Degrees that the light's disc measures across; the sun's are 0.53.
    pub angular_diameter: Option<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuadLightFile {
    /// Of the rectangle.
    pub center: Floats<3>,
    /// Half edge.
    pub u: Floats<3>,
    /// Half edge, at right angles to u; u × v points to the side that shines.
    pub v: Floats<3>,
    /// W/m²/sr, the same in every direction; or `power`.
    pub radiance: Option<Colour>,
    /// Of all that it sends out, W; or `radiance`.
    pub power: Option<Colour>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DiskLightFile {
    /// Of the disk.
    pub center: Floats<3>,
    /// To the side that shines.
    pub normal: Floats<3>,
    /// In lengths of the file.
    pub radius: f64,
    /// W/m²/sr, the same in every direction; or `power`.
    pub radiance: Option<Colour>,
    /// Of all that it sends out, W; or `radiance`.
    pub power: Option<Colour>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointFile {
    /// In lengths of the file.
    pub position: Floats<3>,
    /// W/sr.
    pub intensity: Colour,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpotFile {
    /// In lengths of the file.
    pub position: Floats<3>,
    /// The cone's axis, the way that the light travels.
    pub direction: Floats<3>,
    /// On the axis, W/sr.
    pub intensity: Colour,
    /// Degrees from the axis; without it the edge is sharp.
    pub inner: Option<f64>,
    /// A PNG or an EXR that the light projects, its corners on the cone.
    pub image: Option<String>,
    /// Upright in the image; else +y, or −z in a beam along y.
    pub up: Option<Floats<3>>,
    /// Degrees from the axis at which the light ends.
    pub outer: f64,
}

pub fn one() -> f64 {
    1.0
}

pub fn yes() -> bool {
    true
}

fn upwards() -> Floats<3> {
    Floats([0.0, 1.0, 0.0])
}
