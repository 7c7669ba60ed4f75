//! What two files say of the scenes they were made from.

use std::collections::BTreeMap;

use toml::{Table, Value};

use crate::image::Provenance;

/// The most keys a message names.
const MOST_NAMED: usize = 4;

/// Names the values of the scene that differ, those of the first file before those of the second.
pub fn difference(image: &Provenance, reference: &Provenance) -> String {
    let [ours, theirs] = [image, reference].map(values);
    let [now, then] = [image, reference].map(|about| about.get("time_s").map_or("0", String::as_str));
    let mut keys: Vec<&String> = ours.keys().chain(theirs.keys()).collect();
    keys.sort();
    keys.dedup();
    let of = |values: &BTreeMap<String, String>, key: &String| values.get(key).cloned().unwrap_or("not there".into());
    let differ: Vec<String> = keys
        .into_iter()
        .filter(|key| ours.get(*key) != theirs.get(*key))
        .map(|key| format!("{key} is {} there, {} here", of(&theirs, key), of(&ours, key)))
        .collect();
    match differ.len() {
        0 if now.parse::<f64>() != then.parse::<f64>() => format!("its time is {then} s there, {now} s here"),
        0 => "a mesh file has changed".to_owned(),
        few if few <= MOST_NAMED => differ.join("; "),
        many => format!("{}; and {} more", differ[..MOST_NAMED].join("; "), many - MOST_NAMED),
    }
}

/// The path class that a file was made with: its own word, or its scene's.
pub fn paths(about: &Provenance) -> Option<String> {
    let stated = about.get("paths").or_else(|| about.get("settings.light.paths")).filter(|word| *word != "scene");
    stated.cloned().or_else(|| scene(about)?.get("paths")?.as_str().map(str::to_owned))
}

fn scene(about: &Provenance) -> Option<Table> {
    about.get("scene.resolved")?.parse().ok()
}

/// Every value of the scene by its path.
fn values(about: &Provenance) -> BTreeMap<String, String> {
    let mut flat = BTreeMap::new();
    flatten("", &scene(about).unwrap_or_default(), &mut flat);
    flat
}

fn flatten(prefix: &str, table: &Table, into: &mut BTreeMap<String, String>) {
    for (name, value) in table {
        let path = if prefix.is_empty() { name.clone() } else { format!("{prefix}.{name}") };
        match value {
            Value::Table(inner) => flatten(&path, inner, into),
            other => drop(into.insert(path, other.to_string())),
        }
    }
}
