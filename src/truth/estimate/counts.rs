//! Photons counted in pixels.

use super::{BANDS, Estimate, Judged, Sums};
use crate::truth::{Goal, Standing, eye::Eye, light::Photons, trace::Space};

/// Chunks before an estimate of noise is believed.
pub const CHUNKS: u64 = 32;
/// Chunks between two looks at whether the noise is low enough.
const LOOK: u64 = 8;
/// Independent parts of a chunk, each a low-discrepancy sequence of its own.
pub const PARTS: u64 = 4;

/// The estimate by photons: each adds to the pixel that sees it.
pub struct Counts<'a> {
    space: &'a Space<'a>,
    eye: Eye,
    /// A chunk of them is a part of one of ours.
    photons: Photons<'a>,
    judged: Judged,
    sums: Sums,
    spread: Spread,
}

/// How the noise of the pixels moves together, from the differences of each chunk's parts.
///
/// The error of a low-discrepancy sequence is a function of its one random shift, so pixels are far from independent: with
/// K the covariance of their errors (weighted as relMSE weighs them), Σ error² scatters about its mean tr K by
/// 2 tr K², as if there were (tr K)²/tr K² independent values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Spread {
    /// Σ ⟨d₁₂,d₁₂⟩ + ⟨d₃₄,d₃₄⟩ over the chunks, d the difference of two parts: 4 tr K each.
    own: f64,
    /// Σ ⟨d₁₂,d₃₄⟩²: 4 tr K² each.
    shared: f64,
    /// Σ of the judged pixels' total, and of its square.
    total: f64,
    total_squares: f64,
}

impl Spread {
    const NUMBERS: usize = 4;

    fn numbers(&self) -> [f64; Self::NUMBERS] {
        [self.own, self.shared, self.total, self.total_squares]
    }

    fn add(&mut self, numbers: &[f64]) {
        if let [own, shared, total] = numbers {
            self.own += own;
            self.shared += shared;
            self.total += total;
            self.total_squares += total * total;
        }
    }

    /// As how many independent values the noise scatters; of nothing that scatters, `None`.
    fn freedom(&self, chunks: u64) -> Option<f64> {
        let freedom = self.own * self.own / (4.0 * chunks as f64 * self.shared);
        (chunks > 1 && freedom.is_finite()).then_some(freedom.max(1.0))
    }

    /// Standard error of the total, relative to it.
    fn total_error(&self, chunks: u64) -> Option<f64> {
        let n = chunks as f64;
        let variance = ((self.total_squares - self.total * self.total / n) / (n * (n - 1.0))).max(0.0);
        let error = variance.sqrt() * n / self.total;
        (chunks > 1 && error.is_finite()).then_some(error)
    }
}

impl<'a> Counts<'a> {
    /// Of these photons, as this eye sees them; what is judged weighs the pixels' noise.
    pub fn new(space: &'a Space<'a>, eye: Eye, photons: Photons<'a>, judged: Judged) -> Self {
        let sums = Sums::new(eye.pixels());
        Self { space, eye, photons, judged, sums, spread: Spread::default() }
    }

    fn per_chunk(&self) -> u64 {
        PARTS * self.photons.per_chunk()
    }

    fn part(&self, k: u64) -> Vec<f64> {
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

    /// What a chunk tells the [`Spread`], from its parts and their mean.
    fn spread_of(&self, parts: &[Vec<f64>], mean: &[f64]) -> [f64; 3] {
        let [mut own, mut shared, mut total] = [0.0; 3];
        for (k, x) in mean.iter().enumerate().filter(|(k, _)| self.judged.pixels[k / BANDS]) {
            let weight = 1.0 / (x * x + self.judged.epsilon);
            let (a, b) = (parts[0][k] - parts[1][k], parts[2][k] - parts[3][k]);
            own += weight * (a * a + b * b);
            shared += weight * a * b;
            total += x;
        }
        [own, shared * shared, total]
    }
}

impl Estimate for Counts<'_> {
    fn chunks(&self) -> u64 {
        self.sums.chunks
    }

    /// The picture, then what it tells the `Spread`.
    fn chunk(&self, k: u64) -> Vec<f64> {
        let parts: Vec<Vec<f64>> = (0..PARTS).map(|part| self.part(PARTS * k + part)).collect();
        let at = |pixel: usize| parts.iter().map(|part| part[pixel]).sum::<f64>() / PARTS as f64;
        let mut mean: Vec<f64> = (0..self.eye.pixels() * BANDS).map(at).collect();
        let spread = self.spread_of(&parts, &mean);
        mean.extend(spread);
        mean
    }

    fn add(&mut self, chunk: &[f64]) {
        let (picture, spread) = chunk.split_at(self.eye.pixels() * BANDS);
        self.sums.add(picture);
        self.spread.add(spread);
    }

    fn standing(&self, goal: &Goal) -> Standing {
        let per_chunk = self.per_chunk();
        let noise = if per_chunk == 0 { 0.0 } else { self.judged.noise(self.sums.mean(), self.sums.variance()) };
        let photons = self.sums.chunks * per_chunk;
        let enough = goal.photons.is_some_and(|n| photons >= n);
        let looked = self.sums.chunks >= CHUNKS && self.sums.chunks.is_multiple_of(LOOK);
        let quiet = looked && goal.noise.is_some_and(|most| noise <= most);
        // Relative noise falls as 1/photons at least, so the photons still needed follow from the noise.
        let done = photons as f64;
        let by_photons = goal.photons.map(|n| n as f64 - done);
        let by_noise = goal.noise.map(|most| done * (noise / most - 1.0));
        let missing = by_photons.into_iter().chain(by_noise).fold(f64::INFINITY, f64::min).max(0.0);
        Standing { photons, noise, missing, finished: per_chunk == 0 || enough || quiet }
    }

    fn may_be_finished(&self, goal: &Goal) -> bool {
        let enough = goal.photons.is_some_and(|n| self.sums.chunks * self.per_chunk() >= n);
        enough || goal.noise.is_some() && self.sums.chunks.is_multiple_of(LOOK)
    }

    fn mean(&self) -> Vec<f64> {
        self.sums.mean().collect()
    }

    fn variance(&self) -> Vec<f64> {
        self.sums.variance().collect()
    }

    fn about(&self) -> Vec<(&'static str, String)> {
        let chunks = self.sums.chunks;
        let number = |name, number: Option<f64>| number.map(|number| (name, format!("{number:e}")));
        let freedom = number("noise.freedom", self.spread.freedom(chunks));
        freedom.into_iter().chain(number("noise.total", self.spread.total_error(chunks))).collect()
    }

    fn to_bytes(&self) -> Vec<u8> {
        let spread = self.spread.numbers().into_iter().flat_map(|x| x.to_le_bytes());
        spread.chain(self.sums.to_bytes()).collect()
    }

    fn resume(&mut self, bytes: &[u8]) -> bool {
        let Some((spread, sums)) = bytes.split_at_checked(8 * Spread::NUMBERS) else { return false };
        let Some(sums) = Sums::from_bytes(sums, self.eye.pixels()) else { return false };
        let (words, _) = spread.as_chunks::<8>();
        let number = |k: usize| f64::from_le_bytes(words[k]);
        self.spread = Spread { own: number(0), shared: number(1), total: number(2), total_squares: number(3) };
        self.sums = sums;
        true
    }
}
