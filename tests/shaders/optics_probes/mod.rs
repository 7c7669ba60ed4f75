//! The shipped GLSL in a compute shader against float64: optics, splats, views, intersections, edges included.
//!
//! References are computed in float64 from the very float32 numbers that the shader reads, so that a tolerance holds
//! the shader's own rounding and nothing else.

mod canonical;
mod cover;
mod directions;
mod fresnel;
mod interface;
mod intersection;
mod leaving;
mod refraction;
mod splat;
mod surface;
mod view;

use glam::DVec3;

/// Half a unit in the last place at one: what a correctly rounded float32 operation loses.
const UNIT_ROUNDOFF: f64 = 1.0 / 16_777_216.0;

fn f32s(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

fn f64s(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

/// Largest of errors, where NaN counts as infinite.
fn worst(errors: impl IntoIterator<Item = f64>) -> f64 {
    errors.into_iter().fold(0.0, |worst, e| if e.is_nan() { f64::INFINITY } else { worst.max(e) })
}

/// cos²θ after refraction from the float32 numbers the shader sees; negative in total reflection.
fn squared_cosine(cos_i: f64, eta: f64) -> f64 {
    eta * eta * cos_i * cos_i + (1.0 - eta) * (1.0 + eta)
}

/// What √k may be off by where k is off by `error`: all of √error at the critical angle, little away from it.
fn root_error(k: f64, error: f64) -> f64 {
    (k.max(0.0) + error).sqrt() - (k.max(0.0) - error).max(0.0).sqrt()
}
