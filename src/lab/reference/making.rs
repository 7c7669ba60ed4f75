//! A truth made for some pictures, until it does or the time is over.

use std::{ops::ControlFlow, time::Instant};

use super::{Auto, CAUSTIC, End, Making, Noise, SUMS, Sparing, TRUTHS, Watch, kept, subject::Subject};
use crate::{
    lab::{LabError, Picture},
    truth::{Run, Standing, estimate::CHUNKS, trace::Space},
};

/// Photons beyond what the noise so far asks for, so that one more look is enough most times.
const MARGIN: f64 = 1.05;
/// Chunks that tell their noise at all.
const LEAST: u64 = 2;

/// Everything that making one needs.
pub struct Maker<'a> {
    auto: &'a Auto<'a>,
    subject: &'a Subject,
    images: &'a [&'a Picture],
    started: Instant,
    sparing: Sparing,
}

impl<'a> Maker<'a> {
    pub fn new(auto: &'a Auto<'a>, subject: &'a Subject, images: &'a [&'a Picture]) -> Self {
        Self { auto, subject, images, started: Instant::now(), sparing: Sparing::default() }
    }

    /// Goes on from the sums in the store, and keeps there what comes out: the sums in any case, and the truth if it is
    /// better than the `known` noise of the best one there.
    pub fn finish(mut self, known: f64, watch: Watch) -> Result<(Picture, Noise, End), LabError> {
        let (task, store) = (self.subject.task(), self.auto.store);
        let key = task.key(&self.subject.scene);
        let space = Space::new(&self.subject.scene);
        let subject = self.subject.to_string();
        let nothing = Standing { photons: 0, noise: f64::INFINITY, missing: f64::INFINITY, finished: false };
        let mut look = |_| watch(&Making { subject: &subject, standing: nothing });
        let run = Run::watched(&space, self.subject.camera(), &task, &mut look);
        let mut run = run.ok_or(LabError::Interrupted)?;
        if let Some(sums) = store.get(SUMS, &key) {
            run.resume(&sums); // of another size they would be left alone
        }
        let before = run.chunks();
        let mut keep = |run: &Run| store.put(SUMS, &key, &run.checkpoint());
        let outcome = self.advance(&mut run, watch, &mut keep);
        if run.chunks() > before {
            keep(&run);
        }
        let (truth, noise, end) = outcome?;
        if noise.now < known && (run.chunks() >= LEAST || run.standing().finished) {
            store.put(TRUTHS, &key, &run.layers()?.to_exr(&run.provenance())?);
        }
        Ok((truth, noise, end))
    }

    /// Looks at the noise from time to time. How many chunks there are when it does is a function of the noise alone,
    /// not of how many threads made them.
    fn advance(
        &mut self,
        run: &mut Run,
        watch: Watch,
        keep: &mut dyn FnMut(&Run),
    ) -> Result<(Picture, Noise, End), LabError> {
        loop {
            let truth = kept::picture(run.layers()?, run.provenance());
            let noise = self.auto.noise(self.images, &truth)?;
            let chunks = run.chunks();
            if run.standing().finished || self.auto.layer != CAUSTIC {
                return Ok((truth, noise, End::Complete));
            }
            if chunks >= CHUNKS && noise.is_enough() {
                return Ok((truth, noise, End::Enough));
            }
            if self.is_late(run) {
                return Ok((truth, noise, End::Late));
            }
            self.grow(run, next_look(chunks, noise), noise.most, watch, keep)?;
        }
    }

    /// Adds chunks up to so many, or as many as the time allows.
    fn grow(
        &mut self,
        run: &mut Run,
        target: u64,
        most: f64,
        watch: Watch,
        keep: &mut dyn FnMut(&Run),
    ) -> Result<(), LabError> {
        let subject = self.subject.to_string();
        while run.chunks() < target && !self.is_late(run) {
            let standing = run.standing();
            // Relative noise falls as 1/photons.
            let missing = match standing.noise {
                noise if noise.is_finite() => (standing.photons as f64 * (noise / most - 1.0)).max(0.0),
                _ => f64::INFINITY,
            };
            if watch(&Making { subject: &subject, standing: Standing { missing, ..standing } }).is_break() {
                return Err(LabError::Interrupted);
            }
            let width = (rayon::current_num_threads() as u64).min(target - run.chunks());
            run.advance(width as usize, |_, _| ControlFlow::Break(()));
            if self.sparing.is_due() {
                self.sparing.keep(|| keep(run));
            }
        }
        Ok(())
    }

    fn is_late(&self, run: &Run) -> bool {
        run.chunks() >= LEAST && self.started.elapsed().as_secs_f64() >= self.auto.seconds
    }
}

/// The chunks at which the noise is looked at next: as many as it says are needed (it falls as 1/chunks), and not more
/// than twice those there are, for the figure moves too.
fn next_look(chunks: u64, noise: Noise) -> u64 {
    if chunks < CHUNKS {
        return CHUNKS;
    }
    let needed = MARGIN * chunks as f64 * noise.now / noise.most;
    (needed.ceil() as u64).clamp(chunks + chunks / 16 + 1, 2 * chunks)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_look_is_where_the_noise_should_do() {
        let at = |chunks, now, most| next_look(chunks, Noise { now, most });
        assert_eq!(at(0, f64::INFINITY, 0.0), CHUNKS);
        assert_eq!(at(100, 1.5e-3, 1e-3), 158); // ×1.5, ×1.05
        assert_eq!(at(100, 1.01e-3, 1e-3), 107); // not one by one
        assert_eq!([at(100, 1.0, 1e-3), at(100, 1.0, 0.0)], [200; 2]); // doubling at most
    }
}
