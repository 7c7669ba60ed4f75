//! `nephroid.against/1`: what changed between two runs of the benches, and by how much beyond noise.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{
    Cell, Report, Table,
    timing::{Ratio, Verdict},
};
use crate::stats::{self, CONFIDENCE};

/// What `scripts/bench` writes.
const SCHEMA: &str = "nephroid.bench/1";

/// Why two results cannot be compared.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // the messages say it
pub enum AgainstError {
    #[error("cannot read {file}: {reason}")]
    Read { file: String, reason: std::io::Error },
    #[error("{file}: {reason}: name a lines.json that scripts/bench has written")]
    Form { file: String, reason: String },
}

/// The lines of one run.
#[derive(Debug, Deserialize)]
pub struct BenchLines {
    schema: String,
    commit: String,
    lines: Vec<BenchLine>,
}

#[derive(Debug, Deserialize)]
struct BenchLine {
    name: String,
    unit: String,
    samples: Vec<f64>,
}

/// The result.
#[derive(Debug, Serialize)]
pub struct AgainstReport {
    schema: &'static str,
    before: String,
    after: String,
    lines: Vec<Change>,
    /// Names of lines that one of the two lacks.
    unmatched: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Change {
    name: String,
    unit: String,
    before: f64,
    after: f64,
    ratio: Ratio,
}

impl BenchLines {
    /// Reads a file.
    ///
    /// # Errors
    /// [`AgainstError`] with the file, and where it is wrong.
    pub fn read(path: &Path) -> Result<Self, AgainstError> {
        let file = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|reason| AgainstError::Read { file: file.clone(), reason })?;
        let form = |reason: String| AgainstError::Form { file: file.clone(), reason };
        let lines: Self = serde_json::from_str(&text).map_err(|reason| form(reason.to_string()))?;
        if lines.schema == SCHEMA {
            Ok(lines)
        } else {
            Err(form(format!("schema {}, where {SCHEMA} is read", lines.schema)))
        }
    }
}

impl AgainstReport {
    /// Line by line, by name.
    pub fn new(before: &BenchLines, after: &BenchLines) -> Self {
        let partner =
            |line: &BenchLine| before.lines.iter().find(|other| other.name == line.name && other.unit == line.unit);
        let change = |new: &BenchLine| partner(new).map(|old| Change::of(old, new));
        let lacks = |side: &BenchLines, line: &&BenchLine| !side.lines.iter().any(|other| other.name == line.name);
        let unmatched = before.lines.iter().filter(|line| lacks(after, line));
        let unmatched = unmatched.chain(after.lines.iter().filter(|line| lacks(before, line)));
        Self {
            schema: "nephroid.against/1",
            before: before.commit.clone(),
            after: after.commit.clone(),
            lines: after.lines.iter().filter_map(change).collect(),
            unmatched: unmatched.map(|line| line.name.clone()).collect(),
        }
    }
}

impl Change {
    fn of(before: &BenchLine, after: &BenchLine) -> Self {
        Self {
            name: after.name.clone(),
            unit: after.unit.clone(),
            before: stats::median(&before.samples),
            after: stats::median(&after.samples),
            ratio: Ratio::of(stats::bootstrap_change(&before.samples, &after.samples, CONFIDENCE, 0)),
        }
    }
}

impl Report for AgainstReport {
    fn heading(&self) -> Vec<String> {
        vec![format!("{} against {}: medians, and their ratio at 99 %", self.after, self.before)]
    }

    fn tables(&self) -> Vec<Table> {
        let columns = vec!["line", "unit", "before", "after", "ratio", "low", "high", "change"];
        let row = |c: &Change| {
            let verdict = match c.ratio.verdict {
                Verdict::Slower => "more",
                Verdict::Faster => "less",
                Verdict::None => "no difference shown",
            };
            let real = |x: f64| Cell::Real(x, 3);
            let interval = c.ratio.interval;
            let [ratio, low, high] = [interval.value, interval.low, interval.high].map(real);
            let (name, unit) = (Cell::text(&c.name), Cell::text(&c.unit));
            vec![name, unit, real(c.before), real(c.after), ratio, low, high, Cell::text(verdict)]
        };
        vec![Table { name: "lines", columns, rows: self.lines.iter().map(row).collect() }]
    }

    fn notes(&self) -> Vec<String> {
        self.unmatched.iter().map(|name| format!("{name}: in one of the two alone")).collect()
    }
}
