//! What can be wrong with an image.

/// An image that cannot be put together, written or read.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// A layer does not fit its image.
    #[error("image layer \"{name}\": {problem}")]
    Layer {
        /// The layer.
        name: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A provenance entry cannot be stored in this format.
    #[error("provenance \"{name}\": {problem}")]
    Provenance {
        /// The entry.
        name: String,
        /// What is wrong with it.
        problem: String,
    },
    /// The image has no layer or no pixel.
    #[error("an image of {width} × {height} pixels and {layers} layers has nothing to write")]
    Empty {
        /// Pixels across.
        width: usize,
        /// Pixels down.
        height: usize,
        /// How many.
        layers: usize,
    },
    /// The bytes are not a file of this format, or not one that is supported.
    #[error("not a readable {format} file: {problem}")]
    Format {
        /// The format expected.
        format: &'static str,
        /// What is wrong with it.
        problem: String,
    },
}

impl ImageError {
    pub(super) fn layer(name: &str, problem: impl Into<String>) -> Self {
        Self::Layer { name: name.to_owned(), problem: problem.into() }
    }

    pub(super) fn provenance(name: &str, problem: impl Into<String>) -> Self {
        Self::Provenance { name: name.to_owned(), problem: problem.into() }
    }
}
