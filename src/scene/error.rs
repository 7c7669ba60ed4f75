//! What is wrong with a scene, and where.
use std::fmt;

/// One fault of a scene. Its message has one form: place, key, expected, found, remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {}expected {expected}, found {found}; {remedy}", quoted(.key))]
pub struct SceneError {
    /// Where it was written.
    pub place: Box<Place>,
    /// Dotted path of the key; empty where the fault has none.
    pub key: String,
    /// What should stand there.
    pub expected: String,
    /// What stands there.
    pub found: String,
    /// What to do about it, near names among them.
    pub remedy: String,
}

fn quoted(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("`{key}`: ") }
}

/// Where a fault was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The scene as a whole: it could not be found or read.
    Scene(String),
    /// A place in a file.
    File {
        /// As the user named it.
        file: String,
        /// From 1.
        line: usize,
        /// From 1, in characters.
        column: usize,
    },
    /// An override, as it would be typed.
    Override {
        /// The scene file it was set in.
        file: String,
        /// Without the `scene.` prefix.
        key: String,
        /// As given.
        value: String,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Scene(name) => f.write_str(name),
            Place::File { file, line, column } => write!(f, "{file}:{line}:{column}"),
            Place::Override { file, key, value } => write!(f, "--set scene.{key}={value} (in {file})"),
        }
    }
}
