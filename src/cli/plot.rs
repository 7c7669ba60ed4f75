//! `nephroid plot`: results drawn, and what they say at equal time and equal error.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use clap::{Args, ValueEnum, builder::PossibleValue};

use super::{
    Failure,
    args::ListArgs,
    output::{print, say, warn},
};
use crate::{
    lab::{
        Report,
        plot::{Kind, PlotError, PlotFiles, PlotReport, ReadError, Results, chart},
    },
    whole::OutFolder,
};

#[derive(Args)]
pub struct PlotArgs {
    /// Folders of `sweep merge` (their points.jsonl), lines of points (.jsonl), or JSON of `budget`, `reproduce` or
    /// `render`
    #[arg(value_name = "RESULTS", required = true)]
    results: Vec<PathBuf>,
    /// The plot, FILE.svg; FILE.png and FILE.csv (the data drawn) appear beside it
    #[arg(long, value_name = "FILE.svg", value_parser = parse_svg)]
    out: PathBuf,
    /// What is plotted [default: the first that the results have anything for]
    #[arg(long, value_name = "KIND")]
    kind: Option<Kind>,
    /// The measure of the error
    #[arg(long, value_name = "MEASURE", default_value = "relmse")]
    measure: String,
    /// What a scale plot runs along: photons, lights, triangles, or a setting such as maps.side
    #[arg(long, value_name = "KEY", default_value = "photons")]
    along: String,
    /// Compare the errors at these times, ms [default: some that most series were measured at]
    #[arg(long, value_name = "MS,...", value_delimiter = ',', value_parser = parse_positive)]
    at_ms: Vec<f64>,
    /// Compare the times for these errors [default: some that most series were measured at]
    #[arg(long, value_name = "E,...", value_delimiter = ',', value_parser = parse_positive)]
    at_error: Vec<f64>,
    #[command(flatten)]
    list: ListArgs,
}

pub fn run(args: &PlotArgs) -> Result<(), Failure> {
    let (folder, stem) = (folder_of(&args.out), stem(&args.out)?);
    let folder = OutFolder::stage(folder)?;
    let results = Results::read(&args.results)?;
    warn(&results.notes);
    let chart = chart(&results, args.kind, &args.measure, &args.along)?;
    if chart.kind != Kind::ErrorTime && !(args.at_ms.is_empty() && args.at_error.is_empty()) {
        let kind = chart.kind;
        return Err(Failure::usage(anyhow!("--at-ms and --at-error compare errors and times: this plot is of {kind}")));
    }
    PlotFiles::new(&chart, &results)?.write(folder, &stem)?;
    let written = ["svg", "png", "csv"].map(|ending| args.out.with_extension(ending).display().to_string());
    say(&format!("written: {}", written.join(", ")));
    print(&PlotReport::new(&chart, &results, &args.at_ms, &args.at_error).write(args.list.format)?)
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn stem(path: &Path) -> Result<String, Failure> {
    let stem = path.file_stem().and_then(|stem| stem.to_str());
    stem.map(str::to_owned).ok_or_else(|| Failure::usage(anyhow!("--out {}: no name in UTF-8", path.display())))
}

fn parse_svg(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_svg = path.extension().is_some_and(|ending| ending == "svg");
    is_svg.then_some(path).ok_or_else(|| "expected a file that ends in .svg".to_owned())
}

fn parse_positive(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|v: &f64| v.is_finite() && *v > 0.0);
    value.ok_or_else(|| "expected a number above 0".to_owned())
}

impl ValueEnum for Kind {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        Self::failed(error)
    }
}

impl From<PlotError> for Failure {
    fn from(error: PlotError) -> Self {
        Self::failed(error)
    }
}
