//! Light straight down through a sine wave of water on to a flat floor, class `transmit-1`, without absorption.
//!
//! Source: Snell's law at the height h = A sin kx over a floor at −D: a ray that enters at x lands at
//! x + (D + h) tan(θi − θt), θi = atan h′ signed, sinθt = sinθi/n, and E(x_out) = E⊥ Σ T(θi) |dx/dx_out|.
//! Domain: every ray reaches the floor before it meets the water again, which [`SineWater::new`] holds by A < D and
//! a slope below 1. Singular: at folds, where dx_out/dx = 0, the irradiance is infinite as an inverse square root;
//! the flux on an interval is finite everywhere.

use super::{OutsideDomain, quadrature::panel};
use crate::optics::fresnel;
use std::f64::consts::TAU;

/// Pieces of a period: on each the map is taken as monotone, which leaves at most the piece about a fold in doubt.
const PIECES: u32 = 4096;

/// The water's surface over its floor, lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SineWater {
    amplitude: f64,
    wave_number: f64,
    depth: f64,
    ior: f64,
}

impl SineWater {
    /// Amplitude A and mean depth D (m), wave number k = 2π/length (1/m), index of refraction n ≥ 1.
    ///
    /// # Errors
    /// [`OutsideDomain`] for values that are not finite or not positive, A ≥ D, A·k ≥ 1 or n < 1.
    pub fn new(amplitude: f64, wave_number: f64, depth: f64, ior: f64) -> Result<Self, OutsideDomain> {
        let positive = [amplitude, wave_number, depth, ior].iter().all(|v| v.is_finite() && *v > 0.0);
        let rules = [
            (positive, "a value is not positive and finite"),
            (amplitude < depth, "the wave touches the floor"),
            (amplitude * wave_number < 1.0, "the wave is too steep"),
            (ior >= 1.0, "the refractive index is below 1"),
        ];
        let broken = rules.iter().find(|(holds, _)| !holds);
        broken.map_or(Ok(Self { amplitude, wave_number, depth, ior }), |&(_, why)| Err(OutsideDomain(why)))
    }

    /// Where a ray that enters at `x` lands, m.
    pub fn landing(&self, x: f64) -> f64 {
        let (height, incidence) = self.at(x);
        let refracted = (incidence.sin() / self.ior).asin();
        x + (self.depth + height) * (incidence - refracted).tan()
    }

    /// Irradiance times width, E⊥ = 1 W/m²: the flux per metre of crest that lands between `from` and `to` (m).
    pub fn flux(&self, from: f64, to: f64) -> f64 {
        let step = TAU / self.wave_number / f64::from(PIECES);
        // Rays land at most this far from where they enter: the steepest slope is at the nodes, the depth below 2D.
        let reach = 2.0 * self.depth * self.wave_number * self.amplitude;
        let (first, last) = (((from - reach) / step).floor() as i64, ((to + reach) / step).ceil() as i64);
        (first..last).map(|k| self.piece(k as f64 * step, (k + 1) as f64 * step, from, to)).sum()
    }

    /// The flux that enters between `a` and `b` and lands between `from` and `to`. Inside a piece the map is taken as
    /// straight to find the part that lands there; the flux of that part is integrated.
    fn piece(&self, a: f64, b: f64, from: f64, to: f64) -> f64 {
        let (start, end) = (self.landing(a), self.landing(b));
        let (low, high) = (start.min(end), start.max(end));
        if high <= from || low >= to {
            return 0.0;
        }
        let share = if high > low { (high.min(to) - low.max(from)) / (high - low) } else { 1.0 };
        share * panel(|x| self.transmitted(x), a, b)
    }

    fn transmitted(&self, x: f64) -> f64 {
        1.0 - fresnel(self.at(x).1.cos(), 1.0, self.ior)
    }

    /// Height and signed angle of incidence.
    fn at(&self, x: f64) -> (f64, f64) {
        let phase = self.wave_number * x;
        let slope = self.amplitude * self.wave_number * phase.cos();
        (self.amplitude * phase.sin(), slope.atan())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::refract;
    use glam::DVec3;

    /// 10⁶ rays over a period in bins of 1/40 of it: the rays at a bin's two edges are counted whole or not at all,
    /// two of 25 000, some more beside a fold.
    const COUNTED: f64 = 3e-4;

    #[test]
    fn flux_in_bins_agrees_with_rays_refracted_as_vectors() {
        for (amplitude, depth) in [(0.01, 1.0), (0.1, 1.0), (0.2, 0.4)] {
            let (k, n, bins, rays) = (3.0, 1.33, 40usize, 1_000_000);
            let water = SineWater::new(amplitude, k, depth, n).unwrap();
            let period = TAU / k;
            let mut counted = vec![0.0; bins];
            for i in 0..rays {
                let x = (f64::from(i) + 0.5) / f64::from(rays) * period;
                // The normal by central differences of the height: no derivative is shared.
                let (h, step) = (|x: f64| amplitude * (k * x).sin(), 1e-6);
                let slope = (h(x + step) - h(x - step)) / (2.0 * step);
                let normal = DVec3::new(-slope, 1.0, 0.0).normalize();
                let t = refract(DVec3::NEG_Y, normal, 1.0 / n).unwrap();
                let landed = x - (depth + h(x)) * t.x / t.y;
                let passes = 1.0 - fresnel(normal.y, 1.0, n);
                let bin = (landed.rem_euclid(period) / period * bins as f64) as usize;
                counted[bin.min(bins - 1)] += passes * period / f64::from(rays);
            }
            for (bin, counted) in counted.iter().enumerate() {
                let at = |k: usize| k as f64 / bins as f64 * period;
                let flux = water.flux(at(bin), at(bin + 1));
                let off = (flux - counted).abs() / (period / bins as f64);
                assert!(off < COUNTED, "A {amplitude} bin {bin}: {flux} against {counted}, off {off:.1e} E⊥");
            }
        }
    }

    #[test]
    fn a_period_receives_what_enters_in_one() {
        let water = SineWater::new(0.1, 3.0, 1.0, 1.0).unwrap();
        let period = TAU / 3.0;
        assert!((water.flux(0.2, 0.2 + period) / period - 1.0).abs() < 1e-9, "index 1 bends nothing");
        assert!((water.landing(0.7) - 0.7).abs() < 1e-12);
    }

    #[test]
    fn outside_its_domain_it_is_refused() {
        for [a, k, d, n] in [[0.0, 1.0, 1.0, 1.3], [1.0, 0.5, 1.0, 1.3], [0.5, 2.0, 1.0, 1.3], [0.1, 1.0, 1.0, 0.9]] {
            assert!(SineWater::new(a, k, d, n).is_err());
        }
        assert!(SineWater::new(f64::NAN, 1.0, 1.0, 1.3).is_err());
    }
}
