//! The command, from outside.

use std::process::{Command, Output};

use nephroid::lab::papers;
use serde_json::Value;

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
    assert_eq!(entries.len() - idle.len(), 5, "tables 1 to 4 and Fig. 7 of maps run");
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
