//! `nephroid scenes`: what ships, what is in one, and its text.

use crate::{nephroid, program};

#[test]
fn as_csv_they_begin_with_their_names() {
    let rows = nephroid("scenes --format csv").ok().rows();
    assert_eq!(rows[0], ["name", "title"]);
    let names: Vec<_> = rows[1..].iter().map(|row| row[0].as_str()).collect();
    for name in ["bunny", "diffuse", "flat-water", "glass-sphere", "null"] {
        assert!(names.contains(&name), "{names:?}");
    }
    assert!(rows[1..].iter().all(|row| !row[1].is_empty()), "a scene without a title");
}

#[test]
fn one_is_described_in_every_format() {
    for (format, wanted) in [
        ("table", "region 3.56 x 2.53 m on floor, E0 0."),
        ("json", "\"schema\": \"nephroid.scene/1\""),
        ("csv", "objects,,"),
        ("md", "| bunny"),
    ] {
        let ran = nephroid(&format!("scenes bunny --format {format}")).ok();
        for words in [wanted, "bunny-lo.obj", "3674", "transmit-2"] {
            assert!(ran.out.contains(words), "{format} lacks {words:?}: {}", ran.out);
        }
    }
}

#[test]
fn a_description_holds_what_is_in_the_file() {
    let scene = nephroid("scenes glass-sphere --format json").ok().json();
    let source = nephroid::scene::Scene::load("glass-sphere", &[]).unwrap().source;
    assert_eq!(scene["hash"], source.hash);
    assert_eq!([&scene["class"], &scene["region"]["receiver"]], ["transmit-2", "floor"]);
    assert_eq!([&scene["e0_w_m2"], &scene["region"]["size_m"][0]], [1.0, 3.0]);
    let ball = &scene["objects"][0];
    assert_eq!([&ball["name"], &ball["shape"], &ball["material"]], ["ball", "sphere", "glass"]);
    assert_eq!(ball["triangles"], serde_json::Value::Null);
    assert_eq!(scene["materials"][0]["ior"], serde_json::json!([1.5, 1.5, 1.5]));
    let cameras: Vec<_> = crate::column(&scene["cameras"], "name");
    assert_eq!(cameras, ["main", "region"]);
}

#[test]
fn a_lamp_has_a_power_and_the_sun_has_none() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("lamp.toml");
    let lamp = "\n[lights.lamp.point]\nposition = [0.0, 4.0, 0.0]\nintensity = [1.0, 2.0, 3.0]\n\
                [lights.spot.spot]\nposition = [0.0, 4.0, 0.0]\ndirection = [0.0, -1.0, 0.0]\nintensity = 1.0\nouter = 60.0\n";
    std::fs::write(&file, nephroid("scenes glass-sphere --source").ok().out + lamp).unwrap();
    let scene = nephroid(&format!("scenes {} --format json", file.display())).ok().json();
    let [lamp, spot, sun] = [0, 1, 2].map(|at| &scene["lights"][at]);
    assert!((lamp["power_w"].as_f64().unwrap() - 8.0 * std::f64::consts::PI).abs() < 1e-12, "{lamp}");
    assert!((spot["power_w"].as_f64().unwrap() - std::f64::consts::PI).abs() < 1e-12, "{spot}");
    assert_eq!([&sun["name"].as_str().unwrap(), &sun["kind"].as_str().unwrap()], [&"sun", &"directional"]);
    assert!(sun["power_w"].is_null(), "{sun}");
}

#[test]
fn the_source_can_be_written_and_loaded() {
    let text = nephroid("scenes glass-sphere --source").ok().out;
    assert!(text.contains('#'), "its comments are gone");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml");
    std::fs::write(&file, text).unwrap();
    let plan = nephroid(&format!("plan {} --format json", file.display())).ok().json();
    assert_eq!(plan["scene"], "mine");
}

#[test]
fn one_that_is_not_there_is_answered_with_the_nearest() {
    let ran = nephroid("scenes bunnny");
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("did you mean `bunny`?"), "{}", ran.err);
}

/// Each shell's script names the commands; what reads them is the shell's affair.
#[test]
fn every_shell_has_its_completions() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = nephroid(&format!("completions {shell}")).ok().out;
        for words in ["nephroid", "completions", "devices", "fail-above"] {
            assert!(script.contains(words), "{shell} lacks {words}");
        }
    }
}

/// A script that a shell cannot parse is worse than none.
#[cfg(unix)]
#[test]
fn bash_takes_its_completions() {
    let script = program().args(["completions", "bash"]).output().unwrap().stdout;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("nephroid.bash");
    std::fs::write(&file, script).unwrap();
    let Ok(parsed) = std::process::Command::new("bash").arg("-n").arg(&file).status() else { return };
    assert!(parsed.success());
}
