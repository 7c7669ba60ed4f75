//! Nephroid: real-time caustics methods on one set of scenes, lights and units; what each costs, and how wrong it is.

pub mod gpu;
pub mod image;
pub mod optics;
pub mod settings;
pub mod stats;
pub mod store;
pub mod view;
pub mod truth;
pub mod whole;
pub mod scene;
