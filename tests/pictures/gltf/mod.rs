//! glTF files, made in code: what they become, and what is said of those that are broken.
use std::{fs, path::PathBuf, sync::Arc};

use glam::{DAffine3, DVec3};
use nephroid::scene::{LightKind, MaterialKind, Mesh, Object, Scene, SceneError, Shape};
use tempfile::TempDir;

mod documented;
mod looks;
mod malformed;
mod nodes;
mod sound;
mod textures;
mod twins;

use crate::made::{self, Gltf};

/// A handful of operations in double precision on numbers of order one.
const ROUNDING: f64 = 1e-12;
/// Numbers that a file holds in single precision.
const SINGLE: f64 = 1e-6;

/// A floor, without anything that shines.
const AROUND: &str = r#"version = 1
title = "A glTF file over a floor"
paths = "all:8"

[region]
receiver = "floor"
center = [0, 0]
half = [1, 1]

[cameras.main.pinhole]
position = [0, 3, 3]
target = [0, 0, 0]
fov_y = 40

[objects.floor]
material = "white"
quad = { center = [0, -0.5, 0], u = [4, 0, 0], v = [0, 0, -4] }

[materials.white.diffuse]
albedo = 0.8
"#;

/// A folder of files that lasts as long as the test.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn write(&self, file: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(file);
        fs::create_dir_all(path.parent().expect("a folder")).expect("the file's folder");
        fs::write(&path, content).expect("a file in the temporary folder");
        path
    }

    /// The floor, and more below it.
    fn load_with(&self, more: &str, overrides: &[(&str, &str)]) -> Result<Scene, SceneError> {
        let path = self.write("scene.toml", format!("{AROUND}{more}"));
        let overrides: Vec<_> = overrides.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        Scene::load(path.to_str().expect("a UTF-8 path"), &overrides)
    }
}

/// `file` beside the floor under the name `room`, with more keys.
fn imported(file: &str, content: impl AsRef<[u8]>, keys: &str) -> Result<Scene, SceneError> {
    let folder = Folder::new();
    folder.write(file, content);
    folder.load_with(&format!("[imports.room]\nfile = \"{file}\"\n{keys}"), &[])
}

/// Triangles of an object in the world.
fn triangles(scene: &Scene, name: &str) -> Vec<[DVec3; 3]> {
    let object = scene.objects.iter().find(|object| object.name == name);
    let object = object.unwrap_or_else(|| panic!("no `{name}` among {:?}", names(scene)));
    let Shape::Mesh { mesh, to_world } = &object.shape else { panic!("`{name}` is no mesh") };
    let corner = |k: u32| to_world.transform_point3(mesh.positions[k as usize].as_dvec3());
    mesh.triangles.iter().map(|corners| corners.map(corner)).collect()
}

fn names(scene: &Scene) -> Vec<&str> {
    scene.objects.iter().map(|object| object.name.as_str()).collect()
}

#[track_caller]
fn close(a: DVec3, b: DVec3, tolerance: f64) {
    assert!((a - b).length() <= tolerance, "{a} is not {b}");
}

fn object<'s>(scene: &'s Scene, name: &str) -> &'s Object {
    let found = scene.objects.iter().find(|object| object.name == name);
    found.unwrap_or_else(|| panic!("no `{name}` among {:?}", names(scene)))
}

fn mesh<'s>(scene: &'s Scene, name: &str) -> (&'s Arc<Mesh>, &'s DAffine3) {
    let Shape::Mesh { mesh, to_world } = &object(scene, name).shape else { panic!("`{name}` is no mesh") };
    (mesh, to_world)
}

fn material<'s>(scene: &'s Scene, name: &str) -> &'s MaterialKind {
    let found = scene.materials.iter().find(|material| material.name == name);
    &found.unwrap_or_else(|| panic!("no `{name}` among {:?}", scene.materials)).kind
}

fn light<'s>(scene: &'s Scene, name: &str) -> &'s LightKind {
    let found = scene.lights.iter().find(|light| light.name == name);
    &found.unwrap_or_else(|| panic!("no `{name}` among {:?}", scene.lights)).kind
}

fn read(file: &Gltf) -> Scene {
    imported("room.glb", file.glb(), "").unwrap_or_else(|error| panic!("{error}"))
}
