//! The files that a scene names: each read once, all of them part of its hash.
use std::{collections::BTreeMap, path::Path, sync::Arc};

use super::{
    Mesh, Models, Picture, error::SceneError, gltf::Document, imports::Told, load::Files, locate::Key, models, obj,
};

/// What to do about a file that cannot be read.
pub const BESIDE: &str = "paths are relative to the scene file";
const MESH: &str = "paths are relative to the scene file; a mesh may be model:NAME, one of the models folder";

/// By its ending.
fn is_gltf(file: &str) -> bool {
    let ending = Path::new(file).extension().map(|ending| ending.to_ascii_lowercase());
    ending.is_some_and(|ending| ending == "gltf" || ending == "glb")
}

/// What a scene file names: the meshes and pictures read so far, each once, and the hash over the scene and their bytes.
pub struct Assets<'a> {
    files: &'a Files,
    hasher: blake3::Hasher,
    meshes: BTreeMap<String, Arc<Mesh>>,
    pictures: BTreeMap<String, Arc<Picture>>,
    /// What is left out of them.
    pub warnings: Vec<String>,
}

impl<'a> Assets<'a> {
    pub fn new(files: &'a Files, resolved: &str) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(resolved.as_bytes());
        Assets { files, hasher, meshes: BTreeMap::new(), pictures: BTreeMap::new(), warnings: Vec::new() }
    }

    pub fn hash(&self) -> String {
        self.hasher.finalize().to_hex().to_string()
    }

    /// By the ending of its name: OBJ, or glTF whole.
    pub fn mesh(&mut self, key: &Key, file: &str) -> Result<Arc<Mesh>, SceneError> {
        if let Some(mesh) = self.meshes.get(file) {
            return Ok(mesh.clone());
        }
        if is_gltf(file) {
            let document = self.document(key, file, MESH)?;
            let mut told = Told::of(&document);
            let mesh = document.flattened(file, |body| told.body(body)).map_err(|fault| fault.in_scene(key, file))?;
            self.warnings.extend(told.warnings(file));
            return Ok(self.meshes.entry(file.to_owned()).or_insert(Arc::new(mesh)).clone());
        }
        let bytes = if let Some(name) = file.strip_prefix(models::PREFIX) {
            let bytes = Models::open().read(name);
            let bytes = bytes.map_err(|fault| key.fault(fault.expected, fault.found, fault.remedy))?;
            self.hasher.update(&bytes);
            bytes
        } else {
            self.bytes(key, file, "a readable OBJ or glTF file", MESH)?
        };
        let mesh = Arc::new(obj::parse(file, &bytes).map_err(|fault| {
            let line = if fault.line == 0 { String::new() } else { format!(":{}", fault.line) };
            key.fault(fault.expected, format!("{} at {file}{line}", fault.found), fault.remedy)
        })?);
        self.meshes.insert(file.to_owned(), mesh.clone());
        Ok(mesh)
    }

    /// Of a texture or a slide.
    pub fn picture(&mut self, key: &Key, file: &str) -> Result<Arc<Picture>, SceneError> {
        if let Some(picture) = self.pictures.get(file) {
            return Ok(picture.clone());
        }
        let bytes = self.bytes(key, file, "a readable picture", BESIDE)?;
        let picture = Arc::new(Picture::read(key, file, &bytes)?);
        self.pictures.insert(file.to_owned(), picture.clone());
        Ok(picture)
    }

    /// A glTF file with its buffers.
    pub fn document(&mut self, key: &Key, file: &str, remedy: &str) -> Result<Document, SceneError> {
        let bytes = self.bytes(key, file, "a readable glTF file", remedy)?;
        let folder = Path::new(file).parent().unwrap_or(Path::new("")).to_owned();
        let mut beside = |name: &str| {
            let bytes = self.files.read(&folder.join(name).to_string_lossy())?;
            self.hasher.update(&bytes);
            Ok(bytes)
        };
        Document::read(&bytes, &mut beside).map_err(|fault| fault.in_scene(key, file))
    }

    /// Of a file beside the scene, which are of the scene from now on.
    pub fn bytes(&mut self, key: &Key, file: &str, expected: &str, remedy: &str) -> Result<Vec<u8>, SceneError> {
        let unreadable = |why: String| key.fault(expected, format!("{file}: {why}"), remedy);
        let bytes = self.files.read(file).map_err(unreadable)?;
        self.hasher.update(&bytes);
        Ok(bytes)
    }
}
