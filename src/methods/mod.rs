//! Floor 3: one room per paper. A method adds its passes to a plan; it knows no other method, and no device. One that
//! shoots photons asks [`light`](crate::passes::light) for them; the frame knows nothing of them.
//!
//! To add one: a room here, a folder of shaders under `glsl/`, and a row in [`ALL`].

pub mod maps;
pub mod waves;

use crate::{
    gpu::{BufferId, Feature, ImageId},
    names::NoSuch,
    passes::{
        PlanError, Work,
        account::Account,
        eye::SurfaceProvider,
        light::{Shot, Shots},
    },
    scene::{Region, Scene},
    settings::{Setting, Settings},
};

/// What a picture came of, for those who judge it.
#[derive(Clone, Copy, Debug)]
pub struct Outcome<'a> {
    /// Its scene.
    pub scene: &'a Scene,
    /// What the camera is there for: the region, or the scene's extent.
    pub receiver: &'a Region,
    /// As set.
    pub settings: &'a Settings,
    /// Where its photons went.
    pub account: &'a Account,
}

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

/// What a method offers once it is planned.
#[derive(Clone, Debug, Default)]
pub struct Provided {
    /// The slot `surface`.
    pub surface: Option<SurfaceProvider>,
    /// Images whose texels hold the flux deposited, W.
    pub deposits: Vec<ImageId>,
    /// What a method counts itself, where it traces more than the photon buffer holds.
    pub tally: Option<Tally>,
    /// What a method leaves out of its light.
    pub left_out: Option<LeftOut>,
    /// Its photons; without any, there is no account of them.
    pub photons: Shots,
}

/// A method, planned.
pub enum Planned {
    /// Its passes are in the plan.
    Provided(Provided),
    /// The scene cannot show what it makes: why. Nothing was planned.
    LeftOut(&'static str),
}

impl Planned {
    /// Of what takes photons.
    pub fn of<T>(shot: Shot<T>, provide: impl FnOnce(&T) -> Provided) -> Self {
        match shot {
            Shot::Taken(taker, photons) => Self::Provided(Provided { photons, ..provide(&taker) }),
            Shot::Nothing(reason) => Self::LeftOut(reason),
        }
    }
}

/// A method's own count. Its buffer holds nine words: what arrived in the map, W, and what of it is known as points alone
/// (float32, three bands each); then how many cells were traced finer, how many were to be, but were too many, and the light
/// samples that this took.
#[derive(Clone, Copy, Debug)]
pub struct Tally {
    /// The buffer.
    pub buffer: BufferId,
    /// Light samples traced besides in every frame.
    pub samples: u64,
}

/// What a method without photons leaves out of its light. Its buffer is written by a pass of the account: pairs of words, pieces of
/// light without any way on, and those that some of their corners have.
#[derive(Clone, Copy, Debug)]
pub struct LeftOut {
    /// The buffer.
    pub buffer: BufferId,
    /// Pieces in all.
    pub pieces: u64,
}

/// A picture in the chain of a method's error budget; neighbours differ in one thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// The truth of all paths.
    AllPaths,
    /// The truth of the class of paths that is traced.
    PathClass,
    /// The landing points of the tracer's photons on a fine grid of light samples, binned exactly.
    Landings,
    /// What the method makes of the photons of that fine grid.
    Fine,
    /// The picture as it comes.
    AsAsked,
}

/// A picture of the chain, and the step that leads to it from the one before.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// The picture.
    pub shown: Shown,
    /// The step; of the first picture, nothing.
    pub step: &'static str,
    /// The settings that this picture is the first to depend on: they move this step, and none before it.
    pub moved_by: &'static [&'static str],
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
    /// What it needs of a device, as set, beyond what every frame does: nothing, if it does not say.
    fn needs(&self, _: &Settings) -> Vec<Feature> {
        Vec::new()
    }

    /// Its settings.
    fn settings(&self) -> &'static [Setting] {
        &[]
    }

    /// Settings that another one decides, and their values then.
    fn decided(&self, _: &Settings, _: &Scene) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// Whether it shoots photons, which are then counted and reported.
    fn shoots(&self) -> bool {
        false
    }
    /// Whether, as set, its slot `surface` is irradiance only up to a scale, which then is fitted wherever errors are told.
    fn is_relative(&self, _: &Settings) -> bool {
        false
    }
    /// Eye samples along an axis that a pixel has where nobody says: where, as set, one has the pixel's mean already.
    fn eye_samples(&self, _: &Settings) -> Option<u32> {
        None
    }
    /// Settings of light that it reads, of a method that shoots no photons, besides the class of paths.
    fn reads(&self) -> &'static [&'static str] {
        &[]
    }
    /// Whether the kind of device ([`Settings::on`]) decides what it plans.
    fn hangs_on_device(&self, _: &Settings, _: &Scene) -> bool {
        false
    }
    /// Its stages, which `plan` lists as left out where the scene cannot show what they make.
    fn stages(&self) -> &'static [&'static str];
    /// What its picture does not show well, and the remedy.
    fn warnings(&self, _: &Outcome<'_>) -> Vec<String> {
        Vec::new()
    }

    /// Where its error comes from: the pictures of `nephroid budget`, from the truth of all paths to the picture as it
    /// comes.
    fn chain(&self) -> &'static [Link] {
        &[]
    }

    /// Adds its passes to the plan.
    fn plan(&self, work: &mut Work<'_>) -> Result<Planned, PlanError>;
}

/// Every method, sorted by name. Command line, tests and reports iterate over this.
pub static ALL: &[&dyn Method] = &[&maps::Maps, &waves::Waves];

/// The method of that name.
///
/// # Errors
/// Names the ones near it, or all; `none` is one of them, for the user who wants none.
pub fn find(name: &str) -> Result<&'static dyn Method, NoSuch> {
    let known = || ALL.iter().map(|m| m.name()).chain(["none"]);
    ALL.iter().copied().find(|m| m.name() == name).ok_or_else(|| NoSuch::new("method", name, known()))
}
