//! Options, and the job that they make.

use std::{path::PathBuf, sync::Arc};

use clap::{Args, ValueEnum, builder::PossibleValue};

use super::Failure;
use crate::{
    gpu::{DeviceChoice, GpuOptions},
    lab::{Format, Sequence},
    methods::{self, Method},
    names::NoSuch,
    renderer::{self, Job, Providers},
    scene::Scene,
    settings::Settings,
};

#[derive(Args)]
pub struct RenderArgs {
    #[command(flatten)]
    pub job: JobArgs,
    #[command(flatten)]
    pub device: DeviceArgs,
    /// Frames before timing begins; where it is not 0, a GPU is kept busy for half a second at least, until its clocks are up (not for a single timed frame)
    #[arg(long, value_name = "W", default_value_t = 1)]
    pub warmup: u32,
    /// Timed frames
    #[arg(long, value_name = "R", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    pub repeat: u32,
    /// Time of the frame, s
    #[arg(long, value_name = "T", default_value = "0", value_parser = parse_time, allow_negative_numbers = true)]
    pub time: f64,
    /// Frames at times from FROM on, before TO, FPS a second (0..2@30): numbered pictures, a line of JSON for each in
    /// frames.jsonl, and what the stages took; the same command goes on where it was interrupted
    #[arg(long, value_name = "FROM..TO@FPS", conflicts_with_all = ["time", "repeat", "dump"], allow_hyphen_values = true)]
    pub sequence: Option<Sequence>,
    /// Seed of anything random; nothing is yet
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u32,
    #[command(flatten)]
    pub list: ListArgs,
    /// Images or buffers to write too, by the names that `nephroid plan` prints
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub dump: Vec<String>,
    /// Let RenderDoc capture every frame; it must be loaded
    #[arg(long)]
    pub capture: bool,
    /// Run under the validation layers; any message is a failure, and times mean nothing
    #[arg(long)]
    pub validation: bool,
    /// Folder for the results; made where it is missing
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

#[derive(Args)]
pub struct DeviceArgs {
    /// Device by index, part of its name, or UUID; by default discrete, then integrated, then software
    #[arg(long, value_name = "D")]
    device: Option<String>,
}

impl DeviceArgs {
    /// To open it with.
    pub fn options(&self) -> GpuOptions {
        let device = self.device.clone().map_or(DeviceChoice::Best, DeviceChoice::Named);
        GpuOptions { device, ..GpuOptions::default() }
    }
}

#[derive(Args)]
pub struct PlanArgs {
    #[command(flatten)]
    pub job: JobArgs,
    #[command(flatten)]
    pub list: ListArgs,
}

#[derive(Args)]
pub struct ScenesArgs {
    /// Say what is in this scene: a shipped one by name, or the path of a .toml file
    #[arg(value_name = "SCENE")]
    pub name: Option<String>,
    /// Print the scene's file as it is written
    #[arg(long, requires = "name", conflicts_with = "format")]
    pub source: bool,
    #[command(flatten)]
    pub list: ListArgs,
}

#[derive(Args)]
pub struct CompletionsArgs {
    /// The shell
    pub shell: clap_complete::Shell,
}

#[derive(Args)]
pub struct ListArgs {
    /// How to write to stdout
    #[arg(long, value_name = "FORMAT", default_value = "table")]
    pub format: Format,
}

/// What is rendered, and how.
#[derive(Args)]
pub struct JobArgs {
    /// A shipped scene by name, or the path of a .toml file
    pub scene: String,
    /// The method, in every slot that it fills; `none` for direct light alone [default: the first]
    #[arg(long, value_name = "M", value_parser = parse_method, conflicts_with_all = ["surface", "medium"])]
    method: Option<Choice>,
    /// The method of the slot `surface`
    #[arg(long, value_name = "M", value_parser = parse_method)]
    surface: Option<Choice>,
    /// The method of the slot `medium`
    #[arg(long, value_name = "M", value_parser = parse_method)]
    medium: Option<Choice>,
    /// A setting (`nephroid methods` lists them), or any value of the scene as scene.PATH=VALUE; repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = parse_set)]
    set: Vec<(String, String)>,
    /// `main`, `region` (the receiver region along its normal, specular objects hidden), or another of the scene's
    #[arg(long, value_name = "NAME", default_value = "main")]
    camera: String,
    /// Size of the picture, pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = parse_size)]
    size: [u32; 2],
}

/// A method, or none.
#[derive(Clone)]
struct Choice(Option<&'static dyn Method>);

impl JobArgs {
    /// Scene, providers and settings, checked; needs no device.
    pub fn job(&self) -> Result<Job, Failure> {
        let (scene, settings) = scene_and_settings(&self.scene, &self.set)?;
        let job = Job { scene, providers: self.providers(), settings, camera: self.camera.clone(), size: self.size };
        job.camera()?;
        Ok(job)
    }

    fn providers(&self) -> Providers {
        let chosen = |choice: &Option<Choice>| choice.as_ref().and_then(|c| c.0);
        match (&self.method, &self.surface, &self.medium) {
            (Some(Choice(method)), _, _) => method.map(Providers::of).unwrap_or_default(),
            (None, None, None) => methods::ALL.first().map(|m| Providers::of(*m)).unwrap_or_default(),
            (None, surface, medium) => Providers { surface: chosen(surface), medium: chosen(medium) },
        }
    }
}

/// A scene and settings as they are typed.
pub fn scene_and_settings(scene: &str, set: &[(String, String)]) -> Result<(Arc<Scene>, Settings), Failure> {
    let (of_scene, of_settings): (Vec<_>, Vec<_>) = set.iter().cloned().partition(|(key, _)| key.starts_with(SCENE));
    let known = renderer::all_settings();
    let mut settings = Settings::default();
    for (key, value) in &of_settings {
        settings.set(&known, key, value)?;
    }
    let overrides: Vec<_> = of_scene.into_iter().map(|(key, value)| (key[SCENE.len()..].to_owned(), value)).collect();
    Ok((Arc::new(Scene::load(scene, &overrides)?), settings))
}

/// What a key of the scene begins with.
const SCENE: &str = "scene.";

/// Larger than the images of any device, small enough to count bytes.
const LARGEST: u32 = 65536;

pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |side: &str| side.parse().ok().filter(|n| (1..=LARGEST).contains(n));
    text.split_once('x')
        .and_then(|(width, height)| Some([side(width)?, side(height)?]))
        .ok_or_else(|| format!("expected WIDTHxHEIGHT such as 640x480, each from 1 to {LARGEST}"))
}

pub fn parse_set(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.is_empty() => Ok((key.to_owned(), value.to_owned())),
        _ => Err("expected KEY=VALUE, such as light.side=1024 or scene.exposure=1".to_owned()),
    }
}

pub fn parse_noise(text: &str) -> Result<f64, String> {
    let value = text.strip_prefix("relmse=").and_then(|x| x.parse().ok());
    value.filter(|x: &f64| x.is_finite() && *x > 0.0).ok_or_else(|| "expected relmse=X with X above 0".to_owned())
}

pub fn parse_seconds(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|s: &f64| s.is_finite() && *s >= 0.0);
    value.ok_or_else(|| "expected a number of seconds".to_owned())
}

pub fn parse_time(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|t: &f64| t.is_finite()).ok_or_else(|| "expected a number of seconds".to_owned())
}

fn parse_method(text: &str) -> Result<Choice, NoSuch> {
    match text {
        "none" => Ok(Choice(None)),
        name => methods::find(name).map(|method| Choice(Some(method))),
    }
}

impl ValueEnum for Format {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Table, Self::Json, Self::Csv, Self::Markdown]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            Self::Table => "table",
            Self::Json => "json",
            Self::Csv => "csv",
            Self::Markdown => "md",
        }))
    }
}
