//! What is wrong with a scene, and where.
use std::fmt;

/// One fault of a scene. Its message has one form: place, key, expected, found, remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {}expected {expected}, found {found}; {remedy}", quoted(.key))]
pub struct SceneError {
    /// Where it was written.
    pub place: Box<Place>,
    /// Dotted path of the key; empty where the fault has none.
    pub key: String,
    /// What should stand there.
    pub expected: String,
    /// What stands there.
    pub found: String,
    /// What to do about it, near names among them.
    pub remedy: String,
}

fn quoted(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("`{key}`: ") }
}

/// Where a fault was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// The scene as a whole: it could not be found or read.
    Scene(String),
    /// A place in a file.
    File {
        /// As the user named it.
        file: String,
        /// From 1.
        line: usize,
        /// From 1, in characters.
        column: usize,
    },
    /// An override, as it would be typed.
    Override {
        /// The scene file it was set in.
        file: String,
        /// Without the `scene.` prefix.
        key: String,
        /// As given.
        value: String,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Scene(name) => f.write_str(name),
            Place::File { file, line, column } => write!(f, "{file}:{line}:{column}"),
            Place::Override { file, key, value } => write!(f, "--set scene.{key}={value} (in {file})"),
        }
    }
}

/// "did you mean …?" from the candidates most like `name`, else the whole list.
pub(super) fn near<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let mut close: Vec<(f64, &str)> = candidates.iter().map(|c| (likeness(name, c), *c)).collect();
    close.retain(|(likeness, _)| *likeness >= ALIKE);
    close.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    match (close.as_slice(), candidates.as_slice()) {
        ([], []) => "there is none to choose from".to_owned(),
        ([], all) => format!("choose one of {}", listed(all.iter().copied())),
        (close, _) => format!("did you mean {}?", listed(close.iter().take(MOST).map(|c| c.1))),
    }
}

/// Two edits in a word of four or five letters are still a slip of the hand.
const ALIKE: f64 = 0.55;
/// More suggestions than this are a list, not a hint.
const MOST: usize = 3;

/// Likeness from 0 to 1 of two dotted keys or names; keys that end alike are near, whatever stands before.
fn likeness(a: &str, b: &str) -> f64 {
    let last = |s: &str| s.rsplit('.').next().unwrap_or_default().to_owned();
    let whole = strsim::normalized_damerau_levenshtein(a, b);
    let end = strsim::normalized_damerau_levenshtein(&last(a), &last(b));
    if a.contains('.') { whole.max(0.5 * (whole + end)) } else { whole }
}

fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
