//! `nephroid.sequence/1`: frames one after the other, each at its time; a line of JSON for each, and what they took in all.

use std::{collections::BTreeMap, str::FromStr};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{
    Cell, Provenance, Report, Run, Table,
    devices::DeviceRow,
    render_report::{flux, method_name, photons, warnings},
};
use crate::{
    gpu::FrameTimes,
    passes::account::Account,
    renderer::{Energy, Job, Moved},
    stats,
};

/// The most frames of a sequence: numbers of six digits.
const MOST: f64 = 1e6;
/// Share of a frame by which rounding may make the last one: 0..1@3 has three.
const ROUNDING: f64 = 1e-9;
/// Decimals of milliseconds.
const MS: usize = 3;

/// Times from a first one on, up to a last one that is not among them, evenly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sequence {
    from_s: f64,
    to_s: f64,
    frames_a_second: f64,
}

impl FromStr for Sequence {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || "expected FROM..TO@FPS such as 0..2@30: seconds, and frames a second".to_owned();
        let (range, fps) = text.split_once('@').ok_or_else(expected)?;
        let (from, to) = range.split_once("..").ok_or_else(expected)?;
        let number = |text: &str| text.trim().parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(expected);
        let sequence = Self { from_s: number(from)?, to_s: number(to)?, frames_a_second: number(fps)? };
        match () {
            () if sequence.to_s <= sequence.from_s => {
                Err(format!("{to} s is not after {from} s; give the earlier first"))
            }
            () if sequence.frames_a_second <= 0.0 => Err(format!("{fps} frames a second are none; give more than 0")),
            () if sequence.exact() > MOST => Err(format!("more than {MOST} frames; give fewer a second, or less time")),
            () => Ok(sequence),
        }
    }
}

impl Sequence {
    /// All its times, s.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        (0..self.frames()).map(|k| self.time(k))
    }

    fn exact(&self) -> f64 {
        (self.to_s - self.from_s) * self.frames_a_second
    }

    /// How many frames; at least one.
    pub fn frames(&self) -> u32 {
        (self.exact() - ROUNDING).ceil().clamp(1.0, MOST) as u32
    }

    /// The time of a frame, s.
    pub fn time(&self, index: u32) -> f64 {
        self.from_s + f64::from(index) / self.frames_a_second
    }

    /// The name of a frame's files, without their endings.
    pub fn stem(&self, index: u32) -> String {
        let digits = (self.frames() - 1).to_string().len().max(4);
        format!("image.{index:0digits$}")
    }
}

/// A frame of a sequence: a line of `frames.jsonl`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SequenceFrame {
    /// Its number, from 0.
    pub index: u32,
    time_s: f64,
    /// By path, in the order of the frame.
    stages_ms: Map<String, Value>,
    span_ms: f64,
    wall_ms: f64,
    record_ms: f64,
    /// What moving the scene there took before, on the host.
    move_ms: f64,
    /// More changed than what buffers hold.
    planned_again: bool,
    /// Trees of deformed meshes that were fitted, and those that were built again.
    trees_refitted: u64,
    trees_rebuilt: u64,
    /// Of methods that shoot photons.
    photons: Option<Map<String, Value>>,
    flux_w: Option<Map<String, Value>>,
    deposited_w: Option<f64>,
    warnings: Vec<String>,
}

impl SequenceFrame {
    /// From what was measured; `moved` before and after the frame.
    pub fn new(
        (index, time_s): (u32, f64),
        (stages, times): (&[String], &FrameTimes),
        [before, after]: [Moved; 2],
        (account, energy): (&Account, &Energy),
        job: &Job,
    ) -> Self {
        let shoot = job.providers.shoot();
        let stages_ms = stages.iter().cloned().zip(times.passes.iter().map(|&ms| ms.into())).collect();
        Self {
            index,
            time_s,
            stages_ms,
            span_ms: times.span_ms,
            wall_ms: times.wall_ms,
            record_ms: times.record_ms,
            move_ms: if after.moves > before.moves { after.ms } else { 0.0 },
            planned_again: after.replans > before.replans,
            trees_refitted: after.refitted - before.refitted,
            trees_rebuilt: after.rebuilt - before.rebuilt,
            photons: shoot.then(|| photons(account)),
            flux_w: shoot.then(|| flux(account)),
            deposited_w: shoot.then_some(energy.deposited_w),
            warnings: warnings(account, job),
        }
    }

    /// Whether more changed before it than what buffers hold.
    pub fn was_planned_again(&self) -> bool {
        self.planned_again
    }
}

/// The result of a sequence.
#[derive(Debug, Serialize)]
pub struct SequenceReport {
    schema: &'static str,
    scene: String,
    method: String,
    camera: String,
    size: [u32; 2],
    sequence: Sequence,
    frames: u32,
    device: DeviceRow,
    /// Of the first frame.
    provenance: Provenance,
    run: Run,
    stages: Vec<Stage>,
    /// Frames before which more changed than what buffers hold.
    planned_again: usize,
    trees_refitted: u64,
    trees_rebuilt: u64,
    warnings: Vec<String>,
}

/// A stage over all frames that have it.
#[derive(Debug, Serialize)]
struct Stage {
    path: String,
    frames: usize,
    median_ms: f64,
    mad_ms: f64,
    most_ms: f64,
}

impl Stage {
    fn of(path: &str, samples: &[f64]) -> Self {
        Self {
            path: path.to_owned(),
            frames: samples.len(),
            median_ms: stats::median(samples),
            mad_ms: stats::mad(samples),
            most_ms: samples.iter().copied().fold(0.0, f64::max),
        }
    }
}

impl SequenceReport {
    /// From all frames of a sequence, whenever they were made.
    pub fn new(job: &Job, sequence: Sequence, frames: &[SequenceFrame], provenance: Provenance, run: Run) -> Self {
        let mut paths: Vec<&String> = Vec::new();
        let mut samples: BTreeMap<&String, Vec<f64>> = BTreeMap::new();
        for (path, ms) in frames.iter().flat_map(|frame| &frame.stages_ms) {
            if !samples.contains_key(path) {
                paths.push(path);
            }
            samples.entry(path).or_default().extend(ms.as_f64());
        }
        let mut stages: Vec<Stage> = paths.into_iter().map(|path| Stage::of(path, &samples[path])).collect();
        let each =
            |path: &str, ms: fn(&SequenceFrame) -> f64| Stage::of(path, &frames.iter().map(ms).collect::<Vec<_>>());
        stages.extend([
            each("frame/span", |f| f.span_ms),
            each("frame/wall", |f| f.wall_ms),
            each("frame/record", |f| f.record_ms),
            each("frame/move", |f| f.move_ms),
        ]);
        Self {
            schema: "nephroid.sequence/1",
            scene: job.scene.name.clone(),
            method: method_name(&job.providers),
            camera: job.camera.clone(),
            size: job.size,
            sequence,
            frames: frames.len() as u32,
            device: provenance.device().clone(),
            provenance,
            run,
            stages,
            planned_again: frames.iter().filter(|frame| frame.planned_again).count(),
            trees_refitted: frames.iter().map(|frame| frame.trees_refitted).sum(),
            trees_rebuilt: frames.iter().map(|frame| frame.trees_rebuilt).sum(),
            warnings: warned(frames),
        }
    }

    /// What a reader of the numbers must know.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

/// The first of each frame that has one, said once.
fn warned(frames: &[SequenceFrame]) -> Vec<String> {
    let warned: Vec<_> = frames.iter().filter_map(|frame| Some((frame.index, frame.warnings.first()?))).collect();
    let first =
        warned.first().map(|(index, text)| format!("{} of the frames, the first {index}: {text}", warned.len()));
    first.into_iter().collect()
}

impl Report for SequenceReport {
    fn heading(&self) -> Vec<String> {
        let [width, height] = self.size;
        let Sequence { from_s, to_s, frames_a_second } = self.sequence;
        let device = &self.device;
        vec![
            format!("{}, method {}, camera {}, {width}x{height} pixels", self.scene, self.method, self.camera),
            format!("{} frames from {from_s} to {to_s} s, {frames_a_second} a second", self.frames),
            format!("{} ({}), {}", device.name, device.kind, device.driver),
        ]
    }

    fn tables(&self) -> Vec<Table> {
        let ms = |ms| Cell::Real(ms, MS);
        let rows = self.stages.iter().map(|stage| {
            let counted = Cell::Count(stage.frames as u64);
            vec![Cell::text(&stage.path), counted, ms(stage.median_ms), ms(stage.mad_ms), ms(stage.most_ms)]
        });
        let columns = vec!["stage", "frames", "median ms", "MAD ms", "most ms"];
        vec![Table { name: "stages", columns, rows: rows.collect() }]
    }

    fn notes(&self) -> Vec<String> {
        let mut notes =
            vec!["frame/move: the scene brought to the frame's time, on the host, before its clock".to_owned()];
        if self.planned_again > 0 {
            notes.push(format!(
                "planned again before {} of the frames: more changed than what buffers hold",
                self.planned_again
            ));
        }
        if self.trees_refitted + self.trees_rebuilt > 0 {
            notes.push(format!(
                "trees of deformed meshes: {} fitted, {} built again",
                self.trees_refitted, self.trees_rebuilt
            ));
        }
        notes.extend(self.warnings.iter().map(|warning| format!("warning: {warning}")));
        if self.device.software {
            notes.push(format!("times: {} is a software device; they are no figures for a GPU", self.device.name));
        }
        notes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_has_its_first_time_and_not_its_last() {
        let times = |text: &str| {
            let sequence: Sequence = text.parse().unwrap();
            (0..sequence.frames()).map(|k| sequence.time(k)).collect::<Vec<_>>()
        };
        assert_eq!(times("0..1@4"), [0.0, 0.25, 0.5, 0.75]);
        assert_eq!(times("-0.5..0.5@2"), [-0.5, 0.0]);
        assert_eq!(times("1e6..1000000.1@1"), [1e6], "one at least");
        // Neither 0.1 nor 0.3 is a float64, and no fourth frame comes of it.
        assert_eq!((times("0..0.3@10").len(), times("0..2@30").len(), times("0..1@3").len()), (3, 60, 3));
    }

    #[test]
    fn what_is_no_range_is_refused_with_a_remedy() {
        for (text, words) in [
            ("2..1@30", "earlier first"),
            ("1..1@30", "earlier first"),
            ("0..1@0", "more than 0"),
            ("0..1@-3", "more than 0"),
            ("@0", "FROM..TO@FPS"),
            ("0..1", "FROM..TO@FPS"),
            ("0-1@30", "FROM..TO@FPS"),
            ("nan..1@30", "FROM..TO@FPS"),
            ("0..inf@30", "FROM..TO@FPS"),
            ("0..1@nan", "FROM..TO@FPS"),
            ("0..1e9@1000", "fewer a second"),
        ] {
            let error = text.parse::<Sequence>().unwrap_err();
            assert!(error.contains(words), "{text}: {error}");
        }
    }

    #[test]
    fn numbers_have_four_digits_or_as_many_as_needed() {
        let stem = |text: &str, index| text.parse::<Sequence>().unwrap().stem(index);
        assert_eq!((stem("0..1@8", 7), stem("0..1@20000", 7)), ("image.0007".to_owned(), "image.00007".to_owned()));
    }
}
