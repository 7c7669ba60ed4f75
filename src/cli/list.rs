//! The commands that render nothing.

use anyhow::anyhow;

use super::{
    Failure,
    args::{ListArgs, PlanArgs, ScenesArgs},
    output,
};
use crate::{
    gpu,
    lab::{DevicesReport, DoctorReport, MethodsReport, PlanReport, Report, SceneReport, ScenesReport},
    renderer,
    scene::Scene,
};

pub fn plan(args: &PlanArgs) -> Result<(), Failure> {
    let job = args.job.job()?;
    let planned = renderer::plan(&job)?;
    output::warn(&job.scene.warnings);
    print(&PlanReport::new(&job, &planned.plan), &args.list)
}

pub fn devices(args: &ListArgs) -> Result<(), Failure> {
    let devices = gpu::list_devices()?;
    if devices.is_empty() {
        return Err(gpu::GpuError::NoDevice.into());
    }
    print(&DevicesReport::new(&devices), args)
}

/// The report is printed whatever it says; the exit code says whether anything can be rendered.
pub fn doctor(args: &ListArgs) -> Result<(), Failure> {
    let report = DoctorReport::new();
    print(&report, args)?;
    match (report.has_device(), report.has_compiler()) {
        (true, true) => Ok(()),
        (false, _) => Err(Failure::no_device(anyhow!("no device can run any method; see the rows that do not say ok"))),
        (true, false) => Err(Failure::failed(anyhow!("shaders do not compile; see the row of the compiler"))),
    }
}

pub fn methods(args: &ListArgs) -> Result<(), Failure> {
    print(&MethodsReport::new(), args)
}

pub fn scenes(args: &ScenesArgs) -> Result<(), Failure> {
    let Some(name) = &args.name else { return print(&ScenesReport::new(), &args.list) };
    let scene = Scene::load(name, &[])?;
    if args.source {
        return output::print(scene.source.text.as_bytes());
    }
    let report = SceneReport::new(&scene);
    output::warn(report.warnings());
    print(&report, &args.list)
}

pub fn schema() -> Result<(), Failure> {
    output::print(format!("{:#}\n", Scene::schema()).as_bytes())
}

fn print(report: &impl Report, args: &ListArgs) -> Result<(), Failure> {
    output::print(&report.write(args.format)?)
}
