//! An experiment: one frame of a prepared scene, warmed up, timed again and again, then counted and read back.

use std::{ops::ControlFlow, time::Instant};

use super::{CompareError, timing};
use crate::{
    gpu::{FrameTimes, PassCounters},
    image::{ImageError, Layers},
    passes::account::Account,
    renderer::{Energy, Frame, RenderError, Renderer, Unresolved},
    scene::SceneError,
    whole::FileError,
};

/// What can fail between a job and its files.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// Planning, preparing or rendering.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A scene that cannot be read.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Pictures that cannot be judged.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// A picture that cannot be encoded.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A file that cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A host's lock that cannot be opened.
    #[error("cannot open the lock {}: {reason}", path.display())]
    Lock {
        /// Its file.
        path: std::path::PathBuf,
        /// The system's.
        reason: std::io::Error,
    },
    /// Whoever watches said to stop.
    #[error("interrupted: nothing was written")]
    Interrupted,
    /// A sequence was stopped between two frames.
    #[error("interrupted after {done} of {count} frames: the same command goes on")]
    Stopped {
        /// Frames that are whole.
        done: usize,
        /// Frames of the sequence.
        count: usize,
    },
}

/// Where an experiment is, told before each step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// A frame that is not timed, from 0.
    Warmup(u32),
    /// A timed frame, from 0.
    Timed(u32),
    /// Counters of each pass, then the account of photons and watts.
    Counting,
    /// Layers read back.
    Reading,
}

/// How often a frame is rendered, and which.
#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    /// The frame: the same one every time.
    pub frame: Frame,
    /// Frames before timing begins.
    pub warmup: u32,
    /// Timed frames.
    pub repeat: u32,
}

/// What came out of it.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Stages in the order of [`FrameTimes::passes`].
    pub stages: Vec<String>,
    /// Every timed frame.
    pub frames: Vec<FrameTimes>,
    /// What each stage did, counted outside the timed frames.
    pub counters: Vec<PassCounters>,
    /// Photons and flux by how they ended.
    pub account: Account,
    /// The light deposited beside the light emitted.
    pub energy: Energy,
    /// What a method without photons left out.
    pub unresolved: Option<Unresolved>,
    /// The picture.
    pub layers: Layers,
}

impl Experiment {
    /// Renders, times, counts and reads; `watch` is asked before each step whether to go on.
    pub fn run(
        &self,
        renderer: &mut Renderer,
        watch: &mut dyn FnMut(Step) -> ControlFlow<()>,
    ) -> Result<Measured, LabError> {
        let mut at = |step| if watch(step).is_break() { Err(LabError::Interrupted) } else { Ok(()) };
        let begun = Instant::now();
        for index in 0..self.warmup {
            at(Step::Warmup(index))?;
            renderer.frame(&self.frame)?;
        }
        // Whoever asks for no warm-up gets none, and one frame has no median to spoil.
        let least = timing::least_warmup(renderer.gpu().info());
        while self.warmup > 0 && self.repeat > 1 && begun.elapsed() < least {
            at(Step::Warmup(self.warmup))?;
            renderer.frame(&self.frame)?;
        }
        let mut frames = Vec::new();
        for index in 0..self.repeat {
            at(Step::Timed(index))?;
            frames.push(renderer.frame(&self.frame)?);
        }
        at(Step::Counting)?;
        let (stages, counters) = renderer.counters(&self.frame)?.into_iter().unzip();
        let account = renderer.account()?;
        let unresolved = renderer.unresolved()?;
        at(Step::Reading)?;
        let energy = renderer.energy(&account)?;
        let layers = renderer.layers()?;
        Ok(Measured { stages, frames, counters, account, energy, unresolved, layers })
    }
}
