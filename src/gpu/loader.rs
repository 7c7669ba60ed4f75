//! What stands between the program and its devices: the loader and its layers, found without any driver.

use ash::vk;

use super::{
    device::{OwnedInstance, VALIDATION, load},
    error::{GpuError, Named},
};

/// The Vulkan loader.
#[derive(Clone, Debug)]
pub struct LoaderInfo {
    /// Highest Vulkan version that it speaks.
    pub version: String,
    /// What it could put between the program and a device.
    pub layers: Vec<LayerInfo>,
}

/// A layer that the loader knows; whether it can be loaded, only use shows.
#[derive(Clone, Debug)]
pub struct LayerInfo {
    /// `VK_LAYER_…`.
    pub name: String,
    /// The Vulkan version that it was written for, and its own.
    pub version: String,
    /// Whether it is the one of `--validation`.
    pub is_validation: bool,
}

/// The loader and the layers that it knows.
pub fn inspect_loader() -> Result<LoaderInfo, GpuError> {
    let entry = load()?;
    // SAFETY: plain queries of the loader.
    let (version, layers) = unsafe {
        (
            entry.try_enumerate_instance_version().named("vkEnumerateInstanceVersion")?,
            entry.enumerate_instance_layer_properties().named("vkEnumerateInstanceLayerProperties")?,
        )
    };
    let layers = layers.iter().map(|layer| LayerInfo {
        name: layer.layer_name_as_c_str().unwrap_or_default().to_string_lossy().into_owned(),
        version: format!("{}, build {}", shown(layer.spec_version), layer.implementation_version),
        is_validation: layer.layer_name_as_c_str() == Ok(VALIDATION),
    });
    Ok(LoaderInfo { version: shown(version.unwrap_or(vk::API_VERSION_1_0)), layers: layers.collect() })
}

/// Loads the validation layer, and lets it go again.
pub fn try_validation() -> Result<(), GpuError> {
    OwnedInstance::new(&load()?, true, &[]).map(drop)
}

/// A Vulkan version as it is read.
pub(super) fn shown(version: u32) -> String {
    let [major, minor, patch] =
        [vk::api_version_major(version), vk::api_version_minor(version), vk::api_version_patch(version)];
    format!("{major}.{minor}.{patch}")
}
