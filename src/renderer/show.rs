//! What a window shows: a layer of the last frame, from where it lies on the device.

use super::{RenderError, Renderer};
use crate::{
    gpu::{ImageId, Look, Screen},
    names::NoSuch,
    passes::eye::EyeLayers,
};

/// Names of the picture's layers, in the order of [`Renderer::layers`]; `sky` where the scene has one.
pub const LAYERS: [&str; 7] =
    ["radiance", "direct", "caustic", "irradiance.direct", "irradiance.caustic", "mask", "sky"];

impl Renderer {
    /// Shows a layer of the last frame, or black where the frame has none; ms on the device. `None` if the screen must
    /// be fitted to its window first.
    pub fn show(&self, screen: &mut Screen, layer: &str, ev: f64) -> Result<Option<f64>, RenderError> {
        let (image, alpha) = self.layer(layer)?;
        Ok(screen.show(&self.program, image, Look { ev, alpha })?)
    }

    /// As [`Self::show`], and reads back what the window then shows: sRGB, rows from the top.
    pub fn screenshot(&self, screen: &mut Screen, layer: &str, ev: f64) -> Result<Option<Vec<[u8; 3]>>, RenderError> {
        let (image, alpha) = self.layer(layer)?;
        Ok(screen.read(&self.program, image, Look { ev, alpha })?)
    }

    /// The image that holds a layer, and whether it is its fourth channel.
    fn layer(&self, name: &str) -> Result<(Option<ImageId>, bool), RenderError> {
        let EyeLayers { irradiance_direct, direct, irradiance_caustic, caustic, sky, radiance } = self.planned.layers;
        Ok(match name {
            "radiance" => (Some(radiance), false),
            "direct" => (Some(direct), false),
            "caustic" => (caustic, false),
            "irradiance.direct" => (Some(irradiance_direct), false),
            "irradiance.caustic" => (irradiance_caustic, false),
            "sky" => (sky, false),
            "mask" => (Some(irradiance_direct), true),
            _ => return Err(NoSuch::new("layer", name, LAYERS).into()),
        })
    }
}
