//! A window's surface: what it asks of the instance and the device, and how both are told.

use ash::{khr, vk};
use raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use std::{
    ffi::{CStr, c_char},
    sync::Arc,
};

use super::{
    choose::DeviceInfo,
    device::OwnedInstance,
    error::{GpuError, Named},
};

/// A window of any window system.
pub trait OnScreen: HasDisplayHandle + HasWindowHandle + Send + Sync {}

impl<T: HasDisplayHandle + HasWindowHandle + Send + Sync> OnScreen for T {}

/// A surface that destroys itself, and the window that it must not outlive.
pub(super) struct Surface {
    pub handle: vk::SurfaceKHR,
    pub loader: khr::surface::Instance,
    _window: Arc<dyn OnScreen>,
}

/// The instance extensions that a window of this kind needs.
pub(super) fn instance_extensions(window: &dyn OnScreen) -> Result<&'static [*const c_char], GpuError> {
    let display = window.display_handle().map_err(|e| GpuError::NoScreen(e.to_string()))?;
    let none = |_| GpuError::NoScreen("Vulkan knows no surface for this window system".to_owned());
    ash_window::enumerate_required_extensions(display.as_raw()).map_err(none)
}

/// Refuses what the loader and its drivers lack of the extensions, by name.
pub(super) fn check_extensions(wanted: &[*const c_char], found: &[vk::ExtensionProperties]) -> Result<(), GpuError> {
    // SAFETY: the names are constants of `ash`, ended by a zero.
    let names = wanted.iter().map(|&name| unsafe { CStr::from_ptr(name) });
    let lacking: Vec<_> = names.filter(|n| !found.iter().any(|e| e.extension_name_as_c_str() == Ok(n))).collect();
    if lacking.is_empty() {
        return Ok(());
    }
    let names: Vec<_> = lacking.iter().map(|n| n.to_string_lossy()).collect();
    Err(GpuError::NoScreen(format!("no Vulkan driver here offers {}", names.join(", "))))
}

impl Surface {
    pub fn new(entry: &ash::Entry, instance: &OwnedInstance, window: Arc<dyn OnScreen>) -> Result<Self, GpuError> {
        let display = window.display_handle().map_err(|e| GpuError::NoScreen(e.to_string()))?.as_raw();
        let handle = window.window_handle().map_err(|e| GpuError::NoScreen(e.to_string()))?.as_raw();
        let loader = khr::surface::Instance::new(entry, &instance.handle);
        // SAFETY: the extensions are enabled, and the window is kept as long as its surface; the instance outlives both.
        let handle = unsafe { ash_window::create_surface(entry, &instance.handle, display, handle, None) }
            .named("vkCreateSurfaceKHR")?;
        Ok(Self { handle, loader, _window: window })
    }

    /// Adds to what the device lacks, if it cannot show pictures in this window.
    pub fn require(&self, instance: &ash::Instance, device: &mut DeviceInfo) -> Result<(), GpuError> {
        // SAFETY: device and surface are of this live instance, the family's index is one that the device reported.
        let (extensions, shows) = unsafe {
            (
                instance.enumerate_device_extension_properties(device.physical),
                self.loader.get_physical_device_surface_support(device.physical, device.queue_family, self.handle),
            )
        };
        let extensions = extensions.named("vkEnumerateDeviceExtensionProperties")?;
        if !extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(khr::swapchain::NAME)) {
            device.missing.push("VK_KHR_swapchain".to_owned());
        }
        if !shows.named("vkGetPhysicalDeviceSurfaceSupportKHR")? {
            device.missing.push("a queue that can show pictures in this window".to_owned());
        }
        Ok(())
    }

    /// A format of eight bits a band in sRGB: one that stores what is written, else one that encodes it.
    pub fn format(&self, physical: vk::PhysicalDevice) -> Result<vk::SurfaceFormatKHR, GpuError> {
        // SAFETY: device and surface are of one live instance.
        let offered = unsafe { self.loader.get_physical_device_surface_formats(physical, self.handle) }
            .named("vkGetPhysicalDeviceSurfaceFormatsKHR")?;
        let known = [
            vk::Format::B8G8R8A8_UNORM,
            vk::Format::R8G8B8A8_UNORM,
            vk::Format::B8G8R8A8_SRGB,
            vk::Format::R8G8B8A8_SRGB,
        ];
        let srgb = |f: &&vk::SurfaceFormatKHR| f.color_space == vk::ColorSpaceKHR::SRGB_NONLINEAR;
        let rank = |f: &vk::SurfaceFormatKHR| known.iter().position(|k| *k == f.format);
        let best = offered.iter().filter(srgb).filter_map(|f| Some((rank(f)?, *f))).min_by_key(|(rank, _)| *rank);
        let none = || GpuError::NoScreen("the window has no format of eight bits in sRGB".to_owned());
        best.map(|(_, format)| format).ok_or_else(none)
    }

    /// What the window allows as it is now.
    pub fn capabilities(&self, physical: vk::PhysicalDevice) -> Result<vk::SurfaceCapabilitiesKHR, GpuError> {
        // SAFETY: device and surface are of one live instance.
        unsafe { self.loader.get_physical_device_surface_capabilities(physical, self.handle) }
            .named("vkGetPhysicalDeviceSurfaceCapabilitiesKHR")
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: swapchains hold the device, which is closed before its surface is dropped.
        unsafe { self.loader.destroy_surface(self.handle, None) }
    }
}
