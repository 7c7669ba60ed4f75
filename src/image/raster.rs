//! Pictures that are read: PNG and EXR, their samples as float32.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, Limits, Transformations};

use super::{ImageError, Layers};

/// Pixels at most, 2²⁶: of four channels they take a GiB.
const LARGEST: u64 = 1 << 26;
/// Bytes of samples at most for each byte of file. Deflate, which PNG is packed by, reaches 1032; EXR's packings, on
/// pictures of one colour, some thousand. What promises more is cut off or made up.
const PACKED: u64 = 1 << 14;

/// A picture, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Samples a pixel: grey, grey and alpha, red green blue, or those and alpha.
    pub channels: usize,
    /// Whether samples are linear light, as EXR's are; those of PNG are as they are stored.
    pub linear: bool,
    /// Pixel by pixel; of PNG 0 to 1.
    pub samples: Vec<f32>,
}

impl Raster {
    /// Reads a file of either format, which its first bytes tell apart: EXR as [`Layers::from_exr`], its main picture.
    ///
    /// # Errors
    /// [`ImageError::Format`], whatever is wrong with the bytes.
    pub fn read(bytes: &[u8]) -> Result<Self, ImageError> {
        match bytes {
            [0x89, b'P', b'N', b'G', ..] => Self::from_png(bytes),
            [0x76, 0x2f, 0x31, 0x01, ..] => Self::from_exr(bytes),
            _ => Err(wrong("PNG or EXR", "it begins like neither".to_owned())),
        }
    }

    fn from_png(bytes: &[u8]) -> Result<Self, ImageError> {
        let refused = |problem: String| wrong("PNG", problem);
        let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: 1 << 30 });
        decoder.set_transformations(Transformations::EXPAND);
        let mut reader = decoder.read_info().map_err(|e| refused(e.to_string()))?;
        let (width, height) = reader.info().size();
        check_size("PNG", [width.into(), height.into()], bytes.len())?;
        let size = reader.output_buffer_size().ok_or_else(|| refused("too large to hold".to_owned()))?;
        let mut data = vec![0; size];
        let frame = reader.next_frame(&mut data).map_err(|e| refused(e.to_string()))?;
        let channels = match frame.color_type {
            ColorType::Grayscale => 1,
            ColorType::GrayscaleAlpha => 2,
            ColorType::Rgb => 3,
            ColorType::Rgba => 4,
            ColorType::Indexed => return Err(refused("a palette".to_owned())),
        };
        let samples: Vec<f32> = match frame.bit_depth {
            BitDepth::Sixteen => data
                .chunks_exact(2)
                .map(|b| f32::from(u16::from_be_bytes([b[0], b[1]])) / f32::from(u16::MAX))
                .collect(),
            _ => data.iter().map(|b| f32::from(*b) / f32::from(u8::MAX)).collect(),
        };
        let (width, height) = (width as usize, height as usize);
        if samples.len() != width * height * channels {
            return Err(refused(format!("{} samples for {width} × {height} pixels of {channels}", samples.len())));
        }
        Ok(Self { width, height, channels, linear: false, samples })
    }

    fn from_exr(bytes: &[u8]) -> Result<Self, ImageError> {
        check_size("EXR", Layers::size_of_exr(bytes)?, bytes.len())?;
        let (layers, _) = Layers::from_exr(bytes)?;
        let main = layers.iter().next().ok_or_else(|| wrong("EXR", "no channel".to_owned()))?;
        Ok(Self {
            width: layers.width(),
            height: layers.height(),
            channels: main.channels(),
            linear: true,
            samples: main.data().to_vec(),
        })
    }

    /// The pixel of a column and a row.
    pub fn pixel(&self, x: usize, y: usize) -> &[f32] {
        &self.samples[(y * self.width + x) * self.channels..][..self.channels]
    }

    /// Column and row of the first pixel with a sample that is not finite.
    pub fn first_not_finite(&self) -> Option<[usize; 2]> {
        let at = self.samples.iter().position(|sample| !sample.is_finite())? / self.channels;
        Some([at % self.width, at / self.width])
    }
}

/// Before anything is allocated: a file of a few bytes may say that it holds as many pixels as it likes.
fn check_size(format: &'static str, [width, height]: [u64; 2], bytes: usize) -> Result<(), ImageError> {
    let pixels = width.saturating_mul(height);
    if pixels == 0 {
        return Err(wrong(format, format!("{width} × {height} pixels")));
    }
    if pixels > LARGEST {
        return Err(wrong(format, format!("{width} × {height} pixels, more than {LARGEST}")));
    }
    if pixels / 8 > PACKED * bytes as u64 {
        return Err(wrong(format, format!("{width} × {height} pixels in {bytes} bytes: it has been cut off")));
    }
    Ok(())
}

fn wrong(format: &'static str, problem: String) -> ImageError {
    ImageError::Format { format, problem }
}

#[cfg(test)]
mod tests {
    use png::Encoder;

    use super::*;
    use crate::image::Provenance;

    fn png(size: [u32; 2], color: ColorType, depth: BitDepth, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, size[0], size[1]);
        encoder.set_color(color);
        encoder.set_depth(depth);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(data).unwrap();
        writer.finish().unwrap();
        bytes
    }

    #[test]
    fn samples_are_what_was_stored() {
        let grey = Raster::read(&png([2, 1], ColorType::Grayscale, BitDepth::Sixteen, &[0, 1, 255, 255])).unwrap();
        assert_eq!((grey.width, grey.height, grey.channels), (2, 1, 1));
        assert_eq!(grey.samples, [1.0 / 65535.0, 1.0]);
        let bits = Raster::read(&png([3, 1], ColorType::Grayscale, BitDepth::One, &[0b1010_0000])).unwrap();
        assert_eq!(bits.samples, [1.0, 0.0, 1.0]);
        let rgb = Raster::read(&png([1, 2], ColorType::Rgb, BitDepth::Eight, &[0, 51, 255, 255, 0, 0])).unwrap();
        assert_eq!((rgb.pixel(0, 0), rgb.pixel(0, 1)), (&[0.0, 0.2, 1.0][..], &[1.0, 0.0, 0.0][..]));
        let mut layers = Layers::new(2, 2);
        layers.push("height", 1, vec![0.5, -3.0, f32::NAN, 1e9]).unwrap();
        let exr = Raster::read(&layers.to_exr(&Provenance::new()).unwrap()).unwrap();
        assert_eq!((exr.channels, exr.samples[1], exr.first_not_finite()), (1, -3.0, Some([0, 1])));
    }

    #[test]
    fn what_cannot_be_read_says_why_before_memory_is_spent() {
        let sound = png([64, 64], ColorType::Grayscale, BitDepth::Eight, &[7; 64 * 64]);
        let mut huge = sound.clone();
        huge[16..24].copy_from_slice(&[0, 0, 0x20, 0, 0, 0, 0x20, 0]);
        // The header's checksum would be told first.
        let sum = crc(&huge[12..29]);
        huge[29..33].copy_from_slice(&sum.to_be_bytes());
        let mut larger = huge.clone();
        larger[16] = 0x10;
        let sum = crc(&larger[12..29]);
        larger[29..33].copy_from_slice(&sum.to_be_bytes());
        let cases: [(&[u8], &str); 6] = [
            (b"", "begins like neither"),
            (b"JFIF", "begins like neither"),
            (&sound[..sound.len() / 2], "PNG"),
            (&huge, "cut off"),
            (&larger, "more than"),
            (&[0x76, 0x2f, 0x31, 0x01, 2, 0], "EXR"),
        ];
        for (bytes, words) in cases {
            let error = Raster::read(bytes).expect_err(words).to_string();
            assert!(error.contains(words), "{error}");
        }
    }

    /// CRC-32 of the PNG specification, annex D.
    fn crc(bytes: &[u8]) -> u32 {
        let step = |crc: u32| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
        !bytes.iter().fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), |crc, _| step(crc)))
    }
}
