//! Lights with a size: a disc of the sky, and flat surfaces that shine; and the points that stand for them.
use std::f64::consts::{FRAC_PI_4, PI};

use glam::{DVec2, DVec3};

use super::{
    LightKind,
    error::SceneError,
    file::{Colour, DirectionalFile, DiskLightFile, QuadLightFile},
    locate::Key,
    object, shape_files,
};

/// A flat surface that shines from one side, every point of it alike in every direction (Lambert's law).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// m
    pub center: DVec3,
    /// Half edge of a rectangle, or radius of a disk, m; u × v points to the side that shines.
    pub u: DVec3,
    /// The same, at right angles to `u`.
    pub v: DVec3,
    /// A disk, not a rectangle.
    pub round: bool,
}

impl Face {
    /// Unit vector to the side that shines.
    pub fn normal(&self) -> DVec3 {
        self.u.cross(self.v).normalize_or(DVec3::Y)
    }

    /// m²
    pub fn area(&self) -> f64 {
        let shape = if self.round { PI } else { 4.0 };
        shape * self.u.cross(self.v).length()
    }
}

/// 1 − cosine of half an angular diameter (rad), with all digits of small ones.
pub fn cap_height(radius: f64) -> f64 {
    2.0 * (0.5 * radius).sin().powi(2)
}

/// `count` points of the unit square that stand for equal parts of it: a lattice of rank one, whose generator is nearest
/// to the golden section. It is its own mirror image in the centre, so that what is linear over the square is summed
/// exactly; of one point, it is the centre.
fn lattice(count: u32) -> impl Iterator<Item = DVec2> {
    let n = u64::from(count.max(1));
    let golden = (n as f64 * 0.618_033_988_749_894_9).round() as u64;
    // Odd, so that no point lies on the square's edge, which would have no mirror image.
    let coprime = |g: &u64| (1..=n).contains(g) && gcd(*g, 2 * n) == 1;
    let generator = (0..=n).flat_map(|d| [golden + d, golden.saturating_sub(d)]).find(coprime).unwrap_or(1);
    // (2k + 1) g mod 2n, in halves of a step.
    (0..n).map(move |k| {
        let y = (2 * k + 1) * generator % (2 * n);
        DVec2::new(k as f64 + 0.5, 0.5 * y as f64) / n as f64
    })
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// From the unit square to the unit disk, equal areas to equal areas (Shirley and Chiu 1997).
fn concentric(at: DVec2) -> DVec2 {
    let p = 2.0 * at - 1.0;
    let (radius, other, swapped) = if p.x.abs() > p.y.abs() { (p.x, p.y, false) } else { (p.y, p.x, true) };
    if radius == 0.0 {
        return DVec2::ZERO;
    }
    let (sin, cos) = (FRAC_PI_4 * other / radius).sin_cos();
    radius * if swapped { DVec2::new(sin, cos) } else { DVec2::new(cos, sin) }
}

impl LightKind {
    /// Whether it has a size, so that it casts half-shadows.
    pub fn has_area(&self) -> bool {
        matches!(self, Self::Sun { .. } | Self::Lamp { .. })
    }

    /// `count` lights without size that stand for it, each for an equal part: parallel light of the directions of a sun,
    /// points of a lamp. A sun's irradiance of a plane that faces its middle is kept. A light without size stands for
    /// itself, once.
    pub fn samples(&self, count: u32) -> Vec<LightKind> {
        let share = 1.0 / f64::from(count.max(1));
        match self {
            Self::Sun { direction, irradiance, radius } => {
                let height = cap_height(*radius);
                let x = direction.any_orthonormal_vector();
                let y = direction.cross(x);
                let heights = || lattice(count).map(concentric).map(|p| (height * p.length_squared(), p));
                let facing: f64 = heights().map(|(h, _)| 1.0 - h).sum();
                let one = |(h, p): (f64, DVec2)| {
                    let aside = p.normalize_or_zero() * (h * (2.0 - h)).max(0.0).sqrt();
                    let direction = ((1.0 - h) * direction + aside.x * x + aside.y * y).normalize();
                    Self::Directional { direction, irradiance: irradiance.map(|band| band / facing) }
                };
                heights().map(one).collect()
            }
            Self::Lamp { face, radiance } => {
                let place = |at: DVec2| if face.round { concentric(at) } else { 2.0 * at - 1.0 };
                let one = |at: DVec2| {
                    let at = place(at);
                    let position = face.center + at.x * face.u + at.y * face.v;
                    let intensity = radiance.map(|band| band * face.area() * share);
                    Self::Patch { position, normal: face.normal(), intensity }
                };
                lattice(count).map(one).collect()
            }
            sizeless => vec![sizeless.clone()],
        }
    }
}

/// Degrees.
const DIAMETERS: std::ops::RangeInclusive<f64> = 0.0..=180.0;

/// Parallel light, or a disc of it.
pub(super) fn directional(key: &Key, file: &DirectionalFile) -> Result<LightKind, SceneError> {
    let direction = key.key("direction").direction(file.direction)?;
    let irradiance = key.key("irradiance").strength(file.irradiance, "an irradiance in W/m²")?;
    let remedy = "the sun has 0.53; 0, or none, is light without a half-shadow";
    let written = file.angular_diameter.unwrap_or(0.0);
    let degrees = key.key("angular_diameter").number(written, DIAMETERS, "an angular diameter in degrees", remedy)?;
    Ok(match 0.5 * degrees.to_radians() {
        0.0 => LightKind::Directional { direction, irradiance },
        radius => LightKind::Sun { direction, irradiance, radius },
    })
}

pub(super) fn quad(key: &Key, file: &QuadLightFile, unit: f64) -> Result<LightKind, SceneError> {
    let [center, u, v] = object::rectangle(key, [file.center, file.u, file.v], unit)?;
    lamp(key, Face { center, u, v, round: false }, [file.radiance, file.power])
}

pub(super) fn disk(key: &Key, file: &DiskLightFile, unit: f64) -> Result<LightKind, SceneError> {
    let (center, frame) = shape_files::disk_frame(key, [file.center, file.normal], file.radius, unit)?;
    lamp(key, Face { center, u: frame.x_axis, v: frame.y_axis, round: true }, [file.radiance, file.power])
}

/// Its strength is written as radiance or as power, which is π times the area of it.
fn lamp(key: &Key, face: Face, [radiance, power]: [Option<Colour>; 2]) -> Result<LightKind, SceneError> {
    let radiance = match (radiance, power) {
        (Some(radiance), None) => key.key("radiance").strength(radiance, "a radiance in W/m²/sr")?,
        (None, Some(power)) => {
            let key = key.key("power");
            let watts = key.strength(power, "a power in W")?.map(|band| band / (PI * face.area()));
            key.strength(Colour(watts), "a power whose radiance, in W/m²/sr, is")?
        }
        (given, _) => {
            let found = if given.is_some() { "both" } else { "neither" };
            let remedy = "give the radiance in W/m²/sr, or the power in W that the whole surface sends out";
            return Err(key.fault("one of `radiance` and `power`", found, remedy));
        }
    };
    Ok(LightKind::Lamp { face, radiance })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of up to a thousand roundings.
    const ROUNDING: f64 = 1e-12;
    const COUNTS: [u32; 9] = [1, 2, 3, 4, 7, 16, 64, 100, 1000];

    fn sun(degrees: f64) -> LightKind {
        let direction = DVec3::new(0.3, -0.8, 0.2).normalize();
        LightKind::Sun { direction, irradiance: [1.0, 2.0, 4.0], radius: 0.5 * degrees.to_radians() }
    }

    #[test]
    fn points_of_a_lattice_differ_and_balance() {
        for count in COUNTS {
            let points: Vec<DVec2> = lattice(count).collect();
            assert_eq!(points.len(), count as usize);
            let mean = points.iter().sum::<DVec2>() / f64::from(count);
            assert!((mean - 0.5).length() < ROUNDING, "{count}: {mean}");
            for axis in 0..2 {
                let mut cells: Vec<u32> = points.iter().map(|p| (p[axis] * f64::from(count)) as u32).collect();
                cells.sort_unstable();
                assert!(cells.iter().enumerate().all(|(k, cell)| k as u32 == *cell), "{count}: one to a stripe");
            }
            let disk = points.iter().map(|at| concentric(*at)).sum::<DVec2>();
            assert!(
                disk.length() < ROUNDING * f64::from(count) && points.iter().all(|at| concentric(*at).length() < 1.0)
            );
        }
    }

    /// A disk of radius one has ∫ r² dA = half its area; the lattice's error falls as 1/count.
    #[test]
    fn a_disk_is_filled_evenly() {
        let spread = |count| lattice(count).map(|at| concentric(at).length_squared()).sum::<f64>() / f64::from(count);
        for count in [16, 64, 1000] {
            assert!((spread(count) - 0.5).abs() < 0.5 / f64::from(count), "{count}: {}", spread(count));
        }
    }

    #[test]
    fn a_suns_directions_keep_its_irradiance_and_lie_in_its_disc() {
        for degrees in [1e-9, 0.53, 30.0, 180.0] {
            let LightKind::Sun { direction, radius, .. } = sun(degrees) else { unreachable!() };
            for count in COUNTS {
                let mut facing = DVec3::ZERO;
                for sample in sun(degrees).samples(count) {
                    let LightKind::Directional { direction: d, irradiance } = sample else { panic!("{sample:?}") };
                    assert!(d.angle_between(direction) <= radius + 1e-7 && (d.length() - 1.0).abs() < ROUNDING);
                    facing += DVec3::from(irradiance) * d.dot(direction);
                }
                assert!((facing - DVec3::new(1.0, 2.0, 4.0)).length() < 1e-9, "{degrees}°, {count}: {facing}");
            }
        }
        let LightKind::Directional { direction, irradiance } = sun(5.0).samples(1)[0] else { panic!("one direction") };
        let same = DVec3::new(0.3, -0.8, 0.2).normalize();
        assert!((direction - same).length() < ROUNDING && irradiance == [1.0, 2.0, 4.0], "the middle alone");
    }

    #[test]
    fn a_lamps_points_lie_on_it_and_share_its_power() {
        let face = Face { center: DVec3::Y, u: DVec3::X * 0.5, v: DVec3::Z * 2.0, round: false };
        assert_eq!((face.area(), face.normal()), (4.0, DVec3::NEG_Y));
        let kind = LightKind::Lamp { face, radiance: [3.0; 3] };
        assert!((kind.flux().unwrap()[0] - 12.0 * PI).abs() < ROUNDING);
        for count in COUNTS {
            let all = kind.samples(count);
            let flux: f64 = all.iter().map(|one| one.flux().unwrap()[0]).sum();
            assert!((flux - 12.0 * PI).abs() < 1e-9, "{flux}");
            assert!(all.iter().all(|one| {
                let p = one.position().unwrap() - DVec3::Y;
                p.x.abs() < 0.5 && p.y == 0.0 && p.z.abs() < 2.0
            }));
        }
        let disk = LightKind::Lamp { face: Face { v: DVec3::Z * 0.5, round: true, ..face }, radiance: [1.0; 3] };
        assert!((disk.flux().unwrap()[0] - PI * PI * 0.25).abs() < ROUNDING);
        assert!(disk.samples(100).iter().all(|one| (one.position().unwrap() - DVec3::Y).length() < 0.5));
    }
}
