//! Names of what a file brings: short, printable, and each only once.
use std::collections::HashMap;

/// Characters of a name that are kept.
const LONGEST: usize = 64;

/// Names given so far, and the number that each was last told apart by.
#[derive(Default)]
pub struct Names(HashMap<String, usize>);

impl Names {
    /// The name, or one like it that is not yet taken.
    pub fn give(&mut self, wanted: &str) -> String {
        let Some(number) = self.0.get(wanted).copied() else {
            self.0.insert(wanted.to_owned(), 1);
            return wanted.to_owned();
        };
        let free = (number + 1..).map(|k| (k, format!("{wanted}#{k}"))).find(|(_, name)| !self.0.contains_key(name));
        let (number, name) = free.unwrap_or_default();
        self.0.insert(wanted.to_owned(), number);
        self.0.insert(name.clone(), 1);
        name
    }
}

/// A name as it is shown; `kind` and the number where there is none.
pub fn shown(name: Option<&str>, kind: &str, number: usize) -> String {
    let plain = |c: char| if c.is_control() { '_' } else { c };
    match name.filter(|name| !name.is_empty()) {
        Some(name) => name.chars().take(LONGEST).map(plain).collect(),
        None => format!("{kind}{number}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_apart() {
        let mut names = Names::default();
        let given = ["a", "a", "a#2", "a", "b"].map(|name| names.give(name));
        assert_eq!(given, ["a", "a#2", "a#2#2", "a#3", "b"]);
        assert_eq!(shown(None, "node", 7), "node7");
        assert_eq!(shown(Some("two\nlines"), "node", 7), "two_lines");
        assert_eq!(shown(Some(&"x".repeat(1000)), "node", 7).len(), LONGEST);
    }
}
