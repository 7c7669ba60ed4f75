//! Checks of single values, each spoken from its key.
use std::ops::RangeInclusive;

use glam::DVec3;

use super::{
    error::SceneError,
    file::{Colour, Floats},
    locate::Key,
};

/// Largest coordinate or size, m: its square, and areas, must stay finite and exact enough in single precision.
pub const LARGEST: f64 = 1e9;
/// Smallest size, m, for the same reason.
const SMALLEST: f64 = 1e-9;
/// Largest irradiance (W/m²), intensity (W/sr), radiance (W/m²/sr) or absorption (1/m); products of three stay within single precision.
pub const STRONGEST: f64 = 1e12;
const LENGTHS: &str = "correct it; lengths are those in the file times its `unit`";
/// Directions shorter than this cannot be normalised safely, longer ones overflow when squared.
const DIRECTIONS: RangeInclusive<f64> = 1e-100..=1e100;

impl Key<'_> {
    /// A number in `range`; NaN is in none.
    pub fn number(&self, value: f64, range: RangeInclusive<f64>, what: &str, remedy: &str) -> Result<f64, SceneError> {
        if range.contains(&value) {
            return Ok(value);
        }
        let (low, high) = (shown(*range.start()), shown(*range.end()));
        let expected = format!("{what} from {low} to {high}");
        Err(self.fault(expected, shown(value), remedy))
    }

    /// A size above zero, in metres after the file's unit.
    pub fn size(&self, value: f64, unit: f64) -> Result<f64, SceneError> {
        self.number(value * unit, SMALLEST..=LARGEST, "a length in metres", LENGTHS)
    }

    /// A point, in metres after the file's unit.
    pub fn point(&self, value: Floats<3>, unit: f64) -> Result<DVec3, SceneError> {
        for coordinate in value.0 {
            self.number(coordinate * unit, -LARGEST..=LARGEST, "coordinates in metres", LENGTHS)?;
        }
        Ok(DVec3::from_array(value.0) * unit)
    }

    /// A vector of some length above zero, in metres after the file's unit.
    pub fn edge(&self, value: Floats<3>, unit: f64) -> Result<DVec3, SceneError> {
        let edge = self.point(value, unit)?;
        self.number(edge.length(), SMALLEST..=LARGEST, "a vector with a length in metres", LENGTHS)?;
        Ok(edge)
    }

    /// Two lengths on a quad, metres; `range` says whether they may be zero or negative.
    pub fn pair(&self, value: Floats<2>, unit: f64, positive: bool) -> Result<[f64; 2], SceneError> {
        let range = if positive { SMALLEST..=LARGEST } else { -LARGEST..=LARGEST };
        for length in value.0 {
            self.number(length * unit, range.clone(), "two lengths in metres", LENGTHS)?;
        }
        Ok(value.0.map(|length| length * unit))
    }

    /// A unit vector along `value`.
    pub fn direction(&self, value: Floats<3>) -> Result<DVec3, SceneError> {
        let longest = value.0.iter().fold(0.0, |longest: f64, x| if x.is_nan() { *x } else { longest.max(x.abs()) });
        if DIRECTIONS.contains(&longest) && value.0.iter().all(|x| x.is_finite()) {
            return Ok((DVec3::from_array(value.0) / longest).normalize());
        }
        let [x, y, z] = value.0.map(shown);
        Err(self.fault("a direction", format!("[{x}, {y}, {z}]"), "give a finite vector that is not zero"))
    }

    /// A share of light in each band.
    pub fn share(&self, value: Colour) -> Result<[f64; 3], SceneError> {
        let remedy = "a surface sends back at most the light it gets";
        value.0.iter().try_for_each(|&band| self.number(band, 0.0..=1.0, "a share", remedy).map(drop))?;
        Ok(value.0)
    }

    /// A strength in each band, zero allowed.
    pub fn strength(&self, value: Colour, what: &str) -> Result<[f64; 3], SceneError> {
        let remedy = "give a finite number, zero or more";
        value.0.iter().try_for_each(|&band| self.number(band, 0.0..=STRONGEST, what, remedy).map(drop))?;
        Ok(value.0)
    }
}

/// Short, whatever the size.
fn shown(value: f64) -> String {
    let plain = value == 0.0 || !value.is_finite() || (1e-4..1e7).contains(&value.abs());
    if plain { format!("{value}") } else { format!("{value:e}") }
}
