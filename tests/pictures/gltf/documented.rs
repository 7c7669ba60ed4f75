//! What `scenes/README.md` shows.
use serde_json::json;

use super::{Folder, made::small};
use nephroid::scene::Scene;

/// The snippet there is a whole scene; its keys that say what the default is say so.
#[test]
fn the_readme_shows_a_scene_that_loads() {
    let readme = include_str!("../../../scenes/README.md");
    let mut snippets = readme.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    let snippet = snippets.find(|snippet| snippet.contains("[imports.")).expect("a snippet with an import");
    let (folder, mut file) = (Folder::new(), small());
    file.push("materials", json!({ "name": "Paint" }));
    folder.write("still.glb", file.glb());
    let load = |text: &str| {
        let path = folder.write("scene.toml", text);
        Scene::load(path.to_str().expect("a UTF-8 path"), &[]).unwrap_or_else(|error| panic!("{error}"))
    };
    let shown = load(snippet);
    let import = &shown.imports[0];
    assert_eq!([import.objects, import.materials, import.lights, import.cameras], [1, 1, 1, 1]);
    assert_eq!(shown.objects[0].name, "still/Stone");
    let shorter: Vec<&str> = snippet
        .lines()
        .filter(|line| !["scale", "lights", "watts_per_lumen"].iter().any(|key| line.starts_with(key)))
        .collect();
    assert_eq!(shorter.len() + 3, snippet.lines().count());
    let text = |scene: &Scene| format!("{:.5?}", (&scene.objects, &scene.materials, &scene.lights, &scene.cameras));
    assert_eq!(text(&load(&shorter.join("\n"))), text(&shown));
}
