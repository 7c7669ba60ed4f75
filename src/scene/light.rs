//! Lights: what each sends, and where to; those with a size are in [`super::area`].
use std::f64::consts::TAU;

use glam::DVec3;

use super::{
    Slide,
    area::{self, Face},
    assets::Assets,
    error::SceneError,
    file::{LightFile, SpotFile},
    locate::Key,
};

/// Half angles of a spot's cone, degrees; of 180 it is a point light.
const CONES: std::ops::RangeInclusive<f64> = 1e-3..=180.0;

/// What shines.
#[derive(Clone, Debug)]
pub struct Light {
    /// As in the file.
    pub name: String,
    /// Where its light comes from.
    pub kind: LightKind,
}

/// Colours are one number for each of the three bands.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light.
    Directional {
        /// Unit vector along which the light travels.
        direction: DVec3,
        /// W/m² on a plane that faces the light.
        irradiance: [f64; 3],
    },
    /// A disc of directions, alike in all of it: the sun.
    Sun {
        /// Unit vector along which the light of its middle travels.
        direction: DVec3,
        /// W/m² on a plane that faces its middle.
        irradiance: [f64; 3],
        /// Half its angular diameter, rad: above zero, at most a right angle.
        radius: f64,
    },
    /// A flat surface that shines on one side. It shadows nothing, and is not seen.
    Lamp {
        /// Where it is.
        face: Face,
        /// W/m²/sr
        radiance: [f64; 3],
    },
    /// What stands for a part of such a surface; no file has it.
    Patch {
        /// m
        position: DVec3,
        /// Unit vector to the side that shines.
        normal: DVec3,
        /// W/sr along the normal; it falls with the cosine.
        intensity: [f64; 3],
    },
    /// The same in every direction.
    Point {
        /// m
        position: DVec3,
        /// W/sr
        intensity: [f64; 3],
    },
    /// In a cone about an axis.
    Spot {
        /// m
        position: DVec3,
        /// W/sr on the axis.
        intensity: [f64; 3],
        /// Which share of it goes where.
        beam: Beam,
        /// By whose colours it is multiplied.
        slide: Option<Slide>,
    },
}

/// The cone of a spot light: all of the intensity within the inner half angle, none beyond the outer one, between them
/// a smooth step (3t² − 2t³) in the cosine. Half angles are kept as 1 − cosine, which has digits left at small ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Unit vector.
    pub axis: DVec3,
    /// 1 − cosine of the inner half angle.
    pub inner: f64,
    /// 1 − cosine of the outer half angle, at least that of the inner one; equal for a sharp edge. Above 2 where every
    /// direction is within.
    pub outer: f64,
}

impl Beam {
    /// Share of the intensity along a unit vector, 0 to 1.
    pub fn share(&self, d: DVec3) -> f64 {
        let height = 0.5 * (d - self.axis).length_squared();
        if height <= self.inner {
            1.0
        } else if height < self.outer {
            let t = (self.outer - height) / (self.outer - self.inner);
            t * t * (3.0 - 2.0 * t)
        } else {
            0.0
        }
    }

    /// The share's integral over all directions, sr: a band of height dh on the unit sphere has the area 2π dh.
    pub fn solid_angle(&self) -> f64 {
        let [whole, step] = [self.inner.min(2.0), self.outer - self.inner];
        // The integral of 3t² − 2t³ from 0, where t is 0 at the outer edge and 1 at the inner one.
        let below = |t: f64| t.powi(3) - 0.5 * t.powi(4);
        let beyond = if step > 0.0 { (self.outer - 2.0).clamp(0.0, step) / step } else { 1.0 };
        TAU * (whole + step * (below(1.0) - below(beyond)))
    }
}

impl LightKind {
    /// Where a light that has a place is, or its middle, m.
    pub fn position(&self) -> Option<DVec3> {
        match self {
            Self::Directional { .. } | Self::Sun { .. } => None,
            Self::Lamp { face, .. } => Some(face.center),
            Self::Point { position, .. } | Self::Spot { position, .. } | Self::Patch { position, .. } => {
                Some(*position)
            }
        }
    }

    /// Its irradiance (W/m²), radiance (W/m²/sr) or, on the axis, intensity (W/sr).
    pub fn power(&self) -> [f64; 3] {
        match self {
            Self::Directional { irradiance, .. } | Self::Sun { irradiance, .. } => *irradiance,
            Self::Lamp { radiance, .. } => *radiance,
            Self::Point { intensity, .. } | Self::Spot { intensity, .. } | Self::Patch { intensity, .. } => *intensity,
        }
    }

    /// What a file calls [`Self::power`].
    pub(super) fn power_key(&self) -> &'static str {
        match self {
            Self::Directional { .. } | Self::Sun { .. } => "irradiance",
            Self::Lamp { .. } => "radiance",
            Self::Point { .. } | Self::Spot { .. } | Self::Patch { .. } => "intensity",
        }
    }

    /// What the light gives in all, W in each band; parallel light has no end.
    pub fn flux(&self) -> Option<[f64; 3]> {
        match self {
            Self::Directional { .. } | Self::Sun { .. } => None,
            Self::Lamp { face, radiance } => Some(radiance.map(|band| 0.5 * TAU * face.area() * band)),
            Self::Patch { intensity, .. } => Some(intensity.map(|band| 0.5 * TAU * band)),
            Self::Point { intensity, .. } => Some(intensity.map(|band| 2.0 * TAU * band)),
            Self::Spot { intensity, beam, slide, .. } => {
                let whole = || DVec3::splat(beam.solid_angle());
                let shares = slide.as_ref().map_or_else(whole, |slide| slide.solid_angle(beam));
                Some((DVec3::from(*intensity) * shares).to_array())
            }
        }
    }

    /// Share of the power that goes along a unit vector, of each band.
    pub fn share(&self, d: DVec3) -> DVec3 {
        match self {
            Self::Directional { .. } | Self::Sun { .. } | Self::Point { .. } => DVec3::ONE,
            Self::Lamp { face, .. } => DVec3::splat(face.normal().dot(d).max(0.0)),
            Self::Patch { normal, .. } => DVec3::splat(normal.dot(d).max(0.0)),
            Self::Spot { beam, slide, .. } => {
                let colour = slide.as_ref().map_or(DVec3::ONE, |slide| slide.share(beam.axis, d));
                colour * beam.share(d)
            }
        }
    }
}

pub(super) fn light(key: &Key, file: &LightFile, unit: f64, assets: &mut Assets) -> Result<LightKind, SceneError> {
    match (&file.directional, &file.point, &file.spot, &file.quad, &file.disk) {
        (Some(sun), None, None, None, None) => area::directional(&key.key("directional"), sun),
        (None, Some(point), None, None, None) => {
            let key = key.key("point");
            Ok(LightKind::Point {
                position: key.key("position").point(point.position, unit)?,
                intensity: key.key("intensity").strength(point.intensity, "an intensity in W/sr")?,
            })
        }
        (None, None, Some(written), None, None) => spot(&key.key("spot"), written, unit, assets),
        (None, None, None, Some(written), None) => area::quad(&key.key("quad"), written, unit),
        (None, None, None, None, Some(written)) => area::disk(&key.key("disk"), written, unit),
        _ => Err(key.one_kind(&["directional", "point", "spot", "quad", "disk"])),
    }
}

fn spot(key: &Key, file: &SpotFile, unit: f64, assets: &mut Assets) -> Result<LightKind, SceneError> {
    let half_angle = |name: &str, value: f64, range| {
        key.key(name).number(value, range, "a half angle in degrees", "it is measured from the axis to the edge")
    };
    let outer = half_angle("outer", file.outer, CONES)?;
    let inner = half_angle("inner", file.inner.unwrap_or(outer), 0.0..=outer)?;
    // 2 sin²(θ/2); of 180°, rounding must not leave a direction out.
    let height = |degrees: f64| if degrees == 180.0 { 3.0 } else { 2.0 * (0.5 * degrees.to_radians()).sin().powi(2) };
    let axis = key.key("direction").direction(file.direction)?;
    let slide =
        file.image.as_ref().map(|name| Slide::new(key, assets.picture(&key.key("image"), name)?, file.up, axis, outer));
    if slide.is_none() && file.up.is_some() {
        return Err(key.key("up").fault("an image that stands upright", "none", "add `image`, or take `up` out"));
    }
    Ok(LightKind::Spot {
        position: key.key("position").point(file.position, unit)?,
        intensity: key.key("intensity").strength(file.intensity, "an intensity in W/sr")?,
        beam: Beam { axis, inner: height(inner), outer: height(outer) },
        slide: slide.transpose()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Midpoint rule on this many bands: its error is below 1e-7 of a step's height.
    const BANDS: usize = 20_000;

    #[test]
    fn a_beam_falls_smoothly_from_one_to_nothing() {
        let beam = Beam { axis: DVec3::NEG_Y, inner: 0.1, outer: 0.3 };
        let at = |cosine: f64| beam.share(DVec3::new((1.0 - cosine * cosine).sqrt(), -cosine, 0.0));
        assert_eq!([at(1.0), at(0.95), at(0.7 - 1e-9), at(-1.0)], [1.0, 1.0, 0.0, 0.0]);
        assert!((at(0.8) - 0.5).abs() < 1e-12 && at(0.75) < 0.5 && at(0.85) > 0.5);
        let sharp = Beam { inner: 0.3, ..beam };
        assert_eq!([sharp.share(DVec3::NEG_Y), sharp.share(DVec3::X)], [1.0, 0.0]);
    }

    #[test]
    fn a_beam_fills_the_solid_angle_that_its_shares_sum_to() {
        for (inner, outer) in [(0.1, 0.1), (0.1, 0.4), (0.0, 2.0), (0.5, 3.0), (3.0, 3.0), (1e-9, 2e-9)] {
            let beam = Beam { axis: DVec3::Y, inner, outer };
            let most = f64::min(2.0, outer);
            let at = |k: usize| most * (k as f64 + 0.5) / BANDS as f64;
            let along = |h: f64| DVec3::new((h * (2.0 - h)).sqrt(), 1.0 - h, 0.0);
            let sum: f64 = (0..BANDS).map(|k| beam.share(along(at(k))) * most / BANDS as f64).sum();
            let (summed, closed) = (TAU * sum, beam.solid_angle());
            assert!((summed - closed).abs() < 1e-3 * closed, "{inner}..{outer}: {summed} is not {closed}");
        }
    }

    #[test]
    fn a_point_gives_its_intensity_all_round_and_the_sun_has_no_end() {
        let point = LightKind::Point { position: DVec3::ZERO, intensity: [1.0, 2.0, 0.0] };
        assert_eq!(point.flux(), Some([2.0 * TAU, 4.0 * TAU, 0.0]));
        assert_eq!(LightKind::Directional { direction: DVec3::Y, irradiance: [1.0; 3] }.flux(), None);
    }
}
