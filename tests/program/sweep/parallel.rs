//! GNU parallel runs a sweep by the line of scenes/sweeps/README.md.

use std::{path::Path, process::Command};

use super::{Place, Ran};

#[test]
fn gnu_parallel_does_all_shards() {
    let page = include_str!("../../../scenes/sweeps/README.md");
    let line = page.lines().find(|line| line.starts_with("parallel ")).expect("the page has a line for GNU parallel");
    let place = Place::warm("reference = \"none\"\n[set]\nlight.side = [4, 5, 6, 7, 8]\n");
    let line = line.replace("scenes/sweeps/first.toml", place.file.to_str().unwrap());
    let program = Path::new(env!("CARGO_BIN_EXE_nephroid")).parent().unwrap();
    let path = std::env::join_paths(
        [program.to_owned()].into_iter().chain(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default())),
    );
    let mut command = Command::new("sh");
    command.args(["-c", &line]).env("PATH", path.unwrap()).env("NEPHROID_CACHE", place.store());
    let ran: Ran = command.env("HOME", place.folder.path()).output().unwrap().into();
    ran.code(0);
    let points = place.merged();
    assert_eq!(points.len(), 5);
    assert!(points.iter().all(|point| point["alone"] == true), "shards of one host wait for each other");
}
