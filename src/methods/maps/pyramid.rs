//! The pyramid over the photons: what lies below a texel of each level, a quarter as many texels a level.

use super::{Axes, Column, Job, SIDE, SPLAT_SIZE, SPREAD, TOP};
use crate::{
    gpu::{BufferId, Format, ImageId, Lifetime, PassBuilder, Resource},
    passes::light,
};

/// Invocations along one side of work groups.
const GROUP: u32 = 8;

/// What becomes of photons that fall together (`maps.merge`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Merge {
    None,
    Last,
    All,
    Exact,
}

impl Merge {
    pub fn of(axes: Axes<'_>) -> Self {
        match axes.merge {
            "last" => Self::Last,
            "all" => Self::All,
            "exact" => Self::Exact,
            _ => Self::None,
        }
    }

    /// Whether clusters of this level are tested against where their children fall, as in the paper.
    pub fn tests(self, level: u32) -> bool {
        self == Self::All || self == Self::Last && level == 1
    }
}

/// Images of all levels. All views of one size share them.
pub struct Pyramid {
    /// Photons a side.
    pub side: u32,
    pub layers: u32,
    /// Above the photons.
    pub levels: u32,
    pub merge: Merge,
    /// Whether it counts splats.
    counted: bool,
    columns: Vec<(&'static str, ImageId)>,
    /// Of the map, texels; of splats, texels; `maps.spread`.
    map_side: u32,
    diameter: f32,
    share: f32,
}

/// Push constants of `glsl/maps/pyramid_step.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct PyramidPush {
    side: i32,
    level: i32,
    map_side: i32,
    light: u32,
    diameter: f32,
    share: f32,
}

/// Push constants of `glsl/maps/traverse_step.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct StepPush {
    level: i32,
    top_side: i32,
    map_side: i32,
    light: u32,
    diameter: f32,
    share: f32,
}

/// Texels of a level over `side` photons a side.
pub fn level_side(side: u32, level: u32) -> u32 {
    side.div_ceil(1 << level)
}

impl Pyramid {
    /// Over `side` photons a side, of `sides` that there are; `None` where they are so few that their topmost level is they
    /// themselves.
    pub fn of(job: &mut Job<'_>, axes: Axes<'_>, sides: &[u32], side: u32) -> Option<Self> {
        let (top, layers) = (job.work.settings.whole(&TOP), job.photons.layers());
        let levels = (0..u32::BITS - 1).find(|&level| level_side(side, level) <= top).unwrap_or(0);
        if levels == 0 {
            return None;
        }
        let (merge, counted) = (Merge::of(axes), axes.traverse == "compute");
        let mut columns = match merge {
            Merge::None => vec![("pyramid_valid", Format::R32f)],
            Merge::Last | Merge::All => vec![("pyramid_hit", Format::Rgba32f), ("pyramid_flux", Format::Rgba32f)],
            Merge::Exact => vec![
                ("pyramid_flux", Format::Rgba32f),
                ("pyramid_mean", Format::Rgba32f),
                ("pyramid_bounds", Format::Rgba32f),
                ("pyramid_lean", Format::R32f),
            ],
        };
        if counted {
            columns.push(("pyramid_points", Format::Rgba32u));
        }
        // As `pyramid_place` of `glsl/maps/levels.glsl` lays them out.
        let extent = [level_side(side, 1), 2 * (level_side(side, 1) + levels)];
        let mut image = |(name, format): (&'static str, _)| {
            let known = light::sized(&format!("maps/{}", name.replace('_', ".")), sides, side);
            (name, job.work.plan.image_array(&known, extent, layers, format, Lifetime::Frame))
        };
        let columns = columns.into_iter().map(&mut image).collect();
        let (map_side, diameter) = (job.work.settings.whole(&SIDE), job.work.settings.whole(&SPLAT_SIZE) as f32);
        let share = job.work.settings.real(&SPREAD).unwrap_or_default() as f32;
        Some(Self { side, layers, levels, merge, counted, columns, map_side, diameter, share })
    }

    /// Builds it over a view's photons of a light: a pass a level.
    pub fn build(&self, job: &mut Job<'_>, light: u32, views: BufferId, name_of: &dyn Fn(&str) -> String) {
        for level in 1..=self.levels {
            self.build_level(job, level, light, views, &name_of(&format!("maps/pyramid.{level}")));
        }
    }

    fn build_level(&self, job: &mut Job<'_>, level: u32, light: u32, views: BufferId, name: &str) {
        let Self { side, map_side, diameter, share, .. } = *self;
        let push =
            PyramidPush { side: side as i32, level: level as i32, map_side: map_side as i32, light, diameter, share };
        let pass = self.define(job.photons.define(job.work.plan.pass(name))).push(&push);
        let (converges, from_photons) = (self.counted && self.merge.tests(level), level == 1);
        let pass = if converges { pass.define("CONVERGE", 1) } else { pass };
        // Exact clusters begin where photons land.
        let lands = converges || self.merge == Merge::Exact && from_photons;
        let pass = if lands { pass.read("maps_views", views) } else { pass };
        let columns: &[Column] = if self.merge == Merge::None { &[Column::Hit] } else { &[Column::Hit, Column::Flux] };
        let pass = if from_photons { pass.define("FROM_PHOTONS", 1).with(job.photons.fetch(columns)) } else { pass };
        let shader = if self.merge == Merge::Exact { "maps/pyramid_exact.comp" } else { "maps/pyramid.comp" };
        let groups = level_side(self.side, level).div_ceil(GROUP);
        self.columns.iter().fold(pass, |pass, &(name, image)| pass.store(name, image)).dispatch(
            shader,
            [groups, groups, self.layers],
            GROUP * GROUP,
        );
    }

    /// What a step of a traversal from this level is told.
    pub fn step(&self, level: u32, light: u32) -> StepPush {
        let Self { map_side, diameter, share, .. } = *self;
        let top_side = level_side(self.side, self.levels) as i32;
        StepPush { level: level as i32, top_side, map_side: map_side as i32, light, diameter, share }
    }

    /// Tells a pass what the pyramid holds.
    pub fn define<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let pass = match self.merge {
            Merge::None => pass,
            Merge::Last | Merge::All => pass.define("MERGE", 1),
            Merge::Exact => pass.define("EXACT", 1).define("SHAPED", 1),
        };
        if self.counted { pass.define("POINTS", 1) } else { pass }
    }

    /// Gives a pass those of its columns that it asks for.
    pub fn give<'p>(&self, pass: PassBuilder<'p>, wanted: &[&str]) -> PassBuilder<'p> {
        let given = self.columns.iter().filter(|(name, _)| wanted.contains(name));
        pass.with(given.map(|&(name, image)| (name, Resource::Image(image))))
    }
}

/// Columns that a cluster's splat is made of.
pub const SPLATTED: [&str; 4] = ["pyramid_hit", "pyramid_flux", "pyramid_mean", "pyramid_lean"];
