//! The truths of a budget, from the store, or made and kept there.

use std::{ops::ControlFlow, time::Instant};

use super::{Progress, Watch};
use crate::{
    image::Layers,
    lab::{
        LabError, Picture,
        reference::{self, SUMS, TRUTHS},
    },
    scene::Scene,
    store::Store,
    truth::{Run, Standing, Task, trace::Space},
};

/// The truth of a task. After `seconds` it is taken as it is: its noise is known.
pub(super) fn truth(
    scene: &Scene,
    task: &Task,
    store: &Store,
    seconds: f64,
    watch: Watch,
) -> Result<Picture, LabError> {
    let key = task.key(scene);
    let stored = store.get(TRUTHS, &key).and_then(|bytes| Layers::from_exr(&bytes).ok());
    if let Some((layers, about)) = stored {
        return Ok(reference::picture(layers, about));
    }
    let (space, started) = (Space::new(scene), Instant::now());
    let mut told = |standing: Option<Standing>| watch(&Progress::Truth(standing));
    let run = Run::watched(&space, &scene.cameras[&task.camera], task, &mut |_| told(None));
    let mut run = run.ok_or(LabError::Interrupted)?;
    let sums = task.sums_key(scene);
    if let Some(before) = store.get(SUMS, &sums) {
        run.resume(&before); // of another size they would be left alone
    }
    let mut stopped = false;
    let standing = run.advance(rayon::current_num_threads(), |_, standing| {
        stopped = told(Some(standing)).is_break();
        let late = started.elapsed().as_secs_f64() >= seconds;
        if stopped || late { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    if !standing.finished {
        store.put(SUMS, &sums, &run.checkpoint());
        if stopped {
            return Err(LabError::Interrupted);
        }
    }
    let (layers, about) = (run.layers()?, run.provenance());
    if standing.finished {
        store.put(TRUTHS, &key, &layers.to_exr(&about)?);
    }
    Ok(reference::picture(layers, about))
}
