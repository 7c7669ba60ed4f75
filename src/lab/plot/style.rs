//! How series are told apart: by colour for most, by marker and dash for all, in grey too.

/// Okabe & Ito 2008, "Color Universal Design", without the yellow that a white page swallows; dark ones first.
const COLOURS: [&str; 7] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#56B4E9", "#E69F00"];
const DASHES: [&str; 5] = ["", "7 3", "2 3", "9 3 2 3", "4 2"];

/// The outline of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// ●
    Disc,
    /// ■
    Square,
    /// ▲
    Up,
    /// ◆
    Diamond,
    /// ▼
    Down,
    /// ✚
    Plus,
}

const SHAPES: [Shape; 6] = [Shape::Disc, Shape::Square, Shape::Up, Shape::Diamond, Shape::Down, Shape::Plus];

/// Colour, marker and dash of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// sRGB, as SVG writes it.
    pub colour: &'static str,
    /// Of its points.
    pub shape: Shape,
    /// Of its line, as SVG writes it; empty for a whole line.
    pub dash: &'static str,
}

/// The style of the series at a place: 210 in a row differ.
pub fn of(at: usize) -> Style {
    Style { colour: colour(at), shape: SHAPES[at % SHAPES.len()], dash: DASHES[at % DASHES.len()] }
}

/// The colour at a place.
pub fn colour(at: usize) -> &'static str {
    COLOURS[at % COLOURS.len()]
}

/// Black or white, whichever reads on a colour.
pub fn ink_on(colour: &str) -> &'static str {
    let channel = |at: usize| f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap_or(0));
    // Rec. 709 luma of the encoded channels: enough to choose one of two inks.
    let luma = 0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5);
    if luma > 127.0 { "#000000" } else { "#FFFFFF" }
}
