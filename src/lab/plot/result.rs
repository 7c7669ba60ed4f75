//! What plots are drawn from: points of a sweep, renders, budgets and reproduced tables, as their JSON says it.

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value};

use crate::stats::Number;

/// A measured value, with the ends of its interval where it has one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The value itself.
    pub value: Number,
    /// Lower end of its interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub low: Option<Number>,
    /// Upper end of its interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub high: Option<Number>,
}

impl Estimate {
    /// A value without an interval.
    pub fn plain(value: f64) -> Self {
        Self { value: Number(value), low: None, high: None }
    }

    /// A value in its interval.
    pub fn within(value: f64, [low, high]: [f64; 2]) -> Self {
        Self { value: Number(value), low: Some(Number(low)), high: Some(Number(high)) }
    }

    /// Both ends, if it has both. That of an error is where it lies against a truth without noise, which may be wholly
    /// below the figure itself: it is drawn as far as the figure.
    pub fn interval(&self) -> Option<[f64; 2]> {
        let (low, high) = (self.low?.0, self.high?.0);
        (low <= high && !self.value.0.is_nan()).then(|| [low.min(self.value.0), high.max(self.value.0)])
    }

    /// Can it stand on a logarithmic axis?
    pub fn is_placeable(&self) -> bool {
        self.value.0.is_finite() && self.value.0 > 0.0
    }
}

impl<'de> Deserialize<'de> for Estimate {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        struct Whole {
            #[serde(alias = "median", alias = "gain")]
            value: Number,
            low: Option<Number>,
            high: Option<Number>,
        }
        let value = Value::deserialize(from)?;
        let wrong = serde::de::Error::custom;
        if value.is_object() {
            let whole = Whole::deserialize(value).map_err(wrong)?;
            return Ok(Self { value: whole.value, low: whole.low, high: whole.high });
        }
        Ok(Self::plain(Number::deserialize(value).map_err(wrong)?.0))
    }
}

/// A scene rendered, timed and, of a sweep, judged.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Where it was read: `file:line`.
    pub place: String,
    /// By content; empty for what is not of a sweep.
    pub key: String,
    /// The scene's name.
    pub scene: String,
    /// The method's name.
    pub method: String,
    /// The camera, empty where it is not said.
    pub camera: String,
    /// Pixels.
    pub size: [u32; 2],
    /// What its sweep sets, as written.
    pub set: BTreeMap<String, String>,
    /// Every setting in force.
    pub settings: BTreeMap<String, String>,
    /// N: photons of the light buffer, 0 without.
    pub photons: u64,
    /// Lights and triangles of the scene, and bytes of the device's memory, where it is said.
    pub lights: Option<u64>,
    /// As `lights`.
    pub triangles: Option<u64>,
    /// As `lights`.
    pub bytes: Option<u64>,
    /// The device's name.
    pub device: String,
    /// True where times are not those of a GPU.
    pub software: bool,
    /// Timed frames, where it is said.
    pub repeat: Option<u64>,
    /// ms a frame.
    pub time: Estimate,
    /// ms of each stage, in the frame's order.
    pub stages: Vec<(String, Estimate)>,
    /// The layer judged, empty where none was.
    pub layer: String,
    /// Errors by measure.
    pub errors: BTreeMap<String, Estimate>,
    /// False: another point was timed on its host meanwhile.
    pub alone: bool,
    /// The program's commit.
    pub commit: String,
}

/// Where the error of a picture comes from, step by step.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// The file.
    pub place: String,
    /// The scene's name.
    pub scene: String,
    /// The method's name.
    pub method: String,
    /// Pixels.
    pub size: [u32; 2],
    /// In the order of the chain.
    pub steps: Vec<Step>,
    /// All of them together.
    pub whole: Option<Step>,
}

/// A step of a budget.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Step {
    /// What differs.
    #[serde(default)]
    pub name: String,
    /// What a pixel gains, W/m², signed.
    pub energy: Estimate,
    /// Against the step before.
    pub relmse: Option<Estimate>,
    /// Of the whole difference.
    pub share: Option<Estimate>,
}

/// A published table beside what was measured here.
#[derive(Clone, Debug, PartialEq)]
pub struct Published {
    /// The file.
    pub place: String,
    /// The table's id.
    pub id: String,
    /// The device's name, empty where it is not said.
    pub device: String,
    /// True where times are not those of a GPU.
    pub software: bool,
    /// Its cells.
    pub rows: Vec<PublishedRow>,
}

/// A cell of a published table.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct PublishedRow {
    /// The row's name: N of an N × N photon buffer, for tables over N.
    #[serde(deserialize_with = "words")]
    pub row: String,
    /// The column's name.
    pub column: String,
    /// Of both figures.
    pub unit: String,
    /// What the paper says.
    pub published: Option<Number>,
    /// What was measured here.
    pub measured: Option<Estimate>,
}

fn words<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    Value::deserialize(from).map(|value| plain(&value))
}

/// The value as it is typed on a command line.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

#[derive(Deserialize)]
struct Device {
    name: String,
    #[serde(default)]
    kind: String,
    #[serde(default)]
    software: bool,
}

impl Device {
    fn is_software(&self) -> bool {
        self.software || self.kind == "software"
    }
}

#[derive(Deserialize)]
struct Stage {
    name: String,
    #[serde(flatten)]
    time: Map<String, Value>,
}

/// A point of `nephroid.point/1`.
pub(super) fn point(value: Value, place: &str) -> Result<Point, serde_json::Error> {
    #[derive(Deserialize)]
    struct Raw {
        #[serde(default)]
        key: String,
        scene: String,
        method: String,
        #[serde(default)]
        camera: String,
        size: [u32; 2],
        #[serde(default)]
        set: Map<String, Value>,
        #[serde(default)]
        settings: Map<String, Value>,
        photons: u64,
        lights: Option<u64>,
        triangles: Option<u64>,
        bytes: Option<u64>,
        device: Device,
        repeat: Option<u64>,
        time: Estimate,
        #[serde(default)]
        stages: Vec<Stage>,
        error: Option<Judged>,
        alone: bool,
        #[serde(default)]
        commit: String,
    }
    #[derive(Deserialize)]
    struct Judged {
        #[serde(default)]
        layer: String,
        measures: BTreeMap<String, Estimate>,
    }
    let raw = Raw::deserialize(value)?;
    let typed = |map: Map<String, Value>| map.iter().map(|(key, value)| (key.clone(), plain(value))).collect();
    let stage = |stage: Stage| Ok((stage.name, Estimate::deserialize(Value::Object(stage.time))?));
    let (layer, errors) = raw.error.map(|e| (e.layer, e.measures)).unwrap_or_default();
    Ok(Point {
        place: place.to_owned(),
        key: raw.key,
        scene: raw.scene,
        method: raw.method,
        camera: raw.camera,
        size: raw.size,
        set: typed(raw.set),
        settings: typed(raw.settings),
        photons: raw.photons,
        lights: raw.lights,
        triangles: raw.triangles,
        bytes: raw.bytes,
        software: raw.device.is_software(),
        device: raw.device.name,
        repeat: raw.repeat,
        time: raw.time,
        stages: raw.stages.into_iter().map(stage).collect::<Result<_, serde_json::Error>>()?,
        layer,
        errors,
        alone: raw.alone,
        commit: raw.commit,
    })
}

/// What `nephroid render --format json` says, of schema `nephroid.render/1`: a point without an error.
pub(super) fn render(value: Value, place: &str) -> Result<Point, serde_json::Error> {
    #[derive(Deserialize)]
    struct Raw {
        scene: String,
        method: String,
        camera: String,
        size: [u32; 2],
        settings: Map<String, Value>,
        device: Device,
        stages: Vec<Row>,
        span_ms: f64,
        provenance: Provenance,
        frames: Frames,
        photon_bytes: u64,
    }
    #[derive(Deserialize)]
    struct Row {
        path: String,
        median_ms: f64,
    }
    #[derive(Deserialize)]
    struct Provenance {
        commit: String,
    }
    #[derive(Deserialize)]
    struct Frames {
        span_ms: Vec<f64>,
    }
    let raw = Raw::deserialize(value)?;
    let side = raw.settings.get("light.side").and_then(Value::as_u64).filter(|_| raw.photon_bytes > 0).unwrap_or(0);
    Ok(Point {
        place: place.to_owned(),
        key: String::new(),
        scene: raw.scene,
        method: raw.method,
        camera: raw.camera,
        size: raw.size,
        set: BTreeMap::new(),
        settings: raw.settings.iter().map(|(key, value)| (key.clone(), plain(value))).collect(),
        photons: side * side,
        lights: None,
        triangles: None,
        bytes: None,
        software: raw.device.is_software(),
        device: raw.device.name,
        repeat: Some(raw.frames.span_ms.len() as u64),
        time: Estimate::plain(raw.span_ms),
        stages: raw.stages.into_iter().map(|row| (row.path, Estimate::plain(row.median_ms))).collect(),
        layer: String::new(),
        errors: BTreeMap::new(),
        alone: true,
        commit: raw.provenance.commit,
    })
}

/// A budget of `nephroid.budget/1`.
pub(super) fn budget(value: Value, place: &str) -> Result<Budget, serde_json::Error> {
    #[derive(Deserialize)]
    struct Raw {
        scene: String,
        method: String,
        size: [u32; 2],
        steps: Vec<Step>,
        whole: Option<Step>,
    }
    let Raw { scene, method, size, steps, whole } = Raw::deserialize(value)?;
    Ok(Budget { place: place.to_owned(), scene, method, size, steps, whole })
}

/// A table of `nephroid.reproduce/1`; `name` is its id where it does not say one.
pub(super) fn published(value: Value, place: &str, name: &str) -> Result<Published, serde_json::Error> {
    #[derive(Deserialize)]
    struct Raw {
        id: Option<String>,
        device: Option<Device>,
        rows: Vec<PublishedRow>,
    }
    let raw = Raw::deserialize(value)?;
    Ok(Published {
        place: place.to_owned(),
        id: raw.id.unwrap_or_else(|| name.to_owned()),
        software: raw.device.as_ref().is_some_and(Device::is_software),
        device: raw.device.map(|d| d.name).unwrap_or_default(),
        rows: raw.rows,
    })
}
