//! Honest timing, the one place where anything is timed that is compared: variants interleaved in rounds, each round in
//! another order, after a warm-up that lasts until the median settles; every sample kept; medians and ratios with the
//! interval they are known to, and warnings that say what to do.
//!
//! Based on: hyperfine's habits (warm-up, outliers, uncertainty of ratios). Differs: rounds are interleaved and
//! shuffled, so that what slows the machine for a while slows all variants alike and cancels in the ratios of one round.

mod busy;
mod summary;
#[cfg(test)]
mod tests;
mod warnings;

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use rand::{SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;

use super::LabError;
use crate::{
    gpu::{DeviceInfo, FrameTimes},
    stats,
};
use busy::Cores;

pub use summary::{Ratio, Summary, Verdict};

/// A warm-up has settled when the medians of two windows of this many frames differ by no more than [`SETTLED`].
const WINDOW: usize = 3;
const SETTLED: f64 = 0.05;

/// How long a device must be busy before its times are taken. Idle GPUs lower their clocks, and raise them only after some
/// tenths of a second: until then frames take several times as long, steadily (an H100: 19.8 ms in place of 3.8).
pub fn least_warmup(device: &DeviceInfo) -> Duration {
    if device.is_software() { Duration::ZERO } else { Duration::from_millis(500) }
}

/// How variants are timed.
#[derive(Clone, Copy, Debug)]
pub struct Rounds {
    /// Timed frames of each variant. From eight on a median has an interval of 99 %.
    pub rounds: u32,
    /// The most frames of each variant before that: fewer, if the median settles sooner.
    pub most_warmup: u32,
    /// The least time that the warm-ups take together, whatever settles: see [`least_warmup`].
    pub least_warmup: Duration,
    /// Of the order within the rounds, and of the bootstrap.
    pub seed: u64,
    /// When the time is up: from then on no frame begins, but those of the first round. A round that it cuts is left out.
    pub until: Option<Instant>,
}

/// Renders one frame of a variant.
pub type RenderFrame<'a> = Box<dyn FnMut() -> Result<FrameTimes, LabError> + 'a>;

/// One thing to be timed beside others.
pub struct Variant<'a> {
    /// What it is called in warnings.
    pub name: String,
    /// Its stages, in the order of [`FrameTimes::passes`].
    pub stages: Vec<String>,
    /// Renders a frame.
    pub frame: RenderFrame<'a>,
}

/// Where timing is, told before each frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beat {
    /// A frame of the warm-up of a variant.
    Warmup {
        /// The variant.
        variant: usize,
    },
    /// A frame of a round.
    Timed {
        /// From 0.
        round: u32,
        /// The variant.
        variant: usize,
    },
}

/// The samples of one variant, by round.
#[derive(Clone, Debug)]
pub struct Series {
    /// What it is called.
    pub name: String,
    /// Its stages.
    pub stages: Vec<String>,
    /// Its frames: the k-th is of round k, as the k-th of every other variant.
    pub frames: Vec<FrameTimes>,
    /// Frames of the warm-up.
    pub warmup: u32,
    /// Whether its median settled during the warm-up.
    pub settled: bool,
}

/// What was timed.
#[derive(Clone, Debug)]
pub struct Timed {
    /// The variants, in the order in which they were given.
    pub series: Vec<Series>,
    /// Share of the machine's cores that other processes took meanwhile, where the system tells.
    pub others: Option<f64>,
    seed: u64,
}

impl Rounds {
    /// Warms each variant up, then times all of them in rounds. `watch` is asked before each frame whether to go on.
    ///
    /// # Errors
    /// What a variant's frame fails with; [`LabError::Interrupted`] when `watch` breaks off.
    pub fn run(
        &self,
        variants: &mut [Variant<'_>],
        watch: &mut dyn FnMut(Beat) -> ControlFlow<()>,
    ) -> Result<Timed, LabError> {
        let mut at = |beat| if watch(beat).is_break() { Err(LabError::Interrupted) } else { Ok(()) };
        let mut series = Vec::new();
        let (begun, last) = (Instant::now(), variants.len().saturating_sub(1));
        for (index, variant) in variants.iter_mut().enumerate() {
            let mut spans = Vec::new();
            let settled = loop {
                let awake = index < last || begun.elapsed() >= self.least_warmup;
                if awake && stats::is_settled(&spans, WINDOW, SETTLED) {
                    break true;
                }
                if awake && spans.len() >= self.most_warmup as usize || self.is_late() {
                    break false;
                }
                at(Beat::Warmup { variant: index })?;
                spans.push((variant.frame)()?.span_ms);
            };
            let (name, stages, warmup) = (variant.name.clone(), variant.stages.clone(), spans.len() as u32);
            series.push(Series { name, stages, frames: Vec::new(), warmup, settled });
        }
        let mut random = Pcg64Mcg::seed_from_u64(self.seed);
        let mut order: Vec<usize> = (0..variants.len()).collect();
        let before = Cores::now();
        'rounds: for round in 0..self.rounds {
            order.shuffle(&mut random);
            for &variant in &order {
                if round > 0 && self.is_late() {
                    series.iter_mut().for_each(|s| s.frames.truncate(round as usize));
                    break 'rounds;
                }
                at(Beat::Timed { round, variant })?;
                series[variant].frames.push((variants[variant].frame)()?);
            }
        }
        let others = before.and_then(|before| Cores::now()?.others_since(&before));
        Ok(Timed { series, others, seed: self.seed })
    }

    fn is_late(&self) -> bool {
        self.until.is_some_and(|until| Instant::now() >= until)
    }
}

impl Series {
    /// From the first pass's beginning to the last one's end.
    pub fn span(&self) -> Summary {
        Summary::of(self.frames.iter().map(|f| f.span_ms).collect())
    }

    /// Of one pass; `None` if there is none of that name.
    pub fn stage(&self, name: &str) -> Option<Summary> {
        let at = self.stages.iter().position(|stage| stage == name)?;
        Some(Summary::of(self.frames.iter().map(|f| f.passes[at]).collect()))
    }

    /// Sum of the passes beside the span: what lies between the passes is missing from it.
    pub fn covered(&self) -> f64 {
        let shares = self.frames.iter().map(|f| f.passes.iter().sum::<f64>() / f.span_ms);
        stats::median(&shares.collect::<Vec<_>>())
    }
}

impl Timed {
    /// How many times as long variant `b` takes as variant `a`, by what `of` takes from a frame, ms.
    pub fn ratio(&self, (a, of_a): (usize, &Take), (b, of_b): (usize, &Take)) -> Ratio {
        let pairs = self.series[a].frames.iter().zip(&self.series[b].frames);
        let pairs: Vec<_> = pairs.map(|(x, y)| (of_a(x), of_b(y))).collect();
        Ratio::of(stats::bootstrap_ratio(&pairs, stats::CONFIDENCE, self.seed))
    }

    /// How many times as long the frames of variant `b` take as those of variant `a`.
    pub fn span_ratio(&self, a: usize, b: usize) -> Ratio {
        let span: &Take = &|frame| frame.span_ms;
        self.ratio((a, span), (b, span))
    }

    /// Timed frames of each.
    pub fn rounds(&self) -> u32 {
        self.series.first().map_or(0, |series| series.frames.len() as u32)
    }

    /// What makes these times less than they seem, and what to do about it. `tick_ms`: the device's clock.
    pub fn warnings(&self, tick_ms: f64) -> Vec<String> {
        warnings::warnings(self, tick_ms)
    }
}

/// Takes a time from a frame, ms.
pub type Take<'a> = dyn Fn(&FrameTimes) -> f64 + 'a;
