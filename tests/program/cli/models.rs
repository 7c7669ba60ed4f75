//! `model:NAME` in a scene: found in the models folder, hashed, and where it is not there, said where it was looked for.

use std::{fs, path::Path};

use super::{Ran, nephroid, program};

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

/// Runs with a models folder.
fn with_models(folder: &Path, arguments: &str) -> Ran {
    let mut command = program();
    command.args(arguments.split_whitespace()).env("NEPHROID_MODELS", folder);
    command.output().expect("the program starts").into()
}

/// A folder with a scene that names `model:NAME`, and the scene's path.
fn scene_with(name: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml");
    let text = nephroid("scenes bunny --source").ok().out.replace("bunny-lo.obj", &format!("model:{name}"));
    fs::write(&file, text).unwrap();
    (folder, file.display().to_string())
}

#[test]
fn a_model_is_found_and_its_bytes_are_in_the_hash() {
    let (folder, scene) = scene_with("simple");
    let hash = |text: &str| {
        fs::write(folder.path().join("simple.obj"), text).unwrap();
        let scene = with_models(folder.path(), &format!("scenes {scene} --format json")).ok().json();
        assert_eq!(
            [&scene["objects"][0]["file"], &scene["objects"][0]["triangles"]],
            [&"model:simple".into(), &serde_json::json!(4)]
        );
        scene["hash"].as_str().unwrap().to_owned()
    };
    let first = hash(TETRAHEDRON);
    assert_ne!(first, hash(&format!("{TETRAHEDRON}# changed\n")));
    assert_eq!(first, hash(TETRAHEDRON));
}

#[test]
fn one_that_is_missing_is_answered_with_the_folder_and_what_is_near() {
    let (folder, scene) = scene_with("bunn");
    let plan = |models: &Path| with_models(models, &format!("plan {scene}"));
    let ran = plan(&folder.path().join("nowhere"));
    assert_eq!(ran.code, Some(1), "{}", ran.err);
    for words in
        ["mine.toml:", "objects.bunny.mesh.file", "nowhere", "bunn.obj", "none to choose", "scripts/fetch-models"]
    {
        assert!(ran.err.contains(words), "the message lacks {words:?}: {}", ran.err);
    }
    fs::write(folder.path().join("bunny.obj"), TETRAHEDRON).unwrap();
    fs::write(folder.path().join("teapot.obj"), TETRAHEDRON).unwrap();
    let ran = plan(folder.path());
    assert!(ran.err.contains("did you mean `bunny`?") && !ran.err.contains("teapot"), "{}", ran.err);
    let ran = with_models(folder.path(), "plan bunny --set scene.objects.bunny.file=model:xylophone");
    assert_eq!(ran.code, Some(2), "{}", ran.err);
    assert!(ran.err.contains("choose one of `bunny`, `teapot`"), "{}", ran.err);
}

#[test]
fn a_name_does_not_lead_out_of_the_folder() {
    let (folder, _) = scene_with("x");
    fs::write(folder.path().join("outside.obj"), TETRAHEDRON).unwrap();
    let models = folder.path().join("models");
    fs::create_dir(&models).unwrap();
    for name in ["../outside", "", ".hidden"] {
        let ran = with_models(&models, &format!("plan bunny --set scene.objects.bunny.file=model:{name}"));
        assert!(ran.code == Some(2) && ran.err.contains("no plain name"), "{name}: {}", ran.err);
    }
}

#[test]
fn without_any_folder_the_variable_is_named() {
    let mut command = program();
    command.args(["plan", "bunny", "--set", "scene.objects.bunny.file=model:bunny"]);
    for name in ["NEPHROID_MODELS", "XDG_DATA_HOME", "HOME"] {
        command.env_remove(name);
    }
    let ran = Ran::from(command.output().unwrap());
    assert!(ran.code == Some(2) && ran.err.contains("no models folder; set NEPHROID_MODELS"), "{}", ran.err);
}

/// The script and the program each read the environment: they must come to one folder.
#[cfg(unix)]
#[test]
fn the_script_that_fills_the_folder_means_the_same_one() {
    const NAMES: [&str; 3] = ["NEPHROID_MODELS", "XDG_DATA_HOME", "HOME"];
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/fetch-models");
    for (folders, at) in [
        (["/a", "/b", "/c"], "/a"),
        (["", "/b", "/c"], "/b/nephroid/models"),
        (["", "b", "/c"], "/c/.local/share/nephroid/models"),
        (["", "", "/c"], "/c/.local/share/nephroid/models"),
    ] {
        let environment = || NAMES.into_iter().zip(folders);
        let list =
            std::process::Command::new(&script).arg("--list").envs(environment()).output().expect("bash is there");
        let list = String::from_utf8(list.stdout).unwrap();
        assert!(list.starts_with(&format!("models folder: {at}\n")) && list.contains("dragon"), "{list}");
        let mut command = program();
        command.args(["plan", "bunny", "--set", "scene.objects.bunny.file=model:none"]).envs(environment());
        let ran = Ran::from(command.output().unwrap());
        assert!(ran.err.contains(&format!("a model in {at},")), "{}", ran.err);
    }
}
