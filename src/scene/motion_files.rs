//! Motion as it is written, and its checks.
use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    Canonical, Light, LightKind, Object, Shape,
    deform::{Bend, Deformers, Twist, Wave},
    error::SceneError,
    file::{Colour, Floats, LightFile, ObjectFile},
    flow::flow,
    locate::Key,
    motion::{LightMotion, ObjectMotion},
    shape_files,
    track::{Between, Direction, Track},
};

/// Times, s: float64 still tells microseconds apart there.
const TIMES: std::ops::RangeInclusive<f64> = -1e9..=1e9;
/// Periods, s.
const PERIODS: std::ops::RangeInclusive<f64> = 1e-6..=1e9;
/// Factors of a size: those of nothing leave no surface.
const FACTORS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;
/// Degrees a metre.
const RATES: std::ops::RangeInclusive<f64> = -1e9..=1e9;
/// Sine between vectors that are called parallel.
const PARALLEL: f64 = 1e-6;

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KeyFile<T> {
    /// s
    time: f64,
    /// Exact at its time.
    value: T,
}

type Keys<T> = Option<Vec<KeyFile<T>>>;

#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObjectMotionFile {
    /// Where its `center`, `base` or `vertex` is.
    position: Keys<Floats<3>>,
    /// Degrees about x, then y, then z, about that place.
    rotate: Keys<Floats<3>>,
    /// A factor above zero, about that place.
    scale: Keys<f64>,
    /// Turns a mesh about an axis, by its length.
    twist: Option<TwistFile>,
    /// Curves a mesh.
    bend: Option<BendFile>,
    /// A sine that runs through a mesh.
    wave: Option<WaveFile>,
    /// s; begins all keys again.
    period: Option<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TwistFile {
    /// Through the object's place.
    axis: Floats<3>,
    /// Degrees a length.
    angle: Vec<KeyFile<f64>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BendFile {
    /// The line that is curved.
    along: Floats<3>,
    /// Where it curves to.
    towards: Floats<3>,
    /// Degrees a length.
    angle: Vec<KeyFile<f64>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaveFile {
    /// The way that it runs.
    along: Floats<3>,
    /// The way that points move.
    towards: Floats<3>,
    /// Keys of it.
    amplitude: Vec<KeyFile<f64>>,
    /// In lengths of the file.
    wavelength: f64,
    /// Lengths a second.
    #[serde(default)]
    speed: f64,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LightMotionFile {
    /// Of a light that has a place; of a surface its `center`.
    position: Keys<Floats<3>>,
    /// Of a light that has one; it turns evenly.
    direction: Keys<Floats<3>>,
    /// Of a directional light, W/m².
    irradiance: Keys<Colour>,
    /// Of a surface that shines, W/m²/sr.
    radiance: Keys<Colour>,
    /// Of a point or a spot light, W/sr.
    intensity: Keys<Colour>,
    /// s; begins all keys again.
    period: Option<f64>,
}

/// How an object moves; `None` where nothing is said to.
pub fn object(
    key: &Key,
    object: &Object,
    file: &ObjectFile,
    is_receiver: bool,
    unit: f64,
) -> Result<Option<ObjectMotion>, SceneError> {
    let flow = flow(key, file, unit)?;
    let none = ObjectMotionFile::default();
    let (key, motion) = (&key.key("motion"), file.motion.as_ref().unwrap_or(&none));
    let deformers = deformers(key, &object.shape, motion, unit)?;
    let still = motion.position.is_none() && motion.rotate.is_none() && motion.scale.is_none();
    if still && deformers.is_empty() && flow.is_none() {
        return Ok(None);
    }
    if is_receiver {
        let remedy = "let the others move: what is judged stands still";
        return Err(key.fault("a region's receiver without motion", format!("motion of `{}`", object.name), remedy));
    }
    let factor = |key: &Key, value: f64| {
        key.number(value, FACTORS, "a factor of its size", "a size of nothing has no surface; move it away instead")
    };
    Ok(Some(ObjectMotion {
        place: anchor(&object.shape, file, unit),
        rest: object.shape.clone(),
        flow,
        position: track(key, "position", &motion.position, |key, value| key.point(value, unit))?,
        rotate: track(key, "rotate", &motion.rotate, shape_files::turn)?,
        scale: track(key, "scale", &motion.scale, factor)?,
        deformers,
        period: period(key, motion.period)?,
    }))
}

/// Where the file says that the shape is: its `center`, `base` or `vertex`. All of them were checked with the shape.
fn anchor(shape: &Shape, file: &ObjectFile, unit: f64) -> DVec3 {
    match shape {
        Shape::Sphere { center, .. } | Shape::Quad { center, .. } => *center,
        Shape::Canonical { to_world, .. } => to_world.translation,
        Shape::Mesh { to_world, .. } => {
            let written = file.mesh.as_ref().map(|mesh| DVec3::from_array(mesh.center.0) * unit);
            written.unwrap_or(to_world.translation)
        }
    }
}

fn deformers(key: &Key, shape: &Shape, file: &ObjectMotionFile, unit: f64) -> Result<Deformers, SceneError> {
    let given = [("twist", file.twist.is_some()), ("bend", file.bend.is_some()), ("wave", file.wave.is_some())];
    // A bent sheet is no height over a rectangle: what is below it could not be told.
    let bends = matches!(shape, Shape::Mesh { mesh, .. } if mesh.sheet.is_none());
    if let Some((name, _)) = given.into_iter().find(|(_, given)| *given && !bends) {
        let (found, remedy) = match shape {
            Shape::Mesh { .. } => ("a height over a rectangle", "save the surface as a mesh, and use that"),
            Shape::Canonical { kind: Canonical::Sine { .. }, .. } => {
                ("a shape that its equation makes", "a sine runs by its own `speed`")
            }
            _ => ("a shape that its equation makes", "use a mesh of the shape"),
        };
        return Err(key.key(name).fault("a mesh to deform", found, remedy));
    }
    // Per length: of a unit that is longer, a metre gets less.
    let rate = |key: &Key, value: f64| {
        key.number(value / unit, RATES, "degrees a metre", "it is per length of the file").map(f64::to_radians)
    };
    let twist = file.twist.as_ref().map(|twist| {
        let key = key.key("twist");
        let axis = key.key("axis").direction(twist.axis)?;
        Ok(Twist { axis, angle: keys(&key.key("angle"), &twist.angle, rate)? })
    });
    let bend = file.bend.as_ref().map(|bend| {
        let key = key.key("bend");
        let along = key.key("along").direction(bend.along)?;
        let written = key.key("towards").direction(bend.towards)?;
        let across = written - along * written.dot(along);
        if across.length() < PARALLEL {
            return Err(key.key("towards").fault("a direction across `along`", "one along it", "turn one of the two"));
        }
        Ok(Bend { along, towards: across.normalize(), angle: keys(&key.key("angle"), &bend.angle, rate)? })
    });
    let wave = file.wave.as_ref().map(|wave| wave_of(&key.key("wave"), wave, unit));
    Ok(Deformers { twist: twist.transpose()?, bend: bend.transpose()?, wave: wave.transpose()? })
}

fn wave_of(key: &Key, file: &WaveFile, unit: f64) -> Result<Wave, SceneError> {
    let length = |key: &Key, value: f64| key.number(value * unit, -1e9..=1e9, "a length in metres", "it may be zero");
    Ok(Wave {
        along: key.key("along").direction(file.along)?,
        towards: key.key("towards").direction(file.towards)?,
        amplitude: keys(&key.key("amplitude"), &file.amplitude, length)?,
        wavelength: key.key("wavelength").size(file.wavelength, unit)?,
        speed: key.key("speed").number(file.speed * unit, -1e9..=1e9, "metres a second", "0 stands still")?,
    })
}

/// How a light moves; `None` where nothing is said to.
pub fn light(key: &Key, light: &Light, file: &LightFile, unit: f64) -> Result<Option<LightMotion>, SceneError> {
    let Some(motion) = &file.motion else { return Ok(None) };
    let key = &key.key("motion");
    let (kind, position, direction) = match light.kind {
        LightKind::Directional { .. } | LightKind::Sun { .. } => ("a directional light", false, true),
        LightKind::Point { .. } | LightKind::Patch { .. } => ("a point light", true, false),
        LightKind::Spot { .. } => ("a spot light", true, true),
        LightKind::Lamp { .. } => ("a surface that shines", true, false),
    };
    let power = light.kind.power_key();
    let given = [
        ("position", motion.position.is_some(), position),
        ("direction", motion.direction.is_some(), direction),
        ("irradiance", motion.irradiance.is_some(), power == "irradiance"),
        ("radiance", motion.radiance.is_some(), power == "radiance"),
        ("intensity", motion.intensity.is_some(), power == "intensity"),
    ];
    if given.iter().all(|(_, given, _)| !given) {
        return Ok(None);
    }
    if let Some((name, ..)) = given.iter().find(|(_, given, has)| *given && !has) {
        let has: Vec<_> = given.iter().filter(|(_, _, has)| *has).map(|(name, ..)| format!("`{name}`")).collect();
        let remedy = format!("take it out, or change the light; {kind} has {}", has.join(" and "));
        return Err(key.key(name).fault(format!("a key of {kind}"), format!("`{name}`"), remedy));
    }
    let strength = |key: &Key, value: Colour| key.strength(value, "a power as the light's own");
    let shines = match power {
        "irradiance" => &motion.irradiance,
        "radiance" => &motion.radiance,
        _ => &motion.intensity,
    };
    let direction = track(key, "direction", &motion.direction, |key, value| key.direction(value).map(Direction))?;
    refuse_opposite(key, &motion.direction)?;
    Ok(Some(LightMotion {
        rest: light.kind.clone(),
        position: track(key, "position", &motion.position, |key, value| key.point(value, unit))?,
        direction,
        power: track(key, power, shines, strength)?,
        period: period(key, motion.period)?,
    }))
}

/// Between a direction and its opposite there are as many ways as there are sides.
fn refuse_opposite(key: &Key, written: &Keys<Floats<3>>) -> Result<(), SceneError> {
    let unit = |file: &KeyFile<Floats<3>>| DVec3::from_array(file.value.0).normalize_or_zero();
    for (at, pair) in written.iter().flat_map(|keys| keys.windows(2)).enumerate() {
        if (unit(&pair[0]) + unit(&pair[1])).length() < PARALLEL {
            let remedy = "put a key between the two, on the side where the light is to turn";
            return Err(element(key, "direction", at + 1).fault(
                "a direction that the one before can turn to",
                "its opposite",
                remedy,
            ));
        }
    }
    Ok(())
}

fn element<'k>(key: &Key<'k>, name: &str, at: usize) -> Key<'k> {
    key.key(name).key(&at.to_string())
}

fn period(key: &Key, written: Option<f64>) -> Result<Option<f64>, SceneError> {
    let checked =
        |period| key.key("period").number(period, PERIODS, "a period in seconds", "leave it out to move once");
    written.map(checked).transpose()
}

fn track<F: Copy, T: Between>(
    key: &Key,
    name: &str,
    written: &Keys<F>,
    check: impl Fn(&Key, F) -> Result<T, SceneError>,
) -> Result<Option<Track<T>>, SceneError> {
    written.as_ref().map(|written| keys(&key.key(name), written, check)).transpose()
}

/// Checks each key, and that the times grow.
fn keys<F: Copy, T: Between>(
    key: &Key,
    written: &[KeyFile<F>],
    check: impl Fn(&Key, F) -> Result<T, SceneError>,
) -> Result<Track<T>, SceneError> {
    let mut all: Vec<(f64, T)> = Vec::new();
    for (at, file) in written.iter().enumerate() {
        let key = key.key(&at.to_string());
        let time = key.key("time").number(file.time, TIMES, "a time in seconds", "0 is where a scene begins")?;
        if let Some((before, _)) = all.last().filter(|(before, _)| *before >= time) {
            let remedy = "sort the keys, and give each moment one";
            return Err(key.key("time").fault(
                format!("a time after {before}, that of the key before"),
                time.to_string(),
                remedy,
            ));
        }
        all.push((time, check(&key.key("value"), file.value)?));
    }
    let remedy = "add one, such as { time = 0.0, value = … }, or take the key out";
    Track::new(all).ok_or_else(|| key.fault("at least one key", "none", remedy))
}
