//! Timestamps around passes, and counters taken in runs of their own.

use ash::vk;
use std::sync::Arc;

use super::{
    choose::Feature,
    device::Shared,
    error::{GpuError, Named},
};

/// The times of one run of a phase.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameTimes {
    /// Milliseconds on the device for each pass, in recorded order.
    pub passes: Vec<f64>,
    /// From the first pass's beginning to the last one's end, ms on the device.
    pub span_ms: f64,
    /// From the start of recording to the fence, ms on the host.
    pub wall_ms: f64,
    /// Recording and submitting, ms on the host.
    pub record_ms: f64,
}

/// What a pass did, counted outside the timed frames. `None` where the device cannot count it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PassCounters {
    /// Points drawn, where it draws points.
    pub points: Option<u64>,
    /// Fragments written.
    pub fragments: Option<u64>,
    /// Vertex or compute invocations.
    pub invocations: Option<u64>,
    /// Bytes of what it writes.
    pub bytes: u64,
}

struct Pool {
    shared: Arc<Shared>,
    handle: vk::QueryPool,
    count: u32,
}

impl Pool {
    fn new(
        shared: &Arc<Shared>,
        kind: vk::QueryType,
        count: u32,
        statistics: vk::QueryPipelineStatisticFlags,
    ) -> Result<Self, GpuError> {
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(kind)
            .query_count(count.max(1))
            .pipeline_statistics(statistics);
        // SAFETY: destroyed on drop, after the program waited for the device.
        let handle = unsafe { shared.device.create_query_pool(&info, None) }.named("vkCreateQueryPool")?;
        Ok(Self { shared: shared.clone(), handle, count: count.max(1) })
    }

    fn reset(&self) {
        // SAFETY: host reset is enabled, and no command buffer that uses the pool is pending.
        unsafe { self.shared.device.reset_query_pool(self.handle, 0, self.count) }
    }

    /// `count` queries from `first`, N values each.
    fn read<const N: usize>(&self, first: usize, count: usize) -> Result<Vec<[u64; N]>, GpuError> {
        let mut values = vec![[0u64; N]; count];
        if count > 0 {
            // SAFETY: one slice element is one query of N values; the work has ended, so nothing waits.
            unsafe {
                self.shared.device.get_query_pool_results(
                    self.handle,
                    first as u32,
                    &mut values,
                    vk::QueryResultFlags::TYPE_64,
                )
            }
            .named("vkGetQueryPoolResults")?;
        }
        Ok(values)
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        // SAFETY: no pending command buffer uses it.
        unsafe { self.shared.device.destroy_query_pool(self.handle, None) }
    }
}

/// Queries for the passes of one phase.
pub(super) struct Timer {
    stamps: Pool,
    fragments: Option<Pool>,
    statistics: Option<Pool>,
    passes: usize,
    period_ms: f64,
    /// The bits of a timestamp that count; it wraps around beyond them.
    mask: u64,
}

impl Timer {
    pub fn new(shared: &Arc<Shared>, passes: usize) -> Result<Self, GpuError> {
        let count = passes as u32;
        let none = vk::QueryPipelineStatisticFlags::empty();
        // Not the compute-invocations bit: some drivers crash on it at a dispatch.
        let wanted = vk::QueryPipelineStatisticFlags::INPUT_ASSEMBLY_VERTICES
            | vk::QueryPipelineStatisticFlags::VERTEX_SHADER_INVOCATIONS;
        let has = |f| shared.info.features.contains(&f);
        let make = |wants: bool, kind, flags| wants.then(|| Pool::new(shared, kind, count, flags)).transpose();
        Ok(Self {
            stamps: Pool::new(shared, vk::QueryType::TIMESTAMP, 2 * count, none)?,
            fragments: make(has(Feature::PreciseOcclusion), vk::QueryType::OCCLUSION, none)?,
            statistics: make(has(Feature::Statistics), vk::QueryType::PIPELINE_STATISTICS, wanted)?,
            passes,
            period_ms: f64::from(shared.info.timestamp_period) * 1e-6,
            mask: u64::MAX.checked_shr(64 - shared.info.timestamp_bits.clamp(1, 64)).unwrap_or(u64::MAX),
        })
    }

    pub fn reset(&self) {
        for pool in [Some(&self.stamps), self.fragments.as_ref(), self.statistics.as_ref()].into_iter().flatten() {
            pool.reset();
        }
    }

    /// A timestamp after everything before it has ended: at a boundary, never at the top of the pipe.
    pub fn stamp(&self, commands: vk::CommandBuffer, index: usize) {
        let device = &self.stamps.shared.device;
        // SAFETY: recording; the index is below the pool's count.
        unsafe {
            device.cmd_write_timestamp2(
                commands,
                vk::PipelineStageFlags2::ALL_COMMANDS,
                self.stamps.handle,
                index as u32,
            );
        }
    }

    pub fn begin_counting(&self, commands: vk::CommandBuffer, pass: usize) {
        for (pool, flags) in self.counting() {
            // SAFETY: recording, outside any rendering, index below the count.
            unsafe { pool.shared.device.cmd_begin_query(commands, pool.handle, pass as u32, flags) }
        }
    }

    pub fn end_counting(&self, commands: vk::CommandBuffer, pass: usize) {
        for (pool, _) in self.counting() {
            // SAFETY: begun by `begin_counting` in this command buffer.
            unsafe { pool.shared.device.cmd_end_query(commands, pool.handle, pass as u32) }
        }
    }

    fn counting(&self) -> impl Iterator<Item = (&Pool, vk::QueryControlFlags)> {
        let precise = self.fragments.iter().map(|p| (p, vk::QueryControlFlags::PRECISE));
        precise.chain(self.statistics.iter().map(|p| (p, vk::QueryControlFlags::empty())))
    }

    /// Milliseconds of each pass, and the span of all.
    pub fn times(&self) -> Result<(Vec<f64>, f64), GpuError> {
        let stamps = self.stamps.read::<1>(0, 2 * self.passes)?;
        let ms = |from: u64, to: u64| (to.wrapping_sub(from) & self.mask) as f64 * self.period_ms;
        let passes = stamps.chunks_exact(2).map(|pair| ms(pair[0][0], pair[1][0])).collect();
        let span = match (stamps.first(), stamps.last()) {
            (Some(first), Some(last)) => ms(first[0], last[0]),
            _ => 0.0,
        };
        Ok((passes, span))
    }

    /// Fragments, then assembled vertices and vertex invocations of one pass.
    pub fn counted(&self, pass: usize) -> Result<(Option<u64>, Option<[u64; 2]>), GpuError> {
        let fragments = self.fragments.as_ref().map(|pool| pool.read::<1>(pass, 1)).transpose()?;
        let statistics = self.statistics.as_ref().map(|pool| pool.read::<2>(pass, 1)).transpose()?;
        Ok((fragments.map(|f| f[0][0]), statistics.map(|s| s[0])))
    }
}
