//! Closed forms: caustics and direct light known to float64, for tests to be judged by.
//!
//! * [`SphereCaustic`]: a glass sphere over a floor, under parallel light or an axial point light, class `transmit-2`.
//! * [`flat_water`]: below a flat water surface, class `transmit-1`.
//! * [`SineWater`]: below a sine wave, class `transmit-1`.
//! * [`nephroid`], [`Paraboloid`]: concave mirrors, class `reflect-1`.
//! * [`direct_parallel`], [`direct_point`]: direct irradiance.
//!
//! All light here is one band: watts, W/m² and W/sr of it.

mod mirror;
mod plane;
mod quadrature;
mod sine;
mod sphere;

pub use mirror::{Paraboloid, nephroid};
pub use plane::{direct_parallel, direct_point, flat_water};
pub use sine::SineWater;
pub use sphere::{GlassSphere, Illumination, OutsideDomain, SphereCaustic};
