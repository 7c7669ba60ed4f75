//! Nephroid: real-time caustics methods on one set of scenes, lights and units; what each costs, and how wrong it is.

pub mod gpu;
pub mod optics;
pub mod settings;
pub mod stats;
pub mod store;
pub mod view;
