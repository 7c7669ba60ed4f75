//! What makes times less than they seem.

use super::{Series, Timed, WINDOW};
use crate::stats::{self, Moves};

/// From here on others disturb: a tenth of the machine.
const BUSY: f64 = 0.1;
/// Ticks of the clock that a frame must take, to be known to one per cent.
const LEAST_TICKS: f64 = 100.0;
/// Rounds from which an interval of 99 % can be made.
const LEAST_ROUNDS: usize = 8;

/// Each says what to do.
pub(super) fn warnings(timed: &Timed, tick_ms: f64) -> Vec<String> {
    let mut warnings: Vec<String> = timed.series.iter().flat_map(|series| of_series(series, tick_ms)).collect();
    if let Some(share) = timed.others.filter(|share| *share > BUSY) {
        let percent = 100.0 * share;
        warnings.push(format!(
            "other processes took {percent:.0} % of this machine's cores while it was timed: stop them, and time again"
        ));
    }
    let rounds = timed.series.first().map_or(0, |series| series.frames.len());
    if (1..LEAST_ROUNDS).contains(&rounds) {
        warnings.push(format!("{rounds} rounds are too few for an interval of 99 %: time {LEAST_ROUNDS} or more"));
    }
    warnings
}

fn of_series(series: &Series, tick_ms: f64) -> Vec<String> {
    let name = &series.name;
    let spans: Vec<f64> = series.frames.iter().map(|f| f.span_ms).collect();
    let mut warnings = Vec::new();
    if !series.settled && series.warmup as usize >= 2 * WINDOW {
        let frames = series.warmup;
        warnings.push(format!(
            "{name}: did not settle in {frames} frames of warm-up: warm up longer, or look for what disturbs"
        ));
    }
    if let Some(change) = stats::change_of(&spans) {
        let percent = 100.0 * (change.factor - 1.0);
        let how = match change.moves {
            Moves::Step(round) => format!("jumped by {percent:+.0} % at round {round}"),
            Moves::Drift => format!("drifted by {percent:+.0} %"),
        };
        warnings.push(format!(
            "{name}: its times {how}: clocks or heat may have changed; let the machine rest, and time again"
        ));
    }
    let (median, tick) = (stats::median(&spans), resolution(series, tick_ms));
    if median < LEAST_TICKS * tick {
        let ticks = median / tick;
        warnings.push(format!(
            "{name}: a frame of {median:.4} ms is {ticks:.0} ticks of the device's clock: time more photons or pixels"
        ));
    }
    warnings
}

/// What all times are multiples of: some clocks tick in more than the period they state.
fn resolution(series: &Series, tick_ms: f64) -> f64 {
    let times = series.frames.iter().flat_map(|f| f.passes.iter().copied().chain([f.span_ms]));
    let ticks = times.filter(|ms| ms.is_finite()).map(|ms| (ms / tick_ms).round() as u64);
    tick_ms * ticks.fold(0, greatest_common_divisor).max(1) as f64
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}
