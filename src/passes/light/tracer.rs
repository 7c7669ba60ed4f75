//! Which tracer fills the photon columns, and what each cannot do.

use glam::DVec3;

use super::{
    Emission,
    images::{Bench, Images},
};
use crate::{
    gpu::{PassBuilder, Phase, Plan},
    passes::{PlanError, extents},
    scene::{MaterialKind, PathClass, Scene},
    settings::Choice,
};

/// The tracer.
pub static TRACER: Choice = Choice {
    key: "light.tracer",
    default: "bvh",
    words: &["bvh", "fixed-point", "march", "wyman2005"],
    doc: "bvh: exact intersection; the others estimate in images that the light sees: wyman2005 the way through a body at \
          once, fixed-point by three rounds of it, march by marching and bisection",
};

/// What becomes of light that is totally reflected inside a body.
pub static TOTAL_REFLECTION: Choice = Choice {
    key: "light.total_reflection",
    default: "drop",
    words: &["drop", "follow"],
    doc: "light totally reflected inside a body, in class transmit-2: drop: it ends (Wyman 2005), being of no such chain; \
          follow: it goes on inside up to 8 times, and what gets out counts (Davis and Wyman 2007), with any tracer",
};

/// Which back face the image-space tracers know.
pub static BACK: Choice = Choice {
    key: "light.back",
    default: "farthest",
    words: &["nearest", "farthest"],
    doc: "faces turned from the light that the image-space tracers see: the first along the light's ray, or the last \
          (behind the dents of one body; nearest, where bodies stand behind each other)",
};

/// Total reflections that are followed; the paper shows three, and says that more are rarely seen.
const FOLLOWED: u32 = 8;

/// Points of an object that are asked whether another holds them.
const ASKED: usize = 64;

/// A tracer, planned.
pub struct Tracer {
    follows: bool,
    images: Option<Images>,
}

impl Tracer {
    /// Adds what its views need before the first of them is traced.
    pub fn plan(plan: &mut Plan, bench: &Bench<'_>) -> Result<Self, PlanError> {
        let (name, class) = (bench.settings.choice(&TRACER), bench.class);
        let follows = bench.settings.choice(&TOTAL_REFLECTION) == "follow";
        if follows && class != PathClass::Transmit2 {
            return Err(PlanError::Refused {
                what: format!("light.total_reflection=follow in class {class}"),
                reason: "only in class transmit-2 can light go on inside a body and still be of its chain".into(),
                remedy: "set light.paths=transmit-2, or light.total_reflection=drop".into(),
            });
        }
        if name == "bvh" {
            return Ok(Self { follows, images: None });
        }
        check(bench, name)?;
        Ok(Self { follows, images: Some(Images::plan(plan, bench, name)?) })
    }

    /// Adds the images that the next dispatch over view `index` reads, in its phase.
    pub fn images(&self, plan: &mut Plan, bench: &Bench<'_>, phase: Phase, index: usize) {
        if let Some(images) = &self.images {
            images.draw(plan, bench, phase, index);
        }
    }

    /// Gives a dispatch over view `index` the tracer and what it reads.
    pub(super) fn give<'p>(&self, pass: PassBuilder<'p>, emission: &Emission, index: usize) -> PassBuilder<'p> {
        let pass = if self.follows { pass.define("FOLLOWED", FOLLOWED) } else { pass };
        match &self.images {
            Some(images) => images.give(pass, emission, index),
            None => pass,
        }
    }
}

/// What no image of the light's shows.
fn check(bench: &Bench<'_>, name: &str) -> Result<(), PlanError> {
    let (scene, class) = (bench.scene, bench.class);
    let refused = |what: &str, reason: String| {
        Err(PlanError::Refused {
            what: format!("light.tracer={name} with {what}"),
            reason,
            remedy: "use light.tracer=bvh".into(),
        })
    };
    match class {
        PathClass::All(_) => {
            return refused(&format!("class {class}"), "its images show one surface before and one behind".into());
        }
        PathClass::Reflect1 | PathClass::Transmit1 => return Ok(()),
        PathClass::Transmit2 => {}
    }
    if let Some((inner, outer)) = nested(scene) {
        let reason = format!("the object lies in '{outer}', and light between two bodies is in no image");
        return refused(&format!("the object '{inner}' in class {class}"), reason);
    }
    for emission in bench.emissions {
        let light = &scene.lights[emission.light];
        if emission.position.is_some_and(|p| !scene.media_at(p).is_empty()) {
            let reason = "it stands inside a body, and the body that its light would go through then has no front";
            return refused(&format!("the light '{}' in class {class}", light.name), reason.into());
        }
    }
    Ok(())
}

/// A specular object that lies in another medium, and that medium's name.
fn nested(scene: &Scene) -> Option<(&str, &str)> {
    let holds =
        scene.objects.iter().filter(|o| matches!(scene.materials[o.material].kind, MaterialKind::Dielectric { .. }));
    if holds.count() < 2 && scene.objects.iter().filter(|o| scene.materials[o.material].is_specular()).count() < 2 {
        return None; // asking costs a walk over every triangle
    }
    scene.objects.iter().filter(|o| scene.materials[o.material].is_specular()).find_map(|object| {
        let points = extents::points_on(object);
        let step = points.len().div_ceil(ASKED).max(1);
        let medium = |p: &DVec3| scene.media_at(*p).into_iter().find(|&medium| medium != object.material);
        let outer = points.iter().step_by(step).find_map(medium)?;
        Some((object.name.as_str(), scene.materials[outer].name.as_str()))
    })
}
