//! A plan made real: allocated, compiled, uploaded once; then recorded every frame.

use ash::vk;
use gpu_allocator::MemoryLocation;
use std::{
    rc::Rc,
    sync::{Arc, atomic::Ordering::Relaxed},
    time::Instant,
};

use super::{
    access::{Access, Barrier},
    device::{Gpu, Shared},
    error::{GpuError, Named},
    memory::{Buffer, Format, Image},
    pipeline::{Pipeline, RasterState, Stage},
    plan::{BufferDecl, BufferId, Groups, ImageId, PassDecl, Phase, Plan, Row, Work},
    record::{self, buffer_barrier, image_barrier},
    shader::{ShaderKind, Sources},
    staging::Staging,
    timer::{FrameTimes, PassCounters, Timer},
};
use crate::store::Store;

/// How much of an earlier program a re-plan could keep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reused {
    /// Buffers and images taken over.
    pub kept: usize,
    /// Buffers and images made.
    pub made: usize,
}

/// A plan ready to run.
pub struct Program {
    pub(super) shared: Arc<Shared>,
    pub(super) plan: Plan,
    pub(super) buffers: Vec<Rc<Buffer>>,
    pub(super) images: Vec<Rc<Image>>,
    /// Of each pass, but for copies.
    pub(super) pipelines: Vec<Option<Arc<Pipeline>>>,
    pub(super) staging: Staging,
    phases: Vec<(Phase, Vec<usize>, Timer)>,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
    reused: Reused,
}

impl Program {
    /// Allocates, compiles and uploads what the plan lists; `old` gives what did not change.
    pub fn new(gpu: &Gpu, plan: Plan, sources: &Sources, store: &Store, old: Option<&Self>) -> Result<Self, GpuError> {
        let shared = &gpu.0;
        check_memory(shared, &plan)?;
        let pipelines =
            plan.passes.iter().map(|p| prepare_pass(shared, &plan, p, sources, store)).collect::<Result<_, _>>()?;
        let mut reused = Reused::default();
        let mut fresh = Vec::new();
        let mut buffers = Vec::new();
        for decl in &plan.buffers {
            let kept = old.and_then(|o| o.kept(decl));
            count(&mut reused, kept.is_some());
            if kept.is_none() && decl.content.is_some() {
                fresh.push(buffers.len());
            }
            buffers.push(match kept {
                Some(kept) => kept,
                None => Rc::new(Buffer::create(shared, &decl.name, decl.bytes, MemoryLocation::GpuOnly)?),
            });
        }
        let mut images = Vec::new();
        for decl in &plan.images {
            let kept = old.and_then(|o| o.plan.images.iter().position(|d| d == decl).map(|i| o.images[i].clone()));
            count(&mut reused, kept.is_some());
            images.push(match kept {
                Some(kept) => kept,
                None => {
                    let d = decl;
                    Rc::new(Image::create(shared, &d.name, d.extent, d.layers, d.format, d.array)?)
                }
            });
        }
        let phases = [Phase::Prepare, Phase::Frame, Phase::Account]
            .into_iter()
            .map(|phase| {
                let passes: Vec<usize> = (0..plan.passes.len()).filter(|&i| plan.passes[i].phase == phase).collect();
                let timer = Timer::new(shared, passes.len())?;
                Ok((phase, passes, timer))
            })
            .collect::<Result<_, GpuError>>()?;
        let staging = Staging::new(shared, &plan)?;
        let info = vk::CommandBufferAllocateInfo::default().command_pool(shared.pool).command_buffer_count(1);
        // SAFETY: pool and fence belong to the live device; both handles are released in `drop`.
        let (commands, fence) = unsafe {
            let fence = shared.device.create_fence(&Default::default(), None).named("vkCreateFence")?;
            match shared.device.allocate_command_buffers(&info).named("vkAllocateCommandBuffers") {
                Ok(made) => (made[0], fence),
                Err(e) => {
                    shared.device.destroy_fence(fence, None);
                    return Err(e);
                }
            }
        };
        let mut program =
            Self { shared: shared.clone(), plan, buffers, images, pipelines, staging, phases, commands, fence, reused };
        for index in fresh {
            program.upload(index)?;
        }
        Ok(program)
    }

    /// The buffer that is as declared and holds what is declared.
    fn kept(&self, decl: &BufferDecl) -> Option<Rc<Buffer>> {
        let index = self.plan.buffers.iter().position(|d| d == decl)?;
        self.staging.is_settled(index).then(|| self.buffers[index].clone())
    }

    /// The plan, as recorded.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What a re-plan kept.
    pub fn reused(&self) -> Reused {
        self.reused
    }

    /// The passes of a phase, in order.
    pub fn passes(&self, phase: Phase) -> impl Iterator<Item = &PassDecl> {
        self.phase(phase).0.iter().map(|&i| &self.plan.passes[i])
    }

    fn phase(&self, phase: Phase) -> (&[usize], &Timer) {
        // The three phases are listed in `new`, in the order of the enum.
        let (_, passes, timer) = &self.phases[phase as usize];
        (passes, timer)
    }

    fn upload(&mut self, index: usize) -> Result<(), GpuError> {
        let decl = &self.plan.buffers[index];
        let Some(content) = decl.content.clone().filter(|c| !c.is_empty()) else { return Ok(()) };
        let bytes = content.len() as u64;
        let mut staging = Buffer::create(&self.shared, "staging", bytes, MemoryLocation::CpuToGpu)?;
        if let Some(memory) = staging.mapped_mut() {
            memory[..content.len()].copy_from_slice(&content);
        }
        let target = &self.buffers[index];
        let before = target.history.borrow_mut().advance(Access::CopyWrite, false);
        self.shared.run_once(|commands| {
            self.barriers(commands, before.iter().map(|b| buffer_barrier(b, target)).collect(), Vec::new());
            let region = [vk::BufferCopy { src_offset: 0, dst_offset: 0, size: bytes }];
            // SAFETY: both buffers hold `bytes` and live until the queue is idle.
            unsafe { self.shared.device.cmd_copy_buffer(commands, staging.handle, target.handle, &region) }
        })
    }

    pub(super) fn barriers(
        &self,
        commands: vk::CommandBuffer,
        buffers: Vec<vk::BufferMemoryBarrier2<'_>>,
        images: Vec<vk::ImageMemoryBarrier2<'_>>,
    ) {
        self.shared.barriers(commands, buffers, images);
    }

    /// Runs the passes of a phase: records, submits, and waits for the end. `updates` change small buffers first.
    pub fn run(&mut self, phase: Phase, updates: &[(BufferId, &[u8])]) -> Result<FrameTimes, GpuError> {
        self.execute(phase, updates, false)
    }

    /// As [`Self::run`], and counts what each pass does.
    pub fn count(
        &mut self,
        phase: Phase,
        updates: &[(BufferId, &[u8])],
    ) -> Result<Vec<(String, PassCounters)>, GpuError> {
        self.execute(phase, updates, true)?;
        let (passes, timer) = self.phase(phase);
        passes
            .iter()
            .enumerate()
            .map(|(slot, &index)| {
                let pass = &self.plan.passes[index];
                let mut counters = PassCounters { bytes: self.plan.bytes_written(pass), ..Default::default() };
                match &pass.work {
                    Work::Compute { groups, local, .. } => {
                        let (groups, points) = self.groups(groups)?;
                        let groups = groups.map(|groups| groups.map(u64::from).iter().product::<u64>());
                        counters.invocations = groups.map(|groups| groups * u64::from(*local));
                        counters.points = points;
                    }
                    Work::Copy { .. } => {}
                    Work::Raster { topology, .. } => {
                        let (fragments, vertices) = timer.counted(slot)?;
                        counters.fragments = fragments;
                        counters.invocations = vertices.map(|v| v[1]);
                        if *topology == super::Topology::Points {
                            counters.points = vertices.map(|v| v[0]);
                        }
                    }
                }
                Ok((pass.name.clone(), counters))
            })
            .collect()
    }

    /// Work groups of a dispatch, and the points that they took where the device counted them. A row without any tells
    /// neither: a later pass of the frame may have begun it anew.
    fn groups(&self, groups: &Groups) -> Result<(Option<[u32; 3]>, Option<u64>), GpuError> {
        match *groups {
            Groups::Fixed(groups) => Ok((Some(groups), None)),
            Groups::Counted(Row { rows, row }) => {
                let words: Vec<u32> = bytemuck::pod_collect_to_vec(&self.read_buffer(rows)?);
                let first = row as usize * Row::WORDS;
                let [x, y, z, points] = std::array::from_fn(|at| words[first + at]);
                Ok(if x > 0 { (Some([x, y, z]), Some(points.into())) } else { (None, None) })
            }
        }
    }

    fn execute(&mut self, phase: Phase, updates: &[(BufferId, &[u8])], counting: bool) -> Result<FrameTimes, GpuError> {
        let shared = self.shared.clone();
        if let Some(capture) = &shared.capture {
            capture.start();
        }
        let start = Instant::now();
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the command buffer is not pending: every run waits for its fence.
        unsafe {
            shared.device.begin_command_buffer(self.commands, &begin).named("vkBeginCommandBuffer")?;
            self.copy_waiting();
            let (passes, timer) = self.phase(phase);
            timer.reset();
            record::updates(self, updates);
            for (slot, &index) in passes.iter().enumerate() {
                record::pass(self, index, slot, timer, counting);
            }
            shared.device.end_command_buffer(self.commands).named("vkEndCommandBuffer")?;
            let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands)];
            let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
            shared.calls.submits.fetch_add(1, Relaxed);
            shared.device.queue_submit2(shared.queue, &submit, self.fence).named("vkQueueSubmit2")?;
            let record_ms = start.elapsed().as_secs_f64() * 1e3;
            shared.calls.waits.fetch_add(1, Relaxed);
            shared.device.wait_for_fences(&[self.fence], true, u64::MAX).named("vkWaitForFences")?;
            let wall_ms = start.elapsed().as_secs_f64() * 1e3;
            shared.device.reset_fences(&[self.fence]).named("vkResetFences")?;
            if let Some(capture) = &shared.capture {
                capture.end();
            }
            let (passes, span_ms) = timer.times()?;
            Ok(FrameTimes { passes, span_ms, wall_ms, record_ms })
        }
    }

    pub(super) fn commands(&self) -> vk::CommandBuffer {
        self.commands
    }

    /// All texels of an image, layer by layer, rows from the top, channels interleaved.
    pub fn read_image(&self, id: ImageId) -> Result<Vec<f32>, GpuError> {
        let image = &self.images[id.0];
        let bytes = self.plan.images[id.0].bytes();
        let staging = Buffer::create(&self.shared, "read-back", bytes, MemoryLocation::GpuToCpu)?;
        let before = image.history.borrow_mut().advance(Access::CopyRead, true);
        let region = [image.whole()];
        self.shared.run_once(|commands| {
            self.barriers(commands, Vec::new(), before.iter().map(|b| image_barrier(b, image)).collect());
            // SAFETY: the buffer holds the whole image; both live until the queue is idle.
            unsafe {
                self.shared.device.cmd_copy_image_to_buffer(
                    commands,
                    image.handle,
                    vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                    staging.handle,
                    &region,
                );
            }
            self.to_host(commands, &staging);
        })?;
        self.shared.calls.reads.fetch_add(1, Relaxed);
        let memory = staging.mapped().unwrap_or_default().get(..bytes as usize).unwrap_or_default();
        let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        Ok(match image.format {
            // The indices as numbers, the float32 as what they are.
            Format::Rgba32u => memory
                .chunks_exact(16)
                .flat_map(|t| {
                    let [a, b, u, v] = [0, 4, 8, 12].map(|at| word(&t[at..at + 4]));
                    [a as f32, b as f32, f32::from_bits(u), f32::from_bits(v)]
                })
                .collect(),
            Format::Rgba16f => {
                memory.chunks_exact(2).map(|b| half::f16::from_le_bytes([b[0], b[1]]).to_f32()).collect()
            }
            _ => memory.chunks_exact(4).map(|b| f32::from_bits(word(b))).collect(),
        })
    }

    /// All bytes of a buffer, as declared.
    pub fn read_buffer(&self, id: BufferId) -> Result<Vec<u8>, GpuError> {
        let buffer = &self.buffers[id.0];
        let bytes = self.plan.buffers[id.0].bytes;
        let staging = Buffer::create(&self.shared, "read-back", buffer.bytes, MemoryLocation::GpuToCpu)?;
        let before = buffer.history.borrow_mut().advance(Access::CopyRead, false);
        self.shared.run_once(|commands| {
            self.barriers(commands, before.iter().map(|b| buffer_barrier(b, buffer)).collect(), Vec::new());
            let region = [vk::BufferCopy { src_offset: 0, dst_offset: 0, size: buffer.bytes }];
            // SAFETY: both buffers hold that many bytes and live until the queue is idle.
            unsafe { self.shared.device.cmd_copy_buffer(commands, buffer.handle, staging.handle, &region) }
            self.to_host(commands, &staging);
        })?;
        self.shared.calls.reads.fetch_add(1, Relaxed);
        Ok(staging.mapped().unwrap_or_default().get(..bytes as usize).unwrap_or_default().to_vec())
    }

    fn to_host(&self, commands: vk::CommandBuffer, staging: &Buffer) {
        let b = Barrier { from: Access::CopyWrite.scope(), to: Access::HostRead.scope() };
        self.barriers(commands, vec![buffer_barrier(&b, staging)], Vec::new());
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // SAFETY: nothing of this program is pending after the wait; the handles are its own.
        unsafe {
            let _ = self.shared.device.device_wait_idle();
            self.shared.device.free_command_buffers(self.shared.pool, &[self.commands]);
            self.shared.device.destroy_fence(self.fence, None);
        }
    }
}

/// Refuses a plan that the device's memory cannot hold, before anything is allocated.
fn check_memory(shared: &Shared, plan: &Plan) -> Result<(), GpuError> {
    let (bytes, memory) = (plan.bytes(), shared.info.memory_bytes);
    if bytes <= memory {
        return Ok(());
    }
    let images = plan.images.iter().map(|i| (i.bytes(), &i.name));
    let largest = images.chain(plan.buffers.iter().map(|b| (b.bytes, &b.name))).max();
    let name = largest.map(|(_, name)| name.clone()).unwrap_or_default();
    let gib = |bytes: u64| bytes as f64 / (1u64 << 30) as f64;
    let text = format!(
        "the plan needs {:.2} GiB, the device has {:.2} GiB; lower light.side, maps.side, eye.samples or --size",
        gib(bytes),
        gib(memory)
    );
    Err(GpuError::TooLarge { name, text })
}

fn count(reused: &mut Reused, kept: bool) {
    *(if kept { &mut reused.kept } else { &mut reused.made }) += 1;
}

/// Compiles a pass's shaders and makes its pipeline, then holds its bindings against the shader's.
fn prepare_pass(
    shared: &Shared,
    plan: &Plan,
    pass: &PassDecl,
    sources: &Sources,
    store: &Store,
) -> Result<Option<Arc<Pipeline>>, GpuError> {
    let (files, raster) = match &pass.work {
        Work::Copy { .. } => return Ok(None),
        Work::Compute { shader, .. } => (std::slice::from_ref(shader), None),
        Work::Raster { shaders, targets, depth, topology, streamed, .. } => {
            let colors = targets.iter().map(|t| (plan.images[t.image.0].format.vk(), t.blend)).collect();
            let attributes = pass.attributes.iter().map(|&(_, format)| format).collect();
            let (depth, streams) = (depth.is_some(), streamed.is_some());
            let state = RasterState { colors, depth, topology: *topology, attributes, streams };
            (shaders.as_slice(), Some(state))
        }
    };
    let stages = files
        .iter()
        .map(|file| {
            let words = sources.compile(file, &pass.defines, &pass.provided, store)?;
            Ok(Stage { kind: ShaderKind::of(file).unwrap_or(ShaderKind::Compute), words })
        })
        .collect::<Result<Vec<_>, GpuError>>()?;
    let pipeline = shared.pipeline(pass, &stages, raster.as_ref())?;
    pipeline.check(pass)?;
    Ok(Some(pipeline))
}
