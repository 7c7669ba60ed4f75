//! Traverse `hierarchical` (Wyman 2008, sections 3.1 and 3.2): from a coarse level of the photon buffer down, points are
//! streamed out of a geometry shader and drawn again by their byte count; what holds no valid photon goes at once.

use super::{Axes, Column, Job, TOP};
use crate::{
    gpu::{BufferId, Draw, Format, ImageId, Lifetime, PassBuilder, Resource, Stream, Topology},
    passes::light,
};

/// Invocations along one side of work groups.
const GROUP: u32 = 8;
/// A point (`glsl/maps/stream_point.glsl`).
const POINT: Format = Format::Rg32u;

/// The pyramid over the photons, and the two streams that feed each other. All views of one size share them.
pub struct Hierarchy {
    /// Photons a side.
    pub side: u32,
    layers: u32,
    /// Above the photons.
    levels: u32,
    merges: bool,
    all: bool,
    pyramid: Vec<(&'static str, ImageId)>,
    /// Level k's step writes stream k % 2.
    streams: [Stream; 2],
}

/// Push constants of `glsl/maps/pyramid.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct PyramidPush {
    side: i32,
    level: i32,
}

/// Push constants of `glsl/maps/traverse_step.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct StepPush {
    level: i32,
    top_side: i32,
    map_side: i32,
    light: u32,
}

/// Texels of a level over `side` photons a side.
fn level_side(side: u32, level: u32) -> u32 {
    side.div_ceil(1 << level)
}

impl Hierarchy {
    /// Images and buffers, for each size of view; none where photons are not traversed so, or are so few that their topmost
    /// level is they themselves: they are fetched then.
    pub fn plan(job: &mut Job<'_>, axes: Axes<'_>) -> Vec<Self> {
        if !axes.streams() {
            return Vec::new();
        }
        let sides = light::sides(job.emissions, |e| e.side);
        let all: Vec<Self> = sides.iter().filter_map(|&side| Self::of(job, axes, &sides, side)).collect();
        if all.is_empty() {
            let side = job.photons.side;
            let reason =
                format!("{side} photons a side are no more than the topmost level's (maps.top): they are fetched");
            ["maps/pyramid", "maps/traverse"].iter().for_each(|name| job.plan.leave_out(name, reason.clone()));
        }
        all
    }

    fn of(job: &mut Job<'_>, axes: Axes<'_>, sides: &[u32], side: u32) -> Option<Self> {
        let (top, layers) = (job.settings.whole(&TOP), job.photons.layers());
        let levels = (0..u32::BITS - 1).find(|&level| level_side(side, level) <= top).unwrap_or(0);
        if levels == 0 {
            return None;
        }
        let merges = axes.merge != "none";
        let columns: &[_] = if merges {
            &[("pyramid_hit", Format::Rgba32f), ("pyramid_flux", Format::Rgba32f)]
        } else {
            &[("pyramid_valid", Format::R32f)]
        };
        // As `pyramid_place` of `glsl/maps/levels.glsl` lays them out.
        let extent = [level_side(side, 1), 2 * (level_side(side, 1) + levels)];
        let mut image = |name: &str, format| {
            let name = light::sized(&format!("maps/{}", name.replace('_', ".")), sides, side);
            job.plan.image_array(&name, extent, layers, format, Lifetime::Frame)
        };
        let pyramid = columns.iter().map(|&(name, format)| (name, image(name, format))).collect();
        let mut stream = |level: u32| {
            // What a level's step leaves is of the level below, whose texels are the worst case.
            let points = u64::from(level_side(side, level - 1)).pow(2) * u64::from(layers);
            let name = light::sized(&format!("maps/stream.{}", level % 2), sides, side);
            Stream {
                vertices: job.plan.buffer(&name, points * POINT.bytes(), Lifetime::Frame),
                counter: job.plan.buffer(&format!("{name}.bytes"), 4, Lifetime::Frame),
            }
        };
        let odd = stream(1);
        let streams = [if levels > 1 { stream(2) } else { odd }, odd];
        Some(Self { side, layers, levels, merges, all: axes.merge == "all", pyramid, streams })
    }

    /// Builds the pyramid over a view's photons and traverses it: a pass a level each.
    pub fn traverse(&self, job: &mut Job<'_>, light: u32, map: (u32, BufferId), name_of: &dyn Fn(&str) -> String) {
        for level in 1..=self.levels {
            self.build(job, level, &name_of(&format!("maps/pyramid.{level}")));
        }
        for level in (1..=self.levels).rev() {
            self.step(job, level, light, map, &name_of(&format!("maps/traverse.{level}")));
        }
    }

    fn build(&self, job: &mut Job<'_>, level: u32, name: &str) {
        let push = PyramidPush { side: self.side as i32, level: level as i32 };
        let columns: &[Column] = if self.merges { &[Column::Hit, Column::Flux] } else { &[Column::Hit] };
        let pass = self.define(job.photons.define(job.plan.pass(name))).push(&push);
        let pass = match level {
            1 => pass.define("FROM_PHOTONS", 1).with(job.photons.fetch(columns)),
            _ => pass,
        };
        let groups = level_side(self.side, level).div_ceil(GROUP);
        self.pyramid.iter().fold(pass, |pass, &(name, image)| pass.store(name, image)).dispatch(
            "maps/pyramid.comp",
            [groups, groups, self.layers],
            GROUP * GROUP,
        );
    }

    fn step(&self, job: &mut Job<'_>, level: u32, light: u32, (map_side, views): (u32, BufferId), name: &str) {
        let top_side = level_side(self.side, self.levels);
        let push = StepPush { level: level as i32, top_side: top_side as i32, map_side: map_side as i32, light };
        let converge = self.merges && (self.all || level == 1);
        // Sides are asked of the photon image, and at the last level its photons.
        let columns: &[Column] = if converge { &[Column::Hit, Column::Flux] } else { &[Column::Hit] };
        let pass = self.define(job.photons.define(job.plan.pass(name))).with(job.photons.fetch(columns));
        let pass = if converge || level == self.levels { pass.push(&push) } else { pass };
        let pass = self.with_pyramid(pass, converge).stream(self.streams[level as usize % 2]);
        let pass = if converge { pass.define("CONVERGE", 1).read("maps_views", views) } else { pass };
        let pass = if self.all && level < self.levels { pass.define("READY", 1) } else { pass };
        let shaders = ["maps/traverse.vert", "maps/traverse.geom"];
        if level < self.levels {
            return pass.draw_stream(&shaders, self.streams[(level as usize + 1) % 2], POINT);
        }
        let draw = Draw { vertices: top_side * top_side, first_vertex: 0, instances: self.layers, first_instance: 0 };
        pass.define("FIRST", 1).draw(&shaders, Topology::Points, vec![draw]);
    }

    /// Draws what the traversal left.
    pub fn draw(&self, pass: PassBuilder<'_>, shaders: &[&str]) {
        let pass = self.define(pass);
        let pass = if self.merges { self.with_pyramid(pass, true) } else { pass };
        pass.draw_stream(shaders, self.streams[1], POINT);
    }

    fn define<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        if self.merges { pass.define("MERGE", 1) } else { pass }
    }

    /// Gives a pass the pyramid, `whole` with the flux of what merges.
    fn with_pyramid<'p>(&self, pass: PassBuilder<'p>, whole: bool) -> PassBuilder<'p> {
        let columns = if whole { self.pyramid.len() } else { 1 };
        pass.with(self.pyramid[..columns].iter().map(|&(name, image)| (name, Resource::Image(image))))
    }
}
