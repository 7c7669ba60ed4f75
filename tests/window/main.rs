//! The window under a display that nobody sees: what it shows, how it follows, and how it says that it cannot open.

#[path = "../common/mod.rs"]
mod common;
mod display;
mod hand;
mod picture;
mod refused;
mod steered;
mod tone;

use std::{
    path::Path,
    process::{Command, Output},
};

/// A picture small enough for a software device, with a caustic in it.
const SMALL: &str = "--size 160x120 --set light.side=256 --set maps.side=256";
/// What a window that a hand steers shows: light in splats, whose frames are the shorter.
const QUICK: &str = "--size 160x120 --set light.side=256 --set maps.side=256 --set maps.splat=fixed";

/// The program with a cache that only these tests share, and without the display of whoever runs them.
fn program(arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
    command.env("NEPHROID_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("window-cache"));
    for variable in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "XAUTHORITY"] {
        command.env_remove(variable);
    }
    command.args(arguments.split_whitespace());
    command
}

/// Exit code, stdout, stderr; a panic or a word of the validation layers is a failure whatever the test.
#[track_caller]
fn ran(output: Output) -> (Option<i32>, String, String) {
    let text = |bytes| String::from_utf8(bytes).expect("the program writes UTF-8");
    let (out, err) = (text(output.stdout), text(output.stderr));
    assert!(!err.contains("panicked"), "{err}");
    assert!(!err.contains("validation: "), "{err}");
    (output.status.code(), out, err)
}
