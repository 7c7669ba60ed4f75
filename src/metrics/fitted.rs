//! What is right up to a scale: the scale that fits the truth best, and the judged figure that is left with it.

use super::{Measure, Pair, RELATIVE_TO_E0, pair::Value, relmse};

/// An image fitted to the truth by one scale for all pixels and bands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted {
    /// By which the image is multiplied; of an image without light, which no scale changes, 1.
    pub scale: f64,
    /// The judged figure then: no scale makes it less.
    pub relmse: Measure,
}

/// The s that makes Σ (s x − r)² / (r² + ε) least, ε = (0.1 E₀)²: s = Σ w x r / Σ w x², w = 1 / (r² + ε).
pub fn fitted(pair: &Pair, e0: f64) -> Fitted {
    let epsilon = (RELATIVE_TO_E0 * e0).powi(2);
    let (mut along, mut own) = (0.0, 0.0);
    for Value { x, r, .. } in pair.each().flatten() {
        let weight = 1.0 / (r * r + epsilon);
        along += weight * x * r;
        own += weight * x * x;
    }
    let scale = if own > 0.0 { along / own } else { 1.0 };
    Fitted { scale, relmse: relmse(&pair.clone().scaled(scale), e0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(image: &[f64], reference: &[f64]) -> Pair {
        Pair::new(1, image.to_vec(), reference.to_vec(), None).unwrap()
    }

    #[test]
    fn the_scale_is_found_and_no_other_is_better() {
        // A few sums and quotients of numbers of order one.
        const ROUNDING: f64 = 1e-12;
        let [image, truth] = [[0.5, 0.1, 0.7, 0.0], [1.0, 0.4, 2.0, 0.1]];
        let exact = fitted(&pair(&truth.map(|r| r / 3.0), &truth), 1.0);
        assert!((exact.scale - 3.0).abs() < ROUNDING && exact.relmse.value < ROUNDING);
        let best = fitted(&pair(&image, &truth), 1.0);
        for factor in [0.9, 0.99, 1.01, 1.1] {
            let other = relmse(&pair(&image, &truth).scaled(factor * best.scale), 1.0);
            assert!(other.value > best.relmse.value, "{factor}");
        }
    }

    #[test]
    fn without_light_any_scale_does_and_what_is_no_number_is_infinite() {
        let dark = fitted(&pair(&[0.0; 3], &[1.0, 0.0, 2.0]), 1.0);
        assert_eq!((dark.scale, dark.relmse), (1.0, relmse(&pair(&[0.0; 3], &[1.0, 0.0, 2.0]), 1.0)));
        assert_eq!(fitted(&pair(&[f64::NAN, 1.0], &[1.0, 1.0]), 1.0).relmse.value, f64::INFINITY);
    }
}
