//! What a table's frames show here: a scene that stands in for the paper's.

use crate::scene::{Models, Scene, SceneError};

/// A scene that stands in for the paper's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The scene of Fig. 7.
    Still,
    /// The animation of Table 4.
    Animation,
    /// A row of Table 5: a model between two lights.
    Room(&'static str),
    /// The wave of Rendering Water Caustics over its unit square.
    Water,
    /// A shipped scene of water with something changed: the scene, what is set, and both in words.
    Altered(&'static str, &'static [(&'static str, &'static str)], &'static str),
}

const FLOOR: &str = "objects.floor.quad.center";
const SUN: &str = "lights.sun.directional.direction";

/// The paper's water over a floor nearer than the printed one.
pub const SHALLOW: Subject = Subject::Altered("waves", &[(FLOOR, "[0.0, -0.4, 0.0]")], "0.4 m deep");
/// The same deeper.
pub const DEEP: Subject = Subject::Altered("waves", &[(FLOOR, "[0.0, -1.6, 0.0]")], "1.6 m deep");
/// The same without absorption.
pub const CLEAR: Subject = Subject::Altered("waves", &[("materials.water.dielectric.absorption", "0.0")], "clear");
/// A sea over a floor so near that all of the region is lit through it, with the sun overhead.
pub const SEA_HIGH: Subject =
    Subject::Altered("sea", &[(FLOOR, "[0.0, -0.75, 0.0]"), (SUN, "[0.0, -1.0, 0.0]")], "sea, sun overhead");
/// The same with the sun 60° from the zenith.
pub const SEA_LOW: Subject =
    Subject::Altered("sea", &[(FLOOR, "[0.0, -0.75, 0.0]"), (SUN, "[0.866, -0.5, 0.0]")], "sea, sun at 60 degrees");

/// When the animation's timed frames begin and end, s: while its sphere is in the beam.
const ANIMATION: [f64; 2] = [0.0, 0.6];
/// The model of Table 5 that no file holds.
const SPHERE: &str = "sphere";
/// Its models that a user can have, and those that nobody publishes.
const MODELS: [&str; 5] = ["triceratops", "buddha", "bunny", "dragon", "armadillo"];
const UNPUBLISHED: [&str; 2] = ["shark", "gargoyle"];

/// What differs from the paper's run in every table, and why.
const DEVIATIONS: [&str; 3] = [
    "the eye sees the receiver region straight on, without the glass, at the size stated: the picture that is timed is the one that is judged",
    "the photon image has two columns, position and flux (16 or 32 bits a channel), and all copies take both",
    "splats are Gaussians whose weights sum to one, of 3 texels in a map of maps.side; varying splats are drawn behind combine-all (the paper does not say behind which), as large as photons lie apart on the receiver",
];

/// The same of the paper on water.
const WATER: [&str; 3] = [
    "the scene is waves, the printed function over its unit square with the floor 0.8 below: the paper's pool, its floor's texture and its moment are not published",
    "the sun map is a disc of 5 degrees with a soft edge, which the paper shows without a size; the truth has the sun's 0.53",
    "the time is that of finding and looking up the light (waves/*, eye/surface), and not of the floor and the water drawn before and after it",
];

/// What else is measured of its prose.
const PROSE: [&str; 3] = [
    "depths, clear water and a sea under two suns are altered scenes, whose pictures are compared with each other and not with a truth",
    "useful rays are those of a tracer in float64 from the floor of waves, evenly over the hemisphere, or straight up; the paper's share is of commercial programs",
    "the sun's angle is what follows from the paper's diameter and distances, which is not what it prints",
];

impl Subject {
    /// The room with the model that a row of Table 5 names.
    ///
    /// # Errors
    /// Why it cannot be had, and what would help.
    pub fn room(model: &str) -> Result<Self, String> {
        if model == SPHERE {
            return Ok(Self::Room(SPHERE));
        }
        if UNPUBLISHED.contains(&model) {
            return Err(format!("the model `{model}` is in no public package"));
        }
        let known = MODELS.into_iter().find(|known| *known == model).ok_or_else(|| "not run here yet".to_owned())?;
        let fetched = format!("the model `{known}` is not in the models folder: scripts/fetch-models {known}");
        let remedy = match known {
            "buddha" => "the models folder has no buddha.obj, which no public package holds: bring one".to_owned(),
            _ => fetched,
        };
        let there = Models::open().names().iter().any(|name| name == known);
        there.then_some(Self::Room(known)).ok_or(remedy)
    }

    /// The name of the shipped scene.
    pub fn scene(self) -> &'static str {
        match self {
            Self::Still => "glass-sphere",
            Self::Animation => "moving-sphere",
            Self::Room(_) => "two-lights",
            Self::Water => "waves",
            Self::Altered(scene, ..) => scene,
        }
    }

    /// The model in it, where a table has several.
    pub fn model(self) -> Option<&'static str> {
        if let Self::Room(model) = self { Some(model) } else { None }
    }

    /// What is changed in it, in words.
    pub fn note(self) -> Option<&'static str> {
        if let Self::Altered(.., note) = self { Some(note) } else { None }
    }

    /// Whether its pictures are held against a truth.
    pub fn is_judged(self) -> bool {
        self.note().is_none()
    }

    /// Reads it.
    ///
    /// # Errors
    /// Those of a model's file; a shipped scene has none.
    pub fn load(self) -> Result<Scene, SceneError> {
        let model = self.model().filter(|model| *model != SPHERE).map(|model| {
            let mesh = format!("{{ file = \"model:{model}\", fit = 1.9, center = [0.0, 0.25, 0.0] }}");
            ("objects.model".to_owned(), format!("{{ material = \"glass\", mesh = {mesh} }}"))
        });
        let set = if let Self::Altered(_, set, _) = self { set } else { &[] };
        let set = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned()));
        Scene::load(self.scene(), &set.chain(model).collect::<Vec<_>>())
    }

    /// The moment of round `k` of `rounds`, s.
    pub fn time(self, k: u32, rounds: u32) -> f64 {
        let [from, to] = ANIMATION;
        match self {
            Self::Animation => from + (to - from) * f64::from(k) / f64::from(rounds.max(1)),
            Self::Still | Self::Room(_) | Self::Water | Self::Altered(..) => 0.0,
        }
    }

    /// The moment whose picture is judged, s.
    pub fn judged(self) -> f64 {
        self.time(1, 2)
    }

    /// How its run differs from the paper's.
    pub fn deviations(self) -> Vec<&'static str> {
        let own = match self {
            Self::Still => {
                "the scene is glass-sphere: the model and the light of the paper's Fig. 7 are not published as data"
            }
            Self::Animation => {
                "the animation is moving-sphere from 0 to 0.6 s, a moment a round, judged at 0.3 s: the paper's is not published"
            }
            Self::Room(_) => {
                "the room is two-lights, five quads with the model and two point lights: the paper's, of 315 000 triangles, is not published, and its models have other numbers of triangles; the method is varying-multires, the paper's whole"
            }
            Self::Altered(..) => return PROSE.to_vec(),
            Self::Water => return DEVIATIONS[..1].iter().copied().chain(WATER).collect(),
        };
        std::iter::once(own).chain(DEVIATIONS).collect()
    }
}
