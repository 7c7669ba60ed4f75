//! The published figures of the five papers: `tables.toml`, and every table of it by an id such as `maps.table1`.

use serde::Serialize;
use toml::{Table, Value};

use crate::names::NoSuch;

static TABLES: &str = include_str!("tables.toml");

/// Keys that say what rows are, not what was measured.
const AXES: [&str; 2] = ["photons", "screen"];
/// Keys that say where figures are from.
const SOURCE: [&str; 2] = ["paper", "platform"];
/// The id of what a paper says outside its tables.
const TEXT: &str = "text";

/// Figures of pictures, which have no number in `tables.toml`: paper, figure, what is reported, what its pictures are of.
const PICTURES: [(&str, &str, &str, &[&str]); 8] = [
    ("maps", "figure7", "gather", &["constant", "thin lens", "interpolated", "varying"]),
    ("waves", "figure9", "picture", FIGURE_9),
    ("lines", "figure7", "picture", &["lines", "Krüger et al."]),
    ("lines", "figure8", "picture", &["g = 0.7", "g = 0", "g = -0.7"]),
    ("lines", "figure10", "picture", &["buffer", "filter"]),
    ("lines", "figure11", "picture", &["integration steps"]),
    ("beams", "figure4", "picture", &["static grids", "refinement steps"]),
    ("beams", "figure8", "picture", &["direct", "medium", "volume", "surface", "composed"]),
];

/// Its mesh and its target have no size in the paper.
const FIGURE_9: &[&str] = &[
    "per vertex, 32",
    "per vertex, 128",
    "per vertex, 512",
    "per pixel",
    "texture, 128",
    "texture, 512",
    "texture, 2048",
];

/// What a row is of: an N, or a scene or variant by name.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum Label {
    /// Photons along a side, or pixels.
    Number(u32),
    /// In words; empty where there is one row alone.
    Words(String),
}

impl Label {
    /// As it is printed.
    pub fn text(&self) -> String {
        match self {
            Self::Number(n) => n.to_string(),
            Self::Words(words) if words.is_empty() => "-".to_owned(),
            Self::Words(words) => words.clone(),
        }
    }

    /// N, of a row that is of one.
    pub fn number(&self) -> Option<u32> {
        if let Self::Number(n) = self { Some(*n) } else { None }
    }
}

/// One published figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its row.
    pub row: Label,
    /// Its key in `tables.toml`.
    pub column: String,
    /// Its value; none where the paper shows a picture, or says it in words.
    pub value: Option<f64>,
}

/// A table or figure of a paper.
#[derive(Clone, Debug, PartialEq)]
pub struct Published {
    /// `maps.table1`.
    pub id: String,
    /// Author, year, title.
    pub paper: String,
    /// What it was measured on.
    pub platform: String,
    /// Every figure, column by column.
    pub figures: Vec<Figure>,
}

impl Published {
    /// The method that the paper is of.
    pub fn method(&self) -> &str {
        self.id.split('.').next().unwrap_or_default()
    }
}

/// Every table and figure, by paper and table.
pub fn all() -> Vec<Published> {
    let papers: Table = TABLES.parse().expect("the embedded tables are TOML: a test reads them");
    papers.iter().filter_map(|(name, paper)| Some(of_paper(name, paper.as_table()?))).flatten().collect()
}

/// The one of that id.
///
/// # Errors
/// Names the ones near it, or all.
pub fn find(id: &str) -> Result<Published, NoSuch> {
    let all = all();
    let ids: Vec<String> = all.iter().map(|p| p.id.clone()).collect();
    all.into_iter()
        .find(|p| p.id == id)
        .ok_or_else(|| NoSuch::new("table or figure", id, ids.iter().map(String::as_str).chain(["list"])))
}

fn of_paper(name: &str, paper: &Table) -> Vec<Published> {
    let text = |key: &str| paper.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
    let published = |table: &str, figures| Published {
        id: format!("{name}.{table}"),
        paper: text("paper"),
        platform: text("platform"),
        figures,
    };
    let is_source = |key: &str| SOURCE.contains(&key) || AXES.contains(&key);
    let tables = paper.iter().filter_map(|(key, value)| Some((key, value.as_table()?)));
    let mut all: Vec<_> = tables.map(|(key, table)| published(key, figures(table, axis(paper, table)))).collect();
    let pictures = PICTURES.iter().filter(|(of, ..)| *of == name);
    all.extend(pictures.map(|(_, figure, column, rows)| {
        let row =
            |row: &&str| Figure { row: Label::Words((*row).to_owned()), column: (*column).to_owned(), value: None };
        published(figure, rows.iter().map(row).collect())
    }));
    let outside = paper.iter().filter(|(key, value)| !is_source(key) && !value.is_table());
    let outside: Table = outside.map(|(key, value)| (key.clone(), value.clone())).collect();
    if !outside.is_empty() {
        all.push(published(TEXT, figures(&outside, None)));
    }
    all
}

/// What rows of a table are: its own axis, else the paper's.
fn axis<'t>(paper: &'t Table, table: &'t Table) -> Option<&'t [Value]> {
    let of = |table: &'t Table| AXES.iter().find_map(|key| table.get(*key)?.as_array());
    of(table).or_else(|| of(paper)).map(Vec::as_slice)
}

fn figures(table: &Table, axis: Option<&[Value]>) -> Vec<Figure> {
    let entries = table.iter().filter(|(key, _)| !AXES.contains(&key.as_str()));
    let each = entries.flat_map(|(key, value)| match value {
        Value::Table(columns) => columns.iter().flat_map(|(column, v)| of_value(key, column, v, axis)).collect(),
        other => of_value("", key, other, axis),
    });
    each.collect()
}

/// A figure, or a list of them along the axis. Words (which variant was best) are no figures.
fn of_value(row: &str, column: &str, value: &Value, axis: Option<&[Value]>) -> Vec<Figure> {
    let figure =
        |row, value: f64| Figure { row, column: column.to_owned(), value: Some(value).filter(|v| !v.is_nan()) };
    match value {
        Value::Array(values) => {
            let numbers = values.iter().enumerate();
            numbers.filter_map(|(at, v)| Some(figure(label(row, at, values.len(), axis), number(v)?))).collect()
        }
        other => number(other).map(|v| figure(Label::Words(row.to_owned()), v)).into_iter().collect(),
    }
}

fn label(row: &str, at: usize, of: usize, axis: Option<&[Value]>) -> Label {
    let along = axis.filter(|axis| axis.len() == of).and_then(|axis| u32::try_from(axis[at].as_integer()?).ok());
    match (row, along) {
        ("", Some(n)) => Label::Number(n),
        ("", None) => Label::Words(format!("#{}", at + 1)),
        (row, Some(n)) => Label::Words(format!("{row}, {n}")),
        (row, None) => Label::Words(format!("{row}, #{}", at + 1)),
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|n| n as f64))
}
