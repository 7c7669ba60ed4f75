//! What of a table can be run: each column is some stages of a frame of one variant.

use crate::{
    gpu::FrameTimes,
    lab::papers::{Figure, Label, Published},
    methods,
    settings::{SettingError, Settings},
};

/// What a variant renders: a scene that stands in for the paper's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The scene of Fig. 7.
    Still,
    /// The animation of Table 4.
    Animation,
}

/// When the animation's timed frames begin and end, s: while its sphere is in the beam.
const ANIMATION: [f64; 2] = [0.0, 0.6];

impl Subject {
    /// The name of the shipped scene.
    pub fn scene(self) -> &'static str {
        match self {
            Self::Still => "glass-sphere",
            Self::Animation => "moving-sphere",
        }
    }

    /// The moment of round `k` of `rounds`, s.
    pub fn time(self, k: u32, rounds: u32) -> f64 {
        let [from, to] = ANIMATION;
        match self {
            Self::Still => 0.0,
            Self::Animation => from + (to - from) * f64::from(k) / f64::from(rounds.max(1)),
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
        };
        std::iter::once(own).chain(DEVIATIONS).collect()
    }
}

/// The set-up of the 2006 and 2008 papers, which every variant shares.
const SETUP: [(&str, &str); 2] = [("light.view", "shared"), ("light.tracer", "wyman2005")];

/// What differs from the paper's run in every table, and why.
const DEVIATIONS: [&str; 3] = [
    "the eye sees the receiver region straight on, without the glass, at the size stated: the picture that is timed is the one that is judged",
    "the photon image has two columns, position and flux (16 or 32 bits a channel), and all copies take both",
    "splats are Gaussians whose weights sum to one, of 3 texels in a map of maps.side; varying splats are drawn behind combine-all (the paper does not say behind which), as large as photons lie apart on the receiver",
];

/// What of a frame a column is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// What the light sees, and the tracer, ms.
    Photons,
    /// Photon image to vertex buffer, ms.
    Copy,
    /// Photons to map, ms.
    Gather,
    /// The rest: the picture with the finished map, ms.
    Eye,
    /// The whole, in frames a second.
    Rate,
}

impl Part {
    /// Whether a stage belongs to it.
    pub fn holds(self, stage: &str) -> bool {
        let part = match stage {
            _ if self == Self::Rate => self,
            s if s.starts_with("light/") => Self::Photons,
            s if s.starts_with("maps/copy") => Self::Copy,
            s if s.starts_with("maps/") => Self::Gather,
            _ => Self::Eye,
        };
        part == self
    }

    /// What it is of a frame with these stages.
    pub fn of(self, stages: &[String], frame: &FrameTimes) -> f64 {
        if self == Self::Rate {
            return 1e3 / frame.span_ms;
        }
        stages.iter().zip(&frame.passes).filter(|(stage, _)| self.holds(stage)).map(|(_, ms)| ms).sum()
    }
}

/// A way to gather: the settings beside [`SETUP`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// What it renders.
    pub subject: Subject,
    /// `maps.gather`.
    pub gather: &'static str,
    /// `maps.copy`.
    pub copy: &'static str,
    /// `maps.splat`, where it is no column's.
    pub splat: Option<&'static str>,
}

const COPY_2006: Variant = Variant { subject: Subject::Still, gather: "copy", copy: "16-32", splat: None };
const COPY_32: Variant = Variant { copy: "32-32", ..COPY_2006 };
const COPY_16: Variant = Variant { copy: "16-16", ..COPY_2006 };

impl Variant {
    /// In words.
    pub fn name(self) -> String {
        match (self.gather, self.splat) {
            (_, Some(splat)) => splat.to_owned(),
            ("copy", _) => format!("copy {}", self.copy),
            (gather, _) => gather.to_owned(),
        }
    }

    /// Everything that it sets, for N² photons.
    pub fn set(self, side: u32) -> Vec<(String, String)> {
        let own = [("maps.gather", self.gather), ("maps.copy", self.copy)];
        let splat = self.splat.into_iter().flat_map(|splat| [("maps.traverse", "fetch"), ("maps.splat", splat)]);
        let pairs = SETUP.into_iter().chain(own).chain(splat).map(|(key, value)| (key.to_owned(), value.to_owned()));
        pairs.chain([("light.side".to_owned(), side.to_string())]).collect()
    }

    /// As settings.
    pub fn settings(self, side: u32) -> Result<Settings, SettingError> {
        let (mut settings, known) = (Settings::default(), crate::renderer::all_settings());
        self.set(side).iter().try_for_each(|(key, value)| settings.set(&known, key, value))?;
        Ok(settings)
    }
}

/// N of the pictures of Fig. 7: the paper does not say; few enough for the noise that it shows.
const PICTURED: u32 = 512;

/// Who measures a figure, with which N, and in which part of the frame; else what is missing.
pub fn runs(published: &Published, figure: &Figure) -> Result<(Variant, u32, Part), String> {
    let (variant, part) = of_column(published, figure)?;
    match figure.row {
        Label::Number(n) => Ok((variant, n, part)),
        Label::Words(_) => Ok((variant, PICTURED, part)),
    }
}

fn of_column(published: &Published, figure: &Figure) -> Result<(Variant, Part), String> {
    let column = figure.column.as_str();
    let gather = |gather| Variant { gather, ..COPY_32 };
    match (published.id.as_str(), column) {
        ("maps.table1" | "maps.table3", "render_photon_buffer") => Ok((COPY_2006, Part::Photons)),
        ("maps.table1", "copy_to_vertex_array") => Ok((COPY_2006, Part::Copy)),
        ("maps.table1", "splat_photons") | ("maps.table3", "gather_copy") => Ok((COPY_2006, Part::Gather)),
        ("maps.table1", "eye_render") | ("maps.table3", "final_caustic_map") => Ok((COPY_2006, Part::Eye)),
        ("maps.table2", "f16_to_f32") => Ok((COPY_2006, Part::Copy)),
        ("maps.table2", "f32_to_f32") => Ok((COPY_32, Part::Copy)),
        ("maps.table2", "f16_to_f16") => Ok((COPY_16, Part::Copy)),
        ("maps.table3", "final_multires_map") => Ok((gather("varying-multires"), Part::Eye)),
        ("maps.table3", column) => match known(column.trim_start_matches("gather_")) {
            Some(word) => Ok((gather(word), Part::Gather)),
            None => Err("not run here yet".to_owned()),
        },
        ("maps.table4", column) => {
            let variant = match column {
                "copy" => COPY_2006,
                "varying" => gather("varying-multires"),
                other => gather(known(other).ok_or("not run here yet")?),
            };
            Ok((Variant { subject: Subject::Animation, ..variant }, Part::Rate))
        }
        ("maps.figure7", _) => {
            let splat = match figure.row.text().as_str() {
                "constant" => "fixed",
                "thin lens" => "thin-lens",
                "interpolated" => "interpolated",
                _ => "varying",
            };
            Ok((Variant { splat: Some(splat), ..gather("own") }, Part::Gather))
        }
        ("maps.table5", _) => Err("no scene with two lights round a model ships yet".to_owned()),
        _ => {
            let method = published.method();
            let built = methods::ALL.iter().any(|m| m.name() == method);
            Err(if built { "not run here yet".to_owned() } else { format!("the method `{method}` is not built yet") })
        }
    }
}

/// The preset of `maps.gather` that a column's key names.
fn known(column: &str) -> Option<&'static str> {
    let words = ["fetch", "hierarchical", "combine-last", "combine-all", "varying-multires", "varying-single"];
    words.into_iter().find(|word| *word == column.replace('_', "-"))
}
