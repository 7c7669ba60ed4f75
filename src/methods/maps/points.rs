//! Traverse `compute` with a hierarchy: the splats below each texel are counted level by level, the topmost level's counts
//! summed, and a dispatch of as many invocations as there are splats finds each its own by going down the counts.
//!
//! Nothing is listed, so that nothing overflows; nothing is read back, and what is counted stays in a row of
//! `maps/points.rows` for each view.

use super::{
    Axes, Job,
    hierarchy::too_few,
    pyramid::{Merge, Pyramid, SPLATTED, level_side},
    sums::Fixed,
};
use crate::{
    gpu::{BufferId, Lifetime, PassBuilder, Row},
    passes::{PlanError, light},
};

/// Invocations of the work group that sums (`PREFIX_GROUP` of `glsl/shared/prefix.glsl`).
pub const SUMMING: u32 = 256;
/// Splats of a work group (`SPLATS` of `glsl/maps/gather_points.comp`).
const SPLATS: u32 = 64;

/// The pyramid over the photons, and what its counts sum to. All views of one size share them.
pub struct Points {
    pub pyramid: Pyramid,
    /// Texels of the topmost level, in all layers.
    texels: u32,
    /// Splats before each of them, and of all.
    before: BufferId,
    /// Of each view, the groups of the dispatch and its splats.
    rows: BufferId,
}

/// Push constants of `glsl/maps/points.comp`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct PointsPush {
    level: i32,
    row: u32,
}

impl Points {
    /// Images and buffers, for each size of view; none where nothing merges, or photons are so few that their topmost level
    /// is they themselves.
    ///
    /// # Errors
    /// Where no buffer holds the map's sums.
    pub fn plan(job: &mut Job<'_>, axes: Axes<'_>, fixed: &Option<Fixed>) -> Result<Vec<Self>, PlanError> {
        if axes.traverse != "compute" || Merge::of(axes) == Merge::None {
            return Ok(Vec::new());
        }
        if fixed.is_none() {
            return Err(PlanError::Refused {
                what: format!("maps.merge={} with maps.traverse=compute and so large a map", axes.merge),
                reason: "what a dispatch merges it adds in integers, and a buffer of 128 MiB does not hold so many"
                    .into(),
                remedy: "lower maps.side, or set maps.traverse=hierarchical".into(),
            });
        }
        let sides = light::sides(job.emissions);
        let rows = job.emissions.len() as u64 * Row::BYTES;
        let rows = job.work.plan.buffer("maps/points.rows", rows, Lifetime::Frame);
        let all: Vec<Self> = sides.iter().filter_map(|&side| Self::of(job, axes, &sides, side, rows)).collect();
        if all.is_empty() {
            too_few(job, &["maps/pyramid", "maps/points"], "none are merged");
        }
        Ok(all)
    }

    fn of(job: &mut Job<'_>, axes: Axes<'_>, sides: &[u32], side: u32, rows: BufferId) -> Option<Self> {
        let pyramid = Pyramid::of(job, axes, sides, side)?;
        let texels = level_side(side, pyramid.levels).pow(2) * pyramid.layers;
        let name = light::sized("maps/points.before", sides, side);
        let before = job.work.plan.buffer(&name, 4 * (u64::from(texels) + 1), Lifetime::Frame);
        Some(Self { pyramid, texels, before, rows })
    }

    /// Counts the splats of a view's photons.
    pub fn count(&self, job: &mut Job<'_>, view: usize, views: BufferId, name_of: &dyn Fn(&str) -> String) {
        self.pyramid.build(job, job.emissions[view].lamp, views, name_of);
        let push = PointsPush { level: self.pyramid.levels as i32, row: view as u32 };
        let pass = job.photons.define(job.work.plan.pass(&name_of("maps/points")));
        // How many there are is asked of the photon image.
        let pass = self.pyramid.give(pass.with(job.photons.fetch(&[super::Column::Hit])), &["pyramid_points"]);
        let pass = pass.define("TEXELS", format!("{}u", self.texels));
        let pass = pass.write("maps_before", self.before).write("maps_rows", self.rows);
        pass.push(&push).dispatch("maps/points.comp", [1, 1, 1], SUMMING);
    }

    /// Adds them to the sums.
    pub fn gather(&self, fixed: &Fixed, pass: PassBuilder<'_>, view: usize) {
        let row = Row { rows: self.rows, row: view as u32 };
        fixed.give(self.give(pass)).dispatch_counted("maps/gather_points.comp", row, SPLATS);
    }

    /// Gives a pass what finds splats by their numbers, and makes them.
    pub fn give<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let pass = self.pyramid.give(self.pyramid.define(pass), &SPLATTED);
        self.number(self.pyramid.give(pass, &["pyramid_points"]))
    }

    /// Gives a pass how many there are.
    pub fn number<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let pass = pass.define("TOP", self.pyramid.levels).define("TEXELS", format!("{}u", self.texels));
        pass.read("maps_before", self.before)
    }
}
