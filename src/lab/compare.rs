//! A picture judged against a reference over the receiver region.

use super::{CompareError, Picture, compare_warnings::warnings};
use crate::{
    image::Layer,
    metrics::{
        self, Correlation, Fitted, Measure, PIXELS_PER_DEGREE, Pair, Pictures, RELATIVE_TO_E0, RELATIVE_TO_MEAN, Seen,
    },
};

/// The least share of the region that has to be judged.
pub(super) const LEAST_JUDGED: f64 = 0.95;
/// The measures by name, in the order of the reports.
pub const MEASURES: [&str; 8] =
    ["relmse", "relmse_standard", "relmse_trimmed", "rmse", "mae", "mape", "energy_ratio", "flip"];

/// The judged figure without the reference's noise, and with the best scale: they stand beside [`MEASURES`] where they are known.
pub const DEBIASED: &str = "relmse_debiased";
/// See [`DEBIASED`].
pub const FITTED: &str = "relmse_fitted";

/// A picture and what is wrong with it.
pub struct Comparison {
    /// The picture's file.
    pub image: String,
    /// What it was judged by.
    pub reference: String,
    /// The layer compared.
    pub layer: String,
    /// Pixels judged.
    pub pixels: usize,
    /// Pixels of the region left out.
    pub masked: usize,
    /// What the measures were made with.
    pub constants: Constants,
    /// In the order of [`MEASURES`].
    pub measures: [Measure; 8],
    /// Of a picture that is right up to a scale.
    pub fitted: Option<Fitted>,
    /// The judged figure without what the reference's noise adds; where that noise is known.
    pub debiased: Option<Measure>,
    /// What differs between the two that should not.
    pub warnings: Vec<String>,
    pub(super) maps: Maps,
}

/// What the measures were made with.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct Constants {
    /// W/m²
    pub e0: f64,
    /// ε of `relmse`, (W/m²)².
    pub relmse_epsilon: f64,
    /// ε of `relmse_standard` and `relmse_trimmed`, relative to the squared mean of the reference.
    pub relmse_standard_epsilon: f64,
    /// ε of `mape`, relative to the mean of the reference.
    pub mape_epsilon: f64,
    /// EV
    pub flip_exposure: f64,
    /// 1/degree
    pub flip_pixels_per_degree: f64,
}

/// Errors of each pixel.
pub(super) struct Maps {
    pub size: [usize; 2],
    pub judged: Vec<bool>,
    /// Mean of the bands, image − reference.
    pub signed: Vec<f64>,
    pub flip: Vec<f32>,
}

/// Judges one layer of an image against the same layer of a reference.
///
/// Both are pictures of the whole receiver region. The reference's `LAYER.variance` says how noisy it is. Pixels that
/// either masks are left out.
pub fn compare(image: &Picture, reference: &Picture, layer: &str) -> Result<Comparison, CompareError> {
    let sides = Sides::of(image, reference, layer)?;
    let constants = constants(image, reference)?;
    let seen = Seen { ev: constants.flip_exposure, pixels_per_degree: constants.flip_pixels_per_degree };
    let [xs, rs] = [sides.x, sides.r].map(rgb);
    let vs = sides.variance.map(rgb);
    let pictures =
        Pictures { size: image.size(), image: &xs, reference: &rs, variance: vs.as_deref(), judged: &sides.judged };
    let fitted = image.is_relative(layer).then(|| metrics::fitted(&sides.pair(), constants.e0));
    let fitted = fitted.map(|fit| Fitted { relmse: interval(reference, fit.relmse), ..fit });
    let debiased = (!is_cells(reference)).then(|| metrics::relmse_debiased(&sides.pair(), constants.e0)).flatten();
    let flip = metrics::flip(&pictures, &seen).expect("both pictures and the mask are of one size, checked above");
    Ok(Comparison {
        image: image.file.clone(),
        reference: reference.file.clone(),
        layer: layer.to_owned(),
        pixels: sides.pixels,
        masked: sides.judged.len() - sides.pixels,
        measures: measures(&sides.pair(), constants.e0, flip.measure).map(|measure| interval(reference, measure)),
        fitted,
        debiased,
        constants,
        warnings: warnings(image, reference, &sides),
        maps: Maps { size: image.size(), signed: signed(sides.x, sides.r), flip: flip.map, judged: sides.judged },
    })
}

/// The judged figure alone, at a fraction of the cost of all measures.
pub(super) fn judged_figure(image: &Picture, reference: &Picture, layer: &str) -> Result<Measure, CompareError> {
    let sides = Sides::of(image, reference, layer)?;
    Ok(metrics::relmse(&sides.pair(), e0(image, reference)?))
}

/// The best scale and the figure with it, of a picture that is right only up to one.
pub(super) fn fitted_figure(image: &Picture, reference: &Picture, layer: &str) -> Result<Option<Fitted>, CompareError> {
    let fit = |sides: Sides| Ok(metrics::fitted(&sides.pair(), e0(image, reference)?));
    image.is_relative(layer).then(|| Sides::of(image, reference, layer).and_then(fit)).transpose()
}

/// One layer of both, and where they are held against each other.
pub(super) struct Sides<'p> {
    pub x: &'p Layer,
    pub r: &'p Layer,
    /// Of `r`, where it is known.
    pub variance: Option<&'p Layer>,
    pub correlation: Correlation,
    pub judged: Vec<bool>,
    /// How many are judged.
    pub pixels: usize,
}

impl<'p> Sides<'p> {
    fn of(image: &'p Picture, reference: &'p Picture, layer: &str) -> Result<Self, CompareError> {
        check_sizes(image, reference)?;
        let (x, r) = (image.layer(layer)?, reference.layer(layer)?);
        reference.check_channels(r, x.channels())?;
        let variance = reference.variance(layer);
        variance.map_or(Ok(()), |v| reference.check_channels(v, x.channels()))?;
        image.check_camera()?;
        reference.check_camera()?;
        let judged: Vec<bool> = image.unmasked()?.into_iter().zip(reference.unmasked()?).map(|(a, b)| a && b).collect();
        let pixels = judged.iter().filter(|&&kept| kept).count();
        if pixels == 0 || (pixels as f64) < LEAST_JUDGED * judged.len() as f64 {
            let masked = judged.len() - pixels;
            return Err(CompareError::Masked { image: image.file.clone(), masked, pixels: judged.len() });
        }
        let correlation = reference.correlation(layer);
        Ok(Self { x, r, variance, correlation, judged, pixels })
    }

    fn pair(&self) -> Pair {
        let [x, r] = [self.x, self.r].map(|layer| kept(layer, &self.judged));
        Pair::new(self.x.channels(), x, r, self.variance.map(|v| kept(v, &self.judged)))
            .expect("layers of one size and as many channels, checked when they were put together")
            .correlated(self.correlation)
    }
}

fn check_sizes(image: &Picture, reference: &Picture) -> Result<(), CompareError> {
    let (image_size, reference_size) = (image.size(), reference.size());
    if image_size == reference_size {
        return Ok(());
    }
    let (image, reference) = (image.file.clone(), reference.file.clone());
    Err(CompareError::Size { image, image_size, reference, reference_size })
}

fn e0(image: &Picture, reference: &Picture) -> Result<f64, CompareError> {
    let stated = [image, reference].into_iter().find_map(|p| p.number("e0")).filter(|e0| *e0 > 0.0);
    let unknown = || CompareError::Yardstick { image: image.file.clone(), reference: reference.file.clone() };
    stated.ok_or_else(unknown)
}

fn constants(image: &Picture, reference: &Picture) -> Result<Constants, CompareError> {
    let e0 = e0(image, reference)?;
    let exposure = [image, reference].into_iter().find_map(|p| p.number("settings.eye.exposure"));
    Ok(Constants {
        e0,
        relmse_epsilon: (RELATIVE_TO_E0 * e0).powi(2),
        relmse_standard_epsilon: RELATIVE_TO_MEAN,
        mape_epsilon: RELATIVE_TO_MEAN,
        flip_exposure: exposure.unwrap_or(0.0),
        flip_pixels_per_degree: PIXELS_PER_DEGREE,
    })
}

/// In the order of [`MEASURES`].
fn measures(pair: &Pair, e0: f64, flip: Measure) -> [Measure; 8] {
    [
        metrics::relmse(pair, e0),
        metrics::relmse_standard(pair),
        metrics::relmse_trimmed(pair),
        metrics::rmse(pair),
        metrics::mae(pair),
        metrics::mape(pair),
        metrics::energy_ratio(pair),
        flip,
    ]
}

/// Cells of light have no noise: what stands for their variance says how far they may be off, and bounds no interval.
fn interval(reference: &Picture, measure: Measure) -> Measure {
    if is_cells(reference) { measure.without_interval() } else { measure }
}

fn is_cells(reference: &Picture) -> bool {
    reference.about.get("estimator").is_some_and(|estimator| estimator == "cells")
}

/// The pixels judged, in float64.
pub(super) fn kept(layer: &Layer, judged: &[bool]) -> Vec<f64> {
    let pixels = layer.pixels().zip(judged).filter(|(_, judged)| **judged);
    pixels.flat_map(|(pixel, _)| pixel).map(|&value| f64::from(value)).collect()
}

/// Three bands a pixel, however many there are.
fn rgb(layer: &Layer) -> Vec<[f32; 3]> {
    let last = layer.channels() - 1;
    layer.pixels().map(|pixel| std::array::from_fn(|band| pixel[band.min(last)])).collect()
}

fn signed(image: &Layer, reference: &Layer) -> Vec<f64> {
    let mean = |pixel: &[f32]| pixel.iter().map(|&v| f64::from(v)).sum::<f64>() / pixel.len() as f64;
    image.pixels().zip(reference.pixels()).map(|(x, r)| mean(x) - mean(r)).collect()
}
