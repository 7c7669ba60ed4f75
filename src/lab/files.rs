//! The files of a render: layers, picture, timings, result, and any image or buffer of the plan.

use std::io::Write;

use super::{Format, LabError, Report};
use crate::{
    image::{Layers, Provenance, to_npy, to_png},
    renderer::{Dump, Renderer},
    whole::OutFolder,
};

/// Writes `image.exr`, `image.png`, `timings.csv` and `result.json`.
pub fn write_outputs(
    folder: &mut OutFolder,
    report: &impl Report,
    layers: &Layers,
    exposure_ev: f64,
    provenance: &Provenance,
) -> Result<(), LabError> {
    write_pictures(folder, "image", layers, exposure_ev, provenance)?;
    write_result(folder, report)
}

/// Writes the layers and the picture: `STEM.exr`, `STEM.png`.
pub fn write_pictures(
    folder: &mut OutFolder,
    stem: &str,
    layers: &Layers,
    exposure_ev: f64,
    provenance: &Provenance,
) -> Result<(), LabError> {
    write(folder, &format!("{stem}.exr"), &layers.to_exr(provenance)?)?;
    write(folder, &format!("{stem}.png"), &to_png(layers, "radiance", exposure_ev, provenance)?)
}

/// Writes `timings.csv` and `result.json`.
pub fn write_result(folder: &mut OutFolder, report: &impl Report) -> Result<(), LabError> {
    folder.write("timings.csv", |out| out.write_all(&report.write(Format::Csv)?))?;
    folder.write("result.json", |out| out.write_all(&report.write(Format::Json)?))?;
    Ok(())
}

/// Writes an image or a buffer by its name in the plan: an image as float32 EXR, one file an array layer, a buffer as
/// NPY of 32-bit words.
pub fn write_dump(
    folder: &mut OutFolder,
    renderer: &Renderer,
    name: &str,
    provenance: &Provenance,
) -> Result<(), LabError> {
    match renderer.dump(name)? {
        Dump::Buffer(words) => write(folder, &format!("{}.npy", dump_file(name)), &to_npy(&[words.len()], &words)?),
        Dump::Image { extent: [width, height], channels, layers } => {
            let several = layers.len() > 1;
            for (at, texels) in layers.into_iter().enumerate() {
                let mut image = Layers::new(width as usize, height as usize);
                image.push(name, channels as usize, texels)?;
                let layer = if several { format!(".{at}") } else { String::new() };
                write(folder, &format!("{}{layer}.exr", dump_file(name)), &image.to_exr(provenance)?)?;
            }
            Ok(())
        }
    }
}

/// The name of a dump's file, without its ending: `maps/map` → `maps.map`.
pub fn dump_file(name: &str) -> String {
    name.replace(['/', ':'], ".")
}

fn write(folder: &mut OutFolder, name: &str, bytes: &[u8]) -> Result<(), LabError> {
    Ok(folder.write(name, |out| out.write_all(bytes))?)
}
