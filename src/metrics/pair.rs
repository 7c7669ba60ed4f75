//! An image beside its truth.

/// Values of the pixels that are judged, `channels` a pixel, interleaved.
#[derive(Clone, Debug)]
pub struct Pair {
    channels: usize,
    image: Vec<f64>,
    reference: Vec<f64>,
    variance: Option<Vec<f64>>,
    correlation: Correlation,
}

/// How the errors of a reference move together, as far as that is known; without it, pixel by pixel on their own.
#[derive(Clone, Copy, Debug, Default)]
pub struct Correlation {
    /// As how many independent values the mean of the squared errors scatters.
    pub freedom: Option<f64>,
    /// Standard error of the reference's total, relative to it.
    pub total: Option<f64>,
}

/// One value of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value {
    /// The image's.
    pub x: f64,
    /// The truth's.
    pub r: f64,
    /// Variance of `r`; 0 where it is not known.
    pub v: f64,
}

impl Pair {
    /// Image, reference and, where it is known, the variance of each value of the reference (not of its square root).
    /// `None` if the lengths differ, or are no multiple of `channels`.
    pub fn new(channels: usize, image: Vec<f64>, reference: Vec<f64>, variance: Option<Vec<f64>>) -> Option<Self> {
        let len = image.len();
        let alike = reference.len() == len && variance.as_ref().is_none_or(|v| v.len() == len);
        (alike && channels > 0 && len.is_multiple_of(channels)).then_some(Self {
            channels,
            image,
            reference,
            variance,
            correlation: Correlation::default(),
        })
    }

    /// With what is known of how the reference's errors move together.
    pub fn correlated(self, correlation: Correlation) -> Self {
        Self { correlation, ..self }
    }

    /// With the image multiplied by a number.
    pub(super) fn scaled(mut self, scale: f64) -> Self {
        self.image.iter_mut().for_each(|x| *x *= scale);
        self
    }

    /// Relative variance of a mean of squared errors beyond that of independent pixels: of a normal error's square it is 2.
    pub(super) fn common_scatter(&self) -> f64 {
        self.correlation.freedom.map_or(0.0, |freedom| 2.0 / freedom)
    }

    /// Relative standard error of the reference's total, if it is known.
    pub(super) fn total_error(&self) -> Option<f64> {
        self.correlation.total
    }

    /// How many pixels are judged.
    pub fn pixels(&self) -> usize {
        self.image.len() / self.channels
    }

    /// Values a pixel.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Whether the reference says how noisy it is.
    pub fn has_variance(&self) -> bool {
        self.variance.is_some()
    }

    /// Mean over all values of `of` the reference.
    pub(super) fn reference_mean(&self, of: fn(f64) -> f64) -> f64 {
        self.reference.iter().map(|&r| of(r)).sum::<f64>() / self.reference.len() as f64
    }

    /// The values of each pixel in turn.
    pub(super) fn each(&self) -> impl ExactSizeIterator<Item = impl Iterator<Item = Value>> {
        (0..self.pixels()).map(move |pixel| {
            (pixel * self.channels..(pixel + 1) * self.channels).map(move |at| Value {
                x: self.image[at],
                r: self.reference[at],
                v: self.variance.as_ref().map_or(0.0, |v| v[at]),
            })
        })
    }

    /// Whether there is something to judge, and all of it is a number. A variance below zero is none.
    pub(super) fn is_sound(&self) -> bool {
        let finite = |values: &[f64]| values.iter().all(|v| v.is_finite());
        let variance = self.variance.as_ref().is_none_or(|v| finite(v) && v.iter().all(|v| *v >= 0.0));
        !self.image.is_empty() && finite(&self.image) && finite(&self.reference) && variance
    }
}
