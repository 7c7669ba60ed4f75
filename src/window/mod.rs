//! Floor 6: a window over the renderer. It shows what the renderer's own frame makes, and adds nothing to it but one
//! pass that tone-maps a layer on the device.

mod app;
mod keys;
mod live;
mod orbit;
mod times;

use std::path::PathBuf;

use winit::event_loop::EventLoop;

use crate::{
    gpu::{GpuError, GpuOptions},
    image::ImageError,
    renderer::{Job, RenderError},
    whole::FileError,
};

pub use keys::help;
pub use times::Watched;

/// What ends a window early.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// There is nowhere to show it, or a library for that is missing.
    #[error(
        "no window can be opened: {0}; it needs a display (DISPLAY or WAYLAND_DISPLAY; xvfb-run -a gives one that nobody sees), and under X11 the libraries that scripts/setup installs"
    )]
    NoDisplay(String),
    /// The window system took it back.
    #[error("the window failed: {0}")]
    Failed(String),
    /// Planning, preparing or rendering.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The screenshot cannot be encoded.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The screenshot cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The validation layers had something to say.
    #[error("validation: {}", .0.join("\nvalidation: "))]
    Validation(Vec<String>),
}

impl From<GpuError> for WindowError {
    fn from(error: GpuError) -> Self {
        RenderError::from(error).into()
    }
}

/// How a job is watched.
#[derive(Clone, Debug)]
pub struct Viewing {
    /// Which device, and whether it is validated.
    pub gpu: GpuOptions,
    /// Timed frames after which the window closes by itself.
    pub frames: Option<u32>,
    /// Where what the window shows in the end is written, as PNG.
    pub screenshot: Option<PathBuf>,
    /// What was typed, for the screenshot's provenance.
    pub arguments: Vec<String>,
    /// Exposure to begin with, EV.
    pub ev: f64,
    /// Hears what there is to say while the window is open.
    pub say: fn(&str),
}

/// Opens a window on a job until it is closed; the times of its last frames.
pub fn view(job: Job, viewing: Viewing) -> Result<Watched, WindowError> {
    check_libraries()?;
    let events = EventLoop::new().map_err(|error| WindowError::NoDisplay(reason(&error.to_string())))?;
    let mut app = app::App::new(job, viewing);
    events.run_app(&mut app).map_err(|error| WindowError::Failed(error.to_string()))?;
    app.finish()
}

/// What winit says without the place in its source where it says so.
fn reason(error: &str) -> String {
    let place = |text: &str| Some(text.split_once(".rs:")?.1.split_once(": ")?.1.to_owned());
    error.strip_prefix("os error at ").and_then(place).unwrap_or_else(|| error.to_owned())
}

/// Where winit would panic for want of a library, this is an error.
fn check_libraries() -> Result<(), WindowError> {
    #[cfg(target_os = "linux")]
    {
        let missing = |library: &str| Err(WindowError::NoDisplay(format!("{library} is not installed")));
        if xkbcommon_dl::xkbcommon_option().is_none() {
            return missing("libxkbcommon.so.0");
        }
        let wayland = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET"].iter().any(|v| std::env::var_os(v).is_some());
        if !wayland && xkbcommon_dl::x11::xkbcommon_x11_option().is_none() {
            return missing("libxkbcommon-x11.so.0");
        }
    }
    Ok(())
}
