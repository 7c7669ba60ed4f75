//! The program as a user runs it: every command and format, its files, its exit codes, its messages.

mod against;
mod bad_options;
mod bad_scenes;
mod doctor;
mod lists;
mod models;
mod no_room;
mod render;
mod repeat;
mod scenes;
mod sequence;
mod tracers;

use std::{
    path::{Path, PathBuf},
    process::Command,
};

use tempfile::TempDir;

use crate::{
    gltf,
    ran::{Ran, rows},
};

/// A render small enough for a software device.
const SMALL: &str = "--size 48x32 --set light.side=64 --set maps.side=64 --warmup 0 --repeat 2";

/// The program, with a cache that only these tests share.
fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
    command.env("NEPHROID_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli-cache"));
    command
}

/// Runs the program with arguments that hold no spaces.
fn nephroid(arguments: &str) -> Ran {
    program().args(arguments.split_whitespace()).output().expect("the program starts").into()
}

/// A folder, and the place of an output in it that is not there yet.
fn place() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("made").join("out");
    (folder, out)
}

/// Renders at [`SMALL`] and gives the output folder.
#[track_caller]
fn rendered(arguments: &str) -> (TempDir, PathBuf, Ran) {
    let (folder, out) = place();
    let ran = nephroid(&format!("render {arguments} {SMALL} --out {}", out.display())).ok();
    (folder, out, ran)
}

/// Names in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = folder
        .read_dir()
        .expect("the folder is there")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Numbers of a JSON array of objects, by key.
fn column<'v>(rows: &'v serde_json::Value, key: &str) -> Vec<&'v str> {
    rows.as_array().into_iter().flatten().filter_map(|row| row[key].as_str()).collect()
}
