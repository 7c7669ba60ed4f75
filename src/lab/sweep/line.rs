//! One point as a line of JSON, `nephroid.point/1`.

use serde_json::{Map, Value, json};

use super::{Spec, Sweep};
use crate::{
    gpu::DeviceInfo,
    lab::{
        Comparison, DeviceRow, MEASURES,
        compare::{DEBIASED, FITTED},
        provenance::in_force,
        timing::{Series, Summary},
    },
    metrics::Measure,
    scene::Scene,
    stats::Number,
    store::Key,
};

/// What a line is.
pub const SCHEMA: &str = "nephroid.point/1";

/// What every line has, failed or not.
pub(super) fn begun(sweep: &Sweep, spec: &Spec, key: &Key, device: &DeviceInfo) -> Map<String, Value> {
    let job = &spec.job;
    let line = json!({
        "schema": SCHEMA,
        "key": key.to_string(),
        "scene": job.scene.name,
        "method": spec.method,
        "camera": job.camera,
        "size": job.size,
        "set": set(spec),
        "settings": in_force(job),
        "device": serde_json::to_value(DeviceRow::from(device)).unwrap_or_default(),
        "repeat": sweep.rounds,
        "commit": env!("NEPHROID_COMMIT"),
        "version": env!("CARGO_PKG_VERSION"),
    });
    match line {
        Value::Object(line) => line,
        _ => Map::new(),
    }
}

/// What the point sets, as written.
pub(super) fn set(spec: &Spec) -> Value {
    spec.set.iter().map(|(key, value)| (key.clone(), Value::from(value.clone()))).collect::<Map<_, _>>().into()
}

/// What cost grows with, beside photons and settings; and the device's memory that the point takes.
pub(super) fn scale(scene: &Scene, bytes: u64) -> [(String, Value); 3] {
    let counts = [("lights", scene.lights.len() as u64), ("triangles", scene.triangles()), ("bytes", bytes)];
    counts.map(|(name, count)| (name.to_owned(), count.into()))
}

/// `time` and `stages`, ms.
pub(super) fn times(series: &Series) -> [(&'static str, Value); 2] {
    let named = |stage: &String| {
        let summary = series.stage(stage)?;
        let Value::Object(rest) = time(&summary) else { return None };
        Some(Value::Object([("name".to_owned(), stage.clone().into())].into_iter().chain(rest).collect()))
    };
    let stages = series.stages.iter().filter_map(named).collect();
    [("time", time(&series.span())), ("stages", Value::Array(stages))]
}

fn time(summary: &Summary) -> Value {
    let Summary { median, mad, low, high, samples } = summary;
    let samples: Vec<Value> = samples.iter().map(|ms| Number(*ms).into()).collect();
    json!({ "median": Number(*median), "mad": Number(*mad), "low": Number(*low), "high": Number(*high), "samples": samples })
}

/// What it is off by.
pub(super) fn error(comparison: &Comparison) -> Value {
    let measures = MEASURES.iter().zip(comparison.measures).map(|(name, figure)| (name.to_string(), measure(figure)));
    let mut error = json!({
        "layer": comparison.layer,
        "reference": comparison.reference,
        "measures": measures.collect::<Map<_, _>>(),
    });
    if let Some(fitted) = comparison.fitted {
        error["scale"] = Number(fitted.scale).into();
        error["measures"][FITTED] = measure(fitted.relmse);
    }
    if let Some(debiased) = comparison.debiased {
        error["measures"][DEBIASED] = measure(debiased);
    }
    error
}

/// A figure with its interval.
pub(super) fn measure(figure: Measure) -> Value {
    let parts = [("value", Some(figure.value)), ("low", figure.low), ("high", figure.high)];
    let known = parts.into_iter().chain([("truth_noise", figure.truth_noise)]);
    known.filter_map(|(name, part)| Some((name.to_owned(), Number(part?).into()))).collect::<Map<_, _>>().into()
}
