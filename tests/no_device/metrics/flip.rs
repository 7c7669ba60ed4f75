//! FLIP beside the published evaluator, and what must not show in it.
//!
//! The values were made once with the Python package `flip-evaluator` 1.7 and NumPy:
//! `flip_evaluator.evaluate(reference / 255, test / 255, "LDR", applyMagma=False, parameters={"ppd": ppd})`, float32,
//! on the pictures of [`picture`]; the mean, then the map at (5, 5), (30, 20), (60, 40).

use nephroid::metrics::{PIXELS_PER_DEGREE, Pictures, Seen, flip, flip_map};

const WIDTH: usize = 64;
const HEIGHT: usize = 48;
const POINTS: [[usize; 2]; 3] = [[5, 5], [30, 20], [60, 40]];

/// Picture, pixels per degree, mean, error at [`POINTS`].
const PUBLISHED: [(&str, f64, f64, [f64; 3]); 8] = [
    ("same", 67.0, 0.0, [0.0, 0.0, 0.0]),
    ("same", 20.0, 0.0, [0.0, 0.0, 0.0]),
    ("shift", 67.0, 0.157_843, [0.045_065, 0.133_763, 0.485_498]),
    ("shift", 20.0, 0.147_288, [0.044_373, 0.129_652, 0.132_405]),
    ("disc", 67.0, 0.137_367, [0.0, 0.879_022, 0.0]),
    ("disc", 20.0, 0.105_034, [0.0, 0.855_751, 0.0]),
    ("dim", 67.0, 0.368_048, [0.321_528, 0.298_842, 0.394_508]),
    ("dim", 20.0, 0.348_890, [0.311_857, 0.270_927, 0.408_007]),
];

/// Float32 filters of two versions of one code, on errors up to 1: the same to about 10⁻⁵.
const SAME_CODE: f64 = 1e-4;

/// A pattern of ramps, and three changes to it.
fn picture(kind: &str) -> Vec<u8> {
    let pixel = |at: usize| {
        let (x, y) = (at % WIDTH, at / WIDTH);
        let moved = if kind == "shift" { 10 } else { 0 };
        let base = [3 * x + 2 * y + moved, x * x / 16 + 5 * y, 255 - 4 * x].map(|v| v % 256);
        let far = x.abs_diff(30).pow(2) + y.abs_diff(20).pow(2);
        match kind {
            "disc" if far < 100 => [255, 250, 240],
            "dim" => base.map(|v| (v * 9 / 10) as u8),
            _ => base.map(|v| v as u8),
        }
    };
    (0..WIDTH * HEIGHT).flat_map(pixel).collect()
}

#[test]
fn agrees_with_the_published_evaluator() {
    for (kind, ppd, mean, at) in PUBLISHED {
        let map = flip_map([WIDTH, HEIGHT], &picture(kind), &picture("same"), ppd).expect("pictures of one size");
        let found = map.iter().map(|e| f64::from(*e)).sum::<f64>() / map.len() as f64;
        assert!((found - mean).abs() < SAME_CODE, "{kind} at {ppd}: mean {found}, published {mean}");
        for ([x, y], published) in POINTS.into_iter().zip(at) {
            let found = f64::from(map[y * WIDTH + x]);
            assert!((found - published).abs() < SAME_CODE, "{kind} at {ppd}, ({x}, {y}): {found}, not {published}");
        }
    }
}

const SEEN: Seen = Seen { ev: 0.0, pixels_per_degree: PIXELS_PER_DEGREE };

fn judge(image: &[[f32; 3]], variance: Option<&[[f32; 3]]>, judged: &[bool]) -> nephroid::metrics::Measure {
    let reference = vec![[0.25_f32; 3]; 64];
    let pictures = Pictures { size: [8, 8], image, reference: &reference, variance, judged };
    flip(&pictures, &SEEN).expect("pictures of one size").measure
}

#[test]
fn what_is_left_out_does_not_show() {
    let (mut image, mut judged) = (vec![[0.25; 3]; 64], vec![true; 64]);
    (image[9], judged[9]) = ([f32::NAN; 3], false);
    assert_eq!(judge(&image, None, &judged).value, 0.0);
    assert_eq!(judge(&image, None, &[true; 64]).value, f64::INFINITY);
}

#[test]
fn noise_of_the_truth_is_seen_and_flagged() {
    let image = vec![[0.25; 3]; 64];
    let noisy = judge(&image, Some(&vec![[4e-4; 3]; 64]), &[true; 64]);
    assert!(noisy.truth_noise.is_some_and(|noise| noise > 0.0) && noisy.is_noise(), "{noisy:?}");
    let exact = judge(&image, Some(&vec![[0.0; 3]; 64]), &[true; 64]);
    assert_eq!((exact.truth_noise, exact.high), (Some(0.0), Some(0.0)));
}

#[test]
fn pictures_that_do_not_fill_their_size_are_refused() {
    assert!(flip_map([2, 2], &[0; 12], &[0; 11], 67.0).is_none());
    assert!(flip_map([0, 0], &[], &[], 67.0).is_none());
}
