//! `nephroid truth`: a reference made, kept while it is made, and found again when it was made before.

use std::{
    fs,
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::atomic::Ordering::Relaxed,
    time::Instant,
};

use anyhow::anyhow;
use clap::Args;
use std::io::{ErrorKind, Write};

use super::{
    Failure,
    args::{parse_noise, parse_seconds, parse_set, parse_size, parse_time},
    output::{self, print, say},
    progress::TruthProgress,
    signals,
};
use crate::{
    image::{Layers, Provenance},
    lab::{LabError, SUMS, Sparing, TRUTHS},
    scene::{Camera, PathClass, Scene},
    store::{Key, Store},
    truth::{Estimator, Goal, Run, Standing, Task, trace::Space},
    whole::write_whole,
};

/// The noise asked for if nothing else is.
const DEFAULT_NOISE: f64 = 1e-4;

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
    /// Time, s: where the scene moves, it is traced as it is then
    #[arg(long, value_name = "T", default_value = "0", value_parser = parse_time, allow_negative_numbers = true)]
    time: f64,
    /// Seed of anything random
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Go on from FILE.partial, what a run that was stopped left behind
    #[arg(long)]
    resume: bool,
    /// Any value of the scene as scene.PATH=VALUE; repeatable
    #[arg(long, value_name = "scene.PATH=VALUE", value_parser = parse_scene_set)]
    set: Vec<(String, String)>,
    /// List the finished truths in the store, those of `compare --reference auto` too
    #[arg(long, exclusive = true)]
    list: bool,
    /// Remove the finished truths from the store, and what `compare --reference auto` keeps to go on from
    #[arg(long, exclusive = true)]
    clear: bool,
}

pub fn run(args: &TruthArgs) -> Result<(), Failure> {
    let store = Store::open();
    if args.list {
        return print(listing(&store).as_bytes());
    }
    if args.clear {
        let (truths, sums) = (store.clear(TRUTHS)?, store.clear(SUMS)?);
        let sums = if sums > 0 { format!(", and the sums of {sums}") } else { String::new() };
        return print(format!("{truths} removed{sums}\n").as_bytes());
    }
    let (Some(scene), Some(out)) = (&args.scene, &args.out) else { return Ok(()) };
    let scene = Scene::load(scene, &args.set)?.at(args.time);
    output::warn(&scene.warnings);
    let camera = scene.camera(&args.camera)?;
    let noise = args.until.or(args.photons.is_none().then_some(DEFAULT_NOISE));
    let goal = Goal { photons: args.photons, noise };
    let paths = args.paths.unwrap_or(scene.paths);
    let (estimator, camera_name) = (args.estimator, args.camera.clone());
    let task = Task { estimator, paths, camera: camera_name, size: args.size, seed: args.seed, goal };
    if out.is_dir() {
        return Err(Failure::usage(anyhow!("-o {}: a folder; name a file in it", out.display())));
    }
    let partial = Partial { file: partial(out), key: task.sums_key(&scene) };
    if let Some(bytes) = store.get(TRUTHS, &task.key(&scene)) {
        write_whole(out, |file| file.write_all(&bytes))?;
        partial.discard();
        say(&format!("written: {}, made before", out.display()));
        return Ok(());
    }
    let before = partial.before(args.resume)?;
    make(args, (&scene, camera, &task), &partial, before, (&store, out))
}

fn make(
    args: &TruthArgs,
    (scene, camera, task): (&Scene, &Camera, &Task),
    partial: &Partial,
    before: Option<Vec<u8>>,
    (store, out): (&Store, &Path),
) -> Result<(), Failure> {
    let (stop, started) = (signals::stop_flag()?, Instant::now());
    let goes_on = || if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let space = Space::new(scene);
    let mut progress = TruthProgress::new(args.max_seconds);
    let run = Run::watched(&space, camera, task, &mut |share| {
        progress.direct(share);
        goes_on()
    });
    let mut run = run.ok_or(LabError::Interrupted)?;
    if let Some(sums) = before {
        partial.hand(&sums, &mut run)?;
    }
    progress.start(run.standing().photons);
    let (mut failed, mut sparing) = (None, Sparing::default());
    let standing = run.advance(rayon::current_num_threads(), |run, standing| {
        progress.at(&standing);
        let late = args.max_seconds.is_some_and(|most| started.elapsed().as_secs_f64() >= most);
        let end = late || stop.load(Relaxed);
        if !standing.finished && (end || sparing.is_due()) {
            failed = sparing.keep(|| partial.write(run)).err();
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
    if standing.finished {
        // First of all: whatever happens to the file, the work is kept.
        store.put(TRUTHS, &task.key(scene), &bytes);
    }
    write_whole(out, |file| file.write_all(&bytes))?;
    if standing.finished {
        partial.discard();
    }
    warn(&run.provenance(), &standing);
    say(&summary(&standing, out, started));
    Ok(())
}

/// Share of the flux that cells may leave as points before it is worth a word.
const UNRESOLVED: f64 = 0.01;

/// What a user of the file should know.
fn warn(about: &Provenance, standing: &Standing) {
    if standing.noise == f64::INFINITY {
        say("warning: one chunk or grid knows no noise of its own: ask for more photons");
    }
    let unresolved = about.get("cells.unresolved").and_then(|share| share.parse::<f64>().ok()).unwrap_or(0.0);
    if unresolved > UNRESOLVED {
        let percent = 100.0 * unresolved;
        say(&format!(
            "warning: {percent:.1} % of the flux landed as points, in cells that could not be resolved: \
                      hold this against --estimator photons"
        ));
    }
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

    /// What an earlier run left, to go on from. Nothing is ever started over it.
    fn before(&self, resume: bool) -> Result<Option<Vec<u8>>, Failure> {
        let file = self.file.display();
        let bytes = match fs::read(&self.file) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => {
                if resume {
                    say(&format!("{file}: not there; starting anew"));
                }
                return Ok(None);
            }
            Err(error) => return Err(error.into()),
        };
        if !resume {
            let error = anyhow!("{file} holds what an earlier run has done: go on with --resume, or remove it");
            return Err(Failure::usage(error));
        }
        self.sums(&bytes).map(|sums| Some(sums.to_vec())).ok_or_else(|| self.foreign())
    }

    /// The sums in what a file holds, where they are whole and of this task.
    fn sums<'a>(&self, bytes: &'a [u8]) -> Option<&'a [u8]> {
        let (sum, sums) = bytes.split_at_checked(64)?;
        (self.checksum(sums).as_bytes() == sum).then_some(sums)
    }

    /// Removes the file once its task is finished: of no use to anyone then. One of another task stays.
    fn discard(&self) {
        if fs::read(&self.file).is_ok_and(|bytes| self.sums(&bytes).is_some()) {
            let _ = fs::remove_file(&self.file);
        }
    }

    /// Hands the sums to the run.
    fn hand(&self, sums: &[u8], run: &mut Run) -> Result<(), Failure> {
        if !run.resume(sums) {
            return Err(self.foreign());
        }
        say(&format!("going on after {} photons", run.standing().photons));
        Ok(())
    }

    fn foreign(&self) -> Failure {
        let what = "damaged, or of another task (scene, estimator, class, size, seed, --photons)";
        Failure::failed(anyhow!("{}: {what}: remove it to start anew, or name another file", self.file.display()))
    }

    fn checksum(&self, sums: &[u8]) -> String {
        Key::of([self.key.to_string().as_bytes(), sums]).to_string()
    }
}

fn listing(store: &Store) -> String {
    let row = |key: &Key| {
        let about = Layers::provenance_of_exr(&store.get(TRUTHS, key)?).ok()?;
        let of = |name: &str| about.get(name).map_or("?", String::as_str).to_owned();
        let names = ["scene.name", "estimator", "paths", "camera", "size", "seed", "photons", "noise.relmse"];
        Some(names.map(of).join("  "))
    };
    let rows = store.list(TRUTHS).into_iter().filter_map(|e| Some(format!("{}  {} bytes\n", row(&e.key)?, e.bytes)));
    "scene  estimator  paths  camera  size  seed  photons  noise\n".to_owned() + &rows.collect::<String>()
}

/// Settings other than the scene's mean nothing to the truth.
fn parse_scene_set(text: &str) -> Result<(String, String), String> {
    let (key, value) = parse_set(text)?;
    match key.strip_prefix("scene.") {
        Some(key) => Ok((key.to_owned(), value)),
        None => Err("the truth has no settings; only scene.PATH=VALUE".to_owned()),
    }
}
