//! Concave mirrors under parallel light, class `reflect-1`: the half cylinder, and the paraboloid.

use super::OutsideDomain;
use glam::DVec2;
use std::f64::consts::PI;

/// The caustic of a half-cylinder mirror of `radius` (m) under light along +y: the point that the ray reflected at
/// (R sinα, R cosα) touches, m.
///
/// Source: the envelope of the rays reflected once, half a nephroid (Huygens 1690): x = R sin³α,
/// y = R/4·(3 cosα − cos 3α), with its cusp at (0, R/2). Domain: |α| < π/2; beyond 60° the reflected ray meets the
/// mirror again, after it has touched the curve. Singular: the irradiance is infinite on the curve, as an inverse
/// square root from inside.
pub fn nephroid(radius: f64, alpha: f64) -> DVec2 {
    let y = 0.25 * radius * (3.0 * alpha.cos() - (3.0 * alpha).cos());
    DVec2::new(radius * alpha.sin().powi(3), y)
}

/// A paraboloid mirror z = r²/4f with light along −z, and a receiver across the axis: everything meets at (0, 0, f).
///
/// Source: the ray from (r, r²/4f) through the focus crosses height h at ρ = r |f − h| / (f − r²/4f). Domain: a rim
/// not higher than the focus, r ≤ 2f; a receiver between the rim and the focus, or the focus itself. What the
/// receiver shadows on the light's way in is not taken off. Singular: at h = f all flux is in one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraboloid {
    focus: f64,
    rim: f64,
    height: f64,
}

impl Paraboloid {
    /// Focal length, radius of the rim and height of the receiver, m.
    ///
    /// # Errors
    /// [`OutsideDomain`] for values that are not finite or not positive, a rim above the focus, or a receiver not
    /// between rim and focus.
    pub fn new(focus: f64, rim: f64, height: f64) -> Result<Self, OutsideDomain> {
        let positive = [focus, rim, height].iter().all(|v| v.is_finite() && *v > 0.0);
        let rules = [
            (positive, "a value is not positive and finite"),
            (rim <= 2.0 * focus, "the rim lies above the focus"),
            (height >= rim * rim / (4.0 * focus) && height <= focus, "the receiver is not between rim and focus"),
        ];
        let broken = rules.iter().find(|(holds, _)| !holds);
        broken.map_or(Ok(Self { focus, rim, height }), |&(_, why)| Err(OutsideDomain(why)))
    }

    /// Flux within `radius` metres of the axis, for E⊥ = 1 W/m² and a perfect mirror, W.
    pub fn encircled(&self, radius: f64) -> f64 {
        let short = self.focus - self.height;
        let root = short.hypot(radius);
        // The positive root of ρ r²/4f + (f − h) r − ρ f = 0, written so that nothing cancels.
        let entered = if radius > 0.0 { 2.0 * radius * self.focus / (short + root) } else { 0.0 };
        PI * entered.min(self.rim).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::reflect;
    use glam::DVec3;

    /// Central differences of step 1e-4: their square, and the rounding of a nearly parallel crossing.
    const DIFFERENCES: f64 = 1e-7;
    /// 1000 rings: the one that straddles the radius is counted whole or not at all.
    const RINGS: f64 = 3e-3;

    /// Where two neighbouring reflected rays cross.
    fn crossing(radius: f64, alpha: f64) -> DVec2 {
        let ray = |alpha: f64| {
            let p = radius * DVec3::new(alpha.sin(), alpha.cos(), 0.0);
            (p.truncate(), reflect(DVec3::Y, -p / radius).truncate())
        };
        let ((p, d), (q, e)) = (ray(alpha - 1e-4), ray(alpha + 1e-4));
        p + d * ((q - p).perp_dot(e) / d.perp_dot(e))
    }

    #[test]
    fn the_nephroid_is_where_neighbouring_rays_cross() {
        for degrees in -80..=80 {
            let alpha = f64::from(degrees).to_radians();
            let (ours, crossed) = (nephroid(2.0, alpha), crossing(2.0, alpha));
            assert!((ours - crossed).length() < DIFFERENCES, "{degrees}°: {ours} against {crossed}");
        }
        assert!((nephroid(2.0, 0.0) - DVec2::Y).length() < 1e-15, "the cusp is at R/2");
    }

    #[test]
    fn the_paraboloid_agrees_with_rays_reflected_as_vectors() {
        let (focus, rim) = (0.5, 0.8);
        for height in [0.35, 0.45, 0.5] {
            let mirror = Paraboloid::new(focus, rim, height).unwrap();
            for radius in [0.01, 0.05, 0.1, 0.3, 1.0] {
                let rings = 1000;
                let ring = |k: i32| rim * (f64::from(k) + 0.5) / f64::from(rings);
                let lands = |r: f64| {
                    let d = reflect(DVec3::NEG_Z, DVec3::new(-r / (2.0 * focus), 0.0, 1.0).normalize());
                    (r + d.x / d.z * (height - r * r / (4.0 * focus))).abs()
                };
                let inside = (0..rings).map(ring).filter(|r| lands(*r) <= radius);
                let counted: f64 = inside.map(|r| 2.0 * PI * r * rim / f64::from(rings)).sum();
                let ours = mirror.encircled(radius);
                assert!((ours - counted).abs() < RINGS * PI * rim * rim, "{height} {radius}: {ours} against {counted}");
            }
        }
        assert!(Paraboloid::new(0.5, 0.8, 0.5).unwrap().encircled(1e-300) > 2.0, "everything is at the focus");
    }

    #[test]
    fn outside_its_domain_it_is_refused() {
        for [f, rim, h] in [[0.0, 1.0, 1.0], [0.5, 1.1, 0.5], [0.5, 0.8, 0.2], [0.5, 0.8, 0.6], [f64::NAN, 0.8, 0.4]] {
            assert!(Paraboloid::new(f, rim, h).is_err());
        }
    }
}
