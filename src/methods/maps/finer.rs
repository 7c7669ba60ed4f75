//! Adaptive emission: cells that pay for more light samples get them, level by level, 16 smaller cells for each.
//!
//! The view's own grid is the coarse pass. What each of its cells is wrong by is estimated (`glsl/maps/cell_error.glsl`) and
//! counted by octaves; those are traced finer without which uniform emission would take fewer rays to the error that is left
//! (`glsl/maps/cells_pay.comp`), and of the smaller ones those that are cut or torn and pay in their turn. What brings no light to
//! the map is left as it is. Lists are of fixed size: a level with more cells than `maps.adapt_most` leaves those that are wrong by
//! least, octave by octave, and they are counted.
//!
//! Cells of the view that lie side by side in the first list share the rays on their common edge, which are traced before them
//! (`glsl/maps/cells_edges.comp`): 30 rays each, and 3 more for an edge whose other side is not listed.

use super::Job;
use crate::{
    gpu::{BufferId, Lifetime, PassBuilder, Resource, Row},
    passes::light::{Emission, SamplePush, TRACER, Tracing},
    settings::{Real, Settings, Whole},
};

pub static ADAPT: Whole = Whole {
    key: "maps.adapt",
    unit: "levels",
    default: 1,
    range: 0..=4,
    doc: "with maps.splat = cells, how often a cell is traced as 4 x 4 smaller ones where that lowers the error by more than as many \
          rays elsewhere would (adaptive emission); 0: light.side everywhere. With light.tracer = bvh",
};

pub static MOST: Whole = Whole {
    key: "maps.adapt_most",
    unit: "cells",
    default: 1 << 18,
    range: 1..=1 << 20,
    doc: "cells of a view that are traced finer in each level, at most; of more, those that are wrong by least are left, and counted",
};

pub static ENOUGH: Real = Real {
    key: "maps.adapt_error",
    unit: "",
    default: Some(5e-5),
    range: 0.0..=1.0,
    doc: "relMSE of the map, by estimate, below which cells are not traced finer; 0: as far as it pays. What is below is seldom \
          seen beside what the map's own texels blur",
};

/// Smaller cells of one (`FINER` squared there).
const SMALLER: u64 = 16;
/// Words of a level's row (`ROW` of `glsl/maps/finer.glsl`), and which of them has the view's rays (`RAYS` there).
const ROW: u32 = 44;
const RAYS: usize = 4;
/// Of a light's irradiance, what is told from none just so: as the judged error measure has it.
const DIM: f64 = 0.1;
/// Bands of light.
const BANDS: f64 = 3.0;
/// Bytes of a cell in a list.
const CELL_BYTES: u64 = 8;
/// Bytes of a photon of a sample on a cell's edges, how many samples a cell has there (`EDGE_SAMPLES` of
/// `glsl/maps/cell_edges.glsl`), and what a cell has besides.
const EDGE_BYTES: u64 = 24;
const EDGE_SAMPLES: u64 = 6;
const LISTED_BYTES: u64 = 4;
/// A buffer that every device has. With more cells neighbours trace their common edges each for itself.
const EDGES_MOST: u64 = 128 << 20;
/// Invocations of a work group.
const GROUP: u32 = 64;

/// The lists of cells, and how they are filled.
pub struct Finer {
    /// A list a level.
    lists: Vec<BufferId>,
    /// Of each view and level what its list holds.
    rows: BufferId,
    /// Of each cell of a view whether it is in the first list, and samples that it shares with neighbours.
    edges: Option<BufferId>,
    /// What errors are held against.
    lights: BufferId,
    most: u32,
    /// The sum of a view's errors that is small enough.
    enough: f32,
}

/// Push constants of `glsl/maps/cells_pay.comp`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct PayPush {
    view: u32,
    enough: f32,
}

/// Push constants of `glsl/maps/cells_refine.comp`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct RefinePush {
    sample: SamplePush,
    side: i32,
    diameter: f32,
    blur: f32,
}

/// What an error is held against, of a view of emission (`Lights` of `glsl/maps/cell_error.glsl`): W of a cell at most, and W/m² of
/// what is dim, all bands. Both change as a scene moves, so that a buffer has them.
fn held_against(job: &Job<'_>, emission: &Emission) -> [f32; 2] {
    const NEAREST: f64 = 1e-3; // m: a light in a receiver's middle
    let middle = job.work.receivers.first().map(|receiver| receiver.patch.center);
    let apart = emission.position.zip(middle).map_or(1.0, |(a, b)| a.distance(b).max(NEAREST));
    [BANDS * emission.most(), DIM * BANDS * emission.brightest() / (apart * apart)].map(|held| held as f32)
}

/// What the picture blurs, texels of a map of so many a side: a pixel of one that shows the whole map, or a splat where that is more.
pub fn blur(job: &Job<'_>, side: u32, diameter: f32) -> f32 {
    let pixels = job.work.size[0].min(job.work.size[1]).max(1);
    (side as f32 / pixels as f32).max(diameter)
}

/// Levels in force.
fn levels(settings: &Settings) -> u32 {
    if settings.choice(&TRACER) == "bvh" { settings.whole(&ADAPT) } else { 0 }
}

/// Gives a pass what several take.
type Give<'a> = &'a dyn for<'p> Fn(PassBuilder<'p>) -> PassBuilder<'p>;

impl Finer {
    /// Adds the lists; `None` where no cell is traced finer.
    pub fn plan(job: &mut Job<'_>, side: u32) -> Option<Self> {
        let levels = levels(job.work.settings);
        if levels == 0 {
            let reason = match job.work.settings.choice(&TRACER) {
                "bvh" => "maps.adapt = 0: cells cut by an edge go as points",
                _ => {
                    "the tracer's images show no more than the centres of their texels: cells cut by an edge go as points"
                }
            };
            job.work.plan.leave_out("maps/cells.refine", reason);
            return None;
        }
        let most = job.work.settings.whole(&MOST);
        let mut cells = u64::from(job.photons.side).pow(2);
        let each = LISTED_BYTES + EDGE_SAMPLES * EDGE_BYTES * u64::from(job.photons.layers());
        let shared = (cells * each <= EDGES_MOST).then_some(cells * each);
        let edges = shared.map(|bytes| job.work.plan.buffer("maps/cells.edges", bytes, Lifetime::Frame));
        let mut lists = Vec::new();
        for level in 0..levels {
            let name = format!("maps/cells.list{}", numbered(level));
            lists.push(job.work.plan.buffer(&name, CELL_BYTES * cells, Lifetime::Frame));
            cells = SMALLER * cells.min(most.into());
        }
        let row = |emission: &Emission| {
            let [x, y] = emission.held();
            let mut row = [0; ROW as usize];
            (row[1], row[2], row[RAYS]) = (1, 1, x * y + (x + 1) * (y + 1));
            row.repeat(levels as usize)
        };
        let rows =
            job.work.plan.upload_once("maps/cells.rows", &job.emissions.iter().flat_map(row).collect::<Vec<_>>());
        let lights: Vec<_> = job.emissions.iter().map(|emission| held_against(job, emission)).collect();
        let lights = job.work.plan.upload("maps/cells.lights", &lights);
        // Views share what the map may be wrong by.
        let texels = f64::from(side).powi(2) / job.emissions.len().max(1) as f64;
        let enough = (job.work.settings.real(&ENOUGH).unwrap_or_default() * texels) as f32;
        Some(Self { lists, rows, edges, lights, most, enough })
    }

    /// Gives a pass the list of a level to fill.
    fn fill<'p>(&self, pass: PassBuilder<'p>, level: usize) -> PassBuilder<'p> {
        self.rows(pass.write("cells_next", self.lists[level]))
    }

    /// Gives a pass the rows.
    fn rows<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        pass.write("cells_rows", self.rows).define("CELLS_LEVELS", self.lists.len())
    }

    /// Gives the pass that weighs the cells of the view's own grid what it counts them in.
    pub fn weigh<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        self.rows(pass).read("cells_lights", self.lights)
    }

    /// Makes a pass the one that says which of them pay.
    pub fn pay(&self, pass: PassBuilder<'_>, view: usize) {
        let push = PayPush { view: view as u32, enough: self.enough };
        self.count(pass).push(&push).dispatch("maps/cells_pay.comp", [1, 1, 1], 1);
    }

    /// Gives the pass over the view's own grid the first list.
    pub fn begin<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        self.share(self.fill(pass.define("REFINED", 1).read("cells_lights", self.lights), 0))
    }

    /// Gives a pass what neighbours share.
    fn share<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        self.edges.into_iter().fold(pass, |pass, edges| pass.define("SHARED_EDGES", 1).write("cells_edges", edges))
    }

    /// Adds a pass a level. The first has the photons of the view's own grid, `known`; `give` gives each what all passes over cells
    /// take.
    pub fn refine(
        &self,
        job: &mut Job<'_>,
        view: usize,
        (side, diameter, blur): (i32, f32, f32),
        (known, give): (&[(&'static str, Resource)], Give<'_>),
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
            blocks: None,
        };
        let row_of = |level: usize| {
            let row = (view * self.lists.len() + level) as u32 * (ROW / Row::WORDS as u32);
            Row { rows: self.rows, row }
        };
        if self.edges.is_some() {
            let pass = tracing.give(self.share(self.rows(job.work.plan.pass(&name_of("maps/cells.edges")))));
            let pass = pass.read("cells_list", self.lists[0]).push(&tracing.push());
            pass.dispatch_counted("maps/cells_edges.comp", row_of(0), GROUP);
        }
        let push = RefinePush { sample: tracing.push(), side, diameter, blur };
        for (level, &list) in self.lists.iter().enumerate() {
            let name = name_of(&format!("maps/cells.refine{}", numbered(level as u32)));
            let pass = tracing.give(give(job.work.plan.pass(&name))).read("cells_list", list).push(&push);
            let pass = if level == 0 { self.share(pass.with(known.iter().copied())) } else { pass };
            let pass = pass.define("CELLS_LEVEL", level).define("CELLS_MOST", self.most);
            let pass = match self.lists.get(level + 1) {
                Some(_) => self.fill(pass.define("DEEPER", 1).read("cells_lights", self.lights), level + 1),
                None => self.rows(pass),
            };
            pass.dispatch_counted("maps/cells_refine.comp", row_of(level), GROUP);
        }
    }

    /// Gives the pass that counts the lists.
    pub fn count<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let shared = self.edges.iter().fold(self.rows(pass), |pass, _| pass.define("SHARED_EDGES", 1));
        shared.define("CELLS_MOST", self.most)
    }
}

/// The first has no number: most often it is the only one.
fn numbered(level: u32) -> String {
    if level == 0 { String::new() } else { format!(".{level}") }
}
