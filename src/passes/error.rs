//! Why a scene cannot be planned.

use super::accel::AccelError;

/// A scene, a setting or a method that does not fit the others.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The scene cannot be laid out for the device.
    #[error(transparent)]
    Accel(#[from] AccelError),
    /// Something that is named but not built, or that has no meaning here.
    #[error("{what}: {reason}; {remedy}")]
    Refused {
        /// The scene's key or the setting.
        what: String,
        /// Why.
        reason: String,
        /// What to do instead.
        remedy: String,
    },
}
