//! `--reference auto`: the truth of the scene that a picture names, from the store, or made and kept there.
//!
//! A truth will do for a picture when its noise is at most a tenth of the picture's judged figure: then the noise hardly
//! moves the figure. Until it does, photons are added, from where the last run of the same truth left off. Pictures of
//! one scene, class of paths and size share one truth, which does for all of them.

mod kept;
mod making;
mod sparing;
mod subject;

use std::{ops::ControlFlow, sync::Arc};

pub(super) use kept::picture;
pub use sparing::Sparing;

use super::{CompareError, LabError, Picture, compare::judged_figure};
use crate::{store::Store, truth::Standing};
use making::Maker;
use subject::Subject;

/// What finished truths are kept as in the store.
pub const TRUTHS: &str = "truth";
/// What the sums of truths that more photons can be added to are kept as.
pub const SUMS: &str = "truth-sums";

/// The layer that photons make; direct light is sampled once and for all.
pub(super) const CAUSTIC: &str = "irradiance.caustic";
/// The noise that a truth may have, of the figure that it is to judge.
const SHARE: f64 = 0.1;

/// How references are found or made.
pub struct Auto<'a> {
    /// The layer that is judged.
    pub layer: &'a str,
    /// The most time that goes into one truth, s.
    pub seconds: f64,
    /// Where truths are looked for and kept.
    pub store: &'a Store,
}

/// A truth in the making, as its watcher sees it.
pub struct Making<'a> {
    /// Scene, paths and size, in words.
    pub subject: &'a str,
    /// How far it is, and how far from enough.
    pub standing: Standing,
}

/// Asked before every group of photons whether to go on.
type Watch<'w> = &'w mut dyn FnMut(&Making) -> ControlFlow<()>;

/// How a reference came about.
#[derive(Clone, Copy)]
enum End {
    Stored,
    Enough,
    Late,
    /// No photon would change it.
    Complete,
}

/// The noise of a truth as relMSE, and the most that will do.
#[derive(Clone, Copy)]
struct Noise {
    now: f64,
    most: f64,
}

impl Noise {
    fn is_enough(self) -> bool {
        self.now <= self.most
    }
}

impl Auto<'_> {
    /// The reference of each picture; [`Picture::file`] says what it is.
    ///
    /// # Errors
    /// [`CompareError`] of a picture that names no scene, or one that has changed, or cannot be judged;
    /// [`LabError::Interrupted`] when `watch` breaks off: the sums so far are kept.
    pub fn references(&self, images: &[Picture], watch: Watch) -> Result<Vec<Arc<Picture>>, LabError> {
        let subjects = images.iter().map(Subject::of).collect::<Result<Vec<_>, _>>()?;
        let mut found: Vec<Option<Arc<Picture>>> = vec![None; images.len()];
        for (first, subject) in subjects.iter().enumerate() {
            if found[first].is_none() {
                let alike: Vec<usize> = (first..images.len()).filter(|k| subjects[*k].is_like(subject)).collect();
                let theirs: Vec<&Picture> = alike.iter().map(|k| &images[*k]).collect();
                let reference = Arc::new(self.reference(subject, &theirs, watch)?);
                alike.into_iter().for_each(|k| found[k] = Some(reference.clone()));
            }
        }
        Ok(found.into_iter().flatten().collect())
    }

    /// One truth for pictures of one subject.
    fn reference(&self, subject: &Subject, images: &[&Picture], watch: Watch) -> Result<Picture, LabError> {
        images.iter().try_for_each(|image| image.layer(self.layer).map(drop))?;
        let stored = kept::least_noisy(self.store, subject);
        let stored = stored.map(|truth| Ok::<_, CompareError>((self.noise(images, &truth)?, truth))).transpose()?;
        let (truth, noise, end) = match stored {
            Some((noise, truth)) if noise.is_enough() => (truth, noise, End::Stored),
            Some((noise, truth)) if self.layer != CAUSTIC => (truth, noise, End::Complete),
            stored => {
                let known = stored.as_ref().map_or(f64::INFINITY, |(noise, _)| noise.now);
                let (made, noise, end) = Maker::new(self, subject, images).finish(known, watch)?;
                // One made otherwise may be beyond what the time sufficed for.
                match stored {
                    Some((stored_noise, truth)) if known < noise.now => (truth, stored_noise, end),
                    _ => (made, noise, end),
                }
            }
        };
        Ok(self.named(truth, subject, noise, end))
    }

    /// The noise for the layer judged, and what all pictures allow. Of a figure that is no number, anything.
    fn noise(&self, images: &[&Picture], truth: &Picture) -> Result<Noise, CompareError> {
        let mut noise = Noise { now: 0.0, most: f64::INFINITY };
        for image in images {
            let figure = judged_figure(image, truth, self.layer)?;
            let now = figure.truth_noise.unwrap_or(f64::INFINITY);
            noise.now = noise.now.max(now);
            if figure.value.is_finite() {
                noise.most = noise.most.min(SHARE * (figure.value - now).max(0.0));
            }
        }
        Ok(noise)
    }

    fn named(&self, truth: Picture, subject: &Subject, noise: Noise, end: End) -> Picture {
        let how = match end {
            End::Stored => "from the store".to_owned(),
            End::Enough => "made to a tenth of the figure".to_owned(),
            End::Complete if noise.is_enough() => "complete".to_owned(),
            End::Complete => "complete: the figure's interval says what its noise allows".to_owned(),
            End::Late => format!("stopped after {} s: the figure's interval says what that allows", self.seconds),
        };
        let photons = truth.about.get("photons").map_or("?", String::as_str);
        let now = noise.now;
        Picture { file: format!("truth of {subject}: {photons} photons, noise relmse {now:.1e}, {how}"), ..truth }
    }
}
