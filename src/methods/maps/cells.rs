//! Splat `cells`: the flux of each texel of a light's view is spread over where the light between its corners lands.
//!
//! Ours. The corners are traced beside the centres, and the four triangles between them are shared out among the map's
//! texels exactly: where neighbouring rays stay neighbours, no light is blurred and no gap is left. A cell that its
//! five rays do not describe (cut by a silhouette or a crease, bent, or very large) is traced again as 4 × 4 smaller
//! ones, and those again ([`Finer`]). That takes rays from anywhere, as `bvh` traces them; the image-space tracers know the centres of texels
//! alone, and leave such cells as points.

use super::{
    Axes, Job, SPLAT_SIZE,
    finer::{self, Finer},
    sums::Fixed,
};
use crate::{
    gpu::{BufferId, Lifetime, PassBuilder, Resource},
    methods::Tally,
    passes::{
        PlanError,
        light::{Column, Corners, Photons},
    },
};

/// What a centre's photon must tell.
pub const COLUMNS: &[Column] = &[Column::Hit, Column::Flux, Column::Way];
/// Places beyond the map's where what arrived is summed, and what of it went as points (`SLOTS` of `glsl/maps/cells.glsl`).
pub const PLACES: u64 = 128;
/// Parts of large pieces that are listed for each photon of a view, and at most; what comes after is spread where it is found.
const LARGE_EACH: u64 = 16;
const LARGE_MOST: u64 = 1 << 18;
/// Bytes of one (`Large` of `glsl/maps/cells.glsl`).
const LARGE_BYTES: u64 = 52;
/// Words of the tally.
const TALLY_BYTES: u64 = 9 * 4;
/// Work groups that share the parts: enough for the widest device, and few enough to cost next to nothing where none is
/// listed.
const GROUPS: u32 = 4096;
/// Photons a sample that a work group's shared memory holds for 41 samples, of the 16 KiB that every device has.
const LAYERS_MOST: u32 = 10;
/// Invocations along one side of the other work groups.
const GROUP: u32 = 8;

/// Cells, planned.
pub struct Cells {
    corners: Corners,
    /// Of each view, how many parts of pieces are large.
    counts: BufferId,
    /// Pieces of cells that cover many texels.
    large: BufferId,
    finer: Option<Finer>,
    views: BufferId,
    /// Texels of the map.
    side: u32,
    /// Of a point's splat, texels.
    diameter: f32,
    tally: Tally,
}

/// Push constants of `glsl/maps/cells.comp`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct CellsPush {
    map: LargePush,
    size: [i32; 2],
    blur: f32,
}

/// Push constants of `glsl/maps/cells_large.comp`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct LargePush {
    side: i32,
    diameter: f32,
    light: u32,
    view: u32,
}

/// Push constants of `glsl/maps/cells_tally.comp`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct TallyPush {
    first: u32,
    views: u32,
}

/// Cells are added in integers alone.
///
/// # Errors
/// Where no buffer holds the map's sums.
pub fn check(axes: Axes<'_>, fixed: &Option<Fixed>, (side, layers): (u32, u32)) -> Result<(), PlanError> {
    if axes.splat != "cells" || fixed.is_some() {
        return Ok(());
    }
    Err(PlanError::Refused {
        what: format!("maps.splat=cells with so large a map, {layers} x {side} x {side} texels"),
        reason: "cells are added in integers, and a buffer of 128 MiB does not hold so many".into(),
        remedy: "lower maps.side, or set maps.splat=fixed".into(),
    })
}

impl Cells {
    /// Adds what all views share.
    ///
    /// # Errors
    /// Where a sample leaves more photons than are matched, and what the tracer of corners cannot do.
    pub fn plan(job: &mut Job<'_>, axes: Axes<'_>, side: u32, views: BufferId) -> Result<Option<Self>, PlanError> {
        if axes.splat != "cells" {
            return Ok(None);
        }
        if job.photons.layers() > LAYERS_MOST {
            return Err(PlanError::Refused {
                what: format!("maps.splat=cells with light.layers={}", job.photons.layers()),
                reason: format!("a work group has memory for {LAYERS_MOST} photons of each of a cell's samples"),
                remedy: format!("set light.layers={LAYERS_MOST} or less, or maps.splat=fixed"),
            });
        }
        let corners = Corners::plan(job.work.plan, job.bench, &[Column::Hit, Column::Way])?;
        let count = job.emissions.len();
        let cells = u64::from(job.photons.side).pow(2);
        let counts = job.work.plan.upload_once("maps/cells.counts", &vec![0u32; count]);
        let places = (LARGE_EACH * cells * u64::from(job.photons.layers())).min(LARGE_MOST);
        let large = job.work.plan.buffer("maps/cells.large", places * LARGE_BYTES, Lifetime::Frame);
        let finer = Finer::plan(job, side);
        let each = |[x, y]: [u32; 2]| u64::from(x) * u64::from(y) + u64::from(x + 1) * u64::from(y + 1);
        let samples = job.emissions.iter().map(|emission| each(emission.held())).sum();
        let buffer = job.work.plan.buffer("maps/cells.tally", TALLY_BYTES, Lifetime::Frame);
        let diameter = job.work.settings.whole(&SPLAT_SIZE) as f32;
        Ok(Some(Self { corners, counts, large, finer, views, side, diameter, tally: Tally { buffer, samples } }))
    }

    /// Adds the cells of one view to the sums.
    pub fn gather(&self, job: &mut Job<'_>, fixed: &Fixed, view: usize, name_of: &dyn Fn(&str) -> String) {
        self.corners.trace(job.work.plan, job.bench, view);
        let emission = &job.emissions[view];
        let (side, diameter) = (self.side as i32, self.diameter);
        let map = LargePush { side, diameter, light: emission.lamp, view: view as u32 };
        let blur = finer::blur(job, self.side, diameter);
        let push = CellsPush { map, size: emission.held().map(|n| n as i32), blur };
        let groups = [job.photons.side.div_ceil(GROUP), job.photons.side.div_ceil(GROUP), 1];
        if let Some(finer) = &self.finer {
            let pass = job.photons.define(finer.weigh(job.work.plan.pass(&name_of("maps/cells.weigh"))));
            let pass = pass.with(self.photons(job.photons, COLUMNS, emission.side)).read("maps_views", self.views);
            pass.push(&push).dispatch("maps/cells_weigh.comp", groups, GROUP * GROUP);
            finer.pay(job.photons.define(job.work.plan.pass(&name_of("maps/cells.pay"))), view);
        }
        let pass = job.photons.define(self.give(fixed, job.work.plan.pass(&name_of("maps/cells"))));
        let pass = pass.with(self.photons(job.photons, COLUMNS, emission.side)).read("maps_views", self.views);
        let pass = self.finer.iter().fold(pass, |pass, finer| finer.begin(pass));
        pass.push(&push).dispatch("maps/cells.comp", groups, GROUP * GROUP);
        if let Some(finer) = &self.finer {
            let known = self.photons(job.photons, &[Column::Hit, Column::Way], emission.side);
            finer.refine(
                job,
                view,
                (side, diameter, blur),
                (&known, &|pass| self.give(fixed, pass).read("maps_views", self.views)),
                name_of,
            );
        }
        let pass = self.give(fixed, job.work.plan.pass(&name_of("maps/cells.large")));
        pass.push(&map).dispatch("maps/cells_large.comp", [GROUPS, 1, 1], GROUP * GROUP);
    }

    /// What all passes over cells read and write.
    fn give<'p>(&self, fixed: &Fixed, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        fixed.give(pass).write("cells_counts", self.counts).write("cells_large", self.large)
    }

    /// Columns of the photons of a view's centres, and all that is known of its corners.
    fn photons(&self, centres: &Photons, columns: &[Column], side: u32) -> Vec<(&'static str, Resource)> {
        let photons = self.corners.photons(side);
        let column = |name, column| Some((name, Resource::Image(photons.column(column)?)));
        let corners = [column("corners_hit", Column::Hit), column("corners_way", Column::Way)];
        centres.fetch(columns).into_iter().chain(corners.into_iter().flatten()).collect()
    }

    /// Adds the pass that reads what all views' cells brought, after the last of them.
    pub fn tally(&self, job: &mut Job<'_>, fixed: &Fixed, layers: u32) {
        let views = job.emissions.len() as u32;
        let pass = fixed.resolving(job.work.plan.pass("maps/cells.tally")).write("cells_tally", self.tally.buffer);
        let pass = pass.write("cells_counts", self.counts);
        let pass = self.finer.iter().fold(pass, |pass, finer| finer.count(pass));
        let first = self.side * self.side * layers;
        pass.push(&TallyPush { first, views }).dispatch("maps/cells_tally.comp", [1, 1, 1], GROUP * GROUP);
    }

    /// What the tally holds.
    pub fn counted(&self) -> Tally {
        self.tally
    }
}
