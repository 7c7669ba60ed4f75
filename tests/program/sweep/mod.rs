//! Sweeps: points kept by content, by shards that may be killed at any moment.

mod kept;
mod killed;
mod parallel;
mod refused;

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use serde_json::Value;
use tempfile::TempDir;

use crate::ran::Ran;

/// A sweep's file, its store, and where it writes to.
struct Place {
    folder: TempDir,
    file: PathBuf,
}

/// Points that take a software device some milliseconds.
const TINY: &str = "version = 1\nscenes = [\"glass-sphere\"]\nmethods = [\"maps\"]\nsize = [8, 8]\nrounds = 2\n";

impl Place {
    /// A sweep of [`TINY`] points, with more lines.
    fn new(more: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("tiny.toml");
        fs::write(&file, format!("{TINY}{more}")).unwrap();
        Self { folder, file }
    }

    /// As [`Self::new`], with the compiled shaders of all these tests: what they compile is not what they are about.
    fn warm(more: &str) -> Self {
        let place = Self::new(more);
        let shared = Path::new(env!("CARGO_TARGET_TMPDIR")).join("sweep-spirv");
        for folder in [&shared, &place.store()] {
            fs::create_dir_all(folder).unwrap();
        }
        #[cfg(unix)]
        std::os::unix::fs::symlink(&shared, place.store().join("spirv")).unwrap();
        place
    }

    fn store(&self) -> PathBuf {
        self.folder.path().join("store")
    }

    /// `nephroid sweep WORDS[0] FILE WORDS[1..]`, with the store of this place.
    fn command(&self, words: &str) -> Command {
        let mut words = words.split(' ');
        let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
        command.env("NEPHROID_CACHE", self.store()).arg("sweep").args(words.next()).arg(&self.file).args(words);
        command
    }

    fn run(&self, words: &str) -> Ran {
        self.command(words).output().unwrap().into()
    }

    /// Files of points in the store.
    fn entries(&self) -> Vec<PathBuf> {
        let points = fs::read_dir(self.store().join("point")).into_iter().flatten();
        let mut files: Vec<_> = points.map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files
    }

    /// The merged points.
    fn merged(&self) -> Vec<Value> {
        let out = self.folder.path().join("out");
        self.run(&format!("merge --out {}", out.display())).code(0);
        let text = fs::read_to_string(out.join("points.jsonl")).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }
}

/// Makes the truth that tiny points are judged by; a file's figures are the same in whatever order points come.
fn truth(folder: &Path) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
    command.args(["truth", "glass-sphere", "--camera", "region", "--size", "8x8", "--photons", "20000", "-o"]);
    let ran: Ran =
        command.arg(folder.join("truth.exr")).env("NEPHROID_CACHE", folder.join("store")).output().unwrap().into();
    ran.code(0);
}
