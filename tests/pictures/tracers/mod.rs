//! The image-space tracers against the exact one, and against what is known in closed form.

mod accounts;
mod forms;
mod hard;
mod planned;

use std::ops::ControlFlow;

use nephroid::{
    gpu::Gpu,
    lab::{Compared, Figures, compare_tracers},
    passes::light::TRACER,
    renderer::Job,
    scene::Scene,
};

use crate::common::{assert_quiet, picture::job_of};

/// Coordinates of a few metres in float32, through two images, an interface and a landing.
const ROUNDING: f64 = 5e-6;

/// The image-space tracers.
fn tracers() -> impl Iterator<Item = &'static str> {
    TRACER.words.iter().copied().filter(|name| *name != "bvh")
}

/// Every tracer on a scene; map texels of one metre.
fn compare(gpu: &Gpu, scene: &Scene, set: &[(&str, &str)]) -> Vec<Compared> {
    let job: Job = job_of(scene.clone(), set, "region", [8, 8]);
    let compared = compare_tracers(gpu, &job, 1, 1.0, &mut |_| ControlFlow::Continue(()));
    assert_quiet(gpu);
    compared.unwrap_or_else(|error| panic!("{error}"))
}

/// One tracer's figures.
fn figures<'a>(compared: &'a [Compared], tracer: &str) -> &'a Figures {
    let found = compared.iter().find(|c| c.tracer == tracer).expect("every tracer is run");
    found.result.as_ref().unwrap_or_else(|refused| panic!("{tracer}: {refused}"))
}

/// Nothing lost, nothing invented, no landing further off than this, m.
#[track_caller]
fn holds(what: &str, figures: &Figures, metres: f64) {
    let worst = figures.landing_m.expect("something arrives").worst;
    println!("{what}: landing {worst:.1e} m, lost {}, invented {}", figures.false_loss, figures.false_hits);
    assert!(worst <= metres, "{what}: {worst} m off, of {metres}");
    assert_eq!((figures.false_loss, figures.false_hits), (0.0, 0.0), "{what}");
}
