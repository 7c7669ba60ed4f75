//! Lights: their views, and the tracers that fill photon columns from each (Wyman 2008, section 2: the photon buffer).
//!
//! Cost: one dispatch of N² invocations a view; with `bvh` bound by traversal, 32 bytes written a photon for `maps`, 36 for
//! its cells and 20 for each of their (N + 1)² corners. The image-space tracers rasterise the view up to four times first (at most 92 bytes a photon) and are bound by fetches.
//!
//! In class `all:N` each sample grows a tree, and the buffer has `light.layers` layers, which cost their bytes whether a
//! sample fills them or not.

mod blocks;
mod corners;
mod emission;
mod images;
mod photons;
mod shoot;
mod tracer;
mod unit;

use crate::{
    scene::{PathClass, Scene},
    settings::{Choice, Setting, Settings, Whole, Word},
};

pub use blocks::Blocks;
pub use corners::Corners;
pub use emission::{Emission, emissions, sides, sized, view_name};
pub use images::Bench;
pub use photons::{Column, Photons, SamplePush, Tracing, photon_buffer, photons};
pub use shoot::{Job, Measure, Shot, Shots, Taker, Wanted, shoot};
pub use tracer::{BACK, TOTAL_REFLECTION, TRACER, Tracer};
pub use unit::flux_unit;

/// Photons a side of an emission view.
pub static SIDE: Whole = Whole {
    key: "light.side",
    unit: "texels",
    default: 512,
    range: 1..=16384,
    doc: "photons along each side of a light's emission view (N of N x N)",
};

/// Photons a side of the photon buffer.
pub static TILE: Whole = Whole {
    key: "light.tile",
    unit: "texels",
    default: LARGEST,
    range: 1..=LARGEST,
    doc: "photons a side of the photon buffer, at most: views of more are traced and gathered tile by tile; the picture is \
          the same, but for varying, thin-lens and elliptic splats, which know no neighbour beyond a tile, clusters, which end \
          there, cells, of which each tile chooses which to trace finer, and float32 sums, in another order",
};

/// Every Vulkan device has images of so many texels a side (`maxImageDimension2D`).
const LARGEST: u32 = 4096;

/// How the emission view is chosen.
pub static VIEW: Choice = Choice {
    key: "light.view",
    default: "fitted",
    words: &["fitted", "shared"],
    doc: "fitted: to the specular objects; shared: one view of objects and receiver for photons and map, as in the papers",
};

/// Points of a light with a size that send photons.
pub static AREA_SAMPLES: Whole = Whole {
    key: "light.area_samples",
    unit: "points",
    default: 16,
    range: 1..=256,
    doc: "points (of a sun, directions) of each light with a size that send photons, each of a view of its own: all of them \
          together about light.side x light.side; of waves.variant = inverse, each with rays of its own",
};

/// The path class.
pub static PATHS: Word = Word {
    key: "light.paths",
    default: SCENE,
    forms: &[SCENE, "reflect-1", "transmit-1", "transmit-2", "all:N with N from 1 to 64"],
    accepts: |text| text == SCENE || text.parse::<PathClass>().is_ok(),
    doc: "which specular chains make the caustic; all:N: every one of 1 to N events; scene: as the scene file says",
};
const SCENE: &str = "scene";

/// Layers of the photon buffer in class `all:N`.
pub static LAYERS: Whole = Whole {
    key: "light.layers",
    unit: "layers",
    // On the glass sphere they hold all that arrives in all:8, of a diamond's all:32 all but 0.02 %; six all but 2e-6.
    default: 4,
    range: 1..=64,
    doc: "with all:N, photons that a sample can leave: its brightest; the flux of the others is counted as no_layer",
};

/// Settings of this room.
pub static SETTINGS: &[Setting] = &[
    Setting::Whole(&SIDE),
    Setting::Whole(&TILE),
    Setting::Choice(&VIEW),
    Setting::Whole(&AREA_SAMPLES),
    Setting::Choice(&TRACER),
    Setting::Choice(&TOTAL_REFLECTION),
    Setting::Choice(&BACK),
    Setting::Word(&PATHS),
    Setting::Whole(&LAYERS),
];

/// The path class in force.
pub fn paths(scene: &Scene, settings: &Settings) -> PathClass {
    settings.word(&PATHS).parse().unwrap_or(scene.paths)
}
