//! A picture judged against a reference over the receiver region.

use std::path::{Path, PathBuf};

use super::compare_scene::{self, difference};
use crate::{
    image::{ImageError, Layer, Layers, Provenance},
    metrics::{self, Measure, PIXELS_PER_DEGREE, Pair, Pictures, RELATIVE_TO_E0, RELATIVE_TO_MEAN, Seen},
};

/// The least share of the region that has to be judged.
const LEAST_JUDGED: f64 = 0.95;
/// The camera that sees the region and nothing else.
const REGION: &str = "region";
/// The measures by name, in the order of the reports.
pub const MEASURES: [&str; 8] =
    ["relmse", "relmse_standard", "relmse_trimmed", "rmse", "mae", "mape", "energy_ratio", "flip"];

/// Why two pictures cannot be compared.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // the messages say it
pub enum CompareError {
    #[error("cannot read {}: {reason}", path.display())]
    Read { path: PathBuf, reason: std::io::Error },
    #[error("{}: {reason}", path.display())]
    Image { path: PathBuf, reason: ImageError },
    #[error(
        "{image} is {} pixels, its reference {reference} {}: make both of one size",
        shown(image_size),
        shown(reference_size)
    )]
    Size { image: String, image_size: [usize; 2], reference: String, reference_size: [usize; 2] },
    #[error("{file} has no layer `{layer}`; it has: {known}")]
    Layer { file: String, layer: String, known: String },
    #[error("{file}: layer `{layer}` has {found} channels, where {expected} are needed")]
    Channels { file: String, layer: String, found: usize, expected: usize },
    #[error(
        "{file} was made with --camera {camera}: make it with --camera region, which sees the receiver region whole"
    )]
    Camera { file: String, camera: String },
    #[error(
        "{image}: {masked} of {pixels} pixels of the region are masked, and at least {:.0} % have to be judged: make both \
         pictures with --camera region",
        100.0 * LEAST_JUDGED
    )]
    Masked { image: String, masked: usize, pixels: usize },
    #[error(
        "neither {image} nor {reference} says how bright the region is (attribute nephroid.e0 above 0): render the image \
         again"
    )]
    Yardstick { image: String, reference: String },
}

fn shown([width, height]: &[usize; 2]) -> String {
    format!("{width}x{height}")
}

/// A file of layers, with what it says about itself.
pub struct Picture {
    /// As it was named.
    pub file: String,
    pub(super) layers: Layers,
    pub(super) about: Provenance,
}

/// A picture and what is wrong with it.
pub struct Comparison {
    /// The picture's file.
    pub image: String,
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

impl Picture {
    /// Reads an EXR file.
    pub fn read(path: &Path) -> Result<Self, CompareError> {
        let bytes = std::fs::read(path).map_err(|reason| CompareError::Read { path: path.to_owned(), reason })?;
        let read = Layers::from_exr(&bytes);
        let (layers, about) = read.map_err(|reason| CompareError::Image { path: path.to_owned(), reason })?;
        Ok(Self { file: path.display().to_string(), layers, about })
    }

    fn size(&self) -> [usize; 2] {
        [self.layers.width(), self.layers.height()]
    }

    fn layer(&self, name: &str) -> Result<&Layer, CompareError> {
        self.layers.get(name).ok_or_else(|| CompareError::Layer {
            file: self.file.clone(),
            layer: name.to_owned(),
            known: self.layers.iter().map(Layer::name).collect::<Vec<_>>().join(", "),
        })
    }

    fn check_channels(&self, layer: &Layer, expected: usize) -> Result<(), CompareError> {
        if layer.channels() == expected {
            return Ok(());
        }
        let (file, name, found) = (self.file.clone(), layer.name().to_owned(), layer.channels());
        Err(CompareError::Channels { file, layer: name, found, expected })
    }

    /// How noisy a layer is, where that is known: a truth of a single chunk says infinitely.
    fn variance(&self, layer: &str) -> Option<&Layer> {
        let variance = self.layers.get(&format!("{layer}.variance"))?;
        (!variance.data().contains(&f32::INFINITY)).then_some(variance)
    }

    /// Whether each pixel may be judged: no part of it is masked.
    fn unmasked(&self) -> Result<Vec<bool>, CompareError> {
        match self.layers.get("mask") {
            None => Ok(vec![true; self.layers.width() * self.layers.height()]),
            Some(mask) => self.check_channels(mask, 1).map(|()| mask.data().iter().map(|m| *m == 0.0).collect()),
        }
    }

    fn check_camera(&self) -> Result<(), CompareError> {
        match self.about.get("camera") {
            Some(camera) if camera != REGION => {
                Err(CompareError::Camera { file: self.file.clone(), camera: camera.clone() })
            }
            _ => Ok(()),
        }
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.about.get(name)?.parse().ok().filter(|number: &f64| number.is_finite())
    }
}

/// Judges one layer of an image against the same layer of a reference.
///
/// Both are pictures of the whole receiver region. The reference's `LAYER.variance` says how noisy it is. Pixels that
/// either masks are left out.
pub fn compare(image: &Picture, reference: &Picture, layer: &str) -> Result<Comparison, CompareError> {
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
    let constants = constants(image, reference)?;
    let seen = Seen { ev: constants.flip_exposure, pixels_per_degree: constants.flip_pixels_per_degree };
    let [xs, rs] = [x, r].map(rgb);
    let vs = variance.map(rgb);
    let pictures =
        Pictures { size: image.size(), image: &xs, reference: &rs, variance: vs.as_deref(), judged: &judged };
    let flip = metrics::flip(&pictures, &seen).expect("both pictures and the mask are of one size, checked above");
    let pair = Pair::new(x.channels(), kept(x, &judged), kept(r, &judged), variance.map(|v| kept(v, &judged)))
        .expect("layers of one size and as many channels, checked above");
    Ok(Comparison {
        image: image.file.clone(),
        layer: layer.to_owned(),
        pixels,
        masked: judged.len() - pixels,
        measures: measures(&pair, constants.e0, flip.measure),
        constants,
        warnings: warnings(image, reference, layer),
        maps: Maps { size: image.size(), signed: signed(x, r), flip: flip.map, judged },
    })
}

fn check_sizes(image: &Picture, reference: &Picture) -> Result<(), CompareError> {
    let (image_size, reference_size) = (image.size(), reference.size());
    if image_size == reference_size {
        return Ok(());
    }
    let (image, reference) = (image.file.clone(), reference.file.clone());
    Err(CompareError::Size { image, image_size, reference, reference_size })
}

fn constants(image: &Picture, reference: &Picture) -> Result<Constants, CompareError> {
    let e0 = [image, reference]
        .into_iter()
        .find_map(|p| p.number("e0"))
        .filter(|e0| *e0 > 0.0)
        .ok_or_else(|| CompareError::Yardstick { image: image.file.clone(), reference: reference.file.clone() })?;
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

/// The pixels judged, in float64.
fn kept(layer: &Layer, judged: &[bool]) -> Vec<f64> {
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

/// What the files say of their scenes and paths, where it differs.
fn warnings(image: &Picture, reference: &Picture, layer: &str) -> Vec<String> {
    let mut warnings = Vec::new();
    if reference.layers.get(&format!("{layer}.variance")).is_some() && reference.variance(layer).is_none() {
        warnings
            .push(format!("{}: its noise is infinite somewhere, so that of the figures is not known", reference.file));
    }
    let hash = |picture: &Picture| picture.about.get("scene.hash").cloned();
    if let (Some(ours), Some(theirs)) = (hash(image), hash(reference))
        && ours != theirs
    {
        let what = difference(&image.about, &reference.about);
        warnings.push(format!("{}: its scene is not that of {}: {what}", image.file, reference.file));
    }
    if let (Some(ours), Some(theirs)) = (compare_scene::paths(&image.about), compare_scene::paths(&reference.about))
        && ours != theirs
    {
        let (image, reference) = (&image.file, &reference.file);
        warnings.push(format!("{image}: its paths are {ours}, those of {reference} {theirs}"));
    }
    warnings
}
