//! Finished truths in the store.

use super::{TRUTHS, subject::Subject};
use crate::{
    image::{Layers, Provenance},
    lab::Picture,
    store::Store,
    truth::VERSION,
};

/// The least noisy truth of a subject, whoever made it. Cells of light are left out: their error is no noise, and no
/// interval could be made of it.
pub fn least_noisy(store: &Store, subject: &Subject) -> Option<Picture> {
    let task = subject.task();
    let [width, height] = task.size;
    let wanted = [
        ("kind", "truth".to_owned()),
        ("truth.version", VERSION.to_string()),
        ("scene.hash", subject.scene.source.hash.clone()),
        ("estimator", task.estimator.to_string()),
        ("paths", task.paths.to_string()),
        ("camera", task.camera),
        ("size", format!("{width}x{height}")),
    ];
    let fits = |about: &Provenance| wanted.iter().all(|(name, text)| about.get(*name) == Some(text));
    let noise = |about: &Provenance| about.get("noise.relmse")?.parse().ok().filter(|noise: &f64| noise.is_finite());
    let fitting = store.list(TRUTHS).into_iter().filter_map(|entry| {
        let bytes = store.get(TRUTHS, &entry.key)?;
        let about = Layers::provenance_of_exr(&bytes).ok().filter(fits)?;
        Some((noise(&about)?, bytes))
    });
    let (_, bytes) = fitting.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let (layers, about) = Layers::from_exr(&bytes).ok()?;
    Some(picture(layers, about))
}

/// A truth as a picture to judge by. Without specular objects or light it has no caustic: it is dark, and known to be.
pub(in crate::lab) fn picture(mut layers: Layers, about: Provenance) -> Picture {
    let values = 3 * layers.width() * layers.height();
    for name in [super::CAUSTIC.to_owned(), format!("{}.variance", super::CAUSTIC)] {
        if layers.get(&name).is_none() {
            layers.push(&name, 3, vec![0.0; values]).expect("a layer of three bands fits, and was not there");
        }
    }
    Picture { file: "truth".to_owned(), layers, about }
}
