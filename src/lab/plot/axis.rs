//! Axes: where a value stands, and the values that are written beside it.

/// Fewest decades of a logarithmic axis: values that are all equal, or nearly, stand in the middle of it.
const LEAST_DECADES: f64 = 0.4;
/// Of the span, on each side.
const MARGIN: f64 = 0.06;
/// Most ticks with a label.
const MOST_TICKS: usize = 9;
/// Fewest, where finer ones exist.
const LEAST_TICKS: usize = 3;

/// A logarithmic axis.
#[derive(Clone, Debug, PartialEq)]
pub struct LogAxis {
    /// Decimal logarithms of its ends.
    pub ends: [f64; 2],
    /// Value and label.
    pub ticks: Vec<(f64, String)>,
}

impl LogAxis {
    /// Over all positive finite values; from 0.1 to 10 where there is none.
    pub fn over(values: impl IntoIterator<Item = f64>) -> Self {
        let ends = padded(values);
        Self { ends, ticks: log_ticks(ends) }
    }

    /// As [`LogAxis::over`], its ticks at squares of powers of two: numbers of photons.
    pub fn over_photons(values: impl IntoIterator<Item = f64>) -> Self {
        let ends = padded(values);
        let sides: Vec<_> = (0..32).map(|power| f64::from(power).exp2()).collect();
        let inside: Vec<_> = sides.into_iter().filter(|side| is_between(ends, side * side)).collect();
        let every = inside.len().div_ceil(MOST_TICKS).max(1);
        let ticks: Vec<_> = inside.into_iter().step_by(every).map(|side| (side * side, format!("{side}²"))).collect();
        if ticks.is_empty() { Self { ends, ticks: log_ticks(ends) } } else { Self { ends, ticks } }
    }

    /// From 0 at its lower end to 1 at its upper.
    pub fn place(&self, value: f64) -> f64 {
        (value.log10() - self.ends[0]) / (self.ends[1] - self.ends[0])
    }
}

fn padded(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let logs = values.into_iter().filter(|v| v.is_finite() && *v > 0.0).map(f64::log10);
    let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return [-1.0, 1.0];
    }
    let span = (high - low).max(LEAST_DECADES) * (1.0 + 2.0 * MARGIN);
    let middle = low.midpoint(high);
    [middle - span / 2.0, middle + span / 2.0]
}

fn is_between([low, high]: [f64; 2], value: f64) -> bool {
    (low..=high).contains(&value.log10())
}

/// Decades, or every so many; where that leaves too few, 1–2–5, then each digit, then round steps.
fn log_ticks(ends: [f64; 2]) -> Vec<(f64, String)> {
    let [low, high] = ends.map(|end| end.floor() as i32);
    let powers = high - low + 1;
    let every = (powers as usize).div_ceil(MOST_TICKS).max(1);
    let of = |digits: &[u8], every: usize| -> Vec<f64> {
        let decades = (low..=high).filter(|power| power.rem_euclid(every as i32) == 0);
        let all = decades.flat_map(|p| digits.iter().map(move |d| format!("{d}e{p}").parse::<f64>()));
        all.flatten().filter(|value| is_between(ends, *value)).collect()
    };
    let choices = [of(&[1], every), of(&[1, 2, 5], 1), of(&[1, 2, 3, 4, 5, 6, 7, 8, 9], 1)];
    let found = choices.into_iter().find(|ticks| ticks.len() >= LEAST_TICKS);
    let ticks = found.unwrap_or_else(|| linear_ticks(ends.map(|end| 10f64.powf(end))));
    let plain = ticks.iter().all(|tick| (1e-3..1e5).contains(tick));
    ticks.into_iter().map(|tick| (tick, if plain { number(tick) } else { power(tick) })).collect()
}

/// Round values from one end to the other, five or so.
pub fn linear_ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let rough = (high - low) / 5.0;
    if !(rough > 0.0 && rough.is_finite()) {
        return vec![low];
    }
    let decade = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|s| s * decade).find(|s| *s >= rough).unwrap_or(decade);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(|at| at as f64 * step).collect()
}

/// Without the digits that a sum of steps leaves.
pub fn number(value: f64) -> String {
    let rounded = format!("{value:.6}");
    let text = if rounded.contains('.') { rounded.trim_end_matches('0').trim_end_matches('.') } else { &rounded };
    if value != 0.0 && (value.abs() < 1e-4 || value.abs() >= 1e6) { power(value) } else { text.replace('-', "−") }
}

/// `10⁻²`, `2×10⁻⁵`.
fn power(value: f64) -> String {
    let text = format!("{value:.1e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = digits.trim_end_matches(".0").replace('-', "−");
    let raised: String = exponent.chars().map(superscript).collect();
    if digits == "1" { format!("10{raised}") } else { format!("{digits}×10{raised}") }
}

fn superscript(c: char) -> char {
    match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
    }
}
