//! The two streams: data on stdout, where it must arrive, and words on stderr, where it may.

use std::io::{self, ErrorKind, Write};

use anyhow::Context;

use super::Failure;

/// Writes data to stdout. A reader that has seen enough (`| head`) is no failure; a full disk is one.
pub fn print(data: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(data).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other.context("cannot write to standard output").map_err(Failure::failed),
    }
}

/// Says a line on stderr; nobody has to listen.
pub fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Says what must be known, a line each.
pub fn warn(warnings: &[String]) {
    warnings.iter().for_each(|warning| say(&format!("warning: {warning}")));
}
