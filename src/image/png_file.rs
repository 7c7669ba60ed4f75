//! One layer as an 8-bit sRGB PNG, provenance in its text chunks.

use super::{ImageError, Layers, Provenance, tone_map};
use png::{BitDepth, ColorType, Encoder, EncodingError, SrgbRenderingIntent};

/// The longest keyword of a text chunk (PNG specification, 11.3.3).
const MAX_KEYWORD: usize = 79;

/// The named layer as a PNG file, [tone-mapped](tone_map) at exposure `ev`; the same bytes for the same input.
///
/// A scalar layer is grey; of two or more channels the first three are red, green, blue. Each entry of `provenance` is
/// an `iTXt` chunk (UTF-8).
///
/// # Errors
/// [`ImageError::Layer`] if there is no such layer; [`ImageError::Empty`] without pixels, [`ImageError::Provenance`]
/// for a name that is not 1 to 79 characters of Latin-1.
pub fn to_png(image: &Layers, layer: &str, ev: f64, provenance: &Provenance) -> Result<Vec<u8>, ImageError> {
    let found = image.get(layer).ok_or_else(|| ImageError::layer(layer, "no such layer"))?;
    let (width, height) = (image.width(), image.height());
    if width * height == 0 {
        return Err(ImageError::Empty { width, height, layers: image.iter().len() });
    }
    let pixels: Vec<[u8; 3]> = found.pixels().map(|pixel| tone_map(rgb(pixel), ev)).collect();
    rgb_to_png([width, height], &pixels, provenance)
}

/// Colours (sRGB, rows from the top) as a PNG file, `size` pixels across and down; the same bytes for the same input.
///
/// # Errors
/// [`ImageError::Format`] if the colours do not fill the size, or it is no size of a PNG; [`ImageError::Provenance`] as
/// [`to_png`].
pub fn rgb_to_png(size: [usize; 2], colours: &[[u8; 3]], provenance: &Provenance) -> Result<Vec<u8>, ImageError> {
    let refused = |problem: String| ImageError::Format { format: "PNG", problem };
    let [width, height] = size;
    if width.checked_mul(height) != Some(colours.len()) {
        return Err(refused(format!("{} colours do not fill {width} × {height}", colours.len())));
    }
    let side = |length: usize| u32::try_from(length).map_err(|_| refused(format!("{length} pixels along a side")));
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, side(width)?, side(height)?);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    for (name, text) in provenance {
        check_keyword(name)?;
        encoder.add_itxt_chunk(name.clone(), text.clone()).map_err(format_error)?;
    }
    let mut writer = encoder.write_header().map_err(format_error)?;
    writer.write_image_data(colours.as_flattened()).map_err(format_error)?;
    writer.finish().map_err(format_error)?;
    Ok(bytes)
}

fn rgb(pixel: &[f32]) -> [f32; 3] {
    match *pixel {
        [grey] => [grey; 3],
        [r, g] => [r, g, 0.0],
        [r, g, b, ..] => [r, g, b],
        [] => [0.0; 3],
    }
}

/// The encoder would find a bad keyword only when it writes, and say less.
fn check_keyword(name: &str) -> Result<(), ImageError> {
    let latin1 = name.chars().all(|c| matches!(c, ' '..='~' | '\u{a1}'..='\u{ff}'));
    if !latin1 || !(1..=MAX_KEYWORD).contains(&name.chars().count()) {
        let problem = format!("a name is 1 to {MAX_KEYWORD} printable Latin-1 characters");
        return Err(ImageError::provenance(name, problem));
    }
    Ok(())
}

fn format_error(error: EncodingError) -> ImageError {
    ImageError::Format { format: "PNG", problem: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn sample() -> Layers {
        let mut image = Layers::new(2, 2);
        let radiance = vec![0.0, 0.0, 0.0, 0.5, 0.25, 0.125, f32::NAN, 0.0, 0.0, 4.0, 4.0, 4.0];
        image.push("radiance", 3, radiance).unwrap();
        image.push("mask", 1, vec![0.0, 0.5, 1.0, 0.25]).unwrap();
        image
    }

    fn decode(bytes: &[u8]) -> (Vec<u8>, Provenance) {
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let texts = &reader.info().utf8_text;
        (pixels, texts.iter().map(|t| (t.keyword.clone(), t.get_text().unwrap())).collect())
    }

    #[test]
    fn pixels_and_provenance_come_back() {
        let about = Provenance::from([("scene".into(), "bunny".into()), ("title".into(), "ꟻLIP, naïve".into())]);
        let bytes = to_png(&sample(), "radiance", 1.0, &about).unwrap();
        let (pixels, texts) = decode(&bytes);
        let expected = [[0.0; 3], [0.5, 0.25, 0.125], [f32::NAN, 0.0, 0.0], [4.0; 3]].map(|p| tone_map(p, 1.0));
        assert_eq!(pixels, expected.concat());
        assert_eq!(texts, about);
        assert_eq!(bytes, to_png(&sample(), "radiance", 1.0, &about).unwrap());
    }

    #[test]
    fn a_scalar_layer_is_grey() {
        let (pixels, _) = decode(&to_png(&sample(), "mask", 0.0, &Provenance::new()).unwrap());
        assert_eq!(pixels[3..6], [188; 3]);
    }

    #[test]
    fn what_cannot_be_written_says_why() {
        let error = to_png(&sample(), "caustic", 0.0, &Provenance::new()).unwrap_err().to_string();
        assert_eq!(error, "image layer \"caustic\": no such layer");
        for bad in ["", "ꟻ", "a\nb", &"x".repeat(80)] {
            let about = Provenance::from([(bad.to_owned(), String::new())]);
            let error = to_png(&sample(), "radiance", 0.0, &about).unwrap_err().to_string();
            assert!(error.contains("Latin-1"), "{error}");
        }
        let mut flat = Layers::new(3, 0);
        flat.push("radiance", 3, Vec::new()).unwrap();
        assert!(matches!(to_png(&flat, "radiance", 0.0, &Provenance::new()), Err(ImageError::Empty { .. })));
    }
}
