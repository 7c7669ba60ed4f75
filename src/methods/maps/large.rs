//! Large splats behind `compute`: marked by the dispatch that sums the others in fixed point, then drawn and blended. Which
//! and in which order does not depend on who comes first, so that the map repeats itself bit by bit.

use super::{
    Axes, Job,
    points::{Points, SUMMING},
    sums::Fixed,
};
use crate::{
    gpu::{BufferId, Lifetime, PassBuilder, Row},
    passes::light,
    settings::{Settings, Whole},
};

pub static RASTER_FROM: Whole = Whole {
    key: "maps.raster_from",
    unit: "texels",
    default: 0,
    range: 0..=256,
    doc: "with maps.traverse = compute, the diameter from which splats are drawn and blended in float32 in place of summed in fixed \
          point; 256: none is; 0: what is faster by the kind of device, 256 on a GPU, 8 on a software device",
};

/// [`RASTER_FROM`] where nobody has set it: on lavapipe drawing is faster from some 8 texels on, on an H200 summing 6 to 14 times
/// for all from 3 to 21 (`README.md`).
const FROM_ON_SOFTWARE: u32 = 8;
const FROM_ON_GPU: u32 = 256;

/// The widest splat that is drawn, texels (`SPLAT_MAX_DIAMETER` of `glsl/shared/splat.glsl`).
pub const MOST: u32 = 255;
/// Kinds of splats of any size. Of ellipses, which are thin, the square that is drawn would be mostly empty.
const ROUND: [&str; 2] = ["varying", "thin-lens"];
/// Invocations of a work group that marks, and along one of its sides.
const MARKING: u64 = 64;
const MARKING_SIDE: u32 = 8;

/// What is marked of a view's splats. All views of one size share it.
pub struct Large {
    pub side: u32,
    /// Work groups that gather one by one.
    groups: u32,
    /// A bit for each invocation of each work group that gathers.
    masks: BufferId,
    /// Marked ones before each work group.
    before: BufferId,
    /// Of each view, the draw of what is marked.
    rows: BufferId,
    from: u32,
}

/// The diameter in force from which splats are drawn, texels.
fn raster_from(settings: &Settings) -> u32 {
    match settings.whole(&RASTER_FROM) {
        0 if settings.is_on_software() => FROM_ON_SOFTWARE,
        0 => FROM_ON_GPU,
        from => from,
    }
}

/// Whether the kind of device decides which splats are drawn.
pub fn hangs_on_device(settings: &Settings, axes: Axes<'_>) -> bool {
    settings.whole(&RASTER_FROM) == 0 && axes.traverse == "compute" && can_draw(axes)
}

/// Whether splats behind `compute` are drawn where they are large: any of any size, and fixed ones all or none.
pub fn can_draw(axes: Axes<'_>) -> bool {
    (axes.splat, axes.merge) == ("fixed", "none") || ROUND.contains(&axes.splat)
}

/// Whether fixed splats are so large that all of them are drawn.
pub fn all_drawn(job: &Job<'_>, axes: Axes<'_>) -> bool {
    let size = job.work.settings.whole(&super::SPLAT_SIZE);
    (axes.splat, axes.merge) == ("fixed", "none") && size >= raster_from(job.work.settings)
}

impl Large {
    /// Buffers, for each size of view; none where no splat can be large.
    pub fn plan(job: &mut Job<'_>, axes: Axes<'_>, fixed: &Option<Fixed>) -> Vec<Self> {
        let from = raster_from(job.work.settings);
        if fixed.is_none() || !ROUND.contains(&axes.splat) || from > MOST {
            return Vec::new();
        }
        let rows = job.work.plan.buffer("maps/large.rows", job.emissions.len() as u64 * Row::BYTES, Lifetime::Frame);
        let (sides, layers) = (light::sides(job.emissions), job.photons.layers());
        let mut of = |&side: &u32| {
            // Of those that gather what is merged there are no more.
            let groups = side.div_ceil(MARKING_SIDE).pow(2) * layers;
            let mut buffer = |name, bytes| {
                job.work.plan.buffer(&light::sized(name, &sides, side), bytes * u64::from(groups), Lifetime::Frame)
            };
            let (masks, before) = (buffer("maps/large.masks", MARKING / 8), buffer("maps/large.before", 4));
            Self { side, groups, masks, before, rows, from }
        };
        sides.iter().map(&mut of).collect()
    }

    /// Tells a pass that gathers to mark what is large.
    pub fn mark<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        pass.define("LARGE", format!("{:.1}", f64::from(self.from))).write("large_masks", self.masks)
    }

    /// Counts what is marked.
    pub fn count(&self, job: &mut Job<'_>, points: Option<&Points>, view: u32, name: &str) {
        let pass = job.work.plan.pass(name).read("large_masks", self.masks).push(&view);
        let pass = match points {
            Some(points) => points.number(pass),
            None => pass,
        };
        let pass = pass.define("GROUPS", format!("{}u", self.groups));
        let pass = pass.write("large_before", self.before).write("large_rows", self.rows);
        pass.dispatch("maps/large.comp", [1, 1, 1], SUMMING);
    }

    /// Draws it.
    pub fn draw(&self, pass: PassBuilder<'_>, points: Option<&Points>, view: u32) {
        let pass = points.into_iter().fold(pass, |pass, points| points.give(pass));
        let pass = pass.read("large_masks", self.masks).read("large_before", self.before);
        let pass = pass.read("large_rows", self.rows).define("ROW", view);
        pass.draw_counted(&["maps/gather_large.vert", "maps/splat.frag"], Row { rows: self.rows, row: view });
    }
}
