//! `nephroid.render/1`: what a render cost, and where its light went.

mod tables;

use serde::Serialize;
use serde_json::{Map, Value};

use super::{Measured, Provenance, Run, devices::DeviceRow, provenance::exposure};
use crate::{
    gpu::FrameTimes,
    image::Layers,
    methods::Outcome,
    passes::{
        account::{Account, BUCKETS},
        light::LAYERS,
    },
    renderer::{Counted, Energy, Job, Providers, Renderer, Unresolved},
    settings::Settings,
    stats,
};

/// The result of `nephroid render`.
#[derive(Debug, Serialize)]
pub struct RenderReport {
    schema: &'static str,
    scene: String,
    method: String,
    slots: Slots,
    camera: String,
    size: [u32; 2],
    settings: Map<String, Value>,
    device: DeviceRow,
    provenance: Provenance,
    run: Run,
    stages: Vec<Stage>,
    prepare: Vec<Preparation>,
    /// Medians over the frames.
    #[serde(flatten)]
    frame: Frame<f64>,
    startup_ms: f64,
    /// The frames themselves.
    frames: Frame<Vec<f64>>,
    /// Of methods that shoot photons.
    photons: Option<Map<String, Value>>,
    photon_bytes: u64,
    energy: Option<EnergyRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unresolved: Option<UnresolvedRow>,
    exposure_ev: f64,
    nonfinite_pixels: usize,
    warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Slots {
    surface: Option<&'static str>,
    medium: Option<&'static str>,
}

/// A stage of the frame.
#[derive(Debug, Serialize)]
struct Stage {
    path: String,
    samples_ms: Vec<f64>,
    median_ms: f64,
    mad_ms: f64,
    counters: Counters,
}

/// Counted outside the timed frames; null where the device cannot count, or there is nothing of the kind.
#[derive(Debug, Serialize)]
struct Counters {
    points: Option<u64>,
    fragments: Option<u64>,
    invocations: Option<u64>,
    bytes: u64,
}

/// What was done once, on the host's clock.
#[derive(Debug, Serialize)]
struct Preparation {
    path: &'static str,
    ms: f64,
}

/// A frame as a whole: the sum of its stages and its span on the device's clock; wall and recording on the host's.
#[derive(Debug, Serialize)]
struct Frame<T> {
    sum_ms: T,
    span_ms: T,
    wall_ms: T,
    unaccounted_ms: T,
    record_ms: T,
}

/// What a method without photons left out of its light: triangles of rays, and pixels whose search the device ended.
#[derive(Debug, Serialize)]
struct UnresolvedRow {
    triangles: u64,
    dark: u64,
    grazed: u64,
    cut_pixels: u64,
}

impl From<Unresolved> for UnresolvedRow {
    fn from(Unresolved { pieces, dark, grazed, cut_pixels }: Unresolved) -> Self {
        Self { triangles: pieces, dark, grazed, cut_pixels }
    }
}

#[derive(Debug, Serialize)]
struct EnergyRow {
    emitted_w: f64,
    valid_w: f64,
    deposited_w: f64,
    ratio: Option<f64>,
    counted: Option<CountedRow>,
    flux_w: Map<String, Value>,
}

/// What the method counted itself; deposited is then held against this.
#[derive(Debug, Serialize)]
struct CountedRow {
    arrived_w: f64,
    points_w: f64,
    samples: u64,
    refined: u64,
    left: u64,
}

impl RenderReport {
    /// From what was measured.
    pub fn new(
        job: &Job,
        renderer: &Renderer,
        measured: &Measured,
        startup_ms: f64,
        provenance: Provenance,
        run: Run,
    ) -> Self {
        let (frames, shoot) = (Frame::of(&measured.frames), job.providers.shoot());
        Self {
            schema: "nephroid.render/1",
            scene: job.scene.name.clone(),
            method: method_name(&job.providers),
            slots: Slots {
                surface: job.providers.surface.map(|m| m.name()),
                medium: job.providers.medium.map(|m| m.name()),
            },
            camera: job.camera.clone(),
            size: job.size,
            settings: provenance.settings().clone(),
            device: provenance.device().clone(),
            provenance,
            run,
            stages: (0..measured.stages.len()).map(|at| Stage::of(measured, at)).collect(),
            prepare: renderer.prepare_ms().iter().map(|&(path, ms)| Preparation { path, ms }).collect(),
            frame: frames.medians(),
            startup_ms,
            frames,
            photons: shoot.then(|| photons(&measured.account)),
            photon_bytes: renderer.photon_bytes(),
            energy: shoot.then(|| EnergyRow::new(&measured.energy, &measured.account)),
            unresolved: measured.unresolved.map(UnresolvedRow::from),
            exposure_ev: exposure(&job.settings, &job.scene),
            nonfinite_pixels: nonfinite_pixels(&measured.layers),
            warnings: [&job.scene.warnings[..], &warnings(&measured.account, job), &cut(measured)].concat(),
        }
    }

    /// What a reader of the numbers must know.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

/// The methods that fill the slots, `none` where nobody does.
pub fn method_name(providers: &Providers) -> String {
    let names: Vec<_> = providers.methods().iter().map(|m| m.name()).collect();
    if names.is_empty() { "none".to_owned() } else { names.join("+") }
}

impl Stage {
    fn of(measured: &Measured, at: usize) -> Self {
        let samples_ms: Vec<f64> = measured.frames.iter().filter_map(|f| f.passes.get(at).copied()).collect();
        let counted = measured.counters[at];
        Self {
            path: measured.stages[at].clone(),
            median_ms: stats::median(&samples_ms),
            mad_ms: stats::mad(&samples_ms),
            samples_ms,
            counters: Counters {
                points: counted.points,
                fragments: counted.fragments,
                invocations: counted.invocations,
                bytes: counted.bytes,
            },
        }
    }
}

impl Frame<Vec<f64>> {
    fn of(frames: &[FrameTimes]) -> Self {
        let each = |ms: fn(&FrameTimes) -> f64| frames.iter().map(ms).collect();
        Self {
            sum_ms: each(|f| f.passes.iter().sum()),
            span_ms: each(|f| f.span_ms),
            wall_ms: each(|f| f.wall_ms),
            unaccounted_ms: each(|f| f.span_ms - f.passes.iter().sum::<f64>()),
            record_ms: each(|f| f.record_ms),
        }
    }

    fn medians(&self) -> Frame<f64> {
        Frame {
            sum_ms: stats::median(&self.sum_ms),
            span_ms: stats::median(&self.span_ms),
            wall_ms: stats::median(&self.wall_ms),
            unaccounted_ms: stats::median(&self.unaccounted_ms),
            record_ms: stats::median(&self.record_ms),
        }
    }

    /// Names and samples.
    fn rows(&self) -> [(&'static str, &[f64]); 5] {
        [
            ("frame/sum", &self.sum_ms),
            ("frame/span", &self.span_ms),
            ("frame/unaccounted", &self.unaccounted_ms),
            ("frame/wall", &self.wall_ms),
            ("frame/record", &self.record_ms),
        ]
    }
}

pub(in crate::lab) fn photons(account: &Account) -> Map<String, Value> {
    let counts = BUCKETS.iter().zip(account.counts).map(|(name, count)| (name.to_string(), count.into()));
    counts.chain([("bent".to_owned(), account.bent.into())]).collect()
}

impl EnergyRow {
    fn new(energy: &Energy, account: &Account) -> Self {
        Self {
            emitted_w: energy.emitted_w,
            valid_w: energy.valid_w,
            deposited_w: energy.deposited_w,
            ratio: energy.ratio,
            counted: energy.counted.map(|Counted { arrived_w, points_w, samples, refined, left }| CountedRow {
                arrived_w,
                points_w,
                samples,
                refined,
                left,
            }),
            flux_w: flux(account),
        }
    }
}

/// Watts by how they ended.
pub(in crate::lab) fn flux(account: &Account) -> Map<String, Value> {
    let flux = BUCKETS.iter().zip(account.flux_w).map(|(name, flux)| (name.to_string(), flux.into()));
    flux.chain([("other_paths".to_owned(), account.other_paths_w.into())]).collect()
}

/// Says that searches were ended, whose light is lost.
fn cut(measured: &Measured) -> Vec<String> {
    let pixels = measured.unresolved.map_or(0, |left| left.cut_pixels);
    let warning = || {
        format!(
            "{pixels} pixels lost light: the device ended their search for it; set eye.samples=1, or make the picture larger \
             (each pixel then has fewer cells)"
        )
    };
    (pixels > 0).then(warning).into_iter().collect()
}

/// Share of the flux arriving at receivers that may be missing from the map, for one reason, before it is said.
const MISSING: f64 = 0.01;

/// What a reader of the numbers must know of the light.
pub(in crate::lab) fn warnings(account: &Account, job: &Job) -> Vec<String> {
    let (scene, settings) = (&job.scene, &job.settings);
    let receiver = if job.camera == "region" { &scene.region } else { &scene.extent };
    let shown = Outcome { scene, receiver, settings, account };
    let methods = job.providers.methods();
    let of_methods = methods.iter().flat_map(|method| method.warnings(&shown));
    let of_account = [outside_map(account, &job.camera), no_layer(account, settings)];
    of_account.into_iter().flatten().chain(of_methods).collect()
}

/// Share of the flux that arrives at receivers. Without any light it is no number, and above nothing.
fn of_arriving(account: &Account, flux_w: f64) -> f64 {
    flux_w / (account.valid_w() + account.outside_map_w() + account.no_layer_w())
}

/// Says how much of the light that arrives found no layer in the photon buffer.
fn no_layer(account: &Account, settings: &Settings) -> Option<String> {
    let share = of_arriving(account, account.no_layer_w());
    let layers = settings.whole(&LAYERS);
    (share > MISSING).then(|| {
        format!(
            "{:.1} % of the flux that arrives at receivers has no layer in the photon buffer and is not shown: a sample of \
             the class all:N leaves its {layers} brightest photons; raise light.layers",
            100.0 * share
        )
    })
}

/// Says how much of the light that arrives at receivers the map does not hold, where it is more than a trifle.
fn outside_map(account: &Account, camera: &str) -> Option<String> {
    let share = of_arriving(account, account.outside_map_w());
    let patch = if camera == "region" { "region" } else { "extent" };
    (share > MISSING).then(|| {
        format!(
            "{:.1} % of the flux that arrives at receivers falls outside the caustic map (beside the rectangle on the \
             region's receiver, or on what has no part of the map) and is not shown; \
             widen `[{patch}]`, such as by --set scene.{patch}.half=[U, V] (the receiver's size is the limit), \
             or turn the receiver so that its lit side, u × v, faces the light",
            100.0 * share
        )
    })
}

/// Pixels with a value that is not finite, in whichever layer.
fn nonfinite_pixels(layers: &Layers) -> usize {
    let mut broken = vec![false; layers.width() * layers.height()];
    for layer in layers.iter() {
        for (broken, pixel) in broken.iter_mut().zip(layer.pixels()) {
            *broken |= pixel.iter().any(|value| !value.is_finite());
        }
    }
    broken.into_iter().filter(|&broken| broken).count()
}
