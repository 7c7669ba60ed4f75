//! What is in the store counts while it is whole and of this very content; what is not is told, and the rest stays.

use std::{
    fs,
    io::{BufRead, BufReader},
    ops::ControlFlow,
    process::{Command, Stdio},
    time::Duration,
};

use nephroid::{
    gpu::Sources,
    lab::sweep::{Bench, Host, POINTS, State, Sweep},
    store::{Key, Store},
};

use super::{Place, Ran};

const FOUR: &str = "reference = \"none\"\n[set]\nlight.side = [4, 8]\nmaps.side = [4, 8]\n";

/// Of each point, whether it is done.
fn done(bench: &Bench) -> Vec<bool> {
    (0..bench.sweep.count()).map(|at| matches!(bench.state(at), State::Done(_))).collect()
}

#[test]
fn a_changed_shader_concerns_the_points_that_use_it_alone() {
    let place =
        Place::warm("reference = \"none\"\n[set]\nlight.side = [4, 8]\nlight.tracer = [\"bvh\", \"wyman2005\"]\n");
    let (gpu, sweep) = (crate::common::gpu(), Sweep::load(place.file.to_str().unwrap()).unwrap());
    let store = Store::at(place.store());
    let host = Host::new(&place.store()).unwrap();
    let mut bench = Bench { sweep: &sweep, gpu: &gpu, sources: Sources::default(), store };
    let go_on = || ControlFlow::Continue(());
    for at in 0..sweep.count() {
        assert_eq!(bench.work(at, &host, Duration::ZERO, &go_on).unwrap(), None);
    }
    assert_eq!(done(&bench), [true; 4]);
    for (file, expected) in [
        ("light/far_wyman2005.glsl", [true, false, true, false]), // included by one tracer
        ("maps/resolve.comp", [false; 4]),
        ("passes/show.frag", [true; 4]), // of the window
    ] {
        let text = Sources::default().text(file).unwrap_or_else(|| panic!("{file}")).to_owned();
        bench.sources = Sources::default();
        bench.sources.replace(file, format!("{text}\n// changed\n"));
        assert_eq!(done(&bench), expected, "{file}");
    }
    // Done with the changed shader, they are other points; the first ones stay.
    bench.work(0, &host, Duration::ZERO, &go_on).unwrap();
    bench.sources = Sources::default();
    assert_eq!(done(&bench), [true; 4]);
    crate::common::assert_quiet(&gpu);
}

#[test]
fn settings_of_another_method_make_no_points() {
    let place = Place::new("");
    let axes = "light.side = [4, 8]\nmaps.side = [4, 8]\nlight.area_samples = [1, 2]\nwaves.variant = [\"pixel\", \"inverse\", \"texture\"]\neye.samples = [1, 2]\n";
    let text = fs::read_to_string(&place.file).unwrap().replace("[\"maps\"]", "[\"maps\", \"waves\", \"none\"]");
    fs::write(&place.file, format!("{text}reference = \"none\"\n[set]\n{axes}")).unwrap();
    let sweep = Sweep::load(place.file.to_str().unwrap()).unwrap();
    assert_eq!(sweep.count(), 2 * (2 * (2 * 2 + 3) + 1));
    let named = |key: &str| (0..sweep.count()).filter(|at| sweep.words(*at).contains(key)).count();
    let keys = ["maps.side", "light.side", "waves.variant", "light.area_samples"];
    assert_eq!(keys.map(named), [16, 16, 12, 28], "points of maps, of waves, and of both");
}

#[test]
fn damaged_and_foreign_points_are_told_and_done_again() {
    let place = Place::warm(FOUR);
    place.run("run").code(0);
    let (entries, before) = (place.entries(), place.merged());
    assert_eq!(before.len(), 4);

    // Cut short, as by a power cut; and whole, of a program to come.
    let whole = fs::read(&entries[0]).unwrap();
    fs::write(&entries[0], &whole[..whole.len() / 2]).unwrap();
    let key = before.iter().map(|line| line["key"].as_str().unwrap()).find(|key| entries[1].ends_with(key)).unwrap();
    let store = Store::at(place.store());
    let key: Key = store.list(POINTS).iter().map(|entry| entry.key).find(|k| k.to_string() == key).unwrap();
    store.put(POINTS, &key, br#"{"schema":"nephroid.point/9"}"#);
    let rest = || entries[2..].iter().map(|path| fs::read(path).unwrap()).collect::<Vec<_>>();
    let kept = rest();

    let named = [&entries[0], &entries[1]].map(|path| path.to_string_lossy().into_owned());
    let out = place.folder.path().join("again");
    let merge = format!("merge --out {}", out.display());
    let told = [&named[0], "damaged", &named[1], "nephroid.point/9", "2 of 4 points are missing"];
    place.run(&merge).code(1).says(&told);
    assert!(!out.exists(), "merged in part");
    place.run(&format!("{merge} --partial")).code(0).says(&told);
    assert_eq!(fs::read_to_string(out.join("points.jsonl")).unwrap().lines().count(), 2);
    place.run("run").code(0).says(&["is done again"]);
    assert!(rest() == kept, "whole points were done again");
    assert_eq!(place.merged().len(), 4);

    place.run("clean").code(0).says(&["removed: 4 of 4"]);
    assert!(place.entries().is_empty());
}

#[test]
fn points_that_are_the_same_are_done_once() {
    // 512 is the default of maps.side.
    let place = Place::warm("reference = \"none\"\n[set]\nlight.side = [4, 4]\nmaps.side = [512, 512, 64]\n");
    let ran = place.run("run --format json").code(0);
    let status: serde_json::Value = serde_json::from_str(&ran.out).unwrap();
    assert_eq!((&status["points"], &status["repeated"], &status["done"]), (&2.into(), &4.into(), &2.into()));
    assert_eq!((place.merged().len(), place.entries().len()), (2, 2));
}

#[test]
fn a_point_that_fails_is_told_and_the_rest_goes_on() {
    let place = Place::warm(
        "reference = \"none\"\n[set]\nlight.side = [4, 16384]\nlight.tracer = \"wyman2005\"\nlight.paths = [\"transmit-2\", \"all:2\"]\n",
    );
    let ran = place.run("run --format csv").code(1).says(&["failed: glass-sphere maps", "points failed"]);
    assert!(ran.out.contains("1/1"), "{}", ran.out);
    let points = place.merged();
    let failed = |point: &&serde_json::Value| point["failed"].is_string() && point.get("time").is_none();
    assert_eq!(points.len(), 4);
    assert!((2..4).contains(&points.iter().filter(failed).count()), "{points:#?}");
}

#[cfg(unix)]
#[test]
fn a_full_disk_loses_the_point_in_hand_alone() {
    let place = Place::warm(FOUR);
    // Its SPIR-V is there before the disk is full, and one half of the points.
    place.run("run --shard 1/2").code(0);
    let kept = place.entries();
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -f 1; exec \"$0\" \"$@\""]).arg(env!("CARGO_BIN_EXE_nephroid"));
    command.args(["sweep", "run"]).arg(&place.file).env("NEPHROID_CACHE", place.store());
    let ran: Ran = command.output().unwrap().into();
    ran.code(1).says(&["cannot write to the store", "store/point/", "NEPHROID_CACHE"]);
    assert_eq!(place.entries(), kept);
    place.run("run").code(0);
    assert_eq!(place.merged().len(), 4);
}

#[test]
fn a_store_that_cannot_be_written_is_an_error_before_anything_is_rendered() {
    let place = Place::new(FOUR);
    fs::write(place.store(), "a file of the user's").unwrap();
    let ran = place.run("run").code(1).says(&["cannot write to the store", "NEPHROID_CACHE"]);
    assert!(!ran.err.contains("device:"), "{}", ran.err);
    // What only reads says what is missing.
    place.run("merge").code(1).says(&["4 of 4 points are missing"]);
    assert_eq!(fs::read_to_string(place.store()).unwrap(), "a file of the user's");
}

#[cfg(unix)]
#[test]
fn an_interrupted_sweep_keeps_what_is_done() {
    let place = Place::warm("reference = \"none\"\n[set]\nlight.side = [4, 4096]\nlight.paths = \"all:4\"\n");
    let text = fs::read_to_string(&place.file).unwrap().replace("rounds = 2", "rounds = 1000000");
    fs::write(&place.file, text).unwrap();
    let mut child = place.command("run").stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let mut said = BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(said.next().unwrap().unwrap().starts_with("device:"));
    assert!(Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap().success());
    let rest: Vec<String> = said.map(|line| line.unwrap()).collect();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(rest.iter().any(|line| line.contains("interrupted after 0 of 2 points")), "{rest:?}");
}
