//! Path classes: one enum for tracers, truth, command line and reports.
use std::{fmt, str::FromStr};

/// Which specular chains between light and receiver count as the caustic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PathClass {
    /// One mirror bounce.
    Reflect1,
    /// Through one surface: into water.
    Transmit1,
    /// Through two surfaces: into and out of glass.
    Transmit2,
    /// Every chain of 1 to this many specular events.
    All(u32),
}

impl PathClass {
    /// Longest chain that [`PathClass::All`] may name.
    pub const LONGEST: u32 = 64;
}

impl fmt::Display for PathClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PathClass::Reflect1 => f.write_str("reflect-1"),
            PathClass::Transmit1 => f.write_str("transmit-1"),
            PathClass::Transmit2 => f.write_str("transmit-2"),
            PathClass::All(events) => write!(f, "all:{events}"),
        }
    }
}

/// Why a text is no [`PathClass`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no path class: use reflect-1, transmit-1, transmit-2 or all:N with N from 1 to 64")]
pub struct PathClassError(pub String);

impl FromStr for PathClass {
    type Err = PathClassError;

    fn from_str(text: &str) -> Result<PathClass, PathClassError> {
        let events = |n: &str| n.parse().ok().filter(|n| (1..=PathClass::LONGEST).contains(n));
        match text {
            "reflect-1" => Some(PathClass::Reflect1),
            "transmit-1" => Some(PathClass::Transmit1),
            "transmit-2" => Some(PathClass::Transmit2),
            _ => text.strip_prefix("all:").and_then(events).map(PathClass::All),
        }
        .ok_or_else(|| PathClassError(text.to_owned()))
    }
}
