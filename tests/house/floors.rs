//! Who may import whom: a room only rooms on the floors below; a method never another method; the truth only floor 0.
use crate::paths::{Path, module_of, paths};
use std::collections::{BTreeMap, BTreeSet};

/// The rooms, floor by floor from the ground. Those of the ground floor may lean on each other, never in a circle.
pub const FLOORS: [&[&str]; 8] = [
    &["names", "places", "optics", "view", "image", "metrics", "stats", "store", "settings", "scene", "whole"],
    &["gpu"],
    &["passes"],
    &["methods", "truth"],
    &["renderer"],
    &["lab"],
    &["window"],
    &["cli"],
];

/// The highest floor that the float64 reference may use: what it judges must not have made it.
const TRUTH_MAY_USE: usize = 0;

/// A file's place below `src/`, and its text.
pub type File = (String, String);

/// Each import that goes up, sideways or around, as `file:line: why`.
pub fn violations(files: &[File]) -> Vec<String> {
    let methods = methods(files);
    let mut wrong = Vec::new();
    for (file, source) in files {
        let module = module_of(file);
        // lib.rs lays out the floors and main.rs forwards: they may name any room.
        let Some(room) = module.first() else { continue };
        if floor_of(room).is_none() {
            wrong.push(format!("{file}: room `{room}` stands on no floor"));
            continue;
        }
        for path in paths(file, source) {
            wrong.extend(complaint(&module, &path, &methods).map(|why| format!("{file}:{}: {why}", path.line)));
        }
    }
    wrong.extend(circle(files));
    wrong
}

fn floor_of(room: &str) -> Option<usize> {
    FLOORS.iter().position(|rooms| rooms.contains(&room))
}

/// Every room beside `methods/mod.rs` is a method.
fn methods(files: &[File]) -> BTreeSet<String> {
    files.iter().filter_map(|(file, _)| module_of(file).into_iter().skip_while(|m| m != "methods").nth(1)).collect()
}

fn complaint(module: &[String], path: &Path, methods: &BTreeSet<String>) -> Option<String> {
    let room = module[0].as_str();
    let Some(other) = path.segments.first().map(String::as_str) else {
        return Some("names the crate's root: name the room".to_owned());
    };
    let Some(theirs) = floor_of(other) else {
        return Some(format!("`crate::{other}` is no room: name the room it comes from"));
    };
    let ours = floor_of(room)?;
    if other == room {
        let method = |segments: &[String]| segments.get(1).filter(|m| methods.contains(*m)).cloned();
        let (mine, its) = (method(module), method(&path.segments));
        return (room == "methods" && mine.is_some() && its.is_some() && mine != its).then(|| {
            format!("a method imports another method, `{}`: move what both want to `passes`", path.segments[1])
        });
    }
    if room == "truth" && theirs > TRUTH_MAY_USE {
        return Some(format!("the truth imports `{other}`: it may use floor {TRUTH_MAY_USE} alone"));
    }
    (theirs > ours || (theirs == ours && ours > 0))
        .then(|| format!("`{room}` on floor {ours} imports `{other}` on floor {theirs}"))
}

/// A circle among the ground floor's rooms, if there is one.
fn circle(files: &[File]) -> Option<String> {
    let mut leans: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (file, source) in files {
        let Some(room) = module_of(file).into_iter().next().filter(|room| floor_of(room) == Some(0)) else { continue };
        let others = paths(file, source).into_iter().filter_map(|p| p.segments.into_iter().next());
        let others: Vec<_> = others.filter(|other| *other != room && floor_of(other) == Some(0)).collect();
        leans.entry(room).or_default().extend(others);
    }
    // Rooms that lean on nothing left are sound; what remains in the end leans on itself.
    while let Some(sound) =
        leans.iter().find(|(_, on)| on.iter().all(|o| !leans.contains_key(o))).map(|(r, _)| r.clone())
    {
        leans.remove(&sound);
    }
    let stuck: Vec<_> = leans.into_keys().collect();
    (!stuck.is_empty()).then(|| format!("rooms of floor 0 import each other in a circle: {}", stuck.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judge(files: &[(&str, &str)]) -> Vec<String> {
        violations(&files.iter().map(|(f, s)| ((*f).to_owned(), (*s).to_owned())).collect::<Vec<_>>())
    }

    /// The one complaint about one file contains these words.
    #[track_caller]
    fn bites(file: &str, source: &str, words: &str) {
        let wrong = judge(&[(file, source), ("methods/maps.rs", ""), ("methods/lines/mod.rs", "")]);
        assert_eq!(wrong.len(), 1, "{wrong:?}");
        assert!(wrong[0].contains(words), "{wrong:?}");
    }

    #[test]
    fn down_is_allowed() {
        let wrong = judge(&[
            ("gpu/mod.rs", "use crate::store::Store;"),
            ("methods/mod.rs", "mod maps; use self::maps::Maps; use crate::methods::maps; use crate::gpu;"),
            ("methods/maps.rs", "use crate::{methods::Method, passes::splat}; use super::Slot;"),
            ("truth.rs", "use crate::{optics, scene::Scene};"),
            ("view.rs", "use crate::scene::Camera;"),
            ("main.rs", "use nephroid::cli; use crate::anything;"),
            ("lib.rs", "pub use crate::renderer::Renderer;"),
        ]);
        assert!(wrong.is_empty(), "{wrong:?}");
    }

    #[test]
    fn up_and_sideways_are_not() {
        bites(
            "gpu/frame.rs",
            "\nuse crate::passes::splat;",
            "gpu/frame.rs:2: `gpu` on floor 1 imports `passes` on floor 2",
        );
        bites("scene/mesh.rs", "fn f() -> crate::gpu::Buffer {}", "floor 0 imports `gpu`");
        bites("gpu/frame.rs", "use crate::{stats, lab::report};", "`lab`");
        bites("gpu/frame.rs", "use super::super::renderer;", "`renderer`");
        bites("window/mod.rs", "use crate::cli;", "floor 6 imports `cli`");
        bites("methods/mod.rs", "use crate::truth;", "floor 3");
    }

    #[test]
    fn methods_keep_apart_and_so_does_the_truth() {
        bites("methods/lines/trace.rs", "use crate::methods::maps::Maps;", "another method, `maps`");
        bites("methods/lines/mod.rs", "use super::maps;", "another method");
        bites("truth/mod.rs", "use crate::gpu;", "the truth imports `gpu`");
        bites("truth/mod.rs", "use crate::passes::eye;", "the truth imports `passes`");
    }

    #[test]
    fn rooms_are_named_and_known() {
        bites("cellar.rs", "", "`cellar` stands on no floor");
        bites("gpu/a.rs", "use crate::Renderer;", "`crate::Renderer` is no room");
        bites("gpu/a.rs", "use crate::*;", "names the crate's root");
    }

    #[test]
    fn the_ground_floor_has_no_circles() {
        let wrong = judge(&[
            ("scene.rs", "use crate::view;"),
            ("view.rs", "use crate::scene;"),
            ("stats.rs", "use crate::view;"),
        ]);
        assert_eq!(wrong, ["rooms of floor 0 import each other in a circle: scene, stats, view"]);
    }
}
