//! ꟻLIP: the difference that an eye sees when it alternates between two pictures.
//!
//! Based on: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020, "ꟻLIP: A Difference Evaluator for
//! Alternating Images" (its authors' code, LDR). Differs: linear values are first drawn as [`tone_map`] draws them, in
//! eight bits, at a stated exposure; pixels that are left out are black in both pictures. Not implemented: HDR-ꟻLIP.

use super::Measure;
use crate::image::tone_map;

/// The authors' default: a 0.7 m wide screen of 3840 pixels seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 67.0;

/// A picture in linear values, three a pixel, rows from the top, beside its truth.
pub struct Pictures<'a> {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// The image.
    pub image: &'a [[f32; 3]],
    /// The truth.
    pub reference: &'a [[f32; 3]],
    /// Variance of the truth's values.
    pub variance: Option<&'a [[f32; 3]]>,
    /// Whether a pixel is judged.
    pub judged: &'a [bool],
}

/// How the pictures are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Exposure: linear values × 2^ev, then the tone curve of [`tone_map`].
    pub ev: f64,
    /// Pixels a degree of the eye's field.
    pub pixels_per_degree: f64,
}

/// A figure, and the error of each pixel, 0 to 1.
pub struct Flip {
    /// The mean over the judged pixels.
    pub measure: Measure,
    /// Rows from the top.
    pub map: Vec<f32>,
}

/// Compares; `None` where the planes do not fill the size, or there is no pixel.
///
/// The noise is that of one draw: the truth against itself with normal noise of its variance added. The interval takes
/// the error for a distance (triangle inequality), which it is but for its exponents.
pub fn flip(pictures: &Pictures, seen: &Seen) -> Option<Flip> {
    let count = pictures.judged.len();
    let lengths = [pictures.image.len(), pictures.reference.len(), pictures.variance.map_or(count, <[_]>::len)];
    if lengths.iter().any(|&len| len != count) {
        return None;
    }
    let draw = |plane: &[[f32; 3]]| drawn(plane, pictures.judged, seen.ev);
    let map_of = |test: &[u8], reference: &[u8]| flip_map(pictures.size, test, reference, seen.pixels_per_degree);
    let reference = draw(pictures.reference);
    let map = map_of(&draw(pictures.image), &reference)?;
    let truth_noise = match pictures.variance {
        Some(variance) => {
            let noisy = draw(&noisy(pictures.reference, variance));
            Some(mean(&map_of(&noisy, &reference)?, pictures.judged))
        }
        None => None,
    };
    Some(Flip { measure: measure(pictures, mean(&map, pictures.judged), truth_noise), map })
}

/// The error of each pixel, 0 to 1, between pictures of 8-bit sRGB; `None` where they do not fill the size, pixels
/// across and down, or the size is 0.
pub fn flip_map(size: [usize; 2], image: &[u8], reference: &[u8], pixels_per_degree: f64) -> Option<Vec<f32>> {
    let [width, height] = size.map(|side| u32::try_from(side).ok().filter(|side| *side > 0));
    let (width, height) = (width?, height?);
    let bytes = size[0].checked_mul(size[1])?.checked_mul(3)?;
    if [image.len(), reference.len()] != [bytes; 2] {
        return None;
    }
    let [image, reference] = [image, reference].map(|p| nv_flip::FlipImageRgb8::with_data(width, height, p));
    Some(nv_flip::flip(reference, image, pixels_per_degree as f32).to_vec())
}

fn measure(pictures: &Pictures, value: f64, truth_noise: Option<f64>) -> Measure {
    let finite = |plane: &[[f32; 3]]| {
        plane.iter().zip(pictures.judged).all(|(pixel, judged)| !judged || pixel.iter().all(|v| v.is_finite()))
    };
    // A variance below zero is none.
    let sound = |plane: &[[f32; 3]]| {
        finite(plane) && plane.iter().zip(pictures.judged).all(|(v, judged)| !judged || v.iter().all(|v| *v >= 0.0))
    };
    if !finite(pictures.image) || !finite(pictures.reference) || !pictures.variance.is_none_or(sound) {
        return Measure::infinite(0.0, truth_noise.is_some());
    }
    let low = truth_noise.map(|noise| (value - noise).max(0.0));
    let high = truth_noise.map(|noise| (value + noise).min(1.0));
    Measure { value, low, high, truth_noise, perfect: 0.0 }.finite()
}

fn drawn(plane: &[[f32; 3]], judged: &[bool], ev: f64) -> Vec<u8> {
    plane.iter().zip(judged).flat_map(|(pixel, judged)| if *judged { tone_map(*pixel, ev) } else { [0; 3] }).collect()
}

fn mean(map: &[f32], judged: &[bool]) -> f64 {
    let kept: Vec<f64> = map.iter().zip(judged).filter(|(_, judged)| **judged).map(|(e, _)| f64::from(*e)).collect();
    kept.iter().sum::<f64>() / kept.len() as f64
}

/// The truth with normal noise of its variance; the bands of a pixel move together. The same for the same truth.
fn noisy(reference: &[[f32; 3]], variance: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut state = 0;
    let add = |(pixel, variance): (&[f32; 3], &[f32; 3])| {
        let z = normal(&mut state) as f32;
        std::array::from_fn(|band| pixel[band] + z * variance[band].sqrt())
    };
    reference.iter().zip(variance).map(add).collect()
}

/// Box and Muller 1958, on SplitMix64 (Steele, Lea, Flood 2014).
fn normal(state: &mut u64) -> f64 {
    let mut unit = || {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    (-2.0 * (1.0 - unit()).ln()).sqrt() * (std::f64::consts::TAU * unit()).cos()
}

/// The colours of an error map (matplotlib's magma), 0 black to 1 pale yellow.
pub fn magma(errors: &[f32]) -> Vec<[u8; 3]> {
    let colours = nv_flip::magma_lut().to_vec();
    let last = colours.len() / 3 - 1;
    let colour = |error: &f32| {
        let at = 3 * (error.clamp(0.0, 1.0) * last as f32).round() as usize;
        [colours[at], colours[at + 1], colours[at + 2]]
    };
    errors.iter().map(colour).collect()
}
