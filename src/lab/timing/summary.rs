//! What samples come to.

use serde::Serialize;

use crate::stats::{self, CONFIDENCE, Interval};

/// A time, ms: the median of its samples, their spread, and the interval of the median at 99 %.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Median.
    pub median: f64,
    /// Median absolute deviation.
    pub mad: f64,
    /// Lower end of the median's interval.
    pub low: f64,
    /// Upper end; infinite where there are too few samples.
    pub high: f64,
    /// Every sample, in the order in which they came.
    pub samples: Vec<f64>,
}

impl Summary {
    /// Of samples.
    pub fn of(samples: Vec<f64>) -> Self {
        let Interval { value, low, high } = stats::bootstrap_median(&samples, CONFIDENCE, 0);
        Self { median: value, mad: stats::mad(&samples), low, high, samples }
    }
}

/// What a ratio shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The second takes longer.
    Slower,
    /// The second takes less long.
    Faster,
    /// The interval holds 1.
    #[serde(rename = "no difference shown")]
    None,
}

/// How many times as long one thing takes as another, with its interval at 99 %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ratio {
    /// The ratio.
    #[serde(flatten)]
    pub interval: Interval,
    /// What it shows.
    pub verdict: Verdict,
}

impl Ratio {
    /// Judged by its interval.
    pub fn of(interval: Interval) -> Self {
        let verdict = if interval.low > 1.0 {
            Verdict::Slower
        } else if interval.high < 1.0 {
            Verdict::Faster
        } else {
            Verdict::None
        };
        Self { interval, verdict }
    }

    /// In words: `1.31 (1.28 to 1.35)`, `1.01 (0.97 to 1.06): no difference shown`.
    pub fn words(&self) -> String {
        let Interval { value, low, high } = self.interval;
        let none = if self.verdict == Verdict::None { ": no difference shown" } else { "" };
        format!("{value:.3} ({low:.3} to {high:.3}){none}")
    }
}
