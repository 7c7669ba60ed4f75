//! Several files that belong together, put into their folder at once.

use super::error::{Attempt, FileError};
use super::{Out, fill, sync_folder};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use tempfile::{Builder, TempDir};

/// An output folder whose files appear together, or not at all.
///
/// Files are written to a hidden folder inside it and moved into place by [`OutFolder::commit`]; dropped before that,
/// it leaves everything as it was, folders it had to make included. Made early, it finds an unwritable place before any
/// work is done. Files that are there already and not written again stay.
#[derive(Debug)]
pub struct OutFolder {
    // Dropped in this order: the staged files first, then the folders made for them.
    staging: TempDir,
    made: MadeFolders,
    target: PathBuf,
    names: Vec<String>,
}

impl OutFolder {
    /// Prepares `target`, making it and its parents where they are missing.
    ///
    /// # Errors
    /// [`FileError`] if the folder cannot be made or written to.
    pub fn stage(target: &Path) -> Result<Self, FileError> {
        let made = MadeFolders::make(target).attempt("write to", target)?;
        let staging = Builder::new().prefix(".nephroid-").tempdir_in(target).attempt("write to", target)?;
        fs::create_dir(staging.path().join(NEW)).attempt("write to", target)?;
        fs::create_dir(staging.path().join(OLD)).attempt("write to", target)?;
        Ok(Self { staging, made, target: target.to_path_buf(), names: Vec::new() })
    }

    /// Writes one file of the set, to be known as `name` (a plain file name) in the folder. Written twice, the last
    /// counts.
    ///
    /// # Errors
    /// [`FileError`] if the disk does not take it, `write` fails, or `name` is not plain or names a folder.
    pub fn write(&mut self, name: &str, write: impl FnOnce(&mut Out) -> io::Result<()>) -> Result<(), FileError> {
        let (staged, place) = (self.staging.path().join(NEW).join(name), self.target.join(name));
        check(name, &place).attempt("write", &place)?;
        File::create(staged).and_then(|f| fill(f, write)).and_then(|f| f.sync_all()).attempt("write", &place)?;
        if !self.names.iter().any(|n| n == name) {
            self.names.push(name.to_owned());
        }
        Ok(())
    }

    /// Moves all files into place. If one cannot be moved, those moved before it are taken back.
    ///
    /// # Errors
    /// [`FileError`] of the file that could not be moved; the folder is then as it was.
    pub fn commit(self) -> Result<(), FileError> {
        for (done, name) in self.names.iter().enumerate() {
            if let Err(error) = self.move_in(name) {
                self.names[..done].iter().for_each(|n| self.move_out(n));
                return Err(error).attempt("write", &self.target.join(name));
            }
        }
        sync_folder(&self.target);
        self.made.keep();
        Ok(())
    }

    /// Sets the old file aside and puts the new one in its place.
    fn move_in(&self, name: &str) -> io::Result<()> {
        let [new, old, place] = self.places(name);
        let replaces = place.symlink_metadata().is_ok();
        if replaces {
            fs::rename(&place, &old)?;
        }
        fs::rename(&new, &place).inspect_err(|_| {
            if replaces {
                let _ = fs::rename(&old, &place);
            }
        })
    }

    /// Undoes `move_in`, as far as the system allows: the error that is reported came first.
    fn move_out(&self, name: &str) {
        let [new, old, place] = self.places(name);
        let _ = fs::rename(&place, &new);
        let _ = fs::rename(&old, &place);
    }

    /// The staged new file, the staged old file, and the place of both.
    fn places(&self, name: &str) -> [PathBuf; 3] {
        let staging = self.staging.path();
        [staging.join(NEW).join(name), staging.join(OLD).join(name), self.target.join(name)]
    }
}

const NEW: &str = "new";
const OLD: &str = "old";

/// Refuses names that are not plain, and places that a folder occupies.
fn check(name: &str, place: &Path) -> io::Result<()> {
    if Path::new(name).file_name() != Some(name.as_ref()) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "an output is named by a plain file name"));
    }
    if place.is_dir() { Err(io::ErrorKind::IsADirectory.into()) } else { Ok(()) }
}

/// Folders made on the way to a target; removed on drop, the innermost first, unless kept or in use.
#[derive(Debug)]
struct MadeFolders(Vec<PathBuf>);

impl MadeFolders {
    fn make(target: &Path) -> io::Result<Self> {
        let missing: Vec<&Path> =
            target.ancestors().take_while(|p| !p.as_os_str().is_empty() && p.symlink_metadata().is_err()).collect();
        let mut made = Self(Vec::new());
        for folder in missing.iter().rev() {
            match fs::create_dir(folder) {
                Ok(()) => made.0.push(folder.to_path_buf()),
                Err(_) if folder.is_dir() => {} // another process was faster
                Err(error) => return Err(error),
            }
        }
        if target.is_dir() { Ok(made) } else { Err(io::ErrorKind::NotADirectory.into()) }
    }

    fn keep(mut self) {
        self.0.clear();
    }
}

impl Drop for MadeFolders {
    fn drop(&mut self) {
        for folder in self.0.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn text(content: &str) -> impl FnOnce(&mut Out) -> io::Result<()> {
        move |out| out.write_all(content.as_bytes())
    }

    #[test]
    fn files_appear_together_at_commit() {
        let root = tempfile::tempdir().unwrap();
        let target = root.path().join("a/b");
        let mut folder = OutFolder::stage(&target).unwrap();
        folder.write("x", text("1")).unwrap();
        folder.write("y", text("2")).unwrap();
        folder.write("x", text("3")).unwrap();
        assert!(!target.join("x").exists());
        folder.commit().unwrap();
        assert_eq!(names(&target), ["x", "y"]);
        assert_eq!(fs::read_to_string(target.join("x")).unwrap(), "3");
    }

    #[test]
    fn without_commit_nothing_is_left_not_even_folders() {
        let root = tempfile::tempdir().unwrap();
        let mut folder = OutFolder::stage(&root.path().join("a/b")).unwrap();
        folder.write("x", text("1")).unwrap();
        drop(folder);
        assert!(names(root.path()).is_empty());
    }

    #[test]
    fn a_failing_file_leaves_the_old_set() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("x"), "old").unwrap();
        let mut folder = OutFolder::stage(root.path()).unwrap();
        folder.write("x", text("new")).unwrap();
        let full = folder.write("y", |_| Err(io::ErrorKind::StorageFull.into())).unwrap_err();
        assert_eq!(full.path(), root.path().join("y"));
        drop(folder);
        assert_eq!(names(root.path()), ["x"]);
        assert_eq!(fs::read_to_string(root.path().join("x")).unwrap(), "old");
    }

    #[test]
    fn a_failing_move_takes_the_others_back() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("x"), "old").unwrap();
        let mut folder = OutFolder::stage(root.path()).unwrap();
        folder.write("w", text("new")).unwrap();
        folder.write("x", text("new")).unwrap();
        folder.write("y", text("new")).unwrap();
        fs::remove_file(folder.staging.path().join(NEW).join("y")).unwrap();
        let message = folder.commit().unwrap_err().to_string();
        assert!(message.contains("y"), "{message}");
        assert_eq!(names(root.path()), ["x"]);
        assert_eq!(fs::read_to_string(root.path().join("x")).unwrap(), "old");
    }

    #[test]
    fn names_are_plain_and_no_folder_is_replaced() {
        let root = tempfile::tempdir().unwrap();
        fs::create_dir(root.path().join("taken")).unwrap();
        let mut folder = OutFolder::stage(root.path()).unwrap();
        for bad in ["", "..", "a/b", "/a", "a/"] {
            let message = folder.write(bad, text("")).unwrap_err().to_string();
            assert!(message.contains("plain file name"), "{bad:?}: {message}");
        }
        let message = folder.write("taken", text("")).unwrap_err().to_string();
        assert!(message.contains("in the way"), "{message}");
    }

    #[test]
    fn a_target_below_a_file_is_refused_at_once() {
        let file = tempfile::NamedTempFile::new().unwrap();
        for target in [file.path().to_path_buf(), file.path().join("a/b")] {
            let message = OutFolder::stage(&target).unwrap_err().to_string();
            assert!(message.contains("is a file, not a folder"), "{message}");
        }
    }
}
