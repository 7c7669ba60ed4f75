//! Pictures of scenes through the renderer, and what is measured on them.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use nephroid::{
    gpu::Gpu,
    image::Layers,
    methods,
    passes::account::{Account, BUCKETS},
    renderer::{Dump, Energy, Frame, Job, Providers, Renderer, all_settings},
    scene::{PathClass, Region, Scene},
    settings::Settings,
};

use png::{BitDepth, ColorType, Encoder};

use super::assert_quiet;

/// Pixels that see the region when each is to be one texel of the caustic map: the map's side without its margin, half
/// a splat of three texels and one texel more on each side.
pub const fn pixels_of_map(side: u32) -> u32 {
    side - 5
}

/// A PNG of eight bits a band, rows from the top.
pub fn png(width: u32, pixels: &[[u8; 3]]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, pixels.len() as u32 / width);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&pixels.concat()).unwrap();
    writer.finish().unwrap();
    bytes
}

/// A shipped scene with values changed.
pub fn scene(name: &str, changed: &[(&str, &str)]) -> Scene {
    let changed: Vec<_> = changed.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    Scene::load(name, &changed).unwrap_or_else(|error| panic!("{error}"))
}

/// A scene from its text, with files beside it.
pub fn written(text: &str, beside: &[(&str, &str)]) -> Scene {
    let folder = tempfile::tempdir().expect("a folder for a scene");
    for (name, content) in beside.iter().chain(&[("scene.toml", text)]) {
        std::fs::write(folder.path().join(name), content).expect("a scene is written");
    }
    let path = folder.path().join("scene.toml");
    Scene::load(path.to_str().expect("a plain path"), &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// A shipped scene's text with passages replaced, each of which must be there, and more at its end.
pub fn rewritten(name: &str, replaced: &[(&str, &str)], more: &str) -> String {
    let mut text = scene(name, &[]).source.text;
    for (old, new) in replaced {
        assert!(text.contains(old), "{name} holds no {old:?}");
        text = text.replace(old, new);
    }
    text + more
}

/// `maps` on a scene through one of its cameras.
pub fn job_of(scene: Scene, set: &[(&str, &str)], camera: &str, size: [u32; 2]) -> Job {
    let (mut settings, known) = (Settings::default(), all_settings());
    // Splats where nobody says: most tests are of light, scenes and eye, which splats show in a third of the time that cells take. The
    // default itself is what the program's own tests run, on every scene (`tests/program/references.rs`).
    let said = set.iter().any(|(key, _)| ["maps.gather", "maps.splat"].contains(key));
    let fixed = [("maps.splat", "fixed")];
    for (key, value) in fixed.iter().filter(|_| !said).chain(set) {
        settings.set(&known, key, value).unwrap_or_else(|error| panic!("{error}"));
    }
    let providers = Providers::of(methods::find("maps").expect("maps is a method"));
    Job { scene: Arc::new(scene), providers, settings, camera: camera.to_owned(), size }
}

/// A frame, its account, and the renderer to ask for more.
pub struct Picture {
    pub renderer: Renderer,
    pub layers: Layers,
    pub account: Account,
    pub energy: Energy,
}

/// Renders one frame. Whatever the test, every pixel of every layer must be finite and the validation layers silent.
pub fn picture(gpu: &Gpu, job: &Job) -> Picture {
    let mut renderer = Renderer::new(gpu, job).unwrap_or_else(|error| panic!("{error}"));
    renderer.frame(&Frame::default()).expect("a frame is rendered");
    let account = renderer.account().expect("photons are counted");
    let energy = renderer.energy(&account).expect("the map is read");
    let layers = renderer.layers().expect("the layers are read");
    for layer in layers.iter() {
        let bad = layer.pixels().filter(|pixel| !pixel.iter().all(|v| v.is_finite())).count();
        assert_eq!(bad, 0, "pixels of {} that are not finite", layer.name());
    }
    assert_quiet(gpu);
    Picture { renderer, layers, account, energy }
}

/// The account alone: no frame, no picture.
pub fn account(gpu: &Gpu, job: &Job) -> Account {
    let mut renderer = Renderer::new(gpu, job).unwrap_or_else(|error| panic!("{error}"));
    let account = renderer.account().expect("photons are counted");
    assert_quiet(gpu);
    account
}

/// Every photon that was emitted ended once; in class `all:N`, at least once, by one or several branches.
pub fn all_ended(account: &Account, class: PathClass) {
    let (emitted, ended) = (account.counts[0], account.counts[1..].iter().sum::<u64>());
    let right = if matches!(class, PathClass::All(_)) { ended >= emitted } else { ended == emitted };
    assert!(right, "{class}: {BUCKETS:?} {:?}", account.counts);
}

impl Picture {
    /// All values of a layer.
    pub fn layer(&self, name: &str) -> &[f32] {
        self.layers.get(name).unwrap_or_else(|| panic!("no layer {name}")).data()
    }

    /// The mean of each pixel's bands.
    pub fn mean(&self, name: &str) -> Vec<f64> {
        let bands = self.layer(name).chunks_exact(3);
        bands.map(|b| (f64::from(b[0]) + f64::from(b[1]) + f64::from(b[2])) / 3.0).collect()
    }

    /// The sum over all pixels of the mean of the bands.
    pub fn sum(&self, name: &str) -> f64 {
        self.mean(name).iter().sum()
    }

    /// Names of the stages that were recorded.
    pub fn ran(&self, stage: &str) -> bool {
        self.renderer.stages().iter().any(|s| s.split(':').next() == Some(stage))
    }

    /// The caustic map's texels (RGBA) and its side.
    pub fn map(&self) -> (Vec<f32>, usize) {
        match self.renderer.dump("maps/map").expect("the map is in the plan") {
            Dump::Image { extent, mut layers, .. } => (layers.swap_remove(0), extent[0] as usize),
            Dump::Buffer(_) => panic!("the map is an image"),
        }
    }
}

/// The pixels of the camera `region` on the receiver.
pub struct Pixels<'a> {
    pub region: &'a Region,
    pub size: [u32; 2],
}

impl Pixels<'_> {
    /// m² of receiver a pixel.
    pub fn area(&self) -> f64 {
        self.region.area() / f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// World position of a point of the picture: pixels from its left and top.
    pub fn at(&self, x: f64, y: f64) -> DVec3 {
        let w = DVec2::new(2.0 * x / f64::from(self.size[0]) - 1.0, 1.0 - 2.0 * y / f64::from(self.size[1]));
        self.region.center + self.region.u * w.x + self.region.v * w.y
    }

    /// World positions of all pixels' centres, in the order of a layer's values.
    pub fn centres(&self) -> impl Iterator<Item = DVec3> {
        let [width, height] = self.size;
        (0..height).flat_map(move |y| (0..width).map(move |x| self.at(f64::from(x) + 0.5, f64::from(y) + 0.5)))
    }
}

/// The greatest size among errors; infinite if one is no number.
pub fn worst(errors: impl IntoIterator<Item = f64>) -> f64 {
    errors.into_iter().fold(0.0, |worst, e| if e.is_finite() { worst.max(e.abs()) } else { f64::INFINITY })
}

/// The flux (W) that a rectangle gets of light spread evenly round its centre, by the flux inside each circle.
///
/// `half`: half edges, m; rings of `step` metres each give the share of their circle that lies in the rectangle.
pub fn flux_in_square(half: f64, step: f64, encircled: impl Fn(f64) -> f64) -> f64 {
    let rings = ((half * 2f64.sqrt() - half) / step).ceil() as u32;
    let width = (half * 2f64.sqrt() - half) / f64::from(rings);
    let radius = |k: u32| half + width * f64::from(k);
    let corners = (0..rings).map(|k| {
        let share = 1.0 - 4.0 * (half / (radius(k) + 0.5 * width)).acos() / std::f64::consts::PI;
        share * (encircled(radius(k + 1)) - encircled(radius(k)))
    });
    encircled(half) + corners.sum::<f64>()
}
