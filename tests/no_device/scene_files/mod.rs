//! Scene files, good and bad. Every fault is judged by its place, its key and its remedy; none may panic.
use std::{fs, path::PathBuf};

use nephroid::scene::{Scene, SceneError};
use tempfile::TempDir;

mod malformed;
mod motion;
mod schema;
mod shapes;
mod sheets;
mod sky;
mod sound;
mod textures;

/// A scene with every kind of thing but a mesh; the tests below change it line by line.
const BASE: &str = include_str!("base.toml");

/// A folder of files that lasts as long as the test.
struct Folder(TempDir);

impl Folder {
    fn new() -> Folder {
        Folder(tempfile::tempdir().expect("a temporary folder"))
    }

    fn write(&self, file: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(file);
        fs::write(&path, content).expect("a file in the temporary folder");
        path
    }

    fn load(&self, content: impl AsRef<[u8]>, overrides: &[(&str, &str)]) -> Result<Scene, SceneError> {
        load(self.write("scene.toml", content).to_str().expect("a UTF-8 path"), overrides)
    }
}

fn load(name_or_path: &str, overrides: &[(&str, &str)]) -> Result<Scene, SceneError> {
    let overrides: Vec<_> = overrides.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    Scene::load(name_or_path, &overrides)
}
