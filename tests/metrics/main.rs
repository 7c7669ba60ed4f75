//! The error measures: worked by hand, against their own noise, and beside the published FLIP.

mod bare;
mod by_hand;
mod flip;
mod noise;
#[path = "../common/random.rs"]
#[allow(dead_code)] // the numbers alone are used here
mod random;
