//! Lights: their views, and the tracer `bvh` that fills photon columns from each (Wyman 2008, section 2: the photon
//! buffer; exact intersection in place of the image-space estimate).
//!
//! Cost: one dispatch of N² invocations a view, bound by traversal; 32 bytes written a photon for `maps`.

use glam::DVec3;

use super::{PlanError, extents, scene::SceneBuffers};
use crate::{
    gpu::{BufferId, Format, ImageId, Lifetime, PassBuilder, Plan, Resource},
    scene::{Beam, LightKind, PathClass, Region, Scene},
    settings::{Choice, Setting, Settings, Whole},
    view::{Extent, View},
};

/// Photons a side of an emission view.
pub static SIDE: Whole = Whole {
    key: "light.side",
    unit: "texels",
    default: 512,
    range: 1..=16384,
    doc: "photons along each side of a light's emission view (N of N x N)",
};

/// How the emission view is chosen.
pub static VIEW: Choice = Choice {
    key: "light.view",
    default: "fitted",
    words: &["fitted", "shared"],
    doc: "fitted: to the specular objects; shared: one view of objects and receiver for photons and map, as in the papers",
};

/// The tracer.
pub static TRACER: Choice =
    Choice { key: "light.tracer", default: "bvh", words: &["bvh"], doc: "bvh: exact intersection in a compute shader" };

/// The path class.
pub static PATHS: Choice = Choice {
    key: "light.paths",
    default: "scene",
    words: &["scene", "reflect-1", "transmit-1", "transmit-2"],
    doc: "which specular chains make the caustic; scene: as the scene file says",
};

/// Settings of this room.
pub static SETTINGS: &[Setting] =
    &[Setting::Whole(&SIDE), Setting::Choice(&VIEW), Setting::Choice(&TRACER), Setting::Choice(&PATHS)];

/// Invocations along one side of the dispatch's work groups.
const GROUP: u32 = 8;

/// A column of the photon buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Column {
    /// World position on the receiver, and 1 + its object (0: no photon).
    Hit,
    /// RGB flux (W), and the receiver's normal.
    Flux,
    /// World position on the last specular surface, and how the photon ended.
    Exit,
    /// Direction of travel after it, and how the photon ended.
    Direction,
}

impl Column {
    /// The name in plans and shaders.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hit => "hit",
            Self::Flux => "flux",
            Self::Exit => "exit",
            Self::Direction => "direction",
        }
    }

    /// Positions and flux in float32; a direction loses nothing that matters in float16.
    pub fn format(self) -> Format {
        match self {
            Self::Direction => Format::Rgba16f,
            _ => Format::Rgba32f,
        }
    }
}

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

/// The photon buffer of the view at hand: columns by kind.
#[derive(Clone, Debug)]
pub struct Photons {
    /// Texels a side.
    pub side: u32,
    columns: Vec<(Column, ImageId)>,
}

impl Photons {
    /// The columns asked for, as images to fetch from. A column that no method declared is not there.
    pub fn fetch(&self, wanted: &[Column]) -> Vec<(&'static str, Resource)> {
        let named = |c: Column| match c {
            Column::Hit => "photons_hit",
            Column::Flux => "photons_flux",
            Column::Exit => "photons_exit",
            Column::Direction => "photons_direction",
        };
        let wanted = self.columns.iter().filter(|(c, _)| wanted.contains(c));
        wanted.map(|&(c, image)| (named(c), Resource::Image(image))).collect()
    }

    /// Bytes a photon.
    pub fn bytes_each(&self) -> u64 {
        self.columns.iter().map(|(c, _)| c.format().bytes()).sum()
    }
}

/// The path class in force.
pub fn paths(scene: &Scene, settings: &Settings) -> Result<PathClass, PlanError> {
    let class = settings.choice(&PATHS).parse().unwrap_or(scene.paths);
    match class {
        PathClass::All(_) => Err(PlanError::Refused {
            what: format!("path class {class}"),
            reason: "chains of any length are not built yet".into(),
            remedy: "set light.paths to reflect-1, transmit-1 or transmit-2".into(),
        }),
        class => Ok(class),
    }
}

/// The emission views of every light: none where nothing is specular or a light has no power.
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
    for (light, lamp) in scene.lights.iter().enumerate().filter(|(_, lamp)| lamp.kind.power() != [0.0; 3]) {
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
        let lit = |view: View| match lamp.kind {
            LightKind::Spot { position, beam, .. } if !shared => beam_view(view, position, &beam, &content),
            _ => Some(view),
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

/// Adds the photon columns that `columns` names, once for all views.
pub fn photon_buffer(plan: &mut Plan, settings: &Settings, columns: &[Column]) -> Photons {
    let side = settings.whole(&SIDE);
    let image = |plan: &mut Plan, c: Column| {
        plan.image(&format!("light/photons.{}", c.name()), [side, side], c.format(), Lifetime::Frame)
    };
    let mut wanted = columns.to_vec();
    wanted.sort();
    wanted.dedup();
    Photons { side, columns: wanted.into_iter().map(|c| (c, image(plan, c))).collect() }
}

/// Push constants of `glsl/light/sample.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct SamplePush {
    size: [i32; 2],
    light: u32,
    view: u32,
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

/// The tracer over one view, which several passes run.
#[derive(Clone, Copy)]
pub struct Tracing<'a> {
    /// The scene's buffers.
    pub scene: &'a SceneBuffers,
    /// The buffer of all emission views.
    pub views: BufferId,
    /// The path class.
    pub class: PathClass,
    /// The photon buffer.
    pub photons: &'a Photons,
    /// The view.
    pub emission: &'a Emission,
    /// Its place among the views.
    pub index: usize,
}

impl Tracing<'_> {
    /// Work groups along one side.
    pub fn groups(&self) -> u32 {
        self.photons.side.div_ceil(GROUP)
    }

    /// Gives a pass what the tracer reads, and dispatches it over the view.
    pub fn dispatch(&self, pass: PassBuilder<'_>, shader: &str) {
        let (events, reflect) = match self.class {
            PathClass::Reflect1 => (1, 1),
            PathClass::Transmit1 => (1, 0),
            PathClass::Transmit2 | PathClass::All(_) => (2, 0), // `paths` refuses `all`
        };
        let push = SamplePush {
            size: [self.photons.side as i32; 2],
            light: self.emission.light as u32,
            view: self.index as u32,
        };
        let pass = self.scene.lights(self.scene.tracing(pass));
        let pass = self.emission.band.into_iter().fold(pass, |pass, band| pass.define("BAND", band));
        pass.read("light_views", self.views).define("EVENTS", events).define("REFLECT", reflect).push(&push).dispatch(
            shader,
            [self.groups(), self.groups(), 1],
            GROUP * GROUP,
        );
    }
}

/// Photons of one view into their columns: `light/photons`.
pub fn photons(plan: &mut Plan, name: &str, tracing: &Tracing<'_>) {
    let mut pass = plan.pass(name);
    for &(column, image) in &tracing.photons.columns {
        let binding = format!("photons_{}", column.name());
        let define = format!("COLUMN_{}", column.name().to_uppercase());
        pass = pass.store(&binding, image).define(&define, column.format().glsl());
    }
    tracing.dispatch(pass, "light/photons.comp");
}
