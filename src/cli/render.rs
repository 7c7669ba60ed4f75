//! `nephroid render`: a job measured, and its files written whole or not at all.

use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicBool, Ordering::Relaxed},
    time::Instant,
};

use anyhow::{Context, anyhow};

use super::{
    Failure,
    args::RenderArgs,
    output::{print, say, warn},
    progress::Progress,
    sequence, signals,
};
use crate::{
    gpu::{Gpu, GpuError, GpuOptions, Plan, Sources},
    lab::{self, Experiment, Measured, Provenance, RenderReport, Report, Run},
    passes::eye,
    renderer::{self, Frame, Job, Planned, RenderError, Renderer},
    whole::OutFolder,
};

/// Whatever can be found wrong is found before the first frame: options, scene, plan, dumps, folder, device, in this order.
pub fn run(args: &RenderArgs, started: Instant) -> Result<(), Failure> {
    if let Some(sequence) = args.sequence {
        return sequence::run(args, sequence);
    }
    let job = args.job.job()?;
    if args.time != 0.0 && !job.scene.moves() {
        warn(&[format!("nothing in {} moves: it is at {} s what it is at 0", job.scene.name, args.time)]);
    }
    let planned = renderer::plan(&job)?;
    check_dumps(&args.dump, &planned.plan)?;
    // From here on there is something to take back.
    let stop = signals::stop_flag()?;
    let mut folder = OutFolder::stage(&args.out)?;
    let run = Run::now(&args.out);
    let gpu = open(args)?;
    say(&format!("device: {}", gpu.info().label()));
    let frame = Frame { time: args.time, index: 0, seed: args.seed, camera: None };
    let experiment = Experiment { frame, warmup: args.warmup, repeat: args.repeat };
    let (renderer, measured, startup_ms) = measure(&gpu, &job, planned, &experiment, (started, &stop))?;
    let provenance = Provenance::new(&job, &frame, gpu.info(), arguments(std::env::args_os(), "--out"));
    let attributes = provenance.attributes();
    let report = RenderReport::new(&job, &renderer, &measured, startup_ms, provenance, run);
    warn(report.warnings());
    lab::write_outputs(&mut folder, &report, &measured.layers, lab::exposure(&job.settings, &job.scene), &attributes)?;
    for name in &args.dump {
        lab::write_dump(&mut folder, &renderer, name, &attributes)?;
    }
    refuse_messages(&gpu)?;
    folder.commit()?;
    say(&format!("written: {}", args.out.display()));
    print(&report.write(args.list.format)?)
}

pub(super) fn open(args: &RenderArgs) -> Result<Gpu, Failure> {
    Ok(Gpu::new(&GpuOptions { validation: args.validation, capture: args.capture, ..args.device.options() })?)
}

/// Prepares and runs the experiment under a bar; also says how long it took to get ready, ms.
fn measure(
    gpu: &Gpu,
    job: &Job,
    planned: Planned,
    experiment: &Experiment,
    (started, stop): (Instant, &AtomicBool),
) -> Result<(Renderer, Measured, f64), Failure> {
    let progress = Progress::new(experiment);
    let mut renderer =
        Renderer::planned(gpu, job, planned, Sources::default()).map_err(|error| with_remedy(error, job))?;
    let startup_ms = started.elapsed().as_secs_f64() * 1e3;
    let measured = experiment.run(&mut renderer, &mut |step| {
        progress.at(step);
        if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    Ok((renderer, measured, startup_ms))
}

fn check_dumps(names: &[String], plan: &Plan) -> Result<(), Failure> {
    let check = |name: &String| renderer::resource(plan, name).map(drop);
    names.iter().try_for_each(check).context("--dump").map_err(Failure::usage)
}

/// What does not fit is said with the options that make it as large as it is.
pub(super) fn with_remedy(error: RenderError, job: &Job) -> Failure {
    let RenderError::Gpu(GpuError::TooLarge { name, .. }) = &error else { return error.into() };
    let options = options_of(name.split('/').next().unwrap_or_default(), job);
    Failure::usage(anyhow!("{error}; lower {options}"))
}

/// The options that size the resources of a group, with their values.
fn options_of(group: &str, job: &Job) -> String {
    let now = |key: &str| {
        let known = renderer::all_settings();
        known.iter().find(|s| s.key() == key).map(|s| format!("--set {key} (now {})", job.settings.text(*s)))
    };
    if group == "eye" {
        let [width, height] = job.size;
        let (key, samples) = (eye::SAMPLES.key, job.eye_samples());
        return format!("--size (now {width}x{height}) or --set {key} (now {samples})");
    }
    now(&format!("{group}.side")).unwrap_or_else(|| "the number of triangles in the scene".to_owned())
}

pub(super) fn refuse_messages(gpu: &Gpu) -> Result<(), Failure> {
    match gpu.take_messages().as_slice() {
        [] => Ok(()),
        messages => Err(Failure::failed(anyhow!("validation: {}", messages.join("\nvalidation: ")))),
    }
}

/// The arguments without the program and without where it writes to, which may differ where results do not.
pub(super) fn arguments(all: impl Iterator<Item = std::ffi::OsString>, out: &str) -> Vec<String> {
    let mut kept = Vec::new();
    let mut all = all.skip(1).map(|argument| argument.to_string_lossy().into_owned());
    while let Some(argument) = all.next() {
        if argument == out {
            all.next();
        } else if !argument.starts_with(&format!("{out}=")) {
            kept.push(argument);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::arguments;

    #[test]
    fn arguments_do_not_name_the_output() {
        let given = |line: &str| arguments(line.split(' ').map(Into::into), "--out");
        assert_eq!(given("nephroid render null --out a --seed 1"), ["render", "null", "--seed", "1"]);
        assert_eq!(given("nephroid render --out=a null"), ["render", "null"]);
    }
}
