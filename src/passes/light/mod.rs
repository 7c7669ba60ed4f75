//! Lights: their views, and the tracer `bvh` that fills photon columns from each (Wyman 2008, section 2: the photon
//! buffer; exact intersection in place of the image-space estimate).
//!
//! Cost: one dispatch of N² invocations a view, bound by traversal; 32 bytes written a photon for `maps`.

mod emission;
mod photons;

use super::PlanError;
use crate::{
    scene::{PathClass, Scene},
    settings::{Choice, Setting, Settings, Whole},
};

pub use emission::{Emission, emissions, view_name};
pub use photons::{Column, Photons, Tracing, photon_buffer, photons};

/// Photons a side of an emission view.
pub static SIDE: Whole = Whole {
    key: "light.side",
    unit: "texels",
    default: 512,
    range: 1..=16384,
    doc: "photons along each side of a light's emission view (N of N x N)",
};

/// How the emission view is chosen.
pub static VIEW: Choice = Choice {
    key: "light.view",
    default: "fitted",
    words: &["fitted", "shared"],
    doc: "fitted: to the specular objects; shared: one view of objects and receiver for photons and map, as in the papers",
};

/// The tracer.
pub static TRACER: Choice =
    Choice { key: "light.tracer", default: "bvh", words: &["bvh"], doc: "bvh: exact intersection in a compute shader" };

/// The path class.
pub static PATHS: Choice = Choice {
    key: "light.paths",
    default: "scene",
    words: &["scene", "reflect-1", "transmit-1", "transmit-2"],
    doc: "which specular chains make the caustic; scene: as the scene file says",
};

/// Settings of this room.
pub static SETTINGS: &[Setting] =
    &[Setting::Whole(&SIDE), Setting::Choice(&VIEW), Setting::Choice(&TRACER), Setting::Choice(&PATHS)];

/// The path class in force.
pub fn paths(scene: &Scene, settings: &Settings) -> Result<PathClass, PlanError> {
    let class = settings.choice(&PATHS).parse().unwrap_or(scene.paths);
    match class {
        PathClass::All(_) => Err(PlanError::Refused {
            what: format!("path class {class}"),
            reason: "chains of any length are not built yet".into(),
            remedy: "set light.paths to reflect-1, transmit-1 or transmit-2".into(),
        }),
        class => Ok(class),
    }
}
