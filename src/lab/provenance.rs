//! Where a result comes from: enough to make it again, and nothing that differs between two runs of one command.

use serde::Serialize;
use serde_json::{Map, Value};
use sysinfo::{CpuRefreshKind, RefreshKind, System};

use super::{
    devices::DeviceRow,
    picture::{FILTERED, RELATIVE},
};
use crate::{
    gpu::DeviceInfo,
    image,
    metrics::bare_irradiance,
    passes::eye,
    renderer::{self, Frame, Job},
    scene::Scene,
    settings::{Setting, Settings},
};

/// Program, machine, scene and settings.
#[derive(Clone, Debug, Serialize)]
pub struct Provenance {
    version: &'static str,
    commit: &'static str,
    dirty: bool,
    rustc: &'static str,
    device: DeviceRow,
    cpu: String,
    os: String,
    scene: SceneSource,
    camera: String,
    size: [u32; 2],
    settings: Map<String, Value>,
    /// W/m²: the yardstick of the scene's errors.
    e0: f64,
    time_s: f64,
    seed: u32,
    /// Where the slot `surface` is irradiance only up to a scale.
    #[serde(skip_serializing_if = "Option::is_none")]
    surface: Option<&'static str>,
    arguments: Vec<String>,
}

#[derive(Clone, Debug, Serialize)]
struct SceneSource {
    name: String,
    file: String,
    hash: String,
    overrides: Vec<String>,
    resolved: String,
}

/// What differs from run to run: it stands in `result.json` alone.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// UTC, RFC 3339.
    pub started: String,
    /// The output folder.
    pub out: String,
    /// Processes that wanted to run, mean of the last minute.
    pub load_1min: Option<f64>,
}

impl Run {
    /// Of this moment.
    pub fn now(out: &std::path::Path) -> Self {
        let started = humantime::format_rfc3339_seconds(std::time::SystemTime::now()).to_string();
        let load_1min = System::load_average().ok().map(|load| load.one);
        Self { started, out: out.display().to_string(), load_1min }
    }
}

impl Provenance {
    /// `arguments` without anything that names the output.
    pub fn new(job: &Job, frame: &Frame, device: &DeviceInfo, arguments: Vec<String>) -> Self {
        let scene = job.scene.at(frame.time);
        let commit = env!("NEPHROID_COMMIT");
        let clean = commit.strip_suffix("-dirty");
        Self {
            version: env!("CARGO_PKG_VERSION"),
            commit: clean.unwrap_or(commit),
            dirty: clean.is_some(),
            rustc: env!("NEPHROID_RUSTC"),
            device: device.into(),
            cpu: cpu(),
            os: os(),
            scene: SceneSource::new(&scene),
            camera: job.camera.clone(),
            size: job.size,
            settings: in_force(job),
            e0: bare_irradiance(&scene),
            time_s: frame.time,
            seed: frame.seed,
            surface: surface(job),
            arguments,
        }
    }

    /// Every setting with the value in force.
    pub fn settings(&self) -> &Map<String, Value> {
        &self.settings
    }

    /// The device.
    pub fn device(&self) -> &DeviceRow {
        &self.device
    }

    /// As attributes of a picture: `scene.hash`, `device.name`; lists as JSON.
    pub fn attributes(&self) -> image::Provenance {
        let mut flat = image::Provenance::new();
        if let Ok(Value::Object(all)) = serde_json::to_value(self) {
            flatten("", &all, &mut flat);
        }
        flat
    }
}

impl SceneSource {
    fn new(scene: &Scene) -> Self {
        let source = &scene.source;
        Self {
            name: scene.name.clone(),
            file: source.file.clone(),
            hash: source.hash.clone(),
            overrides: source.overrides.iter().map(|(key, value)| format!("{key}={value}")).collect(),
            resolved: source.resolved.clone(),
        }
    }
}

/// Exposure of the PNG: the setting, else the scene's.
pub fn exposure(settings: &Settings, scene: &Scene) -> f64 {
    settings.real(&eye::EXPOSURE).unwrap_or(scene.exposure)
}

/// What is to be known of the slot `surface`, if anything.
fn surface(job: &Job) -> Option<&'static str> {
    let filters = || job.providers.surface.is_some_and(|method| method.eye_samples(&job.settings).is_some());
    if job.providers.is_relative(&job.settings) { Some(RELATIVE) } else { filters().then_some(FILTERED) }
}

/// Every setting: values as numbers where they are numbers; what the scene or the camera decides, as it decided.
pub(super) fn in_force(job: &Job) -> Map<String, Value> {
    let (settings, scene) = (&job.settings, &job.scene);
    let value = |setting: Setting| match setting {
        Setting::Whole(s) if s.key == eye::SAMPLES.key => job.eye_samples().into(),
        Setting::Whole(s) => settings.whole(s).into(),
        Setting::Real(s) if s.key == eye::EXPOSURE.key => exposure(settings, scene).into(),
        Setting::Real(s) => settings.real(s).into(),
        Setting::Choice(_) | Setting::Word(_) => settings.text(setting).into(),
    };
    let decided = job.providers.methods().into_iter().flat_map(|m| m.decided(settings, scene));
    let decided = decided.map(|(key, value)| (key.to_owned(), value.into()));
    renderer::all_settings().into_iter().map(|s| (s.key().to_owned(), value(s))).chain(decided).collect()
}

fn flatten(prefix: &str, values: &Map<String, Value>, into: &mut image::Provenance) {
    for (name, value) in values {
        let path = if prefix.is_empty() { name.clone() } else { format!("{prefix}.{name}") };
        match value {
            Value::Object(inner) => flatten(&path, inner, into),
            Value::String(text) => drop(into.insert(path, text.clone())),
            other => drop(into.insert(path, other.to_string())),
        }
    }
}

pub(super) fn cpu() -> String {
    let system = System::new_with_specifics(RefreshKind::nothing().with_cpu(CpuRefreshKind::nothing()));
    let known = system.ok().and_then(|s| Some((s.cpus().first()?.brand().trim().to_owned(), s.cpus().len())));
    match known {
        Some((brand, count)) => format!("{brand} ({count} logical)"),
        None => System::cpu_arch(),
    }
}

pub(super) fn os() -> String {
    let unknown = || std::env::consts::OS.to_owned();
    let name = System::long_os_version().unwrap_or_else(|_| unknown());
    let kernel = System::kernel_long_version().unwrap_or_default();
    format!("{name}, {kernel}")
}
