//! Scene files and meshes with faults: each named with file, line, key and remedy, exit code 1, nothing written.

use std::fs;

use super::{SMALL, names, nephroid, place};

const FAILED: i32 = 1;

/// What is replaced in `glass-sphere`, by what; the line at fault is the first that holds the third; then what the
/// message must say.
const CASES: &[(&str, &str, &str, &[&str])] = &[
    ("version = 1", "version = 2", "version = 2", &["version", "expected version 1", "reads no other"]),
    ("version = 1", "version = one", "version = one", &["expected TOML", "toml.io"]),
    ("unit = 1.0", "unit = 0.0", "unit = 0.0", &["`unit`", "found 0"]),
    ("unit = 1.0", "unit = inf", "unit = inf", &["`unit`", "inf"]),
    ("unit = 1.0", "untis = 1.0", "untis = 1.0", &["untis", "did you mean `unit`"]),
    ("exposure = 0.5", "exposure = \"bright\"", "exposure = \"bright\"", &["exposure", "a number", "bright"]),
    ("exposure = 0.5", "exposure = 0.5\nexposure = 0.6", "exposure = 0.6", &["duplicate key"]),
    ("exposure = 0.5", "medium = 1", "medium = 1", &["medium", "media are not built yet"]),
    ("paths = \"transmit-2\"", "paths = \"all:65\"", "all:65", &["paths", "transmit-2", "all:65"]),
    ("receiver = \"floor\"", "receiver = \"flor\"", "receiver = \"flor\"", &["receiver", "did you mean `floor`"]),
    ("half = [1.5, 1.5]", "half = [1.5, -1.5]", "half = [1.5, -1.5]", &["region.half", "-1.5"]),
    ("half = [1.5, 1.5]", "half = [1.5]", "half = [1.5]", &["region.half"]),
    ("radius = 1.0", "radius = -1.0", "radius = -1.0", &["objects.ball.sphere.radius", "-1"]),
    ("radius = 1.0", "radius = nan", "radius = nan", &["objects.ball.sphere.radius", "NaN"]),
    ("fov_y = 34.0", "fov_y = 180.0", "fov_y = 180.0", &["fov_y", "180"]),
    ("target = [0.0, -0.9, 0.0]", "target = [0.0, 4.5, 5.5]", "target = [0.0, 4.5, 5.5]", &["target", "position"]),
    ("material = \"glass\"", "material = \"glas\"", "material = \"glas\"", &["material", "did you mean `glass`"]),
    ("ior = 1.5", "ior = -1.5", "ior = -1.5", &["materials.glass.dielectric.ior", "-1.5"]),
    ("absorption = 0.0", "absorption = -1.0", "absorption = -1.0", &["absorption", "-1"]),
    ("albedo = 0.8", "albedo = 1.8", "albedo = 1.8", &["materials.white.diffuse.albedo", "1.8"]),
    ("direction = [0.0, -1.0, 0.0]", "direction = [0.0, 0.0, 0.0]", "direction = [0.0", &["lights.sun", "direction"]),
    ("irradiance = 1.0", "irradiance = -1.0", "irradiance = -1.0", &["lights.sun", "irradiance", "-1"]),
    ("[cameras.main.pinhole]", "[cameras.region.pinhole]", "[cameras.region", &["region", "another name"]),
    ("[objects.ball.sphere]", "[objects.ball.cube]", "[objects.ball.cube]", &["cube", "sphere"]),
    ("u = [8.0, 0.0, 0.0]", "u = [8.0, 0.0, 8.0]", "v = [0.0, 0.0, -8.0]", &["objects.floor.quad.v", "right angles"]),
];

fn render(scene: &std::path::Path, wanted: &[&str], what: &str) {
    let (folder, out) = place();
    let ran = nephroid(&format!("render {} {SMALL} --out {}", scene.display(), out.display()));
    assert_eq!(ran.code, Some(FAILED), "{what}: {}", ran.err);
    for words in wanted {
        assert!(ran.err.contains(words), "{what}: the message lacks {words:?}: {}", ran.err);
    }
    assert!(ran.out.is_empty() && names(folder.path()).is_empty(), "{what}: something was written");
}

#[test]
fn each_fault_is_found_with_its_line() {
    let text = nephroid("scenes glass-sphere --source").ok().out;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("faulty.toml");
    for (old, new, mark, wanted) in CASES {
        assert!(text.contains(old), "glass-sphere no longer says {old}");
        let faulty = text.replacen(old, new, 1);
        fs::write(&file, &faulty).unwrap();
        let line = 1 + faulty.lines().position(|line| line.contains(mark)).unwrap();
        let place = format!("faulty.toml:{line}:");
        render(&file, &[wanted, &[place.as_str()][..]].concat(), new);
    }
}

/// Mesh files, and what the message must say of each.
const MESHES: &[(&str, &[&str])] = &[
    ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", &["9"]),
    ("v 0 0 0\nv 1 0 0\nv 0 zero 0\nf 1 2 3\n", &["zero"]),
    ("v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n", &["nan"]),
    ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", &[]),
];

#[test]
fn each_bad_mesh_is_named() {
    let scene = nephroid("scenes bunny --source").ok().out.replace("bunny-lo.obj", "faulty.obj");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml");
    fs::write(&file, scene).unwrap();
    render(&file, &["mine.toml:", "faulty.obj", "No such file"], "no mesh");
    for (mesh, wanted) in MESHES {
        fs::write(folder.path().join("faulty.obj"), mesh).unwrap();
        render(&file, &[&["faulty.obj"], *wanted].concat(), mesh);
    }
}

#[test]
fn files_that_are_no_text_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("binary.toml");
    fs::write(&file, b"version = 1\ntitle = \"\xff\"\n").unwrap();
    render(&file, &["binary.toml:2:", "UTF-8"], "not UTF-8");
    fs::write(&file, "").unwrap();
    render(&file, &["binary.toml", "version"], "empty");
}
