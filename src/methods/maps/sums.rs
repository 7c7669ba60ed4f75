//! How splats are summed: exactly, in fixed point, or as the paper does, by blending float32.
//!
//! Blending n photons alike into one texel errs by up to n 2⁻²⁵ of it: each addition rounds the sum the same way. In
//! fixed point each photon is rounded once, to its 2⁻³¹, and what follows is exact.

use super::{Axes, Job, cells, large};
use crate::{
    gpu::{BufferId, ImageId, PassBuilder},
    passes::light,
};

/// Every Vulkan device binds storage buffers of this size (`maxStorageBufferRange`).
const BOUND: u64 = 1 << 27;
/// Bytes a texel: three bands of 64 bits.
const BYTES: u64 = 24;
/// Invocations along one side of work groups.
const GROUP: u32 = 8;

/// Sums of a map in fixed point.
pub struct Fixed {
    sums: BufferId,
    /// Units a watt, and watts a unit: powers of two, which may be others when the scene has moved.
    unit: BufferId,
}

/// Bytes of a map's sums.
fn bytes(splat: &str, side: u32, layers: u64) -> u64 {
    let beyond = if splat == "cells" { cells::PLACES } else { 0 };
    (u64::from(side).pow(2).saturating_mul(layers)).saturating_add(beyond).saturating_mul(BYTES)
}

/// Why no buffer holds the sums of cells in so many layers, if none does.
pub fn too_large_for_cells(side: u32, layers: u64) -> Option<String> {
    let bytes = bytes("cells", side, layers);
    (bytes > BOUND).then(|| {
        format!(
            "cells in up to {layers} layers would take {bytes} bytes of sums, more than a buffer of 128 MiB holds: light is \
             spread by fixed splats (lower maps.side, or set maps.splat)"
        )
    })
}

/// Whether the map's sums are in fixed point, and where; `None` where blending was asked for, or no buffer holds them.
pub fn fixed(job: &mut Job<'_>, axes: Axes<'_>, side: u32, layers: u32) -> Option<Fixed> {
    let bytes = bytes(axes.splat, side, u64::from(layers));
    let reason = match axes.traverse {
        drawn if drawn != "compute" => format!("maps.traverse = {drawn}: splats are drawn, and so blended"),
        _ if large::all_drawn(job, axes) => {
            "splats of maps.splat_size are not below maps.raster_from: they are drawn, and so blended".to_owned()
        }
        _ if bytes > BOUND => {
            format!("{bytes} bytes of sums are more than a buffer of 128 MiB holds: splats are blended")
        }
        _ => {
            let sums = job.work.plan.upload_once("maps/sums", &vec![0u8; bytes as usize]);
            let unit = light::flux_unit(job.emissions);
            return Some(Fixed { sums, unit: job.work.plan.upload("maps/unit", &[unit.recip() as f32, unit as f32]) });
        }
    };
    job.work.plan.leave_out("maps/resolve", reason);
    None
}

impl Fixed {
    /// Gives a pass the sums to add to.
    pub fn give<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        pass.read("flux_unit", self.unit).write("flux_sums", self.sums)
    }

    /// Gives a pass the sums to read, and to begin anew.
    pub fn resolving<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        pass.write("maps_sums", self.sums).read("maps_unit", self.unit)
    }

    /// Adds the photons of one view to the sums.
    pub fn gather(&self, pass: PassBuilder<'_>, [side, layers]: [u32; 2]) {
        let groups = [side.div_ceil(GROUP), side.div_ceil(GROUP), layers];
        self.give(pass).dispatch("maps/gather_fixed.comp", groups, GROUP * GROUP);
    }

    /// The map of all views' sums, on top of what was `drawn` to it.
    pub fn resolve(&self, job: &mut Job<'_>, map: ImageId, side: u32, drawn: bool) {
        let groups = [side.div_ceil(GROUP), side.div_ceil(GROUP), job.work.plan.image_decl(map).layers];
        let pass = self.resolving(job.work.plan.pass("maps/resolve"));
        let pass = if drawn { pass.define("DRAWN", 1) } else { pass };
        pass.store("maps_map", map).push(&(side as i32)).dispatch("maps/resolve.comp", groups, GROUP * GROUP);
    }
}
