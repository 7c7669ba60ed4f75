//! The account of every photon and every watt: taken once, outside the timed frames.

use super::light::Tracing;
use crate::gpu::{BufferId, Lifetime, Phase, Plan, Resource};

/// Statuses a photon can end in, and `emitted` in place 0 (`glsl/shared/photon.glsl`).
pub const STATUSES: usize = 10;

/// Names of the buckets in the order of the shader's statuses.
pub const BUCKETS: [&str; STATUSES] = [
    "emitted",
    "valid",
    "total_internal_reflection",
    "missed",
    "blocked",
    "absorbed",
    "bounce_limit",
    "outside_map",
    "no_layer",
    "faint",
];

/// A work group's sums (`AccountRow` of `glsl/light/account.comp`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of the shader
pub struct AccountRow {
    pub counts: [u32; STATUSES],
    pub bent: u32,
    pub flux: [f32; STATUSES],
    pub other: f32,
    pub absorbed: f32,
}

/// Photons and their flux by how they ended.
///
/// The flux in all buckets and of other paths sums to `emitted`, and so do the counts, but in class `all:N`: there a
/// sample that is emitted ends as often as it has branches, and each end is counted (a branch without flux is none).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// Photons by [`BUCKETS`].
    pub counts: [u64; STATUSES],
    /// Flux by [`BUCKETS`], W, mean of the bands; `absorbed` includes what photons of other buckets lost on the way.
    pub flux_w: [f64; STATUSES],
    /// Fresnel's share outside the path class, W.
    pub other_paths_w: f64,
    /// Times the geometric normal bent a ray in place of the interpolated one.
    pub bent: u64,
}

impl Account {
    /// Adds work groups' rows in their order, in float64.
    pub fn of(rows: &[AccountRow]) -> Self {
        let mut sum = Self::default();
        for row in rows {
            for k in 0..STATUSES {
                sum.counts[k] += u64::from(row.counts[k]);
                sum.flux_w[k] += f64::from(row.flux[k]);
            }
            sum.flux_w[5] += f64::from(row.absorbed);
            sum.other_paths_w += f64::from(row.other);
            sum.bent += u64::from(row.bent);
        }
        sum
    }

    /// Photons emitted: samples that meet a specular object, seen through what stands before it.
    pub fn emitted(&self) -> u64 {
        self.counts[0]
    }

    /// Flux emitted, W.
    pub fn emitted_w(&self) -> f64 {
        self.flux_w[0]
    }

    /// Photons that the method takes.
    pub fn valid(&self) -> u64 {
        self.counts[1]
    }

    /// Flux of the photons that the method takes, W.
    pub fn valid_w(&self) -> f64 {
        self.flux_w[1]
    }

    /// Flux that arrives at receivers but is fainter than what the photon buffer's layers hold, W.
    pub fn no_layer_w(&self) -> f64 {
        self.flux_w[8]
    }

    /// Flux that arrives at receivers where the map is not, W.
    pub fn outside_map_w(&self) -> f64 {
        self.flux_w[7]
    }
}

/// Adds the pass over one view; `capture` says which photons the method takes, and what it reads to know.
pub fn account(
    plan: &mut Plan,
    name: &str,
    tracing: &Tracing<'_>,
    capture: &(&'static str, Vec<(&'static str, Resource)>),
) -> BufferId {
    let bytes = u64::from(tracing.groups()).pow(2) * size_of::<AccountRow>() as u64;
    let rows = plan.buffer(name, bytes, Lifetime::Persistent);
    let pass = plan
        .pass(name)
        .phase(Phase::Account)
        .with(capture.1.iter().copied())
        .provide("capture.glsl", capture.0)
        .write("account_rows", rows);
    tracing.dispatch(pass, "light/account.comp");
    rows
}
