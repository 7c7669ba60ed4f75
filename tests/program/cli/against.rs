//! `nephroid against`: what changed between two runs of the benches; and `nephroid budget` as it is typed.

use std::fs;

use super::{names, nephroid, place};

fn lines(median: f64, others: &str) -> String {
    let samples: Vec<f64> = (0..20).map(|k| median * (1.0 + 0.001 * f64::from(k * 7 % 11))).collect();
    format!(
        "{{\"schema\": \"nephroid.bench/1\", \"commit\": \"c{median}\", \"lines\": [
         {{\"name\": \"a\", \"unit\": \"ms\", \"samples\": {samples:?}, \"median\": {median}}},
         {{\"name\": \"same\", \"unit\": \"ms\", \"samples\": [1.0, 2.0], \"median\": 1.5}}{others}]}}"
    )
}

#[test]
fn what_changed_is_told_from_noise() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let before = file("before.json", &lines(1.0, ""));
    let gone = ", {\"name\": \"new\", \"unit\": \"ms\", \"samples\": [1.0], \"median\": 1.0}";
    let after = file("after.json", &lines(1.2, gone));
    let report = nephroid(&format!("against {before} {after} --format json")).ok().json();
    assert_eq!(report["schema"], "nephroid.against/1");
    let verdicts: Vec<_> = report["lines"].as_array().unwrap().iter().map(|line| &line["ratio"]["verdict"]).collect();
    assert_eq!(verdicts, ["slower", "no difference shown"], "two samples tell nothing");
    assert_eq!(report["lines"][1]["ratio"]["high"], "infinity", "null would pass for nothing");
    assert_eq!(report["unmatched"], serde_json::json!(["new"]));
    let table = nephroid(&format!("against {before} {after}")).ok();
    assert!(table.out.contains("1.200") && table.out.contains("more"), "{}", table.out);
    for (text, says) in [("{", "line 1"), ("{\"schema\": \"other/2\", \"commit\": \"\", \"lines\": []}", "other/2")] {
        let bad = file("bad.json", text);
        let ran = nephroid(&format!("against {before} {bad}"));
        assert!(ran.code == Some(2) && ran.err.contains("bad.json") && ran.err.contains(says), "{}", ran.err);
    }
    let ran = nephroid(&format!("against {before} {before}.none"));
    assert!(ran.code == Some(2) && ran.err.contains("before.json.none"), "{}", ran.err);
}

const SMALL: &str = "budget glass-sphere --method maps --size 16x16 --photons 20000 --fine 128 --set light.side=64";

#[test]
fn a_budget_is_a_report_and_a_folder_of_pictures() {
    let (_folder, out) = place();
    let report = nephroid(&format!("{SMALL} --format json --out {}", out.display())).ok().json();
    assert_eq!((&report["schema"], &report["light_side"]), (&"nephroid.budget/1".into(), &64.into()));
    let steps = report["steps"].as_array().unwrap();
    let named: Vec<_> = steps.iter().map(|step| &step["name"]).collect();
    assert_eq!(named, ["path class", "tracer", "reconstruction", "light.side"]);
    let shares: f64 = steps.iter().map(|step| step["share"].as_f64().unwrap()).sum();
    assert!((shares - 1.0).abs() < 1e-9);
    assert!(steps.windows(2).all(|pair| pair[0]["to"] == pair[1]["from"]));
    assert_eq!(report["provenance"]["device"]["software"].as_bool().map(|_| ()), Some(()));
    let files = names(&out);
    assert!(
        ["budget.exr", "budget.json", "picture.0.png", "picture.4.png", "step.tracer.png", "whole.png"]
            .iter()
            .all(|name| files.iter().any(|file| file == name)),
        "{files:?}"
    );
}

#[test]
fn a_budget_that_cannot_be_is_refused() {
    let cases = [
        ("--all transmit-2", "expected all:N"),
        ("--fine 99999", "--fine"),
        ("--set light.sid=4", "light.side"),
        ("--until 3", "relmse=X"),
    ];
    for (options, says) in cases {
        let ran = nephroid(&format!("{SMALL} {options}"));
        assert!(ran.code == Some(2) && ran.err.contains(says), "{options}: {:?} {}", ran.code, ran.err);
    }
    let none = nephroid("budget glass-sphere --method none");
    assert_eq!(none.code, Some(2), "{}", none.err);
}
