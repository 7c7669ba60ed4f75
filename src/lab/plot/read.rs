//! Results as they lie on disk: folders, lines of JSON, whole JSON files.

use std::{
    collections::BTreeSet,
    fs,
    io::{self, BufRead, BufReader},
    path::{Path, PathBuf},
};

use serde_json::Value;

use super::result::{self, Budget, Point, Published};

/// What a sweep's folder holds.
const POINTS: &str = "points.jsonl";
/// What can be plotted.
const SCHEMAS: [&str; 4] = ["nephroid.point/1", "nephroid.render/1", "nephroid.budget/1", "nephroid.reproduce/1"];
/// Longest quotation of somebody's file in an error, characters.
const QUOTED: usize = 40;
/// Longest reason of a failed point in a note, characters.
const REASON: usize = 200;

/// Why results cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file system refuses.
    #[error("{}: cannot be read: {reason}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// Its reason.
        reason: io::Error,
    },
    /// A folder without points.
    #[error("{}: no {POINTS} in this folder: `nephroid sweep merge FILE.toml` makes it", .0.display())]
    NoPoints(PathBuf),
    /// No JSON, or not of the shape that its schema says.
    #[error("{place}: {problem}: remove the line, or make the result again")]
    Malformed {
        /// `file:line`.
        place: String,
        /// What is wrong.
        problem: String,
    },
    /// Of another version, or nothing of ours.
    #[error(
        "{place}: schema `{schema}` is none that plot reads ({}): make the result again with this version, or plot it \
         with the one that wrote it",
        SCHEMAS.join(", ")
    )]
    Schema {
        /// `file:line`.
        place: String,
        /// What it says it is.
        schema: String,
    },
}

/// All that was read.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// Points that may be plotted as times.
    pub points: Vec<Point>,
    /// Budgets.
    pub budgets: Vec<Budget>,
    /// Published tables.
    pub tables: Vec<Published>,
    /// What was left out and why.
    pub notes: Vec<String>,
    /// The files read, as they were named.
    pub sources: Vec<String>,
}

impl Results {
    /// Reads each path: a folder's `points.jsonl`, a `.jsonl` file line by line, any other file as one JSON value.
    ///
    /// Points timed beside others are left out and counted in `notes`; a point read twice counts once.
    ///
    /// # Errors
    /// [`ReadError`] of the first file or line that cannot be read, with its place.
    pub fn read(paths: &[PathBuf]) -> Result<Self, ReadError> {
        let mut all = Self::default();
        for path in paths {
            all.read_path(path)?;
        }
        all.leave_out_twins();
        all.leave_out_company();
        Ok(all)
    }

    fn read_path(&mut self, path: &Path) -> Result<(), ReadError> {
        let file = if path.is_dir() { path.join(POINTS) } else { path.to_path_buf() };
        if path.is_dir() && !file.is_file() {
            return Err(ReadError::NoPoints(path.to_path_buf()));
        }
        let refused = |reason| ReadError::Io { path: file.clone(), reason };
        let name = file.display().to_string();
        self.sources.push(name.clone());
        if file.extension().is_none_or(|ending| ending != "jsonl") {
            return self.take(&fs::read(&file).map_err(refused)?, &name, None);
        }
        for (at, line) in BufReader::new(fs::File::open(&file).map_err(refused)?).split(b'\n').enumerate() {
            let line = line.map_err(refused)?;
            if !line.trim_ascii().is_empty() {
                self.take(&line, &name, Some(at + 1))?;
            }
        }
        Ok(())
    }

    /// One JSON value, of `file`, of a line or whole.
    fn take(&mut self, text: &[u8], file: &str, line: Option<usize>) -> Result<(), ReadError> {
        let at = |line: usize| format!("{file}:{line}");
        let value: Value = serde_json::from_slice(text).map_err(|error| ReadError::Malformed {
            place: at(line.unwrap_or(error.line().max(1))),
            problem: format!("no JSON ({})", bare(&error)),
        })?;
        let place = line.map_or_else(|| file.to_owned(), at);
        let schema = match value.get("schema") {
            Some(Value::String(schema)) => schema.clone(),
            _ => "none".to_owned(),
        };
        let shape = |error: serde_json::Error| ReadError::Malformed {
            place: place.clone(),
            problem: format!("no {schema} ({})", bare(&error)),
        };
        match schema.as_str() {
            // A point that could not be made has a reason, and nothing to draw.
            "nephroid.point/1" if value["failed"].is_string() => {
                let reason: String = value["failed"].as_str().unwrap_or_default().chars().take(REASON).collect();
                self.notes.push(format!("{place}: left out, it failed: {reason}"));
            }
            "nephroid.point/1" => self.points.push(result::point(value, &place).map_err(shape)?),
            "nephroid.render/1" => self.points.push(result::render(value, &place).map_err(shape)?),
            "nephroid.budget/1" => self.budgets.push(result::budget(value, &place).map_err(shape)?),
            "nephroid.reproduce/1" => {
                let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
                self.tables.push(result::published(value, &place, &stem).map_err(shape)?);
            }
            _ => return Err(ReadError::Schema { place, schema: schema.chars().take(QUOTED).collect() }),
        }
        Ok(())
    }

    fn leave_out_twins(&mut self) {
        let (before, mut seen) = (self.points.len(), BTreeSet::new());
        self.points.retain(|point| point.key.is_empty() || seen.insert(point.key.clone()));
        match before - self.points.len() {
            0 => {}
            twins => self.notes.push(format!("{} read twice, by key: counted once", points(twins))),
        }
    }

    fn leave_out_company(&mut self) {
        let before = self.points.len();
        self.points.retain(|point| point.alone);
        match before - self.points.len() {
            0 => {}
            company => self.notes.push(format!(
                "{} left out: timed while another point ran on the host, which is no time; `sweep run` with one shard a \
                 host times them alone",
                points(company)
            )),
        }
    }
}

/// `1 point`, `2 points`.
pub(super) fn points(count: usize) -> String {
    if count == 1 { "1 point".to_owned() } else { format!("{count} points") }
}

/// The message without its place: ours is of the file.
fn bare(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split(" at line ").next().unwrap_or(&text).to_owned()
}
