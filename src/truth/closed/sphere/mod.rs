//! The caustic of a glass sphere on a floor across the light's axis: an axisymmetric ray map, integrated exactly.
//!
//! A ray that meets the sphere under the angle θ refracts in and out in the plane of the axis (class `transmit-2`) and
//! lands at a signed distance ρ(θ) from the axis, negative once it has crossed it. The flux inside a circle of radius r
//! is the integral of flux × transmission over all θ with |ρ(θ)| ≤ r. Folds of the caustic are extrema of ρ, so ρ is
//! cut there into monotone branches; on each the θ of ±r is found by bisection, and nothing is singular, at folds or
//! on the axis. Rays that leave sideways or upwards (bent by 90° or more) never meet the floor and belong to no branch.

mod ray_map;

#[cfg(test)]
mod tests;

use super::quadrature::{bisect, panel};
use ray_map::RayMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Panels of [0, π/2] for quadrature and for the search of folds: with five nodes each, the flux is exact to rounding.
const PANELS: u32 = 1024;

/// A glass sphere in air, above a floor perpendicular to the light's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlassSphere {
    /// Radius in metres.
    pub radius: f64,
    /// Refractive index, at least 1.
    pub ior: f64,
    /// Absorption inside the glass, 1/m.
    pub absorption: f64,
    /// Distance of the floor below the centre in metres, at least the radius.
    pub floor: f64,
}

/// The light, on the sphere's axis above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Illumination {
    /// Parallel light of irradiance E⊥, W/m².
    Parallel {
        /// Of a plane that faces the light, W/m².
        irradiance: f64,
    },
    /// A point light of intensity I (W/sr) at a distance from the centre (m, more than the radius).
    Point {
        /// From the sphere's centre, m.
        distance: f64,
        /// W/sr.
        intensity: f64,
    },
}

/// The arrangement has no such closed form; the message names the value and its range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("no closed form: {0}")]
pub struct OutsideDomain(pub(super) &'static str);

/// A range of θ over which the landing distance ρ is monotone and finite inside.
#[derive(Clone, Copy, Debug)]
struct Branch {
    start: f64,
    end: f64,
    rising: bool,
}

/// Flux of the class `transmit-2` on the floor below a glass sphere, in watts.
///
/// # Examples
/// ```
/// use nephroid::truth::closed::{GlassSphere, Illumination, SphereCaustic};
/// let glass = GlassSphere { radius: 1.0, ior: 1.5, absorption: 0.0, floor: 1.5 };
/// let caustic = SphereCaustic::new(glass, Illumination::Parallel { irradiance: 1.0 }).unwrap();
/// assert!(caustic.encircled(0.5) < caustic.total() && caustic.total() < caustic.emitted());
/// ```
#[derive(Clone, Debug)]
pub struct SphereCaustic {
    glass: GlassSphere,
    light: Illumination,
    map: RayMap,
    branches: Vec<Branch>,
    /// Transmitted flux from θ = 0 to the end of each panel; one entry more than panels.
    cumulative: Vec<f64>,
}

impl SphereCaustic {
    /// Traces the ray map and integrates its flux once; the queries after it are cheap.
    ///
    /// # Errors
    /// [`OutsideDomain`] if a value is out of the range its field names, or not finite.
    pub fn new(glass: GlassSphere, light: Illumination) -> Result<Self, OutsideDomain> {
        check(glass, light)?;
        let distance = match light {
            Illumination::Parallel { .. } => f64::INFINITY,
            Illumination::Point { distance, .. } => distance / glass.radius,
        };
        let map = RayMap { ior: glass.ior, distance, floor: glass.floor / glass.radius };
        let mut caustic = Self { glass, light, map, branches: branches(&map), cumulative: vec![0.0] };
        for k in 0..PANELS {
            let flux = panel(|t| caustic.transmitted_density(t), node(k), node(k + 1));
            caustic.cumulative.push(caustic.cumulative[k as usize] + flux);
        }
        Ok(caustic)
    }

    /// Flux that meets the sphere: E⊥πR², or I times the solid angle of the sphere's silhouette.
    pub fn emitted(&self) -> f64 {
        match self.light {
            Illumination::Parallel { irradiance } => irradiance * PI * self.glass.radius.powi(2),
            Illumination::Point { distance, intensity } => {
                // 1 − cos, written without the cancellation that a far light brings.
                let sin2 = (self.glass.radius / distance).powi(2);
                intensity * TAU * sin2 / (1.0 + (1.0 - sin2).sqrt())
            }
        }
    }

    /// Flux of the class that lands anywhere on the floor's plane.
    pub fn total(&self) -> f64 {
        self.branches.iter().map(|b| self.transmitted(b.end) - self.transmitted(b.start)).sum()
    }

    /// Flux that passes both surfaces and leaves sideways or upwards: it never meets the floor's plane.
    pub fn missed(&self) -> f64 {
        self.transmitted(FRAC_PI_2) - self.total()
    }

    /// Flux that lands within `radius` metres of the axis.
    pub fn encircled(&self, radius: f64) -> f64 {
        let r = radius.max(0.0) / self.glass.radius;
        let at = |b: &Branch, rho: f64| self.transmitted(self.solve(b, rho));
        self.branches.iter().map(|b| (at(b, r) - at(b, -r)).abs()).sum()
    }

    /// [`Self::encircled`] for every radius; differences of neighbours are the flux of annuli.
    pub fn table(&self, radii: &[f64]) -> Vec<f64> {
        radii.iter().map(|&r| self.encircled(r)).collect()
    }

    /// The θ of a branch at which ρ passes `rho`; the nearer end of the branch where it never does.
    fn solve(&self, branch: &Branch, rho: f64) -> f64 {
        bisect(|t| (self.map.landing(t) < rho) == branch.rising, branch.start, branch.end)
    }

    /// Flux of the class that enters between the axis and θ.
    fn transmitted(&self, theta: f64) -> f64 {
        let k = ((theta / FRAC_PI_2 * f64::from(PANELS)) as u32).min(PANELS - 1);
        self.cumulative[k as usize] + panel(|t| self.transmitted_density(t), node(k), theta)
    }

    /// Transmitted flux per radian of θ.
    fn transmitted_density(&self, theta: f64) -> f64 {
        let emitted = match self.light {
            Illumination::Parallel { irradiance } => irradiance * PI * self.glass.radius.powi(2) * (2.0 * theta).sin(),
            Illumination::Point { intensity, .. } => intensity * TAU * self.map.solid_angle_density(theta),
        };
        emitted * self.map.throughput(theta, self.glass.absorption * self.glass.radius)
    }
}

fn check(glass: GlassSphere, light: Illumination) -> Result<(), OutsideDomain> {
    let GlassSphere { radius, ior, absorption, floor } = glass;
    let (distance, strength) = match light {
        Illumination::Parallel { irradiance } => (f64::MAX, irradiance),
        Illumination::Point { distance, intensity } => (distance, intensity),
    };
    let finite = [radius, ior, absorption, floor, distance, strength].iter().all(|v| v.is_finite());
    let rules = [
        (finite, "a value is not finite"),
        (radius > 0.0, "the radius is not positive"),
        (ior >= 1.0, "the refractive index is below 1"),
        (absorption >= 0.0, "the absorption is negative"),
        (floor >= radius, "the floor cuts the sphere"),
        (distance > radius, "the light is inside the sphere"),
        (strength >= 0.0, "the light is negative"),
    ];
    rules.iter().find(|(holds, _)| !holds).map_or(Ok(()), |&(_, why)| Err(OutsideDomain(why)))
}

/// The k-th of the panels' borders over [0, π/2].
fn node(k: u32) -> f64 {
    FRAC_PI_2 * f64::from(k) / f64::from(PANELS)
}

/// Cuts [0, π/2] where the landing distance turns round (folds) and where rays stop meeting the floor.
fn branches(map: &RayMap) -> Vec<Branch> {
    let state = |theta: f64| (map.lands(theta), map.rises(theta));
    let mut cuts = vec![0.0];
    for k in 0..PANELS {
        let (a, b) = (node(k), node(k + 1));
        if map.lands(a) != map.lands(b) {
            cuts.push(bisect(|t| map.lands(t) == map.lands(a), a, b));
        }
        if map.rises(a) != map.rises(b) {
            cuts.push(bisect(|t| map.rises(t) == map.rises(a), a, b));
        }
    }
    cuts.push(FRAC_PI_2);
    cuts.sort_by(f64::total_cmp);
    let pieces = cuts.windows(2).map(|w| (w[0], w[1], state(0.5 * (w[0] + w[1]))));
    pieces.filter(|(_, _, (lands, _))| *lands).map(|(start, end, (_, rising))| Branch { start, end, rising }).collect()
}
