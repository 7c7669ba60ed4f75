//! What needs no device: scene files, meshes, regions, the truth, error measures, plots.

#[path = "../common/random.rs"]
#[allow(dead_code)] // the numbers alone are used here
mod random;

mod estimators;
mod metrics;
mod plot;
mod scene_files;
mod scene_regions;
mod truth;
