//! Another time: the scene is planned as it is then. Where the plan is the same but for what buffers hold, those are
//! filled anew, without an allocation or a pipeline; else (a lamp that comes into the glass needs six views for one) the
//! frame is planned again, and what did not change is kept.

use std::{sync::Arc, time::Instant};

use super::{Job, RenderError, Renderer, plan::plan_with, seen};
use crate::gpu::{Phase, Program};

/// What moving the scene has taken so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moved {
    /// The last time, on the host: scene, trees, plan, and what runs before the first frame; ms.
    pub ms: f64,
    /// How often it was moved.
    pub moves: u64,
    /// How often more than contents changed.
    pub replans: u64,
    /// Trees of deformed meshes that were fitted to them.
    pub refitted: u64,
    /// Those that were built again.
    pub rebuilt: u64,
}

impl Renderer {
    /// What moving the scene has taken so far; nothing where it stands still.
    pub fn moved(&self) -> Moved {
        self.moved
    }

    /// The scene at another time.
    pub(super) fn move_to(&mut self, time: f64) -> Result<(), RenderError> {
        if !self.job.scene.moves() || self.job.scene.time == time {
            return Ok(());
        }
        let start = Instant::now();
        let job = Job { scene: Arc::new(self.job.scene.at(time)), ..self.job.clone() };
        let planned = plan_with(&job, &mut self.trees)?;
        if !self.program.refresh(&planned.plan) {
            let (plan, old) = (planned.plan.clone(), Some(&self.program));
            self.program = Program::new(&self.gpu, plan, &self.sources, &self.store, old)?;
            self.moved.replans += 1;
        }
        if self.program.passes(Phase::Prepare).next().is_some() {
            self.program.run(Phase::Prepare, &[])?;
        }
        (self.camera, self.eye, self.eye_media) = seen(&job)?;
        (self.planned, self.job) = (planned, job);
        let (refitted, rebuilt) = (self.trees.refitted, self.trees.rebuilt);
        let ms = start.elapsed().as_secs_f64() * 1e3;
        self.moved = Moved { ms, moves: self.moved.moves + 1, refitted, rebuilt, ..self.moved };
        Ok(())
    }
}
