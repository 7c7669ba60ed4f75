//! A bar of colours beside a map, with what three of them stand for.

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

/// Width and height, and the colours, rows from the top.
pub type Colours = ([usize; 2], Vec<[u8; 3]>);

/// A map of `size` pixels with a bar at its right: `bar` from 1 at the top to −1 below, labelled at the top, the middle,
/// the bottom.
pub fn with_bar(
    [width, height]: [usize; 2],
    map: Vec<[u8; 3]>,
    bar: impl Fn(f64) -> [u8; 3],
    labels: [f64; 3],
) -> Colours {
    let wide = width + GAP + BAR + GAP + LABEL * ADVANCE;
    // Three labels need their lines.
    let tall = height.max(3 * (LETTER + 1));
    let mut colours = vec![GROUND; wide * tall];
    for (at, colour) in map.into_iter().enumerate() {
        colours[at / width * wide + at % width] = colour;
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
    ([wide, tall], colours)
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
