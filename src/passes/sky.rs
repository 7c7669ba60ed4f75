//! The sky on the device (`glsl/eye/sky.glsl`): what the eye reads where nothing else is. It lights nothing.

use glam::DVec3;

use super::{Work, accel::SceneArrays, eye};
use crate::{
    gpu::{BufferId, PassBuilder, Plan},
    scene::{Scene, Shape, Sky},
};

/// As its shader knows it (`SkyGradient`).
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of `Sky::Gradient`
pub struct SkyGradient {
    pub up: [f32; 3],
    pub zenith: [f32; 3],
    pub horizon: [f32; 3],
    pub ground: [f32; 3],
}

/// As its shader knows it (`SkyImage`).
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct SkyImage {
    /// Pixels.
    pub size: [u32; 2],
    /// Unit, a quarter of the picture right of its middle.
    pub right: [f32; 3],
    /// Unit, to the zenith.
    pub up: [f32; 3],
    /// Unit, to the picture's middle.
    pub ahead: [f32; 3],
}

/// The buffers of a sky that is seen.
#[derive(Clone, Copy, Debug)]
pub struct SkyBuffers {
    sky: BufferId,
    /// Of a picture.
    texels: Option<BufferId>,
}

impl SkyBuffers {
    /// Adds them to the plan with their contents; `None` where the scene has no sky.
    pub fn upload(plan: &mut Plan, scene: &Scene, arrays: &SceneArrays) -> Option<Self> {
        let f32s = |v: &[f64; 3]| v.map(|x| x as f32);
        let vector = |v: &DVec3| v.as_vec3().to_array();
        Some(match scene.sky.as_ref()? {
            Sky::Gradient { up, zenith, horizon, ground } => {
                let [zenith, horizon, ground] = [zenith, horizon, ground].map(f32s);
                let data = SkyGradient { up: vector(up), zenith, horizon, ground };
                Self { sky: plan.upload_once("scene/sky", &[data]), texels: None }
            }
            Sky::Image { picture, up, ahead } => {
                let size = [picture.width, picture.height].map(|side| side as u32);
                let [right, up, ahead] = [&ahead.cross(*up), up, ahead].map(vector);
                let sky = plan.upload_once("scene/sky", &[SkyImage { size, right, up, ahead }]);
                let texels = plan.upload_shared("scene/sky-texels", arrays.textures.sky.clone());
                Self { sky, texels: Some(texels) }
            }
        })
    }

    /// For a pass that sees it.
    pub fn give<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let pass = pass.read("scene_sky", self.sky);
        match self.texels {
            Some(texels) => pass.define("SKY", "SKY_IMAGE").read("scene_sky_texels", texels),
            None => pass.define("SKY", "SKY_GRADIENT"),
        }
    }
}

/// Whether the region's receiver fills a camera's picture, so that nothing else is behind: of a camera that hides specular
/// objects, as the one of judged pictures does.
pub fn is_hidden(work: &Work<'_>) -> bool {
    let receiver = &work.scene.objects[work.scene.region.receiver];
    let Shape::Quad { center, u, v } = receiver.shape else { return false };
    if !(work.camera.hides_specular && receiver.visible_to_camera) {
        return false;
    }
    let view = eye::view(work.camera, work.size, work.everything);
    let normal = u.cross(v);
    // A rectangle that holds the ends of four rays holds those of all between them.
    [view.low.x, view.high.x].into_iter().all(|x| {
        [view.low.y, view.high.y].into_iter().all(|y| {
            let across = view.right * x + view.up * y;
            let (o, d) = match view.perspective {
                true => (view.origin, view.forward + across),
                false => (view.origin + across, view.forward),
            };
            let t = (center - o).dot(normal) / d.dot(normal); // not finite along the rectangle
            let at = o + t * d - center;
            // The least that decimal numbers are rounded by; a pixel's samples are further from its rim.
            let within = |edge: DVec3| at.dot(edge).abs() <= edge.length_squared() * (1.0 + 1e-9);
            t >= view.near && t.is_finite() && within(u) && within(v)
        })
    })
}
