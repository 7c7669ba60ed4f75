//! Devices, and which methods run on each.

use serde::Serialize;

use super::{Cell, Report, Table};
use crate::{gpu::DeviceInfo, methods, renderer, settings::Settings};

/// A device as reports and results name it.
#[derive(Clone, Debug, Serialize)]
pub struct DeviceRow {
    /// Its place in the loader's list.
    pub index: usize,
    /// The driver's name for it.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// True where times are not those of a GPU.
    pub software: bool,
    /// 32 hexadecimal digits.
    pub uuid: String,
    /// Driver name and version.
    pub driver: String,
    /// Vulkan version.
    pub api: String,
    /// Nanoseconds a tick of its clock.
    pub timestamp_period_ns: f32,
}

impl From<&DeviceInfo> for DeviceRow {
    fn from(info: &DeviceInfo) -> Self {
        Self {
            index: info.index,
            name: info.name.clone(),
            kind: info.kind,
            software: info.is_software(),
            uuid: info.uuid.clone(),
            driver: info.driver.trim().to_owned(),
            api: info.api.clone(),
            timestamp_period_ns: info.timestamp_period,
        }
    }
}

/// Every device the loader finds.
#[derive(Debug, Serialize)]
pub struct DevicesReport {
    schema: &'static str,
    devices: Vec<Device>,
}

#[derive(Debug, Serialize)]
struct Device {
    #[serde(flatten)]
    row: DeviceRow,
    max_image_side_texels: u32,
    features: Vec<&'static str>,
    missing: Vec<String>,
    methods: Vec<MethodOn>,
}

/// Whether a method runs on a device, and what it lacks there.
#[derive(Debug, Serialize)]
pub(super) struct MethodOn {
    pub name: &'static str,
    pub runs: bool,
    pub lacks: Vec<&'static str>,
}

impl DevicesReport {
    /// From the loader's list.
    pub fn new(devices: &[DeviceInfo]) -> Self {
        let device = |info: &DeviceInfo| Device {
            row: info.into(),
            max_image_side_texels: info.max_image_side,
            features: info.features.iter().map(|f| f.name()).collect(),
            missing: info.missing.clone(),
            methods: methods::ALL.iter().map(|m| MethodOn::new(*m, info)).collect(),
        };
        Self { schema: "nephroid.devices/1", devices: devices.iter().map(device).collect() }
    }
}

impl MethodOn {
    pub fn new(method: &dyn methods::Method, info: &DeviceInfo) -> Self {
        let lacks = renderer::lacks(method, &Settings::default(), &info.features);
        Self { name: method.name(), runs: lacks.is_empty() && info.missing.is_empty(), lacks }
    }

    fn text(&self) -> String {
        match (self.runs, self.lacks.is_empty()) {
            (true, _) => self.name.to_owned(),
            (false, true) => format!("not {}", self.name),
            (false, false) => format!("not {} (lacks {})", self.name, self.lacks.join(", ")),
        }
    }
}

impl Report for DevicesReport {
    fn tables(&self) -> Vec<Table> {
        let rows = self.devices.iter().map(|d| {
            vec![
                Cell::Count(d.row.index as u64),
                Cell::text(&d.row.name),
                Cell::text(d.row.kind),
                Cell::text(&d.row.uuid),
                Cell::text(&d.row.driver),
                Cell::text(&d.row.api),
                Cell::text(d.methods.iter().map(MethodOn::text).collect::<Vec<_>>().join(", ")),
                Cell::text(if d.missing.is_empty() { "nothing".to_owned() } else { d.missing.join(", ") }),
            ]
        });
        let columns = vec!["index", "name", "kind", "UUID", "driver", "API", "methods", "missing"];
        vec![Table { name: "devices", columns, rows: rows.collect() }]
    }

    fn notes(&self) -> Vec<String> {
        let software = self.devices.iter().any(|d| d.row.software);
        let note = "A software device computes on the CPU: its times are not those of a GPU.";
        software.then(|| note.to_owned()).into_iter().collect()
    }
}
