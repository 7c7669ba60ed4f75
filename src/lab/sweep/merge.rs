//! All points of a sweep in one file, in the sweep's order.

use std::{collections::BTreeSet, io};

use serde_json::Value;

use super::{Bench, State, line};

/// What was put together, and what is not there.
pub struct Merged {
    /// A line each, as they will be written.
    pub lines: Vec<Value>,
    /// Points without a line, in words.
    pub missing: Vec<String>,
    /// Points that failed.
    pub failed: usize,
    /// What is in the store and of no use.
    pub warnings: Vec<String>,
}

/// Looks all points up.
pub fn merge(bench: &Bench) -> Merged {
    let mut merged = Merged { lines: Vec::new(), missing: Vec::new(), failed: 0, warnings: Vec::new() };
    for (at, spec) in bench.sweep.points.iter().enumerate() {
        let line = match bench.state(at) {
            State::Done(line) => Some(line),
            State::Failed(line) => {
                merged.failed += 1;
                Some(line)
            }
            State::Missing => None,
            State::Unusable(why) => {
                merged.warnings.push(why);
                None
            }
        };
        match line {
            // Another sweep may have made it, with settings of other names.
            Some(mut line) => {
                line["set"] = line::set(spec);
                merged.lines.push(line);
            }
            None => merged.missing.push(bench.sweep.words(at)),
        }
    }
    merged
}

/// Columns beside what points set: a name, and where in a line it stands.
const COLUMNS: [(&str, &str); 25] = [
    ("photons", "/photons"),
    ("lights", "/lights"),
    ("triangles", "/triangles"),
    ("bytes", "/bytes"),
    ("kept", "/kept"),
    ("device", "/device/name"),
    ("device kind", "/device/kind"),
    ("repeat", "/repeat"),
    ("median ms", "/time/median"),
    ("MAD ms", "/time/mad"),
    ("low ms", "/time/low"),
    ("high ms", "/time/high"),
    ("alone", "/alone"),
    ("relmse", "/error/measures/relmse/value"),
    ("relmse low", "/error/measures/relmse/low"),
    ("relmse high", "/error/measures/relmse/high"),
    ("relmse debiased", "/error/measures/relmse_debiased/value"),
    ("relmse debiased error", "/error/measures/relmse_debiased/truth_noise"),
    ("relmse fitted", "/error/measures/relmse_fitted/value"),
    ("scale", "/error/scale"),
    ("energy ratio", "/error/measures/energy_ratio/value"),
    ("flip", "/error/measures/flip/value"),
    ("flicker", "/error/measures/flicker/value"),
    ("reference", "/error/reference"),
    ("failed", "/failed"),
];

impl Merged {
    /// A line a point.
    pub fn json_lines(&self) -> String {
        self.lines.iter().map(|line| format!("{line}\n")).collect()
    }

    /// A row a point; what is not there is empty.
    ///
    /// # Errors
    /// The encoder's; none is expected.
    pub fn csv(&self) -> io::Result<Vec<u8>> {
        let keys = |line: &Value| {
            line["set"].as_object().into_iter().flatten().map(|(key, _)| key.clone()).collect::<Vec<_>>()
        };
        let set: BTreeSet<String> = self.lines.iter().flat_map(keys).collect();
        let mut writer = csv::Writer::from_writer(Vec::new());
        let first = ["scene", "method", "camera", "width", "height"].map(str::to_owned);
        let names = COLUMNS.iter().map(|(name, _)| name.to_string());
        writer.write_record(first.into_iter().chain(set.iter().cloned()).chain(names))?;
        for line in &self.lines {
            let at = |place: &str| line.pointer(place).map(text).unwrap_or_default();
            let first = ["/scene", "/method", "/camera", "/size/0", "/size/1"].map(at);
            let set = set.iter().map(|key| text(&line["set"][key]));
            writer.write_record(first.into_iter().chain(set).chain(COLUMNS.iter().map(|(_, place)| at(place))))?;
        }
        writer.into_inner().map_err(|error| error.into_error())
    }
}

fn text(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
