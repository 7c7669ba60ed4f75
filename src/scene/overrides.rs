//! `--set scene.KEY=VALUE`: values put into the parsed tree, before anything is checked.
use std::borrow::Cow;

use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use super::{
    error::{Place, SceneError},
    format::{KINDS, keys},
    locate::{Locator, respan, respanned},
};
use crate::names::near;

/// What the check of reserved keys has more to say of than that they are unknown.
const RESERVED: [&[&str]; 2] = [&["medium"], &["cameras", "region"]];

/// Puts each override into the tree, in order. Any key of the format can be set, of the things that the scene names.
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
        let span = Locator::override_span(text, index);
        let Some(path) = resolve(tree, key) else {
            if let Some((import, brought)) = imported(tree, key) {
                let remedy = format!("set keys of `imports.{import}`, such as materials, or change the glTF file");
                return Err(fault("a key of the scene file", format!("`{brought}` of a glTF file"), remedy));
            }
            if let Some((thing, held, asked)) = other_kind(tree, key) {
                let remedy =
                    format!("to change its kind, set the whole: --set 'scene.{thing}={{ {asked} = {{ … }} }}'");
                return Err(fault(&format!("a key of its kind, `{held}`"), format!("the kind `{asked}`"), remedy));
            }
            let known = paths(Some(tree), &mut Vec::new());
            let remedy = near(key, known.iter().map(String::as_str));
            return Err(fault("a key that the scene holds", "no such key".to_owned(), remedy));
        };
        put(tree, &path, respan(parsed, &span));
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

/// The full path of a key, with the kinds that were left out; what the file leaves out may be named too.
fn resolve<'k>(tree: &DeTable, key: &'k str) -> Option<Vec<&'k str>> {
    let names: Vec<&str> = key.split('.').collect();
    if RESERVED.iter().any(|reserved| names.starts_with(reserved)) {
        return Some(names);
    }
    let (mut path, mut table) = (Vec::new(), Some(tree));
    for (at, name) in names.iter().enumerate() {
        if !holds(table, &path, name) {
            let kind = table.and_then(kind_in)?;
            path.push(kind);
            table = child(table, kind);
            if !holds(table, &path, name) {
                return None;
            }
        }
        let value = table.and_then(|table| table.get(*name));
        table = child(table, name);
        path.push(name);
        // A value that is no table has no keys below it.
        if value.is_some() && table.is_none() && at + 1 < names.len() {
            return None;
        }
    }
    Some(path)
}

/// Whether `name` stands in the table, or may: a second kind may not.
fn holds(table: Option<&DeTable>, path: &[&str], name: &str) -> bool {
    let there = table.is_some_and(|table| table.contains_key(name));
    let second = KINDS.contains(&name) && table.and_then(kind_in).is_some();
    there || (keys(path).contains(&name) && !second)
}

/// The kind that a table holds.
fn kind_in(table: &DeTable) -> Option<&'static str> {
    KINDS.into_iter().find(|kind| child(Some(table), kind).is_some())
}

fn child<'t, 'a>(table: Option<&'t DeTable<'a>>, name: &str) -> Option<&'t DeTable<'a>> {
    table?.get(name)?.get_ref().as_table()
}

/// Where a key means something that an import brings: the import, and the thing.
fn imported<'k>(tree: &DeTable, key: &'k str) -> Option<(&'k str, &'k str)> {
    let (_, brought) = key.split_once('.')?;
    let (import, _) = brought.split_once('/')?;
    child(child(Some(tree), "imports"), import).map(|_| (import, brought))
}

/// Where a key asks for another kind than the one its thing is of: the thing, its kind, and the one asked for.
fn other_kind(tree: &DeTable, key: &str) -> Option<(String, &'static str, String)> {
    let names: Vec<&str> = key.split('.').collect();
    // `lights.sun` is of a kind, and so is `sky`.
    (1..names.len()).find_map(|at| {
        let (thing, asked) = (&names[..at], names[at]);
        let held = kind_in(thing.iter().try_fold(tree, |table, name| child(Some(table), name))?)?;
        let kind = asked != held && KINDS.contains(&asked) && keys(thing).contains(&asked);
        kind.then(|| (thing.join("."), held, asked.to_owned()))
    })
}

/// Sets a value; tables on the way that are not there are made.
fn put<'a>(tree: &mut DeTable<'a>, path: &[&'a str], value: Spanned<DeValue<'a>>) {
    let Some((last, parents)) = path.split_last() else { return };
    let span = value.span();
    let key = |name: &'a str| respanned(Cow::Borrowed(name), &span);
    let mut table = tree;
    for &name in parents {
        if child(Some(table), name).is_none() {
            table.insert(key(name), Spanned::new(span.clone(), DeValue::Table(DeTable::new())));
        }
        table = match table.get_mut(name).map(Spanned::get_mut) {
            Some(DeValue::Table(inner)) => inner,
            _ => return,
        };
    }
    match table.get_mut(*last) {
        Some(slot) => *slot = value,
        None => drop(table.insert(key(last), value)),
    }
}

/// Every dotted path that can be set.
fn paths<'t>(table: Option<&'t DeTable>, path: &mut Vec<&'t str>) -> Vec<String> {
    let there = table.into_iter().flat_map(|table| table.keys()).map(|name| name.get_ref().as_ref());
    let absent = keys(path).iter().copied().filter(|name| table.is_none_or(|table| !table.contains_key(*name)));
    let names: Vec<&str> = there.chain(absent.filter(|name| holds(table, path, name))).collect();
    let mut all = Vec::new();
    for name in names {
        all.push(name.to_owned());
        path.push(name);
        let value = table.and_then(|table| table.get(name));
        if value.is_none_or(|value| value.get_ref().as_table().is_some()) {
            all.extend(paths(child(table, name), path).into_iter().map(|rest| format!("{name}.{rest}")));
        }
        path.pop();
    }
    all
}
