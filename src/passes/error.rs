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

/// What is refused, why, and what to do instead.
///
/// # Errors
/// Always [`PlanError::Refused`].
pub fn refused<T>(what: impl Into<String>, reason: impl Into<String>, remedy: &str) -> Result<T, PlanError> {
    Err(PlanError::Refused { what: what.into(), reason: reason.into(), remedy: remedy.into() })
}
