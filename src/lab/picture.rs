//! A picture to be judged, or to judge by: a file of layers.

use std::path::Path;

use super::CompareError;
use crate::{
    image::{Layer, Layers, Provenance},
    metrics::Correlation,
    names::NoSuch,
};

/// What a picture says of its slot `surface` where that is irradiance only up to a scale.
pub(super) const RELATIVE: &str = "relative";
/// What it says where one eye sample has the mean of a pixel.
pub(super) const FILTERED: &str = "filtered";
/// The camera that sees the region and nothing else.
pub(super) const REGION: &str = "region";

/// A file of layers, with what it says about itself.
pub struct Picture {
    /// As it was named.
    pub file: String,
    pub(super) layers: Layers,
    pub(super) about: Provenance,
}

impl Picture {
    /// Reads an EXR file.
    pub fn read(path: &Path) -> Result<Self, CompareError> {
        let bytes = std::fs::read(path).map_err(|reason| CompareError::Read { path: path.to_owned(), reason })?;
        let read = Layers::from_exr(&bytes);
        let (layers, about) = read.map_err(|reason| CompareError::Image { path: path.to_owned(), reason })?;
        Ok(Self { file: path.display().to_string(), layers, about })
    }

    pub(super) fn size(&self) -> [usize; 2] {
        [self.layers.width(), self.layers.height()]
    }

    pub(super) fn layer(&self, name: &str) -> Result<&Layer, CompareError> {
        self.layers.get(name).ok_or_else(|| CompareError::Layer {
            file: self.file.clone(),
            reason: NoSuch::new("layer", name, self.layers.iter().map(Layer::name)),
        })
    }

    pub(super) fn check_channels(&self, layer: &Layer, expected: usize) -> Result<(), CompareError> {
        if layer.channels() == expected {
            return Ok(());
        }
        let (file, name, found) = (self.file.clone(), layer.name().to_owned(), layer.channels());
        Err(CompareError::Channels { file, layer: name, found, expected })
    }

    /// How noisy a layer is, where that is known: a truth of a single chunk says infinitely.
    pub(super) fn variance(&self, layer: &str) -> Option<&Layer> {
        let variance = self.layers.get(&format!("{layer}.variance"))?;
        (!variance.data().contains(&f32::INFINITY)).then_some(variance)
    }

    /// How the errors of a layer move together, as the truth says of the caustic's.
    pub(super) fn correlation(&self, layer: &str) -> Correlation {
        match layer {
            "irradiance.caustic" => {
                Correlation { freedom: self.number("noise.freedom"), total: self.number("noise.total") }
            }
            _ => Correlation::default(),
        }
    }

    /// Whether a layer is right only up to a scale.
    pub(super) fn is_relative(&self, layer: &str) -> bool {
        self.is_of_surface(layer, RELATIVE)
    }

    /// Whether one eye sample has a layer's mean of each pixel.
    pub(super) fn is_filtered(&self, layer: &str) -> bool {
        self.is_of_surface(layer, FILTERED)
    }

    /// Whether a layer has what the slot `surface` gives alone, and that is such.
    fn is_of_surface(&self, layer: &str, such: &str) -> bool {
        ["irradiance.caustic", "caustic"].contains(&layer) && self.about.get("surface").is_some_and(|s| s == such)
    }

    /// Whether each pixel may be judged: no part of it is masked.
    pub(super) fn unmasked(&self) -> Result<Vec<bool>, CompareError> {
        match self.layers.get("mask") {
            None => Ok(vec![true; self.layers.width() * self.layers.height()]),
            Some(mask) => self.check_channels(mask, 1).map(|()| mask.data().iter().map(|m| *m == 0.0).collect()),
        }
    }

    pub(super) fn check_camera(&self) -> Result<(), CompareError> {
        match self.about.get("camera") {
            Some(camera) if camera != REGION => {
                Err(CompareError::Camera { file: self.file.clone(), camera: camera.clone() })
            }
            _ => Ok(()),
        }
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.about.get(name)?.parse().ok().filter(|number: &f64| number.is_finite())
    }
}
