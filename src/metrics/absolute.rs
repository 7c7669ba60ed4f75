//! Absolute measures and the ratio of energies.

use super::{Measure, NORMAL_95, Pair, RELATIVE_TO_MEAN, pair::Value};

/// E|η| of a normal η with standard deviation one: √(2/π).
const MEAN_ABSOLUTE: f64 = 0.797_884_560_802_865_4;

/// Mean of |x − r|, in the unit of the values.
pub fn mae(pair: &Pair) -> Measure {
    measure(pair, |_| 1.0)
}

/// Mean of |x − r|/(|r| + ε), ε = 10⁻² mean(|r|).
pub fn mape(pair: &Pair) -> Measure {
    let epsilon = RELATIVE_TO_MEAN * pair.reference_mean(f64::abs);
    measure(pair, move |r| 1.0 / (r.abs() + epsilon))
}

/// Σx/Σr over all values: light lost or made up. Of one band without light in the truth it is infinite.
pub fn energy_ratio(pair: &Pair) -> Measure {
    if !pair.is_sound() {
        return Measure::infinite(1.0, pair.has_variance());
    }
    let (mut image, mut reference, mut variance) = (0.0, 0.0, 0.0);
    for values in pair.each() {
        let mut deviation = 0.0;
        for Value { x, r, v } in values {
            image += x;
            reference += r;
            deviation += v.sqrt();
        }
        variance += deviation * deviation;
    }
    let value = if image == reference { 1.0 } else { image / reference };
    // Both empty: nothing was lost, and nothing is known to a share of nothing.
    let alone = if variance == 0.0 { 0.0 } else { variance.sqrt() / reference.abs() };
    let error = pair.total_error().unwrap_or(alone);
    let known = |bound: f64| pair.has_variance().then_some(bound);
    let spread = NORMAL_95 * error * value.abs();
    Measure { value, low: known(value - spread), high: known(value + spread), truth_noise: known(error), perfect: 1.0 }
        .finite()
}

/// Mean of |x − r| w(r). With r = t + η: E|x − r| lies between |x − t| (Jensen) and |x − t| + E|η| (triangle), which
/// bounds the figure against t from both sides whatever the error; w is taken as known.
fn measure(pair: &Pair, weight: impl Fn(f64) -> f64) -> Measure {
    if !pair.is_sound() {
        return Measure::infinite(0.0, pair.has_variance());
    }
    let (mut sum, mut noise, mut variance) = (0.0, 0.0, 0.0);
    for values in pair.each() {
        let mut deviation = 0.0;
        for Value { x, r, v } in values {
            // A perfect pixel has no error, whatever its weight.
            sum += if x == r { 0.0 } else { (x - r).abs() * weight(r) };
            deviation += if v == 0.0 { 0.0 } else { v.sqrt() * weight(r) };
        }
        noise += MEAN_ABSOLUTE * deviation;
        variance += deviation * deviation;
    }
    let count = (pair.pixels() * pair.channels()) as f64;
    let (value, noise) = (sum / count, noise / count);
    // Of |η| the relative variance is π/2 − 1 where that of η² is 2.
    let common = (0.5 * std::f64::consts::PI - 1.0) / 2.0 * pair.common_scatter() * noise * noise;
    let spread = NORMAL_95 * (variance / (count * count) + common).sqrt();
    let known = |bound: f64| pair.has_variance().then_some(bound.max(0.0));
    Measure {
        value,
        low: known(value - noise - spread),
        high: known(value + spread),
        truth_noise: known(noise),
        perfect: 0.0,
    }
    .finite()
}
