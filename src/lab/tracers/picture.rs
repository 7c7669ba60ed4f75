//! A tracer's error as a picture of the light's view.

use super::{Compared, judge::Verdict};
use crate::{
    image::{ImageError, Provenance, rgb_to_png},
    lab::colour_bar::with_bar,
    metrics::magma,
};

/// Powers of ten of a map texel at both ends of the scale.
const DECADES: [f64; 2] = [-2.0, 2.0];
/// Colours that magma has not.
const LOST: [u8; 3] = [33, 102, 172];
const INVENTED: [u8; 3] = [90, 180, 90];
const NOTHING: [u8; 3] = [128; 3];

/// The landing error of each texel from black (a hundredth of a map texel) to pale yellow (a hundred), what is lost in
/// blue, what is invented in green, grey where nothing arrives; views side by side. PNG.
pub fn tracer_map(compared: &Compared) -> Result<Vec<u8>, ImageError> {
    let (side, views) = (compared.side, compared.verdicts.len());
    let mut colours = vec![NOTHING; side * side * views];
    for (view, verdicts) in compared.verdicts.iter().enumerate() {
        for (at, verdict) in verdicts.iter().enumerate() {
            colours[at / side * side * views + view * side + at % side] = colour(*verdict);
        }
    }
    let [low, high] = DECADES;
    let labels = [high, 0.5 * (low + high), low].map(|decade| 10f64.powf(decade));
    let (size, colours) = with_bar([side * views, side], colours, |at| magma(&[0.5 * (at as f32 + 1.0)])[0], labels);
    let about = Provenance::from([
        ("tracer".to_owned(), compared.tracer.to_owned()),
        ("scale".to_owned(), "landing error, map texels; blue: falsely lost, green: falsely arrived".to_owned()),
    ]);
    rgb_to_png(size, &colours, &about)
}

fn colour(verdict: Verdict) -> [u8; 3] {
    let [low, high] = DECADES;
    match verdict {
        Verdict::Off(texels) => {
            let decade = texels.max(f64::MIN_POSITIVE).log10();
            magma(&[((decade - low) / (high - low)).clamp(0.0, 1.0) as f32])[0]
        }
        Verdict::Lost => LOST,
        Verdict::Invented => INVENTED,
        Verdict::Nothing => NOTHING,
    }
}
