//! The views that lights emit from.

use glam::DVec3;

use super::{AREA_SAMPLES, SIDE, VIEW};
use crate::{
    passes::{PlanError, extents},
    scene::{Beam, Face, LightKind, Region, Scene},
    settings::Settings,
    view::{Extent, View},
};

/// A view that a light emits from.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// The light.
    pub light: usize,
    /// Which of the shaders' lights it is, by [`Lamps`](crate::passes::lamps::Lamps): of a light with a size, one of its
    /// points.
    pub lamp: u32,
    /// Where that is, m; parallel light has no place.
    pub position: Option<DVec3>,
    /// Its view.
    pub view: View,
    /// The band it sends, where the scene bends bands apart; else all.
    pub band: Option<usize>,
    /// Photons a side.
    pub side: u32,
    /// W/m² on a plane that faces it, or W/sr: of its brightest band, in its brightest direction.
    pub(super) brightest: f64,
}

impl Emission {
    /// At most what a photon of the view carries, W: the widest texel's footprint in the light's brightest band and
    /// direction.
    pub fn most(&self) -> f64 {
        let window = (self.view.high - self.view.low).abs() / f64::from(self.side);
        self.brightest * window.x * window.y
    }
}

/// Photons a side of each of `count` views that share the photons of one.
fn shared_side(side: u32, count: u32) -> u32 {
    ((f64::from(side) / f64::from(count).sqrt()).round() as u32).max(1)
}

/// Photons a side that there are, the most first: views of one size share a photon buffer.
pub fn sides(emissions: &[Emission]) -> Vec<u32> {
    let mut sides: Vec<u32> = emissions.iter().map(|emission| emission.side).collect();
    sides.sort_unstable_by(|a, b| b.cmp(a));
    sides.dedup();
    sides
}

/// The name of an image of `side` a side: plain of the most photons, else with the side.
pub fn sized(name: &str, sides: &[u32], side: u32) -> String {
    if sides.first() == Some(&side) { name.to_owned() } else { format!("{name}.{side}") }
}

/// The emission views of every light: none where nothing is specular or a light has no power. Where the scene moves, a
/// light that reaches nothing now keeps its views, which then see nothing: it may reach something at another time.
///
/// Of a light with a size so many points emit as `light.area_samples` says, each by views of its own with its share of the
/// light's photons.
pub fn emissions(scene: &Scene, settings: &Settings, receiver: &Region) -> Result<Vec<Emission>, PlanError> {
    let specular = extents::specular(scene);
    if specular.is_empty() {
        return Ok(Vec::new());
    }
    let shared = settings.choice(&VIEW) == "shared";
    let mut content = specular;
    if shared {
        content.join(&extents::of_region(receiver));
    }
    let field = Field { scene, shared, content, everything: extents::everything(scene) };
    let (side, count) = (settings.whole(&SIDE), settings.whole(&AREA_SAMPLES));
    let plain = scene.lights.iter().filter(|light| !light.kind.has_area()).count() as u32;
    let [mut next, mut next_of_area] = [0, plain];
    let mut all = Vec::new();
    for (light, lamp) in scene.lights.iter().enumerate() {
        let (next, side) = match lamp.kind.has_area() {
            true => (&mut next_of_area, shared_side(side, count)),
            false => (&mut next, side),
        };
        for source in lamp.kind.samples(count) {
            let brightest = source.power().into_iter().fold(0.0, f64::max);
            let bands: &[Option<usize>] = if scene.is_dispersive() { &[Some(0), Some(1), Some(2)] } else { &[None] };
            for view in field.views(&source, &lamp.name)? {
                let (lamp, position) = (*next, source.position());
                all.extend(bands.iter().map(|&band| Emission { light, lamp, position, view, band, side, brightest }));
            }
            *next += 1;
        }
    }
    Ok(all)
}

/// What views must hold.
struct Field<'a> {
    scene: &'a Scene,
    shared: bool,
    content: Extent,
    everything: Extent,
}

impl Field<'_> {
    /// The views of a light without size.
    fn views(&self, source: &LightKind, name: &str) -> Result<Vec<View>, PlanError> {
        let Self { scene, shared, content, everything } = self;
        let dark = source.power() == [0.0; 3];
        if dark && !scene.moves() {
            return Ok(Vec::new());
        }
        let views = match source {
            LightKind::Directional { direction, .. } | LightKind::Sun { direction, .. } => {
                vec![View::orthographic(*direction, content, everything)]
            }
            LightKind::Lamp { face: Face { center: position, .. }, .. }
            | LightKind::Patch { position, .. }
            | LightKind::Point { position, .. }
            | LightKind::Spot { position, .. } => match View::perspective(*position, content, everything) {
                Some(view) => vec![view],
                None if *shared => return Err(no_one_frustum(name)),
                None => View::cube(*position, everything).to_vec(),
            },
        };
        let lit = |view: View| {
            let reached = match source {
                _ if dark => None,
                LightKind::Spot { position, beam, .. } if !shared => beam_view(view, *position, beam, content),
                LightKind::Patch { position, normal, .. } => {
                    (content.along(*normal).1 > position.dot(*normal)).then_some(view)
                }
                _ => Some(view),
            };
            reached.or_else(|| scene.moves().then(|| view.of_nothing()))
        };
        Ok(views.into_iter().filter_map(lit).collect())
    }
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
