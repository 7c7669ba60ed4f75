//! What a series of measurements does over time: whether it has settled, and whether its level moved.

use serde::Serialize;

use super::median;

/// Chance that a series that does not move is said to, by each of two tests.
const ALARM: f64 = 5e-3;
/// Two-sided normal quantile of [`ALARM`].
const ALARM_SIGMAS: f64 = 2.807_033_768;
/// What moves by less is no concern of anyone's.
const LEAST_CHANGE: f64 = 0.02;

/// How a level moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Moves {
    /// From one level to another, before this sample.
    Step(usize),
    /// Bit by bit.
    Drift,
}

/// A level that moved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Change {
    /// How.
    pub moves: Moves,
    /// The level after, relative to the one before.
    pub factor: f64,
}

/// Whether the level of a series moved, by more than 2 % and more than chance does in one of two hundred: by the
/// change point of Pettitt (1979), or the trend of Mann (1945). A series with a value that is no number has no level.
pub fn change_of(series: &[f64]) -> Option<Change> {
    if series.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let ranks = ranks(series);
    let (split, steps) = pettitt(&ranks);
    let drifts = mann_kendall(series).abs() > ALARM_SIGMAS;
    if !steps && !drifts {
        return None;
    }
    let step = median(&series[split..]) / median(&series[..split]);
    let third = series.len().div_ceil(3);
    let drift = median(&series[series.len() - third..]) / median(&series[..third]);
    let (moves, factor) =
        if steps_rather_than_drifts(series, split) { (Moves::Step(split), step) } else { (Moves::Drift, drift) };
    (factor.is_finite() && (factor - 1.0).abs() > LEAST_CHANGE).then_some(Change { moves, factor })
}

/// Whether the last `window` values have the level of those before them: their medians differ by at most `most`.
pub fn is_settled(series: &[f64], window: usize, most: f64) -> bool {
    let Some(start) = series.len().checked_sub(2 * window) else { return false };
    let (before, after) = series[start..].split_at(window);
    (median(after) / median(before) - 1.0).abs() <= most
}

/// Mean ranks, from 1.
fn ranks(series: &[f64]) -> Vec<f64> {
    let below = |x: f64| series.iter().filter(|y| **y < x).count() as f64;
    let equal = |x: f64| series.iter().filter(|y| **y == x).count() as f64;
    series.iter().map(|&x| below(x) + 0.5 * (equal(x) + 1.0)).collect()
}

/// Where the series is best split, and whether the parts differ by more than chance (Pettitt 1979, eq. 2 and 3).
fn pettitt(ranks: &[f64]) -> (usize, bool) {
    let n = ranks.len() as f64;
    let (mut sum, mut best, mut at) = (0.0, 0.0, 0);
    for (k, rank) in ranks.iter().enumerate().take(ranks.len().saturating_sub(1)) {
        sum += rank;
        let u = (2.0 * sum - (k as f64 + 1.0) * (n + 1.0)).abs();
        if u > best {
            (best, at) = (u, k + 1);
        }
    }
    let chance = 2.0 * (-6.0 * best * best / (n * n * n + n * n)).exp();
    (at.max(1).min(ranks.len().max(1)), best > 0.0 && chance < ALARM)
}

/// The trend in standard deviations of no trend (Mann 1945; ties make it smaller, never larger).
fn mann_kendall(series: &[f64]) -> f64 {
    let n = series.len() as f64;
    let pairs = (0..series.len()).flat_map(|i| (i + 1..series.len()).map(move |j| (i, j)));
    let sum: f64 = pairs.map(|(i, j)| f64::from(series[j].total_cmp(&series[i]) as i8)).sum();
    let sigma = (n * (n - 1.0) * (2.0 * n + 5.0) / 18.0).sqrt();
    if sigma > 0.0 { (sum.abs() - 1.0).max(0.0).copysign(sum) / sigma } else { 0.0 }
}

/// Whether two levels leave less of the series than the line of Tukey (1977) through the medians of its outer thirds.
fn steps_rather_than_drifts(series: &[f64], split: usize) -> bool {
    let around = |part: &[f64]| {
        let centre = median(part);
        part.iter().map(|x| (x - centre).abs()).sum::<f64>()
    };
    let third = series.len().div_ceil(3);
    let (first, last) = (median(&series[..third]), median(&series[series.len() - third..]));
    let slope = (last - first) / (series.len() - third).max(1) as f64;
    let flat: Vec<f64> = series.iter().enumerate().map(|(k, x)| x - slope * k as f64).collect();
    around(&series[..split]) + around(&series[split..]) < around(&flat)
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    /// 30 samples of 5 % noise about what `level` says, a spike now and then.
    fn series(seed: u64, level: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let noise = |r: &mut Pcg64Mcg| (0..3).map(|_| r.random::<f64>() - 0.5).sum::<f64>() * 0.1;
        let spike = |r: &mut Pcg64Mcg| if r.random::<f64>() < 0.05 { 1.4 } else { 1.0 };
        (0..30).map(|k| level(k) * (1.0 + noise(&mut random)) * spike(&mut random)).collect()
    }

    fn found(level: impl Fn(usize) -> f64) -> Vec<Option<Change>> {
        (0..200).map(|seed| change_of(&series(seed, &level))).collect()
    }

    #[test]
    fn what_does_not_move_alarms_nobody() {
        // Two tests of one in two hundred each, on two hundred series; twice that is within chance.
        assert!(found(|_| 1.0).iter().flatten().count() <= 4);
        for still in [&[1.0; 30][..], &[], &[1.0], &[1.0, 2.0], &[f64::NAN; 30]] {
            assert_eq!(change_of(still), None);
        }
    }

    #[test]
    fn a_step_is_seen_where_it_is() {
        let steps = found(|k| if k < 12 { 1.0 } else { 1.3 });
        let right = |c: &Change| matches!(c.moves, Moves::Step(9..=15)) && (1.2..1.4).contains(&c.factor);
        let right = steps.iter().flatten().filter(|c| right(c)).count();
        assert!(right >= 190, "{right} of 200");
    }

    #[test]
    fn a_drift_is_seen_as_one() {
        let drifts = found(|k| 1.0 + 0.02 * k as f64);
        let right = |c: &Change| c.moves == Moves::Drift && (1.2..1.7).contains(&c.factor);
        let right = drifts.iter().flatten().filter(|c| right(c)).count();
        assert!(right >= 190, "{right} of 200");
    }

    #[test]
    fn small_changes_are_nobodys_concern() {
        let series: Vec<f64> = (0..40).map(|k| 1.0 + 1e-4 * f64::from(k)).collect();
        assert_eq!(change_of(&series), None);
    }

    #[test]
    fn a_warm_up_ends_when_its_median_settles() {
        let warming: Vec<f64> = (0..40).map(|k| 1.0 + 4.0 * (-0.3 * f64::from(k)).exp()).collect();
        let settled = (0..40).find(|&n| is_settled(&warming[..n], 3, 0.05)).unwrap();
        assert!((10..20).contains(&settled), "{settled}");
        assert!(!is_settled(&[1.0; 5], 3, 0.05) && is_settled(&[1.0; 6], 3, 0.05));
        assert!(!is_settled(&[f64::NAN; 6], 3, 0.05));
    }
}
