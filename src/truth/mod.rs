//! The float64 reference. It shares no code with the GPU path: only scenes, meshes and optics of the lowest floor.

pub mod closed;
