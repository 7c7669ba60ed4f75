//! Times of the frames shown: the dearest stages for the title, medians of all for the end.

use std::collections::VecDeque;

use serde::Serialize;

use crate::{
    gpu::{FrameTimes, SHOW},
    lab::{Cell, DeviceRow, Report, Table},
    stats,
};

/// Frames that the title speaks of.
const RECENT: usize = 16;
/// Stages that the title names.
const DEAREST: usize = 3;
/// Frames kept where nobody said how many there will be.
const KEPT: usize = 256;

/// Samples of every stage, the newest last.
pub(super) struct Times {
    stages: Vec<String>,
    frames: VecDeque<Vec<f64>>,
    keep: usize,
}

impl Times {
    /// For the stages of a plan; `keep` frames, or some.
    pub fn new(stages: Vec<String>, keep: Option<u32>) -> Self {
        let keep = keep.map_or(KEPT, |frames| frames as usize);
        let last = [SHOW, "frame/span", "frame/wall"].map(str::to_owned);
        let stages = stages.into_iter().chain(last).collect();
        Self { stages, frames: VecDeque::new(), keep }
    }

    /// Adds a frame and what showing it took.
    pub fn add(&mut self, frame: &FrameTimes, show_ms: f64) {
        if self.frames.len() >= self.keep {
            self.frames.pop_front();
        }
        self.frames.push_back(frame.passes.iter().copied().chain([show_ms, frame.span_ms, frame.wall_ms]).collect());
    }

    /// The median of the last frames, and the stages that took most of it.
    pub fn title(&self) -> String {
        let first = self.frames.len().saturating_sub(RECENT);
        let medians: Vec<_> = (0..self.stages.len()).map(|stage| stats::median(&self.column(stage, first))).collect();
        let Some((frame, stages)) = medians.split_last().filter(|_| !self.frames.is_empty()) else {
            return "no frame yet".to_owned();
        };
        // Of the others, the last is their span.
        let mut dearest: Vec<_> = stages[..stages.len() - 1].iter().zip(&self.stages).collect();
        dearest.sort_by(|a, b| b.0.total_cmp(a.0));
        let dearest: Vec<_> = dearest.iter().take(DEAREST).map(|(ms, stage)| format!("{stage} {ms:.1}")).collect();
        format!("{frame:.1} ms: {}", dearest.join(", "))
    }

    /// Medians of all frames kept.
    pub fn watched(&self, heading: String, device: DeviceRow) -> Watched {
        let rows = self.stages.iter().enumerate().map(|(at, stage)| {
            let samples = self.column(at, 0);
            StageTime { stage: stage.clone(), median_ms: stats::median(&samples), mad_ms: stats::mad(&samples) }
        });
        let stages = if self.frames.is_empty() { Vec::new() } else { rows.collect() };
        Watched { schema: SCHEMA, heading, device, frames: self.frames.len(), stages }
    }

    fn column(&self, stage: usize, first: usize) -> Vec<f64> {
        self.frames.iter().skip(first).filter_map(|frame| frame.get(stage).copied()).collect()
    }
}

const SCHEMA: &str = "nephroid.view/1";

/// What was watched, and how long it took.
#[derive(Clone, Debug, Serialize)]
pub struct Watched {
    schema: &'static str,
    heading: String,
    device: DeviceRow,
    frames: usize,
    stages: Vec<StageTime>,
}

#[derive(Clone, Debug, Serialize)]
struct StageTime {
    stage: String,
    median_ms: f64,
    mad_ms: f64,
}

impl Report for Watched {
    fn heading(&self) -> Vec<String> {
        let device = &self.device;
        let on = format!("{} ({}), {}, {} timed frames", device.name, device.kind, device.driver, self.frames);
        vec![self.heading.clone(), on]
    }

    fn tables(&self) -> Vec<Table> {
        let row = |s: &StageTime| vec![Cell::text(&s.stage), Cell::Real(s.median_ms, 3), Cell::Real(s.mad_ms, 3)];
        let columns = vec!["stage", "median ms", "MAD ms"];
        vec![Table { name: "stages", columns, rows: self.stages.iter().map(row).collect() }]
    }

    fn notes(&self) -> Vec<String> {
        let device = &self.device;
        let note = format!("times: {} is a software device; they are no figures for a GPU", device.name);
        if device.software { vec![note] } else { Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(passes: [f64; 4]) -> FrameTimes {
        FrameTimes { passes: passes.to_vec(), span_ms: passes.iter().sum(), wall_ms: 20.0, record_ms: 0.1 }
    }

    #[test]
    fn the_title_names_the_dearest_stages_of_the_last_frames() {
        let mut times = Times::new(["a", "b", "c", "d"].map(str::to_owned).to_vec(), None);
        assert_eq!(times.title(), "no frame yet");
        times.add(&frame([900.0; 4]), 0.5);
        (0..40).for_each(|_| times.add(&frame([1.0, 4.0, 2.0, 3.0]), 2.5));
        assert_eq!(times.title(), "20.0 ms: b 4.0, d 3.0, window/show 2.5");
    }

    #[test]
    fn only_so_many_frames_are_kept() {
        let mut times = Times::new(vec!["a".into()], Some(3));
        for ms in [9.0, 1.0, 2.0, 3.0] {
            times.add(&FrameTimes { passes: vec![ms], ..Default::default() }, 0.0);
        }
        assert_eq!(times.column(0, 0), [1.0, 2.0, 3.0]);
    }
}
