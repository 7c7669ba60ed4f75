//! Bars on stderr, on a terminal alone.

use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};

use super::output::say;
use crate::{
    lab::{Experiment, Step},
    truth::Standing,
};

/// Steps that are no frames: preparing, counting, reading.
const OTHERS: u64 = 3;

/// The bar; it vanishes when dropped.
pub struct Progress(ProgressBar);

impl Progress {
    pub fn new(experiment: &Experiment) -> Self {
        let steps = u64::from(experiment.warmup) + u64::from(experiment.repeat) + OTHERS;
        let style = ProgressStyle::with_template("{msg:24} {wide_bar} {pos}/{len} {elapsed}");
        let bar = ProgressBar::new(steps).with_message("preparing");
        Self(bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())))
    }

    pub fn at(&self, step: Step) {
        self.0.inc(1);
        self.0.set_message(match step {
            Step::Warmup(index) => format!("warm-up frame {}", index + 1),
            Step::Timed(index) => format!("timed frame {}", index + 1),
            Step::Counting => "counting".to_owned(),
            Step::Reading => "reading back".to_owned(),
        });
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// How many of several are done: frames of a sequence, points of a sweep.
pub struct CountProgress(ProgressBar);

impl CountProgress {
    pub fn new(count: u32) -> Self {
        let style = ProgressStyle::with_template("{msg:14} {wide_bar} {pos}/{len} {elapsed} {eta} left");
        let bar = ProgressBar::new(u64::from(count)).with_message("preparing");
        Self(bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())))
    }

    pub fn at(&self, done: usize, what: &str) {
        self.0.set_position(done as u64);
        self.0.set_message(what.to_owned());
    }

    /// A line beside the bar.
    pub fn say(&self, line: &str) {
        self.0.suspend(|| say(line));
    }
}

impl Drop for CountProgress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Of a truth: how far, how noisy, how long still.
pub struct TruthProgress {
    bar: ProgressBar,
    max_seconds: Option<f64>,
    /// Photons before this run.
    before: u64,
    started: Instant,
}

impl TruthProgress {
    const STEPS: u64 = 1000;

    pub fn new(max_seconds: Option<f64>) -> Self {
        let style = ProgressStyle::with_template("{msg} {wide_bar} {elapsed}");
        let bar = ProgressBar::new(Self::STEPS);
        let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar, max_seconds, before: 0, started: Instant::now() }
    }

    /// The share of direct light that is done.
    pub fn direct(&self, share: f64) {
        self.bar.set_position((share * Self::STEPS as f64) as u64);
        self.bar.set_message("direct light");
    }

    /// A line beside the bar.
    pub fn say(&self, line: &str) {
        self.bar.suspend(|| say(line));
    }

    /// From here on there are photons, of which so many were there before.
    pub fn start(&mut self, before: u64) {
        (self.before, self.started) = (before, Instant::now());
    }

    pub fn at(&self, standing: &Standing) {
        let (done, missing) = (standing.photons as f64, standing.missing);
        let seconds = self.started.elapsed().as_secs_f64();
        let made = (standing.photons - self.before).max(1) as f64;
        let limit = self.max_seconds.map_or(f64::INFINITY, |most| (most - seconds).max(0.0));
        let left = (missing * seconds / made).min(limit);
        self.bar.set_position((done / (done + missing) * Self::STEPS as f64) as u64);
        self.bar.set_message(format!("{done:.3e} photons, noise relmse {:.2e}, {left:.0} s left", standing.noise));
    }
}

impl Drop for TruthProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
