//! Two ways to a caustic's irradiance that share no reconstruction: photons counted in pixels, and cells of light whose
//! flux is spread over the area that they land on. Both come in chunks that are added in their order, so the result
//! depends neither on how many threads made them nor on whether the run was broken off and resumed.

mod cells;
mod counts;
mod sums;

use std::{fmt, str::FromStr};

pub use cells::Cells;
pub use counts::{CHUNKS, Counts, PARTS};
pub use sums::{BANDS, Sums};

use super::{Goal, Standing};
use crate::names::NoSuch;

/// Which way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Estimator {
    /// Low-discrepancy photons counted in pixels: unbiased, with a variance.
    #[default]
    Photons,
    /// A grid of cells between rays, refined where light folds or breaks: no noise, an error that falls with the cell.
    Cells,
}

impl fmt::Display for Estimator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Photons => "photons",
            Self::Cells => "cells",
        })
    }
}

impl FromStr for Estimator {
    type Err = NoSuch;

    fn from_str(text: &str) -> Result<Self, NoSuch> {
        let found = [Self::Photons, Self::Cells].into_iter().find(|estimator| estimator.to_string() == text);
        found.ok_or_else(|| NoSuch::new("estimator", text, ["photons", "cells"]))
    }
}

/// What is judged, and against what: pixels, and the ε of relMSE.
#[derive(Clone, Debug)]
pub struct Judged {
    /// Whether each pixel counts.
    pub pixels: Vec<bool>,
    /// (W/m²)²
    pub epsilon: f64,
}

impl Judged {
    /// What a perfect image would score in relMSE against an estimate: the mean of σ²/(x² + ε) over the pixels judged.
    pub fn noise(&self, mean: impl Iterator<Item = f64>, variance: impl Iterator<Item = f64>) -> f64 {
        let at = mean.zip(variance).enumerate().filter(|(k, _)| self.pixels[k / BANDS]);
        let (sum, count) = at.fold((0.0, 0u64), |(sum, count), (_, (x, variance))| {
            let one = if variance == 0.0 { 0.0 } else { variance / (x * x + self.epsilon) };
            (sum + one, count + 1)
        });
        if count == 0 { 0.0 } else { sum / count as f64 }
    }
}

/// An estimate in the making, of irradiance (W/m², [`BANDS`] a pixel).
pub trait Estimate: Send + Sync {
    /// Chunks added so far.
    fn chunks(&self) -> u64;

    /// Chunk `k`, a function of nothing else.
    fn chunk(&self, k: u64) -> Vec<f64>;

    /// Adds the next chunk.
    fn add(&mut self, chunk: &[f64]);

    /// How far it is from the goal: dear, since it looks at every pixel.
    fn standing(&self, goal: &Goal) -> Standing;

    /// Whether the goal may have been met by the last chunk, whatever the pixels say.
    fn may_be_finished(&self, goal: &Goal) -> bool;

    /// The irradiance.
    fn mean(&self) -> Vec<f64>;

    /// Its variance; infinite while it is not known.
    fn variance(&self) -> Vec<f64>;

    /// What else the file should say, by name.
    fn about(&self) -> Vec<(&'static str, String)>;

    /// All that was added, to go on from.
    fn to_bytes(&self) -> Vec<u8>;

    /// Goes on from [`Self::to_bytes`] of the same task; false, and nothing changes, if the bytes are of another size.
    fn resume(&mut self, bytes: &[u8]) -> bool;
}
