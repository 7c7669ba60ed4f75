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
}

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
        }
    }

    /// The model in it, where a table has several.
    pub fn model(self) -> Option<&'static str> {
        if let Self::Room(model) = self { Some(model) } else { None }
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
        Scene::load(self.scene(), &Vec::from_iter(model))
    }

    /// The moment of round `k` of `rounds`, s.
    pub fn time(self, k: u32, rounds: u32) -> f64 {
        let [from, to] = ANIMATION;
        match self {
            Self::Animation => from + (to - from) * f64::from(k) / f64::from(rounds.max(1)),
            Self::Still | Self::Room(_) | Self::Water => 0.0,
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
            Self::Water => return DEVIATIONS[..1].iter().copied().chain(WATER).collect(),
        };
        std::iter::once(own).chain(DEVIATIONS).collect()
    }
}
