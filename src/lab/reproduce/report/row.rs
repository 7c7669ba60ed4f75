//! One published figure beside what it is here.

use serde::Serialize;

use crate::{
    lab::{
        Cell,
        papers::{Figure, Label, Published},
        reproduce::{
            columns,
            measure::{Measured, Run},
        },
    },
    metrics::Measure,
    stats::Interval,
};

/// Of an error, which may have no interval: then anything.
fn of_error(m: Measure) -> Interval {
    Interval { value: m.value, low: m.low.unwrap_or(0.0), high: m.high.unwrap_or(f64::INFINITY) }
}

/// One published figure, and what it is here.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub row: Label,
    pub column: String,
    pub unit: &'static str,
    pub published: Option<f64>,
    pub measured: Option<Interval>,
    /// Measured over published.
    pub ratio: Option<f64>,
    /// Of the picture of the frame that was timed.
    pub relmse: Option<Interval>,
    /// The same with the scale that fits best, of a picture that is right only up to one; and that scale.
    pub relmse_fitted: Option<Interval>,
    pub scale: Option<f64>,
    /// Flux in the map over the flux that arrived in it: less where splats are dropped, more where clusters invent light.
    pub kept: Option<f64>,
    /// Points that gathering draws in all, where it draws points.
    pub points: Option<u64>,
    /// Why there is no `measured`.
    pub missing: Option<String>,
}

/// Of times, but where a paper gives rates or counts.
fn unit(published: &Published, column: &str) -> &'static str {
    match (published.id.as_str(), column) {
        ("maps.table4" | "lines.table2", _) => "fps",
        (_, name) if name.ends_with("fps") => "fps",
        ("maps.table1" | "maps.table2" | "maps.table3" | "maps.figure7" | "waves.figure9" | "lines.table1", _) => "ms",
        (_, "speed") => "rad/s",
        (_, "sun_disc_degrees") => "degrees",
        (_, "mental_ray_minutes") => "minutes",
        (_, "absorbed_per_metre") => "1/m",
        _ => "1",
    }
}

impl Row {
    pub fn missing(published: &Published, figure: &Figure, missing: Option<String>) -> Self {
        Self {
            row: figure.row.clone(),
            column: figure.column.clone(),
            unit: unit(published, &figure.column),
            published: figure.value,
            measured: None,
            ratio: None,
            relmse: None,
            relmse_fitted: None,
            scale: None,
            kept: None,
            points: None,
            missing,
        }
    }

    pub fn of(published: &Published, figure: &Figure, run: &Run) -> Self {
        let asked = columns::asked(published, figure);
        let measured = match asked.as_ref().map_err(Clone::clone).and_then(|asked| asked.measure(run)) {
            Ok(measured) => measured,
            Err(why) => return Self::missing(published, figure, Some(why)),
        };
        let ratio = figure.value.map(|published| measured.value / published).filter(|ratio| ratio.is_finite());
        let of_one = asked.ok().and_then(|asked| run.find(asked.place()?).ok()).map(|at| &run.all[at]);
        Self {
            measured: Some(measured),
            ratio,
            relmse: of_one.and_then(|m| m.relmse).map(of_error),
            relmse_fitted: of_one.and_then(|m| m.fitted).map(|fit| of_error(fit.relmse)),
            scale: of_one.and_then(|m| m.fitted).map(|fit| fit.scale),
            kept: of_one.and_then(|m| m.kept),
            points: of_one.and_then(Measured::points),
            ..Self::missing(published, figure, None)
        }
    }
}

/// Three significant digits.
pub fn short(value: f64) -> String {
    match value.abs() {
        a if a >= 100.0 || a == 0.0 => format!("{value:.0}"),
        a if a >= 10.0 => format!("{value:.1}"),
        a if a >= 1.0 => format!("{value:.2}"),
        a if a >= 0.01 => format!("{value:.3}"),
        _ => format!("{value:.1e}"),
    }
}

/// Value and interval, if there are any.
pub fn cells(known: Option<&Interval>) -> [Cell; 2] {
    let known = known.map(|k| [short(k.value), format!("{} to {}", short(k.low), short(k.high))]);
    known.map_or([Cell::None, Cell::None], |texts| texts.map(Cell::text))
}
