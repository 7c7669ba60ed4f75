//! Sequences: numbered files, a line for each, and the same command that goes on where it was left.

use std::fs;

use nephroid::image::Layers;
use serde_json::Value;

use super::{Ran, names, nephroid, place, program};

const FRAMES: &str =
    "render moving-sphere --method maps --size 32x24 --set light.side=64 --set maps.side=64 --warmup 0";

fn sequence(range: &str, out: &std::path::Path) -> Ran {
    let mut command = program();
    command.args(FRAMES.split(' ')).args(["--sequence", range, "--out"]).arg(out);
    Ran::from(command.output().unwrap()).ok()
}

fn lines(out: &std::path::Path) -> Vec<Value> {
    let text = fs::read_to_string(out.join("frames.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect()
}

#[test]
fn a_sequence_is_numbered_pictures_and_a_line_for_each() {
    let (_folder, out) = place();
    let ran = sequence("0..1@2", &out);
    let pictures = ["image.0000.exr", "image.0000.png", "image.0001.exr", "image.0001.png"];
    assert_eq!(names(&out), [&["frames.jsonl"], &pictures[..], &["result.json", "timings.csv"]].concat());
    let lines = lines(&out);
    assert_eq!(lines.len(), 2);
    for (index, line) in lines.iter().enumerate() {
        assert_eq!((line["index"].as_u64(), line["time_s"].as_f64()), (Some(index as u64), Some(0.5 * index as f64)));
        assert!(
            line["stages_ms"]["light/photons"].as_f64().unwrap() > 0.0 && line["photons"]["emitted"].as_u64() > Some(0)
        );
    }
    let moved = |line: &Value| line["move_ms"].as_f64().unwrap() > 0.0;
    assert_eq!([moved(&lines[0]), moved(&lines[1])], [false, true], "the first frame is where the scene was planned");
    let result: Value = serde_json::from_slice(&fs::read(out.join("result.json")).unwrap()).unwrap();
    assert_eq!((result["schema"].as_str(), result["frames"].as_u64()), (Some("nephroid.sequence/1"), Some(2)));
    assert_eq!(result["planned_again"].as_u64(), Some(0));
    assert!(ran.out.contains("light/photons") && ran.out.contains("frame/move"), "{}", ran.out);
    // A frame by itself is the same picture.
    let (_one, alone) = place();
    let mut command = program();
    command.args(FRAMES.split(' ')).args(["--time", "0.5", "--repeat", "1", "--out"]).arg(&alone);
    Ran::from(command.output().unwrap()).ok();
    let layers = |file: std::path::PathBuf| Layers::from_exr(&fs::read(file).unwrap()).unwrap().0;
    assert_eq!(layers(out.join("image.0001.exr")), layers(alone.join("image.exr")));
}

#[test]
fn the_same_command_goes_on_where_it_was_left() {
    let (_folder, out) = place();
    sequence("0..1@4", &out);
    let files = |out: &std::path::Path| -> Vec<_> {
        let pictures = names(out).into_iter().filter(|name| name.starts_with("image."));
        pictures.map(|name| (fs::read(out.join(&name)).unwrap(), name)).collect()
    };
    let before = files(&out);
    // As an end by force may leave it: a picture lost, one cut short, a line torn.
    fs::remove_file(out.join("image.0001.png")).unwrap();
    let cut = fs::read(out.join("image.0002.exr")).unwrap();
    fs::write(out.join("image.0002.exr"), &cut[..cut.len() / 2]).unwrap();
    let text = fs::read_to_string(out.join("frames.jsonl")).unwrap();
    fs::write(out.join("frames.jsonl"), &text[..text.len() - 40]).unwrap();
    let ran = sequence("0..1@4", &out);
    assert!(ran.err.contains("1 of 4 frames were made before"), "{}", ran.err);
    assert!(files(&out) == before, "the same bytes");
    let indices: Vec<_> = lines(&out).iter().map(|line| line["index"].as_u64().unwrap()).collect();
    assert_eq!(indices, [0, 1, 2, 3]);
    let ran = sequence("0..1@4", &out);
    assert!(ran.err.contains("4 of 4 frames were made before"), "{}", ran.err);
    // Frames of another command are none of this one's.
    let ran = sequence("0..0.5@4", &out);
    assert!(!ran.err.contains("made before"), "{}", ran.err);
    assert_eq!(lines(&out).len(), 2);
}

#[test]
fn a_scene_that_stands_still_has_times_too() {
    let (_folder, out) = place();
    let mut command = program();
    command.args("render glass-sphere --size 16x16 --set light.side=32 --sequence 0..2@1 --out".split(' ')).arg(&out);
    Ran::from(command.output().unwrap()).ok();
    let layers = |name: &str| Layers::from_exr(&fs::read(out.join(name)).unwrap()).unwrap().0;
    assert_eq!(layers("image.0000.exr"), layers("image.0001.exr"));
    let ran = nephroid("render glass-sphere --sequence 0..1@1 --repeat 3 --out never");
    assert!(ran.code == Some(2) && ran.err.contains("--repeat"), "{}", ran.err);
}

#[test]
fn where_nothing_moves_it_is_said() {
    let still = FRAMES.replace("moving-sphere", "glass-sphere");
    for (time, words) in [("--sequence 0..1@2", "all frames are one picture"), ("--time 2", "at 2 s what it is at 0")] {
        let (_folder, out) = place();
        let ran = nephroid(&format!("{still} {time} --out {}", out.display())).ok();
        assert!(ran.err.contains("warning: nothing in glass-sphere moves") && ran.err.contains(words), "{}", ran.err);
        let (_folder, out) = place();
        let moving = nephroid(&format!("{FRAMES} {time} --out {}", out.display())).ok();
        assert!(!moving.err.contains("nothing in"), "{}", moving.err);
    }
    let [still, moving] = ["glass-sphere", "moving-sphere"].map(|name| nephroid(&format!("scenes {name}")).ok().out);
    assert!(still.contains("stands still") && moving.contains("moves, keys from -0.3 to 0.9 s"), "{still}{moving}");
}
