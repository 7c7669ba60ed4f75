//! Equal time, equal error: what a method would take or miss where another stands, read off their fronts.
//!
//! Only inside the measured range of each, along straight lines over logarithms; outside nothing is claimed.

use serde::Serialize;

use super::{
    chart::Panel,
    pareto::{Axis, Front, Reading},
};
use crate::stats::Number;

/// How many values are chosen where none is asked for.
const CHOSEN: usize = 3;

/// One series where all are compared.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EqualRow {
    /// Scene, camera, size.
    pub panel: String,
    /// `time` (ms) or `error`: what is equal.
    pub equal: &'static str,
    /// Its value.
    pub at: f64,
    /// The series.
    pub series: String,
    /// The device.
    pub device: String,
    /// The error at this time, or the time (ms) for this error; absent outside of the measured range.
    pub value: Option<Number>,
    /// Interval of `value`.
    pub interval: Option<[Number; 2]>,
    /// `value` over that of the best series.
    pub ratio: Option<Number>,
    /// Interval of `ratio`.
    pub ratio_interval: Option<[Number; 2]>,
    /// In words.
    pub verdict: String,
}

/// The rows of a panel: at each of `times` (ms) and `errors`, or where most series were measured. Series on different
/// devices are not compared.
pub fn equal_rows(panel: &Panel, times: &[f64], errors: &[f64]) -> Vec<EqualRow> {
    let mut devices: Vec<&str> = panel.series.iter().map(|series| series.device.as_str()).collect();
    devices.sort_unstable();
    devices.dedup();
    let mut rows = Vec::new();
    for device in devices {
        let of_device = panel.series.iter().filter(|series| series.device == device);
        let fronts: Vec<_> = of_device.map(|s| (s.name.as_str(), Front::of(&s.marks))).collect();
        for (axis, asked) in [(Axis::X, times), (Axis::Y, errors)] {
            let values = if asked.is_empty() { chosen(&fronts, axis) } else { asked.to_vec() };
            for at in values {
                rows.extend(compared(&panel.title, device, &fronts, axis, at));
            }
        }
    }
    rows
}

/// Round values where most fronts were measured, spread over that range; its middle where none is round.
fn chosen(fronts: &[(&str, Front)], axis: Axis) -> Vec<f64> {
    let ranges: Vec<_> = fronts.iter().filter_map(|(_, front)| front.range(axis)).collect();
    let covering = |at: f64| ranges.iter().filter(|[low, high]| (*low..=*high).contains(&at)).count();
    let most = ranges.iter().flatten().map(|at| covering(*at)).max().unwrap_or(0);
    if most < 2 {
        return Vec::new();
    }
    let mut ends: Vec<f64> = ranges.iter().flatten().copied().collect();
    ends.sort_unstable_by(f64::total_cmp);
    let shared: Vec<_> = ends.into_iter().filter(|at| covering(*at) == most).collect();
    let (low, high) = (shared[0], shared[shared.len() - 1]);
    let round: Vec<_> = round_between(low, high).into_iter().filter(|at| covering(*at) == most).collect();
    match round.len() {
        0 => vec![(low.ln().midpoint(high.ln())).exp().clamp(low, high)],
        count if count <= CHOSEN => round,
        count => (0..CHOSEN).map(|at| round[at * (count - 1) / (CHOSEN - 1)]).collect(),
    }
}

/// 1, 2, 5 times powers of ten.
fn round_between(low: f64, high: f64) -> Vec<f64> {
    let decades = low.log10().floor() as i32..=high.log10().ceil() as i32;
    // Parsed, so that 0.2 is 0.2 and not what a multiplication makes of it.
    let values = decades.flat_map(|power| ["1", "2", "5"].map(|digit| format!("{digit}e{power}").parse()));
    values.flatten().filter(|value: &f64| (low..=high).contains(value)).collect()
}

fn compared(panel: &str, device: &str, fronts: &[(&str, Front)], axis: Axis, at: f64) -> Vec<EqualRow> {
    let readings: Vec<_> = fronts.iter().map(|(name, front)| (*name, front.read(axis, at))).collect();
    let measured = readings.iter().filter_map(|(name, reading)| reading.map(|reading| (*name, reading)));
    let best = measured.min_by(|a, b| a.1.value.total_cmp(&b.1.value));
    let row = |(name, reading): &(&str, Option<Reading>)| {
        let ratio = best.zip(*reading).map(|((of, best), this)| {
            // The best over itself is 1, certainly.
            if of == *name { Reading { value: 1.0, spread: Some([0.0, 0.0]) } } else { over(&this, &best) }
        });
        EqualRow {
            panel: panel.to_owned(),
            equal: if axis == Axis::X { "time" } else { "error" },
            at,
            series: (*name).to_owned(),
            device: device.to_owned(),
            value: reading.map(|r| Number(r.value)),
            interval: reading.and_then(|r| ends(&r)),
            ratio: ratio.map(|r| Number(r.value)),
            ratio_interval: ratio.and_then(|r| ends(&r)),
            verdict: verdict(name, ratio, best, readings.iter().filter(|r| r.1.is_some()).count(), axis),
        }
    };
    readings.iter().map(row).collect()
}

fn verdict(name: &str, ratio: Option<Reading>, best: Option<(&str, Reading)>, measured: usize, axis: Axis) -> String {
    let (Some(ratio), Some((of, _))) = (ratio, best) else { return "not measured".to_owned() };
    let [least, more] = if axis == Axis::X { ["least error", "the error"] } else { ["fastest", "the time"] };
    match ends(&ratio) {
        _ if measured == 1 => "alone".to_owned(),
        _ if name == of => least.to_owned(),
        Some([low, _]) if low.0 <= 1.0 => format!("no difference shown from {of}"),
        Some(_) => format!("{:.1}× {more} of {of}", ratio.value),
        None => format!("{:.1}× {more} of {of}, without an interval", ratio.value),
    }
}

/// The ratio of two independent readings.
fn over(a: &Reading, b: &Reading) -> Reading {
    let spread = a.spread.zip(b.spread).map(|(a, b)| [a[0].hypot(b[1]), a[1].hypot(b[0])]);
    Reading { value: a.value / b.value, spread }
}

fn ends(reading: &Reading) -> Option<[Number; 2]> {
    reading.spread.map(|[down, up]| [reading.value * (-down).exp(), reading.value * up.exp()].map(Number))
}
