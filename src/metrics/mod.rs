//! Error measures in float64, each with what the truth's own noise does to it.
//!
//! | measure | mean over values (pixels × bands) of | constants |
//! |---|---|---|
//! | [`relmse`], the judged one | (x − r)² / (r² + ε) | ε = (0.1 E₀)², E₀ of [`bare_irradiance`] |
//! | [`relmse_debiased`] | the same, without what the truth's noise adds to it | the same |
//! | [`fitted()`] | the same, of s x for the s that makes it least | the same |
//! | [`relmse_standard`] | the same | ε = 10⁻² mean(r)² |
//! | [`relmse_trimmed`] | the same, without the worst 0.1 % of pixels | ε = 10⁻² mean(r)² |
//! | [`rmse`] | (x − r)², then its root | |
//! | [`mae`] | \|x − r\| | |
//! | [`mape`] | \|x − r\| / (\|r\| + ε) | ε = 10⁻² mean(\|r\|) |
//! | [`energy_ratio`] | Σx / Σr | |
//! | [`flicker()`] | (xₖ₊₁ − xₖ)² − (rₖ₊₁ − rₖ)², over mean(r)², of a sequence | |
//! | [`flip()`] | the difference that an eye sees | exposure, pixels per degree |
//!
//! x is the image, r the truth. The relative squared error with a mean in its ε is that of Rousselle, Knaus and Zwicker
//! 2011 ("Adaptive sampling and reconstruction using greedy error minimization", §6: ε = 10⁻² at a mean of one); the
//! relative absolute error with 10⁻² is the one that image viewers show. E₀ in place of the mean makes the figure the
//! same whatever share of the picture is lit.
//!
//! # Noise
//! What is known of the truth is r = t + η with Var η = v, the variance layer. [`Measure::value`] is the plain figure
//! against r. [`Measure::low`] to [`Measure::high`] hold the figure against the noiseless t with at least 95 %
//! confidence; for squared measures the noise adds to the plain figure, and the interval lies below it.
//! [`Measure::truth_noise`] is what t itself would score. The bands of one pixel move together (a photon lights all three).
//! Pixels are independent unless the reference says how far they are not ([`Correlation`]): the error of low-discrepancy
//! photons is a function of few random numbers, and its mean square scatters as if there were some tens of pixels.
//!
//! The squared measures are expanded to second order in η: where √v is a tenth of √(r² + ε) the noise is stated 6 % too
//! low, and the interval holds with 91 to 92 %. Not modelled: the scatter of v itself. Where few photons make a pixel
//! (below about ten), v is a rough guess.

mod absolute;
mod bare;
mod fitted;
mod flicker;
mod flip;
mod pair;
mod squared;

pub use absolute::{energy_ratio, mae, mape};
pub use bare::bare_irradiance;
pub use fitted::{Fitted, fitted};
pub use flicker::flicker;
pub use flip::{Flip, PIXELS_PER_DEGREE, Pictures, Seen, flip, flip_map, magma};
pub use pair::{Correlation, Pair};
pub use squared::{RELATIVE_TO_E0, relmse, relmse_debiased, relmse_standard, relmse_trimmed, rmse};

/// ε of the standard relative squared error, relative to the squared mean; of the absolute one, to the mean.
pub const RELATIVE_TO_MEAN: f64 = 1e-2;

/// The two-sided 95 % quantile of the normal distribution, in standard deviations.
pub const NORMAL_95: f64 = 1.959_963_984_540_054;

/// Figures closer to perfection than this many times the truth's noise say nothing.
pub const KNOWN_FROM: f64 = 2.0;

/// A figure and how well it is known. Infinite where a value that is not finite was measured, or nothing was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// Against the truth as it is, noise included.
    pub value: f64,
    /// Lower end of the 95 % interval of the figure against a truth without noise; none without a variance.
    pub low: Option<f64>,
    /// Its upper end.
    pub high: Option<f64>,
    /// What a perfect image would score; of a ratio, its standard error about one.
    pub truth_noise: Option<f64>,
    /// What a perfect image would score against a truth without noise.
    pub perfect: f64,
}

impl Measure {
    /// Without an interval: what stands for the variance is no noise that could be averaged.
    pub fn without_interval(self) -> Self {
        Self { low: None, high: None, ..self }
    }

    /// What was measured is no number: worse than anything.
    fn infinite(perfect: f64, noisy: bool) -> Self {
        let bound = noisy.then_some(f64::INFINITY);
        Self { value: f64::INFINITY, low: bound, high: bound, truth_noise: bound, perfect }
    }

    /// Whether the figure is lost in the truth's noise: nearer to perfection than twice that noise.
    pub fn is_noise(&self) -> bool {
        self.truth_noise.is_some_and(|noise| (self.value - self.perfect).abs() < KNOWN_FROM * noise)
    }

    /// This, or an infinite measure if any part of it is not finite.
    fn finite(self) -> Self {
        let parts = [Some(self.value), self.low, self.high, self.truth_noise];
        let noisy = self.truth_noise.is_some();
        if parts.into_iter().flatten().all(f64::is_finite) { self } else { Self::infinite(self.perfect, noisy) }
    }
}
