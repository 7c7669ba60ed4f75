//! Photons of lights with a size: of each, a point of the light and a place or direction on the way to the specular objects.
//!
//! Where each photon starts differs from one to the next, and so does what it must reach: a box or a ball about everything
//! specular holds it, which needs no look at every corner. What flies beside is lost time and no error.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

use super::{emit::across, walk::Start};
use crate::{
    scene::{Face, LightKind, cap_height},
    truth::trace::{Ray, Space},
};

/// The light without size at a point of the unit square, as if all of the light came from there; equal areas of the square
/// are equal parts of the light. `None` for a light that has no size.
pub fn point(kind: &LightKind, on: DVec2) -> Option<LightKind> {
    match kind {
        LightKind::Sun { direction, irradiance, radius } => {
            let cap = Cap { axis: *direction, height: cap_height(*radius) };
            let irradiance = irradiance.map(|e| e * cap.brighter());
            Some(LightKind::Directional { direction: cap.direction(on), irradiance })
        }
        LightKind::Lamp { face, radiance } => {
            let (sin, cos) = (TAU * on.y).sin_cos();
            let at = if face.round { on.x.sqrt() * DVec2::new(cos, sin) } else { 2.0 * on - 1.0 };
            let position = face.center + at.x * face.u + at.y * face.v;
            let intensity = radiance.map(|l| l * face.area());
            Some(LightKind::Patch { position, normal: face.normal(), intensity })
        }
        _ => None,
    }
}

/// Directions of a cone, evenly: unit axis, 1 − cosine of its half angle.
#[derive(Clone, Copy, Debug)]
struct Cap {
    axis: DVec3,
    height: f64,
}

impl Cap {
    /// That of a point of the unit square.
    fn direction(&self, at: DVec2) -> DVec3 {
        let ([x, y], below) = (across(self.axis), self.height * at.x);
        let aside = (below * (2.0 - below)).max(0.0).sqrt();
        let (sin, cos) = (TAU * at.y).sin_cos();
        ((1.0 - below) * self.axis + aside * (cos * x + sin * y)).normalize()
    }

    /// A disc of even radiance L gives a plane that faces its middle L π sin²α, and L 2π (1 − cosα) to one that turned with
    /// each of its directions: by this factor more.
    fn brighter(&self) -> f64 {
        1.0 / (1.0 - 0.5 * self.height)
    }
}

/// Parallel light of many directions, each through a box as it is seen from there.
#[derive(Clone, Debug)]
pub struct Disc {
    cap: Cap,
    /// W/m² on a plane that faces its middle.
    irradiance: DVec3,
    /// Corners of the box, m.
    low: DVec3,
    high: DVec3,
    /// Behind which everything lies, as seen along any direction: centre and radius, m.
    ball: (DVec3, f64),
}

impl Disc {
    /// About a unit direction, of half an angular diameter (rad), through a box.
    pub fn new(axis: DVec3, radius: f64, irradiance: [f64; 3], [low, high]: [DVec3; 2], space: &Space) -> Self {
        let cap = Cap { axis, height: cap_height(radius) };
        Self { cap, irradiance: DVec3::from(irradiance), low, high, ball: space.ball() }
    }

    /// Areas of the box's faces across x, y and z, m².
    fn faces(&self) -> DVec3 {
        let size = self.high - self.low;
        DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y)
    }

    /// W per band through all three faces, were they to face the light: what [`Self::start`] is given a share of.
    pub fn flux(&self) -> DVec3 {
        self.irradiance * self.faces().element_sum()
    }

    /// The photon of a point of the unit square from a point of the light.
    pub fn start(&self, at: DVec2, on: DVec2, flux: DVec3) -> Option<Start> {
        let d = self.cap.direction(on);
        let seen = self.faces() * d.abs();
        let whole = seen.element_sum();
        if whole <= 0.0 {
            return None; // all is flat, and seen edge-on
        }
        // One of the three faces that the light meets, by the area that it sees of each.
        let place = at.x * whole;
        let (axis, rest) = match place {
            p if p < seen.x => (0, p / seen.x),
            p if p < seen.x + seen.y => (1, (p - seen.x) / seen.y),
            p => (2, if seen.z > 0.0 { ((p - seen.x - seen.y) / seen.z).min(1.0) } else { 0.0 }),
        };
        let mut share = DVec3::ZERO;
        share[axis] = if d[axis] > 0.0 { 0.0 } else { 1.0 };
        share[(axis + 1) % 3] = rest;
        share[(axis + 2) % 3] = at.y;
        let through = self.low + share * (self.high - self.low);
        let (centre, radius) = self.ball;
        let o = through - d * ((through - centre).dot(d) + radius * (1.0 + super::emit::MARGIN));
        let flux = flux * (self.cap.brighter() * whole / self.faces().element_sum());
        Some(Start { ray: Ray { o, d, left: None }, flux, media: None, band: 0 })
    }
}

/// A surface that shines on a ball.
#[derive(Clone, Debug)]
pub struct Shining {
    face: Face,
    /// W/m²/sr
    radiance: DVec3,
    /// Centre and radius, m.
    ball: (DVec3, f64),
}

impl Shining {
    /// On what lies in a box; of another light `None`.
    pub fn new(kind: &LightKind, [low, high]: [DVec3; 2]) -> Option<Self> {
        let LightKind::Lamp { face, radiance } = kind else { return None };
        let ball = (0.5 * (low + high), 0.5 * (high - low).length());
        Some(Self { face: *face, radiance: DVec3::from(*radiance), ball })
    }

    /// What a point must send light to, so that the ball gets all of it; from within, every direction.
    fn cap(&self, p: DVec3) -> Cap {
        let (centre, radius) = self.ball;
        let (way, distance) = (centre - p, (centre - p).length());
        if distance <= radius {
            return Cap { axis: self.face.normal(), height: 1.0 }; // the half space that it shines into
        }
        let sine = radius / distance;
        // 1 − cosine without cancellation.
        Cap { axis: way / distance, height: sine * sine / (1.0 + (1.0 - sine * sine).max(0.0).sqrt()) }
    }

    /// W per band to the ball, were all of it in the middle, and the ball straight ahead: what [`Self::start`] is given a
    /// share of.
    pub fn flux(&self) -> DVec3 {
        self.radiance * (self.face.area() * TAU * self.cap(self.face.center).height)
    }

    /// The photon of a point of the unit square from a point of the light.
    pub fn start(&self, space: &Space, at: DVec2, on: DVec2, flux: DVec3) -> Option<Start> {
        let lamp = LightKind::Lamp { face: self.face, radiance: self.radiance.to_array() };
        let patch = point(&lamp, on)?;
        let p = patch.position()?;
        let cap = self.cap(p);
        let d = cap.direction(at);
        let share = patch.share(d) * (cap.height / self.cap(self.face.center).height);
        let media = Some(space.media(p));
        (share.x > 0.0).then(|| Start { ray: Ray { o: p, d, left: None }, flux: flux * share, media, band: 0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of sums over this many points a side, second order in it.
    const SIDE: usize = 200;
    const MIDPOINT: f64 = 1e-4;

    fn mean(of: impl Fn(DVec2) -> f64) -> f64 {
        let at = |k: usize| (k as f64 + 0.5) / SIDE as f64;
        let points = (0..SIDE * SIDE).map(|k| DVec2::new(at(k % SIDE), at(k / SIDE)));
        points.map(of).sum::<f64>() / (SIDE * SIDE) as f64
    }

    #[test]
    fn all_directions_of_a_sun_together_are_its_irradiance() {
        for degrees in [1e-6, 0.53, 60.0, 180.0f64] {
            let direction = DVec3::new(0.6, -0.8, 0.0);
            let sun = LightKind::Sun { direction, irradiance: [2.0; 3], radius: 0.5 * degrees.to_radians() };
            let on_a_plane = |normal: DVec3| {
                mean(|on| match point(&sun, on) {
                    Some(LightKind::Directional { direction, irradiance }) => {
                        irradiance[0] * direction.dot(normal).max(0.0)
                    }
                    other => panic!("{other:?}"),
                })
            };
            let facing = on_a_plane(direction);
            assert!((facing - 2.0).abs() < MIDPOINT, "{degrees}: {facing}");
            // A disc that is wholly above a plane lights it by the cosine of its middle.
            if degrees < 60.0 {
                let aslant = on_a_plane(DVec3::NEG_Y);
                assert!((aslant - 1.6).abs() < MIDPOINT, "{degrees}: {aslant}");
            }
        }
    }

    #[test]
    fn a_cap_holds_the_ball() {
        let face = Face { center: DVec3::Y * 4.0, u: DVec3::X, v: DVec3::Z, round: true };
        let shining = Shining { face, radiance: DVec3::ONE, ball: (DVec3::ZERO, 2.0) };
        let cap = shining.cap(DVec3::new(0.0, 4.0, 0.0));
        assert!((cap.height - (1.0 - 3f64.sqrt() / 2.0)).abs() < 1e-15 && cap.axis == DVec3::NEG_Y);
        assert_eq!(shining.cap(DVec3::X).height, 1.0);
    }
}
