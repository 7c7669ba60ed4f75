//! What of a table can be run: each column is some stages of a frame of one variant.

use crate::{
    gpu::FrameTimes,
    lab::papers::Published,
    methods,
    settings::{SettingError, Settings},
};

/// The scene that stands in for the paper's.
pub const SCENE: &str = "glass-sphere";

/// The set-up of the 2006 and 2008 papers, which every variant shares.
const SETUP: [(&str, &str); 2] = [("light.view", "shared"), ("light.tracer", "wyman2005")];

/// What differs from the paper's run, and why.
pub const DEVIATIONS: [&str; 4] = [
    "the scene is glass-sphere: the model and the light of the paper's Fig. 7 are not published as data",
    "the eye sees the receiver region straight on, without the glass, at the size stated: the picture that is timed is the one that is judged",
    "the photon image has two columns, position and flux (16 or 32 bits a channel), and all copies take both",
    "splats are Gaussians whose weights sum to one, of 3 texels in a map of maps.side",
];

/// Which stages of a frame a column is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// What the light sees, and the tracer.
    Photons,
    /// Photon image to vertex buffer.
    Copy,
    /// Photons to map.
    Gather,
    /// The rest: the picture with the finished map.
    Eye,
}

impl Part {
    /// Whether a stage belongs to it.
    pub fn holds(self, stage: &str) -> bool {
        let part = match stage {
            s if s.starts_with("light/") => Self::Photons,
            s if s.starts_with("maps/copy") => Self::Copy,
            s if s.starts_with("maps/gather") => Self::Gather,
            _ => Self::Eye,
        };
        part == self
    }

    /// What it takes of a frame with these stages, ms.
    pub fn of(self, stages: &[String], frame: &FrameTimes) -> f64 {
        stages.iter().zip(&frame.passes).filter(|(stage, _)| self.holds(stage)).map(|(_, ms)| ms).sum()
    }
}

/// A way to gather: the settings beside [`SETUP`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// `maps.gather`.
    pub gather: &'static str,
    /// `maps.copy`.
    pub copy: &'static str,
}

const COPY_2006: Variant = Variant { gather: "copy", copy: "16-32" };
const COPY_32: Variant = Variant { gather: "copy", copy: "32-32" };
const COPY_16: Variant = Variant { gather: "copy", copy: "16-16" };
const FETCH: Variant = Variant { gather: "fetch", copy: "32-32" };

impl Variant {
    /// In words.
    pub fn name(self) -> String {
        if self.gather == "copy" { format!("copy {}", self.copy) } else { self.gather.to_owned() }
    }

    /// Everything that it sets, for N² photons.
    pub fn set(self, side: u32) -> Vec<(String, String)> {
        let own = [("maps.gather", self.gather), ("maps.copy", self.copy)];
        let pairs = SETUP.into_iter().chain(own).map(|(key, value)| (key.to_owned(), value.to_owned()));
        pairs.chain([("light.side".to_owned(), side.to_string())]).collect()
    }

    /// As settings.
    pub fn settings(self, side: u32) -> Result<Settings, SettingError> {
        let (mut settings, known) = (Settings::default(), crate::renderer::all_settings());
        self.set(side).iter().try_for_each(|(key, value)| settings.set(&known, key, value))?;
        Ok(settings)
    }
}

/// Who measures a column of a table, and in which part of the frame; else what is missing.
pub fn runs(published: &Published, column: &str) -> Result<(Variant, Part), String> {
    let no_gather = |name: &str| Err(format!("maps.gather has no `{name}` yet"));
    match (published.id.as_str(), column) {
        ("maps.table1" | "maps.table3", "render_photon_buffer") => Ok((COPY_2006, Part::Photons)),
        ("maps.table1", "copy_to_vertex_array") => Ok((COPY_2006, Part::Copy)),
        ("maps.table1", "splat_photons") | ("maps.table3", "gather_copy") => Ok((COPY_2006, Part::Gather)),
        ("maps.table1", "eye_render") | ("maps.table3", "final_caustic_map") => Ok((COPY_2006, Part::Eye)),
        ("maps.table2", "f16_to_f32") => Ok((COPY_2006, Part::Copy)),
        ("maps.table2", "f32_to_f32") => Ok((COPY_32, Part::Copy)),
        ("maps.table2", "f16_to_f16") => Ok((COPY_16, Part::Copy)),
        ("maps.table3", "gather_fetch") => Ok((FETCH, Part::Gather)),
        ("maps.table3", "final_multires_map") => no_gather("varying-multires"),
        ("maps.table3", gather) => no_gather(&gather.trim_start_matches("gather_").replace('_', "-")),
        ("maps.table4", "copy" | "fetch") => Err("frame rates over an animation are not measured here yet".to_owned()),
        ("maps.table4", gather) => no_gather(&gather.replace('_', "-")),
        ("maps.table5", _) => no_gather("hierarchical"),
        _ => {
            let method = published.method();
            let built = methods::ALL.iter().any(|m| m.name() == method);
            Err(if built { "not run here yet".to_owned() } else { format!("the method `{method}` is not built yet") })
        }
    }
}
