//! Where a picture is wrong: its signed error between blue (too dark) and red (too bright), and its ꟻLIP map.

use super::compare::{Comparison, Maps};
use crate::{
    image::{ImageError, Provenance, rgb_to_png},
    metrics::magma,
    stats,
};

/// The scale ends where this share of the pixels does, so that a few do not take the colour of all others.
const SCALE_PERCENTILE: f64 = 99.0;
/// Ends and middle of ColorBrewer's RdBu (Harrower and Brewer 2003).
const TOO_DARK: [f64; 3] = [33.0, 102.0, 172.0];
const RIGHT: [f64; 3] = [247.0, 247.0, 247.0];
const TOO_BRIGHT: [f64; 3] = [178.0, 24.0, 43.0];
/// Pixels that are left out.
const MASKED: [u8; 3] = [128; 3];
/// Errors that are no numbers.
const NOT_FINITE: [u8; 3] = [255, 0, 255];
/// Black beside the picture.
const GROUND: [u8; 3] = [0; 3];
const INK: [u8; 3] = [255; 3];
/// Pixels: between picture and bar, across the bar, between bar and words, a letter's advance and height.
const GAP: usize = 4;
const BAR: usize = 8;
const ADVANCE: usize = 4;
const LETTER: usize = 5;
/// Letters a label may have: `-1.0e-10`.
const LABEL: usize = 8;

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
    let error = with_bar(maps, signed, diverging, [scale, 0.0, -scale])?;
    let error = (format!("{stem}.error.png"), rgb_to_png(error.0, &error.1, &about)?);
    about.insert("scale".to_owned(), "0 (black) to 1 (pale yellow)".to_owned());
    let bar = |at: f64| magma(&[0.5 * (at as f32 + 1.0)])[0];
    let flip = with_bar(maps, magma(&maps.flip), bar, [1.0, 0.5, 0.0])?;
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
fn diverging(error: f64) -> [u8; 3] {
    if error.is_nan() {
        return NOT_FINITE;
    }
    let end = if error < 0.0 { TOO_DARK } else { TOO_BRIGHT };
    let share = error.abs().min(1.0);
    std::array::from_fn(|band| (RIGHT[band] + share * (end[band] - RIGHT[band])).round() as u8)
}

type Colours = ([usize; 2], Vec<[u8; 3]>);

/// The map with a bar at its right: `bar` from 1 at the top to −1 below, labelled at the top, the middle, the bottom.
fn with_bar(
    maps: &Maps,
    map: Vec<[u8; 3]>,
    bar: impl Fn(f64) -> [u8; 3],
    labels: [f64; 3],
) -> Result<Colours, ImageError> {
    let [width, height] = maps.size;
    let wide = width + GAP + BAR + GAP + LABEL * ADVANCE;
    // Three labels need their lines.
    let tall = height.max(3 * (LETTER + 1));
    let mut colours = vec![GROUND; wide * tall];
    for (at, colour) in map.into_iter().enumerate() {
        colours[at / width * wide + at % width] = if maps.judged[at] { colour } else { MASKED };
    }
    for row in 0..tall {
        let colour = bar(1.0 - 2.0 * (row as f64 + 0.5) / tall as f64);
        let start = row * wide + width + GAP;
        colours[start..start + BAR].fill(colour);
    }
    for (line, value) in labels.into_iter().enumerate() {
        let top = line * (tall - LETTER) / 2;
        write_number(&mut colours, wide, [width + GAP + BAR + GAP, top], value);
    }
    Ok(([wide, tall], colours))
}

fn write_number(colours: &mut [[u8; 3]], wide: usize, [left, top]: [usize; 2], value: f64) {
    let plain = value == 0.0 || (0.01..100.0).contains(&value.abs());
    let text = if plain { format!("{value:.2}") } else { format!("{value:.1e}") };
    for (at, rows) in text.chars().take(LABEL).map(glyph).enumerate() {
        for (row, bits) in rows.into_iter().enumerate() {
            for column in (0..3).filter(|column| bits >> (2 - column) & 1 == 1) {
                colours[(top + row) * wide + left + at * ADVANCE + column] = INK;
            }
        }
    }
}

/// Three by five pixels.
fn glyph(letter: char) -> [u8; LETTER] {
    match letter {
        '0' => [0b111, 0b101, 0b101, 0b101, 0b111],
        '1' => [0b010, 0b110, 0b010, 0b010, 0b111],
        '2' => [0b111, 0b001, 0b111, 0b100, 0b111],
        '3' => [0b111, 0b001, 0b111, 0b001, 0b111],
        '4' => [0b101, 0b101, 0b111, 0b001, 0b001],
        '5' => [0b111, 0b100, 0b111, 0b001, 0b111],
        '6' => [0b111, 0b100, 0b111, 0b101, 0b111],
        '7' => [0b111, 0b001, 0b010, 0b010, 0b010],
        '8' => [0b111, 0b101, 0b111, 0b101, 0b111],
        '9' => [0b111, 0b101, 0b111, 0b001, 0b111],
        '-' => [0, 0, 0b111, 0, 0],
        '.' => [0, 0, 0, 0, 0b010],
        'e' => [0, 0b111, 0b111, 0b100, 0b111],
        _ => [0; LETTER],
    }
}
