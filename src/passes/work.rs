//! What the passes of methods and of the eye are planned with.

use super::{accel::SceneArrays, extents::Receiver, scene::SceneBuffers};
use crate::{
    gpu::{BufferId, Plan},
    scene::{Camera, Scene},
    settings::Settings,
    view::Extent,
};

/// A plan being made, and all that is known of the scene and of the picture.
pub struct Work<'a> {
    /// The plan to add to.
    pub plan: &'a mut Plan,
    /// The settings.
    pub settings: &'a Settings,
    /// The scene.
    pub scene: &'a Scene,
    /// Its arrays.
    pub arrays: &'a SceneArrays,
    /// Its buffers.
    pub buffers: &'a SceneBuffers,
    /// The buffer of [`FrameData`](super::eye::FrameData).
    pub frame: BufferId,
    /// The camera.
    pub camera: &'a Camera,
    /// The rectangles to cover: the receiver region or the scene's extent first, then what else may be seen.
    pub receivers: &'a [Receiver],
    /// All objects that may be seen lit, whatever their shape.
    pub seen: &'a [usize],
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// Samples a pixel along each axis.
    pub samples: u32,
    /// All that the scene holds.
    pub everything: &'a Extent,
}
