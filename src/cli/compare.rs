//! `nephroid compare`: pictures judged against a reference.

use std::{
    io::Write,
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::{Arc, atomic::Ordering::Relaxed},
};

use anyhow::anyhow;
use clap::Args;

use super::{
    Failure,
    args::{ListArgs, parse_seconds},
    output::{print, say, warn},
    progress::TruthProgress,
    signals,
};
use crate::{
    lab::{self, Auto, CompareReport, Comparison, LabError, Limit, Making, Picture, Report},
    names::NoSuch,
    store::Store,
    whole::OutFolder,
};

/// What `--reference` says in the place of a file; `./auto` is a file.
const AUTO: &str = "auto";
/// s
const MAX_SECONDS: f64 = 120.0;

#[derive(Args)]
pub struct CompareArgs {
    /// Pictures (EXR) of the receiver region, as `nephroid render --camera region` makes them
    #[arg(value_name = "IMAGE", required = true)]
    images: Vec<PathBuf>,
    /// What they should be: an EXR of the same region and size, whose LAYER.variance is its noise; or `auto`, the truth
    /// of the scene that a picture names, from the store, or made to a tenth of the figure judged
    #[arg(long, value_name = "R")]
    reference: PathBuf,
    /// The most time for a truth made by `--reference auto` [default: 120]
    #[arg(long, value_name = "S", value_parser = parse_seconds)]
    max_seconds: Option<f64>,
    /// The layer that is judged
    #[arg(long, value_name = "LAYER", default_value = "irradiance.caustic")]
    layer: String,
    /// Exit with 3 if a measure exceeds a value (of energy_ratio: its distance from 1; relmse_fitted is relmse where a picture is in W/m2); repeatable
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
    let images = args.images.iter().map(|path| Picture::read(path)).collect::<Result<Vec<_>, _>>()?;
    let references = references(args, &images)?;
    let pairs = images.iter().zip(&references);
    let comparisons = pairs.map(|(x, r)| lab::compare(x, r, &args.layer)).collect::<Result<Vec<_>, _>>()?;
    let report = CompareReport::new(&args.reference.display().to_string(), &comparisons);
    warn(report.warnings());
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

/// Of each image: the file, or what is found or made.
fn references(args: &CompareArgs, images: &[Picture]) -> Result<Vec<Arc<Picture>>, Failure> {
    if args.reference == Path::new(AUTO) {
        return found(args, images);
    }
    if args.max_seconds.is_some() {
        return Err(Failure::usage(anyhow!("--max-seconds goes with --reference {AUTO}: a file is made already")));
    }
    let file = Arc::new(Picture::read(&args.reference)?);
    Ok(images.iter().map(|_| file.clone()).collect())
}

fn found(args: &CompareArgs, images: &[Picture]) -> Result<Vec<Arc<Picture>>, Failure> {
    let (stop, store) = (signals::stop_flag()?, Store::open());
    let seconds = args.max_seconds.unwrap_or(MAX_SECONDS);
    let mut bars = Bars { seconds, of: None };
    let found = Auto { layer: &args.layer, seconds, store: &store }.references(images, &mut |making| {
        bars.at(making);
        if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    drop(bars);
    if matches!(found, Err(LabError::Interrupted)) && store.folder().is_some() {
        say("kept: the photons so far; the same command goes on from there");
    }
    let found = found?;
    let mut said: Vec<&str> = found.iter().map(|reference| reference.file.as_str()).collect();
    said.dedup();
    said.iter().for_each(|what| say(&format!("reference: {what}")));
    Ok(found)
}

/// A bar for each truth that is made, and a line where there are no bars.
struct Bars {
    seconds: f64,
    of: Option<(String, TruthProgress)>,
}

impl Bars {
    fn at(&mut self, making: &Making) {
        match &self.of {
            Some((subject, bar)) if subject == making.subject => bar.at(&making.standing),
            _ => {
                say(&format!("making the truth of {}, for {} s at most", making.subject, self.seconds));
                let mut bar = TruthProgress::new(Some(self.seconds));
                bar.start(making.standing.photons);
                self.of = Some((making.subject.to_owned(), bar));
            }
        }
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
    let names = || lab::limited().collect::<Vec<_>>();
    let expected = || format!("expected MEASURE=VALUE, a number not below 0; measures: {}", names().join(", "));
    let unknown = |name| NoSuch::new("measure", name, names()).to_string();
    let (name, value) = text.split_once('=').ok_or_else(expected)?;
    let measure = lab::limited().find(|measure| *measure == name).ok_or_else(|| unknown(name))?;
    let most = value.parse().ok().filter(|most: &f64| most.is_finite() && *most >= 0.0).ok_or_else(expected)?;
    Ok(Limit { measure, most })
}
