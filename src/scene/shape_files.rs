//! Canonical shapes as scene files write them: checked, and put in place.
use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Canonical, Material, MaterialKind, Shape, WHOLE, error::SceneError, file::Floats, locate::Key};

/// Sine between an axis and a direction below which it has no part across the axis.
const ACROSS: f64 = 1e-6;
const FULL_TURN: f64 = 360.0;
/// Waves on half a sheet: beyond these float32 loses their phase.
const WAVES: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxFile {
    /// Of the box.
    pub center: Floats<3>,
    /// Three half edges.
    pub half: Floats<3>,
    /// Degrees about x, then y, then z.
    #[serde(default)]
    pub rotate: Floats<3>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DiskFile {
    /// Of the disk.
    pub center: Floats<3>,
    /// To the lit side.
    pub normal: Floats<3>,
    /// In lengths of the file.
    pub radius: f64,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CylinderFile {
    /// Centre of one end.
    pub base: Floats<3>,
    /// From there to the other end.
    pub axis: Floats<3>,
    /// In lengths of the file.
    pub radius: f64,
    /// Along the axis.
    pub height: f64,
    /// Degrees of the circle that are there.
    #[serde(default = "full_turn")]
    pub arc: f64,
    /// Needed where the arc is less than a full turn.
    pub middle: Option<Floats<3>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParaboloidFile {
    /// Its deepest point.
    pub vertex: Floats<3>,
    /// From the vertex to the focus.
    pub axis: Floats<3>,
    /// From the vertex to the focus.
    pub focal_length: f64,
    /// Radius of the rim.
    pub rim: f64,
    /// With `middle`, an off-axis part.
    pub from: Option<f64>,
    /// From the axis to the middle of the part.
    pub middle: Option<Floats<3>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SineFile {
    /// Of the rectangle.
    pub center: Floats<3>,
    /// Half edge; the wave runs along it.
    pub u: Floats<3>,
    /// Half edge, at right angles to u.
    pub v: Floats<3>,
    /// Half the height from trough to crest.
    pub amplitude: f64,
    /// Along u.
    pub wavelength: f64,
    /// Lengths a second, along u.
    #[serde(default)]
    pub speed: f64,
}

fn full_turn() -> f64 {
    FULL_TURN
}

/// Turned about x, then y, then z, by degrees.
pub fn turned(key: &Key, rotate: Floats<3>) -> Result<DMat3, SceneError> {
    turn(key, rotate).map(DMat3::from_quat)
}

/// As [`turned`].
pub fn turn(key: &Key, rotate: Floats<3>) -> Result<DQuat, SceneError> {
    for angle in rotate.0 {
        key.number(angle, -FULL_TURN..=FULL_TURN, "degrees", "a full turn is 360")?;
    }
    let [x, y, z] = rotate.0.map(f64::to_radians);
    Ok(DQuat::from_euler(EulerRot::ZYX, z, y, x))
}

pub fn cuboid(key: &Key, file: &BoxFile, unit: f64) -> Result<Shape, SceneError> {
    let center = key.key("center").point(file.center, unit)?;
    let half = key.key("half");
    let [x, y, z] = file.half.0.map(|half_edge| half.size(half_edge, unit));
    let linear = turned(&key.key("rotate"), file.rotate)? * DMat3::from_diagonal(DVec3::new(x?, y?, z?));
    Ok(placed(Canonical::Box, linear, center))
}

pub fn disk(key: &Key, file: &DiskFile, unit: f64) -> Result<Shape, SceneError> {
    let (center, frame) = disk_frame(key, [file.center, file.normal], file.radius, unit)?;
    Ok(placed(Canonical::Disk, frame, center))
}

/// Centre of a disk, and its axes: two radii, and the normal as long.
pub fn disk_frame(
    key: &Key,
    [center, normal]: [Floats<3>; 2],
    radius: f64,
    unit: f64,
) -> Result<(DVec3, DMat3), SceneError> {
    let center = key.key("center").point(center, unit)?;
    let normal = key.key("normal").direction(normal)?;
    let radius = key.key("radius").size(radius, unit)?;
    Ok((center, frame(normal, None) * radius))
}

pub fn cylinder(key: &Key, file: &CylinderFile, unit: f64) -> Result<Shape, SceneError> {
    let base = key.key("base").point(file.base, unit)?;
    let axis = key.key("axis").direction(file.axis)?;
    let radius = key.key("radius").size(file.radius, unit)?;
    let height = key.key("height").size(file.height, unit)?;
    let arc = key.key("arc").number(file.arc, 1e-3..=FULL_TURN, "degrees of arc", "360 makes the whole tube")?;
    let middle = middle(&key.key("middle"), axis, file.middle, "an arc below 360°", arc < FULL_TURN)?;
    let cut = if arc < FULL_TURN { (0.5 * arc.to_radians()).cos() } else { WHOLE };
    let linear = frame(axis, middle) * DMat3::from_diagonal(DVec3::new(radius, radius, height));
    Ok(placed(Canonical::Cylinder { cut }, linear, base))
}

pub fn paraboloid(key: &Key, file: &ParaboloidFile, unit: f64) -> Result<Shape, SceneError> {
    let vertex = key.key("vertex").point(file.vertex, unit)?;
    let axis = key.key("axis").direction(file.axis)?;
    let focal_length = key.key("focal_length").size(file.focal_length, unit)?;
    let rim = key.key("rim").size(file.rim, unit)?;
    let from = file.from.map(|from| {
        let cut = from * unit / rim;
        key.key("from").number(
            cut,
            -1.0..=0.999,
            "a distance from the axis, over the rim's",
            "leave some of the mirror",
        )
    });
    let cut = from.transpose()?;
    let middle = middle(&key.key("middle"), axis, file.middle, "a part of it", cut.is_some())?;
    let depth = rim * rim / (4.0 * focal_length);
    let linear = frame(axis, middle) * DMat3::from_diagonal(DVec3::new(rim, rim, depth));
    Ok(placed(Canonical::Paraboloid { cut: cut.unwrap_or(WHOLE) }, linear, vertex))
}

/// A wave along u over a rectangle.
pub fn sine(key: &Key, file: &SineFile, [center, u, v]: [DVec3; 3], unit: f64) -> Result<Shape, SceneError> {
    let amplitude = key.key("amplitude").size(file.amplitude, unit)?;
    let wavelength = key.key("wavelength").size(file.wavelength, unit)?;
    let waves = key.key("wavelength").number(u.length() / wavelength, WAVES, "waves along u", "make them longer")?;
    let linear = DMat3::from_cols(u, v, u.cross(v).normalize() * amplitude);
    Ok(placed(Canonical::Sine { wave: std::f64::consts::TAU * waves, phase: 0.0 }, linear, center))
}

/// The direction of the part's middle, across the axis.
fn middle(
    key: &Key,
    axis: DVec3,
    written: Option<Floats<3>>,
    of: &str,
    needed: bool,
) -> Result<Option<DVec3>, SceneError> {
    let Some(written) = written else {
        let remedy = "add `middle`: from the axis to the middle of the part that is there";
        return if needed { Err(key.fault(format!("a direction, for {of}"), "none", remedy)) } else { Ok(None) };
    };
    let direction = key.direction(written)?;
    if direction.cross(axis).length() < ACROSS {
        return Err(key.fault("a direction across the axis", "one along it", "turn one of the two"));
    }
    Ok(Some(direction))
}

/// Right-handed, z along the axis, x as near to `towards` as that lets it be.
fn frame(axis: DVec3, towards: Option<DVec3>) -> DMat3 {
    let x = towards.map_or_else(|| axis.any_orthonormal_vector(), |t| (t - axis * t.dot(axis)).normalize());
    DMat3::from_cols(x, axis.cross(x), axis)
}

fn placed(kind: Canonical, linear: DMat3, at: DVec3) -> Shape {
    Shape::Canonical { kind, to_world: DAffine3::from_mat3_translation(linear, at) }
}

/// A tube or bowl of glass has an inside, but no end to it: which medium holds a point is not said.
pub fn refuse_open_shell(key: &Key, shape: &Shape, material: &Material) -> Result<(), SceneError> {
    let Shape::Canonical { kind, .. } = shape else { return Ok(()) };
    let shell = matches!(kind, Canonical::Cylinder { .. } | Canonical::Paraboloid { .. });
    if !shell || !matches!(material.kind, MaterialKind::Dielectric { .. }) {
        return Ok(());
    }
    let found = format!("the dielectric `{}` on an open shell", material.name);
    let remedy = "open shells of glass are not built yet; name a mirror or a diffuse material, or use a closed shape";
    Err(key.key("material").fault(format!("a mirror or a diffuse material on a {}", kind.name()), found, remedy))
}
