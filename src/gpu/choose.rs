//! Which device: by index, part of a name, or UUID; by default discrete, then integrated, then software.

use ash::vk;
use std::ffi::CStr;

use super::{
    error::{GpuError, Named},
    loader,
};
use crate::names;

/// How a device is asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum DeviceChoice {
    /// Discrete, then integrated, then virtual, then software.
    #[default]
    Best,
    /// An index of `nephroid devices`, part of a name, or a UUID.
    Named(String),
}

/// What a method may need beyond Vulkan 1.3, and a device may lack.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// Geometry shaders that say how large points are.
    GeometryShader,
    /// Transform feedback (`VK_EXT_transform_feedback`).
    TransformFeedback,
    /// Additive blending into four-channel float32 images.
    Float32Blend,
    /// Points larger than one pixel (`largePoints`).
    LargePoints,
    /// Precise occlusion queries, for fragment counters.
    PreciseOcclusion,
    /// Pipeline statistics, for invocation counters.
    Statistics,
}

impl Feature {
    /// The name Vulkan gives it.
    pub fn name(self) -> &'static str {
        match self {
            Self::GeometryShader => "geometryShader with shaderTessellationAndGeometryPointSize",
            Self::TransformFeedback => "VK_EXT_transform_feedback",
            Self::Float32Blend => "blending on R32G32B32A32_SFLOAT",
            Self::LargePoints => "largePoints",
            Self::PreciseOcclusion => "occlusionQueryPrecise",
            Self::Statistics => "pipelineStatisticsQuery",
        }
    }
}

/// A physical device as the user sees it.
#[derive(Clone, Debug)]
pub struct DeviceInfo {
    /// Its place in the loader's list; not stable between drivers.
    pub index: usize,
    /// The driver's name for it.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// The device's UUID, 32 hexadecimal digits.
    pub uuid: String,
    /// Driver name and version.
    pub driver: String,
    /// Highest Vulkan version.
    pub api: String,
    /// Nanoseconds a timestamp tick.
    pub timestamp_period: f32,
    /// Bits of a timestamp that mean something.
    pub timestamp_bits: u32,
    /// What it has of the optional features.
    pub features: Vec<Feature>,
    /// What it lacks of the required ones; empty if Nephroid runs here.
    pub missing: Vec<String>,
    /// Largest side of a 2D image.
    pub max_image_side: u32,
    /// Largest range of a storage buffer, bytes.
    pub max_buffer_range: u64,
    /// Largest point size, pixels.
    pub max_point_size: f32,
    /// Its own memory, bytes: the largest heap that is local to it.
    pub memory_bytes: u64,
    pub(super) physical: vk::PhysicalDevice,
    pub(super) queue_family: u32,
}

impl DeviceInfo {
    /// True for a device that computes on the CPU: its times are no figures for a GPU.
    pub fn is_software(&self) -> bool {
        self.kind == "software"
    }

    /// One line: name, kind.
    pub fn label(&self) -> String {
        if self.is_software() {
            format!("{}, a software device: its times are not those of a GPU", self.name)
        } else {
            format!("{} ({})", self.name, self.kind)
        }
    }
}

/// Splats are placed on a grid of 1/256 texel (`glsl/shared/splat.glsl`).
const SUB_TEXEL_BITS: u32 = 8;
/// What the largest pass binds, and some more.
const STORAGE_BUFFERS: u32 = 12;

/// Every device the loader finds.
pub fn list_devices() -> Result<Vec<DeviceInfo>, GpuError> {
    let entry = super::device::load()?;
    let instance = super::device::OwnedInstance::new(&entry, false, &[])?;
    inspect(&instance.handle)
}

pub(super) fn inspect(instance: &ash::Instance) -> Result<Vec<DeviceInfo>, GpuError> {
    // SAFETY: the instance lives for the call.
    let found = unsafe { instance.enumerate_physical_devices() };
    let found = match found {
        Err(vk::Result::ERROR_INITIALIZATION_FAILED) => Vec::new(),
        other => other.named("vkEnumeratePhysicalDevices")?,
    };
    found.into_iter().enumerate().map(|(index, physical)| describe(instance, index, physical)).collect()
}

fn describe(instance: &ash::Instance, index: usize, physical: vk::PhysicalDevice) -> Result<DeviceInfo, GpuError> {
    let mut ids = vk::PhysicalDeviceVulkan11Properties::default();
    let mut driver = vk::PhysicalDeviceVulkan12Properties::default();
    let mut has12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut has13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut stream = vk::PhysicalDeviceTransformFeedbackFeaturesEXT::default();
    // SAFETY: all queries are on a physical device of this live instance; structures the device does not know stay zero.
    let (properties, extensions, families, blend, memory) = unsafe {
        let plain = instance.get_physical_device_properties(physical);
        if plain.api_version >= vk::API_VERSION_1_2 {
            let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut ids).push_next(&mut driver);
            instance.get_physical_device_properties2(physical, &mut properties);
        }
        (
            plain,
            instance.enumerate_device_extension_properties(physical).named("vkEnumerateDeviceExtensionProperties")?,
            instance.get_physical_device_queue_family_properties(physical),
            instance.get_physical_device_format_properties(physical, vk::Format::R32G32B32A32_SFLOAT),
            instance.get_physical_device_memory_properties(physical),
        )
    };
    let local = memory.memory_heaps_as_slice().iter().filter(|h| h.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL));
    let has_extension = |name: &CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(name));
    let mut features = vk::PhysicalDeviceFeatures2::default();
    if properties.api_version >= vk::API_VERSION_1_3 {
        features = features.push_next(&mut has12).push_next(&mut has13);
    }
    if has_extension(ash::ext::transform_feedback::NAME) {
        features = features.push_next(&mut stream);
    }
    // SAFETY: the chain holds only structures that this device's version and extensions define.
    unsafe { instance.get_physical_device_features2(physical, &mut features) };
    let core = features.features;

    let mut optional = Vec::new();
    let mut offer = |present: bool, feature| {
        if present {
            optional.push(feature)
        }
    };
    let sized_points = core.shader_tessellation_and_geometry_point_size == vk::TRUE;
    offer(core.geometry_shader == vk::TRUE && sized_points, Feature::GeometryShader);
    offer(stream.transform_feedback == vk::TRUE, Feature::TransformFeedback);
    offer(
        blend.optimal_tiling_features.contains(vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND),
        Feature::Float32Blend,
    );
    offer(core.large_points == vk::TRUE, Feature::LargePoints);
    offer(core.occlusion_query_precise == vk::TRUE, Feature::PreciseOcclusion);
    offer(core.pipeline_statistics_query == vk::TRUE, Feature::Statistics);

    let queue_family = families.iter().position(|f| {
        f.queue_flags.contains(vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE) && f.timestamp_valid_bits >= 36
    });
    let mut missing = Vec::new();
    let mut require = |present: bool, what: &str| {
        if !present {
            missing.push(what.to_owned())
        }
    };
    require(properties.api_version >= vk::API_VERSION_1_3, "Vulkan 1.3");
    require(has12.scalar_block_layout == vk::TRUE, "scalarBlockLayout");
    require(has12.host_query_reset == vk::TRUE, "hostQueryReset");
    require(has12.shader_output_layer == vk::TRUE, "shaderOutputLayer");
    require(has13.synchronization2 == vk::TRUE, "synchronization2");
    require(has13.dynamic_rendering == vk::TRUE, "dynamicRendering");
    require(has13.maintenance4 == vk::TRUE, "maintenance4");
    require(has_extension(ash::khr::push_descriptor::NAME), "VK_KHR_push_descriptor");
    require(queue_family.is_some(), "a graphics and compute queue with timestamps");

    let limits = &properties.limits;
    require(limits.sub_pixel_precision_bits >= SUB_TEXEL_BITS, "points placed to 1/256 pixel (subPixelPrecisionBits)");
    require(
        limits.max_per_stage_descriptor_storage_buffers >= STORAGE_BUFFERS,
        "12 storage buffers a stage (maxPerStageDescriptorStorageBuffers)",
    );

    let kind = match properties.device_type {
        vk::PhysicalDeviceType::DISCRETE_GPU => "discrete",
        vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated",
        vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual",
        vk::PhysicalDeviceType::CPU => "software",
        _ => "other",
    };
    let text = |s: Result<&CStr, _>| s.map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(DeviceInfo {
        index,
        name: text(properties.device_name_as_c_str()),
        kind,
        uuid: ids.device_uuid.iter().map(|b| format!("{b:02x}")).collect(),
        driver: format!("{} {}", text(driver.driver_name_as_c_str()), text(driver.driver_info_as_c_str())),
        api: loader::shown(properties.api_version),
        timestamp_period: properties.limits.timestamp_period,
        features: optional,
        missing,
        max_image_side: properties.limits.max_image_dimension2_d,
        max_buffer_range: properties.limits.max_storage_buffer_range.into(),
        max_point_size: properties.limits.point_size_range[1],
        memory_bytes: local.map(|h| h.size).max().unwrap_or(0),
        physical,
        queue_family: queue_family.unwrap_or(0) as u32,
        timestamp_bits: queue_family.map_or(0, |f| families[f].timestamp_valid_bits),
    })
}

/// The device asked for, or the best suitable one.
pub(super) fn choose(devices: Vec<DeviceInfo>, choice: &DeviceChoice) -> Result<DeviceInfo, GpuError> {
    if devices.is_empty() {
        return Err(GpuError::NoDevice);
    }
    let present = devices.iter().map(|d| format!("{} {}", d.index, d.name)).collect::<Vec<_>>().join(", ");
    let chosen = match choice {
        DeviceChoice::Best => {
            let rank = |d: &DeviceInfo| {
                let kind = ["discrete", "integrated", "virtual", "other", "software"].iter().position(|k| *k == d.kind);
                (!d.missing.is_empty(), kind)
            };
            devices.into_iter().min_by_key(rank)
        }
        DeviceChoice::Named(asked) => {
            let plain = asked.to_lowercase();
            let digits = plain.replace('-', "");
            let mut devices = devices;
            devices
                .iter()
                .position(|d| plain.parse() == Ok(d.index) || d.uuid == digits)
                .or_else(|| devices.iter().position(|d| !plain.is_empty() && d.name.to_lowercase().contains(&plain)))
                .map(|at| devices.swap_remove(at))
        }
    };
    let asked = match choice {
        DeviceChoice::Best => "any".to_owned(),
        DeviceChoice::Named(asked) => asked.clone(),
    };
    let near =
        names::guess(&asked, present.split([' ', ',', '(', ')'])).map_or(String::new(), |near| format!("; {near}"));
    let device = chosen.ok_or(GpuError::NoSuchDevice { asked, present, near })?;
    if device.missing.is_empty() {
        Ok(device)
    } else {
        Err(GpuError::Unsuitable { device: device.name, missing: device.missing.join(", ") })
    }
}
