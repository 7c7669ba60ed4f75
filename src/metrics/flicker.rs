//! Flicker: how much more a sequence changes from frame to frame than the truth does.

use super::{Measure, NORMAL_95, Pair};

/// Mean of (xₖ₊₁ − xₖ)² − (rₖ₊₁ − rₖ)² over values and steps, over the mean of r squared. Each pair is one frame of a
/// sequence, the same pixels in all. Below zero where the image moves less than the truth: what is blurred does. None of
/// fewer than two frames, or of frames of other sizes.
///
/// The truth's noise is no part of its change: var(rₖ₊₁) + var(rₖ) is taken from it, and the interval holds what that leaves.
pub fn flicker(frames: &[Pair]) -> Option<Measure> {
    let first = frames.first()?;
    let alike = |pair: &Pair| pair.pixels() == first.pixels() && pair.channels() == first.channels();
    if frames.len() < 2 || !frames.iter().all(alike) {
        return None;
    }
    let noisy = frames.iter().all(Pair::has_variance);
    if !frames.iter().all(Pair::is_sound) {
        return Some(Measure::infinite(0.0, noisy));
    }
    let mean = frames.iter().map(|pair| pair.reference_mean(|r| r)).sum::<f64>() / frames.len() as f64;
    let values = (first.pixels() * first.channels()) as f64;
    let (mut excess, mut scatter) = (0.0, 0.0);
    for step in frames.windows(2) {
        for (now, next) in step[0].each().flatten().zip(step[1].each().flatten()) {
            let (dx, dr, v) = (next.x - now.x, next.r - now.r, next.v + now.v);
            excess += dx * dx - (dr * dr - v);
            scatter += 4.0 * dr * dr * v + 2.0 * v * v;
        }
    }
    let scale = 1.0 / (values * (frames.len() - 1) as f64 * mean * mean);
    let (value, spread) = (excess * scale, NORMAL_95 * scatter.sqrt() * scale);
    let noise = frames.iter().map(|pair| pair.each().flatten().map(|value| value.v).sum::<f64>()).sum::<f64>();
    let noise = 2.0 * noise / (values * frames.len() as f64 * mean * mean);
    let known = |bound: f64| noisy.then_some(bound);
    let (low, high) = (known(value - spread), known(value + spread));
    Some(Measure { value, low, high, truth_noise: known(noise), perfect: 0.0 }.finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(image: f64, truth: f64, variance: f64) -> Pair {
        Pair::new(1, vec![image; 4], vec![truth; 4], Some(vec![variance; 4])).unwrap()
    }

    #[test]
    fn what_moves_as_the_truth_does_has_none() {
        let frames: Vec<Pair> = [1.0, 1.5, 0.5].iter().map(|r| frame(r + 0.25, *r, 0.0)).collect();
        let measure = flicker(&frames).unwrap();
        assert!(measure.value.abs() < 1e-12 && measure.low == measure.high, "{measure:?}");
    }

    #[test]
    fn steps_beyond_the_truths_count_squared_and_fewer_count_below_zero() {
        let of = |steps: [f64; 2]| flicker(&steps.map(|x| frame(x, 2.0, 0.0))).unwrap().value;
        assert!((of([2.0, 3.0]) - 0.25).abs() < 1e-12, "1² over 2²");
        let still = [frame(2.0, 1.0, 0.0), frame(2.0, 3.0, 0.0)];
        assert!((flicker(&still).unwrap().value + 1.0).abs() < 1e-12, "−2² over 2²");
    }

    #[test]
    fn the_truths_noise_is_no_flicker() {
        // Truths two noises apart: what they seem to move is noise as it is expected.
        let frames = [frame(1.0, 0.9, 0.02), frame(1.0, 1.1, 0.02)];
        let measure = flicker(&frames).unwrap();
        assert!(measure.value.abs() < 1e-12, "{measure:?}");
        assert!(measure.low.unwrap() < 0.0 && measure.high.unwrap() > 0.0);
    }

    #[test]
    fn one_frame_and_frames_of_two_sizes_have_none_and_nan_is_infinite() {
        assert!(flicker(&[]).is_none() && flicker(&[frame(1.0, 1.0, 0.0)]).is_none());
        let small = Pair::new(1, vec![1.0], vec![1.0], None).unwrap();
        assert!(flicker(&[frame(1.0, 1.0, 0.0), small]).is_none());
        let broken = [frame(1.0, 1.0, 0.0), frame(f64::NAN, 1.0, 0.0)];
        assert_eq!(flicker(&broken).unwrap().value, f64::INFINITY);
        let dark = [frame(1.0, 0.0, 0.0), frame(1.5, 0.0, 0.0)];
        assert_eq!(flicker(&dark).unwrap().value, f64::INFINITY, "nothing to be relative to");
    }
}
