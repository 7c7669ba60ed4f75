//! How often what is being made is kept.

use std::time::{Duration, Instant};

/// The time between two times of keeping is at least this many times what keeping takes.
const SPARING: u32 = 4;

/// Keeps the time spent on keeping small beside the time spent on making.
#[derive(Debug, Default)]
pub struct Sparing(Option<(Instant, Duration)>);

impl Sparing {
    /// Whether it is time to keep again; the first time, always.
    pub fn is_due(&self) -> bool {
        self.0.is_none_or(|(at, took)| at.elapsed() >= SPARING * took)
    }

    /// Keeps, and takes the time.
    pub fn keep<T>(&mut self, keep: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let kept = keep();
        self.0 = Some((Instant::now(), begun.elapsed()));
        kept
    }
}
