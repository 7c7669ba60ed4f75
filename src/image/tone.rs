//! From linear radiance to the eight bits of a screen.

/// Brightness, after exposure, up to which tones stay linear.
const KNEE: f64 = 0.6;
/// Exposures beyond this are no different for any float32, and would leave the range of float64.
const MAX_EV: f64 = 300.0;
/// What a value that is no number looks like: magenta, a colour that no tone-mapped light has by accident.
const NOT_FINITE: [u8; 3] = [255, 0, 255];

/// Tone-maps one pixel of linear radiance, RGB with sRGB primaries, to 8-bit sRGB.
///
/// Radiance × 2^`ev`, so that 1 is white at EV 0. The largest band m beyond 0.6 rolls off to 0.6 + 0.4 x/(1 + x),
/// x = (m − 0.6)/0.4 (smooth at the knee, never quite white), and the other bands are scaled with it, so a highlight
/// keeps its hue. Then the sRGB curve (IEC 61966-2-1). Negative bands are black; a pixel with a band that is not finite
/// is magenta, so that it is seen.
pub fn tone_map(radiance: [f32; 3], ev: f64) -> [u8; 3] {
    if radiance.iter().any(|band| !band.is_finite()) {
        return NOT_FINITE;
    }
    let exposure = ev.clamp(-MAX_EV, MAX_EV).exp2();
    let exposed = radiance.map(|band| f64::from(band).max(0.0) * exposure);
    let brightest = exposed.into_iter().fold(0.0, f64::max);
    let scale = if brightest > KNEE { roll_off(brightest) / brightest } else { 1.0 };
    exposed.map(|band| (srgb(band * scale) * 255.0).round() as u8)
}

fn roll_off(brightness: f64) -> f64 {
    let x = (brightness - KNEE) / (1.0 - KNEE);
    KNEE + (1.0 - KNEE) * x / (1.0 + x)
}

fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_below_the_knee_by_hand() {
        // sRGB of 0.5 is 187.5 → 188, of 0.2140 is 128 (127.5 and a little), of 0.001 is 3.3 → 3.
        assert_eq!(tone_map([0.5, 0.214_05, 0.001], 0.0), [188, 128, 3]);
        assert_eq!(tone_map([0.25, 0.107_025, 0.0005], 1.0), [188, 128, 3]);
        assert_eq!(tone_map([0.0; 3], 0.0), [0; 3]);
    }

    #[test]
    fn highlights_roll_off_smoothly_and_keep_their_hue() {
        // x = 1 → 0.8; the other bands at half and a quarter of it.
        let expected = [0.8, 0.4, 0.2].map(|v| (srgb(v) * 255.0).round() as u8);
        assert_eq!(tone_map([1.0, 0.5, 0.25], 0.0), expected);
        assert_eq!(tone_map([1e30; 3], 0.0), [255; 3]);
        let step = 1e-6;
        let slope = (roll_off(KNEE + step) - KNEE) / step;
        assert!((slope - 1.0).abs() < 1e-5, "a kink at the knee: {slope}");
    }

    #[test]
    fn brighter_is_never_darker() {
        let greys: Vec<u8> = (0..5000).map(|i| tone_map([i as f32 * 1e-3; 3], 0.0)[0]).collect();
        assert!(greys.windows(2).all(|w| w[0] <= w[1]));
    }

    #[test]
    fn negative_is_black_and_no_number_is_magenta() {
        assert_eq!(tone_map([-1.0, 0.5, -0.1], 0.0), [0, 188, 0]);
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(tone_map([0.0, bad, 0.0], 0.0), NOT_FINITE);
        }
        // 2^1e9 is infinite, and 0 times it no number; black stays black, yellow yellow.
        assert_eq!(tone_map([1.0, 1.0, 0.0], 1e9), [255, 255, 0]);
        assert_eq!(tone_map([1.0, 1.0, 0.0], -1e9), [0, 0, 0]);
    }
}
