#![doc = include_str!("README.md")]
//! Based on: J. Guardado and D. Sánchez-Crespo, *Rendering Water Caustics*, GPU Gems (2004), ch. 2. Differs: any height over a
//! rectangle is water, heights and colours are kept in float32, and textures are filtered in the shader, in full precision.

mod grids;
mod inverse;
mod shade;
mod suns;

use grids::{Mesh, Target};

use super::{Link, Method, Outcome, Planned, Provided, Shown, Slot};
use crate::{
    gpu::{PassBuilder, Resource},
    passes::{PlanError, Work, eye::SurfaceProvider, refused, water::Water},
    settings::{Choice, Real, Setting, Settings, Whole},
};

static VARIANT: Choice = Choice {
    key: "waves.variant",
    default: "pixel",
    words: &["inverse", "listing", "pixel", "shortcut", "texture", "vertex"],
    doc: "where the water's light is found: vertex: on a fine mesh, by finite differences; pixel: at every point seen; texture: in a \
          target of fixed resolution, with mip maps; shortcut: pixel without refraction; listing: the code as printed; inverse: ours, all light of each point, in W/m²",
};

static MESH: Whole = Whole {
    key: "waves.mesh",
    unit: "cells",
    default: 128,
    range: 1..=4096,
    doc: "with waves.variant = vertex, cells of the fine mesh along each side of the water",
};

static SIDE: Whole = Whole {
    key: "waves.side",
    unit: "texels",
    default: 512,
    range: 1..=8192,
    doc: "with waves.variant = texture, texels along each side of the target: a power of two",
};

static ANISOTROPY: Whole = Whole {
    key: "waves.anisotropy",
    unit: "probes",
    default: 16,
    range: 1..=16,
    doc: "with waves.variant = texture, how often the target is looked up along a pixel's longer axis, at most",
};

static FILTER: Choice = Choice {
    key: "waves.filter",
    default: "linear",
    words: &["cubic", "linear"],
    doc: "with waves.variant = texture, what lies between texels: linear, as hardware has it, which shows a cross about bright spots; \
          cubic: ours, of 16 texels, with a 45th of its power",
};

static SUN_WIDTH: Real = Real {
    key: "waves.sun_width",
    unit: "degrees",
    // Of the paper's wave, most of what lies within 0.6 of its origin is then lit, and its crests and troughs stand out.
    default: Some(5.0),
    range: 0.0..=180.0,
    doc: "width of the sun in the sun map, where it has half its brightness; 0: the scene's, or 0.53 where that has none; not with \
          waves.variant = inverse, which has the scene's own suns",
};

static SUN_EDGE: Real = Real {
    key: "waves.sun_edge",
    unit: "",
    default: Some(1.0),
    range: 0.0..=1.0,
    doc: "how much of the sun's half width, on both sides of it, is its edge: 0: a sharp disc; 1: bright in the middle alone; \
          not with waves.variant = inverse",
};

static SUN_DISTANCE: Real = Real {
    key: "waves.sun_distance",
    unit: "m",
    default: Some(0.8),
    range: 1e-6..=1e6,
    doc: "with waves.variant = shortcut, depth at which the sun map is waves.sun_width wide; below it the sun is smaller",
};

static ABSORBED: Real = Real {
    key: "waves.absorbed",
    unit: "1/m",
    default: None,
    range: 0.0..=0.999,
    doc: "share of the light that a metre of water takes on its way (the paper: 0.2 to 0.23), of every band alike; else by the scene's \
          absorption; not with waves.variant = listing, which knows no depth",
};

static SCREEN_DEPTH: Choice = Choice {
    key: "waves.screen_depth",
    default: "off",
    words: &["off", "on"],
    doc: "with pixel or shortcut, whether slopes are divided by the distance from the eye where that is below 1 m, as in the listing, \
          which always does",
};

static SETTINGS: &[Setting] = &[
    Setting::Choice(&VARIANT),
    Setting::Whole(&MESH),
    Setting::Whole(&SIDE),
    Setting::Whole(&ANISOTROPY),
    Setting::Choice(&FILTER),
    Setting::Real(&SUN_WIDTH),
    Setting::Real(&SUN_EDGE),
    Setting::Real(&SUN_DISTANCE),
    Setting::Real(&ABSORBED),
    Setting::Choice(&SCREEN_DEPTH),
    Setting::Whole(&inverse::CELLS),
];

static CHAIN: &[Link] = &[
    Link { shown: Shown::AllPaths, step: "", moved_by: &[] },
    Link { shown: Shown::PathClass, step: "path class", moved_by: &["light.paths"] },
    Link {
        shown: Shown::AsAsked,
        step: "variant",
        moved_by: &[
            "waves.variant",
            "waves.mesh",
            "waves.side",
            "waves.anisotropy",
            "waves.filter",
            "waves.sun_width",
            "waves.sun_edge",
            "waves.sun_distance",
            "waves.absorbed",
            "waves.screen_depth",
            "waves.cells",
            "light.area_samples",
            "eye.samples",
        ],
    },
];

/// Water caustics without light: of every point of a receiver the one ray that goes straight up.
pub struct Waves;

impl Method for Waves {
    fn name(&self) -> &'static str {
        "waves"
    }

    fn title(&self) -> &'static str {
        "the ray straight up from the floor, refracted into the air, looked up in a picture of the sun"
    }

    fn paper(&self) -> &'static str {
        "J. Guardado and D. Sánchez-Crespo, Rendering Water Caustics, GPU Gems 2004, ch. 2"
    }

    fn slots(&self) -> &'static [Slot] {
        &[Slot::Surface]
    }

    fn settings(&self) -> &'static [Setting] {
        SETTINGS
    }

    fn eye_samples(&self, settings: &Settings) -> Option<u32> {
        (settings.choice(&VARIANT) == "inverse").then_some(1)
    }

    fn is_relative(&self, settings: &Settings) -> bool {
        settings.choice(&VARIANT) != "inverse"
    }

    fn reads(&self) -> &'static [&'static str] {
        &["light.area_samples"]
    }

    fn stages(&self) -> &'static [&'static str] {
        &["waves/vertices", "waves/texture", "waves/rays", "waves/bounds"]
    }

    fn warnings(&self, shown: &Outcome<'_>) -> Vec<String> {
        if shown.settings.choice(&VARIANT) == "inverse" {
            return inverse::warnings(shown.scene, shown.settings);
        }
        suns::warnings(shown.scene)
    }

    fn chain(&self) -> &'static [Link] {
        CHAIN
    }

    fn plan(&self, work: &mut Work<'_>) -> Result<Planned, PlanError> {
        check(work.settings)?;
        if work.settings.choice(&VARIANT) == "inverse" {
            return inverse(work);
        }
        if let Some(reason) = suns::nothing(work.scene) {
            return Ok(Planned::LeftOut(reason));
        }
        let Some(water) = Water::of(work.plan, work.scene) else { return Ok(Planned::LeftOut(suns::NO_WATER)) };
        let sky = Sky::plan(work, water);
        let surface = match work.settings.choice(&VARIANT) {
            "vertex" => Mesh::plan(work, &sky).provider(&sky),
            "texture" => Target::plan(work, &sky).provider(&sky, work.settings),
            "shortcut" => sky.provider("waves/shortcut.glsl"),
            "listing" => sky.provider("waves/listing.glsl"),
            _ => sky.provider("waves/pixel.glsl"),
        };
        let surface = match work.settings.choice(&SCREEN_DEPTH) {
            "on" => SurfaceProvider { defines: with(surface.defines, "WAVES_SCREEN_DEPTH", 1), ..surface },
            _ => surface,
        };
        Ok(Planned::Provided(Provided { surface: Some(surface), ..Provided::default() }))
    }
}

/// The variant of all light.
fn inverse(work: &mut Work<'_>) -> Result<Planned, PlanError> {
    if let Some(reason) = inverse::nothing(work.scene) {
        return Ok(Planned::LeftOut(reason));
    }
    Ok(match inverse::plan(work)? {
        Some((surface, left_out)) => {
            Planned::Provided(Provided { surface: Some(surface), left_out: Some(left_out), ..Provided::default() })
        }
        None => Planned::LeftOut(suns::NO_WATER),
    })
}

/// What has no meaning together.
fn check(settings: &Settings) -> Result<(), PlanError> {
    let variant = settings.choice(&VARIANT);
    let side = settings.whole(&SIDE);
    if variant == "texture" && !side.is_power_of_two() {
        return Err(PlanError::Refused {
            what: format!("waves.side={side}"),
            reason: "each level of the target's mip maps has half the texels of the one before".into(),
            remedy: format!(
                "use {} or {}",
                side.next_power_of_two() / 2,
                side.next_power_of_two().min(*SIDE.range.end())
            ),
        });
    }
    if settings.choice(&SCREEN_DEPTH) == "on" && ["inverse", "texture", "vertex"].contains(&variant) {
        return Err(PlanError::Refused {
            what: format!("waves.screen_depth=on with waves.variant={variant}"),
            reason: "where it finds its light, no screen is known".into(),
            remedy: "use waves.variant=pixel or shortcut, or waves.screen_depth=off".into(),
        });
    }
    let unused: &[_] = match variant {
        "inverse" => &[
            (Setting::Real(&SUN_WIDTH), "it looks up no sun map, but has the scene's own suns"),
            (Setting::Real(&SUN_EDGE), "it looks up no sun map, but has the scene's own suns"),
        ],
        "listing" => &[(Setting::Real(&ABSORBED), "the printed code knows no depth")],
        _ => &[],
    };
    let unused = unused.iter().map(|(setting, reason)| (*setting, (*reason).to_owned()));
    let of_others = OF_ONE.iter().filter(|(_, owner)| *owner != variant);
    let of_others = of_others.map(|(setting, owner)| (*setting, format!("waves.variant={owner} alone reads it")));
    let Some((set, reason)) = unused.chain(of_others).find(|(setting, _)| settings.is_set(*setting)) else {
        return Ok(());
    };
    let what = format!("{}={} with waves.variant={variant}", set.key(), settings.text(set));
    refused(what, reason, &format!("do not set {}, or use another waves.variant", set.key()))
}

/// Settings that one variant alone reads.
static OF_ONE: [(Setting, &str); 6] = [
    (Setting::Whole(&MESH), "vertex"),
    (Setting::Whole(&SIDE), "texture"),
    (Setting::Whole(&ANISOTROPY), "texture"),
    (Setting::Choice(&FILTER), "texture"),
    (Setting::Real(&SUN_DISTANCE), "shortcut"),
    (Setting::Whole(&inverse::CELLS), "inverse"),
];

fn with(mut defines: Vec<(&'static str, String)>, name: &'static str, value: u32) -> Vec<(&'static str, String)> {
    defines.push((name, value.to_string()));
    defines
}

/// The water and the sun map above it, which every variant looks up.
struct Sky {
    water: Water,
    /// `Waves` of `glsl/waves/sun.glsl`.
    data: crate::gpu::BufferId,
    /// Bands are bent apart.
    apart: bool,
}

impl Sky {
    fn plan(work: &mut Work<'_>, water: Water) -> Self {
        let apart = work.scene.is_dispersive();
        let data = suns::data(work.scene, &water, work.settings);
        Self { water, data: work.plan.upload("waves", &[data]), apart }
    }

    /// For a stage that includes `waves/sun.glsl`.
    fn give<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let pass = self.water.provide(pass).offer("waves", self.data);
        if self.apart { pass.define("WAVES_BANDS", 3) } else { pass }
    }

    fn provider(&self, file: &'static str) -> SurfaceProvider {
        let (mut defines, mut offers) = self.water.parts();
        offers.push(("waves", self.data));
        if self.apart {
            defines = with(defines, "WAVES_BANDS", 3);
        }
        SurfaceProvider { file, defines, reads: Vec::new(), offers }
    }

    /// The same with an image.
    fn provider_of(&self, file: &'static str, image: (&'static str, Resource)) -> SurfaceProvider {
        SurfaceProvider { reads: vec![image], ..self.provider(file) }
    }
}
