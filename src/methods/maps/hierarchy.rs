//! Traverse `hierarchical` (Wyman 2008, sections 3.1 and 3.2): from a coarse level of the photon buffer down, points are
//! streamed out of a geometry shader and drawn again by their byte count; what holds no valid photon goes at once.

use super::{
    Axes, Column, Job,
    pyramid::{Merge, Pyramid, SPLATTED, level_side},
};
use crate::{
    gpu::{BufferId, Draw, Format, Lifetime, PassBuilder, Stream, Topology},
    passes::light,
};

/// A point (`glsl/maps/stream_point.glsl`).
const POINT: Format = Format::Rg32u;

/// The pyramid over the photons, and the two streams that feed each other. All views of one size share them.
pub struct Hierarchy {
    pub pyramid: Pyramid,
    /// Level k's step writes stream k % 2.
    streams: [Stream; 2],
}

impl Hierarchy {
    /// Images and buffers, for each size of view; none where photons are not traversed so, or are so few that their topmost
    /// level is they themselves: they are fetched then.
    pub fn plan(job: &mut Job<'_>, axes: Axes<'_>) -> Vec<Self> {
        if !axes.streams() {
            return Vec::new();
        }
        let sides = light::sides(job.emissions);
        let all: Vec<Self> = sides.iter().filter_map(|&side| Self::of(job, axes, &sides, side)).collect();
        if all.is_empty() {
            too_few(job, &["maps/pyramid", "maps/traverse"], "they are fetched");
        }
        all
    }

    fn of(job: &mut Job<'_>, axes: Axes<'_>, sides: &[u32], side: u32) -> Option<Self> {
        let pyramid = Pyramid::of(job, axes, sides, side)?;
        let mut stream = |level: u32| {
            // What a level's step leaves is of the level below, whose texels are the worst case.
            let points = u64::from(level_side(side, level - 1)).pow(2) * u64::from(pyramid.layers);
            let name = light::sized(&format!("maps/stream.{}", level % 2), sides, side);
            Stream {
                vertices: job.work.plan.buffer(&name, points * POINT.bytes(), Lifetime::Frame),
                counter: job.work.plan.buffer(&format!("{name}.bytes"), 4, Lifetime::Frame),
            }
        };
        let odd = stream(1);
        let streams = [if pyramid.levels > 1 { stream(2) } else { odd }, odd];
        Some(Self { pyramid, streams })
    }

    /// Builds the pyramid over a view's photons and traverses it: a pass a level each.
    pub fn traverse(&self, job: &mut Job<'_>, light: u32, views: BufferId, name_of: &dyn Fn(&str) -> String) {
        self.pyramid.build(job, light, views, name_of);
        for level in (1..=self.pyramid.levels).rev() {
            self.step(job, level, light, views, &name_of(&format!("maps/traverse.{level}")));
        }
    }

    fn step(&self, job: &mut Job<'_>, level: u32, light: u32, views: BufferId, name: &str) {
        let Pyramid { merge, levels, layers, .. } = self.pyramid;
        let push = self.pyramid.step(level, light);
        let (converges, exact) = (merge.tests(level), merge == Merge::Exact);
        // Sides are asked of the photon image, and at the last level its photons.
        let columns: &[Column] = if converges { &[Column::Hit, Column::Flux] } else { &[Column::Hit] };
        let pass = self.pyramid.define(job.photons.define(job.work.plan.pass(name))).with(job.photons.fetch(columns));
        let pass = if converges || exact || level == levels { pass.push(&push) } else { pass };
        let wanted: &[&str] = match merge {
            Merge::None => &["pyramid_valid"],
            Merge::Exact => &["pyramid_flux", "pyramid_bounds"],
            _ if converges => &["pyramid_hit", "pyramid_flux"],
            _ => &["pyramid_hit"],
        };
        let pass = self.pyramid.give(pass, wanted).stream(self.streams[level as usize % 2]);
        let pass = if converges { pass.define("CONVERGE", 1).read("maps_views", views) } else { pass };
        let readies = matches!(merge, Merge::All | Merge::Exact);
        let pass = if readies && level < levels { pass.define("READY", 1) } else { pass };
        let shaders = ["maps/traverse.vert", "maps/traverse.geom"];
        if level < levels {
            return pass.draw_stream(&shaders, self.streams[(level as usize + 1) % 2], POINT);
        }
        let texels = level_side(self.pyramid.side, levels).pow(2);
        let draw = Draw { vertices: texels, first_vertex: 0, instances: layers, first_instance: 0 };
        pass.define("FIRST", 1).draw(&shaders, Topology::Points, vec![draw]);
    }

    /// Draws what the traversal left.
    pub fn draw(&self, pass: PassBuilder<'_>, shaders: &[&str]) {
        let pass = self.pyramid.give(self.pyramid.define(pass), &SPLATTED);
        pass.draw_stream(shaders, self.streams[1], POINT);
    }
}

/// Says that photons are no more than the topmost level's, and what becomes of them.
pub fn too_few(job: &mut Job<'_>, left_out: &[&str], so: &str) {
    let side = job.photons.side;
    let reason = format!("{side} photons a side are no more than the topmost level's (maps.top): {so}");
    left_out.iter().for_each(|name| job.work.plan.leave_out(name, reason.clone()));
}
