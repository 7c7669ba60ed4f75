//! The eye: G-buffer, direct light with shadows, the surface slot, the sky, pixels that look through glass, compose.
//!
//! Cost: the G-buffer is bound by its k² samples a pixel (16 bytes each); direct light by one shadow ray a sample and
//! light; traced pixels by their Fresnel trees; the sky by its look-ups, where nothing else is seen.

use glam::{DVec2, DVec3};

use super::{
    Work,
    lamps::Lamps,
    scene::{SceneBuffers, visible_draws},
    sky::{self, SkyBuffers},
};
use crate::{
    gpu::{Blend, BufferId, Format, ImageId, Lifetime, PassBuilder, Plan, Resource, Topology},
    scene::{Camera, CameraKind},
    settings::{Real, Setting, Settings, Whole},
    view::{Extent, View, ViewData},
};

/// Samples a pixel along each axis, as it is set; [`samples`] says what is in force.
pub static SAMPLES: Whole = Whole {
    key: "eye.samples",
    unit: "samples",
    default: 0,
    range: 0..=16,
    doc: "k for k x k eye samples a pixel, box-filtered; 0: 1, and through `region` as many as make 1024 across, at most 8, where the \
          method does not filter pixels itself",
};

/// The camera whose pictures are judged: the truth is box-filtered, and so are they unless told otherwise.
const JUDGED: &str = "region";
/// Samples across a judged picture's larger side, at least, up to [`MOST`] a pixel.
const ACROSS: u32 = 1024;
/// The most samples along an axis that are taken unasked.
const MOST: u32 = 8;

/// Samples a pixel along each axis: as set, else as the camera needs. One at the middle of each pixel would give a
/// picture a floor of error that is no fault of the method's.
pub fn samples(settings: &Settings, camera: &str, [width, height]: [u32; 2]) -> u32 {
    match settings.whole(&SAMPLES) {
        0 if camera == JUDGED => ACROSS.div_ceil(width.max(height).max(1)).clamp(1, MOST),
        0 => 1,
        set => set,
    }
}

/// Depth of the Fresnel tree.
pub static DEPTH: Whole = Whole {
    key: "eye.depth",
    unit: "events",
    default: 6,
    range: 1..=16,
    doc: "specular events of a path from the eye, in pixels that look at glass or mirrors; branches below 1e-4 of it are left",
};

/// Points of a light with a size, as they are set; [`light_samples`] says how many are in force.
pub static LIGHT_SAMPLES: Whole = Whole {
    key: "eye.light_samples",
    unit: "points",
    default: 0,
    range: 0..=256,
    doc: "of each light with a size, points that an eye sample asks for direct light; 0: as many as make 64 a pixel",
};

/// Points of a light that a pixel asks, unless told otherwise.
const POINTS: u32 = 64;

/// Points of each light with a size that one of `eye_samples` samples of a pixel asks.
pub fn light_samples(settings: &Settings, eye_samples: u32) -> u32 {
    match settings.whole(&LIGHT_SAMPLES) {
        0 => POINTS.div_ceil(eye_samples.max(1)),
        set => set,
    }
}

/// Exposure of the PNG.
pub static EXPOSURE: Real = Real {
    key: "eye.exposure",
    unit: "EV",
    default: None,
    range: -30.0..=30.0,
    doc: "exposure of image.png: radiance times 2^EV; image.exr is not touched",
};

/// Settings of this room.
pub static SETTINGS: &[Setting] =
    &[Setting::Whole(&SAMPLES), Setting::Whole(&LIGHT_SAMPLES), Setting::Whole(&DEPTH), Setting::Real(&EXPOSURE)];

/// Near plane of a pinhole, relative to the far one. Depth is linear, so this costs no precision.
const NEAR: f64 = 1e-6;

/// What changes every frame (`FrameData` of `glsl/shared/frame.glsl`).
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // the members are those of the shader
pub struct FrameData {
    pub eye: ViewData,
    pub time: f32,
    pub index: u32,
    pub seed: u32,
    pub eye_media: u32,
}

/// The view of a camera for a picture of `size` pixels.
pub fn view(camera: &Camera, size: [u32; 2], everything: &Extent) -> View {
    let forward = (camera.target - camera.position).normalize_or(DVec3::NEG_Z);
    let right = forward.cross(camera.up).try_normalize().unwrap_or_else(|| crate::view::basis(forward).0);
    let up = right.cross(forward);
    let aspect = f64::from(size[0]) / f64::from(size[1].max(1));
    let (high, perspective) = match camera.kind {
        CameraKind::Pinhole { fov_y } => {
            let half = (0.5 * fov_y.to_radians()).tan();
            (DVec2::new(half * aspect, half), true)
        }
        CameraKind::Orthographic { height, width } => {
            (0.5 * DVec2::new(width.unwrap_or(height * aspect), height), false)
        }
    };
    let (_, far) = everything.along(forward);
    // With all behind the eye, the scene's own size: no length that does not grow with the scene.
    let least = everything.bounds().1.max(f64::MIN_POSITIVE);
    let far = (far - camera.position.dot(forward)).max(least) * (1.0 + NEAR);
    let near = if perspective { NEAR * far } else { 0.0 };
    View { origin: camera.position, right, up, forward, low: -high, high, near, far, perspective }
}

/// Push constants of `glsl/eye/gbuffer.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct EyePush {
    size: [i32; 2],
    samples: i32,
}

/// A provider of the slot `surface`: a GLSL function of point, normal, receiver and (u, v), and what it reads.
#[derive(Clone, Debug)]
pub struct SurfaceProvider {
    /// The file that defines `surface_irradiance`.
    pub file: &'static str,
    /// What it is told by the preprocessor.
    pub defines: Vec<(&'static str, String)>,
    /// What it reads.
    pub reads: Vec<(&'static str, Resource)>,
    /// What it may read.
    pub offers: Vec<(&'static str, BufferId)>,
}

impl SurfaceProvider {
    fn give<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let pass = pass.with(self.reads.iter().copied()).provide("provider.glsl", self.file).defines(&self.defines);
        self.offers.iter().fold(pass, |pass, (name, buffer)| pass.offer(name, *buffer))
    }
}

/// The layers that the eye makes.
#[derive(Clone, Copy, Debug)]
pub struct EyeLayers {
    /// Irradiance of direct light, W/m²; alpha is the mask.
    pub irradiance_direct: ImageId,
    /// Radiance by direct light, W/m²/sr.
    pub direct: ImageId,
    /// Irradiance of the caustic, W/m², where a provider fills the slot.
    pub irradiance_caustic: Option<ImageId>,
    /// Radiance by the caustic, W/m²/sr.
    pub caustic: Option<ImageId>,
    /// Radiance of the sky, W/m²/sr, where the scene has one that may be seen.
    pub sky: Option<ImageId>,
    /// Their sum.
    pub radiance: ImageId,
}

/// What the eye passes share.
struct Eye<'a> {
    plan: &'a mut Plan,
    buffers: &'a SceneBuffers,
    lamps: &'a Lamps,
    frame: BufferId,
    gbuffer: ImageId,
    push: EyePush,
    size: [u32; 2],
}

/// Adds the eye's passes.
pub fn passes(work: &mut Work<'_>, lamps: &Lamps, surface: Option<&SurfaceProvider>) -> EyeLayers {
    let gbuffer = gbuffer(work);
    let hidden = work.scene.sky.is_some() && sky::is_hidden(work);
    let sky = if hidden { None } else { SkyBuffers::upload(work.plan, work.scene, work.arrays) };
    let push = EyePush { size: work.size.map(|s| s as i32), samples: work.samples as i32 };
    let (buffers, frame, size) = (work.buffers, work.frame, work.size);
    let mut eye = Eye { plan: &mut *work.plan, buffers, lamps, frame, gbuffer, push, size };
    let (irradiance_direct, direct) = eye.direct();
    let (irradiance_caustic, caustic) = match surface {
        Some(provider) => {
            let (e, l) = eye.surface(provider);
            (Some(e), Some(l))
        }
        None => (None, None),
    };
    let draws = visible_draws(work.scene, work.camera, work.arrays);
    let sees_specular = draws.iter().any(|d| {
        let object = work.arrays.instances[d.first_instance as usize].object as usize;
        work.scene.materials[work.scene.objects[object].material].is_specular()
    });
    let sky = sky.map(|buffers| (buffers, eye.sky(&buffers)));
    if hidden {
        eye.plan.leave_out("eye/sky", "the receiver fills the picture");
    }
    if sees_specular {
        eye.trace(work.settings.whole(&DEPTH), direct, caustic, surface, sky);
    } else if !work.scene.has_specular() {
        eye.plan.leave_out("eye/trace", "nothing in the scene is specular");
    } else {
        eye.plan.leave_out("eye/trace", "the camera sees no specular object");
    }
    let radiance = eye.target("eye/radiance");
    let compose = eye.plan.pass("eye/compose").fetch("layer_direct", direct);
    let compose = match caustic {
        Some(caustic) => compose.fetch("layer_caustic", caustic).define("CAUSTIC", 1),
        None => compose,
    };
    let sky = sky.map(|(_, layer)| layer);
    let compose = match sky {
        Some(sky) => compose.fetch("layer_sky", sky).define("SKY", 1),
        None => compose,
    };
    compose.target(radiance, 0, Some([0.0; 4]), Blend::Replace).screen("passes/compose.frag");
    EyeLayers { irradiance_direct, direct, irradiance_caustic, caustic, sky, radiance }
}

/// Push constants of `glsl/eye/gbuffer.frag`.
fn gbuffer(work: &mut Work<'_>) -> ImageId {
    let extent = work.size.map(|s| s.saturating_mul(work.samples));
    let seen = work.plan.image("eye/gbuffer", extent, Format::Rgba32u, Lifetime::Frame);
    let depth = work.plan.image("eye/depth", extent, Format::Depth32f, Lifetime::Frame);
    let draws = visible_draws(work.scene, work.camera, work.arrays);
    let pass = work.plan.pass("eye/gbuffer").provide("raster_view.glsl", "eye/raster_view.glsl");
    let mut pass = work.buffers.vertices(pass).read("frame", work.frame);
    if work.buffers.is_cast() {
        pass = pass.push(&extent.map(|s| s as i32)); // rays go through the pixels
    }
    pass.target(seen, 0, Some([0.0; 4]), Blend::Replace).depth(depth, true).draw(
        &["eye/gbuffer.vert", "eye/gbuffer.frag"],
        Topology::Triangles,
        draws,
    );
    seen
}

/// For a pass that lights what it sees.
fn lit<'p>(buffers: &SceneBuffers, lamps: &Lamps, pass: PassBuilder<'p>) -> PassBuilder<'p> {
    let pass = if lamps.plain + lamps.seen == 0 { pass } else { buffers.lights(pass) };
    let pass = pass.define("LIGHT_COUNT", lamps.plain);
    if lamps.seen == 0 {
        return pass;
    }
    pass.define("AREA_FIRST", lamps.seen_first).define("AREA_SAMPLES", lamps.seen)
}

impl Eye<'_> {
    fn target(&mut self, name: &str) -> ImageId {
        self.plan.image(name, self.size, Format::Rgba32f, Lifetime::Frame)
    }

    fn direct(&mut self) -> (ImageId, ImageId) {
        let (irradiance, radiance) = (self.target("eye/irradiance.direct"), self.target("eye/direct"));
        let pass = self.buffers.colours(self.plan.pass("eye/direct"));
        let dark = self.lamps.plain + self.lamps.seen == 0;
        let pass = if dark { self.buffers.surfaces(pass) } else { self.buffers.tracing(pass) };
        lit(self.buffers, self.lamps, pass)
            .read("frame", self.frame)
            .fetch("eye_gbuffer", self.gbuffer)
            .push(&self.push)
            .target(irradiance, 0, Some([0.0; 4]), Blend::Replace)
            .target(radiance, 0, Some([0.0; 4]), Blend::Replace)
            .screen("eye/direct.frag");
        (irradiance, radiance)
    }

    fn surface(&mut self, provider: &SurfaceProvider) -> (ImageId, ImageId) {
        let (irradiance, radiance) = (self.target("eye/irradiance.caustic"), self.target("eye/caustic"));
        provider
            .give(self.buffers.tracing(self.buffers.colours(self.plan.pass("eye/surface"))))
            .read("frame", self.frame)
            .fetch("eye_gbuffer", self.gbuffer)
            .push(&self.push)
            .target(irradiance, 0, Some([0.0; 4]), Blend::Replace)
            .target(radiance, 0, Some([0.0; 4]), Blend::Replace)
            .screen("eye/surface.frag");
        (irradiance, radiance)
    }

    fn sky(&mut self, sky: &SkyBuffers) -> ImageId {
        let layer = self.target("eye/sky");
        sky.give(self.buffers.surfaces(self.plan.pass("eye/sky")))
            .read("frame", self.frame)
            .fetch("eye_gbuffer", self.gbuffer)
            .push(&self.push)
            .target(layer, 0, Some([0.0; 4]), Blend::Replace)
            .screen("eye/sky.frag");
        layer
    }

    fn trace(
        &mut self,
        depth: u32,
        direct: ImageId,
        caustic: Option<ImageId>,
        surface: Option<&SurfaceProvider>,
        sky: Option<(SkyBuffers, ImageId)>,
    ) {
        let (buffers, lamps) = (self.buffers, self.lamps);
        let pass = buffers.tracing(buffers.colours(self.plan.pass("eye/trace")));
        let pass = lit(buffers, lamps, pass);
        let pass = match surface {
            Some(provider) => provider.give(pass),
            None => pass.provide("provider.glsl", "eye/no_surface.glsl"),
        };
        let mut pass = pass
            .read("frame", self.frame)
            .fetch("eye_gbuffer", self.gbuffer)
            .define("DEPTH", depth)
            .push(&self.push)
            .target(direct, 0, None, Blend::Add);
        if let Some(caustic) = caustic {
            pass = pass.define("CAUSTIC", 1).target(caustic, 0, None, Blend::Add);
        }
        if let Some((buffers, layer)) = sky {
            let location = 1 + u32::from(caustic.is_some());
            pass = buffers.give(pass).define("SKY_LOCATION", location).target(layer, 0, None, Blend::Add);
        }
        pass.screen("eye/trace.frag");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn judged_pictures_have_about_as_many_samples_across_unless_told() {
        let of = |camera: &str, size: [u32; 2]| samples(&Settings::default(), camera, size);
        let sides = [1, 64, 128, 129, 256, 500, 512, 1023, 1024, 4096];
        assert_eq!(sides.map(|side| of("region", [1, side])), [8, 8, 8, 8, 4, 3, 2, 2, 1, 1]);
        assert_eq!(of("region", [512, 1]), 2);
        assert_eq!(sides.map(|side| of("main", [side, side])), [1; 10]);
        let mut set = Settings::default();
        set.set(SETTINGS, "eye.samples", "3").unwrap();
        assert_eq!(["region", "main"].map(|camera| samples(&set, camera, [64, 64])), [3, 3]);
    }
}
