//! The one place that makes pipelines, from reflection; bindings are matched by name.

use ash::vk;
use std::{
    collections::{BTreeMap, HashMap},
    sync::{Arc, Mutex, PoisonError, atomic::Ordering::Relaxed},
};

use super::{
    device::Shared,
    error::{GpuError, Named},
    memory::Format,
    plan::{Blend, PassDecl, Resource, Topology},
    reflect::{BindingKind, Reflection},
    shader::ShaderKind,
};

/// A pipeline and how to bind to it. Owned by the device's cache, which destroys it.
pub(super) struct Pipeline {
    pub handle: vk::Pipeline,
    pub layout: vk::PipelineLayout,
    pub set_layout: vk::DescriptorSetLayout,
    pub point: vk::PipelineBindPoint,
    pub bindings: BTreeMap<String, (u32, BindingKind)>,
    pub push_bytes: u32,
    pub push_stages: vk::ShaderStageFlags,
}

/// The fixed-function state of a raster pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct RasterState {
    pub colors: Vec<(vk::Format, Blend)>,
    pub depth: bool,
    pub topology: Topology,
    /// Vertex attributes by location, each from a binding of its own.
    pub attributes: Vec<Format>,
    /// Whether the geometry shader streams out; without a target nothing is rasterised then.
    pub streams: bool,
}

/// One compiled stage.
pub(super) struct Stage {
    pub kind: ShaderKind,
    pub words: Vec<u32>,
}

/// Pipelines by what they were made from, and the one sampler.
#[derive(Default)]
pub(super) struct PipelineCache {
    made: Mutex<HashMap<blake3::Hash, Arc<Pipeline>>>,
    sampler: Mutex<Option<vk::Sampler>>,
}

impl PipelineCache {
    /// Destroys everything.
    ///
    /// # Safety
    /// The device is idle and nothing made from these is used again.
    pub unsafe fn destroy(&self, device: &ash::Device) {
        // SAFETY: promised by the caller; each handle is drained, so destroyed once.
        unsafe {
            for (_, p) in self.made.lock().unwrap_or_else(PoisonError::into_inner).drain() {
                device.destroy_pipeline(p.handle, None);
                device.destroy_pipeline_layout(p.layout, None);
                device.destroy_descriptor_set_layout(p.set_layout, None);
            }
            if let Some(sampler) = self.sampler.lock().unwrap_or_else(PoisonError::into_inner).take() {
                device.destroy_sampler(sampler, None);
            }
        }
    }
}

impl Shared {
    /// The sampler of every fetched image; filters are computed in the shaders, exactly.
    pub fn sampler(&self) -> Result<vk::Sampler, GpuError> {
        let mut slot = self.pipelines.sampler.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(sampler) = *slot {
            return Ok(sampler);
        }
        let edge = vk::SamplerAddressMode::CLAMP_TO_EDGE;
        let info = vk::SamplerCreateInfo::default().address_mode_u(edge).address_mode_v(edge).address_mode_w(edge);
        // SAFETY: destroyed with the cache, before the device.
        let sampler = unsafe { self.device.create_sampler(&info, None) }.named("vkCreateSampler")?;
        self.name(sampler, "nearest");
        Ok(*slot.insert(sampler))
    }

    /// The pipeline of a pass, made now or before.
    pub fn pipeline(
        &self,
        pass: &PassDecl,
        stages: &[Stage],
        raster: Option<&RasterState>,
    ) -> Result<Arc<Pipeline>, GpuError> {
        let mut hash = blake3::Hasher::new();
        for stage in stages {
            hash.update(bytemuck::cast_slice(&stage.words));
        }
        hash.update(format!("{raster:?}").as_bytes());
        let key = hash.finalize();
        let mut made = self.pipelines.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = made.get(&key) {
            return Ok(pipeline.clone());
        }
        let pipeline = Arc::new(self.build(pass, stages, raster)?);
        made.insert(key, pipeline.clone());
        Ok(pipeline)
    }

    fn build(&self, pass: &PassDecl, stages: &[Stage], raster: Option<&RasterState>) -> Result<Pipeline, GpuError> {
        let wrong = |text: String| GpuError::Binding { pass: pass.name.clone(), text };
        let mut bindings = BTreeMap::new();
        let (mut push_bytes, mut push_stages) = (0, vk::ShaderStageFlags::empty());
        for stage in stages {
            let reflection = Reflection::of(&stage.words).map_err(wrong)?;
            for (name, number, kind) in reflection.bindings {
                let before = bindings.insert(name.clone(), (number, kind));
                if before.is_some_and(|b| b != (number, kind)) {
                    return Err(wrong(format!("its stages disagree about binding '{name}'")));
                }
            }
            if reflection.push_bytes > 0 {
                push_bytes = push_bytes.max(reflection.push_bytes);
                push_stages |= stage_flag(stage.kind);
            }
        }
        check_numbers(&bindings).map_err(wrong)?;
        let all = stages.iter().fold(vk::ShaderStageFlags::empty(), |flags, s| flags | stage_flag(s.kind));
        let slots: Vec<_> = bindings
            .values()
            .map(|&(number, kind)| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(number)
                    .descriptor_type(descriptor_type(kind))
                    .descriptor_count(1)
                    .stage_flags(all)
            })
            .collect();
        let set_info = vk::DescriptorSetLayoutCreateInfo::default()
            .flags(vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR)
            .bindings(&slots);
        let mut pipeline = Pipeline {
            handle: vk::Pipeline::null(),
            layout: vk::PipelineLayout::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            point: if raster.is_some() { vk::PipelineBindPoint::GRAPHICS } else { vk::PipelineBindPoint::COMPUTE },
            bindings,
            push_bytes,
            push_stages,
        };
        let built = self.build_handles(&mut pipeline, stages, raster, &set_info);
        if built.is_err() {
            // SAFETY: made above and given to nobody; null handles are ignored.
            unsafe {
                self.device.destroy_pipeline_layout(pipeline.layout, None);
                self.device.destroy_descriptor_set_layout(pipeline.set_layout, None);
            }
        }
        built?;
        self.name(pipeline.handle, &pass.name);
        Ok(pipeline)
    }

    fn build_handles(
        &self,
        pipeline: &mut Pipeline,
        stages: &[Stage],
        raster: Option<&RasterState>,
        set_info: &vk::DescriptorSetLayoutCreateInfo<'_>,
    ) -> Result<(), GpuError> {
        // SAFETY: create-info pointers outlive their calls; handles are stored in `pipeline` as they come.
        pipeline.set_layout =
            unsafe { self.device.create_descriptor_set_layout(set_info, None) }.named("vkCreateDescriptorSetLayout")?;
        let sets = [pipeline.set_layout];
        let range = [vk::PushConstantRange { stage_flags: pipeline.push_stages, offset: 0, size: pipeline.push_bytes }];
        let ranges = if pipeline.push_bytes > 0 { &range[..] } else { &[] };
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets).push_constant_ranges(ranges);
        // SAFETY: as above.
        pipeline.layout = unsafe { self.device.create_pipeline_layout(&info, None) }.named("vkCreatePipelineLayout")?;
        let modules = stages.iter().map(|s| Module::new(self, &s.words)).collect::<Result<Vec<_>, _>>()?;
        let stage_infos: Vec<_> = stages
            .iter()
            .zip(&modules)
            .map(|(s, m)| {
                vk::PipelineShaderStageCreateInfo::default().stage(stage_flag(s.kind)).module(m.handle).name(c"main")
            })
            .collect();
        self.calls.pipelines.fetch_add(1, Relaxed);
        pipeline.handle = match raster {
            Some(state) => self.graphics(pipeline.layout, &stage_infos, state)?,
            None => {
                let info = [vk::ComputePipelineCreateInfo::default().stage(stage_infos[0]).layout(pipeline.layout)];
                // SAFETY: modules and layout live through the call.
                unsafe { self.device.create_compute_pipelines(vk::PipelineCache::null(), &info, None) }
                    .map_err(|(_, e)| e)
                    .named("vkCreateComputePipelines")?[0]
            }
        };
        Ok(())
    }

    fn graphics(
        &self,
        layout: vk::PipelineLayout,
        stages: &[vk::PipelineShaderStageCreateInfo<'_>],
        state: &RasterState,
    ) -> Result<vk::Pipeline, GpuError> {
        let (streams, attributes) = vertex_input(&state.attributes);
        let vertex = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&streams)
            .vertex_attribute_descriptions(&attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(match state.topology {
            Topology::Points => vk::PrimitiveTopology::POINT_LIST,
            Topology::Triangles => vk::PrimitiveTopology::TRIANGLE_LIST,
        });
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let nothing_drawn = state.streams && state.colors.is_empty() && !state.depth;
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .line_width(1.0)
            .rasterizer_discard_enable(nothing_drawn);
        let samples =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(state.depth)
            .depth_write_enable(state.depth)
            .depth_compare_op(vk::CompareOp::LESS);
        let blends: Vec<_> = state.colors.iter().map(|&(_, blend)| blend_state(blend)).collect();
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let formats: Vec<_> = state.colors.iter().map(|&(format, _)| format).collect();
        let mut rendering = vk::PipelineRenderingCreateInfo::default().color_attachment_formats(&formats);
        if state.depth {
            rendering = rendering.depth_attachment_format(Format::Depth32f.vk());
        }
        let info = [vk::GraphicsPipelineCreateInfo::default()
            .stages(stages)
            .vertex_input_state(&vertex)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .push_next(&mut rendering)];
        // SAFETY: every pointer outlives the call; modules and layout live through it.
        let made = unsafe { self.device.create_graphics_pipelines(vk::PipelineCache::null(), &info, None) };
        Ok(made.map_err(|(_, e)| e).named("vkCreateGraphicsPipelines")?[0])
    }
}

impl Pipeline {
    /// Holds the pass's bindings against the shader's, by name; the error names both sides.
    pub fn check(&self, pass: &PassDecl) -> Result<(), GpuError> {
        let mut faults = Vec::new();
        for (name, (_, kind)) in &self.bindings {
            match pass.bindings.iter().find(|b| &b.name == name) {
                None => faults.push(format!("the shader wants '{name}', which the pass does not bind")),
                Some(b) if matches!(b.resource, Resource::Buffer(_)) != (*kind == BindingKind::Buffer) => {
                    faults.push(format!("'{name}' is a {kind:?} in the shader and {:?} in the pass", b.resource));
                }
                Some(_) => {}
            }
        }
        for b in pass.bindings.iter().filter(|b| !b.optional && !self.bindings.contains_key(&b.name)) {
            faults.push(format!("the pass binds '{}', which the shader does not use", b.name));
        }
        if pass.push.len() as u32 != self.push_bytes {
            let (pass, shader) = (pass.push.len(), self.push_bytes);
            faults.push(format!("the pass pushes {pass} bytes of constants, the shader declares {shader}"));
        }
        if faults.is_empty() {
            return Ok(());
        }
        let names = |list: Vec<&str>| if list.is_empty() { "none".to_owned() } else { list.join(", ") };
        let shader = names(self.bindings.keys().map(String::as_str).collect());
        let bound = names(pass.bindings.iter().map(|b| b.name.as_str()).collect());
        let text = format!("{} (shader: {shader}; pass: {bound})", faults.join("; "));
        Err(GpuError::Binding { pass: pass.name.clone(), text })
    }
}

/// A shader module for the length of pipeline creation.
struct Module<'d> {
    shared: &'d Shared,
    handle: vk::ShaderModule,
}

impl<'d> Module<'d> {
    fn new(shared: &'d Shared, words: &[u32]) -> Result<Self, GpuError> {
        let info = vk::ShaderModuleCreateInfo::default().code(words);
        // SAFETY: the words are SPIR-V as the compiler made it; the module is destroyed on drop.
        let handle = unsafe { shared.device.create_shader_module(&info, None) }.named("vkCreateShaderModule")?;
        Ok(Self { shared, handle })
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines keep what they need of a module.
        unsafe { self.shared.device.destroy_shader_module(self.handle, None) }
    }
}

fn check_numbers(bindings: &BTreeMap<String, (u32, BindingKind)>) -> Result<(), String> {
    let mut by_number = BTreeMap::new();
    for (name, (number, _)) in bindings {
        if let Some(other) = by_number.insert(number, name) {
            return Err(format!("bindings '{other}' and '{name}' share number {number}"));
        }
    }
    Ok(())
}

fn stage_flag(kind: ShaderKind) -> vk::ShaderStageFlags {
    match kind {
        ShaderKind::Vertex => vk::ShaderStageFlags::VERTEX,
        ShaderKind::Geometry => vk::ShaderStageFlags::GEOMETRY,
        ShaderKind::Fragment => vk::ShaderStageFlags::FRAGMENT,
        ShaderKind::Compute => vk::ShaderStageFlags::COMPUTE,
    }
}

pub(super) fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::Buffer => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
        BindingKind::Sampler => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
    }
}

type Streams = (Vec<vk::VertexInputBindingDescription>, Vec<vk::VertexInputAttributeDescription>);

/// Tightly packed elements, one a vertex: location k from binding k.
fn vertex_input(formats: &[Format]) -> Streams {
    let numbered = || (0..).zip(formats);
    let stream =
        |(at, f): (u32, &Format)| vk::VertexInputBindingDescription::default().binding(at).stride(f.bytes() as u32);
    let attribute = |(at, f): (u32, &Format)| {
        vk::VertexInputAttributeDescription::default().location(at).binding(at).format(f.vk())
    };
    (numbered().map(stream).collect(), numbered().map(attribute).collect())
}

fn blend_state(blend: Blend) -> vk::PipelineColorBlendAttachmentState {
    let one = vk::BlendFactor::ONE;
    vk::PipelineColorBlendAttachmentState::default()
        .blend_enable(blend == Blend::Add)
        .src_color_blend_factor(one)
        .dst_color_blend_factor(one)
        .color_blend_op(vk::BlendOp::ADD)
        .src_alpha_blend_factor(one)
        .dst_alpha_blend_factor(one)
        .alpha_blend_op(vk::BlendOp::ADD)
        .color_write_mask(vk::ColorComponentFlags::RGBA)
}
