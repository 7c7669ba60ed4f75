//! `nephroid truth` as a user runs it: killed, resumed, found again, refused.
#![cfg(unix)]

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
    thread::sleep,
    time::Duration,
};

use nephroid::image::Layers;
use tempfile::TempDir;

/// A run of some seconds in a debug build: 64 chunks.
const LONG: &str = "truth glass-sphere --camera region --size 32x32 --photons 2000000";
const SHORT: &str = "truth glass-sphere --camera region --size 16x16 --photons 20000";

/// The program with a store of its own.
fn command(line: &str, folder: &Path, out: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
    command.args(line.split(' ')).env("NEPHROID_CACHE", folder.join("cache")).current_dir(folder);
    if !out.is_empty() {
        command.args(["-o", out]);
    }
    command
}

fn run(line: &str, folder: &TempDir, out: &str) -> Output {
    command(line, folder.path(), out).output().unwrap()
}

fn error(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn killed_twenty_times_it_ends_with_the_same_bytes() {
    for (how, photons) in [("photons", "6000000"), ("cells", "40000")] {
        let line = LONG.replace("2000000", photons) + " --estimator " + how;
        let (straight, broken) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        assert!(run(&line, &straight, "t.exr").status.success());
        let resumed = format!("{line} --resume");
        let (mut killed, mut before) = (0, 0);
        for k in 0..20u64 {
            let mut child = command(&resumed, broken.path(), "t.exr").stderr(Stdio::piped()).spawn().unwrap();
            sleep(Duration::from_millis(60 + k * 37 % 160));
            killed += u32::from(child.try_wait().unwrap().is_none());
            child.kill().unwrap();
            // What it went on from is never less than what the one before went on from: nothing that was kept is lost.
            let said = error(&child.wait_with_output().unwrap());
            let from =
                said.split("going on after ").nth(1).and_then(|rest| rest.split(' ').next()?.parse::<u64>().ok());
            assert!(from.unwrap_or(before) >= before, "{how}: {from:?} after {before}: {said}");
            before = from.unwrap_or(before);
        }
        assert!(before > 0, "{how}: twenty runs, and none went on from what was done before");
        println!("{how}: killed {killed} times");
        // Where a machine is so fast that it finishes between kills, those that came before count.
        assert!(killed >= 1, "{how}: finished before the first kill");
        let last = run(&resumed, &broken, "t.exr");
        assert!(last.status.success(), "{}", error(&last));
        let read = |folder: &TempDir| fs::read(folder.path().join("t.exr")).unwrap();
        assert!(read(&straight) == read(&broken), "{how}: killed {killed} times, other bytes came out");
        assert!(!broken.path().join("t.exr.partial").exists());
    }
}

#[test]
fn a_finished_truth_is_listed_reused_and_cleared() {
    let folder = tempfile::tempdir().unwrap();
    assert!(run(SHORT, &folder, "a.exr").status.success());
    let again = run(SHORT, &folder, "b.exr");
    assert!(again.status.success() && error(&again).contains("made before"), "{}", error(&again));
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("a.exr") == read("b.exr"));
    let listed = String::from_utf8(run("truth --list", &folder, "").stdout).unwrap();
    assert!(
        listed.lines().count() == 2 && listed.contains("glass-sphere  photons  transmit-2  region  16x16"),
        "{listed}"
    );
    assert_eq!(run("truth --clear", &folder, "").stdout, b"1 removed\n");
    assert_eq!(String::from_utf8(run("truth --list", &folder, "").stdout).unwrap().lines().count(), 1);
}

/// A run killed between its last two steps leaves its finished truth and the sums as well.
#[test]
fn sums_that_a_finished_truth_leaves_behind_go_with_the_next_run() {
    let folder = tempfile::tempdir().unwrap();
    let line = SHORT.replace("20000", "400000");
    assert!(run(&format!("{line} --max-seconds 0"), &folder, "b.exr").status.success());
    assert!(run(&line, &folder, "a.exr").status.success());
    let sums = folder.path().join("b.exr.partial");
    assert!(sums.exists());
    let again = run(&line, &folder, "b.exr");
    assert!(again.status.success() && error(&again).contains("made before"), "{}", error(&again));
    assert!(!sums.exists());
    // Those of another task stay.
    fs::write(&sums, "of another").unwrap();
    assert!(run(&line, &folder, "b.exr").status.success());
    assert!(sums.exists());
}

#[test]
fn the_file_says_what_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let line = format!("{SHORT} --paths all:3 --seed 9 --set scene.materials.glass.ior=1.4");
    assert!(run(&line, &folder, "a.exr").status.success());
    let (layers, about) = Layers::from_exr(&fs::read(folder.path().join("a.exr")).unwrap()).unwrap();
    let mut names: Vec<_> = layers.iter().map(|l| l.name()).collect();
    names.sort_unstable();
    let both = ["irradiance.caustic", "irradiance.caustic.variance", "irradiance.direct", "irradiance.direct.variance"];
    assert_eq!(names, [&both[..], &["mask"]].concat());
    for (name, text) in [("kind", "truth"), ("paths", "all:3"), ("seed", "9"), ("camera", "region"), ("e0", "1e0")] {
        assert_eq!(about.get(name).map(String::as_str), Some(text), "{name}");
    }
    assert!(layers.iter().all(|l| l.data().iter().all(|x| x.is_finite())));
    assert!(about["noise.relmse"].parse::<f64>().unwrap() > 0.0);
}

#[test]
fn stopped_by_the_clock_it_writes_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let first = run(&format!("{LONG} --max-seconds 0"), &folder, "t.exr");
    assert!(first.status.success() && error(&first).contains("not finished"), "{}", error(&first));
    let second = run(&format!("{LONG} --max-seconds 0 --resume"), &folder, "t.exr");
    assert!(error(&second).contains("going on after"), "{}", error(&second));
    // Another noise asked for is the same photons.
    let lower = run(&format!("{LONG} --max-seconds 0 --resume --until relmse=1e-9"), &folder, "t.exr");
    assert!(lower.status.success() && error(&lower).contains("going on after"), "{}", error(&lower));
    // Another task does not take what this one left, and does not write over it; nor does one that does not ask for it.
    let kept = fs::read(folder.path().join("t.exr.partial")).unwrap();
    for (more, code, words) in [
        ("--resume --estimator cells", 1, "of another task"),
        ("--resume --seed 1", 1, "of another task"),
        ("", 2, "--resume"),
    ] {
        let other = run(format!("{LONG} --max-seconds 0 {more}").trim(), &folder, "t.exr");
        assert!(other.status.code() == Some(code) && error(&other).contains(words), "{more}: {}", error(&other));
        assert!(fs::read(folder.path().join("t.exr.partial")).unwrap() == kept, "{more}");
    }
}

#[test]
fn what_cannot_be_done_is_said() {
    let folder = tempfile::tempdir().unwrap();
    for (line, code, words) in [
        ("truth glass-sphere --camera nowhere", 2, "choose one of `main`, `region`"),
        ("truth glass-sphere --until mse=1", 2, "relmse=X"),
        ("truth glass-sphere --paths some", 2, "reflect-1"),
        ("truth glass-sphere --estimator guess", 2, "choose one of `photons`, `cells`"),
        ("truth glass-sphere --set light.side=4", 2, "scene.PATH=VALUE"),
        ("truth nothing-of-the-kind", 2, "nothing-of-the-kind"),
    ] {
        let output = run(line, &folder, "t.exr");
        assert!(output.status.code() == Some(code) && error(&output).contains(words), "{line}: {}", error(&output));
    }
    fs::create_dir(folder.path().join("place")).unwrap();
    let place = run(SHORT, &folder, "place");
    assert!(place.status.code() == Some(2) && error(&place).contains("a folder"), "{}", error(&place));
    let nowhere = run(SHORT, &folder, "missing/t.exr");
    assert!(nowhere.status.code() == Some(1) && error(&nowhere).contains("missing"), "{}", error(&nowhere));
}

#[test]
fn without_specular_objects_there_is_direct_light_alone() {
    let folder = tempfile::tempdir().unwrap();
    let output = run("truth diffuse --camera region --size 16x16", &folder, "t.exr");
    assert!(output.status.success(), "{}", error(&output));
    let (layers, _) = Layers::from_exr(&fs::read(folder.path().join("t.exr")).unwrap()).unwrap();
    assert!(layers.get("irradiance.caustic").is_none() && layers.get("irradiance.direct").is_some());
}

/// Ctrl-C is heard while direct light is sampled, before there is anything to keep.
#[test]
fn an_interrupt_is_heard_from_the_start() {
    let folder = tempfile::tempdir().unwrap();
    let line = "truth bunny --camera region --size 4096x4096 --photons 10";
    let child = command(line, folder.path(), "t.exr").stderr(Stdio::piped()).spawn().unwrap();
    sleep(Duration::from_millis(700));
    let started = std::time::Instant::now();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", error(&output));
    assert!(started.elapsed() < Duration::from_secs(5), "{:?}", started.elapsed());
    assert!(!folder.path().join("t.exr").exists());
}
