//! How large splats are, and into which level of the map they go (Wyman 2008, section 3.3).

use super::{Axes, SPLAT_SIZE};
use crate::{
    gpu::PassBuilder,
    settings::{Choice, Real, Settings},
};

/// Levels of a map with levels; what is larger is dropped ("we discard such photons").
pub const LEVELS: u32 = 4;

pub static LEVEL_THRESHOLD: Real = Real {
    key: "maps.level_threshold",
    unit: "texels",
    default: Some(5.0),
    range: 1.0..=63.0,
    doc: "with maps.splat = varying, the diameter beyond which a splat is of the next level; of levels from 4 on it is dropped",
};

pub static LEVEL: Choice = Choice {
    key: "maps.level",
    default: "trunc",
    words: &["trunc", "ceil"],
    doc: "level of a varying splat of diameter D, from log2(max(1, D / level_threshold)): trunc, as the listing prints; ceil, \
          as the text means, so that no splat is larger than the threshold in its level",
};

pub static FOOTPRINT: Choice = Choice {
    key: "maps.footprint",
    default: "distance",
    words: &["distance", "area"],
    doc: "how large the square is that a varying splat stands for: distance: the largest one between four adjacent \
          photons is its side, as in the paper, whose areas were short of precision; area: their quad's",
};

/// What the shaders that splat are told; push constants of `glsl/maps/photon_splat.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct SplatPush {
    side: i32,
    diameter: f32,
    threshold: f32,
    light: u32,
}

/// The splats of a map.
#[derive(Clone, Copy, Debug)]
pub struct Splats {
    /// Texels of the map.
    pub side: u32,
    varying: bool,
    multires: bool,
}

impl Splats {
    pub fn of(axes: Axes<'_>, side: u32) -> Self {
        Self { side, varying: axes.splat == "varying", multires: axes.target == "multires" }
    }

    /// Layers of the map's image for each view that receives.
    pub fn levels(self) -> u32 {
        if self.multires { LEVELS } else { 1 }
    }

    /// The file of the slot `surface`.
    pub fn surface(self) -> &'static str {
        if self.multires { "maps/surface_multires.glsl" } else { "maps/surface.glsl" }
    }

    /// Tells a pass that splats photons of a light.
    pub fn tell<'p>(self, settings: &Settings, light: usize, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let push = SplatPush {
            side: self.side as i32,
            diameter: settings.whole(&SPLAT_SIZE) as f32,
            threshold: settings.real(&LEVEL_THRESHOLD).unwrap_or(f64::INFINITY) as f32,
            light: light as u32,
        };
        let wanted = [
            ("VARYING", self.varying),
            ("MULTIRES", self.multires),
            ("LEVEL_CEIL", self.varying && settings.choice(&LEVEL) == "ceil"),
            ("FOOTPRINT_AREA", self.varying && settings.choice(&FOOTPRINT) == "area"),
        ];
        let pass = wanted.into_iter().filter(|(_, on)| *on).fold(pass, |pass, (name, _)| pass.define(name, 1));
        pass.push(&push)
    }
}
