//! Floor 7: the command line. Data on stdout, progress and logs on stderr.
//!
//! Exit codes: 0 done, 1 failed, 2 usage, 3 threshold exceeded, 4 no such device or display, 130 interrupted.

mod against;
mod args;
mod budget;
mod compare;
mod failure;
mod list;
mod output;
mod plot;
mod progress;
mod render;
mod reproduce;
mod sequence;
mod signals;
mod sweep;
mod tracers;
mod truth;
mod view;

use std::time::Instant;

use clap::{CommandFactory, Parser, Subcommand};

use crate::window;

pub use failure::Failure;

/// Real-time caustics: what each method costs, and where its light goes.
#[derive(Parser)]
#[command(name = "nephroid", version, arg_required_else_help = true, after_help = EXIT_CODES)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str =
    "Exit codes: 0 done, 1 failed, 2 usage, 3 threshold exceeded, 4 no such device or display, 130 interrupted";

#[derive(Subcommand)]
enum Command {
    /// Render a scene; write its layers, picture, timings and account of light
    Render(args::RenderArgs),
    /// Show a scene in a window: orbit, zoom, layers, methods, and what each stage takes
    #[command(after_help = window::help())]
    View(view::ViewArgs),
    /// Judge pictures against a reference over the receiver region, by eight measures and their uncertainty
    Compare(compare::CompareArgs),
    /// Run a published table here: times and their shape beside the paper's, and the error that it did not print
    Reproduce(reproduce::ReproduceArgs),
    /// Trace a scene's reference in float64 on the CPU, with its variance
    Truth(truth::TruthArgs),
    /// Say where a method's error comes from: a chain of pictures from the truth to its own, and what each step adds
    Budget(budget::BudgetArgs),
    /// Hold every tracer against exact intersection on a scene's light, texel by texel
    Tracers(tracers::TracersArgs),
    /// Say what changed between two runs of scripts/bench, and by how much beyond noise
    Against(against::AgainstArgs),
    /// Do many points, scenes × methods × settings, in shards that may be killed; each is kept as soon as it is done
    Sweep(sweep::SweepArgs),
    /// Plot results: error against time, cost against photons, stages, error budgets; compare at equal time and error
    Plot(plot::PlotArgs),
    /// Print what a frame would run and hold, and what it leaves out; needs no device
    Plan(args::PlanArgs),
    /// List devices, and which methods run on each
    Devices(args::ListArgs),
    /// Look at loader, layers, devices, compiler and folders: what is there, what is missing, and what to do about it
    Doctor(args::ListArgs),
    /// List methods and settings, with units, defaults and ranges
    Methods(args::ListArgs),
    /// List the shipped scenes, or say what is in one
    Scenes(args::ScenesArgs),
    /// Print the scene format as a JSON schema, by which editors complete keys and mark wrong ones
    Schema,
    /// Print a script that completes commands and options in a shell
    Completions(args::CompletionsArgs),
}

impl Cli {
    /// Runs the command; `started` is when the program was.
    pub fn run(self, started: Instant) -> Result<(), Failure> {
        signals::file_size_limit_is_an_error()?;
        match self.command {
            Command::Render(args) => render::run(&args, started),
            Command::View(args) => view::run(&args),
            Command::Compare(args) => compare::run(&args),
            Command::Reproduce(args) => reproduce::run(&args),
            Command::Truth(args) => truth::run(&args),
            Command::Budget(args) => budget::run(&args),
            Command::Tracers(args) => tracers::run(&args),
            Command::Against(args) => against::run(&args),
            Command::Sweep(args) => sweep::run(&args),
            Command::Plot(args) => plot::run(&args),
            Command::Plan(args) => list::plan(&args),
            Command::Devices(args) => list::devices(&args),
            Command::Doctor(args) => list::doctor(&args),
            Command::Methods(args) => list::methods(&args),
            Command::Scenes(args) => list::scenes(&args),
            Command::Schema => list::schema(),
            Command::Completions(args) => completions(args.shell),
        }
    }
}

/// Written to memory first: the generator panics where its writer fails.
fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "nephroid", &mut script);
    output::print(&script)
}
