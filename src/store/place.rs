//! Where the user's cache is.

use std::ffi::OsString;
use std::path::PathBuf;

/// Cache folders in the order they are tried, from the environment (XDG Base Directory Specification 0.8).
///
/// Empty variables count as unset; a relative `XDG_CACHE_HOME` is ignored, as the specification asks.
pub fn candidates(variable: impl Fn(&str) -> Option<OsString>) -> Vec<PathBuf> {
    let set = |name: &str| variable(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let own = set("NEPHROID_CACHE");
    let xdg = set("XDG_CACHE_HOME").filter(|path| path.is_absolute()).map(|path| path.join("nephroid"));
    let home = set("HOME").map(|path| path.join(".cache").join("nephroid"));
    [own, xdg, home].into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(variables: &[(&str, &str)]) -> Vec<PathBuf> {
        candidates(|name| variables.iter().find(|(n, _)| *n == name).map(|(_, v)| OsString::from(v)))
    }

    #[test]
    fn the_order_is_own_then_xdg_then_home() {
        let all = with(&[("HOME", "/h"), ("XDG_CACHE_HOME", "/x"), ("NEPHROID_CACHE", "n")]);
        assert_eq!(all, ["n", "/x/nephroid", "/h/.cache/nephroid"].map(PathBuf::from));
    }

    #[test]
    fn empty_and_relative_ones_are_passed_over() {
        let home = with(&[("NEPHROID_CACHE", ""), ("XDG_CACHE_HOME", "relative"), ("HOME", "/h")]);
        assert_eq!(home, [PathBuf::from("/h/.cache/nephroid")]);
        assert!(with(&[("HOME", "")]).is_empty());
    }
}
