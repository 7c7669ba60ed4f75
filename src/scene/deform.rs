//! Deformers of meshes: twist and bend (Barr 1984, "Global and local deformations of solid primitives"), and a wave that
//! travels. A normal follows by the cofactors of the map's derivative (his tangent and normal rules), exactly.
use std::f64::consts::TAU;

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::{Mesh, track::Track};

/// Angle below which the quotients of [`Bend`] are their limits: the next term is below rounding.
const SMALL: f64 = 1e-8;

/// In the order in which they are applied: about the object's place, before it is scaled, turned and carried.
#[derive(Clone, Debug, Default)]
pub struct Deformers {
    pub twist: Option<Twist>,
    pub bend: Option<Bend>,
    pub wave: Option<Wave>,
}

/// Each slice across the axis is turned about it.
#[derive(Clone, Debug)]
pub struct Twist {
    /// Unit.
    pub axis: DVec3,
    /// rad/m
    pub angle: Track<f64>,
}

/// The line along becomes a circle's arc, which curves towards.
#[derive(Clone, Debug)]
pub struct Bend {
    /// Unit.
    pub along: DVec3,
    /// Unit, across it.
    pub towards: DVec3,
    /// rad/m, the curvature.
    pub angle: Track<f64>,
}

/// A sine that runs along and moves points towards.
#[derive(Clone, Debug)]
pub struct Wave {
    /// Unit.
    pub along: DVec3,
    /// Unit.
    pub towards: DVec3,
    /// m
    pub amplitude: Track<f64>,
    /// m
    pub wavelength: f64,
    /// m/s
    pub speed: f64,
}

/// A point's image, and the derivative there.
type Map = (DVec3, DMat3);

impl Deformers {
    pub fn is_empty(&self) -> bool {
        self.twist.is_none() && self.bend.is_none() && self.wave.is_none()
    }

    pub fn spans(&self) -> Vec<[f64; 2]> {
        let tracks = [
            self.twist.as_ref().map(|t| t.angle.span()),
            self.bend.as_ref().map(|b| b.angle.span()),
            self.wave.as_ref().map(|w| w.amplitude.span()),
        ];
        tracks.into_iter().flatten().collect()
    }

    /// The mesh bent, in its own units still, at a time; `to_world` and `place` are those of the mesh at rest.
    pub fn apply(&self, mesh: &Mesh, to_world: &DAffine3, place: DVec3, time: f64) -> Mesh {
        let (out, aside) = (to_world.matrix3, to_world.translation - place);
        let back = out.inverse();
        let moved = |(position, normal): (&glam::Vec3, &glam::Vec3)| {
            let (p, derivative) = self.map(out * position.as_dvec3() + aside, time);
            // `out` turns and scales evenly, so that its transpose takes a normal back.
            let n = out.transpose() * (cofactors(derivative) * (out * normal.as_dvec3()));
            ((back * (p - aside)).as_vec3(), n.try_normalize().map_or(*normal, |n| n.as_vec3()))
        };
        let (positions, normals) = mesh.positions.iter().zip(&mesh.normals).map(moved).unzip();
        Mesh { file: mesh.file.clone(), positions, normals, triangles: mesh.triangles.clone(), sheet: mesh.sheet }
    }

    fn map(&self, p: DVec3, time: f64) -> Map {
        let mut all = (p, DMat3::IDENTITY);
        let mut then = |map: &dyn Fn(DVec3) -> Map| {
            let (p, derivative) = map(all.0);
            all = (p, derivative * all.1);
        };
        self.twist.iter().for_each(|twist| then(&|p| twist.map(p, time)));
        self.bend.iter().for_each(|bend| then(&|p| bend.map(p, time)));
        self.wave.iter().for_each(|wave| then(&|p| wave.map(p, time)));
        all
    }
}

impl Twist {
    fn map(&self, p: DVec3, time: f64) -> Map {
        let (rate, height) = (self.angle.at(time), p.dot(self.axis));
        let turn = DMat3::from_quat(DQuat::from_axis_angle(self.axis, rate * height));
        let turned = turn * p;
        (turned, turn + outer(self.axis.cross(turned) * rate, self.axis))
    }
}

impl Bend {
    fn map(&self, p: DVec3, time: f64) -> Map {
        let rate = self.angle.at(time);
        let (h, w) = (p.dot(self.along), p.dot(self.towards));
        let (sin, cos) = (rate * h).sin_cos();
        // sin φ/φ and (1 − cos φ)/φ
        let (chord, rise) =
            if (rate * h).abs() < SMALL { (1.0, 0.5 * rate * h) } else { (sin / (rate * h), (1.0 - cos) / (rate * h)) };
        let aside = p - self.along * h - self.towards * w;
        let to = aside + self.along * (h * chord - w * sin) + self.towards * (h * rise + w * cos);
        let stretch = 1.0 - rate * w;
        let by_h = (self.along * cos + self.towards * sin) * stretch;
        let by_w = self.towards * cos - self.along * sin;
        let across = DMat3::IDENTITY - outer(self.along, self.along) - outer(self.towards, self.towards);
        (to, across + outer(by_h, self.along) + outer(by_w, self.towards))
    }
}

impl Wave {
    fn map(&self, p: DVec3, time: f64) -> Map {
        let (amplitude, number) = (self.amplitude.at(time), TAU / self.wavelength);
        // Whole waves are left out before the sine, which keeps late times exact.
        let gone = (self.speed * time / self.wavelength).fract();
        let (sin, cos) = (number * p.dot(self.along) - TAU * gone).sin_cos();
        let slope = self.towards * (amplitude * number * cos);
        (p + self.towards * (amplitude * sin), DMat3::IDENTITY + outer(slope, self.along))
    }
}

/// a bᵀ
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// What takes areas with their normals along: det(m) times the inverse's transpose, without a division.
fn cofactors(m: DMat3) -> DMat3 {
    DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis))
}
