//! A sea: a sum of waves whose lengths, heights and ways are drawn from an ocean's spectrum by a seed, at any time.
//!
//! Based on: Pierson and Moskowitz, A proposed spectral form for fully developed wind seas (J. Geophys. Res. 69, 1964), for the
//! energy of each frequency; Longuet-Higgins, Cartwright and Smith, Observations of the directional spectrum of sea waves
//! (1963), for how it spreads about the wind. Waves of deep water: ω² = g k. Not implemented: capillary waves, whose lengths
//! are below 2 cm, and currents.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

/// m/s²
const GRAVITY: f64 = 9.80665;
/// α and β of the spectrum S(ω) = α g² ω⁻⁵ exp(−β (g/(U ω))⁴).
const ALPHA: f64 = 8.1e-3;
const BETA: f64 = 0.74;
/// Draws of a direction, of which the narrowest spread takes one in twenty.
const DRAWS: usize = 1000;

/// What a sea is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swell {
    /// Its speed 19.5 m above the water, m/s.
    pub wind: f64,
    /// Where it blows to, rad from u towards v.
    pub direction: f64,
    /// s: energy falls about the wind as cos²ˢ of half the angle.
    pub spread: f64,
    /// Waves that are summed.
    pub count: u32,
    /// Shortest and longest of them, m.
    pub lengths: [f64; 2],
    /// Times the height that the spectrum gives.
    pub factor: f64,
    /// Another one is another sea of the same kind.
    pub seed: u32,
}

/// A wave of a sea.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeaWave {
    /// The wave at time 0.
    pub first: Ripple,
    /// ω, rad/s.
    pub rate: f64,
}

/// A wave at one time: amplitude cos(number · x + phase).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    /// Radians a metre along u and v.
    pub number: DVec2,
    /// m
    pub amplitude: f64,
    /// Below a turn, rad.
    pub phase: f64,
}

/// All of its waves.
#[derive(Clone, Debug, PartialEq)]
pub struct Sea(pub Vec<SeaWave>);

impl Sea {
    /// One wave in each of as many bands, equally wide in the logarithm of ω, with all energy of the band.
    pub fn of(swell: &Swell) -> Self {
        let mut random = SplitMix(u64::from(swell.seed));
        let rate = |length: f64| (GRAVITY * TAU / length).sqrt();
        let [low, high] = [rate(swell.lengths[1]).ln(), rate(swell.lengths[0]).ln()];
        let edge = |k: f64| (low + (high - low) * k / f64::from(swell.count)).exp();
        let wave = |k: u32| {
            let band = [f64::from(k), f64::from(k + 1)].map(|k| swell.variance_below(edge(k)));
            let rate = edge(f64::from(k) + random.next());
            let (sin, cos) = (swell.direction + swell.aside(&mut random)).sin_cos();
            let number = rate * rate / GRAVITY * DVec2::new(cos, sin);
            let amplitude = swell.factor * (2.0 * (band[1] - band[0]).max(0.0)).sqrt();
            SeaWave { first: Ripple { number, amplitude, phase: TAU * random.next() }, rate }
        };
        Self((0..swell.count).map(wave).collect())
    }

    /// At a time, s: whole turns are left out here, in float64, so that late times keep their digits.
    pub fn at(&self, time: f64) -> Vec<Ripple> {
        let one =
            |wave: &SeaWave| Ripple { phase: (wave.first.phase - wave.rate * time).rem_euclid(TAU), ..wave.first };
        self.0.iter().map(one).collect()
    }
}

impl Swell {
    /// ∫ S dω from 0, m².
    fn variance_below(&self, rate: f64) -> f64 {
        let pace = GRAVITY / (self.wind * rate);
        ALPHA * self.wind.powi(4) / (4.0 * BETA * GRAVITY * GRAVITY) * (-BETA * pace.powi(4)).exp()
    }

    /// A direction beside the wind's, rad: drawn evenly, and kept as often as the spread says.
    fn aside(&self, random: &mut SplitMix) -> f64 {
        let draw = |_| {
            let (angle, kept) = (PI * (2.0 * random.next() - 1.0), random.next());
            (kept < (0.5 * angle).cos().powf(2.0 * self.spread)).then_some(angle)
        };
        (0..DRAWS).find_map(draw).unwrap_or(0.0)
    }
}

impl Ripple {
    fn angle(&self, at: DVec2) -> f64 {
        self.number.dot(at) + self.phase
    }

    /// Height of a sum of waves, m, at a place, m.
    pub fn height(all: &[Self], at: DVec2) -> f64 {
        all.iter().map(|w| w.amplitude * w.angle(at).cos()).sum()
    }

    /// Slopes there.
    pub fn gradient(all: &[Self], at: DVec2) -> DVec2 {
        all.iter().map(|w| -w.amplitude * w.angle(at).sin() * w.number).sum()
    }
}

/// Steele, Lea and Flood, Fast splittable pseudorandom number generators (2014): the same sea in every version.
struct SplitMix(u64);

impl SplitMix {
    /// From 0 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SWELL: Swell =
        Swell { wind: 8.0, direction: 0.7, spread: 8.0, count: 200, lengths: [0.5, 500.0], factor: 1.0, seed: 1 };
    /// Of the third derivative, times the step's square: of the shortest wave 1e-3 of its slope at this step.
    const STEP: f64 = 1e-4;
    /// Measured 2.5e-7.
    const DIFFERENCE: f64 = 1e-6;

    /// Four times the root of the variance, of all waves together 0.0213 U²; the bands leave out 0.1 % of it.
    #[test]
    fn the_significant_height_is_the_spectrums() {
        let variance: f64 = Sea::of(&SWELL).0.iter().map(|w| 0.5 * w.first.amplitude.powi(2)).sum();
        let expected = 4.0 * (ALPHA / (4.0 * BETA)).sqrt() * SWELL.wind.powi(2) / GRAVITY;
        let height = 4.0 * variance.sqrt();
        assert!((height / expected - 1.0).abs() < 0.002, "{height} for {expected}");
        assert!((expected / (0.0213 * 64.0) - 1.0).abs() < 0.01, "{expected}");
    }

    #[test]
    fn waves_follow_the_wind_and_deep_water() {
        let sea = Sea::of(&SWELL);
        let way: DVec2 = sea.0.iter().map(|w| w.first.number.normalize()).sum();
        // Of 200 waves the mean way is sure to 2°.
        assert!((way.y.atan2(way.x) - SWELL.direction).abs() < 0.1, "{way}");
        for wave in &sea.0 {
            let number = wave.first.number.length();
            assert!((wave.rate * wave.rate / (GRAVITY * number) - 1.0).abs() < 1e-12);
            assert!((SWELL.lengths[0]..=SWELL.lengths[1]).contains(&(TAU / number)));
        }
    }

    #[test]
    fn the_gradient_is_that_of_the_height_also_long_after() {
        let sea = Sea::of(&SWELL);
        for k in 0..200 {
            let waves = sea.at(if k % 2 == 0 { f64::from(k) } else { 1e6 });
            let at = DVec2::new(f64::from(k).sin(), f64::from(k * k).cos()) * 30.0;
            let slope =
                |step: DVec2| (Ripple::height(&waves, at + step) - Ripple::height(&waves, at - step)) / (2.0 * STEP);
            let differences = DVec2::new(slope(DVec2::X * STEP), slope(DVec2::Y * STEP));
            let error = (Ripple::gradient(&waves, at) - differences).length();
            assert!(error < DIFFERENCE, "{error:e} at {at}");
        }
        assert_ne!(Sea::of(&SWELL), Sea::of(&Swell { seed: 2, ..SWELL }));
    }
}
