//! Keys, and what they do: a table that `H` prints and the window reads.

use winit::keyboard::{Key, NamedKey};

use crate::renderer::LAYERS;

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Action {
    /// One of [`LAYERS`].
    Layer(usize),
    /// The next layer.
    NextLayer,
    /// The next method, and after the last one none.
    NextMethod,
    /// Seconds more.
    Time(f64),
    /// EV more.
    Exposure(f64),
    /// Camera, time and exposure as they were.
    Reset,
    /// No frames, until it is pressed again; what is changed is still shown.
    Hold,
    /// Says what the keys are.
    Help,
    /// Closes the window.
    Quit,
}

/// Seconds a press of T.
const TIME_STEP: f64 = 0.1;
/// EV a press of + or −.
const EV_STEP: f64 = 0.5;

/// Keys, what they do, and that in words.
const TABLE: [(&str, Action, &str); 13] = [
    ("l", Action::NextLayer, "next layer; 1 to 7: that layer"),
    ("m", Action::NextMethod, "next method, and none"),
    ("t", Action::Time(TIME_STEP), "0.1 s later"),
    ("T", Action::Time(-TIME_STEP), "0.1 s earlier"),
    ("+", Action::Exposure(EV_STEP), "half a stop brighter"),
    ("=", Action::Exposure(EV_STEP), ""),
    ("-", Action::Exposure(-EV_STEP), "half a stop darker"),
    ("r", Action::Reset, "camera, time and exposure as they were"),
    (" ", Action::Hold, "hold, and go on"),
    ("h", Action::Help, "these lines"),
    ("?", Action::Help, ""),
    ("q", Action::Quit, "close, as Escape does"),
    ("Q", Action::Quit, ""),
];

/// What a key asks for, if anything.
pub(super) fn action(key: &Key) -> Option<Action> {
    let typed = match key {
        Key::Named(NamedKey::Escape) => return Some(Action::Quit),
        Key::Named(NamedKey::Space) => " ",
        Key::Character(typed) => typed.as_str(),
        _ => return None,
    };
    let layer = typed.parse::<usize>().ok().filter(|n| (1..=LAYERS.len()).contains(n)).map(|n| Action::Layer(n - 1));
    // Capitals do what small letters do, unless the table tells them apart.
    let find = |typed: &str| TABLE.iter().find(|(key, ..)| *key == typed).map(|row| row.1);
    layer.or_else(|| find(typed)).or_else(|| find(&typed.to_lowercase()))
}

/// The keys and the mouse, a line each.
pub fn help() -> String {
    let rows = TABLE.iter().filter(|row| !row.2.is_empty());
    let keys = rows.map(|(key, _, words)| format!("  {:<6} {words}\n", if *key == " " { "space" } else { key }));
    let layers: Vec<_> = LAYERS.iter().enumerate().map(|(at, name)| format!("{} {name}", at + 1)).collect();
    let mouse = "  left   orbit by dragging; right or middle: pan; wheel: zoom";
    format!("{}{mouse}\n  layers {}", keys.collect::<String>(), layers.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(text: &str) -> Option<Action> {
        action(&Key::Character(text.into()))
    }

    #[test]
    fn every_key_of_the_table_does_what_it_says() {
        for (key, wanted, _) in TABLE {
            assert_eq!(typed(key), Some(wanted), "{key}");
        }
        assert_eq!(action(&Key::Named(NamedKey::Escape)), Some(Action::Quit));
        assert_eq!(action(&Key::Named(NamedKey::Space)), Some(Action::Hold));
        assert_eq!(typed("L"), Some(Action::NextLayer));
    }

    #[test]
    fn digits_are_layers_and_the_rest_is_nothing() {
        let layers: Vec<_> = ["1", "7", "0", "8", "11", "x", ""].map(typed).into();
        assert_eq!(layers[..2], [Some(Action::Layer(0)), Some(Action::Layer(6))]);
        assert!(layers[2..].iter().all(Option::is_none), "{layers:?}");
    }

    #[test]
    fn help_names_every_layer() {
        let help = help();
        assert!(LAYERS.iter().all(|layer| help.contains(layer)), "{help}");
    }
}
