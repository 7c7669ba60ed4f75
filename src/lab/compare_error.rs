//! Why pictures cannot be compared: each error names the file, what is wrong, and the remedy.

use std::path::PathBuf;

use super::compare::LEAST_JUDGED;
use crate::{image::ImageError, names::NoSuch, scene::SceneError};

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
    #[error("{file}: {reason}")]
    Layer { file: String, reason: NoSuch },
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
    #[error(
        "{image} does not say what scene it shows (attributes nephroid.scene.name, .file, .hash and .overrides): name a \
         file as its --reference"
    )]
    Unsaid { image: String },
    #[error("{image}: its scene cannot be loaded again: {reason}; or name a file as its --reference")]
    Scene { image: String, reason: Box<SceneError> },
    #[error(
        "{image}: its scene, {scene}, has changed since: {what}; render the image again, or name a file as its \
         --reference"
    )]
    Changed { image: String, scene: String, what: String },
}

fn shown([width, height]: &[usize; 2]) -> String {
    format!("{width}x{height}")
}
