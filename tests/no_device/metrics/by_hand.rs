//! Figures that fit on the back of an envelope, and values that are no numbers.

use nephroid::metrics::{Measure, Pair, energy_ratio, mae, mape, relmse, relmse_standard, relmse_trimmed, rmse};

/// Float64 rounding of sums of a few terms.
const ROUNDING: f64 = 1e-12;

fn pair(image: &[f64], reference: &[f64]) -> Pair {
    Pair::new(1, image.to_vec(), reference.to_vec(), None).expect("of one length")
}

#[track_caller]
fn near(measure: Measure, expected: f64) {
    assert!((measure.value - expected).abs() <= ROUNDING * expected.abs(), "{} for {expected}", measure.value);
}

/// E₀ = 10, ε = 1: (1 − 2)²/(4 + 1) = 0.2, (3 − 0)²/(0 + 1) = 9, 0: their mean is 9.2/3.
#[test]
fn the_judged_figure() {
    near(relmse(&pair(&[1.0, 3.0, 5.0], &[2.0, 0.0, 5.0]), 10.0), 9.2 / 3.0);
}

/// The mean is 10, ε = 10⁻² 100 = 1: (0 − 20)²/401 and (1 − 0)²/1.
#[test]
fn the_standard_figure() {
    near(relmse_standard(&pair(&[0.0, 1.0], &[20.0, 0.0])), (400.0 / 401.0 + 1.0) / 2.0);
}

/// Of 2000 pixels two are left out, the two worst: 1 against a mean of 1 is worth 1/1.01.
#[test]
fn the_trimmed_figure_leaves_out_the_worst() {
    let reference = vec![1.0; 2000];
    let mut image = reference.clone();
    (image[3], image[700], image[900]) = (100.0, 50.0, 2.0);
    near(relmse_trimmed(&pair(&image, &reference)), 1.0 / 1.01 / 1998.0);
}

/// A pixel is left out with all its bands.
#[test]
fn trimming_takes_whole_pixels() {
    let image = vec![1.0, 5.0, 1.0, 1.0];
    let pair = Pair::new(2, image, vec![1.0; 4], None).expect("two pixels of two bands");
    near(relmse_trimmed(&pair), 0.0);
}

/// Differences 3, −4, 0.
#[test]
fn absolute_and_squared_differences() {
    let pair = pair(&[4.0, -3.0, 7.0], &[1.0, 1.0, 7.0]);
    near(rmse(&pair), (25.0_f64 / 3.0).sqrt());
    near(mae(&pair), 7.0 / 3.0);
    // ε = 10⁻² 3 = 0.03.
    near(mape(&pair), (3.0 / 1.03 + 4.0 / 1.03) / 3.0);
    near(energy_ratio(&pair), 8.0 / 9.0);
}

/// v = 0.25 everywhere, r = 2, ε = 1, x = r: v/(r² + ε) = 0.05; E|η| = 0.5 √(2/π); √(4 · 0.25)/8 for four pixels.
#[test]
fn noise_of_a_perfect_image() {
    let flat = |value| vec![value; 4];
    let pair = Pair::new(1, flat(2.0), flat(2.0), Some(flat(0.25))).expect("of one length");
    let noise = |measure: Measure| measure.truth_noise.expect("with a variance");
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < ROUNDING, "{found} for {expected}");
    near(noise(relmse(&pair, 10.0)), 0.05);
    near(noise(rmse(&pair)), 0.5);
    near(noise(mae(&pair)), 0.5 * (2.0 / std::f64::consts::PI).sqrt());
    near(noise(energy_ratio(&pair)), 0.125);
    for measure in all(&pair) {
        assert!(measure.is_noise(), "{measure:?}");
    }
}

fn all(pair: &Pair) -> [Measure; 7] {
    [
        relmse(pair, 1.0),
        relmse_standard(pair),
        relmse_trimmed(pair),
        rmse(pair),
        mae(pair),
        mape(pair),
        energy_ratio(pair),
    ]
}

#[test]
fn a_reference_without_variance_has_no_interval() {
    for measure in all(&pair(&[1.0, 2.0], &[1.0, 1.0])) {
        assert_eq!((measure.low, measure.high, measure.truth_noise), (None, None, None));
        assert!(measure.value.is_finite() && !measure.is_noise());
    }
}

#[test]
fn a_reference_without_noise_is_exact() {
    let pair = Pair::new(1, vec![1.0, 2.0], vec![1.0, 1.0], Some(vec![0.0; 2])).expect("of one length");
    for measure in all(&pair) {
        assert_eq!((measure.low, measure.high), (Some(measure.value), Some(measure.value)));
        assert_eq!(measure.truth_noise, Some(0.0));
        assert!(!measure.is_noise());
    }
}

/// In the image, the reference or the variance; and a variance below zero; and nothing at all.
#[test]
fn what_is_no_number_is_infinitely_wrong() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let spoilt = |at: usize| {
            let plane = |own: usize| vec![1.0, if own == at { bad } else { 1.0 }];
            Pair::new(1, plane(0), plane(1), Some(plane(2))).expect("of one length")
        };
        for measure in (0..3).flat_map(|at| all(&spoilt(at))) {
            assert_eq!(measure.value, f64::INFINITY);
            assert_eq!(measure.truth_noise, Some(f64::INFINITY));
        }
    }
    let negative = Pair::new(1, vec![1.0], vec![1.0], Some(vec![-1.0])).expect("of one length");
    let empty = Pair::new(3, vec![], vec![], None).expect("of one length");
    for measure in [&negative, &empty].into_iter().flat_map(all) {
        assert_eq!(measure.value, f64::INFINITY);
    }
}

/// Without light in the truth: light out of nothing is infinitely too much, none at all is right.
#[test]
fn energy_of_the_dark() {
    assert_eq!(energy_ratio(&pair(&[1.0], &[0.0])).value, f64::INFINITY);
    assert_eq!(energy_ratio(&pair(&[0.0], &[0.0])).value, 1.0);
    assert_eq!(mape(&pair(&[0.0], &[0.0])).value, 0.0);
}

#[test]
fn planes_of_different_length_are_no_pair() {
    assert!(Pair::new(1, vec![1.0], vec![1.0, 2.0], None).is_none());
    assert!(Pair::new(1, vec![1.0], vec![1.0], Some(vec![])).is_none());
    assert!(Pair::new(2, vec![1.0], vec![1.0], None).is_none());
    assert!(Pair::new(0, vec![], vec![], None).is_none());
}
