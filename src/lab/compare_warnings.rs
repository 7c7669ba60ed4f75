//! What differs between a picture and its reference that should not: the figures stand, and this is said beside them.

use super::{
    Picture,
    compare::Sides,
    compare_scene::{difference, paths},
};
use crate::image::Layer;

/// Pixels across from which one sample each is fine enough to be judged.
const FINE: usize = 512;
/// What a method gives.
const CAUSTIC: &str = "irradiance.caustic";

/// In words, each with the file that it is about.
pub fn warnings(image: &Picture, reference: &Picture, sides: &Sides) -> Vec<String> {
    let variance = reference.layers.get(&format!("{}.variance", sides.r.name()));
    let unknown = (variance.is_some() && sides.variance.is_none())
        .then(|| format!("{}: its noise is infinite somewhere, so that of the figures is not known", reference.file));
    let all = [
        unknown,
        no_numbers(image, sides.x, &sides.judged, |value| value.is_finite()),
        no_numbers(reference, sides.r, &sides.judged, |value| value.is_finite()),
        sides.variance.and_then(|v| no_numbers(reference, v, &sides.judged, |v| v.is_finite() && v >= 0.0)),
        other_scene(image, reference),
        other_paths(image, reference),
        one_sample(image, reference, sides.x.name()),
    ];
    all.into_iter().flatten().collect()
}

/// Values that make every figure infinite, and where the first is.
fn no_numbers(of: &Picture, layer: &Layer, judged: &[bool], fine: fn(f32) -> bool) -> Option<String> {
    let values = layer.data().iter().enumerate().filter(|(at, _)| judged[at / layer.channels()]);
    let mut bad = values.filter(|(_, value)| !fine(**value));
    let (first, value) = bad.next()?;
    let (pixel, width) = (first / layer.channels(), of.layers.width());
    let (file, name, count, x, y) = (&of.file, layer.name(), 1 + bad.count(), pixel % width, pixel / width);
    Some(format!(
        "{file}: {count} values of `{name}` cannot be judged, the first, {value}, at {x} from the left and {y} from the \
         top: every figure is infinite"
    ))
}

fn other_scene(image: &Picture, reference: &Picture) -> Option<String> {
    let [ours, theirs] = [image, reference].map(|p| p.about.get("scene.hash"));
    (ours? != theirs?).then(|| {
        let what = difference(&image.about, &reference.about);
        format!("{}: its scene is not that of {}: {what}", image.file, reference.file)
    })
}

fn other_paths(image: &Picture, reference: &Picture) -> Option<String> {
    let (ours, theirs) = (paths(&image.about)?, paths(&reference.about)?);
    let [image, reference] = [image, reference].map(|p| &p.file);
    (ours != theirs).then(|| format!("{image}: its paths are {ours}, those of {reference} {theirs}"))
}

/// The truth is box-filtered over each pixel: against it, one sample has an error that is no fault of the method's.
fn one_sample(image: &Picture, reference: &Picture, layer: &str) -> Option<String> {
    let [ours, theirs] = [image, reference].map(|p| p.about.get("settings.eye.samples").is_some_and(|k| k == "1"));
    let [width, height] = image.size();
    (ours && !theirs && !image.is_filtered(layer) && width.max(height) < FINE).then(|| {
        // Where the method's own layer needs one alone, that is what is taken where nothing is set.
        let remedy =
            if image.is_filtered(CAUSTIC) { "with --set eye.samples=4" } else { "without --set eye.samples=1" };
        let file = &image.file;
        format!(
            "{file}: one eye sample a pixel at {width}x{height} adds an error that is not the method's: render the \
             image again {remedy}"
        )
    })
}
