//! The shipped GLSL on lists of inputs, the device floor under it, and the structures that both sides share.

#[path = "../common/mod.rs"]
mod common;

mod gpu_floor;
mod layout;
mod optics_probes;
mod water;
