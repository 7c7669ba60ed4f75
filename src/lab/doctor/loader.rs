//! The loader, its layers, and the variables that lead both.

use std::{
    env,
    ffi::{OsStr, OsString},
};

use super::{Row, Verdict};
use crate::gpu::{self, GpuError, LoaderInfo};

/// Variables that name files or folders of drivers and layers.
const PATHS: [&str; 5] =
    ["VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES", "VK_LAYER_PATH", "VK_ADD_LAYER_PATH"];
/// Variables that put layers into every frame, timed ones too.
const LAYERS: [&str; 2] = ["VK_INSTANCE_LAYERS", "VK_LOADER_LAYERS_ENABLE"];
/// Variables that hide or order what is there.
const CHOICES: [&str; 5] = [
    "VK_LOADER_DRIVERS_SELECT",
    "VK_LOADER_DRIVERS_DISABLE",
    "VK_LOADER_LAYERS_DISABLE",
    "MESA_VK_DEVICE_SELECT",
    "LP_NUM_THREADS",
];

pub fn rows() -> Vec<Row> {
    let mut rows = match gpu::inspect_loader() {
        Ok(info) => {
            let loader = Row::ok("Vulkan loader", format!("Vulkan {}", info.version));
            [loader, validation(&info)].into_iter().chain(others(&info)).collect()
        }
        Err(error) => vec![Row::of_error("Vulkan loader", &error, Verdict::Fail, "reinstall the loader")],
    };
    rows.extend(variables(|name| env::var_os(name)));
    rows
}

fn validation(info: &LoaderInfo) -> Row {
    let what = "validation layer";
    let remedy = "install vulkan-validationlayers (scripts/setup does); --validation and the tests need it";
    let Some(layer) = info.layers.iter().find(|layer| layer.is_validation) else {
        return Row::new(what, "none", Verdict::Warn, remedy);
    };
    match gpu::try_validation() {
        Ok(()) => Row::ok(what, &layer.version),
        // No instance can be made without a driver: the layer may be sound.
        Err(GpuError::NoDevice) => Row::ok(what, format!("{}, not tried without a driver", layer.version)),
        Err(error) => {
            let found = format!("{}, cannot be loaded: {error}", layer.version);
            Row::new(what, found, Verdict::Warn, &format!("re{remedy}"))
        }
    }
}

fn others(info: &LoaderInfo) -> Option<Row> {
    let names: Vec<_> = info.layers.iter().filter(|l| !l.is_validation).map(|l| l.name.as_str()).collect();
    (!names.is_empty()).then(|| Row::ok("other layers", names.join(", ")))
}

/// What the environment says to the loader; a path to nothing is the usual reason why a driver is not found.
fn variables(variable: impl Fn(&str) -> Option<OsString>) -> Vec<Row> {
    let set = |name: &'static str| variable(name).filter(|value| !value.is_empty()).map(|value| (name, value));
    let paths = PATHS.into_iter().filter_map(set).map(|(name, value)| match missing(&value) {
        Some(path) => {
            let found = format!("{}: nothing is at {path}", value.to_string_lossy());
            Row::new(name, found, Verdict::Warn, "name what is there, or unset the variable")
        }
        None => Row::ok(name, value.to_string_lossy()),
    });
    let layers = LAYERS.into_iter().filter_map(set).map(|(name, value)| {
        Row::new(name, value.to_string_lossy(), Verdict::Warn, "unset it to measure: layers take time in every frame")
    });
    let choices = CHOICES.into_iter().filter_map(set).map(|(name, value)| Row::ok(name, value.to_string_lossy()));
    paths.chain(layers).chain(choices).collect()
}

/// The first of a list of paths that is not there.
fn missing(paths: &OsStr) -> Option<String> {
    let gone = env::split_paths(paths).find(|path| !path.as_os_str().is_empty() && !path.exists())?;
    Some(gone.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_that_mislead_are_warned_of() {
        let rows = variables(|name| match name {
            "VK_DRIVER_FILES" => Some("/nonexistent/a.json".into()),
            "VK_LAYER_PATH" => Some(env!("CARGO_MANIFEST_DIR").into()),
            "VK_INSTANCE_LAYERS" => Some("VK_LAYER_x".into()),
            "VK_ICD_FILENAMES" => Some("".into()),
            "LP_NUM_THREADS" => Some("2".into()),
            _ => None,
        });
        let verdicts: Vec<_> = rows.iter().map(|row| (row.what.as_str(), row.verdict)).collect();
        let (ok, warn) = (Verdict::Ok, Verdict::Warn);
        assert_eq!(
            verdicts,
            [("VK_DRIVER_FILES", warn), ("VK_LAYER_PATH", ok), ("VK_INSTANCE_LAYERS", warn), ("LP_NUM_THREADS", ok)]
        );
        assert!(rows[0].found.contains("nothing is at /nonexistent/a.json"), "{:?}", rows[0]);
    }

    #[test]
    fn a_layer_that_is_not_there_is_a_warning() {
        let row = validation(&LoaderInfo { version: "1.3.0".to_owned(), layers: Vec::new() });
        assert_eq!((row.verdict, row.found.as_str()), (Verdict::Warn, "none"));
        assert!(row.remedy.contains("vulkan-validationlayers"));
    }
}
