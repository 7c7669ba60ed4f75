//! Why a scene cannot be laid out for the shaders.

/// Names the object (or material, or light) at fault and what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages name every field
pub enum AccelError {
    #[error("`{name}`: {what} is {value:e}, beyond the ±{limit:e} that float32 shaders can square; rescale the scene")]
    Range { name: String, what: &'static str, value: f64, limit: f64 },
    #[error("`{name}`: its shape is flat in a direction where it needs extent; give it a size above zero")]
    Flat { name: String },
    #[error("`{name}`: triangle {triangle} of `{file}` names a vertex that the mesh does not have")]
    Vertex { name: String, file: String, triangle: usize },
    #[error("the scene has {count} {what}, the shaders hold {limit}")]
    Count { what: &'static str, count: usize, limit: usize },
}
