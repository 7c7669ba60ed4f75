//! Charts of results: what is drawn, what cannot be, and what must be said of either.

use std::collections::{BTreeMap, BTreeSet};

use super::{
    axis::number,
    chart::{Bar, BarPanel, Body, Chart, Kind, Mark, Panel, Series, side},
    read::{Results, points},
    result::{Budget, Estimate, Point, Published, PublishedRow, Step},
    scale::{PHOTONS_AXIS, scale},
    series::{Group, groups, panel},
};

/// The device of a published figure.
const PUBLISHED: &str = "as published";
/// Along and up.
const COST: [&str; 2] = [PHOTONS_AXIS, "time (ms)"];
/// The largest N of an N × N photon buffer that a table's row may name.
const LARGEST_SIDE: u64 = 1 << 20;

/// Why there is no plot.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// Nothing of the kind among the results.
    #[error("no {kind} plot: {why}")]
    Nothing {
        /// What was asked for.
        kind: Kind,
        /// What is there instead, and what would help.
        why: String,
    },
    /// Nothing of any kind.
    #[error("nothing to plot: the results hold no point: `nephroid sweep run FILE.toml` makes points")]
    Empty,
}

/// The chart of a kind, or of the first kind that the results have anything for. `measure` is that of the error, `along`
/// what a scale plot runs along.
///
/// # Errors
/// [`PlotError`] where there is nothing to draw.
pub fn chart(results: &Results, kind: Option<Kind>, measure: &str, along: &str) -> Result<Chart, PlotError> {
    if results.points.is_empty() && results.budgets.is_empty() && results.tables.is_empty() {
        return Err(match results.notes.is_empty() {
            true => PlotError::Empty,
            false => PlotError::Nothing { kind: kind.unwrap_or(Kind::ErrorTime), why: results.notes.join("; ") },
        });
    }
    match kind {
        Some(kind) => of_kind(results, kind, measure, along),
        None => {
            let found = Kind::ALL.into_iter().find_map(|kind| of_kind(results, kind, measure, along).ok());
            found.map_or_else(|| of_kind(results, Kind::ErrorTime, measure, along), Ok)
        }
    }
}

fn of_kind(results: &Results, kind: Kind, measure: &str, along: &str) -> Result<Chart, PlotError> {
    let (body, mut caption) = match kind {
        Kind::ErrorTime => error_time(&results.points, measure),
        Kind::Cost => cost(results),
        Kind::Scale => scale(&results.points, along),
        Kind::Stages => stages(&results.points),
        Kind::Budget => budget(&results.budgets),
    };
    let (empty, edges) = match &body {
        Body::Marks(panels) => (panels.is_empty(), edges(panels)),
        Body::Bars(_, panels) => (panels.is_empty(), unmeasured(panels)),
    };
    if empty {
        let had = format!(
            "{}, error budgets: {}, tables: {}",
            points(results.points.len()),
            results.budgets.len(),
            results.tables.len()
        );
        let why = caption.pop().map(|last| format!("; {last}")).unwrap_or_default();
        return Err(PlotError::Nothing { kind, why: format!("the results hold {had}{why}") });
    }
    caption.extend(edges);
    if kind != Kind::Budget {
        caption.extend(devices(results));
    }
    let measure = if kind == Kind::ErrorTime { measure } else { "" };
    Ok(Chart { kind, measure: measure.to_owned(), body, caption })
}

pub(super) type Made = (Body, Vec<String>);

fn error_time(all: &[Point], measure: &str) -> Made {
    let up = format!("error: {measure} (no unit)");
    let axes = ["time of a frame (ms)", up.as_str()];
    let mark = |point: &Point| {
        let y = *point.errors.get(measure)?;
        Some(Mark { x: point.time, y, photons: point.photons, front: false, place: point.place.clone() })
    };
    let panels: Vec<Panel> = groups(all).iter().filter_map(|group| panel(group, axes, mark, true)).collect();
    let layers: BTreeSet<&str> = all.iter().map(|p| p.layer.as_str()).filter(|layer| !layer.is_empty()).collect();
    let layers = layers.into_iter().collect::<Vec<_>>().join(", ");
    let of = if layers.is_empty() { String::new() } else { format!(" of {layers}") };
    let front = if panels.iter().any(|p| p.front.len() > 1) {
        " Grey: the Pareto front, the points that none beats in both."
    } else {
        ""
    };
    let mut caption =
        vec![format!("Time: median of a frame. Error: {measure}{of}. Bars: intervals as measured.{front}")];
    let without = all.iter().filter(|point| !point.errors.contains_key(measure)).count();
    if without > 0 {
        let known: BTreeSet<_> = all.iter().flat_map(|point| point.errors.keys()).map(String::as_str).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.into_iter().collect::<Vec<_>>().join(", ") };
        caption.push(format!("{} without {measure} left out (measures there: {known}).", points(without)));
    }
    (Body::Marks(panels), caption)
}

fn cost(results: &Results) -> Made {
    let mark = |point: &Point| {
        let x = Estimate::plain(point.photons as f64);
        (point.photons > 0).then(|| Mark {
            x,
            y: point.time,
            photons: point.photons,
            front: false,
            place: point.place.clone(),
        })
    };
    let mut caption = vec!["Time: median, of a frame or of the column named. Bars: intervals as measured.".to_owned()];
    let mut panels: Vec<Panel> =
        groups(&results.points).iter().filter_map(|group| panel(group, COST, mark, false)).collect();
    match results.points.iter().filter(|point| point.photons == 0).count() {
        0 => {}
        without => caption.push(format!("{} without photons left out.", points(without))),
    }
    for table in &results.tables {
        let (series, left_out) = table_series(table);
        if left_out > 0 {
            caption.push(format!("{}: {left_out} figures left out that are no ms over N.", table.id));
        }
        if !series.is_empty() {
            panels.push(Panel { title: table.id.clone(), axes: COST.map(str::to_owned), series, front: Vec::new() });
        }
    }
    (Body::Marks(panels), caption)
}

/// Each column, as measured and as published; and how many rows are no time over N.
fn table_series(table: &Published) -> (Vec<Series>, usize) {
    let mut series: BTreeMap<(&str, bool), Vec<Mark>> = BTreeMap::new();
    let mut left_out = 0;
    for row in &table.rows {
        let Some(side) = side_of(row) else {
            left_out += 1;
            continue;
        };
        let (x, place) = (Estimate::plain((side * side) as f64), table.place.clone());
        let values = [(false, row.measured), (true, row.published.map(|p| Estimate::plain(p.0)))];
        for (published, y) in values {
            if let Some(y) = y {
                let mark = Mark { x, y, photons: side * side, front: false, place: place.clone() };
                series.entry((&row.column, published)).or_default().push(mark);
            }
        }
    }
    let named = |((column, published), mut marks): ((&str, bool), Vec<Mark>)| {
        marks.sort_by_key(|mark| mark.photons);
        let (name, device) = match published {
            true => (format!("{column}, {PUBLISHED}"), PUBLISHED.to_owned()),
            false => (format!("{column}, here"), table.device.clone()),
        };
        Series { name, device, marks }
    };
    (series.into_iter().map(named).collect(), left_out)
}

fn side_of(row: &PublishedRow) -> Option<u64> {
    let digits: String = row.row.chars().take_while(char::is_ascii_digit).collect();
    let side = digits.parse().ok().filter(|side| (1..=LARGEST_SIDE).contains(side));
    side.filter(|_| row.unit == "ms")
}

fn stages(all: &[Point]) -> Made {
    let bars = |group: &Group| -> BarPanel {
        let of_series = group.series.iter().flat_map(|(name, points)| points.iter().map(|p| (name.name.as_str(), *p)));
        let bar = |(name, point): (&str, &Point)| Bar {
            name: if point.photons > 0 { format!("{name}, N = {}", side(point.photons)) } else { name.to_owned() },
            parts: point.stages.clone(),
            whole: Some(point.time),
            remark: format!("{} ms", figure(point.time.value.0)),
            place: point.place.clone(),
        };
        BarPanel {
            title: group.title.clone(),
            bars: of_series.filter(|(_, point)| !point.stages.is_empty()).map(bar).collect(),
        }
    };
    let panels = groups(all).iter().map(bars).filter(|panel| !panel.bars.is_empty()).collect();
    let caption = "Bars: the median of each stage, stacked. The line across and the figure: the median of the frame.";
    (Body::Bars("ms", panels), vec![caption.to_owned()])
}

fn budget(all: &[Budget]) -> Made {
    let bar = |step: &Step, name: &str, place: &str| {
        let relmse = step.relmse.map(|relmse| format!(", relMSE {}", figure(relmse.value.0)));
        let share = step.share.map(|share| format!(", {} %", number((share.value.0 * 1000.0).round() / 10.0)));
        let remark =
            format!("{}{}{}", figure(step.energy.value.0), relmse.unwrap_or_default(), share.unwrap_or_default());
        Bar {
            name: name.to_owned(),
            parts: vec![(String::new(), step.energy)],
            whole: None,
            remark,
            place: place.to_owned(),
        }
    };
    let of = |budget: &Budget| {
        let mut bars: Vec<Bar> = budget.steps.iter().map(|step| bar(step, &step.name, &budget.place)).collect();
        bars.extend(budget.whole.iter().map(|whole| bar(whole, "whole", &budget.place)));
        let [width, height] = budget.size;
        BarPanel { title: format!("{}, {}, {width} × {height}", budget.scene, budget.method), bars }
    };
    let panels = all.iter().map(of).filter(|panel| !panel.bars.is_empty()).collect();
    let caption = "Bars: what each step adds to the mean pixel, signed. Behind them: that figure, relMSE against the \
                   step before, share of the whole squared error.";
    (Body::Bars("W/m²", panels), vec![caption.to_owned()])
}

/// Three digits.
pub(super) fn figure(value: f64) -> String {
    if value.is_nan() {
        return "not a number".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "∞".to_owned() } else { "−∞".to_owned() };
    }
    if value == 0.0 { "0".to_owned() } else { number(rounded(value)) }
}

fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// What stands at an edge, since a logarithmic axis has no place for it.
fn edges(panels: &[Panel]) -> Option<String> {
    let mut found: BTreeMap<&str, usize> = BTreeMap::new();
    for mark in panels.iter().flat_map(|panel| &panel.series).flat_map(|series| &series.marks) {
        for value in [mark.x.value.0, mark.y.value.0] {
            let name = match value {
                v if v.is_nan() => "not a number",
                v if v == f64::INFINITY => "infinite",
                0.0 => "zero",
                v if v < 0.0 => "below zero",
                _ => continue,
            };
            *found.entry(name).or_default() += 1;
        }
    }
    let list: Vec<_> = found.iter().map(|(name, count)| format!("{name}: {count}")).collect();
    (!list.is_empty())
        .then(|| format!("Hollow, at the edge: values without a place on a logarithmic axis ({}).", list.join(", ")))
}

/// Parts of bars that have no length.
fn unmeasured(panels: &[BarPanel]) -> Option<String> {
    let parts = panels.iter().flat_map(|panel| &panel.bars).flat_map(|bar| &bar.parts);
    let count = parts.filter(|(_, part)| !part.value.0.is_finite()).count();
    (count > 0).then(|| format!("Parts that are infinite or not a number, not drawn: {count}."))
}

/// The devices, and which of them time nothing.
fn devices(results: &Results) -> Vec<String> {
    let of_points = results.points.iter().map(|point| (point.device.as_str(), point.software));
    let of_tables = results.tables.iter().map(|table| (table.device.as_str(), table.software));
    let all: BTreeSet<_> = of_points.chain(of_tables).filter(|(name, _)| !name.is_empty()).collect();
    let said = |(name, software): &(&str, bool)| match software {
        true => format!("Software device: {name}; its times are not those of a GPU."),
        false => format!("Device: {name}."),
    };
    let mut said: Vec<_> = all.iter().map(said).collect();
    if all.len() > 1 {
        said.push("Times of different devices are not compared: no common front.".to_owned());
    }
    said
}
