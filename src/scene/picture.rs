//! Pictures as scenes use them: linear colours on a grid of pixels.
use std::sync::Arc;

use super::{Material, MaterialKind, Shape, error::SceneError, file::Floats, locate::Key};
use crate::image::Raster;

/// Pixels at most: as float32 they fill the storage buffer that every device has, 2²⁷ bytes.
pub const MOST_PIXELS: usize = (1 << 27) / 12;
/// How often a picture may stand side by side: beyond it float32 loses its pixels.
const REPEATS: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// A picture's pixels, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// As the scene names it.
    pub file: String,
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Of each pixel, linear red, green and blue: of a texture or a slide 0 to 1, of a sky W/m²/sr.
    pub pixels: Vec<[f32; 3]>,
}

/// A picture on a surface: bilinear between the middles of its pixels, repeated without end, its upper edge where the
/// surface's second coordinate ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// What is shown.
    pub picture: Arc<Picture>,
    /// How often it is within 0 to 1 of the surface's coordinates.
    pub repeat: [f64; 2],
}

/// What is wrong with a picture, in the parts of a scene's error.
#[derive(Debug)]
pub struct PictureFault {
    pub expected: String,
    pub found: String,
    pub remedy: &'static str,
}

impl Picture {
    /// From a file's bytes.
    pub fn read(key: &Key, file: &str, bytes: &[u8]) -> Result<Self, SceneError> {
        Self::decode(file, bytes, true).map_err(|wrong| key.fault(wrong.expected, wrong.found, wrong.remedy))
    }

    /// PNG, whose values are sRGB's, or EXR, whose values are linear. `opaque` refuses transparency, which else is passed over.
    pub fn decode(file: &str, bytes: &[u8], opaque: bool) -> Result<Self, PictureFault> {
        let remedy = "save it again as PNG of 8 or 16 bits, or as EXR, grey or red, green and blue";
        let expected = || "an opaque picture of colours from 0 to 1".to_owned();
        let fault = |found: String, remedy: &'static str| PictureFault { expected: expected(), found, remedy };
        let raster = Raster::read(bytes).map_err(|error| fault(format!("{file}: {error}"), remedy))?;
        let count = raster.width * raster.height;
        if count > MOST_PIXELS {
            let found = format!("{file}, which has {count} pixels");
            let expected = format!("at most {MOST_PIXELS} pixels");
            return Err(PictureFault { expected, found, remedy: "save it smaller" });
        }
        let value = |sample: f32| if raster.linear { sample } else { decoded(sample) };
        let mut pixels = Vec::with_capacity(count);
        for (index, pixel) in raster.samples.chunks_exact(raster.channels).enumerate() {
            let of = |what: String| {
                let [x, y] = [index % raster.width, index / raster.width];
                format!("{file}, whose pixel {x} from the left, {y} from the top {what}")
            };
            let (colour, opacity) = match *pixel {
                [grey] => ([grey; 3], 1.0),
                [grey, alpha] => ([grey; 3], alpha),
                [red, green, blue] => ([red, green, blue], 1.0),
                [red, green, blue, alpha] => ([red, green, blue], alpha),
                _ => return Err(fault(format!("{file}, which has {} channels", raster.channels), remedy)),
            };
            if opaque && opacity != 1.0 {
                let remedy = "save it without transparency: a surface is there or not";
                return Err(fault(of("lets light through".to_owned()), remedy));
            }
            // NaN is in no range.
            if let Some(wrong) = colour.into_iter().find(|band| !(0.0..=1.0).contains(band)) {
                return Err(fault(of(format!("is {wrong}")), "scale it to values from 0 to 1"));
            }
            pixels.push(colour.map(value));
        }
        Ok(Self { file: file.to_owned(), width: raster.width, height: raster.height, pixels })
    }
}

impl Texture {
    /// A picture, and how often it is repeated.
    pub fn new(key: &Key, picture: Arc<Picture>, repeat: Option<Floats<2>>) -> Result<Self, SceneError> {
        let repeat = repeat.unwrap_or(Floats([1.0, 1.0])).0;
        for times in repeat {
            key.key("repeat").number(times, REPEATS, "how often the picture is there", "1 shows it once")?;
        }
        Ok(Self { picture, repeat })
    }
}

/// Of sRGB (IEC 61966-2-1), linear.
fn decoded(value: f32) -> f32 {
    let value = f64::from(value);
    let linear = if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) };
    linear as f32
}

/// A mesh without texture coordinates does not say where a picture's pixels go.
pub fn refuse_no_coordinates(key: &Key, shape: &Shape, material: &Material) -> Result<(), SceneError> {
    let MaterialKind::Diffuse { texture: Some(texture), .. } = &material.kind else { return Ok(()) };
    let Shape::Mesh { mesh, .. } = shape else { return Ok(()) };
    if !mesh.coordinates.is_empty() || mesh.triangles.is_empty() {
        return Ok(());
    }
    let found = format!("{}, which has none, for `{}`", mesh.file, texture.picture.file);
    let remedy = "export it with them (`vt` on every corner of an OBJ file, `TEXCOORD_0` in glTF), or name a material without a texture";
    Err(key.fault("a mesh with texture coordinates", found, remedy))
}

#[cfg(test)]
mod tests {
    use super::decoded;

    /// Float32 of a value of order one.
    const ROUNDING: f32 = 1e-7;

    #[test]
    fn srgb_is_decoded_at_its_ends_its_knee_and_its_middle() {
        for (encoded, linear) in [(0.0, 0.0), (1.0, 1.0), (0.04045, 0.003_130_8), (0.5, 0.214_041_14)] {
            assert!((decoded(encoded) - linear).abs() < ROUNDING, "{encoded}: {}", decoded(encoded));
        }
    }
}
