//! Adaptive emission in blocks (Wyman 2008, section 5, "adaptive emission", which it leaves to others): the view's grid of
//! light samples is cut into blocks, and in each one photon stands for as many slots of the photon image along both sides,
//! a power of two, as the light allows.
//!
//! One photon a block is the coarse pass. Each block's own and its neighbours' say how far apart photons of one slot each
//! would land, and whether they came the same way; the method says what that means in its map. A block whose one photon is
//! enough is done. The others' photons are listed by a prefix sum and traced by an indirect dispatch: nothing is read back,
//! and a ray that is not traced is not paid. A photon goes through the middle of the slots that it stands for, carries
//! their flux and lies in the first of them; the other slots hold none. What is thinner than a block, and lies where neither
//! its photon nor its neighbours' arrive, is lost; where one of them arrives it is traced densely.
//!
//! Cost: a ray for each block, and one for each listed photon; a word a block and view.

use super::{Column, Emission, Measure, Photons, TRACER, Taker, Tracing, photons, sides, sized};
use crate::{
    gpu::{BufferId, Lifetime, PassBuilder, Plan, Row},
    passes::{PlanError, refused},
    settings::Settings,
};

/// Invocations along one side of work groups over blocks.
const GROUP: u32 = 8;
/// Invocations of the work group that counts (`PREFIX_GROUP` of `glsl/shared/prefix.glsl`).
const COUNTING: u32 = 256;
/// Photons of a work group (`PHOTONS` of `glsl/light/blocks_count.comp`).
const PHOTONS: u32 = 64;

/// Every Vulkan device binds storage buffers of this size (`maxStorageBufferRange`).
const BOUND: u64 = 1 << 27;

/// The blocks of all views.
pub struct Blocks {
    /// log2 of a block's side.
    levels: u32,
    /// Words of strides that a view has.
    most: u32,
    strides: BufferId,
    /// Photons before each block, for each size of view.
    before: Vec<(u32, BufferId)>,
    /// Of each view, the groups of the dispatch and its photons.
    rows: BufferId,
}

/// Push constants of `glsl/light/blocks.comp`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct ChoosePush {
    size: [i32; 2],
    light: u32,
    view: u32,
    side: f32,
    apart: [f32; 2],
}

/// Push constants of `glsl/light/blocks_count.comp`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct CountPush {
    size: [i32; 2],
    view: u32,
}

impl Blocks {
    /// Adds what all views share, with blocks of 2^`levels` slots a side.
    ///
    /// # Errors
    /// Where a sample leaves several photons, or the tracer knows no others than one a slot.
    pub(super) fn plan(
        plan: &mut Plan,
        settings: &Settings,
        emissions: &[Emission],
        layers: Option<u32>,
        levels: u32,
    ) -> Result<Self, PlanError> {
        let tracer = settings.choice(&TRACER);
        if tracer != "bvh" {
            let what = format!("emission in blocks with light.tracer={tracer}");
            return refused(what, "its images show one sample a slot, and none between", "set light.tracer=bvh");
        }
        if layers.is_some() {
            let reason = "a sample leaves several photons, and which of its neighbours' each lies beside is not known";
            return refused("emission in blocks in class all:N", reason, "set light.paths to a class of one path");
        }
        let sides = sides(emissions);
        let most = along(sides.first().copied().unwrap_or(1), levels).pow(2);
        let bytes = 4 * u64::from(most) * emissions.len() as u64;
        if bytes > BOUND {
            let what = format!("emission in blocks of 2^{levels} with {} views", emissions.len());
            return refused(
                what,
                "a buffer of 128 MiB does not hold a word for each block",
                "raise maps.blocks, or lower light.side",
            );
        }
        // Until a frame has chosen: one photon a slot, for an account that is taken before.
        let strides = plan.upload_once("light/blocks.strides", &vec![0u32; most as usize * emissions.len()]);
        let mut each = |&side: &u32| {
            let bytes = 4 * (u64::from(along(side, levels)).pow(2) + 1);
            (side, plan.buffer(&sized("light/blocks.before", &sides, side), bytes, Lifetime::Frame))
        };
        let before = sides.iter().map(&mut each).collect();
        let rows = plan.buffer("light/blocks.rows", emissions.len() as u64 * Row::BYTES, Lifetime::Frame);
        Ok(Self { levels, most, strides, before, rows })
    }

    /// Tells a pass over a view of so many slots a side of the blocks, and gives it the strides if it asks for them.
    pub fn define<'p>(&self, pass: PassBuilder<'p>, side: u32) -> PassBuilder<'p> {
        let pass = self.tell(pass, side);
        pass.offer("block_strides", self.strides)
    }

    fn tell<'p>(&self, pass: PassBuilder<'p>, side: u32) -> PassBuilder<'p> {
        let pass = pass.define("BLOCK_LEVELS", self.levels).define("BLOCKS", along(side, self.levels));
        pass.define("BLOCKS_MOST", self.most)
    }

    /// Adds the passes that fill the photon buffer from a view.
    pub(super) fn photons(
        &self,
        plan: &mut Plan,
        tracing: &Tracing<'_>,
        taker: &impl Taker,
        name_of: &dyn Fn(&str) -> String,
    ) {
        let (side, view) = (tracing.photons.side, tracing.index as u32);
        let across = along(side, self.levels).div_ceil(GROUP);
        let pass = photons::columns(plan.pass(&name_of("light/photons.coarse")), tracing.photons).define("COARSE", 1);
        let pass = tracing.give(pass).push(&tracing.push());
        pass.dispatch("light/photons.comp", [across, across, 1], GROUP * GROUP);

        let Measure { file, reads, side: texels, apart } = taker.measure();
        let pass = self.tell(plan.pass(&name_of("light/blocks")), side).write("block_strides", self.strides);
        let pass = pass.with(tracing.photons.fetch(&[Column::Hit, Column::Flux, Column::Way]));
        let pass = pass.with(reads).provide("measure.glsl", file);
        let size = tracing.emission.held().map(|n| n as i32);
        let pass = pass.push(&ChoosePush { size, light: tracing.emission.lamp, view, side: texels, apart });
        pass.dispatch("light/blocks.comp", [across, across, 1], GROUP * GROUP);

        let before = self.before_of(tracing.photons);
        let pass = self.define(plan.pass(&name_of("light/blocks.count")), side).write("blocks_before", before);
        let pass = pass.write("blocks_rows", self.rows).push(&CountPush { size, view });
        pass.dispatch("light/blocks_count.comp", [1, 1, 1], COUNTING);

        let pass = photons::columns(plan.pass(&name_of("light/photons")), tracing.photons).define("LISTED", 1);
        let pass = tracing.give(pass).read("blocks_before", before).push(&tracing.push());
        pass.dispatch_counted("light/photons.comp", Row { rows: self.rows, row: view }, PHOTONS);
    }

    fn before_of(&self, photons: &Photons) -> BufferId {
        let found = self.before.iter().find(|(side, _)| *side == photons.side);
        found.unwrap_or(&self.before[0]).1
    }
}

/// Blocks along a side.
fn along(side: u32, levels: u32) -> u32 {
    side.div_ceil(1 << levels)
}
