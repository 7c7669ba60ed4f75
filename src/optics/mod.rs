//! Optics in float64: what light does at a smooth interface, inside an absorbing medium and inside one texel.
//!
//! These functions are the twins of the GLSL in `glsl/shared`: shader probes are compared with them, the closed forms
//! of [`crate::truth`] are built from them. Nothing here panics; what each function does at the edges of its domain
//! (grazing incidence, equal indices, the critical angle, zero vectors) is said beside it and tested.
//!
//! Conventions: directions are unit vectors in the direction of travel; normals are unit vectors that face against
//! the ray, d·n ≤ 0; refractive indices are real and positive; lengths are metres.

mod interface;
mod texel;

pub use interface::{fresnel, fresnel_conductor, reflect, refract, transmittance};
pub use texel::{footprint_directional, footprint_point, texel_solid_angle};
