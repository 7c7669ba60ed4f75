//! `--reference auto`: a truth made when there is none, found again, gone on with, broken off; and pictures that name no
//! scene, or one that has changed. Each test has a store of its own.

use std::{
    fs,
    io::Read,
    path::Path,
    process::{Command, Stdio},
    thread::sleep,
    time::Duration,
};

use nephroid::{
    image::{Layers, Provenance},
    metrics::bare_irradiance,
    scene::Scene,
    store::Store,
};
use serde_json::Value;
use tempfile::TempDir;

use super::{Ran, folder, program};

const SIDE: usize = 16;
/// So few that a group of chunks is well below the chunks that a noise is believed from.
const THREADS: &str = "4";

/// What `render --camera region` says of a scene.
fn about(scene: &Scene) -> Provenance {
    let source = &scene.source;
    let overrides: Vec<_> = source.overrides.iter().map(|(key, value)| format!("{key}={value}")).collect();
    let entries = [
        ("scene.name", scene.name.clone()),
        ("scene.file", source.file.clone()),
        ("scene.hash", source.hash.clone()),
        ("scene.overrides", serde_json::to_string(&overrides).expect("JSON")),
        ("scene.resolved", source.resolved.clone()),
        ("camera", "region".to_owned()),
        ("e0", bare_irradiance(scene).to_string()),
    ];
    entries.into_iter().map(|(name, text)| (name.to_owned(), text)).collect()
}

fn write(folder: &TempDir, name: &str, caustic: Vec<f32>, about: &Provenance) -> String {
    let mut layers = Layers::new(SIDE, SIDE);
    layers.push("irradiance.direct", 3, vec![0.5; 3 * SIDE * SIDE]).expect("a layer that fits");
    layers.push("irradiance.caustic", 3, caustic).expect("a layer that fits");
    let path = folder.path().join(name);
    fs::write(&path, layers.to_exr(about).expect("encodes")).expect("writes");
    path.display().to_string()
}

/// An even caustic on a scene: far from its truth.
fn rough(folder: &TempDir, name: &str, scene: &Scene) -> String {
    write(folder, name, vec![0.5; 3 * SIDE * SIDE], &about(scene))
}

/// The truth in the store, a little too bright: close to it.
fn close(folder: &TempDir, factor: f32, scene: &Scene) -> String {
    let store = Store::at(folder.path().join("cache"));
    let entry = store.list("truth").pop().expect("a truth in the store");
    let (layers, _) = Layers::from_exr(&store.get("truth", &entry.key).expect("it is whole")).expect("an EXR file");
    let caustic = layers.get("irradiance.caustic").expect("a caustic").data().iter().map(|e| factor * e).collect();
    write(folder, "close.exr", caustic, &about(scene))
}

fn shipped(name: &str) -> Scene {
    Scene::load(name, &[]).expect("a shipped scene")
}

fn command(folder: &TempDir, arguments: &[&str]) -> Command {
    let mut command = program();
    command.env("NEPHROID_CACHE", folder.path().join("cache")).env("RAYON_NUM_THREADS", THREADS).args(arguments);
    command
}

fn run(folder: &TempDir, arguments: &[&str]) -> Ran {
    command(folder, arguments).output().expect("the program starts").into()
}

/// Compares with `--reference auto` and more arguments.
fn auto(folder: &TempDir, images: &[&str], more: &[&str]) -> Ran {
    run(folder, &[&["compare"], images, &["--reference", "auto"], more].concat())
}

/// The result's word for its reference, and its judged figure; the word stands on stderr too.
#[track_caller]
fn judged(ran: &Ran) -> (String, Value) {
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let result = &ran.json()["results"][0];
    let word = result["reference"].as_str().unwrap_or_default().to_owned();
    assert!(ran.err.contains(&format!("reference: {word}")), "`{word}` is not in: {}", ran.err);
    (word, result["measures"]["relmse"].clone())
}

/// Photons that a word tells of.
fn photons(word: &str) -> u64 {
    let count = word.split(": ").nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok());
    count.unwrap_or_else(|| panic!("no photons in {word}"))
}

#[track_caller]
fn fails(ran: &Ran, code: i32, words: &[&str]) {
    assert_eq!((ran.code, ran.out.as_str()), (Some(code), ""), "{}", ran.err);
    words.iter().for_each(|word| assert!(ran.err.contains(word), "`{word}` is not in: {}", ran.err));
}

const JSON: &[&str] = &["--format", "json"];

#[test]
fn made_once_found_again_listed_and_cleared() {
    let folder = folder();
    let image = rough(&folder, "i.exr", &shipped("glass-sphere"));
    let first = auto(&folder, &[&image], JSON);
    let (made, figure) = judged(&first);
    assert!(made.starts_with("truth of glass-sphere, transmit-2, 16x16: 4194304 photons, noise relmse "), "{made}");
    assert!(made.ends_with(", made to a tenth of the figure"), "{made}");
    assert!(first.err.contains("making the truth of glass-sphere, transmit-2, 16x16, for 120 s"), "{}", first.err);
    assert_eq!(first.json()["reference"], "auto");
    let (value, noise) = (figure["value"].as_f64().unwrap(), figure["truth_noise"].as_f64().unwrap());
    assert!(noise > 0.0 && noise <= 0.1 * (value - noise), "{figure}");
    let second = auto(&folder, &[&image], JSON);
    let (found, again) = judged(&second);
    assert_eq!((found, again), (made.replace("made to a tenth of the figure", "from the store"), figure));
    assert!(!second.err.contains("making"), "{}", second.err);
    let listed = run(&folder, &["truth", "--list"]).out;
    assert!(listed.lines().count() == 2 && listed.contains("transmit-2  region  16x16  0  4194304"), "{listed}");
    assert_eq!(run(&folder, &["truth", "--clear"]).out, "1 removed, and the sums of 1\n");
    assert_eq!(run(&folder, &["truth", "--clear"]).out, "0 removed\n");
}

/// What `nephroid truth` finished will do too; what is too noisy will not.
#[test]
fn a_truth_made_before_is_found() {
    let folder = folder();
    let image = rough(&folder, "i.exr", &shipped("glass-sphere"));
    let out = folder.path().join("t.exr").display().to_string();
    let truth = "truth glass-sphere --camera region --size 16x16 --photons";
    let make = |photons: &str, more: &[&str]| {
        let line: Vec<&str> = truth.split(' ').chain([photons, "-o", &out]).chain(more.iter().copied()).collect();
        assert_eq!(run(&folder, &line).code, Some(0));
    };
    make("100000", &["--seed", "5"]);
    make("50000", &["--seed", "6"]);
    make("100000", &["--paths", "all:2"]);
    let (word, _) = judged(&auto(&folder, &[&image], JSON));
    assert!(word.contains(" from the store") && (100_000..200_000).contains(&photons(&word)), "{word}");
}

/// The sums of the first truth are gone on with, to the very truth that a store without them would come to.
#[test]
fn a_better_picture_needs_more_of_the_same_truth() {
    let (folder, anew) = (folder(), folder());
    let scene = shipped("glass-sphere");
    judged(&auto(&folder, &[&rough(&folder, "i.exr", &scene)], JSON));
    let image = close(&folder, 1.004, &scene);
    let first = auto(&folder, &[&image], JSON);
    let (word, figure) = judged(&first);
    assert!(word.ends_with("made to a tenth of the figure") && photons(&word) > 4_194_304, "{word}");
    let mut other = command(&anew, &["compare", &image, "--reference", "auto", "--format", "json"]);
    let fresh = other.env("RAYON_NUM_THREADS", "3").output().expect("the program starts");
    assert_eq!(judged(&fresh.into()), (word, figure));
    // Both pictures share it from now on, side by side.
    let rough = rough(&folder, "again.exr", &scene);
    let both = auto(&folder, &[&rough, &image], JSON).json();
    assert!(both["results"][1]["reference"].as_str().is_some_and(|word| word.ends_with("from the store")), "{both}");
    assert_eq!(both["results"][0]["reference"], both["results"][1]["reference"]);
    assert_eq!(Store::at(folder.path().join("cache")).list("truth").len(), 1);
}

#[test]
fn stopped_by_the_clock_it_says_so_and_goes_on_later() {
    let folder = folder();
    let image = rough(&folder, "i.exr", &shipped("glass-sphere"));
    let stopped = |ran: &Ran| {
        let (word, figure) = judged(ran);
        assert!(word.contains("stopped after 0 s: the figure's interval says what that allows"), "{word}");
        assert!(figure["truth_noise"].as_f64().is_some_and(|noise| noise > 0.0), "{figure}");
        photons(&word)
    };
    let first = stopped(&auto(&folder, &[&image], &["--max-seconds", "0", "--format", "json"]));
    assert!((2 * 65536..4_194_304).contains(&first), "{first}");
    // Its noise happens to do for a figure that large.
    let (word, _) = judged(&auto(&folder, &[&image], JSON));
    assert!(word.ends_with("from the store") && photons(&word) == first, "{word}");
    let near = close(&folder, 1.0, &shipped("glass-sphere"));
    assert_eq!(stopped(&auto(&folder, &[&near], &["--max-seconds", "0", "--format", "json"])), first);
}

/// Ctrl-C: exit code 130, no report, and the photons so far are there for the next one.
#[cfg(unix)]
#[test]
fn interrupted_it_keeps_the_sums() {
    let folder = folder();
    let scene = shipped("glass-sphere");
    judged(&auto(&folder, &[&rough(&folder, "i.exr", &scene)], JSON));
    // Twelve times the photons are between this truth and the one that could judge it.
    let image = close(&folder, 1.0, &scene);
    let mut child = command(&folder, &["compare", &image, "--reference", "auto"]);
    let mut child = child.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // The first line is said before the first group of photons, which is then made whatever comes.
    let (mut line, stderr) = ([0; 6], child.stderr.as_mut().unwrap());
    stderr.read_exact(&mut line).unwrap();
    assert_eq!(&line, b"making");
    sleep(Duration::from_millis(300));
    let interrupt = format!("kill -INT {}", child.id());
    assert!(Command::new("sh").args(["-c", &interrupt]).status().unwrap().success());
    let ran = Ran::from(child.wait_with_output().unwrap());
    fails(&ran, 130, &["interrupted", "kept: the photons so far"]);
    let (word, _) = judged(&auto(&folder, &[&image], &["--max-seconds", "0", "--format", "json"]));
    assert!(word.contains("stopped after 0 s") && photons(&word) > 4_194_304, "{word}");
}

/// Scenes of a file: with their overrides, changed, broken, gone.
#[test]
fn a_scene_that_has_changed_is_an_error_that_names_the_difference() {
    let folder = folder();
    let file = folder.path().join("mine.toml").display().to_string();
    let text = shipped("glass-sphere").source.text;
    fs::write(&file, &text).unwrap();
    let scene = Scene::load(&file, &[("materials.glass.ior".to_owned(), "1.4".to_owned())]).unwrap();
    let image = rough(&folder, "i.exr", &scene);
    let (word, _) = judged(&auto(&folder, &[&image], &["--max-seconds", "0", "--format", "json"]));
    assert!(word.starts_with("truth of mine, transmit-2, 16x16"), "{word}");
    fs::write(&file, text.replace("radius = 1.0", "radius = 1.1")).unwrap();
    let difference = "objects.ball.sphere.radius is 1.1 there, 1.0 here";
    let remedy = ["render the image again", "--reference"];
    fails(&auto(&folder, &[&image], &[]), 1, &[&["i.exr", "mine.toml", difference], &remedy[..]].concat());
    fs::write(&file, "version = 1\n").unwrap();
    fails(&auto(&folder, &[&image], &[]), 1, &["i.exr", "cannot be loaded again", "mine.toml"]);
    fs::remove_file(&file).unwrap();
    fails(&auto(&folder, &[&image], &[]), 1, &["i.exr", "cannot be loaded again", "mine.toml", "No such file"]);
}

#[test]
fn what_cannot_have_a_truth_is_said_at_once() {
    let folder = folder();
    let scene = shipped("glass-sphere");
    let good = rough(&folder, "good.exr", &scene);
    let with = |name: &str, key: &str, value: Option<&str>| {
        let mut about = about(&scene);
        about.remove(key);
        about.extend(value.map(|value| (key.to_owned(), value.to_owned())));
        write(&folder, name, vec![0.5; 3 * SIDE * SIDE], &about)
    };
    for key in ["scene.name", "scene.file", "scene.hash", "scene.overrides"] {
        let image = with("bare.exr", key, None);
        fails(&auto(&folder, &[&good, &image], &[]), 1, &["bare.exr does not say what scene it shows", "--reference"]);
    }
    let main = with("main.exr", "camera", Some("main"));
    fails(&auto(&folder, &[&main], &[]), 1, &["main.exr was made with --camera main", "--camera region"]);
    let dark = with("dark.exr", "e0", Some("none"));
    let (word, _) = judged(&auto(&folder, &[&dark], &["--max-seconds", "0", "--format", "json"]));
    assert!(word.contains("stopped after 0 s"), "{word}"); // the truth knows its E₀
    fails(&auto(&folder, &[&good], &["--layer", "radiance"]), 1, &["good.exr: there is no layer `radiance`"]);
    fails(&auto(&folder, &[&good], &["--max-seconds", "nan"]), 2, &["a number of seconds"]);
    let file = run(&folder, &["compare", &good, "--reference", &good, "--max-seconds", "1"]);
    fails(&file, 2, &["--max-seconds goes with --reference auto"]);
}

/// Direct light is there at once, and so is the darkness of a scene that bends no light.
#[test]
fn what_needs_no_photons_is_complete_at_once() {
    let folder = folder();
    let glass = rough(&folder, "glass.exr", &shipped("glass-sphere"));
    let (word, figure) = judged(&auto(&folder, &[&glass], &["--layer", "irradiance.direct", "--format", "json"]));
    assert!(word.contains(": 0 photons") && word.ends_with("complete"), "{word}");
    assert!(figure["truth_noise"].as_f64().is_some_and(|noise| noise > 0.0), "{figure}");
    let dark = write(&folder, "dark.exr", vec![0.0; 3 * SIDE * SIDE], &about(&shipped("diffuse")));
    let (word, figure) = judged(&auto(&folder, &[&dark], JSON));
    assert!(word.contains("truth of diffuse") && word.ends_with("complete"), "{word}");
    assert_eq!((figure["value"].as_f64(), figure["truth_noise"].as_f64()), (Some(0.0), Some(0.0)));
    let (word, _) = judged(&auto(&folder, &[&dark], JSON));
    assert!(word.ends_with("from the store"), "{word}");
}

/// Pictures of two scenes have two references, and every format tells which is whose.
#[test]
fn every_format_says_which_reference() {
    let folder = folder();
    let scene = |ior: &str| Scene::load("glass-sphere", &[("materials.glass.ior".to_owned(), ior.to_owned())]).unwrap();
    let [a, b] = ["1.5", "1.4"].map(|ior| rough(&folder, &format!("{ior}.exr"), &scene(ior)));
    for (format, times) in [("json", 2), ("csv", 18), ("table", 2), ("md", 2)] {
        let ran = auto(&folder, &[&a, &b], &["--max-seconds", "0", "--format", format]);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        assert_eq!(ran.out.matches("truth of glass-sphere, transmit-2, 16x16").count(), times, "{}", ran.out);
    }
    let alike = auto(&folder, &[&a, &a], &["--max-seconds", "0"]).out;
    assert_eq!(alike.matches("truth of glass-sphere").count(), 1, "{alike}");
}

/// What `render` writes names its scene well enough.
#[test]
fn a_render_finds_its_truth() {
    let folder = folder();
    let out = folder.path().join("out").display().to_string();
    let render = "render bunny --camera region --size 16x16 --set light.side=64 --set scene.materials.glass.ior=1.4 \
                  --set light.paths=transmit-1 --warmup 0 --repeat 1 --out";
    // Its pipelines may be those of an earlier run.
    let cache = Path::new(env!("CARGO_TARGET_TMPDIR")).join("compare-cache");
    let ran = program().env("NEPHROID_CACHE", cache).args(render.split_whitespace()).arg(&out).output();
    let ran = Ran::from(ran.expect("the program starts"));
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let (word, _) = judged(&auto(&folder, &[&format!("{out}/image.exr")], &["--max-seconds", "0", "--format", "json"]));
    assert!(word.starts_with("truth of bunny, transmit-1, 16x16"), "{word}");
}
