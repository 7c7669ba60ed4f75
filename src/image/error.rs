//! What can be wrong with an image.

/// An image that cannot be put together, written or read.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// A layer does not fit its image.
    #[error("image layer \"{name}\": {problem}")]
    Layer { name: String, problem: String },
    /// A provenance entry cannot be stored in this format.
    #[error("provenance \"{name}\": {problem}")]
    Provenance { name: String, problem: String },
    /// The image has no layer or no pixel.
    #[error("an image of {width} × {height} pixels and {layers} layers has nothing to write")]
    Empty { width: usize, height: usize, layers: usize },
    /// The bytes are not a file of this format, or not one that is supported.
    #[error("not a readable {format} file: {problem}")]
    Format { format: &'static str, problem: String },
}

impl ImageError {
    pub(super) fn layer(name: &str, problem: impl Into<String>) -> Self {
        Self::Layer { name: name.to_owned(), problem: problem.into() }
    }

    pub(super) fn provenance(name: &str, problem: impl Into<String>) -> Self {
        Self::Provenance { name: name.to_owned(), problem: problem.into() }
    }
}
