//! What a plot says in words: equal times, equal errors, what was drawn and what was left out.

use serde::Serialize;

use super::{
    build::figure,
    chart::{Body, Chart, Kind, Mark, side},
    equal::{EqualRow, equal_rows},
    files::csv_table,
    read::Results,
    result::Estimate,
    scale::{Growth, growth},
};
use crate::{
    lab::{Cell, Report, Table},
    stats::Number,
};

/// Marks up to which each has a row of its figures; those of more stand in the CSV beside the plot.
const LISTED: usize = 100;

/// Of `nephroid plot`, schema `nephroid.plot/1`.
#[derive(Debug, Serialize)]
pub struct PlotReport {
    schema: &'static str,
    kind: &'static str,
    measure: String,
    sources: Vec<String>,
    series: Vec<SeriesRow>,
    equal: Vec<EqualRow>,
    /// Of a scale plot.
    growth: Vec<Growth>,
    caption: Vec<String>,
    /// Points that were left out.
    left_out: Vec<String>,
    #[serde(skip)]
    drawn: Table,
}

/// A series that was drawn.
#[derive(Debug, Serialize)]
struct SeriesRow {
    panel: String,
    series: String,
    device: String,
    points: u64,
    front: u64,
}

impl PlotReport {
    /// Of a chart of results; equal rows at times (ms) and errors, or at some that suit where none are asked for.
    pub fn new(chart: &Chart, results: &Results, times: &[f64], errors: &[f64]) -> Self {
        let panels = match &chart.body {
            Body::Marks(panels) => panels.as_slice(),
            Body::Bars(..) => &[],
        };
        let series = panels.iter().flat_map(|panel| panel.series.iter().map(|series| (panel.title.clone(), series)));
        let row = |(panel, series): (String, &super::Series)| SeriesRow {
            panel,
            series: series.name.clone(),
            device: series.device.clone(),
            points: series.marks.len() as u64,
            front: series.marks.iter().filter(|mark| mark.front).count() as u64,
        };
        let equal = match chart.kind {
            Kind::ErrorTime => panels.iter().flat_map(|panel| equal_rows(panel, times, errors)).collect(),
            _ => Vec::new(),
        };
        Self {
            schema: "nephroid.plot/1",
            kind: chart.kind.name(),
            measure: chart.measure.clone(),
            sources: results.sources.clone(),
            series: series.map(row).collect(),
            equal,
            growth: if chart.kind == Kind::Scale { growth(panels) } else { Vec::new() },
            caption: chart.caption.clone(),
            left_out: results.notes.clone(),
            drawn: match chart.body {
                Body::Marks(_) if chart.kind != Kind::Scale => figures(chart),
                Body::Marks(_) | Body::Bars(..) => csv_table(chart),
            },
        }
    }

    fn equal_table(&self) -> Table {
        let cell = |value: Option<Number>| value.map_or(Cell::None, |v| Cell::text(figure(v.0)));
        let between = |ends: Option<[Number; 2]>| {
            ends.map_or(Cell::None, |[low, high]| Cell::text(format!("{} to {}", figure(low.0), figure(high.0))))
        };
        let row = |row: &EqualRow| {
            let at = match row.equal {
                "time" => format!("at {} ms", figure(row.at)),
                _ => format!("for {} {}", self.measure, figure(row.at)),
            };
            let unit = if row.equal == "time" { self.measure.as_str() } else { "ms" };
            let value = row.value.map_or(Cell::None, |v| Cell::text(format!("{} {unit}", figure(v.0))));
            let (words, ratio) = (Cell::text(&row.verdict), cell(row.ratio));
            let [interval, of_ratio] = [between(row.interval), between(row.ratio_interval)];
            vec![
                Cell::text(&row.panel),
                Cell::text(at),
                Cell::text(&row.series),
                value,
                interval,
                ratio,
                of_ratio,
                words,
            ]
        };
        let columns = vec!["scene", "equal", "series", "value", "interval", "ratio", "ratio interval", "verdict"];
        Table { name: "equal", columns, rows: self.equal.iter().map(row).collect() }
    }

    fn growth_table(&self) -> Table {
        let row = |row: &Growth| {
            let powers = [row.overall, row.last].map(|power| Cell::Real(power.0, 2));
            [&row.panel, &row.series].map(Cell::text).into_iter().chain(powers).collect()
        };
        let columns = vec!["scene", "series", "power", "at its end"];
        Table { name: "growth", columns, rows: self.growth.iter().map(row).collect() }
    }

    fn series_table(&self) -> Table {
        let row = |row: &SeriesRow| {
            let words = [&row.panel, &row.series, &row.device].map(Cell::text);
            words.into_iter().chain([row.points, row.front].map(Cell::Count)).collect()
        };
        let columns = vec!["scene", "series", "device", "points", "on its front"];
        Table { name: "series", columns, rows: self.series.iter().map(row).collect() }
    }
}

/// What is drawn, to be read: a row a mark, values with their intervals to the digits that count.
fn figures(chart: &Chart) -> Table {
    let Body::Marks(panels) = &chart.body else { return csv_table(chart) };
    let with_error = chart.kind == Kind::ErrorTime;
    let row = |title: &str, series: &super::Series, mark: &Mark| {
        let mut row = [title, &series.name].map(Cell::text).to_vec();
        row.push(if mark.photons > 0 { Cell::text(side(mark.photons)) } else { Cell::None });
        let (time, error) = if with_error { (&mark.x, Some(&mark.y)) } else { (&mark.y, None) };
        row.extend([time].into_iter().chain(error).flat_map(value_and_interval));
        row.push(Cell::text(&series.device));
        row
    };
    let mut rows = Vec::new();
    for panel in panels {
        for series in &panel.series {
            rows.extend(series.marks.iter().map(|mark| row(&panel.title, series, mark)));
        }
    }
    let error: &[&str] = if with_error { &["error", "error interval"] } else { &[] };
    let columns = ["scene", "series", "N", "ms", "ms interval"].iter().chain(error).chain(&["device"]);
    Table { name: "figures", columns: columns.copied().collect(), rows }
}

fn value_and_interval(estimate: &Estimate) -> [Cell; 2] {
    let ends = estimate.low.zip(estimate.high);
    let interval =
        ends.map_or(Cell::None, |(low, high)| Cell::text(format!("{} to {}", figure(low.0), figure(high.0))));
    [Cell::text(figure(estimate.value.0)), interval]
}

impl Report for PlotReport {
    fn tables(&self) -> Vec<Table> {
        let (drawn, bars) = (self.drawn.clone(), self.series.is_empty());
        match drawn.rows.len() {
            _ if bars => vec![drawn],
            _ if !self.growth.is_empty() => vec![self.growth_table()],
            0..=LISTED => vec![drawn, self.series_table(), self.equal_table()],
            _ => vec![self.series_table(), self.equal_table()],
        }
    }

    fn heading(&self) -> Vec<String> {
        let of = if self.measure.is_empty() { String::new() } else { format!(" ({})", self.measure) };
        vec![format!("{}{of}: {}", self.kind, self.sources.join(", "))]
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = self.caption.clone();
        if self.kind == Kind::ErrorTime.name() {
            notes.push(if self.equal.is_empty() {
                "No equal times or errors: no two series of one device were measured over a common range.".to_owned()
            } else {
                "Equal rows: read off each series' own front, only inside its measured range, along straight lines over \
                 logarithms."
                    .to_owned()
            });
        }
        notes.extend(self.left_out.iter().cloned());
        notes
    }
}
