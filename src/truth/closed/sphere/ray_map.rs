//! Where a ray in the plane of the axis leaves a sphere of radius 1, and where it lands.

use crate::optics::{fresnel, transmittance};

/// The ray map of a unit glass sphere. Every ray is named by θ, the angle of incidence, in [0, π/2].
///
/// With α the ray's angle to the axis, sinθ = s sinα (0 for parallel light), and sinθ_t = sinθ / n: it leaves at the
/// polar angle e = 2θ_t − θ + α from the lower pole, in a direction β = α − 2(θ − θ_t) from the axis, and lands at
/// ρ = sin e + (z − cos e) tanβ. Angles and lengths are signed: negative beyond the axis.
#[derive(Clone, Copy, Debug)]
pub struct RayMap {
    /// Refractive index n ≥ 1.
    pub ior: f64,
    /// Distance s > 1 of the light from the centre in radii; infinite for parallel light.
    pub distance: f64,
    /// Distance z ≥ 1 of the floor from the centre, in radii.
    pub floor: f64,
}

/// A ray after the sphere, and the derivatives of its angles by θ.
struct Exit {
    polar: f64,
    direction: f64,
    polar_slope: f64,
    direction_slope: f64,
}

impl RayMap {
    /// θ_t inside the glass.
    fn refracted(&self, theta: f64) -> f64 {
        (theta.sin() / self.ior).asin()
    }

    /// α, and its derivative by θ.
    fn emission(&self, theta: f64) -> (f64, f64) {
        let alpha = (theta.sin() / self.distance).asin();
        (alpha, theta.cos() / (self.distance * alpha.cos()))
    }

    fn exit(&self, theta: f64) -> Exit {
        let inside = self.refracted(theta);
        let (alpha, alpha_slope) = self.emission(theta);
        // 0/0 where n = 1 at grazing incidence: the ray goes straight on, its slope is 1.
        let inside_slope = if self.ior == 1.0 { 1.0 } else { theta.cos() / (self.ior * inside.cos()) };
        Exit {
            polar: 2.0 * inside - theta + alpha,
            direction: alpha - 2.0 * (theta - inside),
            polar_slope: 2.0 * inside_slope - 1.0 + alpha_slope,
            direction_slope: alpha_slope - 2.0 * (1.0 - inside_slope),
        }
    }

    /// Whether the ray goes down towards the floor; the others leave sideways or upwards.
    pub fn lands(&self, theta: f64) -> bool {
        self.exit(theta).direction.cos() > 0.0
    }

    /// Signed distance ρ from the axis at which a ray that [`Self::lands`] meets the floor, in radii.
    pub fn landing(&self, theta: f64) -> f64 {
        let Exit { polar, direction, .. } = self.exit(theta);
        polar.sin() + (self.floor - polar.cos()) * direction.tan()
    }

    /// Whether ρ grows with θ: the sign of dρ/dθ · cos²β, which stays finite where ρ does not.
    pub fn rises(&self, theta: f64) -> bool {
        let e = self.exit(theta);
        let exit_moves = e.polar_slope * e.direction.cos() * (e.polar - e.direction).cos();
        exit_moves + (self.floor - e.polar.cos()) * e.direction_slope > 0.0
    }

    /// Share of the ray's flux left after both surfaces and the chord 2cosθ_t; `absorption` per radius.
    pub fn throughput(&self, theta: f64, absorption: f64) -> f64 {
        // Both surfaces are met under the same pair of angles and reflect alike.
        let passes = 1.0 - fresnel(theta.cos(), 1.0, self.ior);
        passes * passes * transmittance(absorption, 2.0 * self.refracted(theta).cos())
    }

    /// sinα dα/dθ: solid angle per radian of θ and of azimuth.
    pub fn solid_angle_density(&self, theta: f64) -> f64 {
        let (alpha, slope) = self.emission(theta);
        alpha.sin() * slope
    }
}
