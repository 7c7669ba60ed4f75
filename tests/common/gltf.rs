//! glTF files made in code.
#![allow(dead_code)] // each test binary uses its own part

use base64::{Engine, prelude::BASE64_STANDARD};
use serde_json::{Value, json};

/// Component types, by their numbers.
pub const U8: u32 = 5121;
pub const U16: u32 = 5123;
pub const U32: u32 = 5125;
pub const F32: u32 = 5126;

/// A file in the making: its JSON, and its one buffer.
#[derive(Clone)]
pub struct Gltf {
    pub json: Value,
    pub bytes: Vec<u8>,
}

impl Gltf {
    /// One scene without nodes.
    pub fn new() -> Self {
        let json = json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }] });
        Self { json, bytes: Vec::new() }
    }

    /// Adds to a list of the file; the index there.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json.as_object_mut().expect("an object").entry(list).or_insert_with(|| json!([]));
        let list = list.as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    /// A view of bytes, on a multiple of four.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let at = self.bytes.len();
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": at, "byteLength": bytes.len() }))
    }

    pub fn accessor(&mut self, component: u32, kind: &str, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let value = json!({ "bufferView": view, "componentType": component, "type": kind, "count": count });
        self.push("accessors", value)
    }

    /// With the corners of their box, which the specification asks for with positions.
    pub fn vectors(&mut self, rows: &[[f32; 3]]) -> usize {
        let bytes: Vec<u8> = rows.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let accessor = self.accessor(F32, "VEC3", rows.len(), &bytes);
        for (name, choose) in [("min", f32::min as fn(f32, f32) -> f32), ("max", f32::max)] {
            let corner = rows.iter().copied().reduce(|a, b| std::array::from_fn(|axis| choose(a[axis], b[axis])));
            self.json["accessors"][accessor][name] = json!(corner.expect("a vector"));
        }
        accessor
    }

    pub fn shorts(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(U16, "SCALAR", indices.len(), &bytes)
    }

    /// A mesh of one primitive; its attributes, indices and material as given.
    pub fn mesh(&mut self, primitive: Value) -> usize {
        self.push("meshes", json!({ "primitives": [primitive] }))
    }

    /// A node of the scene.
    pub fn node(&mut self, value: Value) -> usize {
        let node = self.push("nodes", value);
        self.json["scenes"][0]["nodes"].as_array_mut().expect("a list").push(json!(node));
        node
    }

    /// A light; the index to name in a node.
    pub fn light(&mut self, value: Value) -> usize {
        let extensions = self.json.as_object_mut().expect("an object").entry("extensions").or_insert(json!({}));
        if extensions.get("KHR_lights_punctual").is_none() {
            extensions["KHR_lights_punctual"] = json!({ "lights": [] });
        }
        let lights = extensions["KHR_lights_punctual"]["lights"].as_array_mut().expect("a list");
        lights.push(value);
        lights.len() - 1
    }

    fn with_buffer(&self, uri: Option<String>) -> String {
        let mut json = self.json.clone();
        if json.get("buffers").is_none() {
            let mut buffer = json!({ "byteLength": self.bytes.len() });
            if let Some(uri) = uri {
                buffer["uri"] = Value::String(uri);
            }
            json["buffers"] = json!([buffer]);
        }
        json.to_string()
    }

    /// With the buffer in it.
    pub fn embedded(&self) -> String {
        let data = BASE64_STANDARD.encode(&self.bytes);
        self.with_buffer(Some(format!("data:application/octet-stream;base64,{data}")))
    }

    /// With the buffer in a file beside it.
    pub fn beside(&self, uri: &str) -> String {
        self.with_buffer(Some(uri.to_owned()))
    }

    /// In one file.
    pub fn glb(&self) -> Vec<u8> {
        glb(&[(b"JSON", self.with_buffer(None).as_bytes()), (b"BIN\0", &self.bytes)])
    }
}

/// A GLB file of chunks.
pub fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut all = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, content) in chunks {
        let length = content.len().next_multiple_of(4);
        all.extend((length as u32).to_le_bytes());
        all.extend(*kind);
        all.extend(*content);
        all.resize(all.len() + length - content.len(), b' ');
    }
    let length = all.len() as u32;
    all[8..12].copy_from_slice(&length.to_le_bytes());
    all
}

/// Corners and triangles of a tetrahedron, counter-clockwise from outside; no two of its edges are alike.
pub const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.25, 0.75, 0.0], [0.25, 0.25, 0.5]];
pub const FACES: [u16; 12] = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3];
/// Unit vectors away from its middle, in eighths of a turn so that single precision is exact enough.
pub const NORMALS: [[f32; 3]; 4] = [[-0.6, 0.0, -0.8], [0.8, 0.0, -0.6], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A tetrahedron of glass under a node, a spot light and a camera: each kind of thing once.
pub fn small() -> Gltf {
    let mut file = Gltf::new();
    let (positions, normals, indices) = (file.vectors(&CORNERS), file.vectors(&NORMALS), file.shorts(&FACES));
    let glass = json!({
        "name": "Glass",
        "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 0 },
        "extensions": {
            "KHR_materials_transmission": { "transmissionFactor": 1 },
            "KHR_materials_ior": { "ior": 1.45 },
            "KHR_materials_volume": {
                "thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 0.25]
            }
        }
    });
    let material = file.push("materials", glass);
    let attributes = json!({ "POSITION": positions, "NORMAL": normals });
    let mesh = file.mesh(json!({ "attributes": attributes, "indices": indices, "material": material }));
    file.node(json!({ "name": "Stone", "mesh": mesh, "translation": [0, 1, 0], "rotation": [0, 0, 0.6, 0.8] }));
    let lamp = file.light(json!({
        "type": "spot", "intensity": 683, "spot": { "innerConeAngle": 0.25, "outerConeAngle": 0.5 }
    }));
    file.node(json!({
        "name": "Lamp", "translation": [0, 4, 0], "rotation": [-0.5_f64.sqrt(), 0, 0, 0.5_f64.sqrt()],
        "extensions": { "KHR_lights_punctual": { "light": lamp } }
    }));
    let eye = file.push("cameras", json!({ "type": "perspective", "perspective": { "yfov": 0.75, "znear": 0.1 } }));
    file.node(json!({ "name": "Eye", "camera": eye, "translation": [0, 1, 4] }));
    file
}
