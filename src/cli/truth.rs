//! `nephroid truth`: a reference made, kept while it is made, and found again when it was made before.

use std::{
    fs,
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::atomic::Ordering::Relaxed,
    time::Instant,
};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;

use super::{
    Failure,
    args::{parse_set, parse_size},
    output::{print, say},
    signals,
};
use crate::{
    image::Layers,
    lab::LabError,
    scene::{Camera, PathClass, Scene},
    store::{Key, Store},
    truth::{Estimator, Goal, Run, Standing, Task, trace::Space},
    whole::write_whole,
};

/// What finished truths are kept as in the store.
const KIND: &str = "truth";
/// The noise asked for if nothing else is.
const DEFAULT_NOISE: f64 = 1e-4;
/// The time between two checkpoints is this many times what writing one takes.
const SPARING: u32 = 20;

#[derive(Args)]
pub struct TruthArgs {
    /// A shipped scene by name, or the path of a .toml file
    #[arg(required_unless_present_any = ["list", "clear"])]
    scene: Option<String>,
    /// The file to write, OpenEXR
    #[arg(short, long = "out", value_name = "FILE", required_unless_present_any = ["list", "clear"])]
    out: Option<PathBuf>,
    /// `main`, `region` (the receiver region along its normal, specular objects hidden), or another of the scene's
    #[arg(long, value_name = "NAME", default_value = "main")]
    camera: String,
    /// photons: unbiased, with a variance; cells: light spread over where it lands, with no noise
    #[arg(long, value_name = "HOW", default_value_t)]
    estimator: Estimator,
    /// Which light paths are the caustic: reflect-1, transmit-1, transmit-2 or all:N [default: the scene's]
    #[arg(long, value_name = "CLASS")]
    paths: Option<PathClass>,
    /// Size of the picture, pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = parse_size)]
    size: [u32; 2],
    /// Finish after this many photons, rounded up to whole chunks; of cells, a grid of so many
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    photons: Option<u64>,
    /// Finish when the estimated noise of the caustic (of cells: the change by doubling the grid) is this low: relmse=X
    /// [default: relmse=1e-4 without --photons]
    #[arg(long, value_name = "relmse=X", value_parser = parse_noise)]
    until: Option<f64>,
    /// Stop after this time and write what there is; --resume goes on from there
    #[arg(long, value_name = "S", value_parser = parse_seconds)]
    max_seconds: Option<f64>,
    /// Seed of anything random
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Go on from FILE.partial, what a run that was stopped left behind
    #[arg(long)]
    resume: bool,
    /// Any value of the scene as scene.PATH=VALUE; repeatable
    #[arg(long, value_name = "scene.PATH=VALUE", value_parser = parse_scene_set)]
    set: Vec<(String, String)>,
    /// List the finished truths in the store
    #[arg(long, exclusive = true)]
    list: bool,
    /// Remove the finished truths from the store
    #[arg(long, exclusive = true)]
    clear: bool,
}

pub fn run(args: &TruthArgs) -> Result<(), Failure> {
    let store = Store::open();
    if args.list {
        return print(listing(&store).as_bytes());
    }
    if args.clear {
        let removed = store.clear(KIND)?;
        return print(format!("{removed} removed\n").as_bytes());
    }
    let (Some(scene), Some(out)) = (&args.scene, &args.out) else { return Ok(()) };
    let scene = Scene::load(scene, &args.set)?;
    let camera = scene.camera(&args.camera)?;
    let noise = args.until.or(args.photons.is_none().then_some(DEFAULT_NOISE));
    let goal = Goal { photons: args.photons, noise };
    let paths = args.paths.unwrap_or(scene.paths);
    let (estimator, camera_name) = (args.estimator, args.camera.clone());
    let task = Task { estimator, paths, camera: camera_name, size: args.size, seed: args.seed, goal };
    let key = task.key(&scene);
    if let Some(bytes) = store.get(KIND, &key) {
        write_whole(out, |file| file.write_all(&bytes))?;
        say(&format!("written: {}, made before", out.display()));
        return Ok(());
    }
    make(args, (&scene, camera, &task), Partial { file: partial(out), key }, &store, out)
}

fn make(
    args: &TruthArgs,
    (scene, camera, task): (&Scene, &Camera, &Task),
    partial: Partial,
    store: &Store,
    out: &Path,
) -> Result<(), Failure> {
    let (stop, started) = (signals::stop_flag()?, Instant::now());
    let space = Space::new(scene);
    let mut run = Run::new(&space, camera, task);
    if args.resume {
        say(&partial.read(&mut run));
    }
    let progress = Progress::new(args.max_seconds, run.standing().photons);
    let (mut failed, mut written) = (None, None::<(Instant, std::time::Duration)>);
    let standing = run.advance(rayon::current_num_threads(), |run, standing| {
        progress.at(&standing);
        let late = args.max_seconds.is_some_and(|most| started.elapsed().as_secs_f64() >= most);
        let end = standing.finished || late || stop.load(Relaxed);
        if end || written.is_none_or(|(at, took)| at.elapsed() >= SPARING * took) {
            let begun = Instant::now();
            failed = partial.write(run).err();
            written = Some((Instant::now(), begun.elapsed()));
        }
        if end || failed.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    drop(progress);
    if let Some(failure) = failed {
        return Err(failure);
    }
    if stop.load(Relaxed) && !standing.finished {
        say(&format!("kept: {}; the same command with --resume goes on", partial.file.display()));
        return Err(LabError::Interrupted.into());
    }
    let bytes = run.layers()?.to_exr(&run.provenance())?;
    write_whole(out, |file| file.write_all(&bytes))?;
    if standing.finished {
        store.put(KIND, &partial.key, &bytes);
        let _ = fs::remove_file(&partial.file); // of no use to anyone now
    }
    say(&summary(&standing, out, started));
    Ok(())
}

fn summary(standing: &Standing, out: &Path, started: Instant) -> String {
    let Standing { photons, noise, finished, .. } = standing;
    let early = if *finished { "" } else { "; not finished, --resume goes on" };
    let seconds = started.elapsed().as_secs_f64();
    format!("written: {}: {photons} photons, noise relmse {noise:.2e}, {seconds:.1} s{early}", out.display())
}

/// The file beside the output that holds the sums so far.
struct Partial {
    file: PathBuf,
    key: Key,
}

fn partial(out: &Path) -> PathBuf {
    let mut name = out.as_os_str().to_owned();
    name.push(".partial");
    name.into()
}

impl Partial {
    /// A checksum over task and sums, then the sums.
    fn write(&self, run: &Run) -> Result<(), Failure> {
        let sums = run.checkpoint();
        let sum = self.checksum(&sums);
        Ok(write_whole(&self.file, |file| file.write_all(sum.as_bytes()).and_then(|()| file.write_all(&sums)))?)
    }

    /// Hands the sums to the run if they are whole and of this task; what happened, in words.
    fn read(&self, run: &mut Run) -> String {
        let file = self.file.display();
        let Ok(bytes) = fs::read(&self.file) else { return format!("{file}: not there; starting anew") };
        let whole = bytes.split_at_checked(64).filter(|(sum, sums)| self.checksum(sums).as_bytes() == *sum);
        match whole {
            Some((_, sums)) if run.resume(sums) => format!("going on after {} photons", run.standing().photons),
            _ => format!("{file}: damaged, or of another task (scene, class, size, seed, goal); starting anew"),
        }
    }

    fn checksum(&self, sums: &[u8]) -> String {
        Key::of([self.key.to_string().as_bytes(), sums]).to_string()
    }
}

fn listing(store: &Store) -> String {
    let row = |key: &Key| {
        let (_, about) = Layers::from_exr(&store.get(KIND, key)?).ok()?;
        let of = |name: &str| about.get(name).map_or("?", String::as_str).to_owned();
        let names = ["scene.name", "estimator", "paths", "camera", "size", "seed", "photons", "noise.relmse"];
        Some(names.map(of).join("  "))
    };
    let rows = store.list(KIND).into_iter().filter_map(|e| Some(format!("{}  {} bytes\n", row(&e.key)?, e.bytes)));
    "scene  estimator  paths  camera  size  seed  photons  noise\n".to_owned() + &rows.collect::<String>()
}

/// A bar on stderr, on a terminal alone: how far, how noisy, how long still.
struct Progress {
    bar: ProgressBar,
    max_seconds: Option<f64>,
    /// Photons before this run.
    before: u64,
    started: Instant,
}

impl Progress {
    const STEPS: u64 = 1000;

    fn new(max_seconds: Option<f64>, before: u64) -> Self {
        let style = ProgressStyle::with_template("{msg} {wide_bar} {elapsed}");
        let bar = ProgressBar::new(Self::STEPS).with_message("direct light");
        let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar, max_seconds, before, started: Instant::now() }
    }

    fn at(&self, standing: &Standing) {
        let (done, missing) = (standing.photons as f64, standing.missing);
        let seconds = self.started.elapsed().as_secs_f64();
        let made = (standing.photons - self.before).max(1) as f64;
        let limit = self.max_seconds.map_or(f64::INFINITY, |most| (most - seconds).max(0.0));
        let left = (missing * seconds / made).min(limit);
        self.bar.set_position((done / (done + missing) * Self::STEPS as f64) as u64);
        self.bar.set_message(format!("{done:.3e} photons, noise relmse {:.2e}, {left:.0} s left", standing.noise));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn parse_noise(text: &str) -> Result<f64, String> {
    let value = text.strip_prefix("relmse=").and_then(|x| x.parse().ok());
    value.filter(|x: &f64| x.is_finite() && *x > 0.0).ok_or_else(|| "expected relmse=X with X above 0".to_owned())
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|s: &f64| s.is_finite() && *s >= 0.0);
    value.ok_or_else(|| "expected a number of seconds".to_owned())
}

/// Settings other than the scene's mean nothing to the truth.
fn parse_scene_set(text: &str) -> Result<(String, String), String> {
    let (key, value) = parse_set(text)?;
    match key.strip_prefix("scene.") {
        Some(key) => Ok((key.to_owned(), value)),
        None => Err("the truth has no settings; only scene.PATH=VALUE".to_owned()),
    }
}
