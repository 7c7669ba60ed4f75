//! The wave function of rendered water: a height over a plane, at any time.
//!
//! Based on: Guardado and Sánchez-Crespo, Rendering water caustics, GPU Gems (2004), ch. 2. Differs: the octave counter runs
//! down, and at the origin, where the surface is a cone's tip, x/d = y/d = 0.

use glam::{DVec2, DVec3};

/// Its constants; lengths are in the wave's own unit. [`Wave::PAPER`] has the paper's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// How many are summed, each of half the length and half the height of the one before.
    pub octaves: u32,
    /// WAVESIZE: the larger, the shorter the waves.
    pub wave_size: f64,
    /// FACTOR of the first octave.
    pub factor: f64,
    /// SPEED, rad/s.
    pub speed: f64,
    /// VTXSIZE: half the height of the first octave a unit away from the origin.
    pub vertex_size: f64,
}

impl Wave {
    /// As printed.
    pub const PAPER: Self = Self { octaves: 5, wave_size: 10.0, factor: 1.0, speed: 2.0, vertex_size: 0.01 };

    /// Factors f_k and phases SPEED t + x y WAVESIZE / f_k.
    fn terms(&self, at: DVec2, time: f64) -> impl Iterator<Item = (f64, f64)> {
        let (wave, product) = (*self, at.x * at.y);
        (0..self.octaves).map(move |k| {
            let factor = wave.factor * 0.5_f64.powi(k as i32);
            (factor, wave.speed * time + product * wave.wave_size / factor)
        })
    }

    /// z = −2 VTXSIZE d Σ f_k cos(SPEED t + x y WAVESIZE / f_k), with d the distance from the origin; `time` in s.
    pub fn height(&self, at: DVec2, time: f64) -> f64 {
        let sum: f64 = self.terms(at, time).map(|(factor, phase)| factor * phase.cos()).sum();
        -2.0 * self.vertex_size * at.length() * sum
    }

    /// (∂z/∂x, ∂z/∂y): ∂z/∂x = 2 VTXSIZE Σ (d y WAVESIZE sin(·) − f_k cos(·) x/d).
    pub fn gradient(&self, at: DVec2, time: f64) -> DVec2 {
        let (d, way) = (at.length(), at.normalize_or_zero());
        let crossed = DVec2::new(at.y, at.x);
        let term =
            |(factor, phase): (f64, f64)| d * self.wave_size * phase.sin() * crossed - factor * phase.cos() * way;
        2.0 * self.vertex_size * self.terms(at, time).map(term).sum::<DVec2>()
    }

    /// Along (−∂z/∂x, −∂z/∂y, 1), of unit length.
    pub fn normal(&self, at: DVec2, time: f64) -> DVec3 {
        (-self.gradient(at, time)).extend(1.0).normalize()
    }
}

/// The wave function at one time, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaveAt {
    /// Its constants.
    pub wave: Wave,
    /// s
    pub time: f64,
    /// Of one unit of the wave, m.
    pub length: f64,
    /// The wave's coordinates at the centre of its rectangle.
    pub middle: DVec2,
}

impl WaveAt {
    fn place(&self, at: DVec2) -> DVec2 {
        self.middle + at / self.length
    }

    /// m, at a place in metres from the centre.
    pub fn height(&self, at: DVec2) -> f64 {
        self.length * self.wave.height(self.place(at), self.time)
    }

    /// Slopes there.
    pub fn gradient(&self, at: DVec2) -> DVec2 {
        self.wave.gradient(self.place(at), self.time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Step of the central differences; the shortest wave is 0.03 units long.
    const STEP: f64 = 1e-5;
    /// Their error: the third derivative of the finest octave, (2π/0.03)³ z times the step's square, and rounding over the step.
    const DIFFERENCE: f64 = 1e-6;

    #[test]
    fn the_gradient_is_that_of_the_height() {
        let mut steepest = 0.0_f64;
        for k in 0..2000 {
            let turn = |factor: f64| (f64::from(k) * factor).sin();
            let (at, time) = (DVec2::new(turn(1.3), turn(2.9)), 3.0 * turn(0.7));
            if at.length() < 1e3 * STEP {
                continue;
            }
            let slope = |step: DVec2| {
                let [high, low] = [at + step, at - step].map(|p| Wave::PAPER.height(p, time));
                (high - low) / (2.0 * STEP)
            };
            let differences = DVec2::new(slope(DVec2::X * STEP), slope(DVec2::Y * STEP));
            let error = (Wave::PAPER.gradient(at, time) - differences).length();
            assert!(error < DIFFERENCE, "{error:e} at {at}, {time} s");
            steepest = steepest.max(differences.length());
        }
        println!("steepest {steepest:.3}");
        assert!(steepest > 1.0, "steep places were among them: {steepest}");
    }

    #[test]
    fn it_is_whole_where_it_has_no_gradient_and_long_after() {
        assert_eq!(Wave::PAPER.height(DVec2::ZERO, 1.0), 0.0);
        assert_eq!(Wave::PAPER.normal(DVec2::ZERO, 1.0), DVec3::Z);
        let later = Wave::PAPER.normal(DVec2::new(0.3, 0.9), 1e6);
        assert!(later.is_normalized() && later.z > 0.0, "{later}");
    }
}
