//! The bundled font: what PNGs are written with, and how wide a text is.
//!
//! A fresh machine has no fonts, and what is measured here must be what is drawn: labels keep apart by it.

/// DejaVu Sans 2.37, reduced; its licence lies beside it.
pub const FONT: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");
/// Its family; Verdana, where a browser has that only, is as wide.
pub const FAMILY: &str = "DejaVu Sans";
/// Ascent and descent together, em.
pub const LINE: f64 = 1.2;
/// From the upper edge of a line to its baseline, em.
pub const ASCENT: f64 = 0.93;

/// Advances of the characters from U+0020 to U+007E, 1/1000 em.
const ADVANCES: [u16; 95] = [
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636, 636, 636, 636, 636,
    636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632, 575, 775, 752, 295, 295, 656, 557, 863,
    748, 787, 603, 787, 695, 635, 611, 732, 684, 989, 685, 611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635,
    615, 352, 635, 634, 278, 278, 579, 278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636,
    337, 636, 838,
];
/// Of raised digits.
const RAISED: f64 = 0.401;
/// Of a minus, raised; of signs and letters beyond ASCII, none is wider than an em.
const RAISED_MINUS: f64 = 0.528;
const SIGN: f64 = 0.838;
const WIDEST: f64 = 1.0;

/// Width of a text at a size, px; never less than what is drawn.
pub fn width(text: &str, size: f64) -> f64 {
    text.chars().map(advance).sum::<f64>() * size
}

fn advance(c: char) -> f64 {
    match c {
        ' '..='~' => f64::from(ADVANCES[c as usize - ' ' as usize]) / 1000.0,
        '¹' | '²' | '³' | '⁰' | '⁴'..='⁹' => RAISED,
        '⁻' => RAISED_MINUS,
        '−' | '×' | '∞' | '→' => SIGN,
        _ => WIDEST,
    }
}

/// The text itself, or as much of it as fits, with an ellipsis.
pub fn fitted(text: &str, size: f64, room: f64) -> String {
    if width(text, size) <= room {
        return text.to_owned();
    }
    let mut kept = String::new();
    for c in text.chars() {
        if width(&kept, size) + (advance(c) + WIDEST) * size > room {
            break;
        }
        kept.push(c);
    }
    kept + "…"
}

/// Lines no longer than the room, broken between words; a word that is longer alone is cut.
pub fn wrapped(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line, size) + width(word, size) + width(" ", size) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(fitted(word, size, room)),
        }
    }
    lines
}
