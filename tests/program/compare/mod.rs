//! `nephroid compare` as a user runs it: on pictures made here, figures, formats, thresholds, maps; in its rooms
//! references made and found by themselves, and malformed files.

mod auto;
mod malformed;

use std::{path::Path, process::Command};

use nephroid::image::{Layers, Provenance};
use serde_json::Value;
use tempfile::TempDir;

use crate::ran::Ran;

const SIDE: usize = 20;
const RESOLVED: &str = "paths = \"transmit-2\"\n[materials.glass.dielectric]\nior = 1.5\n";

/// A picture to be written: an even caustic, and what the file says.
struct Picture {
    side: usize,
    value: f32,
    variance: Option<f32>,
    masked: usize,
    /// With direct light of 1.
    direct: bool,
    about: Provenance,
}

impl Picture {
    fn of(value: f32) -> Self {
        let entry = |(name, text): (&str, &str)| (name.to_owned(), text.to_owned());
        let about = [("e0", "2"), ("camera", "region"), ("scene.hash", "a"), ("scene.resolved", RESOLVED)];
        Self {
            side: SIDE,
            value,
            variance: None,
            masked: 0,
            direct: false,
            about: about.map(entry).into_iter().collect(),
        }
    }

    fn about(mut self, name: &str, text: &str) -> Self {
        self.about.insert(name.to_owned(), text.to_owned());
        self
    }

    fn write(&self, folder: &TempDir, name: &str) -> String {
        let pixels = self.side * self.side;
        let mut layers = Layers::new(self.side, self.side);
        let mask = (0..pixels).map(|at| if at < self.masked { 0.5 } else { 0.0 }).collect();
        layers.push("irradiance.caustic", 3, vec![self.value; 3 * pixels]).expect("a layer that fits");
        if self.direct {
            layers.push("irradiance.direct", 3, vec![1.0; 3 * pixels]).expect("a layer that fits");
        }
        layers.push("mask", 1, mask).expect("a layer that fits");
        if let Some(variance) = self.variance {
            layers.push("irradiance.caustic.variance", 3, vec![variance; 3 * pixels]).expect("a layer that fits");
        }
        let path = folder.path().join(name);
        std::fs::write(&path, layers.to_exr(&self.about).expect("encodes")).expect("writes");
        path.display().to_string()
    }
}

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_nephroid"))
}

fn compare(arguments: &[&str]) -> Ran {
    program().arg("compare").args(arguments).output().expect("the program starts").into()
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// An error: exit code 1, nothing on stdout, every word on stderr.
#[track_caller]
fn fails(arguments: &[&str], words: &[&str]) {
    let ran = compare(arguments);
    assert_eq!((ran.code, ran.out.as_str()), (Some(1), ""), "{}", ran.err);
    for word in words {
        assert!(ran.err.contains(word), "`{word}` is not in: {}", ran.err);
    }
}

/// Float32 values of the files in float64 sums.
const ROUNDING: f64 = 1e-6;

/// E₀ = 2, ε = 0.04; 1.1 against 1: 0.01/1.04; the standard: 0.01/1.01.
#[test]
fn figures_and_their_constants() {
    let folder = folder();
    let (image, reference) = (Picture::of(1.1).write(&folder, "i.exr"), Picture::of(1.0).write(&folder, "r.exr"));
    let report = compare(&[&image, "--reference", &reference, "--format", "json"]).json();
    assert_eq!(report["schema"], "nephroid.compare/1");
    let result = &report["results"][0];
    assert_eq!(result["layer"], "irradiance.caustic");
    assert_eq!((result["pixels"].as_u64(), result["masked"].as_u64()), (Some(400), Some(0)));
    let near = |name: &str, expected: f64| {
        let found = result["measures"][name]["value"].as_f64().unwrap_or(f64::NAN);
        assert!((found / expected - 1.0).abs() < ROUNDING, "{name}: {found} for {expected}");
    };
    near("relmse", 0.01 / 1.04);
    near("relmse_standard", 0.01 / 1.01);
    near("rmse", 0.1);
    near("mae", 0.1);
    near("mape", 0.1 / 1.01);
    near("energy_ratio", 1.1);
    assert_eq!(result["measures"]["relmse"]["truth_noise"], Value::Null);
    assert_eq!(result["constants"]["e0"], 2.0);
    assert_eq!(result["constants"]["flip_pixels_per_degree"], 67.0);
}

/// 0.5 against 1, and right up to a scale: 2 fits it exactly.
#[test]
fn a_relative_picture_is_told_raw_and_fitted() {
    let folder = folder();
    let reference = Picture::of(1.0).write(&folder, "r.exr");
    let image = Picture::of(0.5).about("surface", "relative").write(&folder, "i.exr");
    let result = &compare(&[&image, "--reference", &reference, "--format", "json"]).json()["results"][0];
    assert_eq!(
        (result["fitted"]["scale"].as_f64(), result["fitted"]["relmse"]["value"].as_f64()),
        (Some(2.0), Some(0.0))
    );
    assert!((result["measures"]["relmse"]["value"].as_f64().unwrap() - 0.25 / 1.04).abs() < ROUNDING);
    for format in ["table", "csv", "md"] {
        let out = compare(&[&image, "--reference", &reference, "--format", format]).out;
        assert!(out.contains("relmse_fitted") && out.contains("scale"), "{out}");
    }
    let plain = Picture::of(0.5).write(&folder, "p.exr");
    assert!(!compare(&[&plain, "--reference", &reference]).out.contains("scale"), "what is absolute has no scale");
}

/// Each format names every measure, and its constants; CSV is a record a measure.
#[test]
fn every_format_has_every_measure() {
    let folder = folder();
    let (image, reference) = (Picture::of(1.1).write(&folder, "i.exr"), Picture::of(1.0).write(&folder, "r.exr"));
    for format in ["table", "json", "csv", "md"] {
        let ran = compare(&[&image, &image, "--reference", &reference, "--format", format]);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        for name in nephroid::lab::MEASURES {
            assert!(ran.out.contains(name), "{format}: no {name}");
        }
        assert_eq!(format == "csv", !ran.out.contains("pixels per degree") && format != "json");
        if format == "csv" {
            assert_eq!(ran.out.lines().count(), 1 + 2 * nephroid::lab::MEASURES.len());
        }
    }
}

/// v = 0.01 at r = 1: a perfect image scores 0.01/1.04; one that is 0.1 off is lost in it, one that is 1 off is not.
#[test]
fn a_figure_below_twice_the_noise_is_said_to_be_so() {
    let folder = folder();
    let reference = Picture { variance: Some(0.01), ..Picture::of(1.0) }.write(&folder, "r.exr");
    let judged = |value: f32| {
        let image = Picture::of(value).write(&folder, "i.exr");
        let json = compare(&[&image, "--reference", &reference, "--format", "json"]).json();
        let table = compare(&[&image, "--reference", &reference]).out;
        (json["results"][0]["measures"]["relmse"].clone(), table)
    };
    let (lost, table) = judged(1.1);
    let noise = lost["truth_noise"].as_f64().unwrap_or(f64::NAN);
    assert!((noise / (0.01 / 1.04) - 1.0).abs() < ROUNDING, "{noise}");
    assert_eq!(lost["below_noise"], true);
    assert!(table.contains("lost in noise"), "{table}");
    let (known, table) = judged(2.0);
    assert_eq!(known["below_noise"], false);
    assert!(known["low"].as_f64() < known["value"].as_f64(), "{known}");
    let row = table.lines().find(|line| line.contains(" relmse "));
    assert!(row.is_some_and(|row| !row.contains("lost in noise")), "{table}");
}

#[test]
fn thresholds_decide_the_exit_code() {
    let folder = folder();
    let (image, reference) = (Picture::of(1.1).write(&folder, "i.exr"), Picture::of(1.0).write(&folder, "r.exr"));
    let code = |limit: &str| compare(&[&image, "--reference", &reference, "--fail-above", limit]).code;
    assert_eq!(code("relmse=0.01"), Some(0));
    assert_eq!(code("relmse=0.009"), Some(3));
    assert_eq!(code("relmse=0"), Some(3));
    assert_eq!(code("energy_ratio=0.11"), Some(0));
    assert_eq!(code("energy_ratio=0.09"), Some(3));
    for wrong in ["relmse", "relmse=", "relmse=-1", "relmse=nan", "nothing=1"] {
        assert_eq!(code(wrong), Some(2), "{wrong}");
    }
    let ran = compare(&[&image, "--reference", &reference, "--fail-above", "relsme=0.01"]);
    assert!(ran.err.contains("no measure `relsme`") && ran.err.contains("did you mean `relmse`?"), "{}", ran.err);
    let ran = compare(&[&reference, &image, "--reference", &reference, "--fail-above", "rmse=0.05"]);
    assert_eq!(ran.code, Some(3));
    assert!(ran.err.contains("rmse") && ran.err.contains("i.exr") && !ran.out.is_empty(), "{}", ran.err);
}

/// v = 0.01 at r = 1, ε = 0.04, w = 1/1.04: 0.1 off scores 0.01 w, of which 0.01 (w + 0.4 w² + 0.01 (4 w³ − w²)) is noise; 1 off
/// scores w, and little less without it.
#[test]
fn what_noise_adds_is_taken_off_where_it_is_known() {
    let folder = folder();
    let noisy = Picture { variance: Some(0.01), ..Picture::of(1.0) }.write(&folder, "noisy.exr");
    let debiased = |image: &str, reference: &str| {
        compare(&[image, "--reference", reference, "--format", "json"]).json()["results"][0]["relmse_debiased"].clone()
    };
    let (near, far) = (Picture::of(1.1).write(&folder, "near.exr"), Picture::of(2.0).write(&folder, "far.exr"));
    let (left, known) = (debiased(&near, &noisy), debiased(&far, &noisy));
    let value = |of: &Value| of["value"].as_f64().unwrap_or(f64::NAN);
    let w: f64 = 1.0 / 1.04;
    let expected = 0.01 * w - 0.01 * (w + 0.4 * w * w + 0.01 * (4.0 * w.powi(3) - w * w));
    assert!((value(&left) / expected - 1.0).abs() < 1e-4, "{left} for {expected}");
    assert!(left["low"].as_f64() < Some(value(&left)) && value(&left) < left["high"].as_f64().unwrap(), "{left}");
    assert!((value(&known) - 1.0 / 1.04).abs() < 0.1 && known["below_noise"] == false, "{known}");
    let code =
        |image: &str, reference: &str, limit: &str| compare(&[image, "--reference", reference, "--fail-above", limit]);
    assert_eq!(code(&near, &noisy, "relmse_debiased=0.01").code, Some(0), "it is but noise");
    assert_eq!(code(&near, &noisy, "relmse=0.009").code, Some(3));
    assert_eq!(code(&far, &noisy, "relmse_debiased=0.01").code, Some(3));
    let exact = Picture::of(1.0).write(&folder, "exact.exr");
    assert!(debiased(&near, &exact).is_null());
    let ran = code(&near, &exact, "relmse_debiased=0.01");
    assert!(ran.code == Some(3) && ran.err.contains("not known") && ran.err.contains("exact.exr"), "{}", ran.err);
    let cells =
        Picture { variance: Some(0.01), ..Picture::of(1.0) }.about("estimator", "cells").write(&folder, "c.exr");
    assert!(debiased(&near, &cells).is_null(), "what cells state is no noise");
}

/// 0.5 against 1: raw 0.25/1.04, fitted nothing; a picture in W/m² has no other scale than one.
#[test]
fn a_limit_can_be_for_what_the_best_scale_leaves() {
    let folder = folder();
    let reference = Picture::of(1.0).write(&folder, "r.exr");
    let relative = Picture::of(0.5).about("surface", "relative").write(&folder, "relative.exr");
    let absolute = Picture::of(0.5).write(&folder, "absolute.exr");
    let judged = |image: &str, limit: &str| compare(&[image, "--reference", &reference, "--fail-above", limit]);
    assert_eq!(judged(&relative, "relmse_fitted=0.01").code, Some(0));
    assert_eq!(judged(&relative, "relmse=0.01").code, Some(3));
    let ran = judged(&absolute, "relmse_fitted=0.01");
    assert!(
        ran.code == Some(3) && ran.err.contains("relmse_fitted of") && ran.err.contains("absolute.exr"),
        "{}",
        ran.err
    );
}

/// The union of both masks is left out and counted; more than 5 % of it is refused.
#[test]
fn masks_are_joined() {
    let folder = folder();
    let reference = Picture { masked: 15, ..Picture::of(1.0) }.write(&folder, "r.exr");
    let image = |masked: usize| Picture { masked, ..Picture::of(1.0) }.write(&folder, "i.exr");
    let masked = |name: &str| {
        let report = compare(&[name, "--reference", &reference, "--format", "json"]).json();
        [&report["results"][0]["pixels"], &report["results"][0]["masked"]].map(Value::as_u64)
    };
    assert_eq!(masked(&image(10)), [Some(385), Some(15)]);
    assert_eq!(masked(&image(20)), [Some(380), Some(20)]);
    fails(&[&image(21), "--reference", &reference], &["21 of 400", "--camera region"]);
}

#[test]
fn maps_are_pictures_with_their_bars() {
    let folder = folder();
    let (image, reference) = (Picture::of(1.1).write(&folder, "i.exr"), Picture::of(1.0).write(&folder, "r.exr"));
    let out = folder.path().join("maps");
    let place = out.display().to_string();
    assert_eq!(compare(&[&image, "--reference", &reference, "--maps", &place]).code, Some(0));
    for name in ["i.irradiance.caustic.error.png", "i.irradiance.caustic.flip.png"] {
        let (size, first) = decode(&out.join(name));
        assert!(size[0] as usize > SIDE && size[1] as usize >= SIDE, "{name}: {size:?} leaves no room for a bar");
        // All pixels are 0.1 too bright, which is where the scale ends: the full red.
        assert!(name.contains("flip") || first == [178, 24, 43], "{name}: {first:?}");
    }
}

fn decode(path: &Path) -> ([u32; 2], [u8; 3]) {
    let bytes = std::fs::read(path).expect("the map is there");
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("pixels");
    ([info.width, info.height], [pixels[0], pixels[1], pixels[2]])
}

/// A file that says nothing of itself, as another renderer's.
fn write_plain(place: &str, channels: usize) -> String {
    let mut layers = Layers::new(SIDE, SIDE);
    layers.push("irradiance.caustic", channels, vec![1.0; channels * SIDE * SIDE]).expect("a layer that fits");
    std::fs::write(place, layers.to_exr(&Provenance::new()).expect("encodes")).expect("writes");
    place.to_owned()
}

#[test]
fn a_reference_of_another_renderer_is_taken_as_it_is() {
    let folder = folder();
    let image = Picture::of(1.1).write(&folder, "i.exr");
    let foreign = write_plain(&folder.path().join("foreign.exr").display().to_string(), 3);
    let ran = compare(&[&image, "--reference", &foreign, "--format", "json"]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
    assert_eq!(ran.json()["results"][0]["measures"]["flip"]["truth_noise"], Value::Null);
}

/// What `render` writes says how bright its region is, and is no different from itself.
#[test]
fn a_render_compares_with_itself() {
    let folder = folder();
    let out = folder.path().join("m").display().to_string();
    let render = "render glass-sphere --camera region --size 32x32 --set light.side=64 --repeat 1 --warmup 0 --out";
    let ran = program().args(render.split(' ')).arg(&out).output().expect("the program starts");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let image = format!("{out}/image.exr");
    let ran = compare(&[&image, "--reference", &image, "--format", "json", "--fail-above", "relmse=0"]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
    assert_eq!(ran.json()["results"][0]["constants"]["e0"], 1.0);
}
