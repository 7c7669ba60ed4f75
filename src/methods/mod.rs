//! Floor 3: one room per paper. A method adds its passes to a plan; it knows no other method, and no device.
//!
//! To add one: a room here, a folder of shaders under `glsl/`, and a row in [`ALL`].

pub mod maps;

use crate::{
    gpu::{Feature, ImageId, Plan, Resource},
    names::NoSuch,
    passes::{
        PlanError,
        extents::Receiver,
        eye::SurfaceProvider,
        light::{Column, Emission, Photons},
    },
    scene::Scene,
    settings::{Setting, Settings},
    view::Extent,
};

/// What a method fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// Irradiance of surfaces, W/m².
    Surface,
    /// Radiance of the medium, W/m²/sr.
    Medium,
}

impl Slot {
    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Surface => "surface",
            Self::Medium => "medium",
        }
    }
}

/// What a method plans with.
pub struct Job<'a> {
    /// The plan to add to.
    pub plan: &'a mut Plan,
    /// The settings.
    pub settings: &'a Settings,
    /// The scene.
    pub scene: &'a Scene,
    /// The rectangles to cover: the receiver region or the scene's extent first, then what else may be seen.
    pub receivers: &'a [Receiver],
    /// All that the scene holds.
    pub everything: &'a Extent,
    /// The emission views, in the order in which they come.
    pub emissions: &'a [Emission],
    /// The photon buffer, filled anew for each view.
    pub photons: &'a Photons,
}

/// What a method offers once it is planned.
#[derive(Clone, Debug)]
pub struct Provided {
    /// The slot `surface`.
    pub surface: Option<SurfaceProvider>,
    /// Images whose texels hold the flux deposited, W.
    pub deposits: Vec<ImageId>,
}

/// A method being planned.
pub trait Planned {
    /// Which photons it takes: a file that defines `captured`, and what it reads.
    fn capture(&self) -> (&'static str, Vec<(&'static str, Resource)>);

    /// Takes the photons of one view, which lie in the photon buffer after the pass before.
    fn gather(&mut self, job: &mut Job<'_>, view: usize, name_of: &dyn Fn(&str) -> String);

    /// What it offers to the eye.
    fn provide(&self) -> Provided;
}

/// A method of a paper.
pub trait Method: Sync {
    /// The name on the command line.
    fn name(&self) -> &'static str;
    /// One line: what it does.
    fn title(&self) -> &'static str;
    /// The paper.
    fn paper(&self) -> &'static str;
    /// What it fills.
    fn slots(&self) -> &'static [Slot];
    /// What it needs of a device beyond what every frame does.
    fn needs(&self) -> &'static [Feature];
    /// Its settings.
    fn settings(&self) -> &'static [Setting];
    /// The photon columns it reads.
    fn columns(&self) -> &'static [Column];
    /// Whether it wants them all in float16.
    fn halves(&self, _: &Settings) -> bool {
        false
    }
    /// Its stages, which `plan` lists as left out where no photon can come.
    fn stages(&self) -> &'static [&'static str];
    /// Begins planning: images and buffers that all views share.
    fn plan(&self, job: &mut Job<'_>) -> Result<Box<dyn Planned>, PlanError>;
}

/// Every method, sorted by name. Command line, tests and reports iterate over this.
pub static ALL: &[&dyn Method] = &[&maps::Maps];

/// The method of that name.
///
/// # Errors
/// Names the ones near it, or all; `none` is one of them, for the user who wants none.
pub fn find(name: &str) -> Result<&'static dyn Method, NoSuch> {
    let known = || ALL.iter().map(|m| m.name()).chain(["none"]);
    ALL.iter().copied().find(|m| m.name() == name).ok_or_else(|| NoSuch::new("method", name, known()))
}
