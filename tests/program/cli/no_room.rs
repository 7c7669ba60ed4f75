//! Places that take no output: nothing is left of a failed render, and never a panic.

use std::{
    fs::{self, File},
    io::{BufRead, BufReader},
    path::Path,
    process::{Command, Stdio},
};

use super::{Ran, SMALL, names, nephroid, place, program};

const FAILED: i32 = 1;
const INTERRUPTED: i32 = 130;

#[test]
fn a_folder_below_a_file_is_refused_before_anything_is_rendered() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "mine").unwrap();
    for out in [file.clone(), file.join("below/it")] {
        let ran = nephroid(&format!("render null {SMALL} --out {}", out.display()));
        assert_eq!(ran.code, Some(FAILED), "{}", ran.err);
        assert!(ran.err.contains("is a file, not a folder: choose another"), "{}", ran.err);
        assert!(!ran.err.contains("device:"), "found too late: {}", ran.err);
        assert_eq!(fs::read(&file).unwrap(), b"mine");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_device_is_no_folder() {
    let ran = nephroid(&format!("render null {SMALL} --out /dev/full"));
    assert_eq!(ran.code, Some(FAILED), "{}", ran.err);
    assert!(ran.err.contains("/dev/full"), "{}", ran.err);
}

/// The program under a limit of file sizes, in blocks of 512 bytes (POSIX `ulimit`).
fn limited(blocks: u32, arguments: &str) -> Ran {
    let limit = format!("ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let mut command = Command::new("sh");
    command.args(["-c", &limit]).arg(program().get_program()).args(arguments.split_whitespace());
    command.envs(program().get_envs().filter_map(|(name, value)| Some((name, value?))));
    command.output().expect("sh starts").into()
}

#[cfg(unix)]
#[test]
fn a_file_that_grows_too_large_is_an_error_and_leaves_nothing() {
    // The first limit stops image.exr at its first block, the second a dump, when other files are written already.
    for (blocks, options, file) in
        [(1, "", "image.exr"), (64, "--dump eye/gbuffer --set eye.samples=8", "eye.gbuffer.exr")]
    {
        let (folder, out) = place();
        let ran = limited(blocks, &format!("render null {SMALL} {options} --out {}", out.display()));
        assert_eq!(ran.code, Some(FAILED), "{}", ran.err);
        assert!(ran.err.contains(file) && ran.err.contains("ulimit -f"), "{}", ran.err);
        assert!(names(folder.path()).is_empty(), "something was left: {:?}", names(folder.path()));
    }
}

#[cfg(unix)]
#[test]
fn the_results_before_a_failure_stay() {
    let (folder, out) = place();
    nephroid(&format!("render null {SMALL} --out {}", out.display())).ok();
    let read = || names(&out).iter().map(|name| fs::read(out.join(name)).unwrap()).collect::<Vec<_>>();
    let before = read();
    let ran = limited(1, &format!("render glass-sphere {SMALL} --out {}", out.display()));
    assert_eq!(ran.code, Some(FAILED), "{}", ran.err);
    assert!(before == read(), "the older results changed");
    drop(folder);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_stdout_is_an_error() {
    for arguments in ["scenes", "methods --format json", "plan null"] {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let ran: Ran = program().args(arguments.split(' ')).stdout(full).output().unwrap().into();
        assert_eq!(ran.code, Some(FAILED), "{arguments}: {}", ran.err);
        assert!(ran.err.contains("cannot write to standard output: No space left"), "{}", ran.err);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_stderr_does_not_change_the_exit_code() {
    let full = || File::options().write(true).open("/dev/full").unwrap();
    assert_eq!(program().args(["plan", "nothing"]).stderr(full()).status().unwrap().code(), Some(2));
    let (_folder, out) = place();
    let mut command = program();
    command.arg("render").arg("null").args(SMALL.split(' ')).arg("--out").arg(&out).stderr(full());
    assert_eq!(command.stdout(Stdio::null()).status().unwrap().code(), Some(0));
}

#[cfg(unix)]
#[test]
fn a_reader_that_has_seen_enough_is_no_failure() {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let ran: Ran = program().arg("methods").stdout(writer).output().unwrap().into();
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert!(ran.err.is_empty(), "{}", ran.err);
}

/// Sends Ctrl-C's signal once the device is named, and waits for the end.
#[cfg(unix)]
fn interrupted(arguments: &str, out: &Path) -> Option<i32> {
    let mut command = program();
    command.args(arguments.split_whitespace()).arg("--out").arg(out);
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let mut said = BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(said.next().unwrap().unwrap().starts_with("device:"));
    let signal = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(signal.success());
    said.for_each(drop);
    child.wait().unwrap().code()
}

#[cfg(unix)]
#[test]
fn an_interrupted_render_leaves_nothing() {
    let (folder, out) = place();
    let code = interrupted("render glass-sphere --size 64x64 --repeat 1000000", &out);
    assert_eq!(code, Some(INTERRUPTED));
    assert!(names(folder.path()).is_empty(), "something was left: {:?}", names(folder.path()));
}
