//! Files that are no pictures, or not of what they should be: a located error, or a warning that names the difference.

use nephroid::image::{Layers, Provenance};

use super::{Picture, RESOLVED, SIDE, compare, fails, folder, write_plain};

#[test]
fn malformed_files_are_named() {
    let folder = folder();
    let good = Picture::of(1.0).write(&folder, "good.exr");
    let place = |name: &str| folder.path().join(name).display().to_string();
    let bytes = std::fs::read(&good).expect("reads");
    std::fs::write(place("cut.exr"), &bytes[..bytes.len() / 2]).expect("writes");
    std::fs::write(place("foreign.exr"), b"not an image at all").expect("writes");
    fails(&[&place("cut.exr"), "--reference", &good], &["cut.exr"]);
    fails(&[&good, "--reference", &place("foreign.exr")], &["foreign.exr", "EXR"]);
    fails(&[&place("absent.exr"), "--reference", &good], &["absent.exr", "cannot read"]);
    let small = Picture { side: 19, ..Picture::of(1.0) }.write(&folder, "small.exr");
    fails(&[&small, "--reference", &good], &["small.exr", "19x19", "good.exr", "20x20"]);
    fails(
        &[&good, "--reference", &good, "--layer", "medium"],
        &["good.exr", "`medium`", "`irradiance.caustic`, `mask`"],
    );
    fails(&[&good, "--reference", &good, "--layer", "caustic"], &["good.exr", "did you mean `irradiance.caustic`?"]);
    let main = Picture::of(1.0).about("camera", "main").write(&folder, "main.exr");
    fails(&[&main, "--reference", &good], &["main.exr", "--camera region"]);
    let dark = Picture::of(1.0).about("e0", "none").write(&folder, "dark.exr");
    fails(&[&dark, "--reference", &dark], &["nephroid.e0"]);
    let thin = write_plain(&place("thin.exr"), 1);
    fails(&[&good, "--reference", &thin], &["thin.exr", "1 channels", "3 are needed"]);
}

/// Wherever a file is cut, it is an error of that file; nothing panics.
#[test]
fn cut_anywhere_it_is_an_error() {
    let folder = folder();
    let good = Picture::of(1.0).write(&folder, "good.exr");
    let cut = folder.path().join("cut.exr").display().to_string();
    let bytes = std::fs::read(&good).expect("reads");
    for length in (0..bytes.len()).step_by(bytes.len() / 40) {
        std::fs::write(&cut, &bytes[..length]).expect("writes");
        fails(&[&good, "--reference", &cut], &["cut.exr"]);
    }
    fails(&[&good, "--reference", &folder.path().display().to_string()], &["cannot read"]);
}

/// Layers of the judged one's kin that do not fit it.
#[test]
fn layers_of_another_shape_are_named() {
    let folder = folder();
    let good = Picture::of(1.0).write(&folder, "good.exr");
    let with = |file: &str, name: &str, channels: usize| {
        let mut layers = Layers::new(SIDE, SIDE);
        layers.push("irradiance.caustic", 3, vec![1.0; 3 * SIDE * SIDE]).expect("a layer that fits");
        layers.push(name, channels, vec![0.0; channels * SIDE * SIDE]).expect("a layer that fits");
        let place = folder.path().join(file).display().to_string();
        std::fs::write(&place, layers.to_exr(&Provenance::new()).expect("encodes")).expect("writes");
        place
    };
    let variance = with("v.exr", "irradiance.caustic.variance", 1);
    fails(&[&good, "--reference", &variance], &["v.exr", "`irradiance.caustic.variance` has 1 channels", "3 are"]);
    let mask = with("m.exr", "mask", 3);
    fails(&[&good, "--reference", &mask], &["m.exr", "`mask` has 3 channels", "1 are needed"]);
    let bare = with("b.exr", "depth", 1);
    fails(
        &[&good, "--reference", &bare, "--layer", "mask"],
        &["b.exr: there is no layer `mask`", "choose one of `irradiance.caustic`, `depth`"],
    );
}

#[test]
fn a_reference_from_another_camera_or_of_another_size_is_named() {
    let folder = folder();
    let good = Picture::of(1.0).write(&folder, "good.exr");
    let main = Picture::of(1.0).about("camera", "main").write(&folder, "main.exr");
    fails(&[&good, "--reference", &main], &["main.exr was made with --camera main", "--camera region"]);
    let large = Picture { side: 21, ..Picture::of(1.0) }.write(&folder, "large.exr");
    fails(&[&good, "--reference", &large], &["good.exr", "20x20", "large.exr", "21x21"]);
}

/// Against a box-filtered truth, not against a picture sampled alike; a fine picture needs no more.
#[test]
fn one_sample_a_pixel_is_a_warning() {
    let folder = folder();
    let reference = Picture::of(1.0).write(&folder, "r.exr");
    let one = |side: usize| Picture { side, ..Picture::of(1.0).about("settings.eye.samples", "1") };
    let image = one(SIDE).write(&folder, "i.exr");
    let ran = compare(&[&image, "--reference", &reference, "--format", "json"]);
    let words = "one eye sample a pixel at 20x20";
    assert!(ran.err.contains("i.exr") && ran.err.contains(words) && ran.err.contains("eye.samples=1"), "{}", ran.err);
    assert!(ran.json()["warnings"][0].as_str().is_some_and(|w| w.contains(words)));
    assert_eq!(compare(&[&image, "--reference", &image]).err, "");
    let filtered = Picture { direct: true, ..one(SIDE).about("surface", "filtered") }.write(&folder, "filtered.exr");
    assert_eq!(compare(&[&filtered, "--reference", &reference]).err, "");
    let both = Picture { direct: true, ..Picture::of(1.0) }.write(&folder, "both.exr");
    let direct = compare(&[&filtered, "--reference", &both, "--layer", "irradiance.direct"]).err;
    assert!(
        direct.contains(words) && direct.contains("with --set eye.samples=4"),
        "the method gives the caustic alone: {direct}"
    );
    let more = Picture::of(1.0).about("settings.eye.samples", "2").write(&folder, "more.exr");
    assert_eq!(compare(&[&more, "--reference", &reference]).err, "");
    let large = Picture { side: 512, ..Picture::of(1.0) }.write(&folder, "large.exr");
    assert_eq!(compare(&[&one(512).write(&folder, "fine.exr"), "--reference", &large]).err, "");
}

/// A value that is no number exceeds any limit, its JSON is no number that could pass for a small one, and
/// where it stands is said.
#[test]
fn nan_fails() {
    let folder = folder();
    let (bad, good) = (Picture::of(f32::NAN).write(&folder, "bad.exr"), Picture::of(1.0).write(&folder, "good.exr"));
    let noise = Picture { variance: Some(-1.0), ..Picture::of(1.0) }.write(&folder, "noise.exr");
    for (image, reference, of, value) in [
        (&bad, &good, "bad.exr: 1200 values of `irradiance.caustic`", "NaN"),
        (&good, &bad, "bad.exr: 1200 values of `irradiance.caustic`", "NaN"),
        (&good, &noise, "noise.exr: 1200 values of `irradiance.caustic.variance`", "-1"),
    ] {
        let ran = compare(&[image, "--reference", reference, "--format", "json", "--fail-above", "relmse=1e300"]);
        assert_eq!(ran.code, Some(3));
        for name in nephroid::lab::MEASURES {
            assert_eq!(ran.json()["results"][0]["measures"][name]["value"], "infinity", "{name}");
        }
        let place = format!("{value}, at 0 from the left and 0 from the top");
        assert!(ran.err.contains(of) && ran.err.contains(&place), "{}", ran.err);
    }
}

/// A truth too short to know its noise: the figures stand, their noise does not.
#[test]
fn a_reference_of_infinite_noise_is_compared_without_it() {
    let folder = folder();
    let image = Picture::of(1.1).write(&folder, "i.exr");
    let reference = Picture { variance: Some(f32::INFINITY), ..Picture::of(1.0) }.write(&folder, "r.exr");
    let ran = compare(&[&image, "--reference", &reference, "--format", "json"]);
    assert_eq!(ran.code, Some(0));
    assert!(ran.err.contains("its noise is infinite"), "{}", ran.err);
    let relmse = &ran.json()["results"][0]["measures"]["relmse"];
    assert!(relmse["value"].as_f64().is_some() && relmse["truth_noise"].is_null(), "{relmse}");
}

/// The warning names the value that changed; figures are given all the same.
#[test]
fn a_changed_scene_is_a_warning() {
    let folder = folder();
    let reference = Picture::of(1.0).write(&folder, "r.exr");
    let changed = Picture::of(1.0).about("scene.hash", "b").about("scene.resolved", &RESOLVED.replace("1.5", "1.33"));
    let mesh = Picture::of(1.0).about("scene.hash", "c");
    let paths = Picture::of(1.0).about("settings.light.paths", "reflect-1");
    for (picture, words) in [
        (changed, "materials.glass.dielectric.ior is 1.5 there, 1.33 here"),
        (mesh, "a mesh file has changed"),
        (paths, "its paths are reflect-1"),
    ] {
        let image = picture.write(&folder, "i.exr");
        let ran = compare(&[&image, "--reference", &reference, "--format", "json"]);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        assert!(ran.err.contains("warning") && ran.err.contains(words), "{}", ran.err);
        assert!(ran.json()["warnings"][0].as_str().is_some_and(|w| w.contains(words)));
    }
}
