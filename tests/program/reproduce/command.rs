//! The command, from outside.

use std::{
    fs,
    io::{BufRead, BufReader},
    process::{Command, Output, Stdio},
    time::{Duration, Instant},
};

use nephroid::lab::papers;
use serde_json::Value;

/// For what takes some seconds, on a machine where others work.
const AMPLE: Duration = Duration::from_secs(60);

fn reproduce(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
    command.arg("reproduce").args(arguments).output().expect("the program runs")
}

fn json(arguments: &[&str]) -> Value {
    let output = reproduce(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON on stdout")
}

#[test]
fn every_id_that_cannot_run_says_what_is_missing() {
    let list = json(&["list", "--format", "json"]);
    let entries = list["entries"].as_array().unwrap();
    assert_eq!(entries.len(), papers::all().len());
    let idle: Vec<&str> = entries.iter().filter(|e| e["runs"] == 0).map(|e| e["id"].as_str().unwrap()).collect();
    assert_eq!(
        entries.len() - idle.len(),
        9,
        "tables 1 to 5, Fig. 7 and the prose of maps, and Fig. 9 and the prose of waves run"
    );
    for id in idle {
        let report = json(&[id, "--quick", "--format", "json"]);
        assert!(report["device"].is_null() && report["scene"].is_null());
        for row in report["rows"].as_array().unwrap() {
            assert!(row["measured"].is_null() && row["missing"].as_str().is_some_and(|why| !why.is_empty()), "{row}");
        }
    }
}

#[test]
fn what_is_typed_wrongly_is_said() {
    for (arguments, what) in [
        (&["maps.tabel1"][..], "`maps.table1`"),
        (&["maps.table1", "--max-seconds=soon"], "number of seconds"),
        (&["maps.table1", "--quick", "--max-seconds", "5"], "cannot be used with"),
        (&["maps.table1", "--device", "no such", "--quick"], "no such"),
    ] {
        let output = reproduce(arguments);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        let expected = if arguments.contains(&"--device") { 4 } else { 2 };
        assert_eq!(output.status.code(), Some(expected), "{arguments:?}: {text}");
        assert!(text.contains(what) && output.stdout.is_empty(), "{arguments:?}: {text}");
    }
}

/// A second is less than the rounds of the smallest N take: they end early, what they gave is kept and said to be less.
#[test]
fn time_that_is_up_ends_rounds_and_the_files_say_so() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let started = Instant::now();
    let report = json(&["maps.table2", "--max-seconds", "1", "--format", "json", "--out", out.to_str().unwrap()]);
    assert!(started.elapsed() < AMPLE, "{:?}", started.elapsed());
    let repeats = report["repeats"].as_u64().unwrap();
    assert!((1..15).contains(&repeats), "{repeats}");
    let said = report["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap());
    assert!(
        said.clone().any(|w| w.contains(&format!("after {repeats} of 15 rounds"))),
        "{:?}",
        said.collect::<Vec<_>>()
    );
    assert!(report["rows"].as_array().unwrap().iter().any(|row| row["measured"]["value"].is_number()));
    let mut names: Vec<_> =
        fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(
        names,
        ["copy-16-16-256.png", "copy-16-32-256.png", "copy-32-32-256.png", "maps.table2.json", "maps.table2.svg"]
    );
    let written: Value = serde_json::from_slice(&fs::read(out.join("maps.table2.json")).unwrap()).unwrap();
    assert_eq!(written, report);
}

#[test]
fn an_interrupt_leaves_no_file() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
    command.args(["reproduce", "maps.table2", "--quick", "--out"]).arg(&out);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut said = BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(said.any(|line| line.unwrap().starts_with("timing")), "it began");
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let started = Instant::now();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", said.map_while(Result::ok).collect::<String>());
    assert!(started.elapsed() < AMPLE && output.stdout.is_empty() && !out.exists());
}
