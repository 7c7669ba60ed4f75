//! A render's files and what they say.

use std::path::Path;

use nephroid::image::Layers;
use serde_json::Value;

use super::{SMALL, column, names, nephroid, place, rendered, rows};

const LAYERS: [&str; 6] = ["radiance", "direct", "caustic", "irradiance.direct", "irradiance.caustic", "mask"];

fn result(out: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(out.join("result.json")).unwrap()).unwrap()
}

fn exr(file: &Path) -> (Layers, nephroid::image::Provenance) {
    Layers::from_exr(&std::fs::read(file).unwrap()).unwrap()
}

/// Reading a number from JSON may miss its last bit (2^-52 relative), here twice in a sum.
const PARSED: f64 = 1e-15;

#[track_caller]
fn assert_same(read: &Value, expected: f64) {
    let read = read.as_f64().unwrap();
    assert!((read - expected).abs() <= PARSED * expected.abs(), "{read} is not {expected}");
}

fn numbers(values: &Value) -> Vec<f64> {
    values.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

#[test]
fn four_files_appear() {
    let (_folder, out, ran) = rendered("glass-sphere --method maps");
    assert_eq!(names(&out), ["image.exr", "image.png", "result.json", "timings.csv"]);
    assert!(ran.err.contains("device: "), "the device is named on stderr: {}", ran.err);
    assert!(ran.out.contains("maps/cells") && ran.out.contains("exposure 0.5 EV"), "{}", ran.out);
}

#[test]
fn the_result_holds_samples_summaries_and_counters() {
    let (_folder, out, _) = rendered("glass-sphere");
    let result = result(&out);
    assert_eq!(result["schema"], "nephroid.render/1");
    assert_eq!([&result["scene"], &result["method"]], ["glass-sphere", "maps"]);
    assert_eq!(result["settings"]["light.side"], 64);
    assert_eq!(result["nonfinite_pixels"], 0);
    for stage in result["stages"].as_array().unwrap() {
        let samples = numbers(&stage["samples_ms"]);
        assert_eq!(samples.len(), 2);
        assert_same(&stage["median_ms"], nephroid::stats::median(&samples));
        // Of two samples the deviations are equal: half their distance, which loses what the samples lost.
        let mad = nephroid::stats::mad(&samples);
        assert!((stage["mad_ms"].as_f64().unwrap() - mad).abs() <= PARSED * samples[0].max(samples[1]), "{stage}");
        assert!(stage["counters"]["bytes"].as_u64().unwrap() > 0);
    }
    let stage = |path: &str| result["stages"].as_array().unwrap().iter().find(|s| s["path"] == path).unwrap().clone();
    assert_eq!(stage("light/photons")["counters"]["invocations"], 64 * 64);
    assert_eq!(column(&result["prepare"], "path"), ["prepare/plan", "prepare/program", "prepare/passes"]);
    for key in ["sum_ms", "span_ms", "wall_ms", "unaccounted_ms", "record_ms"] {
        let samples = numbers(&result["frames"][key]);
        assert_same(&result[key], nephroid::stats::median(&samples));
    }
    assert!(result["startup_ms"].as_f64().unwrap() > 0.0);
}

#[test]
fn every_photon_and_every_watt_is_in_a_bucket() {
    // Sums of float32 work groups in float64: 64 additions of 24 bits each lose less than this.
    const FLUX: f64 = 1e-5;
    for scene in ["glass-sphere", "bunny", "flat-water"] {
        let (_folder, out, _) = rendered(scene);
        let result = result(&out);
        let (photons, energy) = (&result["photons"], &result["energy"]);
        let counted: u64 = nephroid::passes::account::BUCKETS[1..].iter().map(|b| photons[*b].as_u64().unwrap()).sum();
        assert_eq!(photons["emitted"].as_u64().unwrap(), counted, "{scene}: {photons}");
        assert!(photons["valid"].as_u64().unwrap() > 0 && photons["bent"].is_u64(), "{scene}: {photons}");
        let flux = energy["flux_w"].as_object().unwrap();
        let summed: f64 = flux.iter().filter(|(name, _)| *name != "emitted").map(|(_, w)| w.as_f64().unwrap()).sum();
        let emitted = energy["emitted_w"].as_f64().unwrap();
        assert!((summed / emitted - 1.0).abs() < FLUX, "{scene}: {summed} of {emitted} W");
        let arrived = &energy["counted"]["arrived_w"]; // by cells
        let ratio = energy["deposited_w"].as_f64().unwrap() / arrived.as_f64().unwrap();
        assert_same(&energy["ratio"], ratio);
    }
}

#[test]
fn without_photons_the_ratio_is_null() {
    let (_folder, out, ran) = rendered("diffuse");
    let nothing = result(&out);
    assert!(nothing["energy"]["ratio"].is_null());
    assert_eq!(nothing["energy"]["deposited_w"], 0.0);
    assert_eq!(nothing["photons"]["emitted"], 0);
    assert!(ran.out.contains("no photon is valid"), "{}", ran.out);
}

#[test]
fn of_who_shoots_no_photons_none_are_told() {
    let (_folder, out, ran) = rendered("glass-sphere --method none");
    let result = result(&out);
    assert!(result["energy"].is_null() && result["photons"].is_null());
    assert!(!ran.out.contains("emitted") && !ran.out.contains("photon"), "{}", ran.out);
}

#[test]
fn light_that_misses_the_map_is_said_with_the_remedy() {
    const SAID: &str = "falls outside the caustic map";
    let turned = "--set scene.objects.floor.v=[0,0,8] --set maps.receivers=quads"; // its back has no layer then
    for aside in ["--set scene.lights.sun.direction=[2,-1,0]", turned] {
        let (_folder, out, ran) = rendered(&format!("glass-sphere {aside}"));
        assert!(ran.err.contains(SAID) && ran.err.contains("scene.extent.half"), "{aside}: {}", ran.err);
        assert!(ran.out.contains(SAID) && ran.out.contains("u × v"), "{aside}: {}", ran.out);
        assert_eq!(result(&out)["warnings"].as_array().unwrap().len(), 1, "{aside}");
    }
    for inside in ["glass-sphere", "diffuse", "glass-sphere --set scene.extent.half=[6,6]"] {
        let (_folder, out, ran) = rendered(inside);
        assert!(!ran.err.contains(SAID) && !ran.out.contains(SAID), "{inside}: {}", ran.err);
        assert_eq!(result(&out)["warnings"].as_array().unwrap().len(), 0, "{inside}");
    }
}

#[test]
fn light_without_a_layer_is_said_with_the_remedy() {
    const SAID: &str = "has no layer in the photon buffer";
    let of = |layers: &str| rendered(&format!("glass-sphere --set light.paths=all:8 --set light.layers={layers}"));
    let (_folder, out, ran) = of("1");
    assert!(ran.err.contains(SAID) && ran.err.contains("raise light.layers"), "{}", ran.err);
    assert!(ran.out.contains(SAID), "{}", ran.out);
    let said = result(&out)["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains(SAID));
    assert!(said && result(&out)["energy"]["flux_w"]["no_layer"].as_f64().unwrap() > 0.0);
    let (_folder, out, ran) = of("4");
    assert!(!ran.err.contains(SAID), "{}", ran.err);
    assert_eq!(result(&out)["energy"]["flux_w"]["no_layer"], 0.0);
}

/// Photons of evenly lit water lie 4 texels apart, and splats are 3 wide: darkness is left between them until they touch.
#[test]
fn photons_too_few_for_their_splats_are_said_with_the_remedy() {
    const SAID: &str = "leave dark gaps";
    // Photons that just touch leave ripples; measured 0.48 to 0.62.
    const EVEN: f32 = 0.4;
    // The darkest pixel over the mean.
    let of = |set: &str| {
        let (_folder, out) = place();
        let small = "--camera region --size 128x128 --set eye.samples=1 --warmup 0 --repeat 1";
        let ran = nephroid(&format!("render flat-water --method maps {small} {set} --out {}", out.display())).ok();
        let (layers, _) = exr(&out.join("image.exr"));
        let values: Vec<f32> = layers.get("irradiance.caustic").unwrap().pixels().map(|pixel| pixel[0]).collect();
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        (ran.err, values.into_iter().fold(f32::INFINITY, f32::min) / mean)
    };
    let few = "--set light.side=64 --set maps.side=128";
    let (said, darkest) = of(few);
    let remedies = ["raise light.side to 121", "raise maps.splat_size to 6", "lower maps.side to 67"];
    assert!(said.contains(SAID) && remedies.iter().all(|remedy| said.contains(remedy)), "{said}");
    assert_eq!(darkest, 0.0);
    let ways = ["light.side=121", "maps.splat_size=6", "maps.side=67", "maps.gather=varying-single"];
    for way in ways {
        let (said, darkest) = of(&format!("{few} --set {way}"));
        println!("{way}: {darkest}");
        assert!(!said.contains(SAID) && darkest >= EVEN, "{way}: {darkest} of the mean, {said}");
    }
}

#[test]
fn layers_and_provenance_are_in_the_pictures() {
    let (_folder, out, _) = rendered("null --seed 7 --set scene.exposure=1.5");
    let (layers, provenance) = exr(&out.join("image.exr"));
    assert_eq!([layers.width(), layers.height()], [48, 32]);
    assert_eq!(layers.iter().next().unwrap().name(), "radiance");
    assert!(LAYERS.iter().all(|name| layers.get(name).is_some()));
    assert_eq!(layers.iter().count(), LAYERS.len());
    for key in ["version", "commit", "dirty", "rustc", "cpu", "os", "seed", "camera", "arguments", "scene.hash"] {
        assert!(provenance.contains_key(key), "{key} is missing: {:?}", provenance.keys());
    }
    for key in ["name", "uuid", "driver", "api", "timestamp_period_ns"] {
        assert!(provenance.contains_key(&format!("device.{key}")), "device.{key} is missing");
    }
    assert_eq!(provenance["seed"], "7");
    assert_eq!(provenance["scene.overrides"], "[\"exposure=1.5\"]");
    assert_eq!(provenance["settings.eye.exposure"], "1.5");
    assert!(provenance["scene.resolved"].contains("exposure = 1.5"));
    assert!(!provenance["arguments"].contains("out"), "the output's place is no provenance");
    let result = result(&out);
    assert_eq!(result["provenance"]["scene"]["hash"].as_str().unwrap(), provenance["scene.hash"]);
    assert!(result["run"]["started"].as_str().unwrap().ends_with('Z'));
    let png = std::fs::read(out.join("image.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG") && png.windows(10).any(|w| w == b"scene.hash"), "provenance in the PNG");
}

#[test]
fn every_format_reports_the_render_and_a_software_device_as_such() {
    let software = nephroid("devices --format json").ok().json()["devices"][0]["kind"] == "software";
    for format in ["table", "md", "csv", "json"] {
        let (_folder, out, ran) = rendered(&format!("null --format {format}"));
        assert!(ran.out.contains("maps/cells"), "{format}: {}", ran.out);
        let said = ran.out.contains("software device") || ran.out.contains(",software\n");
        match format {
            "json" => assert_eq!(ran.json(), result(&out)),
            "csv" => assert_eq!(ran.out.as_bytes(), std::fs::read(out.join("timings.csv")).unwrap()),
            _ => assert!(ran.out.contains("frame/span"), "{format}: {}", ran.out),
        }
        assert!(said == software || format == "json", "{format}: {}", ran.out);
        assert_eq!(result(&out)["device"]["software"], software);
    }
}

#[test]
fn timings_hold_every_sample() {
    let (_folder, out, _) = rendered("glass-sphere");
    let rows = rows(&std::fs::read(out.join("timings.csv")).unwrap());
    assert_eq!(rows[0], ["stage", "frame", "ms", "device", "device_kind"]);
    for stage in column(&result(&out)["stages"], "path").into_iter().chain(["frame/span", "frame/sum"]) {
        let frames: Vec<_> = rows.iter().filter(|r| r[0] == stage).map(|r| r[1].as_str()).collect();
        assert_eq!(frames, ["0", "1"], "{stage}");
    }
    assert!(rows[1..].iter().all(|r| r[2].parse::<f64>().is_ok_and(|ms| ms.is_finite())));
}

#[test]
fn a_dump_is_what_the_plan_names() {
    let (_folder, out, _) =
        rendered("glass-sphere --set scene.materials.glass.ior=1.33 --dump maps/map,light/photons.hit,light/views");
    let (map, provenance) = exr(&out.join("maps.map.exr"));
    let layer = map.iter().next().unwrap();
    assert_eq!((layer.name(), layer.channels(), map.width()), ("maps/map", 4, 64));
    let deposited = layer.pixels().flat_map(|p| &p[..3]).map(|&v| f64::from(v)).sum::<f64>() / 3.0;
    // The same sum of the same texels.
    assert_same(&result(&out)["energy"]["deposited_w"], deposited);
    assert!(provenance["scene.resolved"].contains("1.33"));
    assert!(out.join("light.photons.hit.exr").is_file());
    let views = std::fs::read(out.join("light.views.npy")).unwrap();
    assert!(views.starts_with(b"\x93NUMPY") && views.windows(3).any(|w| w == b"<u4"));
}

#[test]
fn everything_in_a_plan_can_be_dumped_and_validation_is_silent() {
    let scene = "glass-sphere --set eye.samples=2";
    let plan = nephroid(&format!("plan {scene} --format json")).ok().json();
    let all = column(&plan["resources"], "name").join(",");
    let (_folder, out, ran) = rendered(&format!("{scene} --validation --dump {all}"));
    assert_eq!(names(&out).len(), 4 + column(&plan["resources"], "name").len());
    assert!(!ran.err.contains("validation"), "{}", ran.err);
}

#[test]
fn an_image_of_several_layers_is_dumped_as_several_files() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("two.toml");
    let second = "\n[lights.lamp.directional]\ndirection = [0.2, -1.0, 0.0]\nirradiance = 0.5\n";
    std::fs::write(&scene, nephroid("scenes glass-sphere --source").ok().out + second).unwrap();
    let (_folder, out, _) = rendered(&format!("{} --set light.view=shared --dump maps/map", scene.display()));
    assert!(names(&out).starts_with(&["image.exr".into(), "image.png".into(), "maps.map.0.exr".into()]));
    assert!(out.join("maps.map.1.exr").is_file());
}

#[test]
fn cameras_sizes_and_samples_are_taken() {
    for (options, size, samples) in [
        ("--camera region --size 1x1", [1, 1], 8),
        ("--camera region --size 1x400 --set eye.samples=0", [1, 400], 3),
        ("--camera region --size 2x2 --set eye.samples=1", [2, 2], 1),
        ("--size 2x2", [2, 2], 1),
        ("--size 3x200 --set eye.samples=3", [3, 200], 3),
    ] {
        let (_folder, out) = place();
        nephroid(&format!("render glass-sphere {SMALL_LIGHT} {options} --out {}", out.display())).ok();
        let (layers, about) = exr(&out.join("image.exr"));
        assert_eq!([layers.width(), layers.height()], size);
        let result = result(&out);
        assert_eq!(result["nonfinite_pixels"], 0);
        // Never "as the camera needs": what that came to.
        assert_eq!(
            [&result["settings"]["eye.samples"], &result["provenance"]["settings"]["eye.samples"]],
            [samples; 2]
        );
        assert_eq!(about["settings.eye.samples"], samples.to_string());
        let plan = nephroid(&format!("plan glass-sphere {options} --format json")).ok().json();
        assert_eq!(plan["settings"]["eye.samples"], samples);
        let (words, table) =
            (format!("{samples}x{samples} samples"), nephroid(&format!("plan glass-sphere {options}")));
        assert!(table.out.contains(&words), "{}", table.out);
    }
}

const SMALL_LIGHT: &str = "--set light.side=32 --set maps.side=32 --warmup 0 --repeat 1";

#[test]
fn an_output_is_replaced_and_its_neighbours_stay() {
    let (_folder, out) = place();
    std::fs::create_dir_all(&out).unwrap();
    std::fs::write(out.join("notes.txt"), "mine").unwrap();
    std::fs::write(out.join("image.png"), "old").unwrap();
    nephroid(&format!("render null {SMALL} --out {}", out.display())).ok();
    assert_eq!(names(&out), ["image.exr", "image.png", "notes.txt", "result.json", "timings.csv"]);
    assert!(std::fs::read(out.join("image.png")).unwrap().starts_with(b"\x89PNG"));
}
