//! Holds the house: reads the tree and fails where a file breaks a rule of its layout. No device is needed.
//!
//! The rules are pure functions of texts, each tested on bad input beside it; here they meet the real files.

mod floors;
mod paths;
mod tidy;
mod tokens;

use std::{fs, path::Path, process::Command};

/// Every file of the project, by its place below the root, with its text; those that are not text are left out.
fn tree() -> Vec<floors::File> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let names = listed_by_git(root).unwrap_or_else(|| walked(root, root));
    let files: Vec<_> =
        names.into_iter().filter_map(|name| fs::read_to_string(root.join(&name)).ok().map(|t| (name, t))).collect();
    assert!(files.iter().any(|(name, _)| name == "src/lib.rs"), "the tree was not found under {}", root.display());
    files
}

/// What git tracks or would; `None` for an archive without git.
fn listed_by_git(root: &Path) -> Option<Vec<String>> {
    let listing = ["ls-files", "-z", "--cached", "--others", "--exclude-standard"];
    let output = Command::new("git").current_dir(root).args(listing).output().ok().filter(|o| o.status.success())?;
    let names = String::from_utf8(output.stdout).ok()?;
    Some(names.split_terminator('\0').map(str::to_owned).collect())
}

fn walked(root: &Path, folder: &Path) -> Vec<String> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().into_owned();
        match entry.file_type() {
            Ok(kind) if kind.is_dir() && ![".git", "target", "out"].contains(&name.as_str()) => {
                names.extend(walked(root, &path));
            }
            Ok(kind) if kind.is_file() => names.push(name),
            _ => {}
        }
    }
    names
}

/// Fails with every complaint, one a line.
#[track_caller]
fn expect_none(wrong: Vec<String>) {
    assert!(wrong.is_empty(), "\n{}\n", wrong.join("\n"));
}

#[test]
fn rooms_import_only_from_floors_below() {
    let below_src = |(name, text): floors::File| name.strip_prefix("src/").map(|n| (n.to_owned(), text));
    let rust: Vec<_> = tree().into_iter().filter_map(below_src).filter(|(n, _)| n.ends_with(".rs")).collect();
    expect_none(floors::violations(&rust));
}

#[test]
fn unsafe_code_stays_in_gpu_with_its_reasons() {
    let rust = tree().into_iter().filter(|(name, _)| name.ends_with(".rs"));
    expect_none(rust.flat_map(|(name, text)| tidy::unsafe_complaints(&name, &text)).collect());
}

#[test]
fn unsafe_code_is_denied_by_the_compiler_too() {
    let manifest = include_str!("../../Cargo.toml");
    assert!(
        manifest.lines().any(|l| l.starts_with("unsafe_code = \"deny\"")),
        "[lints.rust] unsafe_code is not denied"
    );
}

#[test]
fn dependencies_state_their_reasons() {
    expect_none(tidy::unreasoned_dependencies(include_str!("../../Cargo.toml")));
}

#[test]
fn files_are_short() {
    expect_none(tree().iter().filter_map(|(name, text)| tidy::too_long(name, text)).collect());
}

#[test]
fn files_name_no_machine() {
    expect_none(tree().iter().flat_map(|(name, text)| tidy::machine_paths(name, text)).collect());
}

/// Both ways of listing see the same sources, so that an archive is held to the same rules as a clone.
#[test]
fn the_tree_is_the_same_without_git() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let Some(mut git) = listed_by_git(root) else { return };
    let walked = walked(root, root);
    git.retain(|name| root.join(name).is_file() && !walked.contains(name));
    expect_none(git);
}
