//! What has no size or no direction is refused where it stands, before any light is traced.

use super::*;

/// Refused with the key and these words.
#[track_caller]
fn refused(changed: &[(&str, &str)], key: &str) {
    let owned: Vec<_> = changed.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    let error = Scene::load("glass-sphere", &owned).map(|_| ()).expect_err(key).to_string();
    assert!(error.contains(key), "{key}: {error}");
}

#[track_caller]
fn refused_text(shape: &str, key: &str) {
    let folder = tempfile::tempdir().unwrap();
    let sphere = "[objects.ball.sphere]\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0\n";
    let text = rewritten("glass-sphere", &[(sphere, &format!("{shape}\n"))], "");
    std::fs::write(folder.path().join("s.toml"), text).unwrap();
    std::fs::write(folder.path().join("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let path = folder.path().join("s.toml");
    let error = Scene::load(path.to_str().unwrap(), &[]).map(|_| ()).expect_err(shape).to_string();
    assert!(error.contains(key), "{shape}: {error}");
}

#[test]
fn shapes_of_no_size_are_refused() {
    refused(&[("objects.ball.sphere.radius", "0.0")], "radius");
    refused(&[("objects.ball.sphere.radius", "-0.0")], "radius");
    refused(&[("objects.ball.sphere.radius", "1e-320")], "radius");
    refused(&[("objects.floor.quad.u", "[0, 0, 0]")], "objects.floor.quad");
    refused_text("box = { center = [0, 0, 0], half = [1, 0, 1] }", "half");
    refused_text("mesh = { file = \"m.obj\", fit = 0.0, center = [0, 0, 0] }", "fit");
    refused_text("disk = { center = [0, 0, 0], normal = [0, 1, 0], radius = 0.0 }", "radius");
}

#[test]
fn vectors_of_no_length_are_refused() {
    refused(&[("lights.sun.direction", "[0, 0, 0]")], "direction");
    refused(&[("cameras.main.pinhole.target", "[0.0, 4.5, 5.5]")], "target");
    refused(&[("cameras.main.pinhole.up", "[0, 0, 0]")], "up");
    refused_text("disk = { center = [0, 0, 0], normal = [0, 0, 0], radius = 1.0 }", "normal");
}

#[test]
fn a_unit_of_nothing_is_refused() {
    for unit in ["0.0", "-1.0", "nan", "inf", "1e-300", "1e300"] {
        refused(&[("unit", unit)], "unit");
    }
}

#[test]
fn an_index_of_nothing_is_refused() {
    for index in ["0.0", "-1.5", "nan", "1e300"] {
        refused(&[("materials.glass.ior", index)], "ior");
    }
}
