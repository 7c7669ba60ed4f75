//! The pass that tone-maps a layer into the swapchain's image: its pipeline, and how it is recorded.

use ash::vk;
use std::sync::Arc;

use super::{
    access::{Access, Barrier, barrier},
    chain::{Chain, WHOLE},
    device::Shared,
    error::GpuError,
    memory::{Buffer, Format, Image},
    pipeline::{Pipeline, RasterState, Stage},
    plan::{Blend, Lifetime, Plan, Topology},
    record::{barrier_of, buffer_barrier, image_barrier},
    screen::{Look, Screen},
    shader::{ShaderKind, Sources},
};
use crate::store::Store;

/// Its name in tables and captures.
pub const SHOW: &str = "window/show";

/// Its shaders.
const SHADERS: [&str; 2] = ["passes/screen.vert", "passes/show.frag"];

/// What it binds: a layer of the picture.
const LAYER: &str = "layer";

/// Push constants of `glsl/passes/show.frag`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
struct ShowPush {
    exposure: f32,
    alpha: u32,
    encode: u32,
}

/// Whether a format stores what is written, so that the shader must encode it.
fn stores_plainly(format: vk::Format) -> bool {
    matches!(format, vk::Format::B8G8R8A8_UNORM | vk::Format::R8G8B8A8_UNORM)
}

/// The pass's pipeline for windows of a format. Its target is no image of any plan, so the pass is in none.
pub(super) fn pipeline(shared: &Shared, format: vk::Format) -> Result<Arc<Pipeline>, GpuError> {
    let (sources, store) = (Sources::default(), Store::open());
    let mut plan = Plan::default();
    let layer = plan.image(LAYER, [1, 1], Format::Rgba32f, Lifetime::Frame);
    plan.pass(SHOW).fetch(LAYER, layer).push(&ShowPush::default()).screen(SHADERS[1]);
    let stage = |file| {
        let words = sources.compile(file, &[], &[], &store)?;
        Ok(Stage { kind: ShaderKind::of(file).unwrap_or(ShaderKind::Fragment), words })
    };
    let stages = SHADERS.into_iter().map(stage).collect::<Result<Vec<_>, GpuError>>()?;
    let colors = vec![(format, Blend::Replace)];
    let raster =
        RasterState { colors, depth: false, topology: Topology::Triangles, attributes: Vec::new(), streams: false };
    let pipeline = shared.pipeline(&plan.passes[0], &stages, Some(&raster))?;
    pipeline.check(&plan.passes[0])?;
    Ok(pipeline)
}

/// Records the pass, and a copy of what it drew if one is asked for.
///
/// # Safety
/// The screen's command buffer is recording; layer, chain and buffer live until it has run.
pub(super) unsafe fn record(
    screen: &Screen,
    (chain, index): (&Chain, usize),
    (layer, look): (Option<&Image>, Look),
    copy: Option<&Buffer>,
) {
    let (shared, commands, target) = (&screen.shared, screen.commands, &chain.images[index]);
    let mut before: Vec<_> =
        barrier(Access::None, Access::Color).map(|b| barrier_of(&b, target.image, WHOLE)).into_iter().collect();
    if let Some(layer) = layer {
        let read = layer.history.borrow_mut().advance(Access::GraphicsSample, true);
        before.extend(read.map(|b| image_barrier(&b, layer)));
    }
    let between = |from, to| {
        let barriers = barrier(from, to).map(|b| barrier_of(&b, target.image, WHOLE));
        shared.barriers(commands, Vec::new(), barriers.into_iter().collect());
    };
    shared.barriers(commands, Vec::new(), before);
    screen.timer.stamp(commands, 0);
    // SAFETY: promised by the caller; the barriers bring images to the layouts that are named.
    unsafe {
        draw(screen, target.view, chain.extent, layer, look);
        screen.timer.stamp(commands, 1);
        if let Some(buffer) = copy {
            between(Access::Color, Access::CopyRead);
            read_back(screen, target.image, chain.extent, buffer);
            between(Access::CopyRead, Access::Present);
        } else {
            between(Access::Color, Access::Present);
        }
    }
}

/// # Safety
/// The command buffer is recording; the target is in the layout of colour attachments, the layer in that of fetches.
unsafe fn draw(screen: &Screen, target: vk::ImageView, extent: [u32; 2], layer: Option<&Image>, look: Look) {
    let (device, commands, pipeline) = (&screen.shared.device, screen.commands, &*screen.pipeline);
    let [width, height] = extent;
    let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
    let viewport = vk::Viewport { width: width as f32, height: height as f32, max_depth: 1.0, ..Default::default() };
    let colors = [vk::RenderingAttachmentInfo::default()
        .image_view(target)
        .image_layout(Access::Color.scope().layout)
        .load_op(vk::AttachmentLoadOp::CLEAR) // black, where there is no such layer
        .store_op(vk::AttachmentStoreOp::STORE)];
    let info = vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&colors);
    // SAFETY: promised by the caller.
    unsafe {
        device.cmd_begin_rendering(commands, &info);
        if let Some(layer) = layer {
            device.cmd_bind_pipeline(commands, pipeline.point, pipeline.handle);
            bind(screen, layer, look);
            device.cmd_set_viewport(commands, 0, &[viewport]);
            device.cmd_set_scissor(commands, 0, &[area]);
            device.cmd_draw(commands, 3, 1, 0, 0);
        }
        device.cmd_end_rendering(commands);
    }
}

/// # Safety
/// The command buffer is recording and the pipeline is bound.
unsafe fn bind(screen: &Screen, layer: &Image, look: Look) {
    let (shared, commands, pipeline) = (&screen.shared, screen.commands, &*screen.pipeline);
    let image = [vk::DescriptorImageInfo::default()
        .image_view(layer.view)
        .image_layout(Access::GraphicsSample.scope().layout)
        .sampler(shared.sampler().unwrap_or_default())];
    let number = pipeline.bindings.get(LAYER).map_or(0, |&(number, _)| number);
    let write = [vk::WriteDescriptorSet::default()
        .dst_binding(number)
        .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
        .image_info(&image)];
    let encode = stores_plainly(screen.format.format).into();
    let push = ShowPush { exposure: look.ev.exp2() as f32, alpha: look.alpha.into(), encode };
    let (layout, stages) = (pipeline.layout, pipeline.push_stages);
    // SAFETY: the layout was made from the shader's own bindings and constants; infos live to the end of the call.
    unsafe {
        shared.push.cmd_push_descriptor_set(commands, pipeline.point, layout, 0, &write);
        shared.device.cmd_push_constants(commands, layout, stages, 0, bytemuck::bytes_of(&push));
    }
}

/// # Safety
/// The command buffer is recording; the image is in the layout of copies, and the buffer holds four bytes a pixel.
unsafe fn read_back(screen: &Screen, image: vk::Image, [width, height]: [u32; 2], buffer: &Buffer) {
    let (device, commands) = (&screen.shared.device, screen.commands);
    let layers = vk::ImageSubresourceLayers::default().aspect_mask(WHOLE.aspect_mask).layer_count(1);
    let region = [vk::BufferImageCopy::default().image_subresource(layers).image_extent(vk::Extent3D {
        width,
        height,
        depth: 1,
    })];
    let layout = Access::CopyRead.scope().layout;
    // SAFETY: promised by the caller.
    unsafe { device.cmd_copy_image_to_buffer(commands, image, layout, buffer.handle, &region) }
    let to_host = Barrier { from: Access::CopyWrite.scope(), to: Access::HostRead.scope() };
    screen.shared.barriers(commands, vec![buffer_barrier(&to_host, buffer)], Vec::new());
}
