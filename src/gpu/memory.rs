//! Buffers and images that own their memory and drop it.

use ash::vk;
use gpu_allocator::{
    MemoryLocation,
    vulkan::{Allocation, AllocationCreateDesc, AllocationScheme},
};
use std::{
    cell::RefCell,
    io::Write,
    sync::{Arc, atomic::Ordering::Relaxed},
};

use super::{
    access::History,
    choose::Feature,
    device::{Gpu, Shared},
    error::{GpuError, Named},
};

/// Texel formats in use. Float32 where light is summed: float16 attachments truncate on some devices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Four float32.
    Rgba32f,
    /// Four float16.
    Rgba16f,
    /// Two indices and two float32 bit patterns.
    Rgba32u,
    /// Two words.
    Rg32u,
    /// One float32.
    R32f,
    /// Float32 depth.
    Depth32f,
}

impl Format {
    /// Bytes a texel.
    pub fn bytes(self) -> u64 {
        match self {
            Self::Rgba32f | Self::Rgba32u => 16,
            Self::Rgba16f | Self::Rg32u => 8,
            Self::R32f | Self::Depth32f => 4,
        }
    }

    /// The GLSL layout qualifier of a storage image.
    pub fn glsl(self) -> &'static str {
        match self {
            Self::Rgba32f => "rgba32f",
            Self::Rgba16f => "rgba16f",
            Self::Rgba32u => "rgba32ui",
            Self::Rg32u => "rg32ui",
            Self::R32f => "r32f",
            Self::Depth32f => "depth32f",
        }
    }

    /// Channels a texel.
    pub fn channels(self) -> u32 {
        match self {
            Self::Rgba32f | Self::Rgba16f | Self::Rgba32u => 4,
            Self::Rg32u => 2,
            Self::R32f | Self::Depth32f => 1,
        }
    }

    pub(super) fn vk(self) -> vk::Format {
        match self {
            Self::Rgba32f => vk::Format::R32G32B32A32_SFLOAT,
            Self::Rgba16f => vk::Format::R16G16B16A16_SFLOAT,
            Self::Rgba32u => vk::Format::R32G32B32A32_UINT,
            Self::Rg32u => vk::Format::R32G32_UINT,
            Self::R32f => vk::Format::R32_SFLOAT,
            Self::Depth32f => vk::Format::D32_SFLOAT,
        }
    }

    fn aspect(self) -> vk::ImageAspectFlags {
        if self == Self::Depth32f { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR }
    }
}

struct Memory {
    shared: Arc<Shared>,
    allocation: Option<Allocation>,
}

impl Memory {
    fn new(
        shared: &Arc<Shared>,
        name: &str,
        requirements: vk::MemoryRequirements,
        location: MemoryLocation,
        linear: bool,
    ) -> Result<Self, GpuError> {
        let scheme = AllocationScheme::GpuAllocatorManaged;
        let desc = AllocationCreateDesc { name, requirements, location, linear, allocation_scheme: scheme };
        shared.calls.allocations.fetch_add(1, Relaxed);
        let allocation = shared.allocator().allocate(&desc).map_err(|e| GpuError::Memory {
            name: name.to_owned(),
            bytes: requirements.size,
            text: e.to_string(),
        })?;
        Ok(Self { shared: shared.clone(), allocation: Some(allocation) })
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        if let Some(allocation) = self.allocation.take()
            && let Err(e) = self.shared.allocator().free(allocation)
        {
            // Not `eprintln!`, which panics where standard error cannot be written.
            let _ = writeln!(std::io::stderr(), "device memory could not be freed: {e}");
        }
    }
}

/// A storage buffer.
pub struct Buffer {
    pub(super) handle: vk::Buffer,
    pub(super) bytes: u64,
    pub(super) history: RefCell<History>,
    shared: Arc<Shared>,
    memory: Option<Memory>,
}

impl Buffer {
    /// A device buffer of `bytes` (at least 16 are allocated, so that an empty list can be bound).
    pub fn new(gpu: &Gpu, name: &str, bytes: u64) -> Result<Self, GpuError> {
        Self::create(&gpu.0, name, bytes, MemoryLocation::GpuOnly)
    }

    pub(super) fn create(
        shared: &Arc<Shared>,
        name: &str,
        bytes: u64,
        location: MemoryLocation,
    ) -> Result<Self, GpuError> {
        let bytes = bytes.max(16).next_multiple_of(4);
        let limit = shared.info.max_buffer_range;
        if bytes > limit && location == MemoryLocation::GpuOnly {
            let text = format!("{bytes} bytes, and the device binds at most {limit}");
            return Err(GpuError::TooLarge { name: name.to_owned(), text });
        }
        let mut usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST
            | vk::BufferUsageFlags::INDIRECT_BUFFER
            | vk::BufferUsageFlags::VERTEX_BUFFER;
        if shared.info.features.contains(&Feature::TransformFeedback) {
            usage |= vk::BufferUsageFlags::TRANSFORM_FEEDBACK_BUFFER_EXT
                | vk::BufferUsageFlags::TRANSFORM_FEEDBACK_COUNTER_BUFFER_EXT;
        }
        if location != MemoryLocation::GpuOnly {
            usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
        }
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        // SAFETY: the device lives in `shared`; the handle is owned by `buffer` before anything can fail.
        let handle = unsafe { shared.device.create_buffer(&info, None) }.named("vkCreateBuffer")?;
        let mut buffer = Self { handle, bytes, history: RefCell::default(), shared: shared.clone(), memory: None };
        // SAFETY: the handle was just made by this device.
        let requirements = unsafe { shared.device.get_buffer_memory_requirements(handle) };
        let memory = Memory::new(shared, name, requirements, location, true)?;
        if let Some(a) = &memory.allocation {
            // SAFETY: the allocation fits the requirements; both belong to this device.
            unsafe { shared.device.bind_buffer_memory(handle, a.memory(), a.offset()) }.named("vkBindBufferMemory")?;
        }
        buffer.memory = Some(memory);
        shared.name(handle, name);
        Ok(buffer)
    }

    /// Bytes as allocated.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    pub(super) fn mapped(&self) -> Option<&[u8]> {
        self.memory.as_ref()?.allocation.as_ref()?.mapped_slice()
    }

    pub(super) fn mapped_mut(&mut self) -> Option<&mut [u8]> {
        self.memory.as_mut()?.allocation.as_mut()?.mapped_slice_mut()
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: programs wait for the device before they drop what they bound.
        unsafe { self.shared.device.destroy_buffer(self.handle, None) }
        self.memory = None;
    }
}

/// A 2D image, possibly layered, with the views that passes need.
pub struct Image {
    pub(super) handle: vk::Image,
    pub(super) view: vk::ImageView,
    pub(super) layer_views: Vec<vk::ImageView>,
    pub(super) extent: [u32; 2],
    pub(super) layers: u32,
    pub(super) format: Format,
    pub(super) history: RefCell<History>,
    shared: Arc<Shared>,
    memory: Option<Memory>,
}

impl Image {
    /// An image of `layers` layers; `array` makes even one layer visible as an array.
    pub(super) fn create(
        shared: &Arc<Shared>,
        name: &str,
        extent: [u32; 2],
        layers: u32,
        format: Format,
        array: bool,
    ) -> Result<Self, GpuError> {
        let limit = shared.info.max_image_side;
        if extent.iter().any(|&side| side == 0 || side > limit) {
            let text = format!("{}x{} texels, and the device's images are 1 to {limit} wide", extent[0], extent[1]);
            return Err(GpuError::TooLarge { name: name.to_owned(), text });
        }
        let mut usage =
            vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        usage |= match format {
            Format::Depth32f => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
            _ => vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::STORAGE,
        };
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format.vk())
            .extent(vk::Extent3D { width: extent[0], height: extent[1], depth: 1 })
            .mip_levels(1)
            .array_layers(layers)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage);
        // SAFETY: the device lives in `shared`; the handle is owned by `image` before anything can fail.
        let handle = unsafe { shared.device.create_image(&info, None) }.named("vkCreateImage")?;
        let mut image = Self {
            handle,
            view: vk::ImageView::null(),
            layer_views: Vec::new(),
            extent,
            layers,
            format,
            history: RefCell::default(),
            shared: shared.clone(),
            memory: None,
        };
        // SAFETY: the handle was just made by this device.
        let requirements = unsafe { shared.device.get_image_memory_requirements(handle) };
        let memory = Memory::new(shared, name, requirements, MemoryLocation::GpuOnly, false)?;
        if let Some(a) = &memory.allocation {
            // SAFETY: the allocation fits the requirements; both belong to this device.
            unsafe { shared.device.bind_image_memory(handle, a.memory(), a.offset()) }.named("vkBindImageMemory")?;
        }
        image.memory = Some(memory);
        let whole = if array { vk::ImageViewType::TYPE_2D_ARRAY } else { vk::ImageViewType::TYPE_2D };
        image.view = image.make_view(whole, 0, layers)?;
        for layer in 0..layers {
            let view = image.make_view(vk::ImageViewType::TYPE_2D, layer, 1)?;
            image.layer_views.push(view);
        }
        shared.name(handle, name);
        Ok(image)
    }

    fn make_view(&self, kind: vk::ImageViewType, layer: u32, layers: u32) -> Result<vk::ImageView, GpuError> {
        let range = vk::ImageSubresourceRange { base_array_layer: layer, layer_count: layers, ..self.range() };
        let info = vk::ImageViewCreateInfo::default()
            .image(self.handle)
            .view_type(kind)
            .format(self.format.vk())
            .subresource_range(range);
        // SAFETY: the image is bound and lives as long as its views.
        unsafe { self.shared.device.create_image_view(&info, None) }.named("vkCreateImageView")
    }

    /// All texels, to be copied to or from a buffer that holds nothing else.
    pub(super) fn whole(&self) -> vk::BufferImageCopy {
        let (aspect_mask, layer_count) = (self.format.aspect(), self.layers);
        let layers = vk::ImageSubresourceLayers { aspect_mask, mip_level: 0, base_array_layer: 0, layer_count };
        let [width, height] = self.extent;
        vk::BufferImageCopy::default().image_subresource(layers).image_extent(vk::Extent3D { width, height, depth: 1 })
    }

    /// The whole image.
    pub(super) fn range(&self) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange {
            aspect_mask: self.format.aspect(),
            base_mip_level: 0,
            level_count: 1,
            base_array_layer: 0,
            layer_count: self.layers,
        }
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: programs wait for the device before they drop what they bound; null views are ignored.
        unsafe {
            for view in self.layer_views.drain(..).chain([self.view]) {
                self.shared.device.destroy_image_view(view, None);
            }
            self.shared.device.destroy_image(self.handle, None);
        }
        self.memory = None;
    }
}
