//! What ends a command early: one message, one exit code.

use std::{fmt, io, process::ExitCode};

use crate::{
    gpu::GpuError,
    image::ImageError,
    lab::{CompareError, LabError, sweep::SweepError},
    names::NoSuch,
    passes::PlanError,
    renderer::RenderError,
    scene::{Place, SceneError},
    settings::SettingError,
    whole::FileError,
    window::WindowError,
};

const FAILED: u8 = 1;
/// What was typed cannot be done: change the command.
const USAGE: u8 = 2;
/// A picture is worse than was asked for.
const THRESHOLD: u8 = 3;
const NO_DEVICE: u8 = 4;
/// As a shell says it of a program that Ctrl-C ended.
const INTERRUPTED: u8 = 130;

/// An error with the exit code that it means.
#[derive(Debug)]
pub struct Failure {
    code: u8,
    error: anyhow::Error,
}

impl Failure {
    /// What was typed is wrong.
    pub(super) fn usage(error: impl Into<anyhow::Error>) -> Self {
        Self { code: USAGE, error: error.into() }
    }

    /// What was typed is right, and it failed.
    pub(super) fn failed(error: impl Into<anyhow::Error>) -> Self {
        Self { code: FAILED, error: error.into() }
    }

    /// It was done, and a figure exceeds what was asked for.
    pub(super) fn threshold(error: impl Into<anyhow::Error>) -> Self {
        Self { code: THRESHOLD, error: error.into() }
    }

    /// Ctrl-C, with what it leaves.
    pub(super) fn interrupted(error: impl Into<anyhow::Error>) -> Self {
        Self { code: INTERRUPTED, error: error.into() }
    }

    /// Nothing here can do it.
    pub(super) fn no_device(error: impl Into<anyhow::Error>) -> Self {
        Self { code: NO_DEVICE, error: error.into() }
    }

    /// The process's exit code.
    pub fn code(&self) -> ExitCode {
        ExitCode::from(self.code)
    }
}

/// The whole chain of errors as one message.
impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#}", self.error)
    }
}

impl From<SettingError> for Failure {
    fn from(error: SettingError) -> Self {
        Self::usage(error)
    }
}

impl From<NoSuch> for Failure {
    fn from(error: NoSuch) -> Self {
        Self::usage(error)
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        // A file with a fault is no fault of the command.
        let code = if matches!(*error.place, Place::File { .. }) { FAILED } else { USAGE };
        Self { code, error: error.into() }
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        RenderError::from(error).into()
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        use GpuError::{NoCapture, NoDevice, NoLoader, NoScreen, NoSuchDevice, TooLarge, Unsuitable};
        let code = match &error {
            RenderError::Lacks { .. } => NO_DEVICE,
            RenderError::Gpu(NoDevice | NoLoader(_) | NoScreen(_) | NoSuchDevice { .. } | Unsuitable { .. }) => {
                NO_DEVICE
            }
            RenderError::Gpu(NoCapture(_) | TooLarge { .. }) => USAGE,
            RenderError::Unknown(_) | RenderError::Plan(PlanError::Refused { .. }) => USAGE,
            RenderError::Gpu(_) | RenderError::Plan(PlanError::Accel(_)) => FAILED,
        };
        Self { code, error: error.into() }
    }
}

impl From<LabError> for Failure {
    fn from(error: LabError) -> Self {
        match error {
            LabError::Render(error) => error.into(),
            LabError::Interrupted | LabError::Stopped { .. } => Self { code: INTERRUPTED, error: error.into() },
            other => Self::failed(other),
        }
    }
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Written(error) => error.into(),
            SweepError::Lab(error) => error.into(),
            other => Self::failed(other),
        }
    }
}

impl From<CompareError> for Failure {
    fn from(error: CompareError) -> Self {
        Self::failed(error)
    }
}

impl From<WindowError> for Failure {
    fn from(error: WindowError) -> Self {
        match error {
            WindowError::Render(error) => error.into(),
            WindowError::NoDisplay(_) => Self { code: NO_DEVICE, error: error.into() },
            other => Self::failed(other),
        }
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::failed(error)
    }
}

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Self {
        Self::failed(error)
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::failed(error)
    }
}
