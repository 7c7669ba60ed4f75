//! Where the user's folders are, from the environment (XDG Base Directory Specification 0.8).
//!
//! Each is named by a variable of ours, else lies below one of the XDG's, else below the home folder. Empty variables
//! count as unset; a relative XDG folder is ignored, as the specification asks.

use std::ffi::OsString;
use std::path::PathBuf;

/// What a folder is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Folder {
    /// What can be made again.
    Cache,
    /// Meshes that scenes name as `model:NAME`.
    Models,
}

impl Folder {
    /// The variable that names it before all others.
    pub fn variable(self) -> &'static str {
        match self {
            Self::Cache => "NEPHROID_CACHE",
            Self::Models => "NEPHROID_MODELS",
        }
    }

    /// Its folders in the order they are tried.
    pub fn candidates(self) -> Vec<PathBuf> {
        self.among(|name| std::env::var_os(name))
    }

    fn among(self, variable: impl Fn(&str) -> Option<OsString>) -> Vec<PathBuf> {
        let (xdg, below_home, inside) = match self {
            Self::Cache => ("XDG_CACHE_HOME", ".cache", "nephroid"),
            Self::Models => ("XDG_DATA_HOME", ".local/share", "nephroid/models"),
        };
        let set = |name: &str| variable(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let own = set(self.variable());
        let xdg = set(xdg).filter(|path| path.is_absolute()).map(|path| path.join(inside));
        let home = set("HOME").map(|path| path.join(below_home).join(inside));
        [own, xdg, home].into_iter().flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(folder: Folder, variables: &[(&str, &str)]) -> Vec<PathBuf> {
        folder.among(|name| variables.iter().find(|(n, _)| *n == name).map(|(_, v)| OsString::from(v)))
    }

    #[test]
    fn the_order_is_own_then_xdg_then_home() {
        let cache = with(Folder::Cache, &[("HOME", "/h"), ("XDG_CACHE_HOME", "/x"), ("NEPHROID_CACHE", "n")]);
        assert_eq!(cache, ["n", "/x/nephroid", "/h/.cache/nephroid"].map(PathBuf::from));
        let models = with(Folder::Models, &[("HOME", "/h"), ("XDG_DATA_HOME", "/x"), ("NEPHROID_MODELS", "m")]);
        assert_eq!(models, ["m", "/x/nephroid/models", "/h/.local/share/nephroid/models"].map(PathBuf::from));
    }

    #[test]
    fn empty_and_relative_ones_are_passed_over() {
        let variables = [("NEPHROID_CACHE", ""), ("XDG_CACHE_HOME", "relative"), ("HOME", "/h")];
        assert_eq!(with(Folder::Cache, &variables), [PathBuf::from("/h/.cache/nephroid")]);
        assert!(with(Folder::Models, &[("HOME", "")]).is_empty());
    }
}
