//! `nephroid render --sequence`: frames at their times, each written as soon as it is there; the same command goes on where
//! it was left.

use std::{
    fs::{self, File, OpenOptions},
    io::Write,
    path::Path,
    sync::atomic::{AtomicBool, Ordering::Relaxed},
};

use super::{
    Failure,
    args::RenderArgs,
    output::{print, say, warn},
    progress::CountProgress,
    render::{arguments, open, refuse_messages, with_remedy},
    signals,
};
use crate::{
    gpu::{Gpu, Sources},
    image::{self, Layers},
    lab::{self, LabError, Provenance, Report, Run, Sequence, SequenceFrame, SequenceReport},
    renderer::{self, Frame, Job, Renderer},
    whole::{FileError, OutFolder, write_whole},
};

/// A line for each frame that is whole.
const LINES: &str = "frames.jsonl";

/// A sequence and all that its frames have in common.
struct Making<'a> {
    args: &'a RenderArgs,
    job: &'a Job,
    sequence: Sequence,
    gpu: &'a Gpu,
}

/// Whatever can be found wrong is found before the first frame.
pub fn run(args: &RenderArgs, sequence: Sequence) -> Result<(), Failure> {
    let job = args.job.job()?;
    if !job.scene.moves() {
        let remedy = "give an object or a light `motion`, or leave `--sequence` out";
        warn(&[format!("nothing in {} moves, and all frames are one picture; {remedy}", job.scene.name)]);
    }
    let planned = renderer::plan(&job)?;
    let stop = signals::stop_flag()?;
    drop(OutFolder::stage(&args.out)?); // it can be written to
    let run = Run::now(&args.out);
    let gpu = open(args)?;
    say(&format!("device: {}", gpu.info().label()));
    let making = Making { args, job: &job, sequence, gpu: &gpu };
    let mut frames = making.made_before();
    let count = sequence.frames();
    if (frames.len() as u32) < count {
        let mut renderer =
            Renderer::planned(&gpu, &job, planned, Sources::default()).map_err(|error| with_remedy(error, &job))?;
        making.make(&mut renderer, &mut frames, &stop)?;
    }
    refuse_messages(&gpu)?;
    let report = SequenceReport::new(&job, sequence, &frames, making.provenance(0), run);
    let mut folder = OutFolder::stage(&args.out)?;
    lab::write_result(&mut folder, &report)?;
    folder.commit()?;
    warn(&job.scene.warnings);
    warn(report.warnings());
    say(&format!("written: {}, {count} frames", args.out.display()));
    print(&report.write(args.list.format)?)
}

impl Making<'_> {
    fn frame(&self, index: u32) -> Frame {
        Frame { time: self.sequence.time(index), index, seed: self.args.seed, camera: None }
    }

    fn provenance(&self, index: u32) -> Provenance {
        let typed = arguments(std::env::args_os(), "--out");
        Provenance::new(self.job, &self.frame(index), self.gpu.info(), typed)
    }

    /// Frames of an earlier run of this very command that are whole.
    fn made_before(&self) -> Vec<SequenceFrame> {
        let text = fs::read_to_string(self.args.out.join(LINES)).unwrap_or_default();
        let lines = text.lines().filter_map(|line| serde_json::from_str::<SequenceFrame>(line).ok());
        let mut frames: Vec<_> =
            lines.filter(|frame| frame.index < self.sequence.frames() && self.is_whole(frame.index)).collect();
        frames.sort_by_key(|frame| frame.index);
        frames.dedup_by_key(|frame| frame.index);
        if !frames.is_empty() {
            say(&format!("{} of {} frames were made before", frames.len(), self.sequence.frames()));
        }
        frames
    }

    /// Whether both of its files are there, can be read, and say what this run would.
    fn is_whole(&self, index: u32) -> bool {
        let place = |ending: &str| self.args.out.join(format!("{}.{ending}", self.sequence.stem(index)));
        let read = fs::read(place("exr")).ok().and_then(|bytes| Layers::from_exr(&bytes).ok());
        let same = |about: &image::Provenance| *about == self.provenance(index).attributes();
        fs::metadata(place("png")).is_ok_and(|png| png.len() > 0) && read.is_some_and(|(_, about)| same(&about))
    }

    /// Makes what is missing; those that are there stay, whatever ends it.
    fn make(&self, renderer: &mut Renderer, frames: &mut Vec<SequenceFrame>, stop: &AtomicBool) -> Result<(), Failure> {
        let count = self.sequence.frames();
        let progress = CountProgress::new(count);
        let missing: Vec<u32> = (0..count).filter(|k| frames.iter().all(|frame| frame.index != *k)).collect();
        for index in missing.iter().take(1) {
            (0..self.args.warmup).try_for_each(|_| renderer.frame(&self.frame(*index)).map(drop))?;
        }
        let mut lines = None;
        for index in missing {
            if stop.load(Relaxed) {
                return Err(LabError::Stopped { done: frames.len(), count: count as usize }.into());
            }
            progress.at(frames.len(), &format!("frame {index}"));
            let made = self.one(renderer, index)?;
            if made.was_planned_again() {
                progress.say(&format!("frame {index}: planned again, more changed than what buffers hold"));
            }
            let file = match &mut lines {
                Some(file) => file,
                none => none.insert(self.lines_of(frames)?),
            };
            let line = serde_json::to_string(&made).map_err(std::io::Error::other)? + "\n";
            file.write_all(line.as_bytes())?;
            frames.push(made);
        }
        frames.sort_by_key(|frame| frame.index);
        // In their order, and nothing else.
        drop(lines);
        self.lines_of(frames).map(drop)
    }

    /// Renders a frame, counts its light, and writes its two files.
    fn one(&self, renderer: &mut Renderer, index: u32) -> Result<SequenceFrame, Failure> {
        let (frame, before) = (self.frame(index), renderer.moved());
        let times = renderer.frame(&frame)?;
        let moved = [before, renderer.moved()];
        let account = renderer.account()?;
        let (energy, layers) = (renderer.energy(&account)?, renderer.layers()?);
        refuse_messages(self.gpu)?;
        let mut folder = OutFolder::stage(&self.args.out)?;
        let exposure = lab::exposure(&self.job.settings, &self.job.scene);
        let attributes = self.provenance(index).attributes();
        lab::write_pictures(&mut folder, &self.sequence.stem(index), &layers, exposure, &attributes)?;
        folder.commit()?;
        Ok(SequenceFrame::new((index, frame.time), (&renderer.stages(), &times), moved, (&account, &energy), self.job))
    }

    /// The file of lines with those of `frames` in it, to add to.
    fn lines_of(&self, frames: &[SequenceFrame]) -> Result<File, Failure> {
        let place = self.args.out.join(LINES);
        let text = frames.iter().map(|frame| serde_json::to_string(frame).map(|line| line + "\n"));
        let text = text.collect::<Result<String, _>>().map_err(std::io::Error::other)?;
        write(&place, &text)?;
        Ok(OpenOptions::new().append(true).open(place)?)
    }
}

fn write(place: &Path, text: &str) -> Result<(), FileError> {
    write_whole(place, |out| out.write_all(text.as_bytes()))
}
