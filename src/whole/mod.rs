//! Files that appear whole or not at all.
//!
//! [`write_whole`] writes one file, [`OutFolder`] several that belong together. Both write beside the target, flush to
//! the disk and rename, so that a full disk or a failure in between leaves the old file, never half of a new one, and
//! nothing beside it. (A process killed in between may leave a hidden `.nephroid-…` there.) Their error names the path
//! and what to do.

mod error;
mod folder;

pub use error::FileError;
pub use folder::OutFolder;

use error::Attempt;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// What a file is written through: buffered, and able to seek.
pub type Out = BufWriter<File>;

/// Writes `path` by `write`: to a temporary beside it, flushed to the disk, then renamed over it.
///
/// A symbolic link stays and its target is replaced; a device or a pipe cannot be replaced and is written directly.
///
/// # Errors
/// [`FileError`] if the folder or the disk does not take it, or if `write` fails. `path` is then as it was before.
///
/// # Examples
/// ```
/// use std::io::Write;
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("note.txt");
/// nephroid::whole::write_whole(&path, |out| out.write_all(b"all of it")).unwrap();
/// assert_eq!(std::fs::read(&path).unwrap(), b"all of it");
/// ```
pub fn write_whole(path: &Path, write: impl FnOnce(&mut Out) -> io::Result<()>) -> Result<(), FileError> {
    if path.metadata().is_ok_and(|m| !m.is_file() && !m.is_dir()) {
        let device = File::options().write(true).open(path).attempt("write", path)?;
        return fill(device, write).map(|_| ()).attempt("write", path);
    }
    let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let temporary = temporary_in(&parent(&target)).attempt("write", path)?;
    let (file, temporary) = temporary.into_parts();
    fill(file, write).and_then(|file| file.sync_all()).attempt("write", path)?;
    temporary.persist(&target).map_err(|e| e.error).attempt("write", path)?;
    sync_folder(&parent(&target));
    Ok(())
}

/// Runs `write` and empties its buffer; a failing flush is a failure of the write.
fn fill(file: File, write: impl FnOnce(&mut Out) -> io::Result<()>) -> io::Result<File> {
    let mut out = BufWriter::new(file);
    write(&mut out)?;
    out.flush()?;
    out.into_inner().map_err(|e| e.into_error())
}

/// A temporary file that, once renamed, has the permissions any new file would have.
fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".nephroid-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// The folder of a path, "." for a bare name.
fn parent(path: &Path) -> PathBuf {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_path_buf()
}

/// Makes renames in a folder last through a power cut, where the system can; the files themselves are whole anyway.
fn sync_folder(folder: &Path) {
    if let Ok(handle) = File::open(folder) {
        let _ = handle.sync_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names(folder: &Path) -> Vec<String> {
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_file_appears_and_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write_whole(&path, |out| out.write_all(b"first, and longer")).unwrap();
        write_whole(&path, |out| out.write_all(b"second")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn a_failing_writer_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write_whole(&path, |out| out.write_all(b"old")).unwrap();
        let error = write_whole(&path, |out| {
            out.write_all(&[7; 100_000])?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        });
        let message = error.unwrap_err().to_string();
        assert!(message.contains(&path.display().to_string()) && message.contains("free some space"), "{message}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn a_path_below_a_file_names_the_path_and_a_remedy() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let path = file.path().join("out.png");
        let message = write_whole(&path, |_| Ok(())).unwrap_err().to_string();
        assert!(message.contains("out.png") && message.contains("is a file, not a folder"), "{message}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_fails_and_stays_a_device() {
        use std::os::unix::fs::FileTypeExt;
        let path = Path::new("/dev/full");
        let message = write_whole(path, |out| out.write_all(b"x")).unwrap_err().to_string();
        assert!(message.contains("/dev/full") && message.contains("free some space"), "{message}");
        assert!(path.metadata().unwrap().file_type().is_char_device());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_permissions_are_those_of_any_file() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (real, link, plain) = (folder.path().join("real"), folder.path().join("link"), folder.path().join("plain"));
        fs::write(&plain, "").unwrap();
        fs::write(&real, "old").unwrap();
        symlink(&real, &link).unwrap();
        write_whole(&link, |out| out.write_all(b"new")).unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read(&real).unwrap(), b"new");
        let mode = |p: &Path| p.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&real), mode(&plain));
    }

    #[test]
    fn a_folder_in_the_way_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::create_dir(&path).unwrap();
        assert!(write_whole(&path, |out| out.write_all(b"x")).is_err());
        assert_eq!(names(folder.path()), ["a"]);
    }
}
