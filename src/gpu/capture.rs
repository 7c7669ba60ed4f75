//! RenderDoc, when it is loaded into the process.

use std::sync::{Mutex, PoisonError};

use super::error::GpuError;

/// The in-application interface of a loaded RenderDoc.
pub(super) struct Capture(Mutex<renderdoc::RenderDoc<renderdoc::V110>>);

impl Capture {
    pub fn new() -> Result<Self, GpuError> {
        renderdoc::RenderDoc::new().map(|api| Self(Mutex::new(api))).map_err(|e| GpuError::NoCapture(e.to_string()))
    }

    pub fn start(&self) {
        self.api().start_frame_capture(std::ptr::null(), std::ptr::null());
    }

    pub fn end(&self) {
        self.api().end_frame_capture(std::ptr::null(), std::ptr::null());
    }

    fn api(&self) -> std::sync::MutexGuard<'_, renderdoc::RenderDoc<renderdoc::V110>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
