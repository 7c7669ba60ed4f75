//! A truth in the making: chunks of photons, added in their order until the goal is met.

use rayon::prelude::*;
use std::ops::ControlFlow;

use super::{
    direct::{Direct, direct, judged},
    eye::Eye,
    light::Photons,
    sums::{BANDS, Sums},
    trace::Space,
};
use crate::{
    image::{ImageError, Layers, Provenance},
    metrics::bare_irradiance,
    scene::{Camera, PathClass, Scene},
    store::Key,
};

/// Raised whenever the same task would give other numbers.
pub const VERSION: u32 = 1;

/// ε of the judged figure: (this share of E₀)².
const EPSILON: f64 = 0.1;
/// Chunks before an estimate of noise is believed.
const CHUNKS: u64 = 32;
/// Photons of a chunk, at least and at most.
const PER_CHUNK: [u64; 2] = [1 << 10, 1 << 16];

/// What decides every bit of a truth.
#[derive(Clone, Debug)]
pub struct Task {
    /// Which light paths are its caustic.
    pub paths: PathClass,
    /// Name of the scene's camera.
    pub camera: String,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Of everything random.
    pub seed: u64,
    /// When it is finished.
    pub goal: Goal,
}

/// When a truth is finished: by whichever comes first.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// This many photons, rounded up to whole chunks.
    pub photons: Option<u64>,
    /// An estimated noise, as relMSE, of at most this.
    pub noise: Option<f64>,
}

impl Task {
    /// Photons of a chunk: some [`CHUNKS`] of them, within bounds, so that few photons too have a noise to estimate.
    fn per_chunk(&self) -> u64 {
        (self.goal.photons.unwrap_or(u64::MAX) / (2 * CHUNKS)).clamp(PER_CHUNK[0], PER_CHUNK[1])
    }

    /// What a finished truth of this task is found by.
    pub fn key(&self, scene: &Scene) -> Key {
        let Self { paths, camera, size, seed, goal } = self;
        Key::of([format!("{VERSION} {} {paths} {camera} {size:?} {seed} {goal:?}", scene.source.hash)])
    }
}

/// Where a run stands.
#[derive(Clone, Copy, Debug)]
pub struct Standing {
    /// Photons so far.
    pub photons: u64,
    /// Estimated relMSE of a perfect image against the caustic so far; infinite before two chunks.
    pub noise: f64,
    /// The goal is met.
    pub finished: bool,
}

/// A truth in the making.
pub struct Run<'a> {
    task: &'a Task,
    eye: Eye,
    space: &'a Space<'a>,
    photons: Photons<'a>,
    direct: Direct,
    caustic: Sums,
    judged: Vec<bool>,
    e0: f64,
}

impl<'a> Run<'a> {
    /// Computes direct light, and sets up the photons.
    pub fn new(space: &'a Space<'a>, camera: &Camera, task: &'a Task) -> Self {
        let eye = Eye::new(camera, task.size);
        let direct = direct(space, &eye, task.seed);
        let judged = judged(space, &eye, &direct.mask);
        let photons = Photons::new(space, task.paths, task.seed, task.per_chunk());
        let caustic = Sums::new(eye.pixels());
        Self { task, space, photons, caustic, judged, e0: bare_irradiance(space.scene), direct, eye }
    }

    /// Adds chunks, a group of `width` at a time on all cores, until the goal is met or `watch` breaks off.
    /// `watch` is told after every group. The result does not depend on `width`.
    pub fn advance(&mut self, width: usize, mut watch: impl FnMut(&Self, Standing) -> ControlFlow<()>) -> Standing {
        let mut standing = self.standing();
        while !standing.finished {
            let first = self.caustic.chunks;
            let group: Vec<_> = (first..first + width.max(1) as u64).into_par_iter().map(|k| self.picture(k)).collect();
            for picture in &group {
                self.caustic.add(picture);
                standing = self.standing();
                if standing.finished {
                    break;
                }
            }
            if watch(self, standing).is_break() {
                break;
            }
        }
        standing
    }

    /// Where it stands.
    pub fn standing(&self) -> Standing {
        let per_chunk = self.photons.per_chunk();
        let noise = if per_chunk == 0 { 0.0 } else { self.caustic.noise(&self.judged, self.epsilon()) };
        let photons = self.caustic.chunks * per_chunk;
        let enough = self.task.goal.photons.is_some_and(|n| photons >= n);
        let quiet = self.task.goal.noise.is_some_and(|most| self.caustic.chunks >= CHUNKS && noise <= most);
        Standing { photons, noise, finished: per_chunk == 0 || enough || quiet }
    }

    /// The irradiance of chunk `k` alone, W/m².
    fn picture(&self, k: u64) -> Vec<f64> {
        let mut picture = vec![0.0; self.eye.pixels() * BANDS];
        self.photons.chunk(k, |landing| {
            let Some(seen) = self.eye.see(landing.surface.p) else { return };
            let cosine = seen.towards.dot(landing.normal);
            if cosine <= 0.0 || self.eye.hidden(self.space, &landing.surface.ray(seen.towards), seen.distance) {
                return;
            }
            let e = landing.flux * (cosine * seen.density);
            for band in 0..BANDS {
                picture[seen.pixel * BANDS + band] += e[band];
            }
        });
        picture
    }

    fn epsilon(&self) -> f64 {
        (EPSILON * self.e0).powi(2)
    }

    /// The sums so far, to go on from.
    pub fn checkpoint(&self) -> Vec<u8> {
        self.caustic.to_bytes()
    }

    /// Goes on from a checkpoint of the same task; false, and nothing changes, if the bytes are of another size.
    pub fn resume(&mut self, bytes: &[u8]) -> bool {
        let sums = Sums::from_bytes(bytes, self.eye.pixels());
        sums.map(|sums| self.caustic = sums).is_some()
    }

    /// The layers: both irradiances with the variances of their pixels, and the mask.
    ///
    /// # Errors
    /// [`ImageError`] without pixels.
    pub fn layers(&self) -> Result<Layers, ImageError> {
        let [width, height] = self.task.size.map(|n| n as usize);
        let mut layers = Layers::new(width, height);
        let narrow = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(|x| x as f32).collect::<Vec<_>>();
        if self.photons.per_chunk() > 0 {
            layers.push("irradiance.caustic", BANDS, narrow(&mut self.caustic.mean()))?;
            layers.push("irradiance.caustic.variance", BANDS, narrow(&mut self.caustic.variance()))?;
        }
        layers.push("irradiance.direct", BANDS, narrow(&mut self.direct.sums.mean()))?;
        layers.push("irradiance.direct.variance", BANDS, narrow(&mut self.direct.sums.variance()))?;
        layers.push("mask", 1, narrow(&mut self.direct.mask.iter().copied()))?;
        Ok(layers)
    }

    /// What the file says of itself: nothing in it differs between two runs of one task.
    pub fn provenance(&self) -> Provenance {
        let (scene, task, standing) = (self.space.scene, self.task, self.standing());
        let size = format!("{}x{}", task.size[0], task.size[1]);
        let entries = [
            ("kind", "truth".to_owned()),
            ("truth.version", VERSION.to_string()),
            ("scene.name", scene.name.clone()),
            ("scene.hash", scene.source.hash.clone()),
            ("scene.resolved", scene.source.resolved.clone()),
            ("paths", task.paths.to_string()),
            ("camera", task.camera.clone()),
            ("size", size),
            ("seed", task.seed.to_string()),
            ("photons", standing.photons.to_string()),
            ("chunks", self.caustic.chunks.to_string()),
            ("noise.relmse", format!("{:e}", standing.noise)),
            ("e0", format!("{:e}", self.e0)),
            ("finished", standing.finished.to_string()),
        ];
        entries.into_iter().map(|(name, text)| (name.to_owned(), text)).collect()
    }
}
