//! A sweep as it is written: lists are axes, and every point is one value of each.

use std::{collections::BTreeMap, path::Path, sync::Arc};

use serde::Deserialize;
use toml::{Table, Value};

use super::{Reference, Spec, Sweep};
use crate::{
    lab::{Picture, Sequence, picture::REGION},
    methods,
    names::near,
    passes::light,
    renderer::{self, Job, Providers},
    scene::{Place, Scene, SceneError, Written},
    settings::{SettingError, Settings},
};

/// The one version there is.
const VERSION: i64 = 1;
/// Points of one sweep: more are a slip of the hand.
const MOST: usize = 100_000;
/// Larger than the images of any device.
const LARGEST: u32 = 65536;
/// What a setting of the scene begins with.
const SCENE: &str = "scene.";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SweepFile {
    version: i64,
    scenes: Vec<String>,
    methods: Vec<String>,
    #[serde(default = "region")]
    camera: String,
    size: [u32; 2],
    #[serde(default = "rounds")]
    rounds: u32,
    #[serde(default = "layer")]
    layer: String,
    #[serde(default = "auto")]
    reference: String,
    #[serde(default = "seconds")]
    seconds: f64,
    flicker: Option<String>,
    #[serde(default)]
    set: Table,
}

fn region() -> String {
    REGION.to_owned()
}
fn rounds() -> u32 {
    15
}
fn layer() -> String {
    "irradiance.caustic".to_owned()
}
fn auto() -> String {
    "auto".to_owned()
}
fn seconds() -> f64 {
    120.0
}

/// Keys and values, as they would be typed.
type Pairs = Vec<(String, String)>;

/// A key of `[set]` with its values as they would be typed.
struct Axis {
    key: String,
    values: Vec<String>,
}

/// Reads a sweep and checks all of it: no device is needed to find what is wrong.
pub(super) fn load(file: &str) -> Result<Sweep, SceneError> {
    let written = Written::read(file)?;
    let parsed: SweepFile = written.parse()?;
    check(&written, &parsed)?;
    let flicker = flicker(&written, &parsed)?;
    let folder = Path::new(file).parent().unwrap_or(Path::new(""));
    let axes = axes(&written, &parsed.set)?;
    let count = axes.iter().map(|axis| axis.values.len()).chain([parsed.scenes.len(), parsed.methods.len()]);
    if count.fold(1, usize::saturating_mul) > MOST {
        return Err(written.fault(&["set"], format!("at most {MOST} points"), "more", "shorten its lists"));
    }
    let mut reader = Reader { written: &written, folder, parsed: &parsed, loaded: BTreeMap::new() };
    let mut points = Vec::new();
    for at in 0..parsed.scenes.len() {
        let reference = reader.reference(at)?;
        for method in &parsed.methods {
            let own: Vec<&Axis> = axes.iter().filter(|axis| concerns(&axis.key, method)).collect();
            for set in product(&own) {
                let job = reader.job(at, method, &set)?;
                points.push(Spec { method: method.clone(), set, job, reference: reference.clone() });
            }
        }
    }
    let name = Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Sweep { flicker, ..Sweep::new(name, file, points, (parsed.rounds, parsed.layer, parsed.seconds)) })
}

/// The frames whose flicker is measured: each has a truth of its own, which `auto` alone makes.
fn flicker(written: &Written, parsed: &SweepFile) -> Result<Option<Sequence>, SceneError> {
    let Some(text) = &parsed.flicker else { return Ok(None) };
    if parsed.reference != "auto" {
        let found = format!("reference = \"{}\"", parsed.reference);
        let remedy = "write `reference = \"auto\"`, or take `flicker` out";
        return Err(written.fault(&["flicker"], "a truth for each frame", found, remedy));
    }
    let sequence: Sequence = text.parse().map_err(|why: String| {
        let remedy = "write a range of times, such as \"0..0.6@10\"";
        written.fault(&["flicker"], why, format!("`{text}`"), remedy)
    })?;
    if sequence.frames() < 2 {
        let remedy = "give more frames a second, or more time";
        return Err(written.fault(&["flicker"], "two frames or more", "one", remedy));
    }
    Ok(Some(sequence))
}

fn check(written: &Written, parsed: &SweepFile) -> Result<(), SceneError> {
    if parsed.version != VERSION {
        let remedy = format!("write `version = {VERSION}`; this program reads no other");
        return Err(written.fault(&["version"], format!("version {VERSION}"), parsed.version.to_string(), remedy));
    }
    for (key, empty) in [("scenes", parsed.scenes.is_empty()), ("methods", parsed.methods.is_empty())] {
        if empty {
            return Err(written.fault(
                &[key],
                "one or more",
                "an empty list",
                "name one: a sweep has a point at least",
            ));
        }
    }
    for (at, method) in parsed.methods.iter().enumerate().filter(|(_, method)| *method != "none") {
        if methods::find(method).is_err() {
            let known = methods::ALL.iter().map(|m| m.name()).chain(["none"]);
            let found = format!("`{method}`");
            return Err(written.fault(
                &["methods", &at.to_string()],
                "the name of a method",
                found,
                near(method, known),
            ));
        }
    }
    if parsed.size.iter().any(|side| !(1..=LARGEST).contains(side)) {
        let found = format!("{:?}", parsed.size);
        return Err(written.fault(
            &["size"],
            format!("sides of 1 to {LARGEST} pixels"),
            found,
            "write `[width, height]`",
        ));
    }
    if parsed.rounds == 0 {
        return Err(written.fault(&["rounds"], "one round or more", "0", "write 8 or more, for an interval of 99 %"));
    }
    if !(parsed.seconds.is_finite() && parsed.seconds >= 0.0) {
        let found = parsed.seconds.to_string();
        return Err(written.fault(&["seconds"], "a number of seconds", found, "write the most time for one truth, s"));
    }
    if !renderer::LAYERS.contains(&parsed.layer.as_str()) {
        let (found, remedy) = (format!("`{}`", parsed.layer), near(&parsed.layer, renderer::LAYERS));
        return Err(written.fault(&["layer"], "the name of a layer", found, remedy));
    }
    if parsed.camera != REGION && parsed.reference != "none" {
        let remedy = "write `camera = \"region\"`, or `reference = \"none\"` for times alone";
        let found = format!("`{}`", parsed.camera);
        return Err(written.fault(&["camera"], "the camera `region`, where errors are judged", found, remedy));
    }
    Ok(())
}

/// Whether a key is one of a method's points: settings of another method are not, nor are those of photons where it
/// shoots none, but for what it says to read. Of all of them it would have the same picture.
fn concerns(key: &str, method: &str) -> bool {
    let room = key.split('.').next().unwrap_or_default();
    if methods::ALL.iter().any(|known| known.name() == room) {
        return room == method;
    }
    let of_photons = room == "light" && key != light::PATHS.key;
    !of_photons || methods::find(method).is_ok_and(|method| method.shoots() || method.reads().contains(&key))
}

/// Every key below `[set]`, in the order of the alphabet.
fn axes(written: &Written, set: &Table) -> Result<Vec<Axis>, SceneError> {
    let (mut axes, mut settings, known) = (Vec::new(), Settings::default(), renderer::all_settings());
    for (key, value) in flat("", set) {
        let path = |at: &str| ["set", &key, at].map(str::to_owned);
        let fault = |at: usize, expected: String, found: String, remedy: String| {
            let path = path(&at.to_string());
            let list = if value.is_array() { &path[..] } else { &path[..2] };
            written.fault(&list.iter().map(String::as_str).collect::<Vec<_>>(), expected, found, remedy)
        };
        let values = match value {
            Value::Array(values) => values.iter().map(typed).collect(),
            single => vec![typed(single)],
        };
        if values.is_empty() {
            let remedy = "name one, or take the key out".to_owned();
            return Err(written.fault(&["set", &key], "one value or more", "an empty list", remedy));
        }
        for (at, text) in values.iter().enumerate().filter(|_| !key.starts_with(SCENE)) {
            settings.set(&known, &key, text).map_err(|error| match error {
                SettingError::Unknown { near, .. } => {
                    let remedy = format!("`nephroid methods` lists them{near}");
                    fault(at, "a setting".to_owned(), format!("`{key}`"), remedy)
                }
                SettingError::Value { value, expected, unit, default, .. } => {
                    fault(at, format!("{expected}{unit}"), value, format!("the default is {default}"))
                }
            })?;
        }
        axes.push(Axis { key, values });
    }
    Ok(axes)
}

/// Dotted keys with what stands there.
fn flat<'t>(prefix: &str, table: &'t Table) -> Vec<(String, &'t Value)> {
    let mut all = Vec::new();
    for (name, value) in table {
        let path = if prefix.is_empty() { name.clone() } else { format!("{prefix}.{name}") };
        match value {
            Value::Table(inner) => all.extend(flat(&path, inner)),
            other => all.push((path, other)),
        }
    }
    all
}

/// As one would type it after `--set KEY=`.
fn typed(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// One value of each axis, the last one changing fastest.
fn product(axes: &[&Axis]) -> Vec<Pairs> {
    axes.iter().fold(vec![Vec::new()], |points, axis| {
        let with = |point: &Vec<(String, String)>, value: &String| {
            point.iter().cloned().chain([(axis.key.clone(), value.clone())]).collect()
        };
        points.iter().flat_map(|point| axis.values.iter().map(move |value| with(point, value))).collect()
    })
}

/// What scenes and references are read by.
struct Reader<'f> {
    written: &'f Written,
    folder: &'f Path,
    parsed: &'f SweepFile,
    /// By name and overrides.
    loaded: BTreeMap<(usize, Pairs), Arc<Scene>>,
}

impl Reader<'_> {
    fn job(&mut self, at: usize, method: &str, set: &[(String, String)]) -> Result<Job, SceneError> {
        let (of_scene, of_settings): (Vec<_>, Vec<_>) =
            set.iter().cloned().partition(|(key, _)| key.starts_with(SCENE));
        let overrides: Vec<_> =
            of_scene.into_iter().map(|(key, value)| (key[SCENE.len()..].to_owned(), value)).collect();
        let (mut settings, known) = (Settings::default(), renderer::all_settings());
        for (key, value) in &of_settings {
            // They were checked one by one before.
            let _ = settings.set(&known, key, value);
        }
        let providers = methods::find(method).map(Providers::of).unwrap_or_default();
        let (camera, size) = (self.parsed.camera.clone(), self.parsed.size);
        let job = Job { scene: self.scene(at, overrides)?, providers, settings, camera, size };
        if let Err(error) = job.camera() {
            let found = format!("`{}`: {error}", job.camera);
            return Err(self.written.fault(&["camera"], "a camera of every scene", found, "name one that each has"));
        }
        Ok(job)
    }

    fn scene(&mut self, at: usize, overrides: Pairs) -> Result<Arc<Scene>, SceneError> {
        let key = (at, overrides);
        if let Some(scene) = self.loaded.get(&key) {
            return Ok(scene.clone());
        }
        let name = &self.parsed.scenes[at];
        let scene = Scene::load(&self.beside(name), &key.1).map_err(|error| self.located(at, error))?;
        Ok(self.loaded.entry(key).or_insert(Arc::new(scene)).clone())
    }

    /// A fault of what the sweep says stands in the sweep; one of a scene file, there.
    fn located(&self, at: usize, error: SceneError) -> SceneError {
        let scene = &self.parsed.scenes[at];
        let SceneError { place, expected, found, remedy, .. } = &error;
        match &**place {
            Place::Scene(_) => self.written.fault(&["scenes", &at.to_string()], expected, found, remedy),
            Place::Override { key, value, .. } => {
                let found = format!("{found} (of the scene `{scene}`, at {value})");
                self.written.fault(&["set", "scene", key], expected, found, remedy)
            }
            Place::File { .. } => error,
        }
    }

    /// A path is relative to the sweep's file; a name is none.
    fn beside(&self, name: &str) -> String {
        if name.contains('/') || name.ends_with(".toml") {
            return self.folder.join(name).display().to_string();
        }
        name.to_owned()
    }

    fn reference(&mut self, at: usize) -> Result<Reference, SceneError> {
        let pattern = match self.parsed.reference.as_str() {
            "auto" => return Ok(Reference::Auto),
            "none" => return Ok(Reference::None),
            pattern => pattern,
        };
        let path = self.folder.join(pattern.replace("{scene}", &self.scene(at, Vec::new())?.name));
        let fault = |expected: String, found, remedy| self.written.fault(&["reference"], expected, found, remedy);
        let remedy = "make it by `nephroid truth`, or write \"auto\" or \"none\"; {scene} stands for a scene's name";
        let expected = || "\"auto\", \"none\", or a readable EXR file".to_owned();
        let bytes =
            std::fs::read(&path).map_err(|why| fault(expected(), format!("{}: {why}", path.display()), remedy))?;
        let picture = Picture::read(&path).map_err(|why| fault(expected(), why.to_string(), remedy))?;
        let size = self.parsed.size.map(|side| side as usize);
        if picture.size() != size {
            let [width, height] = picture.size();
            let found = format!("{width}x{height} in {}", path.display());
            return Err(fault(format!("a picture of {}x{}", size[0], size[1]), found, "change `size`"));
        }
        Ok(Reference::File { picture: Arc::new(picture), hash: blake3::hash(&bytes).to_hex().to_string() })
    }
}
