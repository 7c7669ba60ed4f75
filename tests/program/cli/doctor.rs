//! `nephroid doctor`: whatever is missing is a row with its remedy, never a panic.

use std::{ffi::OsStr, fs, path::Path};

use serde_json::Value;

use super::{Ran, nephroid, program};

const NO_DEVICE: i32 = 4;
const NOWHERE: &str = "/nonexistent";

/// The doctor as JSON in a changed environment, and its exit code.
fn doctor<V: AsRef<OsStr>>(variables: &[(&str, V)]) -> (Value, Ran) {
    let mut command = program();
    command.args(["doctor", "--format", "json"]);
    command.envs(variables.iter().map(|(name, value)| (name, value)));
    let ran = Ran::from(command.output().expect("the program starts"));
    (ran.json(), ran)
}

/// The row of that name, which has this verdict.
#[track_caller]
fn row<'r>(report: &'r Value, what: &str, verdict: &str) -> &'r Value {
    let rows = report["checks"].as_array().expect("rows");
    let row = rows.iter().find(|row| row["what"] == what).unwrap_or_else(|| panic!("no row {what}: {report:#}"));
    assert_eq!(row["verdict"], verdict, "{row}");
    assert!(verdict == "ok" || row["remedy"].as_str().is_some_and(|text| !text.is_empty()), "no remedy: {row}");
    row
}

#[test]
fn where_a_device_runs_a_method_all_is_said_in_every_format() {
    for (format, wanted) in
        [("table", "verdict"), ("json", "nephroid.doctor/1"), ("csv", "verdict,what,"), ("md", "|--")]
    {
        let ran = nephroid(&format!("doctor --format {format}")).ok();
        for words in [wanted, "Vulkan loader", "device 0: method maps", "shader compiler", "store", "models"] {
            assert!(ran.out.contains(words), "{format} lacks {words:?}: {}", ran.out);
        }
    }
    let (report, ran) = doctor::<&str>(&[]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert_eq!([&report["has_device"], &report["has_compiler"]], [true, true]);
    let devices = nephroid("devices --format json").ok().json();
    let name = devices["devices"][0]["name"].as_str().unwrap();
    let rows = report["checks"].as_array().unwrap();
    assert!(rows.iter().any(|row| row["found"].as_str().unwrap().starts_with(name)), "{report:#}");
    assert!(row(&report, "shader compiler", "ok")["found"].as_str().unwrap().contains("SPIR-V 1."));
}

#[test]
fn without_a_driver_it_says_so_and_which_variable_hides_it() {
    let (report, ran) = doctor(&[("VK_DRIVER_FILES", NOWHERE), ("VK_ICD_FILENAMES", NOWHERE)]);
    assert_eq!(ran.code, Some(NO_DEVICE), "{}", ran.err);
    assert!(ran.err.contains("no device can run any method"), "{}", ran.err);
    let remedy = row(&report, "devices", "fail")["remedy"].as_str().unwrap();
    assert!(
        remedy.contains("unset VK_DRIVER_FILES, VK_ICD_FILENAMES") && remedy.contains("mesa-vulkan-drivers"),
        "{remedy}"
    );
    assert!(row(&report, "VK_DRIVER_FILES", "warn")["found"].as_str().unwrap().contains("nothing is at"));
    row(&report, "Vulkan loader", "ok");
    row(&report, "shader compiler", "ok");
}

/// A file of the loader's name that is no library stands in for one that is not installed.
#[cfg(target_os = "linux")]
#[test]
fn without_a_loader_it_says_what_to_install() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("libvulkan.so.1"), "").unwrap();
    let (report, ran) = doctor(&[("LD_LIBRARY_PATH", folder.path())]);
    assert_eq!(ran.code, Some(NO_DEVICE), "{}", ran.err);
    for what in ["Vulkan loader", "devices"] {
        assert!(row(&report, what, "fail")["remedy"].as_str().unwrap().contains("libvulkan1"));
    }
    row(&report, "shader compiler", "ok");
}

#[test]
fn without_layers_rendering_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let (report, ran) = doctor(&[("VK_LAYER_PATH", folder.path())]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let validation = row(&report, "validation layer", "warn");
    assert!(validation["remedy"].as_str().unwrap().contains("vulkan-validationlayers"), "{validation}");
}

#[test]
fn a_layer_that_cannot_be_loaded_is_found_out() {
    let folder = tempfile::tempdir().unwrap();
    let layer = r#"{"name": "VK_LAYER_KHRONOS_validation", "type": "GLOBAL", "library_path": "./gone.so",
        "api_version": "1.3.200", "implementation_version": "1", "description": "broken"}"#;
    let manifest = format!(r#"{{"file_format_version": "1.1.0", "layer": {layer}}}"#);
    fs::write(folder.path().join("broken.json"), manifest).unwrap();
    let (report, ran) = doctor(&[("VK_LAYER_PATH", folder.path())]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let validation = row(&report, "validation layer", "warn");
    assert!(validation["found"].as_str().unwrap().contains("cannot be loaded"), "{validation}");
}

#[test]
fn the_folders_are_said_with_what_is_in_them() {
    let folder = tempfile::tempdir().unwrap();
    let cache = folder.path().join("cache");
    let key = "0123456789abcdef".repeat(4);
    fs::create_dir_all(cache.join("spirv")).unwrap();
    fs::write(cache.join("spirv").join(key), vec![0; 2048]).unwrap();
    fs::write(folder.path().join("thing.obj"), "").unwrap();
    let (report, _) = doctor(&[("NEPHROID_CACHE", cache.as_path()), ("NEPHROID_MODELS", folder.path())]);
    assert_eq!(row(&report, "store: spirv", "ok")["found"], "1 entries, 2.0 KiB");
    assert!(row(&report, "models", "ok")["found"].as_str().unwrap().ends_with(": thing"));
    let (report, _) = doctor(&[("NEPHROID_MODELS", cache.as_path())]);
    assert!(row(&report, "models", "ok")["remedy"].as_str().unwrap().contains("scripts/fetch-models"));
}

#[test]
fn a_store_that_cannot_be_written_to_is_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let below: &Path = &file.join("below");
    let (report, ran) = doctor(&[("NEPHROID_CACHE", below), ("XDG_CACHE_HOME", below), ("HOME", below)]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert!(row(&report, "store", "warn")["remedy"].as_str().unwrap().contains("NEPHROID_CACHE"));
    let (report, _) = doctor(&[("NEPHROID_CACHE", below), ("XDG_CACHE_HOME", folder.path())]);
    assert!(row(&report, "store", "warn")["found"].as_str().unwrap().contains("cannot be written to"));
}
