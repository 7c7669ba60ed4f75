//! The pictures of a run side by side, a row an N, the error of each below it: what the paper's Fig. 7 shows without it.

use super::measure::Measured;
use crate::lab::plot::{Anchor, Area, Canvas};

/// px
const PICTURE: f64 = 240.0;
const GAP: f64 = 8.0;
const LETTERS: f64 = 13.0;
/// Lines below a picture.
const LINES: f64 = 2.0;

/// As SVG, of pictures in files beside it; nothing of none.
pub fn strip(id: &str, pictures: &[(String, Measured)]) -> Option<String> {
    let mut sides: Vec<u32> = pictures.iter().map(|(_, m)| m.side).collect();
    sides.sort_unstable(); // what is not timed comes last, whatever its N
    sides.dedup();
    let rows: Vec<Vec<_>> =
        sides.iter().map(|&side| pictures.iter().filter(|(_, m)| m.side == side).collect()).collect();
    let columns = rows.iter().map(Vec::len).max().filter(|&columns| columns > 0)?;
    let (across, down) = (PICTURE + GAP, PICTURE + GAP + (LINES + 0.5) * 1.4 * LETTERS);
    let mut canvas = Canvas::new(across * columns as f64 + GAP);
    canvas.size[1] = down * rows.len() as f64 + GAP;
    for (y, row) in rows.iter().enumerate() {
        for (x, (file, m)) in row.iter().enumerate() {
            let corner = [GAP + across * x as f64, GAP + down * y as f64];
            canvas.picture(file, &Area { x: corner[0], y: corner[1], w: PICTURE, h: PICTURE });
            let error = m.relmse.map_or_else(|| "not judged".to_owned(), |error| format!("relMSE {:.2e}", error.value));
            let fitted = m.fitted.map(|fit| format!(", fitted {:.2e} ({:.2} x)", fit.relmse.value, fit.scale));
            let lines = [m.variant.at(m.side), error + &fitted.unwrap_or_default()];
            for (line, text) in lines.iter().enumerate() {
                let middle = corner[1] + PICTURE + (line as f64 + 1.0) * 1.4 * LETTERS;
                canvas.text(text, [corner[0] + PICTURE / 2.0, middle], LETTERS, Anchor::Middle, "#000000");
            }
        }
    }
    let about = "pictures of the frames that were timed; their settings are in the JSON beside this file";
    Some(canvas.svg(id, about))
}
