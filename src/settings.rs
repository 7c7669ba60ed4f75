//! Typed settings: each room lists its own, with unit, default and range; `--set` reaches every one of them.

use std::{collections::BTreeMap, ops::RangeInclusive};

use crate::names;

/// A whole number.
#[derive(Debug)]
pub struct Whole {
    /// `group.name`.
    pub key: &'static str,
    /// What it counts.
    pub unit: &'static str,
    /// Its default.
    pub default: u32,
    /// What is allowed.
    pub range: RangeInclusive<u32>,
    /// What it does, in a line.
    pub doc: &'static str,
}

/// A real number; without a default the scene gives it.
#[derive(Debug)]
pub struct Real {
    /// `group.name`.
    pub key: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its default; `None`: the scene's.
    pub default: Option<f64>,
    /// What is allowed.
    pub range: RangeInclusive<f64>,
    /// What it does, in a line.
    pub doc: &'static str,
}

/// One of a list of words.
#[derive(Debug)]
pub struct Choice {
    /// `group.name`.
    pub key: &'static str,
    /// Its default, one of the words.
    pub default: &'static str,
    /// The words.
    pub words: &'static [&'static str],
    /// What it does, in a line.
    pub doc: &'static str,
}

/// A word of a list, or one of a family that a list can only hint at (`all:N`).
#[derive(Debug)]
pub struct Word {
    /// `group.name`.
    pub key: &'static str,
    /// Its default.
    pub default: &'static str,
    /// What it may be, for a reader.
    pub forms: &'static [&'static str],
    /// Whether it may be this.
    pub accepts: fn(&str) -> bool,
    /// What it does, in a line.
    pub doc: &'static str,
}

/// Any setting.
#[derive(Clone, Copy, Debug)]
pub enum Setting {
    /// A whole number.
    Whole(&'static Whole),
    /// A real number.
    Real(&'static Real),
    /// One of a list of words.
    Choice(&'static Choice),
    /// One of a family of words.
    Word(&'static Word),
}

impl Setting {
    /// `group.name`.
    pub fn key(self) -> &'static str {
        match self {
            Self::Whole(s) => s.key,
            Self::Real(s) => s.key,
            Self::Choice(s) => s.key,
            Self::Word(s) => s.key,
        }
    }

    /// Its unit, or nothing.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Whole(s) => s.unit,
            Self::Real(s) => s.unit,
            Self::Choice(_) | Self::Word(_) => "",
        }
    }

    /// Its default as text.
    pub fn default_text(self) -> String {
        match self {
            Self::Whole(s) => s.default.to_string(),
            Self::Real(s) => s.default.map_or("scene".to_owned(), |v| v.to_string()),
            Self::Choice(s) => s.default.to_owned(),
            Self::Word(s) => s.default.to_owned(),
        }
    }

    /// What is allowed, as text.
    pub fn range_text(self) -> String {
        match self {
            Self::Whole(s) => format!("{} to {}", s.range.start(), s.range.end()),
            Self::Real(s) => format!("{} to {}", s.range.start(), s.range.end()),
            Self::Choice(s) => s.words.join(" | "),
            Self::Word(s) => s.forms.join(" | "),
        }
    }

    /// What it does, in a line.
    pub fn doc(self) -> &'static str {
        match self {
            Self::Whole(s) => s.doc,
            Self::Real(s) => s.doc,
            Self::Choice(s) => s.doc,
            Self::Word(s) => s.doc,
        }
    }

    fn check(self, text: &str) -> bool {
        match self {
            Self::Whole(s) => text.parse().is_ok_and(|v| s.range.contains(&v)),
            Self::Real(s) => text.parse().is_ok_and(|v: f64| v.is_finite() && s.range.contains(&v)),
            Self::Choice(s) => s.words.contains(&text),
            Self::Word(s) => (s.accepts)(text),
        }
    }
}

/// A setting that cannot be made.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SettingError {
    /// No setting of that name.
    #[error("--set {key}: there is no such setting{near} (nephroid methods lists them)")]
    Unknown {
        /// What was asked for.
        key: String,
        /// The names near to it, as a question.
        near: String,
    },
    /// A value outside its range, or of another kind.
    #[error("--set {key}={value}: expected {expected}{unit}, default {default}")]
    Value {
        /// The setting.
        key: String,
        /// What was given.
        value: String,
        /// What is allowed.
        expected: String,
        /// Its unit.
        unit: String,
        /// Its default.
        default: String,
    },
}

/// Values by key; what was not set has its default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    set: BTreeMap<&'static str, String>,
    on_software: bool,
}

impl Settings {
    /// Sets one of `known` from text.
    pub fn set(&mut self, known: &[Setting], key: &str, value: &str) -> Result<(), SettingError> {
        let Some(setting) = known.iter().find(|s| s.key() == key) else {
            let near = names::guess(key, known.iter().map(|s| s.key())).map(|near| format!("; {near}"));
            let near = near.unwrap_or_default();
            return Err(SettingError::Unknown { key: key.to_owned(), near });
        };
        if !setting.check(value) {
            let unit = if setting.unit().is_empty() { String::new() } else { format!(" {}", setting.unit()) };
            return Err(SettingError::Value {
                key: key.to_owned(),
                value: value.to_owned(),
                expected: setting.range_text(),
                unit,
                default: setting.default_text(),
            });
        }
        self.set.insert(setting.key(), value.to_owned());
        Ok(())
    }

    /// The same on a device of a kind; a GPU, unless said. What is fastest may hang on it, where nobody has set it.
    pub fn on(&self, software: bool) -> Self {
        Self { on_software: software, ..self.clone() }
    }

    /// Whether the device computes on the CPU.
    pub fn is_on_software(&self) -> bool {
        self.on_software
    }

    /// A whole number.
    pub fn whole(&self, setting: &Whole) -> u32 {
        self.set.get(setting.key).and_then(|v| v.parse().ok()).unwrap_or(setting.default)
    }

    /// A real number; `None` where the scene decides.
    pub fn real(&self, setting: &Real) -> Option<f64> {
        self.set.get(setting.key).and_then(|v| v.parse().ok()).or(setting.default)
    }

    /// A word.
    pub fn choice<'s>(&'s self, setting: &'s Choice) -> &'s str {
        self.set.get(setting.key).map_or(setting.default, String::as_str)
    }

    /// A word of a family.
    pub fn word<'s>(&'s self, setting: &'s Word) -> &'s str {
        self.set.get(setting.key).map_or(setting.default, String::as_str)
    }

    /// Whether it was set, be it to its default.
    pub fn is_set(&self, setting: Setting) -> bool {
        self.set.contains_key(setting.key())
    }

    /// The value of any setting, as text.
    pub fn text(&self, setting: Setting) -> String {
        self.set.get(setting.key()).cloned().unwrap_or_else(|| setting.default_text())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    static SIDE: Whole = Whole { key: "light.side", unit: "texels", default: 512, range: 1..=16384, doc: "photons" };
    static KNOWN: &[Setting] = &[Setting::Whole(&SIDE)];

    #[test]
    fn a_value_is_held_against_its_range() {
        let mut settings = Settings::default();
        assert_eq!(settings.whole(&SIDE), 512);
        settings.set(KNOWN, "light.side", "64").unwrap();
        assert_eq!(settings.whole(&SIDE), 64);
        for bad in ["-3", "0", "1e9", "16385", "NaN", "", "64.5"] {
            let text = settings.set(KNOWN, "light.side", bad).unwrap_err().to_string();
            assert!(text.contains(&format!("light.side={bad}")) && text.contains("1 to 16384 texels"), "{text}");
        }
    }

    #[test]
    fn a_wrong_name_lists_the_near_ones() {
        let text = Settings::default().set(KNOWN, "light.sied", "64").unwrap_err().to_string();
        assert!(text.contains("did you mean `light.side`?"), "{text}");
        let text = Settings::default().set(KNOWN, "maps.side", "64").unwrap_err().to_string();
        assert!(text.contains("did you mean `light.side`?"), "{text}");
    }
}
