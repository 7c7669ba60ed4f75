//! `nephroid budget`: where a method's error comes from.

use std::{ops::ControlFlow, path::PathBuf, sync::atomic::Ordering::Relaxed};

use anyhow::anyhow;
use clap::Args;

use super::{
    Failure,
    args::{DeviceArgs, ListArgs, parse_noise, parse_seconds, parse_set, parse_size, scene_and_settings},
    output::{print, say, warn},
    progress::TruthProgress,
    render::{arguments, refuse_messages},
    signals,
};
use crate::{
    gpu::{Gpu, GpuOptions},
    lab::{
        self, Provenance, Report,
        budget::{Budget, BudgetReport, Progress, write_budget},
    },
    methods::{self, Method},
    names::NoSuch,
    renderer::{Frame, Job, Providers},
    scene::PathClass,
    store::Store,
    truth::Goal,
    whole::OutFolder,
};

/// Of each truth, as relMSE.
const NOISE: f64 = 1e-4;
/// s
const MAX_SECONDS: f64 = 120.0;

#[derive(Args)]
pub struct BudgetArgs {
    /// A shipped scene by name, or the path of a .toml file
    scene: String,
    /// The method
    #[arg(long, value_name = "M", value_parser = parse_method)]
    method: Budgeted,
    /// A setting (`nephroid methods` lists them), or any value of the scene as scene.PATH=VALUE; repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = parse_set)]
    set: Vec<(String, String)>,
    /// Size of the pictures of the region, pixels
    #[arg(long, value_name = "WxH", default_value = "128x128", value_parser = parse_size)]
    size: [u32; 2],
    /// Light samples along each side of the fine grid
    #[arg(long, value_name = "N", default_value_t = 2048, value_parser = clap::value_parser!(u32).range(1..))]
    fine: u32,
    /// What stands for all paths: every chain of 1 to N specular events
    #[arg(long, value_name = "all:N", default_value = "all:8")]
    all: PathClass,
    /// Each truth is done when its noise is at most this [default: relmse=1e-4]
    #[arg(long, value_name = "relmse=X", value_parser = parse_noise)]
    until: Option<f64>,
    /// Each truth is done after so many photons
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    photons: Option<u64>,
    /// The most time for each truth; its noise is then what it is
    #[arg(long, value_name = "S", default_value_t = MAX_SECONDS, value_parser = parse_seconds)]
    max_seconds: f64,
    /// Seed of the truths' photons
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    device: DeviceArgs,
    /// Run under the validation layers; any message is a failure
    #[arg(long)]
    validation: bool,
    #[command(flatten)]
    list: ListArgs,
    /// Folder for budget.json, budget.exr, and a picture of each picture and step; made where it is missing
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

#[derive(Clone)]
struct Budgeted(&'static dyn Method);

fn parse_method(name: &str) -> Result<Budgeted, NoSuch> {
    methods::find(name).map(Budgeted)
}

pub fn run(args: &BudgetArgs) -> Result<(), Failure> {
    let (scene, settings) = scene_and_settings(&args.scene, &args.set)?;
    if !matches!(args.all, PathClass::All(_)) {
        return Err(Failure::usage(anyhow!(
            "--all {}: expected all:N, every chain of 1 to N specular events",
            args.all
        )));
    }
    let method = args.method.0;
    let (camera, providers) = ("region".to_owned(), Providers::of(method));
    let job = Job { scene, providers, settings, camera, size: args.size };
    warn(&job.scene.warnings);
    let stop = signals::stop_flag()?;
    let folder = args.out.as_deref().map(OutFolder::stage).transpose()?;
    let gpu = Gpu::new(&GpuOptions { validation: args.validation, ..args.device.options() })?;
    say(&format!("device: {}", gpu.info().label()));
    let noise = args.until.or(args.photons.is_none().then_some(NOISE));
    let goal = Goal { photons: args.photons, noise };
    let budget = Budget { fine: args.fine, all: args.all, goal, seconds: args.max_seconds, seed: args.seed };
    let bar = TruthProgress::new(Some(args.max_seconds));
    let chain = budget.chain(&gpu, &job, method, &Store::open(), &mut |progress| {
        match progress {
            Progress::Begun(picture) => bar.say(picture),
            Progress::Truth(standing) => standing.iter().for_each(|standing| bar.at(standing)),
        }
        if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    drop(bar);
    let chain = chain?;
    refuse_messages(&gpu)?;
    let provenance = Provenance::new(&job, &Frame::default(), gpu.info(), arguments(std::env::args_os(), "--out"));
    let report = BudgetReport::new(&budget, &job, method.name(), &chain, provenance);
    if let (Some(mut folder), Some(place)) = (folder, &args.out) {
        write_budget(&mut folder, &report, &chain, lab::exposure(&job.settings, &job.scene))?;
        folder.commit()?;
        say(&format!("written: {}", place.display()));
    }
    print(&report.write(args.list.format)?)
}
