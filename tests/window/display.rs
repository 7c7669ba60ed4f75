//! An X server without a screen, on a display that it chooses itself.

use std::{
    io::{BufRead, BufReader},
    process::{Child, Command, Stdio},
};

/// A running Xvfb; dropped, it ends.
pub struct Display {
    server: Child,
    pub name: String,
}

impl Display {
    /// Starts one. A missing Xvfb is a failure: skips are not silent.
    pub fn start() -> Self {
        let options = ["-displayfd", "1", "-screen", "0", "800x600x24", "-nolisten", "tcp"];
        let mut server = Command::new("Xvfb")
            .args(options)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("tests of the window need Xvfb: run scripts/setup");
        let mut number = String::new();
        let stdout = server.stdout.take().expect("its output is piped");
        BufReader::new(stdout).read_line(&mut number).expect("Xvfb says which display it took");
        let name = format!(":{}", number.trim());
        assert!(name.len() > 1, "Xvfb did not start");
        Self { server, name }
    }

    /// The program, to be shown here.
    pub fn program(&self, arguments: &str) -> Command {
        let mut command = super::program(arguments);
        command.env("DISPLAY", &self.name);
        command
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
