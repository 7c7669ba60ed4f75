//! From a key to the place where it was written: in the file, or in an override.
use std::{borrow::Cow, ops::Range};

use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use super::error::{Place, SceneError};
use crate::names::near;

/// The scene as text and tree. A span beyond the text's end names an override: `text.len() + 1 + index`.
pub struct Locator<'a> {
    pub file: &'a str,
    pub text: &'a str,
    pub overrides: &'a [(String, String)],
    pub tree: DeTable<'a>,
}

impl Locator<'_> {
    /// The span that everything set by override number `index` carries.
    pub fn override_span(text: &str, index: usize) -> Range<usize> {
        let at = text.len() + 1 + index;
        at..at
    }

    pub fn place(&self, span: Range<usize>) -> Place {
        let beyond = span.start.checked_sub(self.text.len() + 1);
        match beyond.and_then(|index| self.overrides.get(index)) {
            Some((key, value)) => {
                Place::Override { file: self.file.to_owned(), key: key.clone(), value: value.clone() }
            }
            None => place_in(self.file, self.text.as_bytes(), span.start),
        }
    }

    pub fn root(&self) -> Key<'_> {
        Key { locator: self, path: String::new() }
    }

    /// The value of a scalar, the header of a table; for a missing key, the table that lacks it. Elements of an array are
    /// named by their number.
    fn span_of(&self, path: &str) -> Range<usize> {
        let (mut table, mut span) = (&self.tree, 0..0);
        let mut names = path.split('.');
        while let Some(name) = names.next() {
            let Some((key, value)) = table.get_key_value(name) else { break };
            let (value, at) = match value.get_ref() {
                DeValue::Table(_) => (value, key.span()),
                DeValue::Array(items) => {
                    let item = names.clone().next().and_then(|at| items.get(at.parse::<usize>().ok()?));
                    item.map_or((value, value.span()), |item| (item, item.span()))
                }
                _ => return value.span(),
            };
            let DeValue::Table(inner) = value.get_ref() else { return at };
            if matches!(table.get(name).map(Spanned::get_ref), Some(DeValue::Array(_))) {
                names.next();
            }
            (table, span) = (inner, at);
        }
        span
    }
}

/// Line and column, from 1, of a byte offset.
pub fn place_in(file: &str, text: &[u8], offset: usize) -> Place {
    let before = &text[..offset.min(text.len())];
    let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
    let start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |newline| newline + 1);
    Place::File { file: file.to_owned(), line, column: String::from_utf8_lossy(&before[start..]).chars().count() + 1 }
}

/// A key of the scene by its dotted path: checks and faults are spoken from here.
pub struct Key<'a> {
    locator: &'a Locator<'a>,
    path: String,
}

impl<'a> Key<'a> {
    pub fn key(&self, name: &str) -> Key<'a> {
        let dot = if self.path.is_empty() { "" } else { "." };
        Key { locator: self.locator, path: format!("{}{dot}{name}", self.path) }
    }

    pub fn fault(
        &self,
        expected: impl Into<String>,
        found: impl Into<String>,
        remedy: impl Into<String>,
    ) -> SceneError {
        SceneError {
            place: Box::new(self.locator.place(self.locator.span_of(&self.path))),
            key: self.path.clone(),
            expected: expected.into(),
            found: found.into(),
            remedy: remedy.into(),
        }
    }

    /// A table that should hold exactly one of these, and does not.
    pub fn one_kind(&self, kinds: &[&str]) -> SceneError {
        let mut table = Some(&self.locator.tree);
        for name in self.path.split('.') {
            table = table.and_then(|table| table.get(name)?.get_ref().as_table());
        }
        let held: Vec<&str> =
            kinds.iter().copied().filter(|kind| table.is_some_and(|t| t.contains_key(*kind))).collect();
        let (found, remedy) = match held.as_slice() {
            [] => ("none".to_owned(), format!("add `[{}.{}]`, or another of them", self.path, kinds[0])),
            several => (several.join(" and "), "keep one of them".to_owned()),
        };
        self.fault(format!("exactly one kind of {}", kinds.join(", ")), found, remedy)
    }

    /// A name that must be one of `names`.
    pub fn resolve<'n>(
        &self,
        what: &str,
        name: &str,
        names: impl Iterator<Item = &'n str> + Clone,
    ) -> Result<usize, SceneError> {
        let unknown = || self.fault(format!("the name of {what}"), format!("`{name}`"), near(name, names.clone()));
        names.clone().position(|candidate| candidate == name).ok_or_else(unknown)
    }
}

/// Every span within `value`, itself included, set to `span`: where an override put it.
pub fn respan<'a>(value: Spanned<DeValue<'a>>, span: &Range<usize>) -> Spanned<DeValue<'a>> {
    let value = match value.into_inner() {
        DeValue::Array(items) => DeValue::Array(items.into_iter().map(|item| respan(item, span)).collect()),
        DeValue::Table(table) => DeValue::Table(
            table.into_iter().map(|(key, item)| (respanned(key.into_inner(), span), respan(item, span))).collect(),
        ),
        scalar => scalar,
    };
    Spanned::new(span.clone(), value)
}

pub fn respanned<'a>(key: Cow<'a, str>, span: &Range<usize>) -> Spanned<Cow<'a, str>> {
    Spanned::new(span.clone(), key)
}
