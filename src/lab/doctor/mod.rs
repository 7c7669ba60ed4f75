//! What the program needs, what is there, and what to do about the rest; whatever is missing is a row, never an error.

mod devices;
mod folders;
mod loader;

use serde::Serialize;
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

use super::{
    Cell, Report, Table,
    provenance::{cpu, os},
};
use crate::gpu::{self, GpuError, Sources};

/// How a finding stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Verdict {
    Ok,
    /// Something is lost; rendering goes on.
    Warn,
    /// Nothing can be rendered here, or not on this device.
    Fail,
}

/// One thing that was looked at.
#[derive(Debug, Serialize)]
struct Row {
    what: String,
    found: String,
    verdict: Verdict,
    /// What to do; nothing where nothing is wrong.
    remedy: String,
}

impl Row {
    fn new(what: impl Into<String>, found: impl Into<String>, verdict: Verdict, remedy: &str) -> Self {
        Self { what: what.into(), found: found.into(), verdict, remedy: remedy.to_owned() }
    }

    fn ok(what: impl Into<String>, found: impl Into<String>) -> Self {
        Self::new(what, found, Verdict::Ok, "")
    }

    /// An error that ends in its remedy is taken apart; `remedy` is for one that names none.
    fn of_error(what: impl Into<String>, error: &GpuError, verdict: Verdict, remedy: &str) -> Self {
        let text = error.to_string();
        let (found, remedy) = text.split_once("; ").unwrap_or((&text, remedy));
        Self::new(what, found, verdict, remedy)
    }
}

/// Program, machine, loader, layers, devices, compiler, folders.
#[derive(Debug, Serialize)]
pub struct DoctorReport {
    schema: &'static str,
    /// A device runs a method.
    has_device: bool,
    /// Shaders compile.
    has_compiler: bool,
    checks: Vec<Row>,
}

impl DoctorReport {
    /// Looks at this machine; devices are opened, nothing is rendered.
    pub fn new() -> Self {
        let (devices, has_device) = devices::rows();
        let compiler = compiler();
        let has_compiler = compiler.verdict == Verdict::Ok;
        let mut checks = vec![program(), machine()];
        checks.extend(loader::rows());
        checks.extend(devices);
        checks.push(compiler);
        checks.extend(folders::rows());
        Self { schema: "nephroid.doctor/1", has_device, has_compiler, checks }
    }

    /// Whether a device here runs a method.
    pub fn has_device(&self) -> bool {
        self.has_device
    }

    /// Whether shaders compile here.
    pub fn has_compiler(&self) -> bool {
        self.has_compiler
    }
}

impl Default for DoctorReport {
    fn default() -> Self {
        Self::new()
    }
}

fn program() -> Row {
    let [version, commit, rustc] = [env!("CARGO_PKG_VERSION"), env!("NEPHROID_COMMIT"), env!("NEPHROID_RUSTC")];
    let found = format!("{version}, commit {commit}, {rustc}");
    if cfg!(debug_assertions) {
        let remedy = "cargo build --release; host times of a debug build mean nothing";
        return Row::new("nephroid", format!("{found}, debug build"), Verdict::Warn, remedy);
    }
    Row::ok("nephroid", found)
}

fn machine() -> Row {
    let kind = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let memory = System::new_with_specifics(kind).map(|system| format!(", {}", size(system.total_memory())));
    Row::ok("machine", format!("{}, {}{}", os(), cpu(), memory.unwrap_or_default()))
}

fn compiler() -> Row {
    let spirv = gpu::spirv_version();
    match Sources::try_compiler() {
        Ok(()) => Row::ok("shader compiler", format!("shaderc, SPIR-V {spirv}")),
        Err(error) => {
            let remedy = "build again after scripts/setup, or with --features shaderc-from-source";
            Row::of_error("shader compiler", &error, Verdict::Fail, remedy)
        }
    }
}

/// Bytes in the unit that leaves them short.
fn size(bytes: u64) -> String {
    const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
    let mut unit = 0;
    let mut left = bytes as f64;
    while left >= 1024.0 && unit + 1 < UNITS.len() {
        (left, unit) = (left / 1024.0, unit + 1);
    }
    let decimals = usize::from(unit > 0);
    format!("{left:.decimals$} {}", UNITS[unit])
}

impl Report for DoctorReport {
    fn tables(&self) -> Vec<Table> {
        let rows = self.checks.iter().map(|row| {
            let verdict = match row.verdict {
                Verdict::Ok => "ok",
                Verdict::Warn => "warn",
                Verdict::Fail => "fail",
            };
            [verdict, &row.what, &row.found, &row.remedy].map(Cell::text).to_vec()
        });
        vec![Table { name: "doctor", columns: vec!["verdict", "what", "found", "remedy"], rows: rows.collect() }]
    }

    fn notes(&self) -> Vec<String> {
        let words = match (self.has_device, self.has_compiler) {
            (true, true) => "Nephroid can render here.",
            (false, _) => "Nephroid cannot render here: no device can run any method.",
            (true, false) => "Nephroid cannot render here: shaders do not compile.",
        };
        vec![words.to_owned()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_short() {
        let all = [0, 1023, 1024, 1536 << 20, 78 << 30].map(size);
        assert_eq!(all, ["0 B", "1023 B", "1.0 KiB", "1.5 GiB", "78.0 GiB"]);
    }

    #[test]
    fn an_error_with_a_remedy_is_taken_apart() {
        let row = Row::of_error("loader", &GpuError::NoLoader("gone".to_owned()), Verdict::Fail, "");
        assert_eq!(row.found, "no Vulkan loader: gone");
        assert!(row.remedy.starts_with("install it"), "{}", row.remedy);
        let row = Row::of_error("layer", &GpuError::NoLayer("x".to_owned()), Verdict::Warn, "install it");
        assert!(row.found.contains("x is not installed") && row.remedy == "install it", "{row:?}");
    }
}
