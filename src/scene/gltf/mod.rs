//! Static glTF 2.0, as JSON (`.gltf`) or in one file (`.glb`): triangles, nodes, materials, cameras and punctual lights.
//!
//! Read here and not by the crate `gltf`, as OBJ is: no input may panic, and every fault names its place. That crate reads
//! accessors without asking whether they lie within their buffers, ends the program on a GLB whose header says a length
//! below its own, takes indices modulo 2³², and refuses files that require `KHR_mesh_quantization`. A test holds this
//! reader against it on sound files.
//!
//! Work and memory are bounded by the file: it may ask for as many triangles and sparse elements as it has bytes,
//! buffers included. Every triangle takes a byte at least, so that only a file that reads the same data again and again
//! meets the bound.
use std::{cell::Cell, collections::BTreeMap, rc::Rc};

mod accessor;
mod appearance;
mod container;
mod flat;
mod geometry;
mod json;
mod names;
mod nodes;
mod textures;

pub use appearance::{Look, camera, light, look};
pub use container::READ;
pub use geometry::{Body, Group, mapped};
pub use json::Root;
pub use names::{Names, shown};

use super::{error::SceneError, locate::Key};

/// What is wrong with a glTF file, in the parts of a scene's error.
#[derive(Debug, PartialEq)]
pub struct GltfFault {
    /// Behind the file's name: `:line:column`, or `: path.in.the[0].JSON`; empty for the file as a whole.
    pub at: String,
    pub expected: String,
    pub found: String,
    pub remedy: String,
}

impl GltfFault {
    /// As a fault of the scene that names the file.
    pub fn in_scene(self, key: &Key, file: &str) -> SceneError {
        key.fault(self.expected, format!("{} at {file}{}", self.found, self.at), self.remedy)
    }
}

/// At a path in the JSON.
pub fn fault(
    path: impl AsRef<str>,
    expected: impl Into<String>,
    found: impl Into<String>,
    remedy: impl Into<String>,
) -> GltfFault {
    let path = path.as_ref();
    let at = if path.is_empty() { String::new() } else { format!(": {path}") };
    GltfFault { at, expected: expected.into(), found: found.into(), remedy: remedy.into() }
}

const EXPORT: &str = "export the file again";

/// Reads a file by its path relative to the glTF file.
pub type ReadBeside<'a> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'a;

/// A file whose layout is sound; its figures are checked as they are used.
pub struct Document {
    pub json: Root,
    /// Bytes of the file and of its buffers.
    pub size: usize,
    buffers: Vec<Rc<[u8]>>,
    pictures: textures::Pictures,
    /// Triangles and sparse elements that may still be read.
    left: Cell<usize>,
}

impl Document {
    pub fn read(bytes: &[u8], beside: &mut ReadBeside) -> Result<Document, GltfFault> {
        let (json, binary) = container::split(bytes)?;
        let json = container::parse(json)?;
        let buffers = container::buffers(&json.buffers, binary, beside)?;
        // A buffer that two names share is counted once, as it is held.
        let mut distinct: Vec<&Rc<[u8]>> = buffers.iter().collect();
        distinct.sort_by_key(|buffer| Rc::as_ptr(buffer).cast::<u8>());
        distinct.dedup_by(|a, b| Rc::ptr_eq(a, b));
        let size = bytes.len() + distinct.iter().map(|buffer| buffer.len()).sum::<usize>();
        let mut document = Document { json, size, buffers, pictures: BTreeMap::new(), left: Cell::new(size) };
        textures::pictures(&mut document, beside)?;
        Ok(document)
    }

    /// Takes from what may still be read.
    pub fn spend(&self, path: &str, elements: usize) -> Result<(), GltfFault> {
        let left = self.left.get().checked_sub(elements).ok_or_else(|| {
            let remedy = "export meshes once each, and let nodes share them; `[imports]` keeps them shared";
            fault(path, "as many triangles as the file has bytes, at most", "more", remedy)
        })?;
        self.left.set(left);
        Ok(())
    }
}

/// The thing that an index names.
fn named<'t, T>(things: &'t [T], index: usize, path: &str, what: &str) -> Result<&'t T, GltfFault> {
    let missing = || fault(path, format!("the index of one of {} {what}", things.len()), index.to_string(), EXPORT);
    things.get(index).ok_or_else(missing)
}
