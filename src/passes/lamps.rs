//! What the shaders know as lights, none with a size: first the scene's own that have none; then, of each that has one, the
//! points that photons come from; then those that light what the eye sees.

use super::{
    PlanError,
    accel::{self, SceneArrays},
};
use crate::scene::Scene;

/// Where which of them are.
#[derive(Clone, Debug)]
pub struct Lamps {
    /// All of them; one that means nothing where there is none.
    pub all: Vec<accel::Light>,
    /// How many are the scene's own.
    pub plain: usize,
    /// Place of the first point that lights what the eye sees.
    pub seen_first: usize,
    /// How many of them an eye sample asks.
    pub seen: usize,
}

impl Lamps {
    /// `emitting` points of each light with a size send photons; an eye sample asks `seen` of each, and `eye_samples` of a
    /// pixel other ones each, so that it asks points of the whole light.
    pub fn of(
        scene: &Scene,
        arrays: &SceneArrays,
        emitting: u32,
        [seen, eye_samples]: [u32; 2],
    ) -> Result<Self, PlanError> {
        let areas: Vec<_> = scene.lights.iter().filter(|light| light.kind.has_area()).collect();
        let plain = scene.lights.len() - areas.len();
        let mut all: Vec<accel::Light> = arrays.lights[..plain].to_vec();
        let order = mixed(eye_samples);
        for light in &areas {
            for sample in light.kind.samples(emitting) {
                all.push(accel::light(scene, &light.name, &sample)?);
            }
        }
        for light in &areas {
            let samples = light.kind.samples(seen * eye_samples);
            for at in (0..seen).flat_map(|k| order.iter().map(move |at| k * eye_samples + at)) {
                all.push(accel::light(scene, &light.name, &samples[at as usize])?);
            }
        }
        let seen_first = plain + areas.len() * emitting as usize;
        if all.is_empty() {
            all.push(accel::Light::default()); // no Vulkan buffer may be empty
        }
        Ok(Self { all, plain, seen_first, seen: areas.len() * seen as usize })
    }
}

/// The numbers below `count`, neighbours far apart by the golden section: where in its pixel an eye sample is must not go
/// with which side of the light it asks, or half-shadows would be moved by part of a pixel.
fn mixed(count: u32) -> Vec<u32> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let mut order: Vec<u32> = (0..count).collect();
    order.sort_by(|a, b| (f64::from(*a) * GOLDEN).fract().total_cmp(&(f64::from(*b) * GOLDEN).fract()));
    order
}
