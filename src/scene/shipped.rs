//! The scenes and meshes inside the program.
use include_dir::{Dir, include_dir};

static SCENES: Dir = include_dir!("$CARGO_MANIFEST_DIR/scenes");

/// Name and text of every shipped scene that methods are judged on, sorted by name.
pub fn scenes() -> impl Iterator<Item = (&'static str, &'static str)> {
    named(&SCENES)
}

/// Scenes that stand in for a paper's own: loaded by name like any other, and no part of what methods are judged on.
const PAPERS: &str = "papers";

/// As [`scenes`], of those.
pub fn papers() -> impl Iterator<Item = (&'static str, &'static str)> {
    SCENES.get_dir(PAPERS).into_iter().flat_map(named)
}

fn named(folder: &'static Dir) -> impl Iterator<Item = (&'static str, &'static str)> {
    let scene = |file: &'static include_dir::File| {
        Some((file.path().file_name()?.to_str()?.strip_suffix(".toml")?, file.contents_utf8()?))
    };
    let mut scenes: Vec<_> = folder.files().filter_map(scene).collect();
    scenes.sort();
    scenes.into_iter()
}

/// Place and text of a shipped scene.
pub fn text(name: &str) -> Option<(String, &'static str)> {
    let of = |file: String| Some((format!("built-in scenes/{file}"), SCENES.get_file(&file)?.contents_utf8()?));
    let plain = !name.contains('/');
    plain.then(|| of(format!("{name}.toml")).or_else(|| of(format!("{PAPERS}/{name}.toml")))).flatten()
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
