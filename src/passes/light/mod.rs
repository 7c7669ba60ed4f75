//! Lights: their views, and the tracers that fill photon columns from each (Wyman 2008, section 2: the photon buffer).
//!
//! Cost: one dispatch of N² invocations a view; with `bvh` bound by traversal, 32 bytes written a photon for `maps`. The
//! image-space tracers rasterise the view up to four times first (at most 92 bytes a photon) and are bound by fetches.

mod emission;
mod images;
mod photons;
mod tracer;

use super::PlanError;
use crate::{
    scene::{PathClass, Scene},
    settings::{Choice, Setting, Settings, Whole},
};

pub use emission::{Emission, emissions, view_name};
pub use images::Bench;
pub use photons::{Column, Photons, Tracing, photon_buffer, photons};
pub use tracer::{BACK, TOTAL_REFLECTION, TRACER, Tracer};

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

/// The path class.
pub static PATHS: Choice = Choice {
    key: "light.paths",
    default: "scene",
    words: &["scene", "reflect-1", "transmit-1", "transmit-2"],
    doc: "which specular chains make the caustic; scene: as the scene file says",
};

/// Settings of this room.
pub static SETTINGS: &[Setting] = &[
    Setting::Whole(&SIDE),
    Setting::Choice(&VIEW),
    Setting::Choice(&TRACER),
    Setting::Choice(&TOTAL_REFLECTION),
    Setting::Choice(&BACK),
    Setting::Choice(&PATHS),
];

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
