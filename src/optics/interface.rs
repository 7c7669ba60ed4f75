//! Snell, Fresnel, reflection, Beer–Lambert.

use glam::DVec3;

/// The squared cosine of the refracted ray, 1 − η²(1 − cos²θ), negative beyond the critical angle.
///
/// Written so that η = 1 gives back cos²θ exactly: a medium of equal index then vanishes to the last bit.
fn cos2_transmitted(cos_i: f64, eta: f64) -> f64 {
    let bent = eta * cos_i;
    (1.0 - eta) * (1.0 + eta) + bent * bent
}

/// The refracted unit direction, or `None` beyond the critical angle (total internal reflection).
///
/// `d` unit direction of travel, `n` unit normal with d·n ≤ 0, `eta` = n_from / n_to. Snell's law in vector form:
/// t = η d + (η cosθ − cosθ_t) n (Glassner, *An Introduction to Ray Tracing*, 1989, ch. 2, §5.2).
///
/// Edges: η = 1 returns `d` itself; the critical angle exactly is refracted, along the surface; grazing incidence
/// into the denser medium leaves under the critical angle; a zero vector gives no NaN (and no unit vector).
///
/// # Examples
/// ```
/// use glam::DVec3;
/// let straight_down = nephroid::optics::refract(DVec3::NEG_Y, DVec3::Y, 1.0 / 1.5);
/// assert_eq!(straight_down, Some(DVec3::NEG_Y));
/// ```
pub fn refract(d: DVec3, n: DVec3, eta: f64) -> Option<DVec3> {
    let cos_i = -d.dot(n);
    let cos2_t = cos2_transmitted(cos_i, eta);
    (cos2_t >= 0.0).then(|| eta * d + (eta * cos_i - cos2_t.sqrt()) * n)
}

/// The mirrored direction d − 2(d·n)n; `n` may face either way.
pub fn reflect(d: DVec3, n: DVec3) -> DVec3 {
    d - 2.0 * d.dot(n) * n
}

/// The share of unpolarised light that a smooth dielectric interface reflects, in [0, 1]; what passes is 1 − this.
///
/// `cos_i` = |d·n|, clamped to [0, 1]. The exact Fresnel equations, the mean of the two polarisations (Born & Wolf,
/// *Principles of Optics*, §1.5.2, eq. 21a), no fit.
///
/// Edges: 1 from the critical angle on; 1 at grazing incidence, except between equal indices, where an absent
/// interface reflects nothing: 0 for every angle, at cosθ = 0 by definition (the equations read 0/0 there).
pub fn fresnel(cos_i: f64, n_from: f64, n_to: f64) -> f64 {
    let cos_i = cos_i.clamp(0.0, 1.0);
    let cos2_t = cos2_transmitted(cos_i, n_from / n_to);
    if cos2_t < 0.0 {
        return 1.0;
    }
    let cos_t = cos2_t.sqrt();
    let s = amplitude(n_from * cos_i, n_to * cos_t);
    let p = amplitude(n_to * cos_i, n_from * cos_t);
    0.5 * (s * s + p * p)
}

/// The share of unpolarised light that a smooth metal reflects, in [0, 1]; it absorbs the rest.
///
/// `eta` + i `k` is its complex index relative to the medium before it, `cos_i` = |d·n|, clamped to [0, 1] (Born & Wolf,
/// *Principles of Optics*, §14.2; in real numbers as by Lagarde 2013, "Memo on Fresnel equations"). Edges: 1 at grazing
/// incidence; with k = 0 that of a dielectric, total reflection included; 0 for eta = 1, k = 0, no surface, at every angle.
pub fn fresnel_conductor(cos_i: f64, eta: f64, k: f64) -> f64 {
    if eta == 1.0 && k == 0.0 {
        return 0.0;
    }
    let c = cos_i.clamp(0.0, 1.0);
    let (cos2, sin2) = (c * c, 1.0 - c * c);
    let t0 = eta * eta - k * k - sin2;
    let a2b2 = t0.hypot(2.0 * eta * k);
    // a b = η k: the sum that cancels is not taken.
    let a = if t0 < 0.0 { eta * k / (0.5 * (a2b2 - t0)).sqrt() } else { (0.5 * (a2b2 + t0)).sqrt() };
    let s = ratio(a2b2 + cos2, 2.0 * a * c);
    let p = s * ratio(cos2 * a2b2 + sin2 * sin2, 2.0 * a * c * sin2);
    0.5 * (s + p)
}

/// (a − b)/(a + b) of a ≥ b ≥ 0; 1 where both are 0: what is nothing on both sides reflects all.
fn ratio(a: f64, b: f64) -> f64 {
    if a + b == 0.0 { 1.0 } else { ((a - b) / (a + b)).max(0.0) }
}

/// (a − b)/(a + b) for a, b ≥ 0, and 0 where both are 0.
fn amplitude(a: f64, b: f64) -> f64 {
    if a + b == 0.0 { 0.0 } else { (a - b) / (a + b) }
}

/// The share of light left after `length` metres in a medium that absorbs `absorption` per metre (Beer–Lambert).
///
/// A medium that absorbs nothing lets everything pass, at any length, infinite too (0·∞ is not asked).
pub fn transmittance(absorption: f64, length: f64) -> f64 {
    if absorption == 0.0 { 1.0 } else { (-absorption * length).exp() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// A few roundings of float64 on numbers of order one, and the conditioning of asin away from its ends.
    const ROUNDING: f64 = 1e-13;
    /// Near the critical angle cosθ_t is a square root of a rounded difference: √(2⁻⁵²) at worst.
    const CRITICAL: f64 = 3e-8;
    /// The form by angles subtracts two nearly equal angles when the indices are close: 2⁻⁵² over 1e-6 at n = 1.0001.
    const BY_ANGLES: f64 = 1e-10;
    const INDICES: [(f64, f64); 6] = [(1.0, 1.5), (1.5, 1.0), (1.0, 1.33), (1.33, 1.5), (1.0, 2.42), (1.0, 1.0001)];

    /// A ray that meets the plane y = 0 under the angle θ, turned by φ about y.
    fn ray(theta: f64, phi: f64) -> DVec3 {
        DVec3::new(theta.sin() * phi.cos(), -theta.cos(), theta.sin() * phi.sin())
    }

    fn angles() -> impl Iterator<Item = f64> {
        (0..=200).map(|i| f64::from(i) / 200.0 * 1.57)
    }

    #[test]
    fn refraction_obeys_snell_in_the_plane_of_incidence() {
        for ((from, to), theta) in INDICES.iter().flat_map(|&pair| angles().map(move |t| (pair, t))) {
            let d = ray(theta, 0.7);
            let sin_t = theta.sin() * from / to;
            match refract(d, DVec3::Y, from / to) {
                Some(t) => {
                    assert!((t.length() - 1.0).abs() < ROUNDING, "{from} {to} {theta}: length {}", t.length());
                    let expected = ray(sin_t.min(1.0).asin(), 0.7);
                    assert!((t - expected).length() < CRITICAL, "{from} {to} {theta}: {t} against {expected}");
                }
                None => assert!(sin_t > 1.0 - ROUNDING, "{from} {to} {theta}: sinθt = {sin_t} is no total reflection"),
            }
        }
    }

    #[test]
    fn refraction_is_reversible() {
        for theta in angles().take(199) {
            let d = ray(theta, -1.1);
            let inside = refract(d, DVec3::Y, 1.0 / 1.5).unwrap();
            let back = refract(-inside, DVec3::NEG_Y, 1.5).unwrap();
            assert!((back + d).length() < CRITICAL, "{theta}: {back} against {}", -d);
        }
    }

    #[test]
    fn index_one_changes_no_bit() {
        for theta in angles().chain([FRAC_PI_2]) {
            let d = ray(theta, 0.3);
            assert_eq!(refract(d, DVec3::Y, 1.0), Some(d));
            assert_eq!(fresnel(theta.cos(), 1.0, 1.0), 0.0);
        }
    }

    #[test]
    fn both_sides_of_the_critical_angle() {
        let critical = (1.0f64 / 1.5).asin();
        let step = 1e-9;
        assert!(refract(ray(critical - step, 0.0), DVec3::Y, 1.5).is_some());
        assert!(refract(ray(critical + step, 0.0), DVec3::Y, 1.5).is_none());
        assert_eq!(fresnel((critical + step).cos(), 1.5, 1.0), 1.0);
        // Reflectance rises as 1 − k·√(θc − θ): at 1e-9 below it is still within 1e-3 of 1, and below 1.
        let below = fresnel((critical - step).cos(), 1.5, 1.0);
        assert!(below < 1.0 && below > 0.999, "{below}");
    }

    #[test]
    fn grazing_and_zero_vectors() {
        let along = refract(DVec3::X, DVec3::Y, 1.0 / 1.5).unwrap();
        assert!((along - ray((1.0f64 / 1.5).asin(), 0.0)).length() < ROUNDING, "{along}");
        assert_eq!(fresnel(0.0, 1.0, 1.5), 1.0);
        assert_eq!(fresnel(0.0, 1.5, 1.0), 1.0);
        assert_eq!(fresnel(0.0, 1.3, 1.3), 0.0);
        assert!(refract(DVec3::ZERO, DVec3::Y, 0.7).unwrap().is_finite());
        assert!(refract(DVec3::X, DVec3::ZERO, 0.7).unwrap().is_finite());
        assert_eq!(reflect(DVec3::ZERO, DVec3::Y), DVec3::ZERO);
    }

    /// The other form of the Fresnel equations, by angles: sin² and tan² of the difference over those of the sum.
    fn fresnel_by_angles(theta: f64, from: f64, to: f64) -> f64 {
        let t = (theta.sin() * from / to).asin();
        let (less, more) = (theta - t, theta + t);
        0.5 * ((less.sin() / more.sin()).powi(2) + (less.tan() / more.tan()).powi(2))
    }

    #[test]
    fn fresnel_agrees_with_the_form_by_angles() {
        for (from, to) in INDICES {
            for theta in angles().skip(1).filter(|t| t.sin() * from / to < 0.999) {
                let (ours, theirs) = (fresnel(theta.cos(), from, to), fresnel_by_angles(theta, from, to));
                assert!((ours - theirs).abs() < BY_ANGLES, "{from} {to} {theta}: {ours} against {theirs}");
            }
        }
    }

    #[test]
    fn fresnel_at_normal_incidence_and_at_brewsters_angle() {
        for (from, to) in INDICES {
            let normal = ((from - to) / (from + to)).powi(2);
            assert!((fresnel(1.0, from, to) - normal).abs() < ROUNDING);
            // At tanθ = n_to/n_from one polarisation is not reflected; the other is ((n²−1)/(n²+1))².
            let n2 = (to / from).powi(2);
            let brewster = 0.5 * ((n2 - 1.0) / (n2 + 1.0)).powi(2);
            let ours = fresnel((to / from).atan().cos(), from, to);
            assert!((ours - brewster).abs() < ROUNDING, "{from} {to}: {ours} against {brewster}");
        }
        assert!((fresnel(1.0, 1.0, 1.5) - 0.04).abs() < ROUNDING);
    }

    #[test]
    fn fresnel_is_the_same_from_both_sides() {
        for theta in angles() {
            let cos_t = (1.0 - (theta.sin() / 1.5).powi(2)).sqrt();
            let (out, back) = (fresnel(theta.cos(), 1.0, 1.5), fresnel(cos_t, 1.5, 1.0));
            // Near grazing, back's cosine is a root of a rounded difference (see CRITICAL), and R falls by ~5 per unit.
            assert!((out - back).abs() < 10.0 * CRITICAL, "{theta}: {out} against {back}");
        }
    }

    #[test]
    fn reflection_keeps_the_tangent_and_turns_the_normal() {
        let d = DVec3::new(0.6, -0.64, 0.48);
        assert!((reflect(d, DVec3::Y) - DVec3::new(0.6, 0.64, 0.48)).length() < ROUNDING);
        assert!((reflect(d, DVec3::NEG_Y) - DVec3::new(0.6, 0.64, 0.48)).length() < ROUNDING);
        let tilted = DVec3::new(1.0, 2.0, -0.5).normalize();
        assert!((reflect(reflect(d, tilted), tilted) - d).length() < ROUNDING);
    }

    #[test]
    fn transmittance_by_hand() {
        assert!((transmittance(std::f64::consts::LN_2, 3.0) - 0.125).abs() < ROUNDING);
        assert!((transmittance(2.0, 0.3) * transmittance(2.0, 0.7) - transmittance(2.0, 1.0)).abs() < ROUNDING);
        assert_eq!(transmittance(0.0, f64::INFINITY), 1.0);
        assert_eq!(transmittance(1.0, f64::INFINITY), 0.0);
        assert_eq!(transmittance(5.0, 0.0), 1.0);
    }

    /// Roundings of some twenty operations.
    const METAL: f64 = 1e-12;
    /// At the critical angle the cosine of refraction is the root of a rounding: measured 1e-7.
    const TOTAL: f64 = 2e-7;

    #[test]
    fn a_metal_without_extinction_is_a_dielectric() {
        for eta in [0.6, 1.0, 1.5, 2.4] {
            for step in 0..=100 {
                let c = f64::from(step) / 100.0;
                let (metal, glass) = (fresnel_conductor(c, eta, 0.0), fresnel(c, 1.0, eta));
                let critical = (eta * eta - 1.0 + c * c).abs() < METAL;
                let allowed = if critical { TOTAL } else { METAL };
                assert!((metal - glass).abs() < allowed, "η {eta}, cosine {c}: {metal} for {glass}");
            }
        }
    }

    /// Straight on: ((η − 1)² + k²)/((η + 1)² + k²). Silver, gold and aluminium at 0.55 µm.
    #[test]
    fn metals_straight_on_and_grazing() {
        for (eta, k) in [(0.06f64, 3.6f64), (0.43, 2.45), (0.96, 6.7), (1.0, 1.0), (3.0, 0.1)] {
            let exact = ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
            assert!((fresnel_conductor(1.0, eta, k) - exact).abs() < METAL);
            assert_eq!(fresnel_conductor(0.0, eta, k), 1.0);
            let all = (0..=1000).map(|i| fresnel_conductor(f64::from(i) / 1000.0, eta, k));
            assert!(all.into_iter().all(|r| (0.0..=1.0).contains(&r)));
        }
    }
}
