//! Images and arrays as bytes of a file: layered EXR, PNG, NPY.
//!
//! * [`Layers`]: named float32 layers of one size; [`Layers::to_exr`], [`Layers::from_exr`].
//! * [`to_png`]: one layer, tone-mapped by [`tone_map`].
//! * [`rgb_to_png`]: colours as they are.
//! * [`Raster`]: a picture that is read, PNG or EXR.
//! * [`to_npy`]: an array of numbers.
//!
//! Encoders are functions of their input alone: the same input gives the same bytes, whatever the thread count, with no
//! time of day in them. Rows run from the top, pixels from the left, channels within a pixel.

mod error;
mod exr_file;
mod layers;
mod npy;
mod png_file;
mod raster;
mod tone;

pub use error::ImageError;
pub use layers::{Layer, Layers};
pub use npy::{NpyElement, to_npy};
pub use png_file::{rgb_to_png, to_png};
pub use raster::Raster;
pub use tone::tone_map;

/// What a file says about how it was made: name → text, in the names' order.
pub type Provenance = std::collections::BTreeMap<String, String>;
