//! `nephroid against`: what changed between two runs of `scripts/bench`.

use std::path::PathBuf;

use clap::Args;

use super::{Failure, args::ListArgs, output::print};
use crate::lab::{AgainstReport, BenchLines, Report};

#[derive(Args)]
pub struct AgainstArgs {
    /// The lines.json of the earlier run of scripts/bench
    before: PathBuf,
    /// That of the later one, on the same machine
    after: PathBuf,
    #[command(flatten)]
    list: ListArgs,
}

pub fn run(args: &AgainstArgs) -> Result<(), Failure> {
    let read = |path: &PathBuf| BenchLines::read(path).map_err(Failure::usage);
    let report = AgainstReport::new(&read(&args.before)?, &read(&args.after)?);
    print(&report.write(args.list.format)?)
}
