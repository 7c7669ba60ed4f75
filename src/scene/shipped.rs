//! The scenes and meshes inside the program.
use include_dir::{Dir, include_dir};

static SCENES: Dir = include_dir!("$CARGO_MANIFEST_DIR/scenes");

/// Name and text of every shipped scene, sorted by name.
pub fn scenes() -> impl Iterator<Item = (&'static str, &'static str)> {
    let scene =
        |file: &'static include_dir::File| Some((file.path().to_str()?.strip_suffix(".toml")?, file.contents_utf8()?));
    let mut scenes: Vec<_> = SCENES.files().filter_map(scene).collect();
    scenes.sort();
    scenes.into_iter()
}

/// The bytes of a shipped file, such as a mesh.
pub fn bytes(file: &str) -> Option<&'static [u8]> {
    SCENES.get_file(file).map(|file| file.contents())
}

/// The title in a scene's text; a test holds that every shipped scene has one.
pub fn title(text: &str) -> String {
    let table = text.parse::<toml::Table>().unwrap_or_default();
    table.get("title").and_then(toml::Value::as_str).unwrap_or_default().to_owned()
}

/// What stands for the path of a shipped scene.
pub fn place(name: &str) -> String {
    format!("built-in scenes/{name}.toml")
}
