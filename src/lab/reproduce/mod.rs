//! A published table beside a run of it here: times of the same phases, the shape that they make, and the error of each
//! picture, which no paper printed.

mod asked;
mod claims;
mod columns;
mod measure;
mod report;
mod strip;
mod subject;
mod text;

use std::ops::ControlFlow;

use super::{LabError, papers::Published};
use crate::{gpu::Gpu, store::Store};

pub use report::{CatalogueReport, ReproduceReport};

/// How far a run goes.
#[derive(Clone, Debug)]
pub struct Extent {
    /// Whether this is the quick run, which then says so.
    pub quick: bool,
    /// The largest N that is run.
    pub most_side: u32,
    /// Timed frames of each variant.
    pub rounds: u32,
    /// For all frames together, s. N that would take longer are left out, and where it is up no round is added; both are
    /// said. One round of the smallest N is always made.
    pub seconds: f64,
    /// For the truth, s: less where the frames took more than theirs.
    pub truth_seconds: f64,
    /// Of the picture, pixels.
    pub size: [u32; 2],
}

impl Extent {
    /// Small N and few frames: a minute on a software device.
    pub fn quick() -> Self {
        Self { quick: true, most_side: 512, rounds: 8, seconds: 46.0, truth_seconds: 10.0, size: [64, 64] }
    }

    /// Every N of the paper that the time and the device's memory allow.
    pub fn whole(seconds: f64) -> Self {
        let truth_seconds = 0.2 * seconds;
        let size = [256, 256];
        Self { quick: false, most_side: u32::MAX, rounds: 15, seconds: seconds - truth_seconds, truth_seconds, size }
    }
}

/// What a run is told and asked: words for whoever watches, and whether to go on.
pub type Watch<'w> = &'w mut dyn FnMut(&str) -> ControlFlow<()>;

/// Whether any column of a table can be run.
pub fn can_run(published: &Published) -> bool {
    published
        .figures
        .iter()
        .any(|figure| columns::asked(published, figure).is_ok_and(|asked| !asked.places().is_empty()))
}

/// Runs what can be run of a table.
///
/// # Errors
/// Those of rendering; [`LabError::Interrupted`] when `watch` breaks off.
pub fn reproduce(
    gpu: &Gpu,
    store: &Store,
    published: &Published,
    extent: &Extent,
    watch: Watch,
) -> Result<ReproduceReport, LabError> {
    let run = measure::run(gpu, store, published, extent, watch)?;
    Ok(ReproduceReport::measured(published, extent, run))
}
