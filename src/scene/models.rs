//! Models that the user has: `model:NAME` in a scene is `NAME.obj` in the models folder.
use std::{
    fs,
    path::{Path, PathBuf},
};

use super::load::read;
use crate::{names::near, places::Folder};

/// What a mesh file begins with that is a model.
pub const PREFIX: &str = "model:";

/// The models folder.
#[derive(Clone, Debug)]
pub struct Models {
    folder: Option<PathBuf>,
}

/// Why a model cannot be had, in the parts of a scene's error.
pub struct ModelFault {
    pub expected: String,
    pub found: String,
    pub remedy: String,
}

impl Models {
    /// The user's: `NEPHROID_MODELS`, else `XDG_DATA_HOME/nephroid/models`, else `~/.local/share/nephroid/models`.
    pub fn open() -> Self {
        Self { folder: Folder::Models.candidates().into_iter().next() }
    }

    /// Where models lie, if anywhere; it need not be there.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Every model, sorted by name.
    pub fn names(&self) -> Vec<String> {
        let entries = self.folder.as_ref().and_then(|folder| fs::read_dir(folder).ok()).into_iter().flatten().flatten();
        let name = |entry: fs::DirEntry| Some(entry.file_name().to_str()?.strip_suffix(".obj")?.to_owned());
        let mut names: Vec<_> = entries.filter_map(name).filter(|name| is_plain(name)).collect();
        names.sort();
        names
    }

    pub(super) fn read(&self, name: &str) -> Result<Vec<u8>, ModelFault> {
        let Some(folder) = &self.folder else {
            return Err(ModelFault {
                expected: format!("the model `{name}`"),
                found: "no models folder".to_owned(),
                remedy: format!("set {} to one", Folder::Models.variable()),
            });
        };
        let fault = |found: String| {
            let (names, variable) = (self.names(), Folder::Models.variable());
            let near = near(name, names.iter().map(String::as_str));
            ModelFault {
                expected: format!("a model in {}", folder.display()),
                found,
                remedy: format!("{near} (scripts/fetch-models fills the folder, {variable} names another)"),
            }
        };
        if !is_plain(name) {
            return Err(fault(format!("{name:?}, which is no plain name")));
        }
        read(&folder.join(format!("{name}.obj"))).map_err(|why| fault(format!("{name}.obj: {why}")))
    }
}

/// A name is one file of the folder, never a way out of it.
fn is_plain(name: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || "_-.+ ".contains(c);
    !name.is_empty() && !name.starts_with('.') && name.chars().all(plain)
}
