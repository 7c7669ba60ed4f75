//! The command line: parses, runs, prints the error chain.

fn main() {}
