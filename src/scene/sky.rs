//! The sky: radiance from every direction, seen where nothing is. It lights nothing.
use std::{ops::RangeInclusive, sync::Arc};

use glam::{DQuat, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    MOST_PIXELS, Picture,
    assets::{Assets, BESIDE},
    error::SceneError,
    file::{Colour, Floats, one},
    locate::Key,
    measure::STRONGEST,
    schema,
};
use crate::image::Raster;

/// Degrees about the vertical.
const TURNS: RangeInclusive<f64> = -360.0..=360.0;
/// Sine between the vertical and z below which −z does not say where the middle of a picture is.
const PARALLEL: f64 = 1e-6;

/// What the eye sees where nothing is, alone and in what bends or mirrors its rays. Radiance in W/m²/sr, one number for
/// each of the three bands; it does not change with place or time.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// L = `horizon` + (`zenith` − `horizon`) f(s), s being the sine of the elevation and f(s) = s² (3 − 2 |s|); below the
    /// horizon, s < 0, with `ground` in the place of `zenith`. Without a step in value or slope.
    Gradient {
        /// Unit vector to the zenith.
        up: DVec3,
        /// Straight up.
        zenith: [f64; 3],
        /// All round.
        horizon: [f64; 3],
        /// Straight down.
        ground: [f64; 3],
    },
    /// An equirectangular picture: rows are even in elevation, its upper edge the zenith, and columns in azimuth, its middle
    /// `ahead`, with `ahead` × `up` to its right. Bilinear between the middles of pixels, across its sides to the other
    /// one, and over the zenith to the column opposite.
    Image {
        /// Twice as wide as it is high.
        picture: Arc<Picture>,
        /// Unit vector to the zenith.
        up: DVec3,
        /// Unit vector across it, seen in the picture's middle.
        ahead: DVec3,
    },
}

/// Exactly one kind is given.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = schema::one_kind)]
pub struct SkyFile {
    /// Smooth from the horizon to the zenith and straight down.
    pub gradient: Option<GradientFile>,
    /// A picture of all directions.
    pub image: Option<ImageFile>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GradientFile {
    /// Radiance straight up, W/m²/sr.
    pub zenith: Colour,
    /// Radiance at the horizon, W/m²/sr.
    pub horizon: Colour,
    /// Radiance straight down, W/m²/sr; else the horizon's.
    pub ground: Option<Colour>,
    /// To the zenith; else +y.
    pub up: Option<Floats<3>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImageFile {
    /// An equirectangular EXR, twice as wide as it is high.
    pub file: String,
    /// W/m²/sr of a pixel of value 1.
    #[serde(default = "one")]
    pub scale: f64,
    /// To the zenith, the picture's upper edge; else +y.
    pub up: Option<Floats<3>>,
    /// Degrees about the zenith, by the right hand; at 0 its middle is −z, or +y under a zenith along z.
    #[serde(default)]
    pub turn: f64,
}

/// Of a scene's table; a picture's bytes become the scene's.
pub fn sky(key: &Key, file: &SkyFile, assets: &mut Assets) -> Result<Sky, SceneError> {
    match (&file.gradient, &file.image) {
        (Some(written), None) => gradient(&key.key("gradient"), written),
        (None, Some(written)) => image(&key.key("image"), written, assets),
        _ => Err(key.one_kind(&["gradient", "image"])),
    }
}

fn gradient(key: &Key, file: &GradientFile) -> Result<Sky, SceneError> {
    let radiance = |name: &str, colour| key.key(name).strength(colour, "a radiance in W/m²/sr");
    Ok(Sky::Gradient {
        up: zenith(key, file.up)?,
        zenith: radiance("zenith", file.zenith)?,
        horizon: radiance("horizon", file.horizon)?,
        ground: radiance("ground", file.ground.unwrap_or(file.horizon))?,
    })
}

fn image(key: &Key, file: &ImageFile, assets: &mut Assets) -> Result<Sky, SceneError> {
    let scale = key.key("scale").number(file.scale, 0.0..=STRONGEST, "a factor", "1 takes the picture as it is")?;
    let turn = key.key("turn").number(file.turn, TURNS, "degrees about the zenith", "a whole turn is 360")?;
    let up = zenith(key, file.up)?;
    let straight = if up.cross(DVec3::Z).length() < PARALLEL { DVec3::Y } else { DVec3::NEG_Z };
    let ahead = DQuat::from_axis_angle(up, turn.to_radians()) * straight.reject_from_normalized(up).normalize();
    let key = key.key("file");
    let bytes = assets.bytes(&key, &file.file, "a readable picture", BESIDE)?;
    Ok(Sky::Image { picture: Arc::new(picture(&key, &file.file, &bytes, scale)?), up, ahead })
}

fn zenith(key: &Key, up: Option<Floats<3>>) -> Result<DVec3, SceneError> {
    up.map_or(Ok(DVec3::Y), |up| key.key("up").direction(up))
}

/// Radiance of all directions, from a file's bytes.
fn picture(key: &Key, file: &str, bytes: &[u8], scale: f64) -> Result<Picture, SceneError> {
    const SHAPE: &str = "make it equirectangular, all of the way round and from zenith to nadir, twice as wide as high";
    let expected = "an EXR of radiance from all directions";
    let fault = |found: String, remedy: &str| key.fault(expected, format!("{file}{found}"), remedy);
    let saved = "save it as EXR, grey or red, green and blue";
    let raster = Raster::read(bytes).map_err(|error| fault(format!(": {error}"), saved))?;
    if !raster.linear {
        let remedy = "save it as EXR: the numbers of a PNG end where a sky is bright";
        return Err(fault(", which is a PNG".to_owned(), remedy));
    }
    let Raster { width, height, .. } = raster;
    if width != 2 * height {
        return Err(fault(format!(", which has {width} × {height} pixels"), SHAPE));
    }
    if width * height > MOST_PIXELS {
        let found = format!("{file}, which has {} pixels", width * height);
        return Err(key.fault(format!("at most {MOST_PIXELS} pixels"), found, "save it smaller"));
    }
    let mut pixels = Vec::with_capacity(width * height);
    for (index, pixel) in raster.samples.chunks_exact(raster.channels).enumerate() {
        let colour = match *pixel {
            [red, green, blue, ..] => [red, green, blue],
            [grey, ..] => [grey; 3],
            [] => return Err(fault(", which has no channel".to_owned(), saved)),
        };
        let radiance = colour.map(|band| f64::from(band) * scale);
        // NaN is in no range, and neither is nothing times infinity.
        if let Some(band) = (0..3).find(|band| !(0.0..=STRONGEST).contains(&radiance[*band])) {
            let [x, y] = [index % width, index / width];
            let found = format!(", whose pixel {x} from the left, {y} from the top is {}", colour[band]);
            return Err(fault(found, "make each finite, zero or more, and at most 1e12 W/m²/sr by `scale`"));
        }
        pixels.push(radiance.map(|band| band as f32));
    }
    Ok(Picture { file: file.to_owned(), width, height, pixels })
}
