//! Where a picture is wrong: its signed error between blue (too dark) and red (too bright), and its ꟻLIP map.

use super::{
    colour_bar::with_bar,
    compare::{Comparison, Maps},
};
use crate::{
    image::{ImageError, Provenance, rgb_to_png},
    metrics::magma,
    stats,
};

/// The scale ends where this share of the pixels does, so that a few do not take the colour of all others.
pub(super) const SCALE_PERCENTILE: f64 = 99.0;
/// Ends and middle of ColorBrewer's RdBu (Harrower and Brewer 2003).
const TOO_DARK: [f64; 3] = [33.0, 102.0, 172.0];
const RIGHT: [f64; 3] = [247.0, 247.0, 247.0];
const TOO_BRIGHT: [f64; 3] = [178.0, 24.0, 43.0];
/// Pixels that are left out.
pub(super) const MASKED: [u8; 3] = [128; 3];
/// Errors that are no numbers.
const NOT_FINITE: [u8; 3] = [255, 0, 255];
/// File names and PNG files of a comparison; `stem` begins the names.
pub fn error_maps(comparison: &Comparison, stem: &str) -> Result<Vec<(String, Vec<u8>)>, ImageError> {
    let maps = &comparison.maps;
    let scale = scale(maps);
    let mut about = Provenance::from([
        ("image".to_owned(), comparison.image.clone()),
        ("layer".to_owned(), comparison.layer.clone()),
        ("scale".to_owned(), format!("{scale} (blue: as much too dark, red: as much too bright)")),
    ]);
    let signed: Vec<_> = maps.signed.iter().map(|error| diverging(error / scale)).collect();
    let error = with_bar(maps.size, masked(maps, signed), diverging, [scale, 0.0, -scale]);
    let error = (format!("{stem}.error.png"), rgb_to_png(error.0, &error.1, &about)?);
    about.insert("scale".to_owned(), "0 (black) to 1 (pale yellow)".to_owned());
    let bar = |at: f64| magma(&[0.5 * (at as f32 + 1.0)])[0];
    let flip = with_bar(maps.size, masked(maps, magma(&maps.flip)), bar, [1.0, 0.5, 0.0]);
    let flip = (format!("{stem}.flip.png"), rgb_to_png(flip.0, &flip.1, &about)?);
    Ok(vec![error, flip])
}

/// The error that has full colour, above zero.
fn scale(maps: &Maps) -> f64 {
    let judged = maps.signed.iter().zip(&maps.judged).filter(|(e, judged)| **judged && e.is_finite());
    let sizes: Vec<f64> = judged.map(|(e, _)| e.abs()).collect();
    let scale = stats::percentile(&sizes, SCALE_PERCENTILE);
    if scale > 0.0 && scale.is_finite() { scale } else { 1.0 }
}

/// −1 too dark, 0 right, 1 too bright.
pub(super) fn diverging(error: f64) -> [u8; 3] {
    if error.is_nan() {
        return NOT_FINITE;
    }
    let end = if error < 0.0 { TOO_DARK } else { TOO_BRIGHT };
    let share = error.abs().min(1.0);
    std::array::from_fn(|band| (RIGHT[band] + share * (end[band] - RIGHT[band])).round() as u8)
}

/// Grey where nothing is judged.
fn masked(maps: &Maps, map: Vec<[u8; 3]>) -> Vec<[u8; 3]> {
    map.into_iter().zip(&maps.judged).map(|(colour, judged)| if *judged { colour } else { MASKED }).collect()
}
