//! Options that make no sense: each named with its remedy, exit code 2 or 4, and nothing written.

use super::{Ran, nephroid, place, program};

const USAGE: i32 = 2;
const NO_DEVICE: i32 = 4;

/// Options after `render`, the exit code, and what the message must say.
const CASES: &[(&str, i32, &[&str])] = &[
    ("glass-sphere --set light.side=-3", USAGE, &["light.side=-3", "1 to 16384 texels", "default 512"]),
    ("glass-sphere --set light.side=64.5", USAGE, &["light.side=64.5", "1 to 16384 texels"]),
    ("glass-sphere --set light.sied=64", USAGE, &["light.sied", "no such setting", "did you mean `light.side`?"]),
    ("glass-sphere --set nothing.like.it=1", USAGE, &["nothing.like.it", "nephroid methods"]),
    ("glass-sphere --set light.side", USAGE, &["light.side", "KEY=VALUE"]),
    ("glass-sphere --set =3", USAGE, &["=3", "KEY=VALUE"]),
    ("glass-sphere --set light.view=wide", USAGE, &["light.view=wide", "fitted | shared"]),
    ("glass-sphere --set eye.exposure=NaN", USAGE, &["eye.exposure=NaN", "-30 to 30 EV"]),
    ("glass-sphere --set eye.samples=17", USAGE, &["eye.samples=17", "0 to 16"]),
    ("glass-sphere --size 640", USAGE, &["640", "--size", "WIDTHxHEIGHT"]),
    ("glass-sphere --size 0x480", USAGE, &["0x480", "each from 1"]),
    ("glass-sphere --size 640x480x3", USAGE, &["640x480x3", "WIDTHxHEIGHT"]),
    ("glass-sphere --size -1x5", USAGE, &["-1"]),
    ("glass-sphere --size 70000x1", USAGE, &["70000x1", "65536"]),
    ("glass-sphere --size 32768x1", USAGE, &["eye/", "32768x1", "lower --size (now 32768x1)", "eye.samples"]),
    ("glass-sphere --size 4096x1 --set eye.samples=16", USAGE, &["65536x16", "lower --size", "eye.samples (now 16)"]),
    ("glass-sphere --method map", USAGE, &["--method", "'map'", "no method `map`", "did you mean `maps`?"]),
    ("glass-sphere --method maps --surface maps", USAGE, &["--method", "--surface", "cannot be used with"]),
    ("glass-sphere --medium maps", USAGE, &["--medium maps", "does not fill the slot medium", "not built yet"]),
    ("glass-sphere --camera side", USAGE, &["no camera `side`", "choose one of `main`, `region`"]),
    ("glass-sphere --camera regoin", USAGE, &["no camera `regoin`", "did you mean `region`?"]),
    ("glass-sphere --repeat 0", USAGE, &["--repeat", "0"]),
    ("glass-sphere --warmup some", USAGE, &["--warmup", "some"]),
    ("glass-sphere --time NaN", USAGE, &["--time", "NaN", "a number of seconds"]),
    ("moving-sphere --sequence 2..1@30", USAGE, &["--sequence", "1 s is not after 2 s", "earlier first"]),
    ("moving-sphere --sequence 0..1@0", USAGE, &["--sequence", "0 frames a second", "more than 0"]),
    ("moving-sphere --sequence @0", USAGE, &["--sequence", "FROM..TO@FPS"]),
    ("moving-sphere --sequence nan..1@2", USAGE, &["--sequence", "FROM..TO@FPS"]),
    ("moving-sphere --sequence 0..1e9@60", USAGE, &["--sequence", "fewer a second"]),
    ("moving-sphere --sequence 0..1@2 --time 3", USAGE, &["--sequence", "--time"]),
    ("glass-sphere --seed 1.5", USAGE, &["--seed", "1.5"]),
    ("glass-sphere --format xml", USAGE, &["--format", "xml", "table, json, csv, md"]),
    ("glass-sphere --dump maps/nap", USAGE, &["--dump", "`maps/nap`", "did you mean `maps/map`?"]),
    ("diffuse --dump maps/map", USAGE, &["--dump", "`maps/map`", "choose one of", "`eye/radiance`"]),
    ("glass-sphere --bogus", USAGE, &["--bogus"]),
    ("glass-sphere second", USAGE, &["second"]),
    ("glas-sphere", USAGE, &["glas-sphere", "no such scene", "glass-sphere"]),
    ("no/such/scene.toml", USAGE, &["no/such/scene.toml", "No such file", "check the path"]),
    ("src/scene/", USAGE, &["src/scene/", "a folder"]),
    ("glass-sphere --set scene.materials.glass.iro=1.3", USAGE, &["scene.materials.glass.iro", "did you mean", "ior"]),
    ("glass-sphere --set scene.materials.glass.ior=-1", USAGE, &["--set scene.materials.glass.ior=-1", "ior"]),
    ("glass-sphere --set scene.materials.glass.ior=wet", USAGE, &["--set scene.materials.glass.ior=wet", "`water`"]),
    ("glass-sphere --set scene.exposure=bright", USAGE, &["--set scene.exposure=bright", "a number"]),
    ("glass-sphere --set scene.objects.ball.material=[1", USAGE, &["--set scene.objects.ball.material=[1", "TOML"]),
    ("glass-sphere --set scene.objects.ball.material=gold", USAGE, &["gold", "glass", "white"]),
    ("bunny --set scene.objects.bunny.file=none.obj", USAGE, &["none.obj", "No such file"]),
    ("glass-sphere --set light.paths=all:65", USAGE, &["light.paths=all:65", "transmit-2", "all:N", "default scene"]),
    ("glass-sphere --set light.paths=everything", USAGE, &["light.paths=everything", "transmit-2", "all:N"]),
    ("glass-sphere --set light.layers=65", USAGE, &["light.layers=65", "1 to 64 layers", "default"]),
    ("glass-sphere --set scene.medium.x=1", USAGE, &["--set scene.medium.x=1", "media are not built yet"]),
    ("glass-sphere --set scene.lights.sun.point.position=[0,3,0]", USAGE, &["`directional`", "scene.lights.sun={"]),
    ("glass-sphere --medium maps --device voodoo", USAGE, &["--medium maps", "does not fill the slot medium"]),
    ("glass-sphere --capture", USAGE, &["--capture", "RenderDoc is not loaded", "renderdoccmd"]),
    ("glass-sphere --device 99", NO_DEVICE, &["no device matches '99'", "present: 0"]),
    ("glass-sphere --device voodoo", NO_DEVICE, &["no device matches 'voodoo'", "present: 0"]),
];

#[test]
fn each_is_refused_with_its_name_and_remedy_and_nothing_is_written() {
    for (options, code, wanted) in CASES {
        let (folder, out) = place();
        let ran = nephroid(&format!("render {options} --out {}", out.display()));
        assert_eq!(ran.code, Some(*code), "{options}: {}", ran.err);
        assert!(ran.err.starts_with("error: ") || ran.err.contains("\nerror: "), "{options}: {}", ran.err);
        for words in *wanted {
            assert!(ran.err.contains(words), "{options}: the message lacks {words:?}: {}", ran.err);
        }
        assert!(ran.out.is_empty(), "{options}: {}", ran.out);
        assert!(super::names(folder.path()).is_empty(), "{options}: something was written");
    }
}

#[test]
fn a_device_is_suggested_by_a_word_of_its_name() {
    let devices = nephroid("devices --format json").ok().json();
    let name = devices["devices"][0]["name"].as_str().unwrap().to_owned();
    let word = name.split([' ', ',', '(', ')']).find(|word| word.len() > 4).expect("a word of its name").to_owned();
    let ran = nephroid(&format!("render null --device {}x --out {}", word, place().1.display()));
    assert_eq!(ran.code, Some(NO_DEVICE), "{}", ran.err);
    assert!(ran.err.contains(&format!("did you mean `{word}`?")), "{}", ran.err);
}

#[test]
fn a_command_must_be_whole() {
    for (arguments, wanted) in [
        ("", "Usage"),
        ("rendre glass-sphere", "render"),
        ("render --out x", "<SCENE>"),
        ("render glass-sphere", "--out"),
        ("plan", "<SCENE>"),
        ("scenes null --source --format json", "--format"),
        ("scenes --source", "<SCENE>"),
        ("completions", "<SHELL>"),
        ("completions basch", "bash"),
    ] {
        let ran = nephroid(arguments);
        assert_eq!(ran.code, Some(USAGE), "{arguments}: {}", ran.err);
        assert!(ran.err.contains(wanted), "{arguments}: {}", ran.err);
    }
}

#[test]
fn without_any_device_the_exit_code_says_so() {
    for arguments in ["devices".to_owned(), format!("render null --out {}", place().1.display())] {
        let mut command = program();
        command
            .args(arguments.split(' '))
            .env("VK_DRIVER_FILES", "/nonexistent")
            .env("VK_ICD_FILENAMES", "/nonexistent");
        let ran = Ran::from(command.output().unwrap());
        assert_eq!(ran.code, Some(NO_DEVICE), "{arguments}: {}", ran.err);
        assert!(ran.err.contains("no Vulkan device") && ran.err.contains("mesa-vulkan-drivers"), "{}", ran.err);
    }
}

#[cfg(unix)]
#[test]
fn arguments_that_are_no_text_are_refused() {
    use std::{ffi::OsStr, os::unix::ffi::OsStrExt};
    let ran = program().args([OsStr::new("plan"), OsStr::from_bytes(b"\xff\xfe")]).output().unwrap();
    assert_eq!(ran.status.code(), Some(USAGE));
    assert!(!String::from_utf8_lossy(&ran.stderr).contains("panicked"));
}
