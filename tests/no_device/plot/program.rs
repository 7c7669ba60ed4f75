//! The program: its files, its exit codes, its messages.

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

use serde_json::{Value, json};

use super::{curve, point, points_file};

fn plot(input: &Path, more: &[&str]) -> Output {
    let out = input.with_file_name("plot.svg");
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
    command.arg("plot").arg(input).arg("--out").arg(out).args(more).output().unwrap()
}

#[track_caller]
fn refused(input: &Path, code: i32, words: &[&str]) {
    let output = plot(input, &[]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{said}");
    words.iter().for_each(|word| assert!(said.contains(word), "{word:?} in {said}"));
    for ending in ["svg", "png", "csv"] {
        assert!(!input.with_file_name("plot").with_extension(ending).exists(), "{ending} of a failed plot");
    }
}

#[test]
fn svg_png_csv_and_report() {
    let (_folder, file) = points_file(&[curve("s", "lines", 1.0), curve("s", "maps", 2.3)].concat());
    let output = plot(&file, &["--format", "json", "--at-ms", "20"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["schema"], &report["kind"]), (&json!("nephroid.plot/1"), &json!("error-time")));
    assert!(report["equal"].as_array().is_some_and(|rows| !rows.is_empty()));
    let svg = fs::read_to_string(file.with_file_name("plot.svg")).unwrap();
    assert!(svg.contains("<metadata>") && svg.contains("points.jsonl"), "no provenance");
    let png = fs::File::open(file.with_file_name("plot.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(png)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    assert!(pixels.chunks(3).any(|p| p[0] < 100) && reader.info().utf8_text[0].keyword == "nephroid");
    assert_eq!(fs::read_to_string(file.with_file_name("plot.csv")).unwrap().lines().count(), 1 + 6);
}

#[test]
fn a_scale_plot_says_what_power_each_part_grows_with() {
    // Twice the side in ten times the time: log 10 over log 4 in photons.
    let (_folder, file) = points_file(&curve("s", "maps", 1.0));
    let output = plot(&file, &["--format", "json", "--kind", "scale"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let growth = report["growth"].as_array().unwrap();
    let panels: Vec<_> = growth.iter().map(|row| row["panel"].as_str().unwrap().rsplit(' ').next().unwrap()).collect();
    assert_eq!(panels, ["frame", "light", "maps"], "no bytes are said, and so no memory is drawn");
    for row in growth {
        let [overall, last] = ["overall", "last"].map(|name| row[name].as_f64().unwrap());
        let power = 10f64.ln() / 4f64.ln();
        assert!((overall - power).abs() < 1e-9 && (last - power).abs() < 1e-9, "{row}");
    }
    let output = plot(&file, &["--kind", "scale", "--along", "lights"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("3"), "no point says its lights");
}

#[test]
fn budgets_and_tables_have_plots_of_their_own() {
    let step = |name: &str, gain: f64| {
        json!({ "name": name, "energy": { "gain": gain, "low": gain, "high": gain },
        "relmse": { "value": 0.1 }, "share": 0.5, "from": "a", "to": "b" })
    };
    let budget = json!({ "schema": "nephroid.budget/1", "scene": "s", "method": "maps", "size": [8, 8],
        "steps": [step("path class", -0.5), step("light side", 0.2)], "whole": step("whole", -0.3) });
    let row = |side: u32| {
        json!({ "row": side.to_string(), "column": "copy", "unit": "ms", "published": 1.0,
        "measured": { "value": 2.0, "low": 1.0, "high": 3.0 }, "ratio": 2.0 })
    };
    let table = json!({ "schema": "nephroid.reproduce/1", "id": "maps.table2", "rows": [row(256), row(512)] });
    for (value, kind, rows) in [(budget, "budget", 3), (table, "cost", 4)] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("result.json");
        fs::write(&file, value.to_string()).unwrap();
        let output = plot(&file, &["--format", "json"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(report["kind"], kind);
        assert_eq!(fs::read_to_string(file.with_file_name("plot.csv")).unwrap().lines().count(), 1 + rows);
    }
}

#[test]
fn nothing_to_plot_is_a_failure_that_says_so() {
    let (_folder, file) = points_file(&[]);
    refused(&file, 1, &["nothing to plot"]);
    let mut company = point("s", "maps", 64, 1.0, json!(0.5));
    company["alone"] = json!(false);
    let (_folder, file) = points_file(&[company]);
    refused(&file, 1, &["1 point left out", "another point ran"]);
    let mut failed = point("s", "maps", 64, 1.0, json!(0.5));
    for gone in ["time", "stages", "error"] {
        failed.as_object_mut().unwrap().remove(gone);
    }
    failed["failed"] = json!("too large for the device");
    let (_folder, file) = points_file(&[failed]);
    refused(&file, 1, &["points.jsonl:1: left out, it failed: too large for the device"]);
    let (folder, file) = points_file(&[]);
    fs::remove_file(&file).unwrap();
    refused(&folder.path().join("points.jsonl"), 1, &["points.jsonl", "cannot be read"]);
}

#[test]
fn a_bad_line_is_named() {
    let mut foreign = point("s", "maps", 64, 1.0, json!(0.5));
    foreign["schema"] = json!("nephroid.point/2");
    let good = point("s", "maps", 64, 1.0, json!(0.5)).to_string();
    let cases = [
        ("{\"schema\": oops".to_owned(), "no JSON"),
        (foreign.to_string(), "nephroid.point/2"),
        ("{\"schema\":\"nephroid.point/1\"}".to_owned(), "missing field"),
        ("\u{0}\u{1}".to_owned(), "no JSON"),
    ];
    for (bad, words) in cases {
        let (_folder, file) = points_file(&[]);
        fs::write(&file, format!("{good}\n\n{bad}\n")).unwrap();
        refused(&file, 1, &["points.jsonl:3:", words]);
    }
}
