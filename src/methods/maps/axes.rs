//! The axes of gathering photons, and the paper's columns as presets of them.

use super::{SIDE, SPLAT_SIZE, blocks, large::RASTER_FROM, sums, unused, views};
use crate::{
    passes::{PlanError, light, refused},
    scene::{PathClass, Scene},
    settings::{Choice, Setting, Settings},
};

pub static GATHER: Choice = Choice {
    key: "maps.gather",
    default: "own",
    words: &[
        "own",
        "copy",
        "fetch",
        "hierarchical",
        "combine-last",
        "combine-all",
        "varying-multires",
        "varying-single",
        "cells",
        "fixed",
        "combine-exact",
        "elliptic",
    ],
    doc: "a column of the paper's Table 3, or our cells, fixed, combine-exact or elliptic, which set the four axes below; own: as the axes say",
};

pub static TRAVERSE: Choice = Choice {
    key: "maps.traverse",
    default: "compute",
    words: &["compute", "copy", "fetch", "hierarchical"],
    doc: "how photons reach the map: compute: a dispatch over them, summed exactly in 64-bit fixed point (beyond 128 MiB of sums, \
          fetch); the others draw points, blended in float32: copy: of a vertex buffer (2006); fetch: fetched where they \
          were traced (section 4); hierarchical: streamed out level by level, without what is invalid (section 3.1)",
};

pub static MERGE: Choice = Choice {
    key: "maps.merge",
    default: "none",
    words: &["none", "last", "all", "exact"],
    doc: "with hierarchical or compute, whether photons that fall together are splatted as one: none; four that fall into one \
          texel become one of 4^i times the flux (section 3.2), last: tested at the last level; all: at every level; ours: \
          exact: as many as lie within maps.spread, with their flux, mean place and spread",
};

pub static SPLAT: Choice = Choice {
    key: "maps.splat",
    default: AUTO,
    words: &[AUTO, "fixed", "varying", "thin-lens", "interpolated", "elliptic", "cells"],
    doc: "how large splats are: auto: cells, but fixed where another axis, maps.splat_size, maps.raster_from or maps.blocks is set for splats, in \
          class all:N, whose cells are dear, and where 24 bytes of sums for each texel of all layers that any camera asks for are more than 128 MiB; fixed: maps.splat_size; varying: as far as neighbouring photons lie apart (section 3.3); our reading of what \
          its Fig. 7 compares: thin-lens: by where neighbouring rays come nearest; interpolated: of four sizes those that \
          a dozen photons fall into; ours: elliptic: ellipses that reach to the photons beside them; cells: no splats: the light between the corners of a photon's texel, exactly where \
          it lands",
};

/// Measured: at the default numbers cells take a tenth more of a frame than fixed splats do, and err a hundred times less.
const AUTO: &str = "auto";

pub static TARGET: Choice = Choice {
    key: "maps.target",
    default: "single",
    words: &["single", "multires"],
    doc: "where varying splats go: single: one map; multires: large ones into smaller levels of it, which the eye sums",
};

/// The four axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes<'s> {
    pub traverse: &'s str,
    pub merge: &'s str,
    pub splat: &'s str,
    pub target: &'s str,
}

/// The columns of Table 3, and ours. What its varying splats ran behind the paper does not say; its times are about twice those of
/// combine-all, as its text says.
const PRESETS: [(&str, [&str; 4]); 11] = [
    ("copy", ["copy", "none", "fixed", "single"]),
    ("fetch", ["fetch", "none", "fixed", "single"]),
    ("hierarchical", ["hierarchical", "none", "fixed", "single"]),
    ("combine-last", ["hierarchical", "last", "fixed", "single"]),
    ("combine-all", ["hierarchical", "all", "fixed", "single"]),
    ("varying-multires", ["hierarchical", "all", "varying", "multires"]),
    ("varying-single", ["hierarchical", "all", "varying", "single"]),
    ("cells", ["compute", "none", "cells", "single"]),
    ("fixed", ["compute", "none", "fixed", "single"]),
    ("combine-exact", ["compute", "exact", "fixed", "single"]),
    ("elliptic", ["compute", "none", "elliptic", "single"]),
];

const KEYS: [&Choice; 4] = [&TRAVERSE, &MERGE, &SPLAT, &TARGET];

impl<'s> Axes<'s> {
    /// As set, be they of one meaning together or not; what splats are is left open where nobody says.
    pub fn asked(settings: &'s Settings) -> Self {
        let preset = PRESETS.iter().find(|(name, _)| *name == settings.choice(&GATHER)).map(|(_, values)| *values);
        let [traverse, merge, splat, target] = preset.unwrap_or_else(|| KEYS.map(|key| settings.choice(key)));
        Self { traverse, merge, splat, target }
    }

    /// The axes in force, be they of one meaning together or not.
    pub fn of(settings: &'s Settings, scene: &Scene) -> Self {
        let axes = Self::asked(settings);
        if axes.splat == AUTO { Self { splat: axes.chosen(settings, scene), ..axes } } else { axes }
    }

    /// What the light is spread by where nobody says.
    fn chosen(self, settings: &Settings, scene: &Scene) -> &'static str {
        let cells = self.asks_for_cells(settings, scene) && no_room(settings, scene).is_none();
        if cells { "cells" } else { "fixed" }
    }

    /// Why light is not spread by cells although nothing that is set speaks against them; none else.
    pub fn why_no_cells(settings: &Settings, scene: &Scene) -> Option<String> {
        let asked = Axes::asked(settings);
        let meant = asked.splat == AUTO && asked.asks_for_cells(settings, scene);
        if meant { no_room(settings, scene) } else { None }
    }

    /// Whether cells suit the axes, the scene and what is set.
    fn asks_for_cells(self, settings: &Settings, scene: &Scene) -> bool {
        let plain = (self.traverse, self.merge, self.target) == ("compute", "none", "single");
        let splats = [&SPLAT_SIZE, &RASTER_FROM].iter().any(|key| settings.is_set(Setting::Whole(key)));
        let splats = splats || blocks::levels(settings) > 0;
        let one_way = !matches!(light::paths(scene, settings), PathClass::All(_));
        plain && !splats && one_way
    }

    /// As [`Self::of`].
    ///
    /// # Errors
    /// Axes that contradict the preset, or each other.
    pub fn checked(settings: &'s Settings, scene: &Scene) -> Result<Self, PlanError> {
        let axes = Self::of(settings, scene);
        for (key, value) in KEYS.into_iter().zip(Self::asked(settings).values()) {
            let asked = settings.choice(key);
            if settings.is_set(Setting::Choice(key)) && asked != value {
                let gather = settings.choice(&GATHER);
                let what = format!("{}={asked} with maps.gather={gather}", key.key);
                let reason = format!("that preset has {}={value}", key.key);
                return refused(what, reason, "leave maps.gather out, and set the axes alone");
            }
        }
        match axes {
            Self { traverse: traverse @ ("copy" | "fetch"), merge, .. } if merge != "none" => {
                let what = format!("maps.merge={merge} with maps.traverse={traverse}");
                let remedy = "set maps.traverse=compute or hierarchical";
                refused(what, "only a hierarchy knows which photons lie together", remedy)
            }
            Self { splat, merge: "exact", .. } if splat != "fixed" => refused(
                format!("maps.merge=exact with maps.splat={splat}"),
                "a cluster's splat is a fixed one, made longer and wider by where its own photons lie",
                "set maps.splat=fixed",
            ),
            Self { splat: "cells", merge, .. } if merge != "none" => {
                let what = format!("maps.splat=cells with maps.merge={merge}");
                refused(what, "cells are no points that could fall together", "set maps.merge=none")
            }
            Self { traverse: "copy", splat: splat @ ("varying" | "thin-lens" | "elliptic"), .. } => refused(
                format!("maps.splat={splat} with maps.traverse=copy"),
                "a vertex knows nothing of the photons beside it",
                "set maps.traverse=fetch",
            ),
            Self { splat: splat @ ("thin-lens" | "elliptic"), merge: "last" | "all", .. } => refused(
                format!("maps.splat={splat} with maps.merge={}", axes.merge),
                "a cluster leaves no one place of the glass, and lies beside no one photon",
                "set maps.merge=none",
            ),
            Self { splat: "interpolated", traverse: "compute", .. } => refused(
                "maps.splat=interpolated with maps.traverse=compute",
                "it counts photons where they are blended",
                "set maps.traverse=fetch",
            ),
            Self { splat: splat @ ("fixed" | "interpolated" | "elliptic"), target: "multires", .. } => refused(
                format!("maps.target=multires with maps.splat={splat}"),
                "its splats have no level each",
                "set maps.splat=varying",
            ),
            Self { traverse, splat: "cells", .. } if traverse != "compute" => refused(
                format!("maps.splat=cells with maps.traverse={traverse}"),
                "cells are shared out among texels, and added in integers, by a dispatch",
                "set maps.traverse=compute",
            ),
            Self { splat: "cells", target: "multires", .. } => refused(
                "maps.target=multires with maps.splat=cells",
                "cells cover the texels that they cover, however many",
                "set maps.target=single",
            ),
            _ => unused::check(settings, axes).map(|()| axes),
        }
    }

    fn values(self) -> [&'s str; 4] {
        [self.traverse, self.merge, self.splat, self.target]
    }

    /// By key.
    pub fn pairs(self) -> Vec<(&'static str, String)> {
        KEYS.into_iter().zip(self.values()).map(|(key, value)| (key.key, value.to_owned())).collect()
    }

    /// Whether points are streamed out by transform feedback.
    pub fn streams(self) -> bool {
        self.traverse == "hierarchical"
    }
}

/// Why no buffer holds cells, decided by the layers that any camera asks for: what light is spread by does not depend on
/// who looks.
fn no_room(settings: &Settings, scene: &Scene) -> Option<String> {
    sums::too_large_for_cells(settings.whole(&SIDE), views::most_layers(scene, settings))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(set: &[(&str, &str)]) -> Settings {
        let mut settings = Settings::default();
        set.iter().for_each(|(key, value)| settings.set(super::super::SETTINGS, key, value).unwrap());
        settings
    }

    #[test]
    fn every_word_of_the_presets_is_one_of_its_axis() {
        let scene = Scene::load("glass-sphere", &[]).unwrap();
        assert_eq!(PRESETS.map(|(name, _)| name).as_slice(), &GATHER.words[1..]);
        for (name, values) in PRESETS {
            assert!(KEYS.iter().zip(values).all(|(key, value)| key.words.contains(&value)), "{name}");
            assert!(Axes::checked(&settings(&[("maps.gather", name)]), &scene).is_ok());
        }
    }

    #[test]
    fn light_is_spread_by_cells_where_nobody_says() {
        let splat = |name: &str, set: &[(&str, &str)]| {
            Axes::of(&settings(set), &Scene::load(name, &[]).unwrap()).splat.to_owned()
        };
        assert_eq!(splat("glass-sphere", &[]), "cells");
        assert_eq!(splat("room", &[]), "fixed", "all:3");
        for set in [
            ("maps.splat_size", "5"),
            ("maps.merge", "exact"),
            ("maps.traverse", "fetch"),
            ("maps.side", "4096"),
            ("maps.blocks", "2"),
        ] {
            assert_eq!(splat("glass-sphere", &[set]), "fixed", "{set:?}");
        }
        let scene = Scene::load("glass-sphere", &[]).unwrap();
        let auto = [("maps.splat", "auto"), ("maps.gather", "fixed")];
        assert_eq!(Axes::checked(&settings(&auto[..1]), &scene).unwrap().splat, "cells", "the default, said");
        assert!(Axes::checked(&settings(&auto), &scene).is_err(), "the preset says otherwise");
    }

    #[test]
    fn what_has_no_meaning_is_refused_with_the_reason() {
        let scene = Scene::load("glass-sphere", &[]).unwrap();
        let refused: [&[(&str, &str)]; 13] = [
            &[("maps.gather", "fetch"), ("maps.traverse", "hierarchical")],
            &[("maps.merge", "last"), ("maps.traverse", "fetch")],
            &[("maps.merge", "exact"), ("maps.splat", "varying")],
            &[("maps.merge", "all"), ("maps.splat", "cells")],
            &[("maps.merge", "last"), ("maps.splat", "elliptic")],
            &[("maps.target", "multires"), ("maps.splat", "elliptic")],
            &[("maps.traverse", "copy"), ("maps.splat", "varying")],
            &[("maps.target", "multires")],
            &[("maps.target", "multires"), ("maps.splat", "interpolated"), ("maps.traverse", "fetch")],
            &[("maps.splat", "interpolated")],
            &[("maps.splat", "cells"), ("maps.traverse", "fetch")],
            &[("maps.splat", "cells"), ("maps.target", "multires")],
            &[("maps.splat", "thin-lens"), ("maps.traverse", "hierarchical"), ("maps.merge", "last")],
        ];
        for set in refused {
            let text = Axes::checked(&settings(set), &scene).unwrap_err().to_string();
            assert!(set.iter().any(|(key, value)| text.contains(&format!("{key}={value}"))), "{text}");
        }
        let agreeing = [("maps.gather", "combine-all"), ("maps.merge", "all")];
        assert_eq!(Axes::checked(&settings(&agreeing), &scene).unwrap().merge, "all");
    }
}
