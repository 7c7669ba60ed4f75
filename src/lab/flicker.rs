//! Flicker of a sequence against the truth of each of its frames.

use std::sync::Arc;

use super::{
    CompareError, Picture,
    compare::{LEAST_JUDGED, kept},
};
use crate::metrics::{self, Measure, Pair};

/// How much more a layer changes from frame to frame than its truths do ([`metrics::flicker`]), over the pixels that no
/// frame and no truth masks.
///
/// # Errors
/// [`CompareError`] of a frame that cannot be held against its truth, or where masks leave too little.
pub fn flicker(frames: &[Picture], truths: &[Arc<Picture>], layer: &str) -> Result<Option<Measure>, CompareError> {
    let Some(first) = frames.first() else { return Ok(None) };
    let mut judged = first.unmasked()?;
    for picture in frames.iter().chain(truths.iter().map(Arc::as_ref)) {
        let mask = picture.unmasked()?;
        if mask.len() != judged.len() {
            let (image, reference) = (first.file.clone(), picture.file.clone());
            let (image_size, reference_size) = (first.size(), picture.size());
            return Err(CompareError::Size { image, image_size, reference, reference_size });
        }
        judged.iter_mut().zip(mask).for_each(|(judged, mask)| *judged &= mask);
    }
    let pixels = judged.iter().filter(|judged| **judged).count();
    if pixels == 0 || (pixels as f64) < LEAST_JUDGED * judged.len() as f64 {
        let (image, masked, pixels) = (first.file.clone(), judged.len() - pixels, judged.len());
        return Err(CompareError::Masked { image, masked, pixels });
    }
    let pair = |(image, truth): (&Picture, &Arc<Picture>)| {
        let (x, r) = (image.layer(layer)?, truth.layer(layer)?);
        truth.check_channels(r, x.channels())?;
        let variance = truth.variance(layer).map(|variance| kept(variance, &judged));
        let pair = Pair::new(x.channels(), kept(x, &judged), kept(r, &judged), variance);
        Ok(pair.expect("layers of one size and as many channels, checked above"))
    };
    let pairs = frames.iter().zip(truths).map(pair).collect::<Result<Vec<_>, CompareError>>()?;
    Ok(metrics::flicker(&pairs))
}
