//! How large splats are, and into which level of the map they go (Wyman 2008, section 3.3).

use super::{Axes, Job, SIDE, SPLAT, SPLAT_SIZE, large};
use crate::{
    gpu::PassBuilder,
    passes::light::{Blocks, Column, Emission},
    settings::{Choice, Real, Settings},
};

/// Levels of a map with levels; what is larger is dropped ("we discard such photons").
pub const LEVELS: u32 = 4;

pub static LEVEL_THRESHOLD: Real = Real {
    key: "maps.level_threshold",
    unit: "texels",
    default: Some(5.0),
    range: 1.0..=63.0,
    doc: "with maps.splat = varying or thin-lens, the diameter beyond which a splat is of the next level; of levels from 4 on it is dropped",
};

pub static LEVEL: Choice = Choice {
    key: "maps.level",
    default: "trunc",
    words: &["trunc", "ceil"],
    doc: "level of a varying or thin-lens splat of diameter D, from log2(max(1, D / level_threshold)): trunc, as the listing prints; ceil, \
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
    view: u32,
}

/// What passes that splat are told of, besides.
#[derive(Clone, Copy)]
pub struct Told<'a> {
    settings: &'a Settings,
    view: usize,
    emission: &'a Emission,
    blocks: Option<&'a Blocks>,
}

impl<'a> Told<'a> {
    pub fn of(job: &Job<'a>, view: usize) -> Self {
        Self { settings: job.work.settings, view, emission: &job.emissions[view], blocks: job.blocks }
    }
}

/// The splats of a map.
#[derive(Clone, Copy, Debug)]
pub struct Splats {
    /// Texels of the map.
    pub side: u32,
    /// `maps.splat`.
    kind: &'static str,
    /// Texels: of fixed splats, and of the narrowest of several.
    diameter: u32,
    multires: bool,
}

/// Diameters that are drawn of `interpolated` splats, each twice the one before.
const DIAMETERS: usize = 4;

/// The widest of the narrowest of them whose widest is drawn as wide as it is.
pub fn most_interpolated() -> u32 {
    large::MOST >> (DIAMETERS - 1)
}

impl Splats {
    pub fn of(axes: Axes<'_>, settings: &Settings) -> Self {
        let kind = SPLAT.words.iter().find(|word| **word == axes.splat).expect("the axis has one of its words");
        let (side, diameter) = (settings.whole(&SIDE), settings.whole(&SPLAT_SIZE));
        Self { side, kind, diameter, multires: axes.target == "multires" }
    }

    /// Layers of the map's image for each view that receives.
    pub fn levels(self) -> u32 {
        if self.multires { LEVELS } else { 1 }
    }

    /// Names of the maps: one for each size of splat that the eye interpolates between.
    pub fn maps(self) -> &'static [&'static str] {
        const MAPS: [&str; DIAMETERS] = ["maps/map", "maps/map.1", "maps/map.2", "maps/map.3"];
        if self.kind == "interpolated" { &MAPS } else { &MAPS[..1] }
    }

    /// What the eye is told.
    pub fn defines(self) -> Vec<(&'static str, String)> {
        match self.kind {
            "interpolated" => vec![("NARROWEST", format!("{:.1}", f64::from(self.diameter)))],
            _ if self.multires => vec![("LEVELS", LEVELS.to_string())],
            _ => Vec::new(),
        }
    }

    /// Columns that the shaders that splat read.
    pub fn columns(self) -> &'static [Column] {
        match self.kind {
            "thin-lens" => &[Column::Hit, Column::Flux, Column::Exit],
            "elliptic" => &[Column::Hit, Column::Flux, Column::Way],
            _ => &[Column::Hit, Column::Flux],
        }
    }

    /// Texels of a fixed splat, or of the narrowest.
    pub fn diameter(self) -> u32 {
        self.diameter
    }

    /// Whether splats are as wide as their neighbours are far.
    pub fn is_elliptic(self) -> bool {
        self.kind == "elliptic"
    }

    /// Tells a pass that splats photons of a view of emission into the map of that number.
    pub fn tell<'p>(self, told: Told<'_>, map: usize, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let Told { settings, view, emission, blocks } = told;
        let varying = ["varying", "thin-lens"].contains(&self.kind);
        let push = SplatPush {
            side: self.side as i32,
            diameter: (self.diameter << map) as f32,
            threshold: settings.real(&LEVEL_THRESHOLD).unwrap_or(f64::INFINITY) as f32,
            light: emission.lamp,
            view: view as u32,
        };
        let wanted = [
            ("VARYING", varying),
            ("MULTIRES", self.multires),
            ("LEVEL_CEIL", varying && settings.choice(&LEVEL) == "ceil"),
            ("FOOTPRINT_AREA", self.kind == "varying" && settings.choice(&FOOTPRINT) == "area"),
            ("THIN_LENS", self.kind == "thin-lens"),
            ("ELLIPTIC", self.kind == "elliptic"),
            ("SHAPED", self.kind == "elliptic"),
            ("COUNTED", self.kind == "interpolated"),
        ];
        let pass = wanted.into_iter().filter(|(_, on)| *on).fold(pass, |pass, (name, _)| pass.define(name, 1));
        let pass = match blocks.filter(|_| self.is_elliptic()) {
            Some(blocks) => blocks.define(pass, emission.side),
            None => pass,
        };
        pass.push(&push)
    }
}
