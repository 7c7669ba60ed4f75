//! Floor 2: rooms that several methods share: the scene on the device, light views and photons, the eye, compose.

pub mod accel;
pub mod account;
mod error;
pub mod extents;
pub mod eye;
pub mod lamps;
pub mod light;
pub mod scene;
pub mod sky;
pub mod water;
mod work;

pub use error::{PlanError, refused};
pub use work::Work;
