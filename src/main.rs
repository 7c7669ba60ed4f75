//! The command line: parses, runs, prints the error chain.

use std::{
    io::{Write, stderr},
    process::ExitCode,
    time::Instant,
};

use clap::Parser;
use nephroid::cli::Cli;

fn main() -> ExitCode {
    let started = Instant::now();
    match Cli::parse().run(started) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // Where nobody can be told, the exit code still tells.
            let _ = writeln!(stderr(), "error: {failure}");
            failure.code()
        }
    }
}
