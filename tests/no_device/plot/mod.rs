//! Plots: what is read, what is drawn, what is said, and that nothing collides. No device is needed.

mod drawn;
mod equal;
mod program;

use std::path::PathBuf;

use nephroid::lab::plot::{Chart, Kind, Results, chart};
use serde_json::{Value, json};
use tempfile::TempDir;

/// A point of a sweep on a software device, its intervals 10 % of the time and 20 % of the error to either side.
fn point(scene: &str, method: &str, side: u64, time: f64, error: Value) -> Value {
    let error = match error.as_f64() {
        Some(value) => json!({ "value": value, "low": 0.8 * value, "high": 1.2 * value }),
        None => json!({ "value": error }),
    };
    json!({
        "schema": "nephroid.point/1", "key": format!("{scene} {method} {side} {time} {error}"), "scene": scene,
        "method": method, "camera": "region", "size": [64, 64], "set": { "light.side": side.to_string() },
        "settings": {}, "photons": side * side, "device": { "name": "llvmpipe", "kind": "software" }, "repeat": 5,
        "time": { "median": time, "mad": 0.0, "low": 0.9 * time, "high": 1.1 * time, "samples": [time] },
        "stages": [{ "name": "light/photons", "median": 0.25 * time }, { "name": "maps/gather", "median": 0.5 * time }],
        "error": { "layer": "irradiance.caustic", "measures": { "relmse": error } }, "alone": true, "commit": "c",
    })
}

/// Error falling as the inverse of time, `error` at 1 ms.
fn curve(scene: &str, method: &str, error: f64) -> Vec<Value> {
    let of = |(at, time): (u32, f64)| point(scene, method, 64 << at, time, json!(error / time));
    [1.0, 10.0, 100.0].into_iter().enumerate().map(|(at, time)| of((at as u32, time))).collect()
}

/// A folder with these points, one a line.
fn points_file(points: &[Value]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("points.jsonl");
    std::fs::write(&file, points.iter().map(|point| format!("{point}\n")).collect::<String>()).unwrap();
    (folder, file)
}

fn results(points: &[Value]) -> Results {
    let (_folder, file) = points_file(points);
    Results::read(&[file]).unwrap()
}

fn chart_of(points: &[Value], kind: Kind) -> Chart {
    chart(&results(points), Some(kind), "relmse", "photons").unwrap()
}
