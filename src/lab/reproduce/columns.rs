//! What of a table can be run: each figure is some stages of frames, or of their counts.

use super::{
    asked::{Asked, Place},
    claims,
    subject::Subject,
    text,
};
use crate::{
    gpu::FrameTimes,
    lab::papers::{Figure, Published},
    methods,
    settings::{SettingError, Settings},
};

/// The set-up of the 2006 and 2008 papers, which every variant shares.
const SETUP: [(&str, &str); 2] = [("light.view", "shared"), ("light.tracer", "wyman2005")];

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
    /// All that makes light below water, ms.
    Water,
    /// What finds it before anything is seen, ms.
    Texture,
    /// What finds it where it is seen, ms.
    Surface,
}

impl Part {
    /// Whether a stage belongs to it.
    pub fn holds(self, stage: &str) -> bool {
        let part = match stage {
            _ if self == Self::Rate => self,
            s if self == Self::Water => return Self::Texture.holds(s) || Self::Surface.holds(s),
            s if self == Self::Texture => return s.starts_with("waves/"),
            s if self == Self::Surface => return s == "eye/surface",
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

/// A way to gather, or to light water: the settings beside [`SETUP`].
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
    /// `maps.cull`.
    pub cull: &'static str,
    /// `waves.variant` in the place of all these.
    pub waves: Option<&'static str>,
    /// How many times as many pixels the picture has along a side, of one eye sample each, where that is what is measured.
    pub magnified: Option<u32>,
}

pub const COPY_2006: Variant = Variant {
    subject: Subject::Still,
    gather: "copy",
    copy: "16-32",
    splat: None,
    cull: "clip",
    waves: None,
    magnified: None,
};
const COPY_32: Variant = Variant { copy: "32-32", ..COPY_2006 };
const COPY_16: Variant = Variant { copy: "16-16", ..COPY_2006 };

impl Variant {
    /// In words.
    pub fn name(self) -> String {
        if let Some(waves) = self.waves {
            let note = self.subject.note().map_or(String::new(), |note| format!(", {note}"));
            let magnified = self.magnified.map_or(String::new(), |times| format!(", {times} x the picture"));
            return format!("{waves}{note}{magnified}");
        }
        let name = match (self.gather, self.splat) {
            (_, Some(splat)) => splat.to_owned(),
            ("copy", _) => format!("copy {}", self.copy),
            (gather, _) => gather.to_owned(),
        };
        let cull = if self.cull == "clip" { "" } else { ", discarded in a geometry shader" };
        let model = self.subject.model().map_or(String::new(), |model| format!("{model}, "));
        format!("{model}{name}{cull}")
    }

    /// The name with N, and of what it is the number; none where it depends on none.
    pub fn at(self, side: u32) -> String {
        match self.waves {
            None => format!("{}, {side}² photons", self.name()),
            Some("vertex") => format!("{}, {side}² cells", self.name()),
            Some("texture") => format!("{}, {side}² texels", self.name()),
            Some(_) => self.name(),
        }
    }

    /// The method's name.
    pub fn method(self) -> &'static str {
        if self.waves.is_some() { "waves" } else { "maps" }
    }

    /// How many times as long as at the N before a frame takes, at most: photons and vertices grow as N², and of water what
    /// the eye does is the most.
    pub fn growth(self) -> f64 {
        if self.waves.is_some() { 1.0 } else { 4.0 }
    }

    /// Whether its picture is one of those that the paper shows, which are held against a truth.
    pub fn is_judged(self) -> bool {
        self.magnified.is_none() && self.subject.is_judged()
    }

    /// The picture's size, where pictures have `size`.
    pub fn size(self, size: [u32; 2]) -> [u32; 2] {
        size.map(|side| side * self.magnified.unwrap_or(1))
    }

    /// The same of another subject.
    pub fn with(self, subject: Subject) -> Self {
        Self { subject, ..self }
    }

    /// Everything that it sets, for N² photons.
    pub fn set(self, side: u32) -> Vec<(String, String)> {
        if let Some(waves) = self.waves {
            let size = match waves {
                "vertex" => Some("waves.mesh"),
                "texture" => Some("waves.side"),
                _ => None,
            };
            let size = size.map(|key| (key.to_owned(), side.to_string()));
            let samples = self.magnified.map(|_| ("eye.samples".to_owned(), "1".to_owned()));
            let own = [("waves.variant".to_owned(), waves.to_owned())];
            return own.into_iter().chain(size).chain(samples).collect();
        }
        let own = [("maps.gather", self.gather), ("maps.copy", self.copy), ("maps.cull", self.cull)];
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

/// N of what has none: any would do, and this one is always run.
const LEAST: u32 = 32;

/// What a figure is of a run; else what is missing.
pub fn asked(published: &Published, figure: &Figure) -> Result<Asked, String> {
    match published.id.as_str() {
        "maps.table5" => of_models(figure),
        "maps.text" => text::asked(&figure.column),
        "waves.text" => claims::asked(figure),
        "waves.figure9" => Ok(Asked::Time(of_water(figure))),
        _ => {
            let (variant, part) = of_column(published, figure)?;
            let side = figure.row.number().unwrap_or(PICTURED);
            Ok(Asked::Time(Place { variant, side, part }))
        }
    }
}

/// A row of Table 5: its model, then N; or its triangles.
fn of_models(figure: &Figure) -> Result<Asked, String> {
    let row = figure.row.text();
    let (model, side) = row.split_once(", ").unwrap_or((&row, ""));
    let subject = Subject::room(model)?;
    match side.parse() {
        Ok(side) => {
            Ok(Asked::Time(Place { variant: gather("varying-multires").with(subject), side, part: Part::Rate }))
        }
        Err(_) => Ok(Asked::Triangles(subject)),
    }
}

/// A row of the water paper's Fig. 9: what is lit, then N, where it has one.
fn of_water(figure: &Figure) -> Place {
    let row = figure.row.text();
    let (what, side) = row.split_once(", ").unwrap_or((&row, ""));
    let waves = match what {
        "per vertex" => "vertex",
        "texture" => "texture",
        _ => "pixel",
    };
    Place { variant: water(waves, Subject::Water), side: side.parse().unwrap_or(LEAST), part: Part::Water }
}

/// A variant of water.
pub fn water(waves: &'static str, subject: Subject) -> Variant {
    Variant { waves: Some(waves), ..COPY_32 }.with(subject)
}

/// A preset in the set-up of the papers.
pub fn gather(gather: &'static str) -> Variant {
    Variant { gather, ..COPY_32 }
}

fn of_column(published: &Published, figure: &Figure) -> Result<(Variant, Part), String> {
    let column = figure.column.as_str();
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
            Ok((variant.with(Subject::Animation), Part::Rate))
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
