//! The commands that render nothing.

use super::{
    Failure,
    args::{ListArgs, PlanArgs, ScenesArgs},
    output,
};
use crate::{
    gpu,
    lab::{DevicesReport, MethodsReport, PlanReport, Report, SceneReport, ScenesReport},
    renderer,
    scene::Scene,
};

pub fn plan(args: &PlanArgs) -> Result<(), Failure> {
    let job = args.job.job()?;
    let planned = renderer::plan(&job)?;
    print(&PlanReport::new(&job, &planned.plan), &args.list)
}

pub fn devices(args: &ListArgs) -> Result<(), Failure> {
    let devices = gpu::list_devices()?;
    if devices.is_empty() {
        return Err(gpu::GpuError::NoDevice.into());
    }
    print(&DevicesReport::new(&devices), args)
}

pub fn methods(args: &ListArgs) -> Result<(), Failure> {
    print(&MethodsReport::new(), args)
}

pub fn scenes(args: &ScenesArgs) -> Result<(), Failure> {
    let Some(name) = &args.name else { return print(&ScenesReport::new(), &args.list) };
    let scene = Scene::load(name, &[])?;
    if args.source { output::print(scene.source.text.as_bytes()) } else { print(&SceneReport::new(&scene), &args.list) }
}

fn print(report: &impl Report, args: &ListArgs) -> Result<(), Failure> {
    output::print(&report.write(args.format)?)
}
