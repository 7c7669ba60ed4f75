//! Floor 2: rooms that several methods share.

pub mod accel;
