//! `nephroid tracers`: every tracer against exact intersection.

use std::{io::Write, ops::ControlFlow, path::PathBuf, sync::atomic::Ordering::Relaxed};

use anyhow::anyhow;
use clap::Args;

use super::{
    Failure,
    args::{DeviceArgs, ListArgs, parse_set, scene_and_settings},
    output::{print, say},
    render::{arguments, refuse_messages},
    signals,
};
use crate::{
    gpu::{Gpu, GpuOptions},
    lab::{self, Compared, Format, Provenance, Report, Subject, TracersReport},
    methods::maps,
    passes::light::{self, SIDE, TRACER},
    renderer::{Frame, Job, Providers},
    whole::OutFolder,
};

#[derive(Args)]
pub struct TracersArgs {
    /// A shipped scene by name, or the path of a .toml file
    scene: String,
    /// A setting but light.tracer, or any value of the scene as scene.PATH=VALUE; repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = parse_set)]
    set: Vec<(String, String)>,
    #[command(flatten)]
    device: DeviceArgs,
    /// Timed frames of each tracer
    #[arg(long, value_name = "R", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..))]
    repeat: u32,
    /// Run under the validation layers; any message is a failure, and times mean nothing
    #[arg(long)]
    validation: bool,
    #[command(flatten)]
    list: ListArgs,
    /// Folder for `tracers.json` and a picture of each tracer's error; made where it is missing
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn run(args: &TracersArgs) -> Result<(), Failure> {
    if args.set.iter().any(|(key, _)| key == TRACER.key) {
        return Err(Failure::usage(anyhow!("--set {}: every tracer is run; leave it out", TRACER.key)));
    }
    let (scene, settings) = scene_and_settings(&args.scene, &args.set)?;
    let class = light::paths(&scene, &settings);
    let job = Job { scene, providers: Providers::default(), settings, camera: "region".to_owned(), size: [1, 1] };
    let stop = signals::stop_flag()?;
    let folder = args.out.as_deref().map(OutFolder::stage).transpose()?;
    let gpu = Gpu::new(&GpuOptions { validation: args.validation, ..args.device.options() })?;
    say(&format!("device: {}", gpu.info().label()));
    let map_texel = job.scene.region.area().sqrt() / f64::from(job.settings.whole(&maps::SIDE));
    let compared = lab::compare_tracers(&gpu, &job, args.repeat, map_texel, &mut |tracer| {
        say(&format!("tracing with {tracer}"));
        if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    refuse_messages(&gpu)?;
    let subject = Subject {
        scene: job.scene.name.clone(),
        class: class.to_string(),
        side: job.settings.whole(&SIDE),
        map_texel,
        frames: args.repeat,
    };
    let provenance = Provenance::new(&job, &Frame::default(), gpu.info(), arguments(std::env::args_os(), "--out"));
    let report = TracersReport::new(subject, &compared, provenance);
    if let (Some(folder), Some(place)) = (folder, &args.out) {
        write(folder, &report, &compared)?;
        say(&format!("written: {}", place.display()));
    }
    print(&report.write(args.list.format)?)
}

fn write(mut folder: OutFolder, report: &TracersReport, compared: &[Compared]) -> Result<(), Failure> {
    let json = report.write(Format::Json)?;
    folder.write("tracers.json", |out| out.write_all(&json))?;
    for compared in compared.iter().filter(|compared| !compared.verdicts.is_empty()) {
        let bytes = lab::tracer_map(compared)?;
        folder.write(&format!("{}.png", compared.tracer), |out| out.write_all(&bytes))?;
    }
    Ok(folder.commit()?)
}
