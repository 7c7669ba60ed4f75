//! `nephroid.sweep/1`: what of a sweep is done, by shard.

use serde::Serialize;
use serde_json::Value;

use super::{Bench, POINTS, SCHEMA, Shard};
use crate::{
    lab::{Cell, DeviceRow, Report, Table},
    store::Key,
};

/// How a point stands in the store.
#[derive(Clone, Debug, PartialEq)]
pub enum State {
    /// Its line.
    Done(Value),
    /// Its line, which says why.
    Failed(Value),
    /// Not there.
    Missing,
    /// There, and of no use: why, and where.
    Unusable(String),
}

impl Bench<'_> {
    /// Looks a point up, by what it would be made from now.
    pub fn state(&self, at: usize) -> State {
        let (key, _) = self.plan(&self.sweep.points[at]);
        self.stored(&key)
    }

    fn stored(&self, key: &Key) -> State {
        let place = self.store.file(POINTS, key).unwrap_or_default();
        let unusable = |why: &str| State::Unusable(format!("{}: {why}: it counts as missing", place.display()));
        let Some(bytes) = self.store.get(POINTS, key) else {
            return if place.exists() { unusable("damaged or unreadable") } else { State::Missing };
        };
        let Ok(line) = serde_json::from_slice::<Value>(&bytes) else { return unusable("no line of JSON") };
        match line.get("schema").and_then(Value::as_str) {
            Some(SCHEMA) if line.get("failed").is_some() => State::Failed(line),
            Some(SCHEMA) => State::Done(line),
            other => unusable(&format!("{}, where this program reads {SCHEMA}", other.unwrap_or("no schema"))),
        }
    }

    /// Removes this sweep's points from the store, and says how many there were. A point that another sweep asks for too
    /// is the same point.
    ///
    /// # Errors
    /// The system's, with the folder.
    pub fn clean(&self) -> Result<usize, super::SweepError> {
        let mut removed = 0;
        for spec in &self.sweep.points {
            let (key, _) = self.plan(spec);
            let path = self.store.file(POINTS, &key).unwrap_or_default();
            let gone = self.store.remove(POINTS, &key);
            removed += usize::from(gone.map_err(|reason| super::SweepError::Store { path, reason })?);
        }
        Ok(removed)
    }
}

/// What is done.
#[derive(Debug, Serialize)]
pub struct Status {
    schema: &'static str,
    sweep: String,
    file: String,
    device: DeviceRow,
    points: usize,
    repeated: usize,
    done: usize,
    failed: Vec<Reason>,
    missing: usize,
    shards: Vec<Row>,
    /// What is in the store and of no use.
    pub warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Reason {
    point: String,
    reason: String,
}

#[derive(Debug, Default, Serialize)]
struct Row {
    shard: String,
    points: usize,
    done: usize,
    failed: usize,
    missing: usize,
}

impl Status {
    /// Of some shards.
    pub fn new(bench: &Bench, shards: &[Shard]) -> Self {
        let sweep = bench.sweep;
        let mut status = Self {
            schema: "nephroid.sweep/1",
            sweep: sweep.name.clone(),
            file: sweep.file.clone(),
            device: bench.gpu.info().into(),
            points: sweep.count(),
            repeated: sweep.repeated,
            done: 0,
            failed: Vec::new(),
            missing: 0,
            shards: Vec::new(),
            warnings: Vec::new(),
        };
        for &shard in shards {
            let name = format!("{}/{}", shard.index + 1, shard.of);
            let mut row = Row { shard: name, ..Row::default() };
            for at in shard.points(sweep.count()) {
                row.points += 1;
                status.count(&mut row, sweep.words(at), bench.state(at));
            }
            status.done += row.done;
            status.missing += row.missing;
            status.shards.push(row);
        }
        status
    }

    fn count(&mut self, row: &mut Row, point: String, state: State) {
        match state {
            State::Done(_) => row.done += 1,
            State::Failed(line) => {
                row.failed += 1;
                let reason = line["failed"].as_str().unwrap_or_default().to_owned();
                self.failed.push(Reason { point, reason });
            }
            State::Missing => row.missing += 1,
            State::Unusable(why) => {
                row.missing += 1;
                self.warnings.push(why);
            }
        }
    }

    /// Points that failed.
    pub fn failures(&self) -> usize {
        self.failed.len()
    }
}

impl Report for Status {
    fn heading(&self) -> Vec<String> {
        let software = if self.device.software { ", a software device: its times are not those of a GPU" } else { "" };
        vec![format!("{}: {} points on {}{software}", self.file, self.points, self.device.name)]
    }

    fn tables(&self) -> Vec<Table> {
        let row = |row: &Row| {
            let counts = [row.points, row.done, row.failed, row.missing].map(|n| Cell::Count(n as u64));
            [Cell::text(&row.shard)].into_iter().chain(counts).collect()
        };
        let columns = vec!["shard", "points", "done", "failed", "missing"];
        vec![Table { name: "shards", columns, rows: self.shards.iter().map(row).collect() }]
    }

    fn notes(&self) -> Vec<String> {
        let failed = self.failed.iter().map(|f| format!("failed: {}: {}", f.point, f.reason));
        let repeated = (self.repeated > 0).then(|| format!("{} more are the same as one before", self.repeated));
        repeated.into_iter().chain(failed).collect()
    }
}
