//! Intervals of medians by the bootstrap (Efron and Tibshirani 1993, chapter 13: percentile intervals), nowhere narrower
//! than the order statistics of the sign test allow, which hold for any distribution: of few samples the bootstrap alone
//! misses the median 2.5 times as often as it says.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use super::{median, percentile, write_number};

/// The confidence of every interval that the lab prints.
pub const CONFIDENCE: f64 = 0.99;
/// At 99 % some ten of them lie beyond either end.
const RESAMPLES: usize = 2000;

/// A value, and where it lies with a stated confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// The value of the sample.
    #[serde(serialize_with = "write_number")]
    pub value: f64,
    /// Lower end.
    #[serde(serialize_with = "write_number")]
    pub low: f64,
    /// Upper end.
    #[serde(serialize_with = "write_number")]
    pub high: f64,
}

impl Interval {
    /// What was counted: there is no doubt about it.
    pub fn exact(value: f64) -> Self {
        Self { value, low: value, high: value }
    }

    /// Whether `x` lies in it, its ends included. Nothing lies in an interval with an end that is no number.
    pub fn contains(&self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// Nothing is known: from zero to infinity.
    const UNKNOWN: Self = Self { value: f64::INFINITY, low: 0.0, high: f64::INFINITY };
}

/// The median of positive quantities and its interval. Fewer samples than an interval of this confidence can be made
/// from (eight, for 99 %) give one without bounds: from zero to infinity.
pub fn bootstrap_median(samples: &[f64], confidence: f64, seed: u64) -> Interval {
    let value = median(samples);
    if !value.is_finite() {
        return Interval::UNKNOWN;
    }
    if samples.len() < least_samples(confidence) {
        return Interval { value, ..Interval::UNKNOWN };
    }
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut resample = vec![0.0; samples.len()];
    let mut medians: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            resample.fill_with(|| samples[random.random_range(0..samples.len())]);
            median(&resample)
        })
        .collect();
    medians.sort_unstable_by(f64::total_cmp);
    let tail = 50.0 * (1.0 - confidence);
    let (low, high) = order_statistics(samples, confidence);
    Interval { value, low: percentile(&medians, tail).min(low), high: percentile(&medians, 100.0 - tail).max(high) }
}

/// The innermost order statistics between which the median lies with this confidence, whatever the distribution: the
/// number of samples below the median is binomial.
fn order_statistics(samples: &[f64], confidence: f64) -> (f64, f64) {
    let n = samples.len();
    let mut sorted = samples.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let (mut below, mut binomial, mut at) = (0.0, 0.5f64.powi(n as i32), 0);
    while at < n / 2 && below + binomial <= 0.5 * (1.0 - confidence) {
        below += binomial;
        at += 1;
        binomial *= (n + 1 - at) as f64 / at as f64;
    }
    let at = at.saturating_sub(1);
    (sorted[at], sorted[n - 1 - at])
}

/// How many times as large the second of each pair is: the median of the ratios, and its interval. Pairs are of one
/// round, so that what slows a whole round cancels. A pair that has no ratio leaves nothing known.
pub fn bootstrap_ratio(pairs: &[(f64, f64)], confidence: f64, seed: u64) -> Interval {
    let ratios: Vec<f64> = pairs.iter().map(|&(a, b)| if a > 0.0 && b > 0.0 { b / a } else { f64::NAN }).collect();
    bootstrap_median(&ratios, confidence, seed)
}

/// How many times as large the median of `after` is as that of `before`, of samples that came apart: the quotients that
/// the intervals of both medians allow, each at half the doubt.
pub fn bootstrap_change(before: &[f64], after: &[f64], confidence: f64, seed: u64) -> Interval {
    // Both hold at once with at least the confidence asked for (Bonferroni).
    let each = 1.0 - 0.5 * (1.0 - confidence);
    let [a, b] = [before, after].map(|samples| bootstrap_median(samples, each, seed));
    if !(a.value > 0.0 && b.value.is_finite()) {
        return Interval::UNKNOWN;
    }
    let high = if a.low > 0.0 { b.high / a.low } else { f64::INFINITY };
    Interval { value: b.value / a.value, low: b.low / a.high, high }
}

/// All of n samples lie on one side of the true median in 2^(1-n) of all cases: with fewer than these, even the whole
/// range of the sample is no interval of this confidence.
fn least_samples(confidence: f64) -> usize {
    (1.0 - (1.0 - confidence).log2()).ceil() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// False alarms of a 99 % interval on `n` samples from `draw`, whose median is 1, of 1000.
    fn missed(n: usize, draw: impl Fn(&mut Pcg64Mcg) -> f64) -> usize {
        let mut random = Pcg64Mcg::seed_from_u64(7);
        let mut sample = vec![0.0; n];
        (0..1000)
            .filter(|&seed| {
                sample.fill_with(|| draw(&mut random));
                !bootstrap_median(&sample, CONFIDENCE, seed).contains(1.0)
            })
            .count()
    }

    fn normal(random: &mut Pcg64Mcg) -> f64 {
        let (u, v): (f64, f64) = (1.0 - random.random::<f64>(), random.random());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }

    /// Ten of a thousand are stated; three standard deviations of that count more.
    const MISSED: usize = 20;

    /// As timings are: a long upper tail, and spikes.
    fn spiked(random: &mut Pcg64Mcg) -> f64 {
        (0.1 * normal(random)).exp() * if random.random::<f64>() < 0.1 { 1.5 } else { 1.0 }
    }

    #[test]
    fn the_true_median_is_missed_as_seldom_as_stated() {
        let mut random = Pcg64Mcg::seed_from_u64(1);
        let many: Vec<f64> = (0..400_001).map(|_| spiked(&mut random)).collect();
        let centre = median(&many);
        for n in [8, 11, 15, 20, 40] {
            let [plain, spikes] = [missed(n, |r| 1.0 + 0.05 * normal(r)), missed(n, |r| spiked(r) / centre)];
            assert!(plain <= MISSED && spikes <= MISSED, "{n} samples: {plain} and {spikes} of 1000");
        }
    }

    #[test]
    fn a_tenth_more_is_found_in_pairs_of_rounds() {
        // 2 % of noise within a round, 20 % from round to round, which pairs cancel.
        let mut random = Pcg64Mcg::seed_from_u64(2);
        let called = |slower: f64, random: &mut Pcg64Mcg| {
            let found = (0..200).filter(|&seed| {
                let round = |r: &mut Pcg64Mcg| {
                    let level = (0.2 * normal(r)).exp();
                    (level * (1.0 + 0.02 * normal(r)), slower * level * (1.0 + 0.02 * normal(r)))
                };
                let pairs: Vec<_> = (0..12).map(|_| round(random)).collect();
                !bootstrap_ratio(&pairs, CONFIDENCE, seed).contains(1.0)
            });
            found.count()
        };
        assert!(called(1.1, &mut random) >= 198);
        assert!(called(1.0, &mut random) <= 6);
    }

    #[test]
    fn too_few_samples_have_no_bounds() {
        let few = bootstrap_median(&[1.0; 7], CONFIDENCE, 0);
        assert_eq!((few.value, few.low, few.high), (1.0, 0.0, f64::INFINITY));
        assert_eq!(bootstrap_median(&[1.0; 8], CONFIDENCE, 0), Interval { value: 1.0, low: 1.0, high: 1.0 });
    }

    #[test]
    fn what_was_not_measured_is_unknown() {
        for bad in [&[][..], &[f64::NAN; 9], &[f64::INFINITY; 9]] {
            assert_eq!(bootstrap_median(bad, CONFIDENCE, 0), Interval::UNKNOWN);
        }
        assert_eq!(bootstrap_ratio(&[(0.0, 1.0); 9], CONFIDENCE, 0), Interval::UNKNOWN);
        assert_eq!(bootstrap_ratio(&[(2.0, 3.0); 9], CONFIDENCE, 0).value, 1.5);
    }

    #[test]
    fn what_came_apart_is_compared_more_carefully() {
        let sample = |level: f64| (0..20).map(|k| level * (1.0 + 0.002 * f64::from(k * 7 % 11))).collect::<Vec<_>>();
        let more = bootstrap_change(&sample(1.0), &sample(1.1), CONFIDENCE, 0);
        assert!((more.value - 1.1).abs() < 1e-12 && more.low > 1.05 && more.high < 1.15, "{more:?}");
        assert!(bootstrap_change(&sample(1.0), &sample(1.001), CONFIDENCE, 0).contains(1.0));
        assert!(bootstrap_change(&[1.0], &[9.0], CONFIDENCE, 0).contains(1.0), "one sample says nothing");
        assert_eq!(bootstrap_change(&[0.0; 20], &sample(1.0), CONFIDENCE, 0), Interval::UNKNOWN);
    }

    #[test]
    fn one_seed_is_one_interval() {
        let sample: Vec<f64> = (0..20).map(|k| 1.0 + f64::from(k * k % 7)).collect();
        assert_eq!(bootstrap_median(&sample, CONFIDENCE, 3), bootstrap_median(&sample, CONFIDENCE, 3));
    }
}
