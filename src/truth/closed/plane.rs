//! Irradiance on plane receivers: direct light, and light below flat water.

use crate::optics::{fresnel, transmittance};
use glam::DVec3;

/// Irradiance of directional light on a plane: E⊥ max(0, −d·n), in the unit of `e_perp`.
///
/// `d` unit direction of travel, `n` unit normal of the lit side.
pub fn direct_parallel(d: DVec3, n: DVec3, e_perp: f64) -> f64 {
    e_perp * (-d.dot(n)).max(0.0)
}

/// Irradiance (W/m²) of a point light of `intensity` (W/sr) at `light` on a plane through `point`: I cosθ / r².
///
/// `n` unit normal of the lit side. At the light itself there is no direction: NaN.
pub fn direct_point(light: DVec3, intensity: f64, point: DVec3, n: DVec3) -> f64 {
    let to_point = point - light;
    let r = to_point.length();
    intensity * (-to_point.dot(n)).max(0.0) / (r * r * r)
}

/// Irradiance on a horizontal floor below flat water under parallel light: E⊥ cosθ T(θ) exp(−σ_a l / cosθ_t).
///
/// `cos_sun`: cosine of the sun's angle from the zenith; `ior` of the water; `depth` l (m), `absorption` σ_a (1/m).
/// A sun at or below the horizon gives 0. Refraction moves the light sideways but keeps the area it crosses, so the
/// floor is lit evenly.
pub fn flat_water(ior: f64, cos_sun: f64, depth: f64, absorption: f64, e_perp: f64) -> f64 {
    if cos_sun <= 0.0 {
        return 0.0;
    }
    let cos_t = (1.0 - (1.0 - cos_sun * cos_sun) / (ior * ior)).sqrt();
    e_perp * cos_sun * (1.0 - fresnel(cos_sun, 1.0, ior)) * transmittance(absorption, depth / cos_t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::texel_solid_angle;
    use std::f64::consts::PI;

    /// Roundings of float64 over a few dozen operations.
    const ROUNDING: f64 = 1e-13;
    /// Midpoint rule over 400 × 400 cells of a smooth integrand: second order in 1/400.
    const MIDPOINT: f64 = 1e-5;

    #[test]
    fn direct_light_by_hand() {
        let slanted = DVec3::new(0.6, -0.8, 0.0);
        assert!((direct_parallel(slanted, DVec3::Y, 2.0) - 1.6).abs() < ROUNDING);
        assert_eq!(direct_parallel(slanted, DVec3::NEG_Y, 2.0), 0.0);
        // 3-4-5: cosθ = 4/5 at distance 5.
        let e = direct_point(DVec3::new(3.0, 4.0, 0.0), 50.0, DVec3::ZERO, DVec3::Y);
        assert!((e - 1.6).abs() < ROUNDING);
        assert_eq!(direct_point(DVec3::new(3.0, 4.0, 0.0), 50.0, DVec3::ZERO, DVec3::NEG_Y), 0.0);
    }

    #[test]
    fn a_point_lights_flux_on_a_rectangle_is_its_solid_angle() {
        let (n, light) = (400, DVec3::new(0.0, 1.0, 0.0));
        let at = |i: i32, lo: f64, hi: f64| lo + (hi - lo) * (f64::from(i) + 0.5) / f64::from(n);
        let cell = 1.4 * 0.7 / f64::from(n * n);
        let flux: f64 = (0..n * n)
            .map(|k| DVec3::new(at(k % n, -0.5, 0.9), 0.0, at(k / n, 0.1, 0.8)))
            .map(|p| direct_point(light, 3.0, p, DVec3::Y) * cell)
            .sum();
        let exact = 3.0 * texel_solid_angle(-0.5, 0.1, 0.9, 0.8);
        assert!((flux / exact - 1.0).abs() < MIDPOINT, "{flux} against {exact}");
    }

    /// Share of power that passes, by the amplitudes of the transmitted waves and the Poynting vector, not by 1 − R.
    fn transmitted_power(cos_i: f64, n: f64) -> f64 {
        let cos_t = (1.0 - cos_i.acos().sin().powi(2) / (n * n)).sqrt();
        let s = 2.0 * cos_i / (cos_i + n * cos_t);
        let p = 2.0 * cos_i / (n * cos_i + cos_t);
        n * cos_t / cos_i * 0.5 * (s * s + p * p)
    }

    #[test]
    fn flat_water_agrees_with_the_transmitted_waves() {
        for degrees in [0.0, 10.0, 30.0, 60.0, 85.0] {
            let cos = f64::to_radians(degrees).cos();
            let cos_t = (f64::to_radians(degrees).sin() / 1.33).asin().cos();
            let expected = 5.0 * cos * transmitted_power(cos, 1.33) * (-0.2 * 1.5 / cos_t).exp();
            let ours = flat_water(1.33, cos, 1.5, 0.2, 5.0);
            assert!((ours - expected).abs() < ROUNDING, "{degrees}°: {ours} against {expected}");
        }
    }

    #[test]
    fn flat_water_overhead_by_hand_and_its_edges() {
        let passes = 1.0 - (0.33f64 / 2.33).powi(2);
        assert!((flat_water(1.33, 1.0, 2.0, 0.0, 1.0) - passes).abs() < ROUNDING);
        assert_eq!(flat_water(1.33, 0.0, 2.0, 0.0, 1.0), 0.0);
        assert_eq!(flat_water(1.33, -0.5, 2.0, 0.0, 1.0), 0.0);
        assert!((flat_water(1.0, 0.5, 2.0, 0.0, PI) - PI / 2.0).abs() < ROUNDING);
    }
}
