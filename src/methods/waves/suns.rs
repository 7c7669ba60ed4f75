//! What shines on the water, as the sun map has it.

use glam::DVec3;

use super::{ABSORBED, SUN_DISTANCE, SUN_EDGE, SUN_WIDTH};
use crate::{
    passes::water::{self, Water},
    scene::{LightKind, MaterialKind, Scene},
    settings::Settings,
};

/// Of the sun seen from the Earth, degrees: where the scene's has no width.
const TRUE_WIDTH: f64 = 0.53;
/// The sun may stand this far from straight above before it is said: its own width.
const ASIDE: f64 = TRUE_WIDTH;

/// Why a scene shows nothing.
pub const NO_WATER: &str = "there is no water: no dielectric quad, sine, wave, sea or heights";
const NO_SUN: &str = "there is no sun with any power: waves know directional lights alone";

/// `Waves` of `glsl/waves/sun.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct WavesData {
    irradiance: [f32; 3],
    attenuation: [f32; 3],
    inner: f32,
    outer: f32,
    distance: f32,
}

/// Lights that count: direction, irradiance (W/m²) and width (degrees).
fn suns(scene: &Scene) -> impl Iterator<Item = (DVec3, [f64; 3], f64)> {
    let sun = |kind: &LightKind| match kind {
        LightKind::Directional { direction, irradiance } => Some((*direction, *irradiance, TRUE_WIDTH)),
        LightKind::Sun { direction, irradiance, radius } => Some((*direction, *irradiance, 2.0 * radius.to_degrees())),
        _ => None,
    };
    scene.lights.iter().filter_map(move |light| sun(&light.kind)).filter(|(_, power, _)| *power != [0.0; 3])
}

/// Why there is nothing to look up; of a scene that moves, lights may have power later.
pub fn nothing(scene: &Scene) -> Option<&'static str> {
    (suns(scene).next().is_none() && !scene.moves()).then_some(NO_SUN)
}

/// What the water takes of light on its way, 1/m: of every band alike where it is set, else as the scene has it.
pub fn attenuation(scene: &Scene, water: &Water, settings: &Settings) -> DVec3 {
    let absorption = match scene.materials[scene.objects[water.object].material].kind {
        MaterialKind::Dielectric { absorption, .. } => DVec3::from(absorption),
        _ => DVec3::ZERO,
    };
    settings.real(&ABSORBED).map_or(absorption, |share| DVec3::splat(-(-share).ln_1p()))
}

/// The sun map of a scene: all suns in one, as wide as the widest where nothing is set.
pub fn data(scene: &Scene, water: &Water, settings: &Settings) -> WavesData {
    let irradiance: DVec3 = suns(scene).map(|(_, power, _)| DVec3::from(power)).sum();
    let own = suns(scene).map(|(.., width)| width).reduce(f64::max).unwrap_or(TRUE_WIDTH);
    let width = settings.real(&SUN_WIDTH).filter(|set| *set > 0.0).unwrap_or(own);
    let edge = settings.real(&SUN_EDGE).unwrap_or_default();
    let half = 0.5 * width.to_radians();
    WavesData {
        irradiance: irradiance.as_vec3().to_array(),
        attenuation: attenuation(scene, water, settings).as_vec3().to_array(),
        inner: (half * (1.0 - edge)) as f32,
        outer: (half * (1.0 + edge)) as f32,
        distance: settings.real(&SUN_DISTANCE).unwrap_or_default() as f32,
    }
}

/// What a reader of the picture must know.
pub fn warnings(scene: &Scene) -> Vec<String> {
    let mut all = Vec::new();
    let Some(first) = water::waters(scene).next() else { return vec![format!("waves show nothing: {NO_WATER}")] };
    if suns(scene).next().is_none() {
        return vec![format!("waves show nothing: {NO_SUN}")];
    }
    all.push(
        "waves: irradiance.caustic is right only up to a scale, and its light comes from straight above alone: nephroid \
         compare finds the scale"
            .to_owned(),
    );
    let others = water::waters(scene).count() - 1;
    if others > 0 {
        let name = &scene.objects[first].name;
        all.push(format!(
            "waves know one water, '{name}', and not the {others} others; put each into a scene of its own"
        ));
    }
    let up = water::normal(&scene.objects[first].shape);
    let away = |(direction, ..): (DVec3, [f64; 3], f64)| (-direction).angle_between(up).to_degrees();
    let farthest = suns(scene).map(away).fold(0.0, f64::max);
    if farthest > ASIDE {
        all.push(format!(
            "waves take the sun to stand straight above the water, as the paper does; here it is {farthest:.1} degrees aside"
        ));
    }
    let unknown = scene.lights.len() - suns(scene).count();
    if unknown > 0 {
        all.push(format!("waves know directional lights alone: {unknown} others make no caustic"));
    }
    all
}
