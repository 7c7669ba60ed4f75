//! Says where photons are too few for their splats to touch.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use super::{Axes, Outcome, SIDE, SPLAT_SIZE};
use crate::{
    passes::light::{self, Emission},
    scene::Region,
    settings::Whole,
};

/// How far apart the photons of a light lie on a receiver whose light nothing has gathered or spread, m, in the worse of
/// the two directions. Light that a mirror turns may fall on it from anywhere: straight on, where they are nearest.
fn apart(emission: &Emission, receiver: &Region, side: f64) -> f64 {
    let view = &emission.view;
    let metres = if view.perspective { (receiver.center - view.origin).length() } else { 1.0 };
    (view.high - view.low).abs().max_element() * metres / side
}

/// A warning where no fixed splat reaches the middle between four photons of an evenly lit receiver: there it has gaps.
/// Splats that follow their neighbours' distance leave none. Nothing is said where so many photons arrive that they would
/// touch all over the map: then light is gathered.
pub fn warning(shown: &Outcome<'_>) -> Option<String> {
    let Outcome { scene, receiver, settings, account } = *shown;
    if Axes::of(settings, scene).splat != "fixed" {
        return None;
    }
    let emissions = light::emissions(scene, settings, receiver).ok()?;
    let [photons, side, wide] = [&light::SIDE, &SIDE, &SPLAT_SIZE].map(|s| f64::from(settings.whole(s)));
    let texels = |emission: &Emission| match settings.choice(&light::VIEW) {
        "shared" => side / photons, // one view for both
        _ => apart(emission, receiver, photons) / (2.0 * receiver.u.length().min(receiver.v.length()) / side),
    };
    let worst = emissions.iter().map(texels).fold(0.0, f64::max);
    let on_average = side / (account.valid() as f64).sqrt();
    let reached = wide * FRAC_1_SQRT_2;
    (worst > reached && on_average > reached && account.valid() > 0).then(|| {
        let ways = [
            way("raise", &light::SIDE, (photons * worst / reached).ceil()),
            way("raise", &SPLAT_SIZE, (worst * SQRT_2).ceil()),
            way("lower", &SIDE, (side * reached / worst).floor()),
        ];
        let ways: Vec<_> = ways.into_iter().flatten().collect();
        format!(
            "photons of {photons} a side lie {worst:.1} texels of the caustic map apart where light is neither gathered nor \
             spread, and their splats, {wide} wide, leave dark gaps; {}",
            ways.join(", or ")
        )
    })
}

/// What to set, where that may be set.
fn way(verb: &str, setting: &Whole, to: f64) -> Option<String> {
    let whole = setting.range.contains(&(to as u32)).then_some(to as u32)?;
    Some(format!("{verb} {} to {whole}", setting.key))
}
