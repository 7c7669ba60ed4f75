//! What the prose of Rendering Water Caustics claims, as measured figures.

use super::{
    asked::{Asked, Place, ratio},
    columns::{Part, Variant, water},
    measure::{Measured, Run},
    subject::{CLEAR, DEEP, SEA_HIGH, SEA_LOW, SHALLOW, Subject},
};
use crate::{
    lab::{
        Picture,
        compare::{self, FITTED, MEASURES},
        papers::Figure,
    },
    scene::Wave,
    stats::Interval,
    truth::backward::{Beam, Useful},
};

/// The layer that is compared.
const LAYER: &str = "irradiance.caustic";
/// Texels or cells along a side, where the paper states none; what has no N is run with this one too, all at once.
const SIDE: u32 = 256;
/// How many times as many pixels the larger of two pictures has along a side.
pub const LARGER: u32 = 4;
/// Of the waves scene's floor below the water, m.
const DEPTH: f64 = 0.8;
/// The sun's diameter, and its least and greatest distance, as the paper has them; million km.
const SUN: [f64; 3] = [1.42, 147.0, 152.0];
/// The two-sided 99 % quantile of the normal distribution, in standard deviations.
const NORMAL_99: f64 = 2.575_829_303_548_901;

/// What a claim about water asks.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// Nothing of a run.
    Known(Interval),
    /// By which power of the picture's pixels invocations grow from the first to the second.
    Work(Place, Place),
    /// The same of time.
    Time(Place, Place),
    /// How far the first's picture is from the second's, by a measure of that name.
    Difference(Place, Place, &'static str),
    /// Standard deviation over mean of the first's picture, over that of the second's.
    Contrast(Place, Place),
    /// Share of the light that a metre takes, of a picture and of one without absorption.
    Absorbed(Place, Place),
    /// Error of the first, each at its best scale, over that of the second.
    Better(Place, Place),
    /// Share of rays backward from the floor that meet the sun.
    Useful(Beam),
}

/// What a figure asks; else what is missing.
pub fn asked(figure: &Figure) -> Result<Asked, String> {
    let known = |value: f64| Claim::Known(Interval::exact(value));
    let found = |variant: Variant, part| Place { variant, side: SIDE, part };
    let texels = |variant: Variant| Place { variant, side: SIDE, part: Part::Texture };
    let sized = |waves, times| Variant { magnified: Some(times), ..water(waves, Subject::Water) };
    let whole = |place: Place| Place { part: Part::Water, ..place };
    let pixels = [1, LARGER].map(|times| found(sized("pixel", times), Part::Surface));
    let textures = [1, LARGER].map(|times| texels(sized("texture", times)));
    let picture = |waves, subject| found(water(waves, subject), Part::Water);
    let deep = |row: &str| match row {
        "0.4 m" => SHALLOW,
        "1.6 m" => DEEP,
        _ => Subject::Water,
    };
    let shortcut = |measure| {
        let subject = deep(&figure.row.text());
        Claim::Difference(picture("shortcut", subject), picture("pixel", subject), measure)
    };
    let texture = |measure| {
        Claim::Difference(whole(texels(water("texture", Subject::Water))), picture("pixel", Subject::Water), measure)
    };
    let claim = match figure.column.as_str() {
        "octaves" => known(Wave::PAPER.octaves.into()),
        "wave_size" => known(Wave::PAPER.wave_size),
        "factor" => known(Wave::PAPER.factor),
        "speed" => known(Wave::PAPER.speed),
        "vertex_size" => known(Wave::PAPER.vertex_size),
        "sun_disc_degrees" => Claim::Known(sun_disc()),
        "absorbed_per_metre" => Claim::Absorbed(picture("pixel", Subject::Water), picture("pixel", CLEAR)),
        "useful_rays_least" | "useful_rays_most" => Claim::Useful(Beam::Hemisphere),
        "useful_vertical_rays" => Claim::Useful(Beam::Vertical),
        "texture_work_exponent" => Claim::Work(textures[0], textures[1]),
        "pixel_work_exponent" => Claim::Work(pixels[0], pixels[1]),
        "texture_time_exponent" => Claim::Time(textures[0], textures[1]),
        "pixel_time_exponent" => Claim::Time(pixels[0], pixels[1]),
        "texture_time_over_pixel" => return Ok(Asked::Times(whole(textures[1]), pixels[1])),
        "texture_flip" => texture("flip"),
        "texture_relmse" => texture("relmse"),
        "shortcut_flip" => shortcut("flip"),
        "shortcut_relmse" => shortcut("relmse"),
        "shortcut_relmse_fitted" => shortcut(FITTED),
        "shortcut_contrast_deeper" => Claim::Contrast(picture("shortcut", DEEP), picture("shortcut", SHALLOW)),
        "contrast_at_60_degrees" => Claim::Contrast(picture("inverse", SEA_LOW), picture("inverse", SEA_HIGH)),
        "pixel_error_over_vertex" => Claim::Better(
            picture("pixel", Subject::Water),
            Place { variant: water("vertex", Subject::Water), side: SIDE, part: Part::Water },
        ),
        _ => return Err("it is the scene's: no run measures it".to_owned()),
    };
    Ok(Asked::Claim(claim))
}

/// The sun's angle by the paper's own numbers, degrees: at its mean distance, at the greatest and at the least.
fn sun_disc() -> Interval {
    let [across, near, far] = SUN;
    let at = |distance: f64| 2.0 * (0.5 * across / distance).atan().to_degrees();
    Interval { value: at(0.5 * (near + far)), low: at(far), high: at(near) }
}

impl Claim {
    /// All that must be run for it.
    pub fn places(&self) -> Vec<Place> {
        match self {
            Self::Known(_) | Self::Useful(_) => Vec::new(),
            Self::Work(a, b)
            | Self::Time(a, b)
            | Self::Difference(a, b, _)
            | Self::Contrast(a, b)
            | Self::Absorbed(a, b)
            | Self::Better(a, b) => vec![*a, *b],
        }
    }

    /// Of them those whose time it asks.
    pub fn timed(&self) -> Vec<Place> {
        if let Self::Time(..) = self { self.places() } else { Vec::new() }
    }

    /// The rays backward that it asks for.
    pub fn beam(&self) -> Option<Beam> {
        if let Self::Useful(beam) = self { Some(*beam) } else { None }
    }

    /// Its value.
    ///
    /// # Errors
    /// Why there is none.
    pub fn measure(&self, run: &Run) -> Result<Interval, String> {
        let of = |place: &Place| run.find(*place).map(|at| &run.all[at]);
        match self {
            Self::Known(known) => Ok(*known),
            Self::Work(a, b) => {
                let [less, more] = [work(of(a)?, a.part)?, work(of(b)?, b.part)?];
                Ok(Interval::exact(exponent(more / less)))
            }
            Self::Time(a, b) => {
                let Interval { value, low, high } = ratio(run, *a, *b)?.interval;
                Ok(Interval { value: exponent(value), low: exponent(low), high: exponent(high) })
            }
            Self::Difference(a, b, measure) => difference(of(a)?, of(b)?, measure),
            Self::Contrast(a, b) => Ok(Interval::exact(contrast(of(a)?)? / contrast(of(b)?)?)),
            Self::Absorbed(a, b) => {
                let left = mean(of(a)?)? / mean(of(b)?)?;
                Ok(Interval::exact(1.0 - left.powf(1.0 / DEPTH)))
            }
            Self::Better(a, b) => {
                let error = |m: &Measured| m.fitted.map(|fit| fit.relmse.value).ok_or("was not judged".to_owned());
                Ok(Interval::exact(error(of(a)?)? / error(of(b)?)?))
            }
            Self::Useful(beam) => {
                let found = run.useful.iter().find(|(known, _)| known == beam);
                found.map(|(_, useful)| share(*useful)).ok_or_else(|| "no ray was sent".to_owned())
            }
        }
    }
}

/// Of what grows so many times from one picture to the larger.
fn exponent(times: f64) -> f64 {
    times.ln() / f64::from(LARGER * LARGER).ln()
}

/// Invocations of a part's stages, or fragments.
fn work(measured: &Measured, part: Part) -> Result<f64, String> {
    let sum: u64 = measured.work.iter().filter(|(stage, _)| part.holds(stage)).map(|(_, count)| count).sum();
    if sum > 0 { Ok(sum as f64) } else { Err("this device counts no invocations".to_owned()) }
}

fn difference(of: &Measured, from: &Measured, measure: &str) -> Result<Interval, String> {
    let picture =
        |m: &Measured| Picture { file: m.variant.name(), layers: m.layers.clone(), about: m.provenance.attributes() };
    let found = compare::compare(&picture(of), &picture(from), LAYER).map_err(|error| error.to_string())?;
    let fitted = found.fitted.filter(|_| measure == FITTED).map(|fit| fit.relmse);
    let plain = MEASURES.iter().position(|name| *name == measure).map(|at| found.measures[at]);
    fitted.or(plain).map(|known| Interval::exact(known.value)).ok_or_else(|| format!("there is no {measure}"))
}

/// Mean of the bands of each pixel, W/m².
fn light(measured: &Measured) -> Result<Vec<f64>, String> {
    let layer = measured.layers.get(LAYER).ok_or_else(|| format!("the picture has no {LAYER}"))?;
    let mean = |bands: &[f32]| bands.iter().map(|v| f64::from(*v)).sum::<f64>() / bands.len() as f64;
    Ok(layer.pixels().map(mean).collect())
}

fn mean(measured: &Measured) -> Result<f64, String> {
    let light = light(measured)?;
    let mean = light.iter().sum::<f64>() / light.len().max(1) as f64;
    if mean > 0.0 { Ok(mean) } else { Err("the picture is dark".to_owned()) }
}

fn contrast(measured: &Measured) -> Result<f64, String> {
    let (light, mean) = (light(measured)?, mean(measured)?);
    let variance = light.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / light.len() as f64;
    if variance > 0.0 { Ok(variance.sqrt() / mean) } else { Err("the picture is even".to_owned()) }
}

/// With the score interval of Wilson 1927, which has an answer where no ray met anything.
fn share(Useful { rays, met }: Useful) -> Interval {
    let (n, p) = (rays.max(1) as f64, met as f64 / rays.max(1) as f64);
    let z2 = NORMAL_99 * NORMAL_99;
    let middle = (p + 0.5 * z2 / n) / (1.0 + z2 / n);
    let half = NORMAL_99 * (p * (1.0 - p) / n + 0.25 * z2 / (n * n)).sqrt() / (1.0 + z2 / n);
    Interval { value: p, low: (middle - half).max(0.0), high: (middle + half).min(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_suns_angle_is_not_quite_what_the_paper_says() {
        let disc = sun_disc();
        assert!((disc.low - 0.535).abs() < 1e-3 && (disc.high - 0.553).abs() < 1e-3, "{disc:?}");
        assert!(disc.low < disc.value && disc.value < disc.high);
    }

    /// Of 0 in n the upper end is z²/(n + z²).
    #[test]
    fn shares_have_intervals_where_nothing_was_met_too() {
        let none = share(Useful { rays: 1000, met: 0 });
        assert!(none.value == 0.0 && none.low == 0.0 && (none.high - 6.634_9 / 1_006.634_9).abs() < 1e-6, "{none:?}");
        let half = share(Useful { rays: 1000, met: 500 });
        assert!((half.low + half.high - 1.0).abs() < 1e-12 && half.contains(0.5), "{half:?}");
    }

    #[test]
    fn what_grows_with_the_pixels_has_exponent_one() {
        assert_eq!([exponent(1.0), exponent(f64::from(LARGER * LARGER))], [0.0, 1.0]);
    }
}
