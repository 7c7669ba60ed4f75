//! `nephroid compare`: pictures judged against a reference.

use std::{io::Write, path::PathBuf};

use anyhow::anyhow;
use clap::Args;

use super::{
    Failure,
    args::ListArgs,
    output::{print, say},
};
use crate::{
    lab::{self, CompareReport, Comparison, Limit, MEASURES, Picture, Report},
    names::NoSuch,
    whole::OutFolder,
};

#[derive(Args)]
pub struct CompareArgs {
    /// Pictures (EXR) of the receiver region, as `nephroid render --camera region` makes them
    #[arg(value_name = "IMAGE", required = true)]
    images: Vec<PathBuf>,
    /// What they should be: an EXR of the same region and size; LAYER.variance in it is its noise
    #[arg(long, value_name = "R")]
    reference: PathBuf,
    /// The layer that is judged
    #[arg(long, value_name = "LAYER", default_value = "irradiance.caustic")]
    layer: String,
    /// Exit with 3 if a measure exceeds a value (of energy_ratio: its distance from 1); repeatable
    #[arg(long, value_name = "MEASURE=VALUE", value_parser = parse_limit)]
    fail_above: Vec<Limit>,
    /// Folder for pictures of the signed error and of FLIP; made where it is missing
    #[arg(long, value_name = "DIR")]
    maps: Option<PathBuf>,
    #[command(flatten)]
    list: ListArgs,
}

pub fn run(args: &CompareArgs) -> Result<(), Failure> {
    let folder = args.maps.as_deref().map(OutFolder::stage).transpose()?;
    let reference = Picture::read(&args.reference)?;
    let mut comparisons = Vec::new();
    for path in &args.images {
        comparisons.push(lab::compare(&Picture::read(path)?, &reference, &args.layer)?);
    }
    let report = CompareReport::new(&reference.file, &comparisons);
    report.warnings().iter().for_each(|warning| say(&format!("warning: {warning}")));
    if let (Some(folder), Some(place)) = (folder, &args.maps) {
        write_maps(folder, &args.images, &comparisons)?;
        say(&format!("written: {}", place.display()));
    }
    print(&report.write(args.list.format)?)?;
    match report.exceeded(&args.fail_above) {
        exceeded if exceeded.is_empty() => Ok(()),
        exceeded => Err(Failure::threshold(anyhow!(exceeded.join("\n")))),
    }
}

fn write_maps(mut folder: OutFolder, paths: &[PathBuf], comparisons: &[Comparison]) -> Result<(), Failure> {
    for (at, comparison) in comparisons.iter().enumerate() {
        let name = paths[at].file_stem().unwrap_or_default().to_string_lossy();
        // Pictures of one name in several folders would overwrite each other's maps.
        let number = if paths.len() > 1 { format!("{}.", at + 1) } else { String::new() };
        let stem = lab::dump_file(&format!("{number}{name}.{}", comparison.layer));
        for (file, bytes) in lab::error_maps(comparison, &stem)? {
            folder.write(&file, |out| out.write_all(&bytes))?;
        }
    }
    Ok(folder.commit()?)
}

fn parse_limit(text: &str) -> Result<Limit, String> {
    let expected = || format!("expected MEASURE=VALUE, a number not below 0; measures: {}", MEASURES.join(", "));
    let unknown = |name| NoSuch::new("measure", name, MEASURES).to_string();
    let (name, value) = text.split_once('=').ok_or_else(expected)?;
    let measure = MEASURES.into_iter().find(|measure| *measure == name).ok_or_else(|| unknown(name))?;
    let most = value.parse().ok().filter(|most: &f64| most.is_finite() && *most >= 0.0).ok_or_else(expected)?;
    Ok(Limit { measure, most })
}
