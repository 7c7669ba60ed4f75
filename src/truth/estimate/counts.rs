//! Photons counted in pixels.

use super::{BANDS, Estimate, Judged, Sums};
use crate::truth::{Goal, Standing, eye::Eye, light::Photons, trace::Space};

/// Chunks before an estimate of noise is believed.
pub const CHUNKS: u64 = 32;

/// The estimate by photons: each adds to the pixel that sees it.
pub struct Counts<'a> {
    space: &'a Space<'a>,
    eye: Eye,
    photons: Photons<'a>,
    sums: Sums,
}

impl<'a> Counts<'a> {
    /// Of these photons, as this eye sees them.
    pub fn new(space: &'a Space<'a>, eye: Eye, photons: Photons<'a>) -> Self {
        let sums = Sums::new(eye.pixels());
        Self { space, eye, photons, sums }
    }
}

impl Estimate for Counts<'_> {
    fn chunks(&self) -> u64 {
        self.sums.chunks
    }

    fn chunk(&self, k: u64) -> Vec<f64> {
        let mut picture = vec![0.0; self.eye.pixels() * BANDS];
        self.photons.chunk(k, |landing| {
            let Some(seen) = self.eye.project(landing.surface.p) else { return };
            let Some(pixel) = self.eye.pixel(seen.at) else { return };
            let cosine = seen.towards.dot(landing.normal);
            if cosine <= 0.0 || self.eye.hidden(self.space, &landing.surface.ray(seen.towards), seen.distance) {
                return;
            }
            let e = landing.flux * (cosine * seen.density);
            for band in 0..BANDS {
                picture[pixel * BANDS + band] += e[band];
            }
        });
        picture
    }

    fn add(&mut self, chunk: &[f64]) {
        self.sums.add(chunk);
    }

    fn standing(&self, goal: &Goal, judged: &Judged) -> Standing {
        let per_chunk = self.photons.per_chunk();
        let noise = if per_chunk == 0 { 0.0 } else { judged.noise(self.sums.mean(), self.sums.variance()) };
        let photons = self.sums.chunks * per_chunk;
        let enough = goal.photons.is_some_and(|n| photons >= n);
        let quiet = goal.noise.is_some_and(|most| self.sums.chunks >= CHUNKS && noise <= most);
        // Relative noise falls as 1/photons at least, so the photons still needed follow from the noise.
        let done = photons as f64;
        let by_photons = goal.photons.map(|n| n as f64 - done);
        let by_noise = goal.noise.map(|most| done * (noise / most - 1.0));
        let missing = by_photons.into_iter().chain(by_noise).fold(f64::INFINITY, f64::min).max(0.0);
        Standing { photons, noise, missing, finished: per_chunk == 0 || enough || quiet }
    }

    fn mean(&self) -> Vec<f64> {
        self.sums.mean().collect()
    }

    fn variance(&self) -> Vec<f64> {
        self.sums.variance().collect()
    }

    fn about(&self) -> Vec<(&'static str, String)> {
        vec![]
    }

    fn to_bytes(&self) -> Vec<u8> {
        self.sums.to_bytes()
    }

    fn resume(&mut self, bytes: &[u8]) -> bool {
        let sums = Sums::from_bytes(bytes, self.eye.pixels());
        sums.map(|sums| self.sums = sums).is_some()
    }
}
