//! The one place that records: barriers, bindings, timestamps and labels around each pass.

use ash::vk;
use std::ffi::CString;

use super::{
    access::{Access, Barrier},
    device::Shared,
    memory::{Buffer, Image},
    pipeline::{Pipeline, descriptor_type},
    plan::{BufferId, Groups, ImageId, PassDecl, Resource, Row, Stream, Work},
    program::Program,
    reflect::BindingKind,
    timer::Timer,
};

pub(super) fn buffer_barrier<'a>(b: &Barrier, buffer: &Buffer) -> vk::BufferMemoryBarrier2<'a> {
    vk::BufferMemoryBarrier2::default()
        .src_stage_mask(b.from.stages)
        .src_access_mask(b.from.access)
        .dst_stage_mask(b.to.stages)
        .dst_access_mask(b.to.access)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .buffer(buffer.handle)
        .size(vk::WHOLE_SIZE)
}

pub(super) fn image_barrier<'a>(b: &Barrier, image: &Image) -> vk::ImageMemoryBarrier2<'a> {
    barrier_of(b, image.handle, image.range())
}

/// Of an image that may be another's, as those of a swapchain are.
pub(super) fn barrier_of<'a>(
    b: &Barrier,
    image: vk::Image,
    range: vk::ImageSubresourceRange,
) -> vk::ImageMemoryBarrier2<'a> {
    vk::ImageMemoryBarrier2::default()
        .src_stage_mask(b.from.stages)
        .src_access_mask(b.from.access)
        .dst_stage_mask(b.to.stages)
        .dst_access_mask(b.to.access)
        .old_layout(b.from.layout)
        .new_layout(b.to.layout)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .image(image)
        .subresource_range(range)
}

impl Shared {
    /// Records barriers, outside rendering.
    pub fn barriers(
        &self,
        commands: vk::CommandBuffer,
        mut buffers: Vec<vk::BufferMemoryBarrier2<'_>>,
        mut images: Vec<vk::ImageMemoryBarrier2<'_>>,
    ) {
        if buffers.is_empty() && images.is_empty() {
            return;
        }
        // A stage that the device lacks may not be named, even beside others.
        let known = self.known_stages();
        for b in &mut buffers {
            (b.src_stage_mask, b.dst_stage_mask) = (b.src_stage_mask & known, b.dst_stage_mask & known);
        }
        for b in &mut images {
            (b.src_stage_mask, b.dst_stage_mask) = (b.src_stage_mask & known, b.dst_stage_mask & known);
        }
        let info = vk::DependencyInfo::default().buffer_memory_barriers(&buffers).image_memory_barriers(&images);
        // SAFETY: recording, outside rendering; handles are live.
        unsafe { self.device.cmd_pipeline_barrier2(commands, &info) }
    }
}

/// Writes small buffers from the command stream, before the first pass.
///
/// # Safety
/// The program's command buffer is recording.
pub(super) unsafe fn updates(program: &Program, updates: &[(BufferId, &[u8])]) {
    let commands = program.commands();
    for (id, bytes) in updates {
        let buffer = &program.buffers[id.0];
        let before = buffer.history.borrow_mut().advance(Access::CopyWrite, false);
        program.barriers(commands, before.iter().map(|b| buffer_barrier(b, buffer)).collect(), Vec::new());
        // SAFETY: the buffer holds at least these bytes, a multiple of four and below 64 KiB by its declaration.
        unsafe { program.shared.device.cmd_update_buffer(commands, buffer.handle, 0, bytes) }
    }
}

/// Records one pass.
///
/// # Safety
/// The program's command buffer is recording, and the pass's resources are alive.
pub(super) unsafe fn pass(program: &Program, index: usize, slot: usize, timer: &Timer, counting: bool) {
    let (pass, pipeline, commands) = (&program.plan.passes[index], &program.pipelines[index], program.commands());
    let device = &program.shared.device;
    let counts = counting && matches!(pass.work, Work::Raster { .. });
    // SAFETY: recording is promised by the caller; queries begin and end outside rendering.
    unsafe {
        label(program, commands, Some(&pass.name));
        resource_barriers(program, pass);
        settle(device, commands);
        timer.stamp(commands, 2 * slot);
        settle(device, commands);
        if counts {
            timer.begin_counting(commands, slot);
        }
        if let Some(pipeline) = pipeline {
            device.cmd_bind_pipeline(commands, pipeline.point, pipeline.handle);
            bind(program, pass, pipeline);
        }
        match &pass.work {
            Work::Compute { groups: Groups::Fixed([x, y, z]), .. } => device.cmd_dispatch(commands, *x, *y, *z),
            Work::Compute { groups: Groups::Counted(row), .. } => {
                let rows = program.buffers[row.rows.0].handle;
                device.cmd_dispatch_indirect(commands, rows, u64::from(row.row) * Row::BYTES);
            }
            Work::Copy { copies } => copies.iter().for_each(|&copied| copy(program, copied)),
            Work::Raster { .. } => draw(program, pass),
        }
        if counts {
            timer.end_counting(commands, slot);
        }
        timer.stamp(commands, 2 * slot + 1);
        label(program, commands, None);
    }
}

/// Keeps passes apart, so that each is charged for its own work alone: a timestamp orders nothing by itself. Passes
/// that share nothing would overlap on a GPU; a software rasteriser bins timestamps with its draws while its dispatches
/// run at once, and would charge a dispatch to the pass after it.
///
/// # Safety
/// The command buffer is recording, outside rendering.
unsafe fn settle(device: &ash::Device, commands: vk::CommandBuffer) {
    let all = vk::PipelineStageFlags2::ALL_COMMANDS;
    let barrier = [vk::MemoryBarrier2::default().src_stage_mask(all).dst_stage_mask(all)];
    // SAFETY: promised by the caller.
    unsafe { device.cmd_pipeline_barrier2(commands, &vk::DependencyInfo::default().memory_barriers(&barrier)) }
}

/// # Safety
/// The command buffer is recording.
unsafe fn label(program: &Program, commands: vk::CommandBuffer, begin: Option<&str>) {
    let Some(labels) = &program.shared.labels else { return };
    // SAFETY: promised by the caller; every begin has its end in `pass`.
    unsafe {
        match begin {
            Some(name) => {
                let name = CString::new(name).unwrap_or_default();
                let info = vk::DebugUtilsLabelEXT::default().label_name(&name);
                labels.cmd_begin_debug_utils_label(commands, &info);
            }
            None => labels.cmd_end_debug_utils_label(commands),
        }
    }
}

/// Every resource of the pass is brought to the access that the pass declares.
fn resource_barriers(program: &Program, pass: &PassDecl) {
    let (mut buffers, mut images) = (Vec::new(), Vec::new());
    let mut image = |at: usize, access| {
        let image = &program.images[at];
        images.extend(image.history.borrow_mut().advance(access, true).map(|b| image_barrier(&b, image)));
    };
    let mut buffer = |at: usize, access| {
        let buffer = &program.buffers[at];
        buffers.extend(buffer.history.borrow_mut().advance(access, false).map(|b| buffer_barrier(&b, buffer)));
    };
    for binding in &pass.bindings {
        match binding.resource {
            Resource::Image(i) => image(i.0, binding.access),
            Resource::Buffer(i) => buffer(i.0, binding.access),
        }
    }
    pass.attributes.iter().for_each(|(b, _)| buffer(b.0, Access::VertexAttributes));
    if let Work::Compute { groups: Groups::Counted(row), .. } | Work::Raster { counted: Some(row), .. } = &pass.work {
        buffer(row.rows.0, Access::Indirect);
    }
    if let Work::Copy { copies } = &pass.work {
        for (from, to) in copies {
            image(from.0, Access::CopyRead);
            buffer(to.0, Access::CopyWrite);
        }
    }
    if let Work::Raster { targets, depth, drawn, streamed, .. } = &pass.work {
        drawn.iter().for_each(|s| buffer(s.counter.0, Access::Indirect));
        if let Some(stream) = streamed {
            buffer(stream.vertices.0, Access::StreamWrite);
            buffer(stream.counter.0, Access::StreamCounterWrite);
        }
        targets.iter().for_each(|t| image(t.image.0, Access::Color));
        depth.iter().for_each(|d| image(d.image.0, Access::Depth));
    }
    program.barriers(program.commands(), buffers, images);
}

/// Pushes descriptors and constants: nothing is allocated in a frame.
///
/// # Safety
/// The command buffer is recording and the pipeline is bound.
unsafe fn bind(program: &Program, pass: &PassDecl, pipeline: &Pipeline) {
    let mut buffers = [vk::DescriptorBufferInfo::default(); 32];
    let mut images = [vk::DescriptorImageInfo::default(); 32];
    for ((binding, buffer), image) in pass.bindings.iter().zip(&mut buffers).zip(&mut images) {
        match binding.resource {
            Resource::Buffer(id) => {
                buffer.buffer = program.buffers[id.0].handle;
                buffer.range = vk::WHOLE_SIZE;
            }
            Resource::Image(id) => {
                image.image_view = program.images[id.0].view;
                image.image_layout = binding.access.scope().layout;
                image.sampler = program.shared.sampler().unwrap_or_default();
            }
        }
    }
    let writes: Vec<_> = pass
        .bindings
        .iter()
        .enumerate()
        .filter_map(|(at, binding)| {
            let &(number, kind) = pipeline.bindings.get(&binding.name)?;
            let write = vk::WriteDescriptorSet::default().dst_binding(number).descriptor_type(descriptor_type(kind));
            Some(match kind {
                BindingKind::Buffer => write.buffer_info(&buffers[at..=at]),
                BindingKind::StorageImage | BindingKind::Sampler => write.image_info(&images[at..=at]),
            })
        })
        .collect();
    let commands = program.commands();
    // SAFETY: layouts were made from the same reflection; infos live to the end of the call.
    unsafe {
        if !writes.is_empty() {
            program.shared.push.cmd_push_descriptor_set(commands, pipeline.point, pipeline.layout, 0, &writes);
        }
        if pipeline.push_bytes > 0 {
            let (layout, stages) = (pipeline.layout, pipeline.push_stages);
            program.shared.device.cmd_push_constants(commands, layout, stages, 0, &pass.push);
        }
    }
}

/// Copies a whole image to a buffer.
///
/// # Safety
/// The command buffer is recording, outside rendering; barriers came before.
unsafe fn copy(program: &Program, (from, to): (ImageId, BufferId)) {
    let (image, buffer) = (&program.images[from.0], &program.buffers[to.0]);
    let region = [image.whole()];
    let layout = Access::CopyRead.scope().layout;
    // SAFETY: the plan declares the buffer as large as the image; the rest is promised by the caller.
    unsafe {
        program.shared.device.cmd_copy_image_to_buffer(program.commands(), image.handle, layout, buffer.handle, &region)
    }
}

/// Streams to the start of a buffer from here on.
///
/// # Safety
/// The command buffer is recording, within rendering, with a pipeline bound that streams; barriers came before.
unsafe fn begin_stream(program: &Program, stream: &Stream) {
    let (commands, feedback) = (program.commands(), program.shared.feedback());
    let (vertices, offset) = (&program.buffers[stream.vertices.0], 0);
    // SAFETY: promised by the caller; without counters the stream begins at the buffer's start.
    unsafe {
        let bind = feedback.cmd_bind_transform_feedback_buffers_ext;
        bind(commands, 0, 1, &vertices.handle, &offset, &vertices.bytes);
        (feedback.cmd_begin_transform_feedback_ext)(commands, 0, 0, std::ptr::null(), std::ptr::null());
    }
}

/// # Safety
/// The command buffer is recording, outside rendering, with the pass's pipeline bound.
unsafe fn draw(program: &Program, pass: &PassDecl) {
    let Work::Raster { targets, depth, draws, counted, drawn, streamed, .. } = &pass.work else { return };
    let load = |clears: bool| if clears { vk::AttachmentLoadOp::CLEAR } else { vk::AttachmentLoadOp::LOAD };
    let colors: Vec<_> = targets
        .iter()
        .map(|t| {
            let image = &program.images[t.image.0];
            vk::RenderingAttachmentInfo::default()
                .image_view(t.layer.map_or(image.view, |layer| image.layer_views[layer as usize]))
                .image_layout(Access::Color.scope().layout)
                .load_op(load(t.clear.is_some()))
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(vk::ClearValue { color: vk::ClearColorValue { float32: t.clear.unwrap_or_default() } })
        })
        .collect();
    let depth_info = depth.as_ref().map(|d| {
        vk::RenderingAttachmentInfo::default()
            .image_view(program.images[d.image.0].view)
            .image_layout(Access::Depth.scope().layout)
            .load_op(load(d.clear))
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 1.0, stencil: 0 } })
    });
    let first = targets.first().map(|t| t.image).or(depth.as_ref().map(|d| d.image));
    // What is streamed out alone is drawn to nothing.
    let [width, height] = first.map_or([1, 1], |id| program.images[id.0].extent);
    let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
    let layered = targets.iter().filter(|t| t.layer.is_none()).map(|t| program.images[t.image.0].layers);
    let layers = layered.min().unwrap_or(1);
    let mut info = vk::RenderingInfo::default().render_area(area).layer_count(layers).color_attachments(&colors);
    if let Some(depth) = &depth_info {
        info = info.depth_attachment(depth);
    }
    let viewport = vk::Viewport { width: width as f32, height: height as f32, max_depth: 1.0, ..Default::default() };
    let (device, commands) = (&program.shared.device, program.commands());
    // SAFETY: promised by the caller; attachments are in their layouts by the barriers before.
    unsafe {
        device.cmd_begin_rendering(commands, &info);
        device.cmd_set_viewport(commands, 0, &[viewport]);
        device.cmd_set_scissor(commands, 0, &[area]);
        for (at, (buffer, _)) in (0..).zip(&pass.attributes) {
            device.cmd_bind_vertex_buffers(commands, at, &[program.buffers[buffer.0].handle], &[0]);
        }
        if let Some(stream) = streamed {
            begin_stream(program, stream);
        }
        for d in draws {
            device.cmd_draw(commands, d.vertices, d.instances, d.first_vertex, d.first_instance);
        }
        if let Some(row) = counted {
            let rows = program.buffers[row.rows.0].handle;
            device.cmd_draw_indirect(commands, rows, u64::from(row.row) * Row::BYTES, 1, Row::BYTES as u32);
        }
        if let Some((stream, (_, format))) = drawn.as_ref().zip(pass.attributes.first()) {
            let counter = program.buffers[stream.counter.0].handle;
            let draw = program.shared.feedback().cmd_draw_indirect_byte_count_ext;
            draw(commands, 1, 0, counter, 0, 0, format.bytes() as u32);
        }
        if let Some(stream) = streamed {
            let counters = [program.buffers[stream.counter.0].handle];
            let end = program.shared.feedback().cmd_end_transform_feedback_ext;
            end(commands, 0, 1, counters.as_ptr(), std::ptr::null());
        }
        device.cmd_end_rendering(commands);
    }
}
