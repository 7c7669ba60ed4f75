//! Paths into the crate that a source file names: `crate::…`, `super::…`, `self::…`, groups spread out.
use crate::tokens::{Token, tokens};

/// One path, from the crate's root: `["methods", "maps", "Maps"]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    pub segments: Vec<String>,
    /// From 1.
    pub line: usize,
}

/// The module that a file under `src/` is: `methods/maps.rs` and `methods/maps/mod.rs` are `["methods", "maps"]`.
pub fn module_of(file: &str) -> Vec<String> {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    let stem = stem.strip_suffix("/mod").unwrap_or(stem);
    if stem == "lib" || stem == "main" { vec![] } else { stem.split('/').map(str::to_owned).collect() }
}

/// Every path that a file (relative to `src/`) names within its crate.
pub fn paths(file: &str, source: &str) -> Vec<Path> {
    let tokens = tokens(source);
    let mut inside = Inside { module: module_of(file), ..Inside::default() };
    let mut found = Vec::new();
    for at in 0..tokens.len() {
        inside.step(&tokens, at);
        if let Some((mut base, rest)) = root(&tokens, at, &inside.module) {
            spread(&tokens, rest, &mut base, tokens[at].line, &mut found);
        }
    }
    found
}

fn text(tokens: &[Token], at: usize) -> &str {
    tokens.get(at).map_or("", |t| t.text.as_str())
}

/// The module a path starting at this token starts from, and where its rest begins; `None` if none starts here.
fn root(tokens: &[Token], at: usize, module: &[String]) -> Option<(Vec<String>, usize)> {
    let before = |steps| at.checked_sub(steps).map_or("", |i| text(tokens, i));
    // The middle of a longer path, or a visibility (`pub(in crate::x)`).
    if before(1) == "::" || (before(1) == "in" && before(2) == "(") {
        return None;
    }
    let mut base = match text(tokens, at) {
        "crate" if ["::", "as"].contains(&text(tokens, at + 1)) => return Some((vec![], at + 1)),
        "super" | "self" if text(tokens, at + 1) == "::" => module.to_vec(),
        _ => return None,
    };
    let mut rest = at;
    while text(tokens, rest) == "super" || text(tokens, rest) == "self" {
        if text(tokens, rest) == "super" {
            base.pop();
        }
        rest += if text(tokens, rest + 1) == "::" { 2 } else { 1 };
    }
    // Back to the `::` that the rest begins with.
    Some((base, rest - 1))
}

/// Follows `::a::{b, c::*}` from `at`, adding each whole path. Returns where it ends.
fn spread(tokens: &[Token], at: usize, base: &mut Vec<String>, line: usize, found: &mut Vec<Path>) -> usize {
    if text(tokens, at) != "::" || text(tokens, at + 1) == "<" {
        found.push(Path { segments: base.clone(), line });
        return at;
    }
    if text(tokens, at + 1) == "{" {
        return spread_group(tokens, at + 2, base, found);
    }
    follow(tokens, at + 1, base, found)
}

/// Adds the word at `at` (`self` and `*` stand for the module itself) and goes on behind it.
fn follow(tokens: &[Token], at: usize, base: &mut Vec<String>, found: &mut Vec<Path>) -> usize {
    let word = text(tokens, at);
    if word == "self" || word == "*" {
        return spread(tokens, at + 1, base, tokens[at].line, found);
    }
    base.push(word.to_owned());
    let end = spread(tokens, at + 1, base, tokens.get(at).map_or(0, |t| t.line), found);
    base.pop();
    end
}

/// Adds the members of a group whose first token is at `at`. Returns the place behind the closing brace.
fn spread_group(tokens: &[Token], mut at: usize, base: &mut Vec<String>, found: &mut Vec<Path>) -> usize {
    while at < tokens.len() && text(tokens, at) != "}" {
        at = if text(tokens, at) == "," { at + 1 } else { follow(tokens, at, base, found) };
        if text(tokens, at) == "as" {
            at += 2;
        }
    }
    at + 1
}

/// Which module the reader is in: inline modules (`mod tests { … }`) count.
#[derive(Default)]
struct Inside {
    module: Vec<String>,
    depth: usize,
    /// Brace depths at which inline modules began.
    inline: Vec<usize>,
}

impl Inside {
    fn step(&mut self, tokens: &[Token], at: usize) {
        match text(tokens, at) {
            "{" => {
                self.depth += 1;
                if at >= 2 && text(tokens, at - 2) == "mod" {
                    self.module.push(text(tokens, at - 1).to_owned());
                    self.inline.push(self.depth);
                }
            }
            "}" => {
                if self.inline.last() == Some(&self.depth) {
                    self.inline.pop();
                    self.module.pop();
                }
                self.depth = self.depth.saturating_sub(1);
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(file: &str, source: &str) -> Vec<String> {
        paths(file, source).iter().map(|p| p.segments.join("::")).collect()
    }

    #[test]
    fn files_are_modules() {
        assert_eq!(module_of("gpu/frame.rs"), ["gpu", "frame"]);
        assert_eq!(module_of("methods/mod.rs"), ["methods"]);
        assert!(module_of("lib.rs").is_empty());
    }

    #[test]
    fn plain_paths_and_groups_are_read() {
        assert_eq!(
            named("gpu/a.rs", "use crate::scene::Scene; fn f() { crate::view::g::<u8>() }"),
            ["scene::Scene", "view::g"]
        );
        assert_eq!(
            named("lab.rs", "use crate::{gpu::{self, Gpu as G}, scene::*, stats};"),
            ["gpu", "gpu::Gpu", "scene", "stats"]
        );
        assert_eq!(named("lab.rs", "$crate::gpu::x!(); use crate as here;"), ["gpu::x", ""]);
    }

    #[test]
    fn relative_paths_are_resolved() {
        assert_eq!(
            named("methods/maps.rs", "use super::lines::Lines; use self::inner::X;"),
            ["methods::lines::Lines", "methods::maps::inner::X"]
        );
        assert_eq!(named("gpu/frame.rs", "use super::super::lab;"), ["lab"]);
        assert_eq!(
            named("scene.rs", "mod tests { use super::*; mod deep { use super::super::Y; } } use super::view;"),
            ["scene", "scene::Y", "view"]
        );
    }

    #[test]
    fn what_is_no_path_is_left_alone() {
        assert!(named("a.rs", "pub(crate) fn f(&self) { self.x } // crate::gpu\n\"crate::gpu\"").is_empty());
        assert!(named("a/b.rs", "pub(in super::super) struct S;").is_empty());
    }

    #[test]
    fn lines_are_kept_in_groups() {
        let found = paths("a.rs", "use crate::{\n  gpu,\n  lab,\n};");
        assert_eq!(found.iter().map(|p| p.line).collect::<Vec<_>>(), [2, 3]);
    }
}
