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
        let (triangles, coordinates) = (mesh.triangles.clone(), mesh.coordinates.clone());
        Mesh { file: mesh.file.clone(), positions, normals, triangles, coordinates, sheet: mesh.sheet.clone() }
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// A few roundings of numbers of order one.
    const ROUNDING: f64 = 1e-14;
    /// Step of a central difference, and its error: the step squared, and rounding over it.
    const STEP: f64 = 1e-5;
    const DIFFERENCE: f64 = 1e-9;

    fn held(value: f64) -> Track<f64> {
        Track::new(vec![(0.0, value)]).unwrap()
    }

    fn twist(rate: f64) -> Twist {
        Twist { axis: DVec3::Y, angle: held(rate) }
    }

    fn bend(rate: f64) -> Bend {
        Bend { along: DVec3::X, towards: DVec3::Y, angle: held(rate) }
    }

    fn wave() -> Wave {
        Wave { along: DVec3::X, towards: DVec3::Y, amplitude: held(0.3), wavelength: 2.0, speed: 0.5 }
    }

    #[test]
    fn a_twist_turns_each_slice_by_its_height() {
        let quarter = std::f64::consts::FRAC_PI_2;
        for (p, expected) in [
            (DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0)),
            (DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, -1.0)),
            (DVec3::new(0.0, -1.0, 2.0), DVec3::new(-2.0, -1.0, 0.0)),
        ] {
            let (to, derivative) = twist(quarter).map(p, 0.0);
            assert!((to - expected).length() < ROUNDING, "{p}: {to}");
            assert!((derivative.determinant() - 1.0).abs() < ROUNDING, "a twist keeps volumes");
        }
    }

    #[test]
    fn a_bent_line_is_an_arc_of_the_same_length_about_one_centre() {
        let rate = 0.8;
        let centre = DVec3::Y / rate;
        for (h, w) in [(0.0, 0.0), (1.0, 0.0), (-2.5, 0.4), (3.0, -0.7)] {
            let to = bend(rate).map(DVec3::new(h, w, 0.3), 0.0).0;
            let away = (to - centre).with_z(0.0);
            assert!((away.length() - (1.0 / rate - w)).abs() < ROUNDING && to.z == 0.3, "{to}");
            assert!((away.x.atan2(-away.y) - rate * h).abs() < ROUNDING, "its angle is its length over the radius");
        }
        // Without curvature nothing moves, and next to it hardly anything.
        let p = DVec3::new(2.0, 0.5, -1.0);
        assert_eq!(bend(0.0).map(p, 0.0), (p, DMat3::IDENTITY));
        assert!((bend(1e-12).map(p, 0.0).0 - p).length() < 1e-11);
    }

    #[test]
    fn a_wave_travels_by_its_speed_and_late_times_are_exact() {
        let at = |x: f64, time: f64| wave().map(DVec3::X * x, time).0.y;
        assert!((at(0.5, 0.0) - 0.3).abs() < ROUNDING && at(0.0, 0.0).abs() < ROUNDING);
        assert!((at(0.5 + 0.5 * 1.7, 1.7) - 0.3).abs() < ROUNDING, "its crest has gone half a metre a second");
        assert!((at(0.2, 1e6 + 0.25) - at(0.2, 0.25)).abs() < ROUNDING, "a quarter of a million periods later");
    }

    #[test]
    fn derivatives_are_those_of_the_maps() {
        let all = Deformers { twist: Some(twist(0.7)), bend: Some(bend(-0.6)), wave: Some(wave()) };
        let each = [
            Deformers { twist: all.twist.clone(), ..Default::default() },
            Deformers { bend: all.bend.clone(), ..Default::default() },
            Deformers { wave: all.wave.clone(), ..Default::default() },
            all,
        ];
        for deformers in each {
            for p in [DVec3::new(0.3, 0.8, -0.4), DVec3::new(-1.2, 0.1, 0.9), DVec3::ZERO] {
                let derivative = deformers.map(p, 0.3).1;
                for axis in DVec3::AXES {
                    let [high, low] = [1.0, -1.0].map(|side| deformers.map(p + axis * STEP * side, 0.3).0);
                    let error = (derivative * axis - (high - low) / (2.0 * STEP)).length();
                    assert!(error < DIFFERENCE, "{deformers:?} at {p}: {error}");
                }
            }
        }
    }

    /// A flat square of small triangles, bent: the normals given by the map are those of the triangles.
    #[test]
    fn normals_follow_the_surface() {
        const SIDE: u32 = 40;
        let at =
            |i: u32, j: u32| Vec3::new(i as f32, 0.0, -(j as f32)) * (2.0 / SIDE as f32) - Vec3::new(1.0, 0.0, -1.0);
        let positions: Vec<Vec3> = (0..=SIDE).flat_map(|i| (0..=SIDE).map(move |j| at(i, j))).collect();
        let index = |i: u32, j: u32| i * (SIDE + 1) + j;
        let cell = |i: u32, j: u32| {
            [[index(i, j), index(i + 1, j), index(i + 1, j + 1)], [index(i, j), index(i + 1, j + 1), index(i, j + 1)]]
        };
        let triangles = (0..SIDE).flat_map(|i| (0..SIDE).flat_map(move |j| cell(i, j))).collect();
        let mesh = Mesh {
            file: String::new(),
            normals: vec![Vec3::Y; positions.len()],
            positions,
            triangles,
            coordinates: vec![],
            sheet: None,
        };
        let map = DAffine3::from_scale_rotation_translation(
            DVec3::splat(0.5),
            DQuat::from_rotation_z(0.4),
            DVec3::new(3.0, 1.0, 0.0),
        );
        let deformers = Deformers { twist: Some(twist(1.5)), bend: Some(bend(1.0)), wave: Some(wave()) };
        let bent = deformers.apply(&mesh, &map, map.translation, 0.7);
        let exact = super::super::mesh::vertex_normals(&bent.positions, &bent.triangles);
        let inner = (1..SIDE).flat_map(|i| (1..SIDE).map(move |j| index(i, j) as usize));
        let worst = inner.map(|k| bent.normals[k].angle_between(exact[k])).fold(0.0, f32::max);
        // Triangles of a twentieth of a metre see the curvature to second order.
        assert!(worst < 0.01, "{worst} rad");
        assert!(bent.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
    }
}
