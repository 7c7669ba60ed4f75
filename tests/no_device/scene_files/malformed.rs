//! One fault each: a line of the base scene changed, a mesh broken, an override that does not fit.
use std::fs;

use nephroid::scene::{Place, SceneError};

use super::{BASE, Folder, load};

/// `BASE` with one passage changed, then the line of the fault, its key, and words of found and remedy.
type Case = (&'static str, &'static str, usize, &'static str, &'static str, &'static str);

#[rustfmt::skip]
const CASES: &[Case] = &[
    // The text is no TOML.
    ("ior = 1.5", "ior = ", 33, "", "must be quoted", "toml.io"),
    ("radius = 1\n", "radius = 1\nradius = 2\n", 23, "", "duplicate key", "toml.io"),
    ("[region]", "[region", 6, "", "unclosed table", "toml.io"),
    // The TOML is no scene.
    ("version = 1", "version = 2", 1, "version", "2", "write `version = 1`"),
    ("version = 1", "", 1, "version", "no version", "write `version = 1`"),
    ("version = 1", "version = \"one\"", 1, "version", "\"one\"", "write `version = 1`"),
    ("[region]", "[medium.box]\nscattering = 1\n[region]", 6, "medium", "reserved key", "media are not built yet"),
    ("[lights.lamp.point]", "[cameras.region.pinhole]", 46, "cameras.region", "reserved name", "choose another name"),
    ("[lights.lamp.point]", "[lights.\"a b\".point]", 42, "lights", "\"a b\"", "rename it"),
    ("[cameras.main.pinhole]", "[cameras.front.pinhole]", 11, "cameras", "none", "add `[cameras.main.pinhole]`"),
    ("title = \"Test\"\n", "", 1, "title", "none", "add it"),
    ("title = \"Test\"", "title = 3", 2, "title", "integer `3`", "in quotes"),
    ("radius = 1", "radus = 1", 22, "objects.ball.sphere.radus", "unknown key `radus`", "did you mean `radius`?"),
    ("radius = 1", "", 20, "objects.ball.sphere.radius", "none", "add it"),
    ("radius = 1", "radius = \"one\"", 22, "objects.ball.sphere.radius", "string \"one\"", "without quotes"),
    ("radius = 1", "radius = 1e999", 22, "objects.ball.sphere.radius", "overflowed", "double precision"),
    ("center = [0, 0, 0]", "center = [0, 0]", 21, "objects.ball.sphere.center", "an array of 2", "write `[x, y, z]`"),
    ("center = [0, 0, 0]", "center = [0, 0, 0, 0]",
        21, "objects.ball.sphere.center", "an array of 4", "write `[x, y, z]`"),
    ("center = [0, 0, 0]", "center = 0", 21, "objects.ball.sphere.center", "one number", "write `[x, y, z]`"),
    ("[objects.ball.sphere]", "[objects.ball.spheer]",
        20, "objects.ball.spheer", "unknown key `spheer`", "did you mean `sphere`?"),
    ("[materials.silver.mirror]\nreflectance = 0.9", "[materials.silver]",
        39, "materials.silver", "none", "add `[materials.silver.diffuse]`"),
    ("albedo = 0.8", "albedo = 0.8\n[materials.white.mirror]\nreflectance = 1",
        36, "materials.white", "diffuse and mirror", "keep one"),
    ("albedo = 0.8", "albedo = [0.8, \"red\", 0]",
        37, "materials.white.diffuse.albedo", "string \"red\"", "without quotes"),
    // Values out of range.
    ("unit = 1.0", "unit = 0", 3, "unit", "0", "1 means metres"),
    ("radius = 1", "radius = -1", 22, "objects.ball.sphere.radius", "-1", "correct it"),
    ("radius = 1", "radius = nan", 22, "objects.ball.sphere.radius", "NaN", "correct it"),
    ("radius = 1", "radius = 1e300", 22, "objects.ball.sphere.radius", "1e300", "correct it"),
    ("center = [0, -1.5, 0]", "center = [0, -inf, 0]", 28, "objects.floor.quad.center", "-inf", "correct it"),
    ("ior = 1.5", "ior = 0", 33, "materials.glass.dielectric.ior", "0", "glass has about 1.5"),
    ("ior = 1.5", "ior = \"glas\"", 33, "materials.glass.dielectric.ior", "glas", "glass"),
    ("ior = 1.5", "ior = [1.5, 1.6]", 33, "materials.glass.dielectric.ior", "an array of 2", "write `[x, y, z]`"),
    ("ior = 1.5", "ior = { cauchy = [1.5, nan] }", 33, "materials.glass.dielectric.ior", "NaN", "glass has about 1.5"),
    ("ior = 1.5", "ior = { cauchi = [1.5, 0] }", 33, "materials.glass.dielectric.ior.cauchi", "cauchi", "`cauchy`"),
    ("ior = 1.5", "ior = 50", 33, "materials.glass.dielectric.ior", "50", "glass has about 1.5"),
    ("[0, 0.1, 0]", "[0, -0.1, 0]", 34, "materials.glass.dielectric.absorption", "-0.1", "zero or more"),
    ("albedo = 0.8", "albedo = 1.2", 37, "materials.white.diffuse.albedo", "1.2", "at most the light it gets"),
    ("reflectance = 0.9", "reflectance = [0.9, -0.1, 0]",
        40, "materials.silver.mirror.reflectance", "-0.1", "at most the light it gets"),
    ("[materials.silver.mirror]\nreflectance = 0.9", "[materials.silver.conductor]\neta = 0.1\nk = -1",
        41, "materials.silver.conductor.k", "-1", "gold has about"),
    ("[materials.silver.mirror]\nreflectance = 0.9", "[materials.silver.conductor]\neta = 0.1",
        39, "materials.silver.conductor.k", "none", "add it"),
    ("irradiance = 1", "irradiance = -1", 44, "lights.sun.directional.irradiance", "-1", "zero or more"),
    ("intensity = 20", "intensity = inf", 48, "lights.lamp.point.intensity", "inf", "zero or more"),
    ("[lights.lamp.point]\n", "[lights.lamp.spot]\nouter = 30\n", 46, "lights.lamp.spot.direction", "none", "add it"),
    ("[lights.lamp.point]\n", "[lights.lamp.spot]\ndirection = [0, -1, 0]\n", 46, "lights.lamp.spot.outer", "none", "add it"),
    ("[lights.lamp.point]\n", "[lights.lamp.spot]\ndirection = [0, -1, 0]\nouter = 181\n",
        48, "lights.lamp.spot.outer", "181", "from the axis to the edge"),
    ("[lights.lamp.point]\n", "[lights.lamp.spot]\ndirection = [0, -1, 0]\nouter = 0\n",
        48, "lights.lamp.spot.outer", "0", "from the axis to the edge"),
    ("[lights.lamp.point]\n", "[lights.lamp.spot]\ndirection = [0, -1, 0]\nouter = 20\ninner = 30\n",
        49, "lights.lamp.spot.inner", "30", "from the axis to the edge"),
    ("[lights.lamp.point]\n", "[lights.lamp.spot]\ndirection = [0, 0, 0]\nouter = 20\n",
        47, "lights.lamp.spot.direction", "[0, 0, 0]", "not zero"),
    ("direction = [0, -1, 0]", "direction = [0, 0, 0]",
        43, "lights.sun.directional.direction", "[0, 0, 0]", "not zero"),
    ("irradiance = 1", "irradiance = 1\nangular_diameter = -1",
        45, "lights.sun.directional.angular_diameter", "-1", "the sun has 0.53"),
    ("irradiance = 1", "irradiance = 1\nangular_diameter = 180.1",
        45, "lights.sun.directional.angular_diameter", "180.1", "the sun has 0.53"),
    ("irradiance = 1", "irradiance = 1\nangular_diameter = nan",
        45, "lights.sun.directional.angular_diameter", "NaN", "the sun has 0.53"),
    ("[lights.lamp.point]\nposition = [1, 3, 0]\nintensity = 20", "[lights.lamp.quad]\ncenter = [0, 3, 0]\nu = [0, 0, 0]\nv = [0, 0, 1]\nradiance = 1",
        48, "lights.lamp.quad.u", "0", "correct it"),
    ("[lights.lamp.point]\nposition = [1, 3, 0]\nintensity = 20", "[lights.lamp.quad]\ncenter = [0, 3, 0]\nu = [1, 0, 0]\nv = [1, 0, 0]\nradiance = 1",
        49, "lights.lamp.quad.v", "0.000°", "turn one"),
    ("[lights.lamp.point]\nposition = [1, 3, 0]\nintensity = 20", "[lights.lamp.quad]\ncenter = [0, 3, 0]\nu = [1, 0, 0]\nv = [0, 0, 1]",
        46, "lights.lamp.quad", "neither", "give the radiance"),
    ("[lights.lamp.point]\nposition = [1, 3, 0]\nintensity = 20", "[lights.lamp.quad]\ncenter = [0, 3, 0]\nu = [1, 0, 0]\nv = [0, 0, 1]\nradiance = 1\npower = 1",
        46, "lights.lamp.quad", "both", "give the radiance"),
    ("[lights.lamp.point]\nposition = [1, 3, 0]\nintensity = 20", "[lights.lamp.disk]\ncenter = [0, 3, 0]\nnormal = [0, -1, 0]\nradius = 0\npower = 1",
        49, "lights.lamp.disk.radius", "0", "correct it"),
    ("[lights.lamp.point]\nposition = [1, 3, 0]\nintensity = 20", "[lights.lamp.disk]\ncenter = [0, 3, 0]\nnormal = [0, 0, 0]\nradius = 1\npower = 1",
        48, "lights.lamp.disk.normal", "[0, 0, 0]", "not zero"),
    ("[lights.lamp.point]\nposition = [1, 3, 0]\nintensity = 20", "[lights.lamp.disk]\ncenter = [0, 3, 0]\nnormal = [0, 1, 0]\nradius = 1\nradiance = -2",
        50, "lights.lamp.disk.radiance", "-2", "zero or more"),
    ("[lights.lamp.point]\nposition = [1, 3, 0]\nintensity = 20", "[lights.lamp.disk]\ncenter = [0, 3, 0]\nnormal = [0, 1, 0]\nradius = 1e-6\npower = 100",
        50, "lights.lamp.disk.power", "e13", "zero or more"),
    ("direction = [0, -1, 0]", "direction = [0, nan, 0]",
        43, "lights.sun.directional.direction", "[0, NaN, 0]", "finite vector"),
    ("u = [4, 0, 0]", "u = [0, 0, 0]", 29, "objects.floor.quad.u", "0", "correct it"),
    ("v = [0, 0, -4]", "v = [1, 0, -4]", 30, "objects.floor.quad.v", "75.964°", "turn one"),
    ("fov_y = 40", "fov_y = 180", 15, "cameras.main.pinhole.fov_y", "180", "40 is usual"),
    ("target = [0, 0, 0]", "target = [0, 3, 3]", 13, "cameras.main.pinhole.target", "own position", "move one"),
    ("up = [0, 1, 0]", "up = [0, -3, -3]", 14, "cameras.main.pinhole.up", "one along it", "[0, 0, -1]"),
    // Names and regions that lead nowhere.
    ("paths = \"transmit-2\"", "paths = \"transmit-3\"", 4, "paths", "`transmit-3`", "name the class"),
    ("paths = \"transmit-2\"", "paths = \"all:0\"", 4, "paths", "`all:0`", "name the class"),
    ("material = \"glass\"", "material = \"galss\"", 18, "objects.ball.material", "`galss`", "did you mean `glass`?"),
    ("receiver = \"floor\"", "receiver = \"flor\"", 7, "region.receiver", "`flor`", "did you mean `floor`?"),
    ("receiver = \"floor\"", "receiver = \"ball\"", 7, "region.receiver", "`ball`", "name one"),
    ("material = \"white\"", "material = \"silver\"", 7, "region.receiver", "`floor`", "change the object"),
    ("half = [1, 1]", "half = [1, 5]", 9, "region.half", "1 by 5 m", "smaller"),
    ("half = [1, 1]", "half = [0, 1]", 9, "region.half", "0", "correct it"),
    ("half = [1, 1]", "half = [1, 1]\n[extent]\ncenter = [4, 0]\nhalf = [1, 1]",
        12, "extent.half", "5 by 1 m", "larger"),
];

#[track_caller]
fn judge(error: &SceneError, key: &str, found: &str, remedy: &str) {
    assert_eq!(error.key, key, "{error}");
    assert!(error.found.contains(found), "found: {error}");
    assert!(error.remedy.contains(remedy), "remedy: {error}");
    let message = error.to_string();
    let parts = [error.place.to_string(), error.expected.clone(), error.found.clone(), error.remedy.clone()];
    assert!(parts.iter().all(|part| !part.is_empty() && message.contains(part)), "{message}");
}

#[test]
fn every_fault_names_file_line_key_and_remedy() {
    for (from, to, at, key, found, remedy) in CASES {
        let folder = Folder::new();
        assert!(BASE.contains(from), "{from}");
        let error = folder.load(BASE.replacen(from, to, 1), &[]).expect_err(to);
        judge(&error, key, found, remedy);
        let Place::File { file, line, column } = &*error.place else { panic!("{error}") };
        assert!(file.ends_with("scene.toml") && line == at && *column > 0, "line {at}: {error}");
    }
}

#[test]
fn columns_count_characters() {
    let error = Folder::new().load(BASE.replace("title = \"Test\"", "title = \"Glück\" x"), &[]).unwrap_err();
    assert!(error.to_string().contains("scene.toml:2:17: expected TOML"), "{error}");
}

/// What is written in place of a mesh, then words of found (with the line of the OBJ file) and remedy.
#[rustfmt::skip]
const MESHES: &[(&str, &str, &str)] = &[
    ("", "no vertex at bad.obj", "right file"),
    ("ply\nformat ascii 1.0\n", "no vertex at bad.obj", "right file"),
    ("v 0 0 0\nv 1 0\n", "fewer at bad.obj:2", "repair the line"),
    ("v 0 0 0\nv 1 zero 0\n", "\"zero\" at bad.obj:2", "repair the line"),
    ("v 0 0 0\n\nv 1 nan 0\n", "\"nan\" at bad.obj:3", "repair the line"),
    ("v 0 0 1e300\n", "\"1e300\" at bad.obj:1", "repair the line"),
    ("v 0 0 0\nvn 0 0 0\n", "zero at bad.obj:2", "take the normals out"),
    ("v 0 0 0\nv 1 0 0\nf 1 2\n", "2 at bad.obj:3", "take the face out"),
    ("v 0 0 0\nv 1 0 0\nf 1 2 3\n", "vertex 3 at bad.obj:3", "export it again"),
    ("v 0 0 0\nf 1 1 0\n", "\"0\" at bad.obj:2", "from 1"),
    ("v 0 0 0\nf 1 1 -2\n", "\"-2\" at bad.obj:2", "from -1"),
    ("v 0 0 0\nf 1 1 one\n", "\"one\" at bad.obj:2", "from 1"),
    ("v 0 0 0\nf 1 1 99999999999999999999\n", "\"99999999999999999999\" at bad.obj:2", "from 1"),
    ("v 0 0 0\nf 1//1 1//1 1//9223372036854775807\n", "normal 1 at bad.obj:2", "export it again"),
    ("v 0 0 0\nv 1e20 0 0\nf 1 2 2\n", "1.00000002004087", "scale the mesh in its file"),
];

const MESH: &str = "[objects.ball.mesh]\nfile = \"bad.obj\"\nfit = 1\ncenter = [0, 0, 0]";

fn with_mesh() -> String {
    BASE.replace("[objects.ball.sphere]\ncenter = [0, 0, 0]\nradius = 1", MESH)
}

#[test]
fn every_fault_of_a_mesh_names_scene_mesh_and_line() {
    for (obj, found, remedy) in MESHES {
        let folder = Folder::new();
        folder.write("bad.obj", obj);
        let error = folder.load(with_mesh(), &[]).expect_err(obj);
        judge(&error, "objects.ball.mesh.file", found, remedy);
        assert!(error.to_string().contains("scene.toml:21:8: `objects.ball.mesh.file`"), "{error}");
    }
}

#[test]
fn a_mesh_that_cannot_be_read_is_named() {
    let folder = Folder::new();
    let error = folder.load(with_mesh(), &[]).unwrap_err();
    judge(&error, "objects.ball.mesh.file", "bad.obj: No such file", "relative to the scene file");
    fs::create_dir(folder.write("other.obj", "").with_file_name("folder.obj")).unwrap();
    let error = folder.load(with_mesh().replace("bad.obj", "folder.obj"), &[]).unwrap_err();
    judge(&error, "objects.ball.mesh.file", "folder.obj: a folder", "relative to the scene file");
}

#[test]
fn a_scene_that_cannot_be_read_is_named() {
    judge(&load("glass-spere", &[]).unwrap_err(), "", "no such scene", "did you mean `glass-sphere`?");
    judge(&load("xylophone", &[]).unwrap_err(), "", "no such scene", "choose one of `bending`, ");
    judge(&load("nowhere/none", &[]).unwrap_err(), "", "No such file", "nephroid scenes");
    judge(&load("none.toml", &[]).unwrap_err(), "", "No such file", "nephroid scenes");
    judge(&load("./", &[]).unwrap_err(), "", "a folder", "nephroid scenes");
    judge(&load("/dev/zero", &[]).unwrap_err(), "", "not a regular file", "nephroid scenes");
}

#[test]
fn text_that_is_no_scene_is_named() {
    let folder = Folder::new();
    judge(&folder.load("", &[]).unwrap_err(), "version", "no version", "write `version = 1`");
    let error = folder.load(b"version = 1\ntitle = \"\xff\"\n", &[]).unwrap_err();
    judge(&error, "", "0xff", "UTF-8");
    assert!(error.to_string().contains("scene.toml:2:10:"), "{error}");
    let deep = format!("version = 1\nunit = {}", "[".repeat(100_000));
    judge(&folder.load(deep, &[]).unwrap_err(), "", "recurse", "toml.io");
}

/// Key, value, words of found and remedy of an override that does not fit.
#[rustfmt::skip]
const OVERRIDES: &[(&str, &str, &str, &str)] = &[
    ("materials.glas.dielectric.ior", "1.3", "no such key", "did you mean `materials.glass.dielectric.ior`"),
    ("objects.ball.sphere.radios", "1", "no such key", "`objects.ball.sphere.radius`"),
    ("objects.cube.sphere.radius", "1", "no such key", "`objects.ball.sphere.radius`"),
    ("", "1", "no such key", "choose one of `cameras`"),
    ("title.text", "1", "no such key", "`title`"),
    ("objects.ball.visible_to_camrea", "false", "no such key", "`objects.ball.visible_to_camera`"),
    ("extent.haf", "[3, 3]", "no such key", "`extent.half`"),
    ("extent.half", "[3, 5]", "3 by 5 m", "smaller"),
    ("objects.floor.visible_to_camera", "maybe", "string \"maybe\"", "write true or false"),
    ("cameras.main.pinhole.fov", "30", "no such key", "`cameras.main.pinhole.fov_y`"),
    ("cameras.region.pinhole.fov_y", "30", "reserved name", "choose another name"),
    ("lights.lmap.point.intensity", "1", "no such key", "`lights.lamp.point.intensity`"),
    ("lights.sun.point.position", "[0, 3, 0]", "the kind `point`", "scene.lights.sun={ point = "),
    ("medium.scattering", "1", "reserved key", "media are not built yet"),
    ("medium", "1", "reserved key", "media are not built yet"),
    ("materials.glass.dielectric.ior", "-1", "-1", "glass has about 1.5"),
    ("materials.glass.dielectric.ior", "nan", "NaN", "glass has about 1.5"),
    ("materials.glass.dielectric.ior", "high", "`high`", "`diamond`"),
    ("objects.floor.quad.center", "[0, 1", "unclosed array", "write a number"),
    ("objects.floor.quad.center", "[0, 1]", "an array of 2", "write `[x, y, z]`"),
    ("objects.ball.material", "galss", "`galss`", "did you mean `glass`?"),
    ("materials.glass", "{ glossy = {} }", "unknown key `glossy`", "choose one of"),
    ("paths", "transmit", "`transmit`", "name the class"),
    ("version", "2", "2", "write `version = 1`"),
];

#[test]
fn an_override_that_does_not_fit_is_named_as_it_was_typed() {
    for (key, value, found, remedy) in OVERRIDES {
        let error = Folder::new().load(BASE, &[("unit", "1"), (key, value)]).expect_err(key);
        assert!(error.found.contains(found) && error.remedy.contains(remedy), "{error}");
        let message = error.to_string();
        assert!(message.starts_with(&format!("--set scene.{key}={value} (in ")), "{message}");
    }
}

/// The override is sound; what it breaks is in the file, and named where it stands.
#[test]
fn what_an_override_breaks_is_named_where_it_stands() {
    let error = Folder::new().load(BASE, &[("objects.floor.quad.u", "[0.5, 0, 0]")]).unwrap_err();
    judge(&error, "region.half", "reaches to 1 by 1 m", "smaller");
    assert!(error.to_string().contains("scene.toml:9:8:"), "{error}");
}

#[test]
fn no_truncation_or_lost_line_panics() {
    let folder = Folder::new();
    let lines: Vec<&str> = BASE.lines().collect();
    let refused = (0..BASE.len()).filter(|&end| folder.load(&BASE[..end], &[]).is_err()).count();
    assert!(refused > BASE.len() / 2, "{refused}");
    for lost in 0..lines.len() {
        let rest: Vec<&str> = lines.iter().enumerate().filter(|(i, _)| *i != lost).map(|(_, line)| *line).collect();
        let _ = folder.load(rest.join("\n"), &[]);
    }
}

/// Whatever stands in place of a value: it is refused, or the scene holds finite numbers only.
#[test]
fn any_value_anywhere_is_refused_or_finite() {
    const VALUES: [&str; 16] = [
        "nan",
        "inf",
        "-inf",
        "0",
        "-0.0",
        "-1",
        "1e308",
        "-1e308",
        "1e-308",
        "9223372036854775807",
        "true",
        "\"x\"",
        "[]",
        "[1e308, 1e308, 1e308]",
        "{}",
        "1979-05-27",
    ];
    let folder = Folder::new();
    let mut loaded = 0;
    for line in BASE.lines().filter(|line| line.contains(" = ")) {
        let (key, _) = line.split_once(" = ").unwrap();
        for value in VALUES {
            if let Ok(scene) = folder.load(BASE.replacen(line, &format!("{key} = {value}"), 1), &[]) {
                loaded += 1;
                let text = format!("{:?}", (scene.region, scene.extent, scene.cameras, scene.objects, scene.lights));
                assert!(!text.contains("NaN") && !text.contains("inf"), "{key} = {value}: {text}");
            }
        }
    }
    assert!(loaded > 0);
}
