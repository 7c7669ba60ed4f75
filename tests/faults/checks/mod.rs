//! The checks: each renders one scene with the shaders it is given and says how far it is from what is known.

pub mod caustic;
pub mod floor;
pub mod light;
pub mod merged;

use crate::common::{
    assert_quiet,
    picture::{Picture, rewritten, worst, written},
};
use nephroid::{
    gpu::{Gpu, Sources},
    passes::account::Account,
    renderer::{Frame, Job, Renderer},
    scene::{LightKind, Scene},
};

/// A figure that is 0 where all is well, and what it may come to.
pub struct Check {
    /// What it looks at.
    pub name: &'static str,
    /// The greatest figure that sound shaders may have; its constant says why.
    pub bound: f64,
    /// Renders and measures.
    pub figure: fn(&Gpu, &Sources) -> f64,
}

impl Check {
    /// The figure's size; infinite if it is no number.
    pub fn judge(&self, gpu: &Gpu, sources: &Sources) -> f64 {
        worst([(self.figure)(gpu, sources)])
    }
}

/// A frame, silent under validation. Unlike `common::picture::picture` it lets NaN pass: the figure has to notice.
fn render(gpu: &Gpu, sources: &Sources, job: &Job) -> Picture {
    let mut renderer = Renderer::with_sources(gpu, job, sources.clone()).unwrap_or_else(|error| panic!("{error}"));
    renderer.frame(&Frame::default()).expect("a frame is rendered");
    let account = renderer.account().expect("photons are counted");
    let energy = renderer.energy(&account).expect("the map is read");
    let layers = renderer.layers().expect("the layers are read");
    assert_quiet(gpu);
    Picture { renderer, layers, account, energy }
}

/// The account alone: no frame, no picture.
fn count(gpu: &Gpu, sources: &Sources, job: &Job) -> Account {
    let mut renderer = Renderer::with_sources(gpu, job, sources.clone()).unwrap_or_else(|error| panic!("{error}"));
    let account = renderer.account().expect("photons are counted");
    assert_quiet(gpu);
    account
}

/// A shipped scene's text, passages of it replaced, under a lamp in the place of the sun.
fn under_a_lamp(name: &str, replaced: &[(&str, &str)], position: [f64; 3], intensity: f64) -> Scene {
    let text = rewritten(name, replaced, "\n[lights.lamp.point]\nposition = [0, 9, 0]\nintensity = 1.0\n");
    let mut scene = written(&text, &[]);
    scene.lights.retain(|light| light.name == "lamp");
    scene.lights[0].kind = LightKind::Point { position: position.into(), intensity: [intensity; 3] };
    scene
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
