//! What each device is, and what it lacks of what frames and methods need.

use super::{Row, Verdict, size};
use crate::{
    gpu::{self, DeviceChoice, DeviceInfo, Feature, Gpu, GpuError, GpuOptions},
    lab::devices::MethodOn,
    methods,
};

/// Variables that say which drivers are looked at.
const DRIVERS: [&str; 4] =
    ["VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_LOADER_DRIVERS_SELECT", "VK_LOADER_DRIVERS_DISABLE"];

/// Also says whether any device runs any method.
pub fn rows() -> (Vec<Row>, bool) {
    let devices = match gpu::list_devices() {
        Ok(devices) => devices,
        Err(error) => return (vec![none(&error)], false),
    };
    if devices.is_empty() {
        return (vec![none(&GpuError::NoDevice)], false);
    }
    let hardware = devices.iter().any(|device| !device.is_software());
    let mut any = false;
    let mut rows = Vec::new();
    for device in &devices {
        let (its, runs) = of_device(device, hardware);
        rows.extend(its);
        any |= runs;
    }
    (rows, any)
}

/// A variable may hide the drivers that are there.
fn none(error: &GpuError) -> Row {
    let remedy = "install a driver (scripts/setup brings a software device)";
    let mut row = Row::of_error("devices", error, Verdict::Fail, remedy);
    let set: Vec<_> =
        DRIVERS.into_iter().filter(|name| std::env::var_os(name).is_some_and(|v| !v.is_empty())).collect();
    if !set.is_empty() {
        row.remedy = format!("unset {}, which may hide drivers; else {}", set.join(", "), row.remedy);
    }
    row
}

/// `hardware`: the machine has a device that is not software. Also says whether a method runs on this one.
fn of_device(info: &DeviceInfo, hardware: bool) -> (Vec<Row>, bool) {
    let what = |part: &str| format!("device {}: {part}", info.index);
    let mut rows = vec![identity(info, hardware)];
    if !info.missing.is_empty() {
        let remedy = "update its driver, or take another device (--device)";
        rows.push(Row::new(what("every frame"), format!("lacks {}", info.missing.join(", ")), Verdict::Fail, remedy));
        return (rows, false);
    }
    if let Err(error) = open(info) {
        rows.push(Row::of_error(
            what("every frame"),
            &error,
            Verdict::Fail,
            "update its driver, or take another device",
        ));
        return (rows, false);
    }
    rows.push(Row::ok(what("every frame"), "all that is needed; opens"));
    let methods: Vec<_> = methods::ALL.iter().map(|method| MethodOn::new(*method, info)).collect();
    rows.extend(methods.iter().map(|method| of_method(&what(&format!("method {}", method.name)), method)));
    rows.extend([counters(what("counters"), info), clock(what("clock"), info), limits(what("limits"), info)]);
    rows.push(Row::ok(what("memory"), format!("{} of its own", size(info.memory_bytes))));
    (rows, methods.iter().any(|method| method.runs))
}

fn identity(info: &DeviceInfo, hardware: bool) -> Row {
    let found = format!("{}, {}; {}; Vulkan {}", info.name, info.kind, info.driver.trim(), info.api);
    let what = format!("device {}", info.index);
    if info.is_software() && !hardware {
        let remedy = "install a GPU's driver to measure: a software device's times are not those of a GPU";
        return Row::new(what, found, Verdict::Warn, remedy);
    }
    Row::ok(what, found)
}

fn open(info: &DeviceInfo) -> Result<(), GpuError> {
    Gpu::new(&GpuOptions { device: DeviceChoice::Named(info.uuid.clone()), ..GpuOptions::default() }).map(drop)
}

fn of_method(what: &str, method: &MethodOn) -> Row {
    if method.runs {
        return Row::ok(what, "runs");
    }
    let remedy = "take another method or device (nephroid devices lists which runs where)";
    Row::new(what, format!("lacks {}", method.lacks.join(", ")), Verdict::Warn, remedy)
}

fn counters(what: String, info: &DeviceInfo) -> Row {
    let counts = [(Feature::PreciseOcclusion, "fragments"), (Feature::Statistics, "points")];
    let (has, lacks): (Vec<_>, Vec<_>) = counts.into_iter().partition(|(feature, _)| info.features.contains(feature));
    let words = |of: &[(Feature, &str)]| of.iter().map(|(_, word)| *word).collect::<Vec<_>>().join(", ");
    if lacks.is_empty() {
        return Row::ok(what, words(&has));
    }
    Row::new(what, format!("no {}", words(&lacks)), Verdict::Warn, "none here: reports leave those columns empty")
}

fn clock(what: String, info: &DeviceInfo) -> Row {
    Row::ok(what, format!("{} ns a tick, {} bits", info.timestamp_period, info.timestamp_bits))
}

fn limits(what: String, info: &DeviceInfo) -> Row {
    let (side, range, point) = (info.max_image_side, size(info.max_buffer_range), info.max_point_size);
    Row::ok(what, format!("images to {side} texels a side, buffers to {range}, points to {point} pixels"))
}
