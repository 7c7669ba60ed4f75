//! Analytic shapes: a canonical one in its own space, under an affine map, exact everywhere. Float64 twin of
//! `glsl/shared/canonical.glsl`.

use glam::DVec3;

use super::sine;

/// Pieces of the polygon that stands for a whole circle in a [hull](Canonical::hull): 0.1 % wider than the circle.
const PIECES: f64 = 64.0;

/// A shape of one size at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Canonical {
    /// [−1, 1]³, closed.
    Box,
    /// The unit disk in the xy-plane; its normal +z points to the lit side.
    Disk,
    /// x² + y² = 1 for z from 0 to 1, as far as x ≥ `cut`: an open tube, or a part of one.
    Cylinder {
        /// The cosine of half the arc that is there; [`WHOLE`] for all of it.
        cut: f64,
    },
    /// z = x² + y² up to 1, as far as x ≥ `cut`.
    Paraboloid {
        /// [`WHOLE`] for all of it.
        cut: f64,
    },
    /// z = sin(`wave` x + `phase`) over [−1, 1]², an open interface; its normal has z > 0.
    Sine {
        /// Radians.
        wave: f64,
        /// Radians.
        phase: f64,
    },
}

/// A cut that takes nothing off, with room for rounding.
pub const WHOLE: f64 = -2.0;

impl Canonical {
    /// As scene files name it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Disk => "disk",
            Self::Cylinder { .. } => "cylinder",
            Self::Paraboloid { .. } => "paraboloid",
            Self::Sine { .. } => "sine",
        }
    }

    /// Points whose convex hull holds the shape: of what is round, polygons about it.
    pub fn hull(&self) -> Vec<DVec3> {
        let round = |cut: f64, heights: &[f64]| {
            let all = heights.iter().flat_map(|z| segment(cut).into_iter().map(|(x, y)| DVec3::new(x, y, *z)));
            all.collect()
        };
        match *self {
            Self::Box | Self::Sine { .. } => {
                (0..8).map(|k| DVec3::from([0, 1, 2].map(|axis| f64::from(k >> axis & 1) * 2.0 - 1.0))).collect()
            }
            Self::Disk => round(WHOLE, &[0.0]),
            Self::Cylinder { cut } | Self::Paraboloid { cut } => round(cut, &[0.0, 1.0]),
        }
    }

    /// The first meeting after `near` with the ray o + t d, in lengths of d. A ray that starts on the shape starts at 0
    /// exactly, so that no tolerance decides whether it meets it again.
    pub fn meet(&self, o: DVec3, d: DVec3, near: f64, starts_here: bool) -> Option<f64> {
        if let Self::Sine { wave, phase } = *self {
            return sine::meet([wave, phase], o, d, near, starts_here);
        }
        let crossings = match self {
            Self::Box => slabs(o, d),
            Self::Disk => [-o.z / d.z, f64::NAN],
            Self::Cylinder { .. } => tube(o, d),
            Self::Paraboloid { .. } => bowl(o, d),
            Self::Sine { .. } => [f64::NAN; 2],
        };
        let again = match self {
            Self::Box => [f64::NAN, crossings[1]],
            Self::Disk | Self::Sine { .. } => [f64::NAN; 2],
            Self::Cylinder { .. } => [f64::NAN, -2.0 * flat(o, d) / flat(d, d)],
            Self::Paraboloid { .. } => [f64::NAN, (d.z - 2.0 * flat(o, d)) / flat(d, d)],
        };
        let all = if starts_here { again } else { crossings };
        all.into_iter().find(|t| *t > near && t.is_finite() && self.reaches(o + *t * d))
    }

    /// Whether a place on the whole surface is on the part that is there.
    fn reaches(&self, p: DVec3) -> bool {
        match *self {
            Self::Box | Self::Sine { .. } => true,
            Self::Disk => flat(p, p) <= 1.0,
            Self::Cylinder { cut } => p.x >= cut && (0.0..=1.0).contains(&p.z),
            Self::Paraboloid { cut } => p.x >= cut && flat(p, p) <= 1.0,
        }
    }

    /// The place on the shape beside a point that is there but for rounding, and the normal of the outside, of any length.
    pub fn foot(&self, p: DVec3) -> (DVec3, DVec3) {
        match self {
            Self::Box => {
                let axis = (0..3).fold(0, |best, k| if p[k].abs() > p[best].abs() { k } else { best });
                let normal = DVec3::AXES[axis] * p[axis].signum();
                (p.clamp(DVec3::NEG_ONE, DVec3::ONE) * (1.0 - normal.abs()) + normal, normal)
            }
            Self::Disk => (p.with_z(0.0), DVec3::Z),
            Self::Cylinder { .. } => {
                let out = p.with_z(0.0).normalize_or(DVec3::X);
                (out.with_z(p.z), out)
            }
            Self::Sine { wave, phase } => {
                let (sin, cos) = (wave * p.x + phase).sin_cos();
                (p.with_z(sin), DVec3::new(-wave * cos, 0.0, 1.0))
            }
            Self::Paraboloid { .. } => (p.with_z(flat(p, p)), DVec3::new(2.0 * p.x, 2.0 * p.y, -1.0)),
        }
    }
}

/// Of the two vectors across z.
fn flat(a: DVec3, b: DVec3) -> f64 {
    a.x * b.x + a.y * b.y
}

/// Corners about the part of the unit circle with x ≥ `cut`.
fn segment(cut: f64) -> Vec<(f64, f64)> {
    let half = cut.clamp(-1.0, 1.0).acos();
    let pieces = (PIECES * half / std::f64::consts::PI).ceil().max(1.0);
    let step = 2.0 * half / pieces;
    let at = |angle: f64, reach: f64| (reach * angle.cos(), reach * angle.sin());
    // Tangents at the ends of the pieces meet half-way between them.
    let middles = (0..pieces as usize).map(|k| at((k as f64 + 0.5) * step - half, 1.0 / (0.5 * step).cos()));
    [at(-half, 1.0), at(half, 1.0)].into_iter().chain(middles).collect()
}

/// Where a line enters and leaves [−1, 1]³; NaN if it passes by.
pub(super) fn slabs(o: DVec3, d: DVec3) -> [f64; 2] {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for k in 0..3 {
        // Within a face's plane 0/0 is NaN, which `min` and `max` pass over.
        let (a, b) = ((-1.0 - o[k]) / d[k], (1.0 - o[k]) / d[k]);
        (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
    }
    if enter <= leave { [enter, leave] } else { [f64::NAN; 2] }
}

/// By the closest approach to the axis: what is subtracted from 1 is a square itself.
fn tube(o: DVec3, d: DVec3) -> [f64; 2] {
    let (a, b) = (flat(d, d), flat(o, d));
    let nearest = o - d * (b / a);
    let half = ((1.0 - flat(nearest, nearest)) / a).sqrt();
    [-b / a - half, -b / a + half]
}

/// The roots of a t² + 2 h t + c, without a difference of near numbers; a ray along the axis has one.
fn bowl(o: DVec3, d: DVec3) -> [f64; 2] {
    let (a, h, c) = (flat(d, d), flat(o, d) - 0.5 * d.z, flat(o, o) - o.z);
    let root = (h * h - a * c).sqrt();
    let q = -(h + root.copysign(h));
    let (s, t) = (q / a, c / q);
    if s <= t { [s, t] } else { [t, s] }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Canonical; 8] = [
        Canonical::Box,
        Canonical::Disk,
        Canonical::Cylinder { cut: WHOLE },
        Canonical::Cylinder { cut: 0.3 },
        Canonical::Paraboloid { cut: WHOLE },
        Canonical::Paraboloid { cut: 0.3 },
        Canonical::Sine { wave: 9.0, phase: 0.0 },
        Canonical::Sine { wave: 9.0, phase: -2.0 },
    ];
    /// Some dozen roundings on numbers of order ten.
    const ROUNDING: f64 = 1e-13;

    fn rays() -> impl Iterator<Item = (DVec3, DVec3)> {
        (0..4000).map(|k| {
            let turn = |factor: f64| (f64::from(k) * factor).sin();
            let o = DVec3::new(turn(1.3), turn(2.7), turn(3.9)) * 4.0;
            (o, DVec3::new(turn(5.1), turn(7.7), 0.5 + turn(9.3)) - o)
        })
    }

    #[test]
    fn what_is_met_is_on_the_shape_and_in_its_hull() {
        for shape in ALL {
            let hull = shape.hull();
            let hits: Vec<_> = rays().filter_map(|(o, d)| Some(o + d * shape.meet(o, d, 0.0, false)?)).collect();
            assert!(hits.len() > 200, "{shape:?}: {}", hits.len());
            for p in hits {
                let (foot, normal) = shape.foot(p);
                assert!((foot - p).length() < 10.0 * ROUNDING, "{shape:?}: {p} beside {foot}");
                for axis in [normal, DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::new(0.3, -0.5, 0.8)] {
                    let reach = hull.iter().map(|h| h.dot(axis)).fold(f64::NEG_INFINITY, f64::max);
                    assert!(p.dot(axis) <= reach + ROUNDING, "{shape:?}: {p} beyond its hull along {axis}");
                }
            }
        }
    }

    #[test]
    fn a_ray_that_starts_on_a_shape_meets_its_other_side_only() {
        for shape in ALL {
            let mut chords = 0;
            for (o, d) in rays() {
                let Some(t) = shape.meet(o, d, 0.0, false) else { continue };
                let on = shape.foot(o + d * t).0;
                let next = shape.meet(o, d, t + 1e-9, false);
                let again = shape.meet(on, d, 1e-9, true);
                assert_eq!(next.is_some(), again.is_some(), "{shape:?}: {next:?} {again:?}");
                if let (Some(next), Some(again)) = (next, again) {
                    chords += 1;
                    assert!((next - t - again).abs() < 1e4 * ROUNDING, "{shape:?}: {next} {t} {again}");
                }
            }
            assert_eq!(chords > 0, shape != Canonical::Disk, "{shape:?}");
        }
    }

    #[test]
    fn rays_along_the_axis_meet_a_bowl_once_and_no_tube() {
        let (o, d) = (DVec3::new(0.5, 0.0, 3.0), DVec3::NEG_Z);
        assert_eq!(Canonical::Paraboloid { cut: WHOLE }.meet(o, d, 0.0, false), Some(2.75));
        assert_eq!(Canonical::Cylinder { cut: WHOLE }.meet(o, d, 0.0, false), None);
        assert_eq!(Canonical::Cylinder { cut: WHOLE }.meet(o.with_x(1.0), d, 0.0, false), None);
    }
}
