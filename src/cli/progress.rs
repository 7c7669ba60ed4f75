//! A bar on stderr, on a terminal alone.

use indicatif::{ProgressBar, ProgressStyle};

use crate::lab::{Experiment, Step};

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
