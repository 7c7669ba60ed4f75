//! From a name to a checked scene: find, read, parse, override, deserialise, check.
use std::{
    fs,
    path::{Path, PathBuf},
};

use serde::Deserialize;
use toml::{
    Deserializer, Spanned,
    de::{DeTable, DeValue},
};

use super::{
    Scene, Source, build,
    error::{Place, SceneError},
    file::{SceneFile, VERSION},
    locate::{Key, Locator, place_in},
    overrides, shipped,
};
use crate::names::near;

/// A scene's text, and the files it may name.
struct Found {
    name: String,
    file: String,
    text: String,
    files: Files,
}

/// Where a scene's mesh files lie.
pub enum Files {
    /// Inside the program; else relative to the working directory.
    Shipped,
    /// Relative to the scene file.
    Beside(PathBuf),
}

impl Files {
    pub fn read(&self, file: &str) -> Result<Vec<u8>, String> {
        match self {
            Files::Shipped => shipped::bytes(file).map_or_else(|| read(Path::new(file)), |bytes| Ok(bytes.to_vec())),
            Files::Beside(folder) => read(&folder.join(file)),
        }
    }
}

pub fn load(name_or_path: &str, overrides: &[(String, String)]) -> Result<Scene, SceneError> {
    let Found { name, file, text, files } = find(name_or_path)?;
    let mut tree = DeTable::parse(&text).map_err(|error| malformed(&file, &text, &error))?.into_inner();
    overrides::apply(&mut tree, &file, &text, overrides)?;
    let locator = Locator { file: &file, text: &text, overrides, tree };
    check_reserved(&locator)?;
    let root = || Deserializer::from(Spanned::new(0..0, locator.tree.clone()));
    let parsed = SceneFile::deserialize(root()).map_err(|error| misfit(&locator, &error))?;
    let resolved = toml::Table::deserialize(root()).map_err(|error| misfit(&locator, &error))?.to_string();
    let source =
        Source { file: file.clone(), text: text.clone(), overrides: overrides.to_vec(), resolved, hash: String::new() };
    build::build(name, parsed, source, &locator.root(), &files)
}

fn find(name_or_path: &str) -> Result<Found, SceneError> {
    let path = Path::new(name_or_path);
    if name_or_path.contains(['/', std::path::MAIN_SEPARATOR]) || name_or_path.ends_with(".toml") {
        let text = read_text(name_or_path, path)?;
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        return Ok(Found { name, file: name_or_path.to_owned(), text, files: Files::Beside(folder) });
    }
    let Some((file, text)) = shipped::text(name_or_path) else {
        let remedy = near(name_or_path, shipped::scenes().chain(shipped::papers()).map(|(name, _)| name));
        return Err(unreadable(
            name_or_path,
            "the name of a shipped scene, or a path that ends in .toml",
            "no such scene",
            &remedy,
        ));
    };
    Ok(Found { name: name_or_path.to_owned(), file, text: text.to_owned(), files: Files::Shipped })
}

fn read_text(file: &str, path: &Path) -> Result<String, SceneError> {
    let remedy = "check the path; `nephroid scenes` lists the scenes that need none";
    let bytes = read(path).map_err(|why| unreadable(file, "a readable scene file", &why, remedy))?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        SceneError {
            place: Box::new(place_in(file, error.as_bytes(), at)),
            key: String::new(),
            expected: "UTF-8 text".to_owned(),
            found: format!("the byte 0x{:02x}", error.as_bytes()[at]),
            remedy: "save the file as UTF-8".to_owned(),
        }
    })
}

/// Reads a regular file: a folder or a device is refused before it can hang or fill memory.
pub fn read(path: &Path) -> Result<Vec<u8>, String> {
    let kind = fs::metadata(path).map_err(|error| error.to_string())?;
    match () {
        () if kind.is_dir() => Err("a folder".to_owned()),
        () if !kind.is_file() => Err("not a regular file".to_owned()),
        () => fs::read(path).map_err(|error| error.to_string()),
    }
}

fn unreadable(file: &str, expected: &str, found: &str, remedy: &str) -> SceneError {
    SceneError {
        place: Box::new(Place::Scene(file.to_owned())),
        key: String::new(),
        expected: expected.to_owned(),
        found: found.to_owned(),
        remedy: remedy.to_owned(),
    }
}

/// The text is no TOML.
pub fn malformed(file: &str, text: &str, error: &toml::de::Error) -> SceneError {
    SceneError {
        place: Box::new(place_in(file, text.as_bytes(), error.span().map_or(0, |span| span.start))),
        key: String::new(),
        expected: "TOML".to_owned(),
        found: error.message().to_owned(),
        remedy: "see https://toml.io for the format, and the shipped scenes for examples".to_owned(),
    }
}

/// What must be said before the layout is judged: another version's keys are not typing errors.
fn check_reserved(locator: &Locator) -> Result<(), SceneError> {
    let (root, tree) = (locator.root(), &locator.tree);
    let version = tree.get("version").map(|value| value.get_ref());
    let number = version.and_then(DeValue::as_integer).and_then(|n| n.as_str().parse::<i64>().ok());
    if number != Some(VERSION) {
        let found = version.map_or("no version".to_owned(), shown);
        let remedy = format!("write `version = {VERSION}`; this program reads no other");
        return Err(root.key("version").fault(format!("version {VERSION}"), found, remedy));
    }
    if tree.contains_key("medium") {
        let remedy = "take the key out: participating media are not built yet";
        return Err(root.key("medium").fault("no medium", "the reserved key `medium`", remedy));
    }
    for kind in ["cameras", "objects", "materials", "lights", "imports"] {
        for name in tree.get(kind).and_then(|value| value.get_ref().as_table()).into_iter().flat_map(|t| t.keys()) {
            check_name(&root.key(kind), name.get_ref())?;
        }
    }
    if tree.get("cameras").is_some_and(|cameras| cameras.get_ref().get("region").is_some()) {
        let remedy = "choose another name; the scene's region makes this camera";
        return Err(root.key("cameras").key("region").fault("another name", "the reserved name `region`", remedy));
    }
    Ok(())
}

/// Names are parts of dotted keys, on the command line too.
fn check_name(parent: &Key, name: &str) -> Result<(), SceneError> {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(plain) {
        return Ok(());
    }
    Err(parent.fault("names of letters, digits, `_` and `-`", format!("{name:?}"), "rename it"))
}

fn shown(value: &DeValue) -> String {
    match value {
        DeValue::Integer(number) => number.to_string(),
        DeValue::Float(number) => number.to_string(),
        DeValue::String(text) => format!("{text:?}"),
        other => format!("a {}", other.type_str()),
    }
}

/// The TOML is no scene: serde's message, taken apart into our form.
pub fn misfit(locator: &Locator, error: &toml::de::Error) -> SceneError {
    let text = error.to_string();
    let path = text.lines().find_map(|line| line.strip_prefix("in `")?.strip_suffix('`')).unwrap_or_default();
    let at = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    let message = error.message();
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let (key, expected, found, remedy) = if message.starts_with("missing field") {
        let name = quoted.first().copied().unwrap_or_default();
        let remedy = "add it; the shipped scenes show how";
        (at(name), format!("the key `{name}`"), "none".to_owned(), remedy.to_owned())
    } else if message.starts_with("unknown field") {
        let (name, known) = quoted.split_first().map_or(("", &quoted[..]), |(name, known)| (*name, known));
        let expected = format!("one of {}", known.iter().map(|k| format!("`{k}`")).collect::<Vec<_>>().join(", "));
        (at(name), expected, format!("the unknown key `{name}`"), near(name, known.iter().copied()))
    } else if let Some((found, expected)) = message.split_once(", expected ") {
        let (expected, remedy) = plain(expected);
        let found = found.trim_start_matches("invalid type: ").trim_start_matches("invalid value: ");
        (path.to_owned(), expected.to_owned(), found.replace("invalid length", "an array of"), remedy.to_owned())
    } else {
        let remedy = "write one that double precision can hold";
        (path.to_owned(), "a number in range".to_owned(), message.to_owned(), remedy.to_owned())
    };
    let place = Box::new(locator.place(error.span().unwrap_or(0..0)));
    SceneError { place, key, expected, found, remedy }
}

/// What Rust expected in the reader's words, and how to write it.
fn plain(expected: &str) -> (&str, &str) {
    match expected {
        "f64" => ("a number", "write a number, without quotes"),
        "u32" => ("a whole number", "write one of zero or more, without quotes"),
        "a string" => ("a string", "put the text in quotes"),
        "a boolean" => ("true or false", "write true or false, without quotes"),
        "an array of 2 numbers" => (expected, "write `[along u, along v]`"),
        "an array of 3 numbers" => (expected, "write `[x, y, z]`"),
        _ if expected.contains("number") => (expected, "write one number, or `[red, green, blue]`"),
        _ => ("a table", "write its keys below a `[header]`, as the shipped scenes do"),
    }
}
