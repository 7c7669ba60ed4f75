//! `nephroid scenes`: what ships, what is in one, and its text.

use super::{gltf, nephroid, program};

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
    let cameras: Vec<_> = super::column(&scene["cameras"], "name");
    assert_eq!(cameras, ["main", "region"]);
}

#[test]
fn a_sky_is_told_where_there_is_one() {
    let of = |format: &str| nephroid(&format!("scenes sea --format {format}")).ok();
    for format in ["table", "csv", "md"] {
        let out = of(format).out;
        assert!(out.contains("gradient") && out.contains("zenith [0.02, 0.05, 0.13], horizon"), "{out}");
    }
    let sky = &of("json").json()["sky"];
    assert_eq!([&sky["kind"], &sky["up"][1]], [&serde_json::json!("gradient"), &serde_json::json!(1.0)]);
    assert_eq!(sky["zenith"], serde_json::json!([0.02, 0.05, 0.13]));
    assert!(nephroid("scenes null --format json").ok().json()["sky"].is_null());
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

/// A cube without its lid.
const OPEN_CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 -1 1\nv -1 -1 1\nv -1 1 -1\nv 1 1 -1\nv 1 1 1\nv -1 1 1\n\
                         f 1 2 3 4\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

#[test]
fn an_open_mesh_of_glass_is_warned_of_with_the_place_of_its_hole() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("open.toml");
    let text = nephroid("scenes bunny --source").ok().out.replace("bunny-lo.obj", "cube.obj");
    std::fs::write(folder.path().join("cube.obj"), OPEN_CUBE).unwrap();
    std::fs::write(&file, &text).unwrap();
    // 1.5 m a side on the floor: the missing lid is at that height.
    let words =
        "`bunny` (cube.obj) is a dielectric with 1 hole, the largest 6.0000 m round about [0.0000, 1.5000, 0.0000] m";
    let described = nephroid(&format!("scenes {} --format json", file.display())).ok();
    assert!(described.err.contains(&format!("warning: {words}")), "{}", described.err);
    assert!(described.json()["warnings"][0].as_str().unwrap().starts_with(words));
    let out = folder.path().join("out");
    let rendered = nephroid(&format!("render {} {} --out {}", file.display(), super::SMALL, out.display())).ok();
    assert!(rendered.err.contains(words), "{}", rendered.err);
    let result: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("result.json")).unwrap()).expect("JSON");
    assert!(result["warnings"][0].as_str().unwrap().starts_with(words), "{}", result["warnings"]);
    // A mirror bounds no medium, and may be open.
    std::fs::write(
        &file,
        text.replace(
            "[materials.glass.dielectric]\nior = 1.5\nabsorption = 0.0",
            "[materials.glass.mirror]\nreflectance = 1",
        ),
    )
    .unwrap();
    assert_eq!(nephroid(&format!("scenes {}", file.display())).ok().err, "");
}

/// What an import brought has a table of its own, and its things stand in the others.
#[test]
fn an_import_is_told_of() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("room.glb"), gltf::small().glb()).unwrap();
    let scene = folder.path().join("scene.toml");
    let text = nephroid::scene::Scene::load("diffuse", &[]).unwrap().source.text;
    std::fs::write(&scene, format!("{text}\n[imports.room]\nfile = \"room.glb\"\nscale = 0.5\n")).unwrap();
    let told = nephroid(&format!("scenes {}", scene.display())).ok();
    for words in ["room/Stone", "room/Glass", "room/Lamp", "room/Eye", " import   file       m a unit   objects"] {
        assert!(told.out.contains(words), "{words}: {}", told.out);
    }
    let json = nephroid(&format!("scenes {} --format json", scene.display())).ok().json();
    assert_eq!(
        json["imports"],
        serde_json::json!([{
            "name": "room", "file": "room.glb", "scale": 0.5, "objects": 1, "triangles": 4, "materials": 1, "lights": 1,
            "cameras": 1
        }])
    );
    let plan = format!("plan {} --camera", scene.display());
    nephroid(&format!("{plan} room/Eye")).ok();
    let missing = nephroid(&format!("{plan} room/Eys"));
    assert!(missing.code == Some(2) && missing.err.contains("did you mean `room/Eye`?"), "{}", missing.err);
}
