//! `nephroid reproduce`: a published table beside a run of it here.

use std::{ops::ControlFlow, path::PathBuf, sync::atomic::Ordering::Relaxed};

use clap::Args;

use super::{
    Failure,
    args::{DeviceArgs, ListArgs, parse_seconds},
    output::{print, say},
    signals,
};
use crate::{
    gpu::Gpu,
    lab::{self, CatalogueReport, Extent, Report, ReproduceReport, papers},
    store::Store,
    whole::OutFolder,
};

/// What lists the ids in the place of one.
const LIST: &str = "list";
/// s
const MAX_SECONDS: f64 = 600.0;

#[derive(Args)]
pub struct ReproduceArgs {
    /// A table or figure, such as maps.table2; `list` for all, and what of each runs here
    #[arg(value_name = "ID")]
    id: String,
    /// Small N, few frames: a minute at most on a software device
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    device: DeviceArgs,
    /// The most time for frames and truth; N that would take longer are left out, rounds end when it is up, and both are said [default: 600]
    #[arg(long, value_name = "S", value_parser = parse_seconds, conflicts_with = "quick")]
    max_seconds: Option<f64>,
    #[command(flatten)]
    list: ListArgs,
    /// Folder for `ID.json` and a picture of each variant and N; made where it is missing
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn run(args: &ReproduceArgs) -> Result<(), Failure> {
    if args.id == LIST {
        return print(&CatalogueReport::default().write(args.list.format)?);
    }
    let published = papers::find(&args.id)?;
    let seconds = args.max_seconds.unwrap_or(MAX_SECONDS);
    let extent = if args.quick { Extent::quick() } else { Extent::whole(seconds) };
    let stop = signals::stop_flag()?;
    let folder = args.out.as_deref().map(OutFolder::stage).transpose()?;
    let report = if lab::can_run(&published) {
        let gpu = Gpu::new(&args.device.options())?;
        lab::reproduce(&gpu, &Store::open(), &published, &extent, &mut |what| {
            if !what.is_empty() {
                say(what);
            }
            if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?
    } else {
        say(&format!("nothing of {} can be run yet: its published figures, and what is missing", published.id));
        ReproduceReport::unrun(&published, &extent)
    };
    if let (Some(mut folder), Some(place)) = (folder, &args.out) {
        report.write_files(&mut folder)?;
        folder.commit()?;
        say(&format!("written: {}", place.display()));
    }
    print(&report.write(args.list.format)?)
}
