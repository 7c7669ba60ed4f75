//! What can go wrong on the device, said with its remedy.

use ash::vk;

/// An error of the device floor. Each text names what failed and what to do.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// The Vulkan loader is not installed.
    #[error("no Vulkan loader: {0}; install it (Debian, Ubuntu: libvulkan1, or run scripts/setup)")]
    NoLoader(String),
    /// The loader found no driver at all.
    #[error(
        "no Vulkan device: the loader found no driver; for a software device install mesa-vulkan-drivers (scripts/setup does)"
    )]
    NoDevice,
    /// The asked-for device is not there.
    #[error("no device matches '{asked}'; present: {present}{near}")]
    NoSuchDevice {
        /// What the user asked for.
        asked: String,
        /// The devices that are there.
        present: String,
        /// What was perhaps meant, as a question.
        near: String,
    },
    /// The device lacks something that every frame needs.
    #[error(
        "device '{device}' cannot run Nephroid: it lacks {missing}; choose another with --device (nephroid devices lists them)"
    )]
    Unsuitable {
        /// The device.
        device: String,
        /// What it lacks.
        missing: String,
    },
    /// A window was asked for and cannot be shown.
    #[error("no window can be shown: {0}")]
    NoScreen(String),
    /// A layer that was asked for is not installed.
    #[error("validation layer {0} is not installed (Debian, Ubuntu: vulkan-validationlayers, or run scripts/setup)")]
    NoLayer(String),
    /// GLSL that does not compile; the text carries file:line.
    #[error("shader {file} does not compile:\n{text}")]
    Shader {
        /// The file under `glsl/`.
        file: String,
        /// The compiler's messages.
        text: String,
    },
    /// A pass and its shader disagree about a binding.
    #[error("pass '{pass}': {text}")]
    Binding {
        /// The pass.
        pass: String,
        /// Both sides of the disagreement.
        text: String,
    },
    /// A plan that the device cannot hold.
    #[error("'{name}' does not fit on the device: {text}")]
    TooLarge {
        /// The buffer or image.
        name: String,
        /// What exceeds what.
        text: String,
    },
    /// Device memory.
    #[error("out of device memory for '{name}' ({bytes} bytes): {text}; lower light.side, maps.side or --size")]
    Memory {
        /// The allocation.
        name: String,
        /// Its size.
        bytes: u64,
        /// The allocator's reason.
        text: String,
    },
    /// A capture was asked for and RenderDoc is not loaded.
    #[error(
        "--capture: RenderDoc is not loaded into this process ({0}); start nephroid from RenderDoc or with renderdoccmd capture"
    )]
    NoCapture(String),
    /// Any other Vulkan call that failed.
    #[error("{call} failed: {result:?}")]
    Vulkan {
        /// The call.
        call: &'static str,
        /// Vulkan's answer.
        result: vk::Result,
    },
}

/// Names the call that failed.
pub(super) trait Named<T> {
    fn named(self, call: &'static str) -> Result<T, GpuError>;
}

impl<T> Named<T> for Result<T, vk::Result> {
    fn named(self, call: &'static str) -> Result<T, GpuError> {
        self.map_err(|result| GpuError::Vulkan { call, result })
    }
}
