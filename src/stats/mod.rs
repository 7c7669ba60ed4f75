//! Order statistics of small samples: what timings and errors are summed up with.
//!
//! A NaN or an infinity among the values, or no value at all, gives infinity: what was not measured passes no test
//! and wins no comparison.

mod bootstrap;
mod number;
mod series;

pub use bootstrap::{CONFIDENCE, Interval, bootstrap_change, bootstrap_median, bootstrap_ratio};
pub use number::{Number, write_number};
pub use series::{Change, Moves, change_of, is_settled};

/// The middle value; the mean of the two middle ones for an even count.
///
/// # Examples
/// ```
/// assert_eq!(nephroid::stats::median(&[3.0, 1.0, 2.0]), 2.0);
/// assert_eq!(nephroid::stats::median(&[1.0, f64::NAN]), f64::INFINITY);
/// ```
pub fn median(values: &[f64]) -> f64 {
    percentile(values, 50.0)
}

/// Median absolute deviation from the median, in the values' own unit (not scaled by 1.4826 to a normal σ).
pub fn mad(values: &[f64]) -> f64 {
    let centre = median(values);
    let deviations: Vec<f64> = values.iter().map(|v| (v - centre).abs()).collect();
    median(&deviations)
}

/// The value below which `percent` per cent of the sample lie, linear between order statistics (Hyndman & Fan 1996,
/// definition 7: NumPy's default). `percent` is clamped to [0, 100]; 0 is the minimum, 100 the maximum.
pub fn percentile(values: &[f64], percent: f64) -> f64 {
    if values.is_empty() || percent.is_nan() || values.iter().any(|v| !v.is_finite()) {
        return f64::INFINITY;
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let position = percent.clamp(0.0, 100.0) / 100.0 * (sorted.len() - 1) as f64;
    let below = sorted[position.floor() as usize];
    let above = sorted[position.ceil() as usize];
    below + (above - below) * position.fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_by_hand() {
        assert_eq!(median(&[7.0]), 7.0);
        assert_eq!(median(&[9.0, -1.0, 4.0]), 4.0);
        assert_eq!(median(&[4.0, 1.0, 3.0, 2.0]), 2.5);
    }

    #[test]
    fn mad_by_hand() {
        // Median 2, deviations 1 1 0 0 2 4 7, sorted 0 0 1 1 2 4 7.
        assert_eq!(mad(&[1.0, 1.0, 2.0, 2.0, 4.0, 6.0, 9.0]), 1.0);
        assert_eq!(mad(&[5.0, 5.0, 5.0]), 0.0);
        assert_eq!(mad(&[5.0]), 0.0);
    }

    #[test]
    fn percentiles_by_hand() {
        let sample = [40.0, 10.0, 30.0, 20.0, 50.0];
        assert_eq!(percentile(&sample, 0.0), 10.0);
        assert_eq!(percentile(&sample, 25.0), 20.0);
        assert_eq!(percentile(&sample, 90.0), 46.0);
        assert_eq!(percentile(&sample, 100.0), 50.0);
        assert_eq!(percentile(&sample, 250.0), 50.0);
        assert_eq!(percentile(&sample, -1.0), 10.0);
    }

    #[test]
    fn what_is_not_finite_or_not_there_is_infinite() {
        for bad in [&[1.0, f64::NAN, 2.0][..], &[f64::INFINITY, 1.0], &[f64::NEG_INFINITY, 1.0, 2.0], &[]] {
            assert_eq!(median(bad), f64::INFINITY);
            assert_eq!(mad(bad), f64::INFINITY);
            assert_eq!(percentile(bad, 99.0), f64::INFINITY);
        }
        assert_eq!(percentile(&[1.0], f64::NAN), f64::INFINITY);
    }
}
