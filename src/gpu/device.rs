//! The device: instance, queue, allocator, object names, and a count of the calls a frame must not make.

use ash::{ext, khr, vk};
use gpu_allocator::{AllocatorDebugSettings, vulkan as memory};
use std::{
    ffi::{CStr, CString, c_char},
    io::Write,
    mem::ManuallyDrop,
    sync::{
        Arc, Mutex, MutexGuard,
        atomic::{AtomicU64, Ordering::Relaxed},
    },
};

use super::{
    choose::{self, DeviceChoice, DeviceInfo, Feature},
    error::{GpuError, Named},
    messages::Messages,
    pipeline::PipelineCache,
    surface::{self, OnScreen, Surface},
};

/// The layer of `--validation`.
pub(super) const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

/// How to open a device.
#[derive(Clone, Debug, Default)]
pub struct GpuOptions {
    /// Which one.
    pub device: DeviceChoice,
    /// Core and synchronisation validation; never in timed runs.
    pub validation: bool,
    /// Trigger RenderDoc around every frame.
    pub capture: bool,
}

/// How often a call was made that has no place inside a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Calls {
    /// Memory allocations.
    pub allocations: u64,
    /// Pipelines created.
    pub pipelines: u64,
    /// Waits on the device.
    pub waits: u64,
    /// Copies from device to host memory read by the CPU.
    pub reads: u64,
    /// Queue submissions.
    pub submits: u64,
}

#[derive(Default)]
pub(super) struct CallCounts {
    pub allocations: AtomicU64,
    pub pipelines: AtomicU64,
    pub waits: AtomicU64,
    pub reads: AtomicU64,
    pub submits: AtomicU64,
}

/// An open device. Clones share it; the last one closes it.
#[derive(Clone)]
pub struct Gpu(pub(super) Arc<Shared>);

pub(super) struct Shared {
    pub device: ash::Device,
    pub push: khr::push_descriptor::Device,
    feedback: Option<ext::transform_feedback::Device>,
    pub labels: Option<ext::debug_utils::Device>,
    pub queue: vk::Queue,
    pub pool: vk::CommandPool,
    pub info: DeviceInfo,
    pub calls: CallCounts,
    pub capture: Option<super::capture::Capture>,
    pub pipelines: PipelineCache,
    allocator: ManuallyDrop<Mutex<memory::Allocator>>,
    /// The window's, where the device was opened for one.
    pub surface: Option<Surface>,
    // Declared last, dropped last: everything above lives inside the instance.
    messages: Option<Messages>,
    pub instance: OwnedInstance,
}

/// The loader, or how to install it.
pub(super) fn load() -> Result<ash::Entry, GpuError> {
    // SAFETY: loading the system's Vulkan loader runs its initialisers, which are trusted as any driver is.
    unsafe { ash::Entry::load() }.map_err(|e| GpuError::NoLoader(e.to_string()))
}

/// An instance that destroys itself.
pub(super) struct OwnedInstance {
    pub handle: ash::Instance,
    pub labels: bool,
    _entry: ash::Entry,
}

impl OwnedInstance {
    /// `window`: the extensions that a window needs.
    pub fn new(entry: &ash::Entry, validation: bool, window: &[*const c_char]) -> Result<Self, GpuError> {
        // SAFETY: plain queries of the loader.
        let (layers, extensions) = unsafe {
            (
                entry.enumerate_instance_layer_properties().named("vkEnumerateInstanceLayerProperties")?,
                entry.enumerate_instance_extension_properties(None).named("vkEnumerateInstanceExtensionProperties")?,
            )
        };
        if validation && !layers.iter().any(|l| l.layer_name_as_c_str() == Ok(VALIDATION)) {
            return Err(GpuError::NoLayer(VALIDATION.to_string_lossy().into_owned()));
        }
        let labels = validation || extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(ext::debug_utils::NAME));
        let layer_names = if validation { vec![VALIDATION.as_ptr()] } else { Vec::new() };
        surface::check_extensions(window, &extensions)?;
        let mut extension_names = window.to_vec();
        if labels {
            extension_names.push(ext::debug_utils::NAME.as_ptr());
        }
        let application = vk::ApplicationInfo::default().application_name(c"nephroid").api_version(vk::API_VERSION_1_3);
        let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut synchronisation = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .enabled_layer_names(&layer_names)
            .enabled_extension_names(&extension_names);
        if validation {
            info = info.push_next(&mut synchronisation);
        }
        // SAFETY: every pointer in `info` outlives the call.
        let handle = match unsafe { entry.create_instance(&info, None) } {
            Err(vk::Result::ERROR_INCOMPATIBLE_DRIVER) => return Err(GpuError::NoDevice),
            other => other.named("vkCreateInstance")?,
        };
        Ok(Self { handle, labels, _entry: entry.clone() })
    }
}

impl Drop for OwnedInstance {
    fn drop(&mut self) {
        // SAFETY: owners of children are dropped before this.
        unsafe { self.handle.destroy_instance(None) }
    }
}

impl Gpu {
    /// Opens a device. Errors name what is missing and how to get it.
    pub fn new(options: &GpuOptions) -> Result<Self, GpuError> {
        Self::open(options, None)
    }

    /// Opens a device that can show pictures in the window, which is kept as long as the device is open.
    pub fn for_window(options: &GpuOptions, window: Arc<dyn OnScreen>) -> Result<Self, GpuError> {
        Self::open(options, Some(window))
    }

    fn open(options: &GpuOptions, window: Option<Arc<dyn OnScreen>>) -> Result<Self, GpuError> {
        let capture = options.capture.then(super::capture::Capture::new).transpose()?;
        let entry = load()?;
        let extensions = window.as_ref().map(|w| surface::instance_extensions(&**w)).transpose()?.unwrap_or_default();
        let instance = OwnedInstance::new(&entry, options.validation, extensions)?;
        let messages = options.validation.then(|| Messages::new(&entry, &instance.handle)).transpose()?;
        let surface = window.map(|window| Surface::new(&entry, &instance, window)).transpose()?;
        let mut devices = choose::inspect(&instance.handle)?;
        if let Some(surface) = &surface {
            devices.iter_mut().try_for_each(|device| surface.require(&instance.handle, device))?;
        }
        let info = choose::choose(devices, &options.device)?;
        let device = create_device(&instance.handle, &info, surface.is_some())?;
        let guard = DeviceGuard(device);
        let device = guard.0.clone();
        // SAFETY: the queue family and its one queue were asked for in `create_device`.
        let queue = unsafe { device.get_device_queue(info.queue_family, 0) };
        let pool_info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(info.queue_family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        let allocator = memory::Allocator::new(&memory::AllocatorCreateDesc {
            instance: instance.handle.clone(),
            device: device.clone(),
            physical_device: info.physical,
            debug_settings: AllocatorDebugSettings::default(),
            buffer_device_address: false,
            allocation_sizes: Default::default(),
        })
        .map_err(|e| GpuError::Memory { name: "allocator".into(), bytes: 0, text: e.to_string() })?;
        // SAFETY: the device lives; the pool is destroyed in `Shared::drop`.
        let pool = unsafe { device.create_command_pool(&pool_info, None) }.named("vkCreateCommandPool")?;
        std::mem::forget(guard);
        Ok(Self(Arc::new(Shared {
            push: khr::push_descriptor::Device::new(&instance.handle, &device),
            feedback: info
                .features
                .contains(&Feature::TransformFeedback)
                .then(|| ext::transform_feedback::Device::new(&instance.handle, &device)),
            labels: instance.labels.then(|| ext::debug_utils::Device::new(&instance.handle, &device)),
            device,
            queue,
            pool,
            info,
            calls: CallCounts::default(),
            capture,
            pipelines: PipelineCache::default(),
            allocator: ManuallyDrop::new(Mutex::new(allocator)),
            surface,
            messages,
            instance,
        })))
    }

    /// What was opened.
    pub fn info(&self) -> &DeviceInfo {
        &self.0.info
    }

    /// True if the device has the feature.
    pub fn has(&self, feature: Feature) -> bool {
        self.0.info.features.contains(&feature)
    }

    /// What the validation layers said since the last call.
    pub fn take_messages(&self) -> Vec<String> {
        self.0.messages.as_ref().map(Messages::take).unwrap_or_default()
    }

    /// Calls made so far.
    pub fn calls(&self) -> Calls {
        let counts = &self.0.calls;
        Calls {
            allocations: counts.allocations.load(Relaxed),
            pipelines: counts.pipelines.load(Relaxed),
            waits: counts.waits.load(Relaxed),
            reads: counts.reads.load(Relaxed),
            submits: counts.submits.load(Relaxed),
        }
    }

    /// Live allocations by name and bytes, largest first.
    pub fn live_allocations(&self) -> Vec<(String, u64)> {
        let report = self.0.allocator().generate_report();
        let mut live: Vec<_> = report.allocations.into_iter().map(|a| (a.name, a.size)).collect();
        live.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        live
    }
}

/// Destroys a device that was created but not yet owned.
struct DeviceGuard(ash::Device);

impl Drop for DeviceGuard {
    fn drop(&mut self) {
        // SAFETY: nothing was made from it yet.
        unsafe { self.0.destroy_device(None) }
    }
}

fn create_device(instance: &ash::Instance, info: &DeviceInfo, shows: bool) -> Result<ash::Device, GpuError> {
    let has = |f| info.features.contains(&f);
    let priorities = [1.0];
    let queues =
        [vk::DeviceQueueCreateInfo::default().queue_family_index(info.queue_family).queue_priorities(&priorities)];
    let mut extensions = vec![khr::push_descriptor::NAME.as_ptr()];
    if shows {
        extensions.push(khr::swapchain::NAME.as_ptr());
    }
    let core = vk::PhysicalDeviceFeatures::default()
        .geometry_shader(has(Feature::GeometryShader))
        .shader_tessellation_and_geometry_point_size(has(Feature::GeometryShader))
        .large_points(has(Feature::LargePoints))
        .occlusion_query_precise(has(Feature::PreciseOcclusion))
        .pipeline_statistics_query(has(Feature::Statistics));
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default()
        .scalar_block_layout(true)
        .host_query_reset(true)
        .shader_output_layer(true);
    let mut v13 =
        vk::PhysicalDeviceVulkan13Features::default().synchronization2(true).dynamic_rendering(true).maintenance4(true);
    let mut stream = vk::PhysicalDeviceTransformFeedbackFeaturesEXT::default().transform_feedback(true);
    let mut create = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_features(&core);
    create = create.push_next(&mut v12).push_next(&mut v13);
    if has(Feature::TransformFeedback) {
        extensions.push(ext::transform_feedback::NAME.as_ptr());
        create = create.push_next(&mut stream);
    }
    // SAFETY: every pointer outlives the call; only features that the device reported are enabled.
    unsafe { instance.create_device(info.physical, &create.enabled_extension_names(&extensions), None) }
        .named("vkCreateDevice")
}

impl Shared {
    pub fn allocator(&self) -> MutexGuard<'_, memory::Allocator> {
        self.allocator.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Transform feedback, which every method that streams declares it needs.
    pub fn feedback(&self) -> &ext::transform_feedback::DeviceFn {
        self.feedback.as_ref().expect("a plan that streams runs where the device has transform feedback").fp()
    }

    /// Pipeline stages that barriers may name on this device.
    pub fn known_stages(&self) -> vk::PipelineStageFlags2 {
        let optional = [
            (Feature::GeometryShader, vk::PipelineStageFlags2::GEOMETRY_SHADER),
            (Feature::TransformFeedback, vk::PipelineStageFlags2::TRANSFORM_FEEDBACK_EXT),
        ];
        let lacking = optional.into_iter().filter(|(feature, _)| !self.info.features.contains(feature));
        lacking.fold(!vk::PipelineStageFlags2::NONE, |known, (_, stage)| known & !stage)
    }

    /// Names an object for the validation layers and for captures.
    pub fn name<H: vk::Handle>(&self, handle: H, name: &str) {
        if let (Some(labels), Ok(name)) = (&self.labels, CString::new(name)) {
            let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
            // SAFETY: the handle is live, the name outlives the call; a failure loses a name, no more.
            let _ = unsafe { labels.set_debug_utils_object_name(&info) };
        }
    }

    /// Runs a one-off command buffer to its end: uploads, reads and first layouts, never inside a frame.
    pub fn run_once(&self, record: impl FnOnce(vk::CommandBuffer)) -> Result<(), GpuError> {
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the buffer comes from this pool, is ended before submission and freed after the queue is idle.
        unsafe {
            let commands = self.device.allocate_command_buffers(&info).named("vkAllocateCommandBuffers")?;
            let done = (|| {
                self.device.begin_command_buffer(commands[0], &begin).named("vkBeginCommandBuffer")?;
                record(commands[0]);
                self.device.end_command_buffer(commands[0]).named("vkEndCommandBuffer")?;
                let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
                self.calls.submits.fetch_add(1, Relaxed);
                self.device.queue_submit(self.queue, &submit, vk::Fence::null()).named("vkQueueSubmit")?;
                self.calls.waits.fetch_add(1, Relaxed);
                self.device.queue_wait_idle(self.queue).named("vkQueueWaitIdle")
            })();
            self.device.free_command_buffers(self.pool, &commands);
            done
        }
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: every resource holds an `Arc` of this, so none is left; the allocator goes before its device.
        unsafe {
            let _ = self.device.device_wait_idle();
            self.pipelines.destroy(&self.device);
            self.device.destroy_command_pool(self.pool, None);
            for leak in self.allocator().generate_report().allocations {
                let _ = writeln!(std::io::stderr(), "leaked device memory: {} ({} bytes)", leak.name, leak.size);
            }
            ManuallyDrop::drop(&mut self.allocator);
            self.device.destroy_device(None);
        }
    }
}
