//! glTF scenes put into a scene: their nodes become objects, lights and cameras under the name of the import.
use std::collections::BTreeMap;

use glam::DAffine3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    Camera, Light, Material, Object,
    assets::{Assets, BESIDE},
    error::SceneError,
    file::{Floats, one, yes},
    gltf::Document,
    locate::Key,
    picture::refuse_no_coordinates,
    shape_files,
};

mod importer;
mod told;

use importer::Importer;
pub use told::Told;

/// Metres a unit of the file.
const SCALES: std::ops::RangeInclusive<f64> = 1e-9..=1e9;
/// W/lm: a candela is 1/683 W/sr of green light, by the definition of the candela.
const WATTS_PER_LUMEN: f64 = 1.0 / 683.0;
/// Objects that a file may ask for, beside one for each so many bytes of its own: an object takes some 400 bytes.
const OBJECTS: usize = 1024;
const BYTES_AN_OBJECT: usize = 8;

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImportFile {
    /// Path of a glTF file, `.gltf` or `.glb`.
    pub file: String,
    /// Metres a unit of the file.
    #[serde(default = "one")]
    pub scale: f64,
    /// Where its origin is.
    #[serde(default)]
    pub position: Floats<3>,
    /// Degrees about x, then y, then z.
    #[serde(default)]
    pub rotate: Floats<3>,
    /// By the file's names, the scene's materials that stand for its own.
    #[serde(default)]
    pub materials: BTreeMap<String, String>,
    /// Whether its lights come along.
    #[serde(default = "yes")]
    pub lights: bool,
    /// Of its lights; without it 1/683.
    pub watts_per_lumen: Option<f64>,
}

/// What a glTF file brought into a scene.
#[derive(Clone, Debug)]
pub struct Import {
    /// As in the scene; what was brought is named `NAME/…`.
    pub name: String,
    /// As the scene names it.
    pub file: String,
    /// Metres a unit of the file.
    pub scale: f64,
    /// Its objects.
    pub objects: usize,
    /// Of all of its objects.
    pub triangles: usize,
    /// Its materials, less those that the scene's own replaced.
    pub materials: usize,
    /// Its lights.
    pub lights: usize,
    /// Its cameras.
    pub cameras: usize,
}

/// All that the imports of a scene bring.
#[derive(Default)]
pub struct Imported {
    pub imports: Vec<Import>,
    /// Each with the name of its material.
    pub objects: Vec<(Object, String)>,
    pub materials: Vec<Material>,
    pub lights: Vec<Light>,
    pub cameras: BTreeMap<String, Camera>,
    pub warnings: Vec<String>,
}

/// Reads every import; `own` are the names of the scene's own materials.
pub fn imports(
    root: &Key,
    files: &BTreeMap<String, ImportFile>,
    unit: f64,
    own: &[Material],
    assets: &mut Assets,
) -> Result<Imported, SceneError> {
    let mut all = Imported::default();
    for (name, file) in files {
        let key = root.key("imports").key(name);
        let document = assets.document(&key.key("file"), &file.file, BESIDE)?;
        check_replaced(&key.key("materials"), &document, file, own)?;
        let scale = key.key("scale").number(file.scale, SCALES, "metres a unit of the file", "glTF is in metres: 1")?;
        let position = key.key("position").point(file.position, unit)?;
        let turn = shape_files::turned(&key.key("rotate"), file.rotate)? * scale;
        let watts_per_lumen = key.key("watts_per_lumen").number(
            file.watts_per_lumen.unwrap_or(WATTS_PER_LUMEN),
            0.0..=1e6,
            "watts a lumen",
            "1/683 = 0.001464 is that of green light; 1 takes the file's figures as watts",
        )?;
        let importer = Importer {
            name,
            file: &file.file,
            document: &document,
            to_world: DAffine3::from_mat3_translation(turn, position),
            scale,
            watts_per_lumen: file.lights.then_some(watts_per_lumen),
            most: OBJECTS + document.size / BYTES_AN_OBJECT,
            replaced: &file.materials,
        };
        let before = all.objects.len();
        importer.run(&mut all).map_err(|fault| fault.in_scene(&key.key("file"), &file.file))?;
        for (object, name) in &all.objects[before..] {
            if let Some(material) = own.iter().find(|material| material.name == *name) {
                refuse_no_coordinates(&key.key("materials"), &object.shape, material)?;
            }
        }
    }
    Ok(all)
}

/// Both sides of what is replaced are there.
fn check_replaced(key: &Key, document: &Document, file: &ImportFile, own: &[Material]) -> Result<(), SceneError> {
    let names = document.material_names();
    for (theirs, ours) in &file.materials {
        let key = key.key(theirs);
        key.resolve("a material of the glTF file", theirs, names.iter().map(String::as_str))?;
        key.resolve("a material of the scene", ours, own.iter().map(|material| material.name.as_str()))?;
    }
    Ok(())
}
