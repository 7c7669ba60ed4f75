//! Numbers that look random and are functions of their place: streams by seed, and a low-discrepancy sequence.

use glam::DVec2;

/// Mixes a state into 64 bits that look independent (SplitMix64: Steele, Lea & Flood 2014, figure 10).
pub fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A stream of its own for each tuple of numbers.
pub fn stream(parts: &[u64]) -> u64 {
    parts.iter().fold(0, |state, part| mix(state ^ mix(*part)))
}

/// The 53 high bits as a number in [0, 1).
pub fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// The next number of a stream, in [0, 1).
pub fn draw(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    unit(mix(*state))
}

/// The R2 sequence (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"), shifted as a whole by a
/// random vector (Cranley & Patterson 1976): multiples of 1/g and 1/g² modulo 1, g³ = g + 1, in 64-bit fixed point,
/// where adding wraps by itself and nothing is rounded.
#[derive(Clone, Copy, Debug)]
pub struct R2 {
    shift: [u64; 2],
}

/// 2^64/g and 2^64/g², g = 1.32471795724474602596…
const STEPS: [u64; 2] = [0xc13f_a9a9_02a6_328f, 0x91e1_0da5_c79e_7b1d];

impl R2 {
    /// The sequence with the shift of a stream.
    pub fn new(stream: u64) -> Self {
        Self { shift: [mix(stream), mix(stream ^ u64::MAX)] }
    }

    /// The i-th point of the unit square.
    pub fn point(&self, i: u64) -> DVec2 {
        let at = |k: usize| unit(self.shift[k].wrapping_add(STEPS[k].wrapping_mul(i)));
        DVec2::new(at(0), at(1))
    }
}

/// As [`R2`], in four dimensions: multiples of 1/g to 1/g⁴, g⁵ = g + 1.
#[derive(Clone, Copy, Debug)]
pub struct R4 {
    shift: [u64; 4],
}

/// 2^64/g to 2^64/g⁴, g = 1.16730397826141868425…
const STEPS_OF_FOUR: [u64; 4] =
    [0xdb4f_0b91_75ae_2165, 0xbbe0_5633_03a4_615f, 0xa0f2_ec75_a1fe_1576, 0x89e1_8285_7d9e_d689];

impl R4 {
    /// The sequence with the shift of a stream.
    pub fn new(stream: u64) -> Self {
        let shift = |k: u64| mix(stream ^ mix(k));
        Self { shift: [shift(0), shift(1), shift(2), shift(3)] }
    }

    /// The i-th point, as two of unit squares.
    pub fn point(&self, i: u64) -> [DVec2; 2] {
        let at = |k: usize| unit(self.shift[k].wrapping_add(STEPS_OF_FOUR[k].wrapping_mul(i)));
        [DVec2::new(at(0), at(1)), DVec2::new(at(2), at(3))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_steps_are_those_of_the_plastic_number() {
        let g = 1.324_717_957_244_746_f64;
        for (step, exact) in STEPS.iter().zip([1.0 / g, 1.0 / (g * g)]) {
            assert!((unit(*step) - exact).abs() < 1e-15, "{}", unit(*step));
        }
    }

    #[test]
    fn the_steps_of_four_are_those_of_their_number() {
        let g = 1.167_303_978_261_418_7_f64;
        assert!((g.powi(5) - g - 1.0).abs() < 1e-15);
        for (k, step) in STEPS_OF_FOUR.iter().enumerate() {
            assert!((unit(*step) - g.powi(-(k as i32 + 1))).abs() < 1e-15, "{k}: {}", unit(*step));
        }
    }

    #[test]
    fn points_fill_the_square_evenly() {
        // 4096 points in 256 boxes: 16 each; random ones would stray by 4 at one σ, by 14 in the worst box.
        let sequence = R2::new(7);
        let mut boxes = [0i32; 256];
        for i in 0..4096 {
            let p = sequence.point(i) * 16.0;
            boxes[p.x as usize * 16 + p.y as usize] += 1;
        }
        assert!(boxes.iter().all(|n| (n - 16).abs() <= 3), "{boxes:?}");
    }

    #[test]
    fn streams_differ_and_repeat() {
        assert_eq!(stream(&[1, 2]), stream(&[1, 2]));
        assert!(stream(&[1, 2]) != stream(&[2, 1]) && stream(&[0]) != stream(&[0, 0]));
        let mut state = stream(&[3]);
        let mean = (0..4096).map(|_| draw(&mut state)).sum::<f64>() / 4096.0;
        assert!((mean - 0.5).abs() < 0.02, "{mean}"); // 4.4 σ of 0.289/64
    }
}
