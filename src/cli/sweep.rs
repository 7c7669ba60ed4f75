//! `nephroid sweep`: many points rendered, timed and judged, in shards that may be killed.

use std::{
    io::Write,
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::atomic::Ordering::Relaxed,
    time::Duration,
};

use anyhow::anyhow;
use clap::{Args, Subcommand};

use super::{
    Failure,
    args::{DeviceArgs, ListArgs, parse_seconds},
    output::{print, say, warn},
    progress::CountProgress,
    signals,
};
use crate::{
    gpu::{Gpu, Sources},
    lab::{
        LabError, Report,
        sweep::{self, Bench, Host, Shard, State, Status, Sweep, SweepError},
    },
    whole::OutFolder,
};

/// Missing points that a message names.
const MOST_NAMED: usize = 5;

#[derive(Args)]
pub struct SweepArgs {
    #[command(subcommand)]
    command: SweepCommand,
}

#[derive(Subcommand)]
enum SweepCommand {
    /// Do what is missing of a sweep, or of a shard of it; the same command goes on where it was stopped
    Run(RunArgs),
    /// Say what is done and what is missing, by shard
    Status(StatusArgs),
    /// Write all points into points.jsonl and points.csv
    Merge(MergeArgs),
    /// Remove a sweep's points from the store
    Clean(FileArgs),
}

#[derive(Args)]
struct FileArgs {
    /// The sweep (scenes/sweeps/README.md says how one is written)
    #[arg(value_name = "FILE.toml")]
    file: String,
    #[command(flatten)]
    device: DeviceArgs,
}

#[derive(Args)]
struct RunArgs {
    #[command(flatten)]
    file: FileArgs,
    /// Do the I-th of N shards alone: every N-th point
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// The most time to wait, before a point is timed, until no other is worked on on this host, s; after it the point
    /// is timed beside the others, and marked as not alone
    #[arg(long, value_name = "S", default_value = "600", value_parser = parse_patience)]
    patience: Duration,
    #[command(flatten)]
    list: ListArgs,
}

#[derive(Args)]
struct StatusArgs {
    #[command(flatten)]
    file: FileArgs,
    /// Into how many shards the sweep is dealt
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    shards: u32,
    #[command(flatten)]
    list: ListArgs,
}

#[derive(Args)]
struct MergeArgs {
    #[command(flatten)]
    file: FileArgs,
    /// Write what is there, even where points are missing
    #[arg(long)]
    partial: bool,
    /// Folder for the results [default: out/sweeps/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn run(args: &SweepArgs) -> Result<(), Failure> {
    match &args.command {
        SweepCommand::Run(args) => work(args),
        SweepCommand::Status(args) => {
            let shards: Vec<Shard> =
                (0..args.shards as usize).map(|index| Shard { index, of: args.shards as usize }).collect();
            with_bench(&args.file, |bench| {
                let status = Status::new(bench, &shards);
                warn(&status.warnings);
                print(&status.write(args.list.format)?)
            })
        }
        SweepCommand::Merge(args) => with_bench(&args.file, |bench| merge(args, bench)),
        SweepCommand::Clean(args) => with_bench(args, |bench| {
            let removed = bench.clean()?;
            say(&format!("removed: {removed} of {} points", bench.sweep.count()));
            Ok(())
        }),
    }
}

fn with_bench(args: &FileArgs, then: impl FnOnce(&Bench) -> Result<(), Failure>) -> Result<(), Failure> {
    let sweep = Sweep::load(&args.file)?;
    let store = sweep::store()?;
    let gpu = Gpu::new(&args.device.options())?;
    then(&Bench { sweep: &sweep, gpu: &gpu, sources: Sources::default(), store })
}

fn work(args: &RunArgs) -> Result<(), Failure> {
    let stop = signals::stop_flag()?;
    let go_on = || if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    with_bench(&args.file, |bench| {
        let folder = bench.store.folder().unwrap_or(Path::new(""));
        let host = Host::new(folder).map_err(|reason| SweepError::Store { path: folder.to_owned(), reason })?;
        say(&format!("device: {}", bench.gpu.info().label()));
        let shard = args.shard.unwrap_or(Shard::WHOLE);
        let points: Vec<usize> = shard.points(bench.sweep.count()).collect();
        let progress = CountProgress::new(points.len() as u32);
        for (done, &at) in points.iter().enumerate() {
            let words = bench.sweep.words(at);
            progress.at(done, &words);
            match bench.state(at) {
                State::Done(_) => continue,
                State::Unusable(why) => progress.say(&format!("warning: {why}, and is done again")),
                State::Failed(_) | State::Missing => {}
            }
            match bench.work(at, &host, args.patience, &go_on) {
                Ok(None) => {}
                Ok(Some(reason)) => progress.say(&format!("failed: {words}: {reason}")),
                Err(SweepError::Lab(LabError::Interrupted)) => {
                    let (all, kept) = (points.len(), "what is done is kept, and the same command goes on");
                    return Err(Failure::interrupted(anyhow!("interrupted after {done} of {all} points: {kept}")));
                }
                Err(error) => return Err(error.into()),
            }
        }
        drop(progress);
        let status = Status::new(bench, &[shard]);
        print(&status.write(args.list.format)?)?;
        match status.failures() {
            0 => Ok(()),
            failed => Err(Failure::failed(anyhow!("{failed} of {} points failed, see above", points.len()))),
        }
    })
}

fn merge(args: &MergeArgs, bench: &Bench) -> Result<(), Failure> {
    let out = args.out.clone().unwrap_or_else(|| Path::new("out/sweeps").join(&bench.sweep.name));
    let merged = sweep::merge(bench);
    warn(&merged.warnings);
    let (missing, all) = (merged.missing.len(), bench.sweep.count());
    if missing > 0 {
        let mut named: Vec<&str> = merged.missing.iter().take(MOST_NAMED).map(String::as_str).collect();
        let more = format!("and {} more", missing.saturating_sub(MOST_NAMED));
        named.extend((missing > MOST_NAMED).then_some(more.as_str()));
        let what = format!("{missing} of {all} points are missing: {}", named.join("; "));
        if !args.partial {
            let file = &bench.sweep.file;
            return Err(Failure::failed(anyhow!("{what}\nrun `nephroid sweep run {file}`, or merge with --partial")));
        }
        warn(&[what]);
    }
    if merged.failed > 0 {
        warn(&[format!("{} of {all} points failed: their lines have `failed` in the place of figures", merged.failed)]);
    }
    let mut folder = OutFolder::stage(&out)?;
    let csv = merged.csv()?;
    folder.write("points.jsonl", |file| file.write_all(merged.json_lines().as_bytes()))?;
    folder.write("points.csv", |file| file.write_all(&csv))?;
    folder.commit()?;
    say(&format!("written: {}", out.display()));
    Ok(())
}

fn parse_patience(text: &str) -> Result<Duration, String> {
    let seconds = parse_seconds(text)?;
    Duration::try_from_secs_f64(seconds).map_err(|error| error.to_string())
}
