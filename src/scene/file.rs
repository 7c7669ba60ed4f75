//! The scene file, version 1, as it is written: names unresolved, lengths in the file's own unit.
use std::{collections::BTreeMap, fmt};

use serde::{
    Deserialize, Deserializer,
    de::{Error, IgnoredAny, SeqAccess, Unexpected, Visitor},
};

use super::{
    imports::ImportFile,
    index::IndexFile,
    motion_files::{LightMotionFile, ObjectMotionFile},
};

/// The one version there is.
pub const VERSION: i64 = 1;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    #[serde(rename = "version")]
    _version: i64,
    pub title: String,
    #[serde(default = "one")]
    pub unit: f64,
    pub paths: String,
    #[serde(default)]
    pub exposure: f64,
    pub region: RegionFile,
    pub extent: Option<PatchFile>,
    pub cameras: BTreeMap<String, CameraFile>,
    pub objects: BTreeMap<String, ObjectFile>,
    pub materials: BTreeMap<String, MaterialFile>,
    #[serde(default)]
    pub lights: BTreeMap<String, LightFile>,
    #[serde(default)]
    pub imports: BTreeMap<String, ImportFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegionFile {
    pub receiver: String,
    pub center: Floats<2>,
    pub half: Floats<2>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PatchFile {
    /// Else the region's.
    pub center: Option<Floats<2>>,
    /// Else twice the region's.
    pub half: Option<Floats<2>>,
}

/// Exactly one kind is given, as in the tables below.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraFile {
    pub pinhole: Option<PinholeFile>,
    pub orthographic: Option<OrthographicFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PinholeFile {
    pub position: Floats<3>,
    pub target: Floats<3>,
    #[serde(default = "upwards")]
    pub up: Floats<3>,
    #[serde(default)]
    pub hides_specular: bool,
    pub fov_y: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrthographicFile {
    pub position: Floats<3>,
    pub target: Floats<3>,
    #[serde(default = "upwards")]
    pub up: Floats<3>,
    #[serde(default)]
    pub hides_specular: bool,
    pub height: f64,
    pub width: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectFile {
    pub material: String,
    #[serde(default = "yes")]
    pub visible_to_camera: bool,
    pub sphere: Option<SphereFile>,
    pub quad: Option<QuadFile>,
    pub r#box: Option<BoxFile>,
    pub disk: Option<DiskFile>,
    pub cylinder: Option<CylinderFile>,
    pub paraboloid: Option<ParaboloidFile>,
    pub sine: Option<SineFile>,
    pub heights: Option<HeightsFile>,
    pub wave: Option<WaveFile>,
    pub mesh: Option<MeshFile>,
    pub motion: Option<ObjectMotionFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereFile {
    pub center: Floats<3>,
    pub radius: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QuadFile {
    pub center: Floats<3>,
    pub u: Floats<3>,
    pub v: Floats<3>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxFile {
    pub center: Floats<3>,
    pub half: Floats<3>,
    #[serde(default)]
    pub rotate: Floats<3>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiskFile {
    pub center: Floats<3>,
    pub normal: Floats<3>,
    pub radius: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CylinderFile {
    pub base: Floats<3>,
    pub axis: Floats<3>,
    pub radius: f64,
    pub height: f64,
    #[serde(default = "full_turn")]
    pub arc: f64,
    /// Needed where the arc is less than a full turn.
    pub middle: Option<Floats<3>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParaboloidFile {
    pub vertex: Floats<3>,
    pub axis: Floats<3>,
    pub focal_length: f64,
    pub rim: f64,
    /// With `middle`, an off-axis part.
    pub from: Option<f64>,
    pub middle: Option<Floats<3>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SineFile {
    pub center: Floats<3>,
    pub u: Floats<3>,
    pub v: Floats<3>,
    pub amplitude: f64,
    pub wavelength: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeightsFile {
    pub file: String,
    pub center: Floats<3>,
    pub u: Floats<3>,
    pub v: Floats<3>,
    /// Of a pixel of value 1; of PNG, white.
    pub height: f64,
    /// Height of a pixel of value 0.
    #[serde(default)]
    pub base: f64,
    /// Cells along the longer side; without it one between two pixels.
    pub grid: Option<u32>,
}

/// Constants that are left out are the paper's.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaveFile {
    pub center: Floats<3>,
    pub u: Floats<3>,
    pub v: Floats<3>,
    /// Of one unit of the wave; else the edge along u.
    pub length: Option<f64>,
    /// The wave's own coordinates at the centre.
    pub middle: Option<Floats<2>>,
    pub octaves: Option<u32>,
    pub wave_size: Option<f64>,
    pub factor: Option<f64>,
    pub speed: Option<f64>,
    pub vertex_size: Option<f64>,
    #[serde(default)]
    pub time: f64,
    pub grid: Option<u32>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    pub file: String,
    pub fit: f64,
    pub center: Floats<3>,
    #[serde(default)]
    pub rotate: Floats<3>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialFile {
    pub diffuse: Option<DiffuseFile>,
    pub dielectric: Option<DielectricFile>,
    pub mirror: Option<MirrorFile>,
    pub conductor: Option<ConductorFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiffuseFile {
    pub albedo: Colour,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DielectricFile {
    pub ior: IndexFile,
    #[serde(default)]
    pub absorption: Colour,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MirrorFile {
    pub reflectance: Colour,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConductorFile {
    pub eta: Colour,
    pub k: Colour,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightFile {
    pub directional: Option<DirectionalFile>,
    pub point: Option<PointFile>,
    pub spot: Option<SpotFile>,
    pub motion: Option<LightMotionFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DirectionalFile {
    pub direction: Floats<3>,
    pub irradiance: Colour,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointFile {
    pub position: Floats<3>,
    pub intensity: Colour,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpotFile {
    pub position: Floats<3>,
    pub direction: Floats<3>,
    pub intensity: Colour,
    /// Degrees from the axis; without it the edge is sharp.
    pub inner: Option<f64>,
    pub outer: f64,
}

pub fn one() -> f64 {
    1.0
}

fn full_turn() -> f64 {
    360.0
}

pub fn yes() -> bool {
    true
}

fn upwards() -> Floats<3> {
    Floats([0.0, 1.0, 0.0])
}

/// Exactly N numbers; the library's own arrays let surplus ones pass.
#[derive(Clone, Copy)]
pub struct Floats<const N: usize>(pub [f64; N]);

impl<const N: usize> Default for Floats<N> {
    fn default() -> Self {
        Floats([0.0; N])
    }
}

impl<'de, const N: usize> Deserialize<'de> for Floats<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Numbers { single: false }).map(Floats)
    }
}

/// One number for all three bands, or `[red, green, blue]`.
#[derive(Clone, Copy, Default)]
pub struct Colour(pub [f64; 3]);

impl<'de> Deserialize<'de> for Colour {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Numbers { single: true }).map(Colour)
    }
}

struct Numbers<const N: usize> {
    /// A lone number stands for N equal ones.
    single: bool,
}

impl<'de, const N: usize> Visitor<'de> for Numbers<N> {
    type Value = [f64; N];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}an array of {N} numbers", if self.single { "a number or " } else { "" })
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        if self.single { Ok([value; N]) } else { Err(E::invalid_type(Unexpected::Other("one number"), &self)) }
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        self.visit_f64(value as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Self::Value, A::Error> {
        let mut values = [0.0; N];
        for (i, value) in values.iter_mut().enumerate() {
            *value = sequence.next_element()?.ok_or_else(|| A::Error::invalid_length(i, &self))?;
        }
        match sequence.next_element::<IgnoredAny>()? {
            None => Ok(values),
            Some(_) => Err(A::Error::invalid_length(N + 1, &self)),
        }
    }
}
