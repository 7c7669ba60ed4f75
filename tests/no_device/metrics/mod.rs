//! The error measures: worked by hand, against their own noise, and beside the published FLIP.

mod bare;
mod by_hand;
mod flip;
mod noise;
