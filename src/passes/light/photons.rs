//! The photon buffer, and the dispatch that fills it from one view.

use super::{Bench, Blocks, Emission, LAYERS, Tracer, emission::sized};
use crate::{
    gpu::{BufferId, Format, ImageId, Lifetime, PassBuilder, Plan, Resource},
    passes::scene::SceneBuffers,
    scene::PathClass,
    settings::Settings,
};

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
    /// A number that photons of one way share: the same objects met in one order, the same receiver (0: no photon).
    Way,
}

impl Column {
    /// The name in plans and shaders.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hit => "hit",
            Self::Flux => "flux",
            Self::Exit => "exit",
            Self::Direction => "direction",
            Self::Way => "way",
        }
    }

    /// Positions and flux in float32, unless all are asked for in float16; a direction loses nothing that matters there.
    pub fn format(self, half: bool) -> Format {
        match self {
            Self::Way => Format::R32f,
            _ if half => Format::Rgba16f,
            Self::Direction => Format::Rgba16f,
            _ => Format::Rgba32f,
        }
    }
}

/// The photon buffer of the view at hand: columns by kind.
#[derive(Clone, Debug)]
pub struct Photons {
    /// Texels a side.
    pub side: u32,
    /// Layers, where each sample can leave several photons: shaders then see arrays, and LAYERS.
    pub(super) layers: Option<u32>,
    /// Where columns are float16: units a watt of the flux, a power of two.
    half: Option<f64>,
    columns: Vec<(Column, ImageId)>,
}

impl Photons {
    /// Of `side` samples a side, in float32, with as many layers as the photon buffer has.
    pub(super) fn beside(plan: &mut Plan, bench: &Bench<'_>, name: &str, side: u32, columns: &[Column]) -> Self {
        let layers = layers(bench.settings, bench.class);
        Self { side, layers, half: None, columns: Vec::new() }.with_columns(plan, name, columns)
    }

    fn with_columns(mut self, plan: &mut Plan, name: &str, columns: &[Column]) -> Self {
        let mut wanted = columns.to_vec();
        wanted.sort();
        wanted.dedup();
        for c in wanted {
            let (name, extent, format) =
                (format!("{name}.{}", c.name()), [self.side; 2], c.format(self.half.is_some()));
            let image = match self.layers {
                Some(layers) => plan.image_array(&name, extent, layers, format, Lifetime::Frame),
                None => plan.image(&name, extent, format, Lifetime::Frame),
            };
            self.columns.push((c, image));
        }
        self
    }

    /// The columns asked for, as images to fetch from. A column that no method declared is not there.
    pub fn fetch(&self, wanted: &[Column]) -> Vec<(&'static str, Resource)> {
        let named = |c: Column| match c {
            Column::Hit => "photons_hit",
            Column::Flux => "photons_flux",
            Column::Exit => "photons_exit",
            Column::Direction => "photons_direction",
            Column::Way => "photons_way",
        };
        let wanted = self.columns.iter().filter(|(c, _)| wanted.contains(c));
        wanted.map(|&(c, image)| (named(c), Resource::Image(image))).collect()
    }

    /// Photons that a sample can leave.
    pub fn layers(&self) -> u32 {
        self.layers.unwrap_or(1)
    }

    /// The image of a column, which some method declared.
    pub fn column(&self, wanted: Column) -> Option<ImageId> {
        self.columns.iter().find(|(c, _)| *c == wanted).map(|(_, image)| *image)
    }

    /// Tells a shader of the layers, and of float16.
    pub fn define<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let pass = self.half.into_iter().fold(pass, |pass, units| pass.define("HALF", format!("{units:e}")));
        self.layers.into_iter().fold(pass, |pass, layers| pass.define("LAYERS", layers))
    }

    /// Bytes a photon.
    pub fn bytes_each(&self) -> u64 {
        self.columns.iter().map(|(c, _)| c.format(self.half.is_some()).bytes()).sum()
    }
}

/// Layers of photon buffers, where a sample can leave several photons.
fn layers(settings: &Settings, class: PathClass) -> Option<u32> {
    matches!(class, PathClass::All(_)).then(|| settings.whole(&LAYERS))
}

/// Adds the photon columns that `columns` names, once for all views of each of the `sides`; with layers where the class has
/// several paths.
///
/// `half`: all of them in float16, and the most flux of a photon (W). Positions are then rounded as float16 rounds; flux
/// is scaled by a power of two, or a photon's microwatts would be lost below what float16 holds.
pub fn photon_buffer(
    plan: &mut Plan,
    settings: &Settings,
    class: PathClass,
    columns: &[Column],
    half: Option<f64>,
    sides: &[u32],
) -> Vec<Photons> {
    /// Below 65504 by enough that nothing overflows; 2⁻¹⁴ is the least that keeps all bits.
    const BRIGHTEST: f64 = 14.0;
    let half = half.map(|most| if most > 0.0 { (BRIGHTEST - most.log2().ceil()).exp2() } else { 1.0 });
    let layers = layers(settings, class);
    let each = |&side: &u32| {
        let photons = Photons { side, layers, half, columns: Vec::new() };
        photons.with_columns(plan, &sized("light/photons", sides, side), columns)
    };
    sides.iter().map(each).collect()
}

/// Push constants of `glsl/light/sample.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct SamplePush {
    /// Samples of the photon image that lie in the view.
    pub size: [i32; 2],
    /// The light.
    pub light: u32,
    /// The view's place among the views.
    pub view: u32,
    /// The whole view's sample that is the image's first.
    pub first: [i32; 2],
    /// Samples a side of the whole view.
    pub whole: i32,
}

impl SamplePush {
    /// Of the view in that place.
    pub fn of(emission: &Emission, index: usize) -> Self {
        let whole = |pair: [u32; 2]| pair.map(|n| n as i32);
        Self {
            size: whole(emission.held()),
            light: emission.lamp,
            view: index as u32,
            first: whole(emission.first),
            whole: emission.whole as i32,
        }
    }
}

/// The tracer over one view, which several passes run.
#[derive(Clone, Copy)]
pub struct Tracing<'a> {
    /// The scene's buffers.
    pub scene: &'a SceneBuffers,
    /// The buffer of all emission views.
    pub views: BufferId,
    /// The tracer.
    pub tracer: &'a Tracer,
    /// The path class.
    pub class: PathClass,
    /// The photon buffer.
    pub photons: &'a Photons,
    /// The view.
    pub emission: &'a Emission,
    /// Its place among the views.
    pub index: usize,
    /// Where photons are not one a slot of the photon buffer.
    pub blocks: Option<&'a Blocks>,
}

impl Tracing<'_> {
    /// Work groups along one side.
    pub fn groups(&self) -> u32 {
        self.photons.side.div_ceil(GROUP)
    }

    /// Push constants of a dispatch over the view.
    pub fn push(&self) -> SamplePush {
        SamplePush::of(self.emission, self.index)
    }

    /// Gives a pass all that tracing from the view reads but push constants.
    pub fn give<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let (events, reflect) = match self.class {
            PathClass::Reflect1 => (1, 1),
            PathClass::Transmit1 => (1, 0),
            PathClass::Transmit2 => (2, 0),
            PathClass::All(most) => (most, 0), // of a tree only their number matters
        };
        let lights = self.scene.lights(self.scene.tracing(pass));
        let pass = self.photons.define(self.tracer.give(lights, self.emission, self.index));
        let pass = self.blocks.into_iter().fold(pass, |pass, blocks| blocks.define(pass, self.photons.side));
        let pass = self.emission.band.into_iter().fold(pass, |pass, band| pass.define("BAND", band));
        pass.read("light_views", self.views).define("EVENTS", events).define("REFLECT", reflect)
    }

    /// Gives a pass what the tracer reads, and dispatches it over the view.
    pub fn dispatch(&self, pass: PassBuilder<'_>, shader: &str) {
        let groups = [self.groups(), self.groups(), 1];
        self.give(pass).push(&self.push()).dispatch(shader, groups, GROUP * GROUP);
    }
}

/// Photons of one view into their columns: `light/photons`.
pub fn photons(plan: &mut Plan, name: &str, tracing: &Tracing<'_>) {
    tracing.dispatch(columns(plan.pass(name), tracing.photons), "light/photons.comp");
}

/// Gives a pass the columns to fill.
pub(super) fn columns<'p>(mut pass: PassBuilder<'p>, photons: &Photons) -> PassBuilder<'p> {
    for &(column, image) in &photons.columns {
        let binding = format!("photons_{}", column.name());
        let define = format!("COLUMN_{}", column.name().to_uppercase());
        pass = pass.store(&binding, image).define(&define, column.format(photons.half.is_some()).glsl());
    }
    pass
}
