//! A file that could not be written: which, why, and what to do.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// What was tried on which path, the system's reason, and a remedy.
#[derive(Debug, thiserror::Error)]
#[error("cannot {action} {}: {reason}{}", path.display(), remedy(reason.kind(), path))]
pub struct FileError {
    action: &'static str,
    path: PathBuf,
    reason: io::Error,
}

impl FileError {
    /// The path that could not be written.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// Puts action and path to a result of the system.
pub(super) trait Attempt<T> {
    fn attempt(self, action: &'static str, path: &Path) -> Result<T, FileError>;
}

impl<T> Attempt<T> for io::Result<T> {
    fn attempt(self, action: &'static str, path: &Path) -> Result<T, FileError> {
        self.map_err(|reason| FileError { action, path: path.to_path_buf(), reason })
    }
}

/// What the user can do, as the end of the sentence.
fn remedy(kind: ErrorKind, path: &Path) -> String {
    match kind {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "; free some space there, or choose a folder on another disk".into()
        }
        ErrorKind::FileTooLarge => "; raise the limit of file sizes (ulimit -f), or make a smaller picture".into(),
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => "; choose a folder that you may write to".into(),
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => match path.ancestors().find(|p| p.is_file()) {
            Some(file) => format!("; {} is a file, not a folder: choose another", file.display()),
            None => "; choose another folder".into(),
        },
        ErrorKind::IsADirectory => "; a folder of that name is in the way: remove it, or choose another".into(),
        ErrorKind::NotFound => "; make the folder first, or choose another".into(),
        _ => String::new(),
    }
}
