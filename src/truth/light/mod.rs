//! Photons: from each light on to the specular objects, by every path of a class, to the first diffuse surface.
//!
//! Photons come in chunks of one size. Each chunk is an unbiased estimate of its own: a low-discrepancy sequence with
//! a random shift that is a function of seed, light and chunk. The spread of the chunks gives the noise.

pub mod area;
mod chain;
mod emit;
pub mod sequence;
mod walk;

#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};

pub use chain::Chain;
use walk::Faint;
pub use walk::{Balance, Landing};

use super::trace::Space;
use crate::scene::PathClass;
pub use emit::Emission;
use sequence::{R2, R4, stream};

/// What a seed's numbers are for: photons.
const PHOTONS: u64 = 1;
/// What a seed's numbers are for: which way a faint branch goes.
const CHOICES: u64 = 2;

/// The photons of a scene in one path class.
#[derive(Debug)]
pub struct Photons<'a> {
    space: &'a Space<'a>,
    class: PathClass,
    seed: u64,
    /// Each light, and its photons in a chunk.
    lights: Vec<(Emission, u64)>,
}

impl<'a> Photons<'a> {
    /// About `per_chunk` photons a chunk, shared among the lights by the mean of the bands of their flux, at least one
    /// to each light that shines.
    pub fn new(space: &'a Space<'a>, class: PathClass, seed: u64, per_chunk: u64) -> Self {
        let emissions = Emission::of(space);
        let total: f64 = emissions.iter().map(|e| e.flux().element_sum()).sum();
        let share = |e: &Emission| match e.flux().element_sum() {
            flux if flux > 0.0 => ((per_chunk as f64 * flux / total).round() as u64).max(1),
            _ => 0,
        };
        let lights = emissions.into_iter().map(|e| (share(&e), e)).map(|(n, e)| (e, n)).collect();
        Self { space, class, seed, lights }
    }

    /// Photons of a chunk; 0 without specular objects or without light.
    pub fn per_chunk(&self) -> u64 {
        self.lights.iter().map(|(_, n)| n).sum()
    }

    /// Traces chunk `k` and shows each landing to `land`. Fluxes are those of the whole light: a chunk alone is an
    /// estimate of everything.
    pub fn chunk(&self, k: u64, mut land: impl FnMut(&Landing)) -> Balance {
        let mut sum = Balance::default();
        for (light, (emission, count)) in self.lights.iter().enumerate() {
            let seed = stream(&[self.seed, PHOTONS, light as u64, k]);
            let (plane, both) = (R2::new(seed), R4::new(seed));
            let point = |i| if emission.has_area() { both.point(i) } else { [plane.point(i), DVec2::ZERO] };
            let choices = stream(&[self.seed, CHOICES, light as u64, k]);
            let flux = emission.flux() / (*count).max(1) as f64;
            for i in 0..*count {
                let faint = Faint::Choose(stream(&[choices, i]));
                for start in emission.starts(self.space, point(i), flux) {
                    sum = sum.plus(&walk::walk(self.space, self.class, &start, faint, &mut land));
                }
            }
        }
        sum
    }
}

/// Every landing of the ray through a point of an emission's unit square, its flux a share of what was emitted. Nothing is
/// left to chance, so that neighbouring points have neighbouring landings; of a light with a size, the light of its middle.
pub fn follow(space: &Space, class: PathClass, emission: &Emission, at: DVec2, mut land: impl FnMut(&Landing)) {
    for start in emission.starts(space, [at, DVec2::splat(0.5)], DVec3::ONE) {
        walk::walk(space, class, &start, Faint::Drop, &mut land);
    }
}

impl Balance {
    /// Both together.
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            emitted: self.emitted + other.emitted,
            landed: self.landed + other.landed,
            absorbed: self.absorbed + other.absorbed,
            missed: self.missed + other.missed,
            other: self.other + other.other,
        }
    }

    /// Everything that a photon can come to; equal to `emitted` but for rounding and the choices of faint branches.
    pub fn spent(&self) -> DVec3 {
        self.landed + self.absorbed + self.missed + self.other
    }
}
