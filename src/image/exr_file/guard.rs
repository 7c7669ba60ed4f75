//! Which files are read: what the header says is judged before memory is asked for, or a block decoded.

use exr::compression::Compression;
use exr::meta::BlockDescription;
use exr::meta::attribute::LevelMode;
use exr::meta::header::Header;
use exr::prelude::Vec2;

use crate::image::ImageError;

/// The most bytes of pixels that a byte of a file can hold: Deflate makes up to 1032 of one, and PXR24 drops a quarter before.
const MOST_OF_ONE: u64 = 1400;

/// # Errors
/// [`ImageError::Format`] for a header that announces more pixels than the file can hold, and for what the decoder does not
/// survive when it is damaged: lossy blocks, and tiles in several resolutions.
pub fn check(header: &Header, file: usize) -> Result<(), ImageError> {
    let refused = |problem: String| Err(ImageError::Format { format: "EXR", problem });
    let bytes = |side: usize| u64::try_from(side).unwrap_or(u64::MAX);
    let a_pixel = header.channels.list.iter().map(|channel| bytes(channel.sample_type.bytes_per_sample())).sum();
    let Vec2(width, height) = header.layer_size;
    let announced = bytes(width).saturating_mul(bytes(height)).saturating_mul(a_pixel);
    if announced > MOST_OF_ONE.saturating_mul(bytes(file)) {
        return refused(format!(
            "{width} × {height} pixels of {a_pixel} bytes are announced, more than {file} bytes can hold"
        ));
    }
    match header.compression {
        Compression::Uncompressed
        | Compression::RLE
        | Compression::ZIP1
        | Compression::ZIP16
        | Compression::PIZ
        | Compression::PXR24 => {}
        lossy => return refused(format!("{lossy} is not read: save it with ZIP")),
    }
    match header.blocks {
        BlockDescription::Tiles(tiles) if tiles.level_mode != LevelMode::Singular => {
            refused("it holds several resolutions: save it with one".to_owned())
        }
        _ => Ok(()),
    }
}
