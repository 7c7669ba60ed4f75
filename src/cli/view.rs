//! `nephroid view`: a job in a window.

use std::path::PathBuf;

use clap::Args;

use super::{
    Failure,
    args::{DeviceArgs, JobArgs, ListArgs},
    output::{print, say, warn},
    render::arguments,
};
use crate::{
    gpu::GpuOptions,
    lab::{self, Report},
    renderer,
    window::{self, Viewing},
};

#[derive(Args)]
pub struct ViewArgs {
    #[command(flatten)]
    job: JobArgs,
    #[command(flatten)]
    device: DeviceArgs,
    /// Close after N timed frames and print the medians of their stages; the first frame of a plan is not timed
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// Write what the window shows in the end, as PNG
    #[arg(long, value_name = "FILE")]
    screenshot: Option<PathBuf>,
    /// Run under the validation layers; any message is a failure, and times mean nothing
    #[arg(long)]
    validation: bool,
    #[command(flatten)]
    list: ListArgs,
}

/// What can be found wrong without a window is found before it opens.
pub fn run(args: &ViewArgs) -> Result<(), Failure> {
    let job = args.job.job()?;
    renderer::plan(&job)?;
    warn(&job.scene.warnings);
    let gpu = GpuOptions { validation: args.validation, ..args.device.options() };
    let ev = lab::exposure(&job.settings, &job.scene);
    let arguments = arguments(std::env::args_os(), "--screenshot");
    let viewing = Viewing { gpu, frames: args.frames, screenshot: args.screenshot.clone(), arguments, ev, say };
    let watched = window::view(job, viewing)?;
    args.screenshot.iter().for_each(|path| say(&format!("written: {}", path.display())));
    if args.frames.is_some() { print(&watched.write(args.list.format)?) } else { Ok(()) }
}
