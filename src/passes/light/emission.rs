//! The views that lights emit from.

use glam::DVec3;

use super::{AREA_SAMPLES, SIDE, TILE, VIEW};
use crate::{
    passes::{PlanError, extents},
    scene::{Beam, Face, LightKind, Region, Scene},
    settings::Settings,
    view::{Extent, View},
};

/// Views that a frame has at most: each is some passes, and a tile of one photon would make millions.
const MOST_VIEWS: u32 = 4096;

/// Tiles' sides are multiples of it, where they may be so large.
const ROUND: u32 = 256;

/// A view that a light emits from, or a tile of one that has more photons than the photon buffer.
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
    /// Photons a side, at most: what does not lie in the view is not emitted.
    pub side: u32,
    /// Photons a side of the whole view.
    pub whole: u32,
    /// The whole view's photon that is the first.
    pub first: [u32; 2],
    /// W/m² on a plane that faces it, or W/sr: of its brightest band, in its brightest direction.
    pub(super) brightest: f64,
}

impl Emission {
    /// At most what a photon of the view carries, W: the widest texel's footprint in the light's brightest band and
    /// direction.
    pub fn most(&self) -> f64 {
        let window = (self.view.high - self.view.low).abs() / f64::from(self.whole);
        self.brightest * window.x * window.y
    }

    /// W/m² on a plane that faces the light, or W/sr: of its brightest band, in its brightest direction.
    pub fn brightest(&self) -> f64 {
        self.brightest
    }

    /// Photons along both sides that lie in the view: a tile may reach beyond it.
    pub fn held(&self) -> [u32; 2] {
        self.first.map(|first| self.side.min(self.whole - first))
    }

    /// Whether it is the first of its view's tiles and bands.
    pub fn begins_view(&self) -> bool {
        self.first == [0, 0] && matches!(self.band, None | Some(0))
    }
}

/// Photons a side of the tiles of a view that has `whole`, and where each begins: as few as hold no more than `most` a
/// side, of even sides; those of many photons have whole texels in every level of a pyramid over them.
fn tiles(whole: u32, most: u32) -> (u32, impl Iterator<Item = [u32; 2]>) {
    let count = whole.div_ceil(most);
    let even = whole.div_ceil(count);
    let side = if count > 1 { even.next_multiple_of(ROUND).min(most) } else { even };
    (side, (0..count * count).map(move |at| [at % count * side, at / count * side]))
}

/// Photons a side of each of `count` views that share the photons of one.
fn shared_side(side: u32, count: u32) -> u32 {
    ((f64::from(side) / f64::from(count).sqrt()).round() as u32).max(1)
}

/// Photons a side that there are, the most first: views of one size share a photon buffer.
pub fn sides(emissions: &[Emission]) -> Vec<u32> {
    distinct(emissions.iter().map(|emission| emission.side))
}

/// Sides, the greatest first, each once.
pub(super) fn distinct(sides: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut sides: Vec<u32> = sides.collect();
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
/// light's photons. A view of more photons than `light.tile` a side is as many as it has tiles, whose bands follow each
/// other.
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
    let (side, count, tile) = (settings.whole(&SIDE), settings.whole(&AREA_SAMPLES), settings.whole(&TILE));
    let plain = scene.lights.iter().filter(|light| !light.kind.has_area()).count() as u32;
    let [mut next, mut next_of_area] = [0, plain];
    let mut all = Vec::new();
    for (light, lamp) in scene.lights.iter().enumerate() {
        let (next, whole) = match lamp.kind.has_area() {
            true => (&mut next_of_area, shared_side(side, count)),
            false => (&mut next, side),
        };
        for source in lamp.kind.samples(count) {
            let brightest = source.power().into_iter().fold(0.0, f64::max);
            let bands: &[Option<usize>] = if scene.is_dispersive() { &[Some(0), Some(1), Some(2)] } else { &[None] };
            for view in field.views(&source, &lamp.name)? {
                let (lamp, position, (side, tiles)) = (*next, source.position(), tiles(whole, tile));
                let of = |first| {
                    bands.iter().map(move |&band| Emission {
                        light,
                        lamp,
                        position,
                        view,
                        band,
                        side,
                        whole,
                        first,
                        brightest,
                    })
                };
                if all.len() as u64 + u64::from(whole.div_ceil(side)).pow(2) > u64::from(MOST_VIEWS) {
                    return Err(too_many(whole, tile));
                }
                all.extend(tiles.flat_map(of));
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

fn too_many(whole: u32, tile: u32) -> PlanError {
    PlanError::Refused {
        what: format!("light.tile={tile} with views of {whole} photons a side"),
        reason: format!("the lights then have more than {MOST_VIEWS} views and tiles"),
        remedy: "raise light.tile, or lower light.side or light.area_samples".into(),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_hold_each_photon_once() {
        for (whole, most) in
            [(1, 1), (64, 64), (64, 16), (65, 16), (67, 16), (97, 96), (5, 2), (8192, 4096), (5000, 4096), (1025, 256)]
        {
            let (side, firsts) = tiles(whole, most);
            let firsts: Vec<_> = firsts.collect();
            assert!(side <= most && firsts.len() as u32 == whole.div_ceil(most).pow(2), "{whole} by {most}: {side}");
            assert!(firsts.iter().flatten().all(|first| *first < whole), "{whole} by {most}: an empty tile");
            let held = |[x, y]: [u32; 2]| u64::from(side.min(whole - x)) * u64::from(side.min(whole - y));
            let held: u64 = firsts.into_iter().map(held).sum();
            assert_eq!(held, u64::from(whole).pow(2), "{whole} by {most}");
        }
    }
}
