//! Adaptive emission: cells that need more light samples get them, level by level, 16 smaller cells for each.
//!
//! The view's own grid is the coarse pass. It tells which cells are cut by a silhouette or a crease, bend, or are spread
//! wide (`glsl/maps/cells.comp`); each level's smaller cells are asked the same again. What brings no light to the map is left as it is. Lists are of fixed size: a level with more cells than
//! `maps.adapt_most` leaves those of the least flux, octave by octave, and they are counted.

use super::Job;
use crate::{
    gpu::{BufferId, Lifetime, PassBuilder, Row},
    passes::light::{SamplePush, TRACER, Tracing},
    settings::{Settings, Whole},
};

pub static ADAPT: Whole = Whole {
    key: "maps.adapt",
    unit: "levels",
    default: 1,
    range: 0..=4,
    doc: "with maps.splat = cells, how often a cell that its five rays do not describe is traced as 4 x 4 smaller ones: its own \
          light is then so much finer, and no other's (adaptive emission); 0: light.side everywhere. With light.tracer = bvh",
};

pub static MOST: Whole = Whole {
    key: "maps.adapt_most",
    unit: "cells",
    default: 1 << 18,
    range: 1..=1 << 20,
    doc: "cells of a view that are traced finer in each level, at most; of more, those of the least light are left, and counted",
};

/// Light samples of a cell that is traced finer, and of one that is left (`SAMPLES` and `LEFT` of
/// `glsl/maps/cells_refine.comp`).
pub const SAMPLES: [u64; 2] = [25 + 16, 5];
/// Smaller cells of one (`FINER` squared there).
const SMALLER: u64 = 16;
/// Words of a level's row (`ROW` of `glsl/maps/finer.glsl`): that of its dispatch, and octaves of flux.
const ROW: u32 = 36;
/// Bytes of a cell in a list.
const CELL_BYTES: u64 = 8;
/// Invocations of a work group.
const GROUP: u32 = 64;

/// The lists of cells, and how they are filled.
pub struct Finer {
    /// A list a level.
    lists: Vec<BufferId>,
    /// Of each view and level what its list holds.
    rows: BufferId,
    most: u32,
}

/// Push constants of `glsl/maps/cells_refine.comp`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct RefinePush {
    sample: SamplePush,
    side: i32,
    diameter: f32,
}

/// Levels in force.
fn levels(settings: &Settings) -> u32 {
    if settings.choice(&TRACER) == "bvh" { settings.whole(&ADAPT) } else { 0 }
}

impl Finer {
    /// Adds the lists; `None` where no cell is traced finer.
    pub fn plan(job: &mut Job<'_>) -> Option<Self> {
        let levels = levels(job.settings);
        if levels == 0 {
            let reason = match job.settings.choice(&TRACER) {
                "bvh" => "maps.adapt = 0: cells cut by an edge go as points",
                _ => {
                    "the tracer's images show no more than the centres of their texels: cells cut by an edge go as points"
                }
            };
            job.plan.leave_out("maps/cells.refine", reason);
            return None;
        }
        let most = job.settings.whole(&MOST);
        let mut cells = u64::from(job.photons.side).pow(2);
        let mut lists = Vec::new();
        for level in 0..levels {
            let name = format!("maps/cells.list{}", numbered(level));
            lists.push(job.plan.buffer(&name, CELL_BYTES * cells, Lifetime::Frame));
            cells = SMALLER * cells.min(most.into());
        }
        let empty: Vec<u32> = (0..ROW).map(|word| u32::from(word == 1 || word == 2)).collect();
        let rows = job.plan.upload_once("maps/cells.rows", &empty.repeat(job.emissions.len() * levels as usize));
        Some(Self { lists, rows, most })
    }

    /// Gives a pass the list of a level to fill.
    fn fill<'p>(&self, pass: PassBuilder<'p>, level: usize) -> PassBuilder<'p> {
        let pass = pass.write("cells_next", self.lists[level]).write("cells_rows", self.rows);
        pass.define("CELLS_LEVELS", self.lists.len())
    }

    /// Gives the pass over the view's own grid the first list.
    pub fn begin<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        self.fill(pass.define("REFINED", 1), 0)
    }

    /// Adds a pass a level; `give` gives it what all passes over cells take.
    pub fn refine(
        &self,
        job: &mut Job<'_>,
        view: usize,
        (side, diameter): (i32, f32),
        give: &dyn for<'p> Fn(PassBuilder<'p>) -> PassBuilder<'p>,
        name_of: &dyn Fn(&str) -> String,
    ) {
        let tracing = Tracing {
            scene: job.bench.buffers,
            views: job.bench.views,
            tracer: job.tracer,
            class: job.bench.class,
            photons: job.photons,
            emission: &job.emissions[view],
            index: view,
        };
        let push = RefinePush { sample: tracing.push(), side, diameter };
        for (level, &list) in self.lists.iter().enumerate() {
            let name = name_of(&format!("maps/cells.refine{}", numbered(level as u32)));
            let pass = tracing.give(give(job.plan.pass(&name))).read("cells_list", list).push(&push);
            let pass = pass.define("CELLS_LEVEL", level).define("CELLS_MOST", self.most);
            let pass = match self.lists.get(level + 1) {
                Some(_) => self.fill(pass.define("DEEPER", 1), level + 1),
                None => pass.write("cells_rows", self.rows).define("CELLS_LEVELS", self.lists.len()),
            };
            let row = (view * self.lists.len() + level) as u32 * (ROW / Row::WORDS as u32);
            pass.dispatch_counted("maps/cells_refine.comp", Row { rows: self.rows, row }, GROUP);
        }
    }

    /// Gives the pass that counts the lists.
    pub fn count<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        pass.write("cells_rows", self.rows).define("CELLS_LEVELS", self.lists.len()).define("CELLS_MOST", self.most)
    }
}

/// The first has no number: most often it is the only one.
fn numbered(level: u32) -> String {
    if level == 0 { String::new() } else { format!(".{level}") }
}
