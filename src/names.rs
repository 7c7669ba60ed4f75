//! Names as they are typed: what comes near to one that names nothing, said in one way everywhere.

/// A name that names nothing, and what was perhaps meant.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no {what} `{name}`; {remedy}")]
pub struct NoSuch {
    what: &'static str,
    name: String,
    remedy: String,
}

impl NoSuch {
    /// Of a kind of thing (`camera`), what was typed and what there is.
    pub fn new<'a>(what: &'static str, name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Self {
        Self { what, name: name.to_owned(), remedy: near(name, candidates) }
    }
}

/// "did you mean …?" from the candidates most like `name`, else the whole list.
pub fn near<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    match guess(name, candidates.iter().copied()) {
        Some(question) => question,
        None if candidates.is_empty() => "there is none to choose from".to_owned(),
        None => format!("choose one of {}", listed(&candidates)),
    }
}

/// "did you mean …?" if a candidate is like `name`: for lists too long to be shown whole.
pub fn guess<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let mut close: Vec<(f64, &str)> = candidates.into_iter().map(|c| (likeness(name, c), c)).collect();
    close.retain(|(likeness, _)| *likeness >= ALIKE);
    close.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    let best = close.first().map_or(0.0, |c| c.0);
    close.retain(|(likeness, _)| best - likeness <= RIVAL);
    let names: Vec<&str> = close.into_iter().take(MOST).map(|(_, name)| name).collect();
    (!names.is_empty()).then(|| format!("did you mean {}?", listed(&names)))
}

/// Two edits in a word of four or five letters are still a slip of the hand.
const ALIKE: f64 = 0.55;
/// What is less like the name than the best by more than this was not meant.
const RIVAL: f64 = 0.15;
/// More suggestions than this are a list, not a hint.
const MOST: usize = 3;
/// What parts a path: of settings, layers and scene keys, and of a plan's resources.
const PARTS: [char; 2] = ['.', '/'];

/// Likeness from 0 to 1 of two names or paths; paths that end alike are near, whatever stands before.
fn likeness(a: &str, b: &str) -> f64 {
    let last = |s: &str| s.rsplit(PARTS).next().unwrap_or_default().to_lowercase();
    let whole = strsim::normalized_damerau_levenshtein(&a.to_lowercase(), &b.to_lowercase());
    let end = strsim::normalized_damerau_levenshtein(&last(a), &last(b));
    if a.contains(PARTS) || b.contains(PARTS) { 0.5 * (whole + end) } else { whole }
}

fn listed(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_found_and_the_nearest_comes_first() {
        assert_eq!(near("glas-sphere", ["bunny", "glass-sphere"]), "did you mean `glass-sphere`?");
        assert_eq!(near("Region", ["main", "region"]), "did you mean `region`?");
        assert_eq!(near("side", ["sides", "aside", "slide", "sidle"]).matches('`').count(), 2 * MOST);
        assert_eq!(near("light.sied", ["light.view", "light.tracer", "light.side"]), "did you mean `light.side`?");
        assert_eq!(near("maps.side", ["eye.samples", "light.side"]), "did you mean `light.side`?");
    }

    #[test]
    fn the_end_of_a_path_is_enough() {
        assert_eq!(near("caustic", ["mask", "irradiance.caustic"]), "did you mean `irradiance.caustic`?");
        assert_eq!(near("map", ["light/photons", "maps/map"]), "did you mean `maps/map`?");
    }

    #[test]
    fn what_is_like_nothing_gets_the_list() {
        assert_eq!(near("xylophone", ["main", "region"]), "choose one of `main`, `region`");
        assert_eq!(near("", ["main"]), "choose one of `main`");
        assert_eq!(near("main", []), "there is none to choose from");
        assert_eq!(guess("xylophone", ["main"]), None);
        let error = NoSuch::new("camera", "mian", ["main", "region"]).to_string();
        assert_eq!(error, "there is no camera `mian`; did you mean `main`?");
    }
}
