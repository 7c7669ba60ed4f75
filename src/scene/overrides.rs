//! `--set scene.KEY=VALUE`: values put into the parsed tree, before anything is checked.
use std::borrow::Cow;

use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use super::{
    error::{Place, SceneError, near},
    locate::{Locator, respan},
};

/// Tables that say of what kind their parent is; an override may leave them out.
const KINDS: [&str; 10] =
    ["dielectric", "diffuse", "directional", "mesh", "mirror", "orthographic", "pinhole", "point", "quad", "sphere"];

/// Puts each override into the tree, in order. Only keys that are there can be set.
pub fn apply<'a>(
    tree: &mut DeTable<'a>,
    file: &str,
    text: &str,
    overrides: &'a [(String, String)],
) -> Result<(), SceneError> {
    for (index, (key, value)) in overrides.iter().enumerate() {
        let fault = |expected: &str, found: String, remedy: String| SceneError {
            place: Box::new(Place::Override { file: file.to_owned(), key: key.clone(), value: value.clone() }),
            key: key.clone(),
            expected: expected.to_owned(),
            found,
            remedy,
        };
        let parsed = parse(value).map_err(|message| {
            fault("a TOML value", message, "write a number, a quoted string, [a, b, c] or true".to_owned())
        })?;
        let unknown = || {
            let keys = paths(tree);
            let remedy = near(key, keys.iter().map(String::as_str));
            fault("a key that the scene holds", "no such key".to_owned(), remedy)
        };
        let path = resolve(tree, key).ok_or_else(unknown)?;
        if let Some(slot) = slot(tree, &path) {
            *slot = respan(parsed, &Locator::override_span(text, index));
        }
    }
    Ok(())
}

/// A TOML value; what does not even begin like one is a string.
fn parse(value: &str) -> Result<Spanned<DeValue<'_>>, String> {
    match DeValue::parse(value) {
        Ok(parsed) => Ok(parsed),
        Err(error) if value.starts_with(['[', '{', '"', '\'']) => Err(error.message().to_owned()),
        Err(_) => Ok(Spanned::new(0..value.len(), DeValue::String(Cow::Borrowed(value)))),
    }
}

/// The full path of a key, with the kinds that were left out.
fn resolve(tree: &DeTable, key: &str) -> Option<Vec<String>> {
    let (mut path, mut table) = (Vec::new(), Some(tree));
    for name in key.split('.') {
        let (kind, value) = child(table?, name)?;
        path.extend(kind.map(str::to_owned));
        path.push(name.to_owned());
        table = value.as_table();
    }
    Some(path)
}

fn child<'t, 'a>(table: &'t DeTable<'a>, name: &str) -> Option<(Option<&'t str>, &'t DeValue<'a>)> {
    let through = |kind: &'static str| Some((Some(kind), table.get(kind)?.get_ref().as_table()?.get(name)?.get_ref()));
    let direct = table.get(name).map(|value| (None, value.get_ref()));
    direct.or_else(|| KINDS.into_iter().find_map(through))
}

fn slot<'t, 'a>(tree: &'t mut DeTable<'a>, path: &[String]) -> Option<&'t mut Spanned<DeValue<'a>>> {
    let (last, parents) = path.split_last()?;
    let mut table = tree;
    for name in parents {
        table = match table.get_mut(name.as_str())?.get_mut() {
            DeValue::Table(inner) => inner,
            _ => return None,
        };
    }
    table.get_mut(last.as_str())
}

/// Every dotted path of the tree.
fn paths(table: &DeTable) -> Vec<String> {
    let mut all = Vec::new();
    for (name, value) in table {
        all.push(name.get_ref().to_string());
        if let DeValue::Table(inner) = value.get_ref() {
            all.extend(paths(inner).into_iter().map(|rest| format!("{}.{rest}", name.get_ref())));
        }
    }
    all
}
