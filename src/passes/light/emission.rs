//! The views that lights emit from.

use glam::DVec3;

use super::VIEW;
use crate::{
    passes::{PlanError, extents},
    scene::{Beam, LightKind, Region, Scene},
    settings::Settings,
    view::{Extent, View},
};

/// A view that a light emits from.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// The light.
    pub light: usize,
    /// Its view.
    pub view: View,
    /// The band it sends, where the scene bends bands apart; else all.
    pub band: Option<usize>,
}

impl Emission {
    /// At most what a photon of the view carries, W, of `side` a side: the widest texel's footprint in the light's
    /// brightest band and direction.
    pub fn most(&self, scene: &Scene, side: u32) -> f64 {
        let power = match scene.lights[self.light].kind {
            LightKind::Directional { irradiance, .. } => irradiance,
            LightKind::Point { intensity, .. } | LightKind::Spot { intensity, .. } => intensity,
        };
        let window = (self.view.high - self.view.low).abs() / f64::from(side);
        power.into_iter().fold(0.0, f64::max) * window.x * window.y
    }
}

/// The emission views of every light: none where nothing is specular or a light has no power. Where the scene moves, a
/// light that reaches nothing now keeps its views, which then see nothing: it may reach something at another time.
pub fn emissions(scene: &Scene, settings: &Settings, receiver: &Region) -> Result<Vec<Emission>, PlanError> {
    let specular = extents::specular(scene);
    if specular.is_empty() {
        return Ok(Vec::new());
    }
    let shared = settings.choice(&VIEW) == "shared";
    let everything = extents::everything(scene);
    let mut content = specular;
    if shared {
        content.join(&extents::of_region(receiver));
    }
    let mut all = Vec::new();
    for (light, lamp) in scene.lights.iter().enumerate() {
        let dark = lamp.kind.power() == [0.0; 3];
        if dark && !scene.moves() {
            continue;
        }
        let views = match lamp.kind {
            LightKind::Directional { direction, .. } => vec![View::orthographic(direction, &content, &everything)],
            LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
                match View::perspective(position, &content, &everything) {
                    Some(view) => vec![view],
                    None if shared => return Err(no_one_frustum(&lamp.name)),
                    None => View::cube(position, &everything).to_vec(),
                }
            }
        };
        let lit = |view: View| {
            let reached = match lamp.kind {
                _ if dark => None,
                LightKind::Spot { position, beam, .. } if !shared => beam_view(view, position, &beam, &content),
                _ => Some(view),
            };
            reached.or_else(|| scene.moves().then(|| view.of_nothing()))
        };
        let bands: &[Option<usize>] = if scene.is_dispersive() { &[Some(0), Some(1), Some(2)] } else { &[None] };
        let each = |view: View| bands.iter().map(move |&band| Emission { light, view, band });
        all.extend(views.into_iter().filter_map(lit).flat_map(each));
    }
    Ok(all)
}

fn no_one_frustum(light: &str) -> PlanError {
    PlanError::Refused {
        what: format!("light.view=shared with the light '{light}'"),
        reason: "no one frustum holds the objects and the receiver from there".into(),
        remedy: "use light.view=fitted, or move the light away from them".into(),
    }
}

/// What a beam lights of a view on to the content: a narrower window, or nothing.
fn beam_view(view: View, position: DVec3, beam: &Beam, content: &Extent) -> Option<View> {
    // A half angle beyond every direction's, or of 90° and more, bounds no window.
    let (half, (centre, radius)) = (2.0 * (0.5 * beam.outer).min(1.0).sqrt().asin(), content.bounds());
    let (way, distance) = (centre - position, (centre - position).length());
    let seen = if distance > radius { (radius / distance).asin() } else { std::f64::consts::PI };
    let aside = way.cross(beam.axis).length().atan2(way.dot(beam.axis));
    if aside > half + seen {
        return None;
    }
    if half >= std::f64::consts::FRAC_PI_2 { Some(view) } else { view.within_cone(beam.axis, half) }
}

/// The name of a pass of view `index`: plain where there is one view only, else with the light, the number of its view
/// where it has several, and the band where they are apart.
pub fn view_name(base: &str, scene: &Scene, all: &[Emission], index: usize) -> String {
    const BANDS: [&str; 3] = ["red", "green", "blue"];
    let Some(one) = all.get(index).filter(|_| all.len() > 1) else { return base.to_owned() };
    let alike = |all: &[Emission]| all.iter().filter(|e| e.light == one.light && e.band == one.band).count();
    let number = if alike(all) > 1 { format!(".{}", alike(&all[..index])) } else { String::new() };
    let band = one.band.map_or(String::new(), |band| format!(".{}", BANDS[band]));
    format!("{base}:{}{number}{band}", scene.lights[one.light].name)
}
