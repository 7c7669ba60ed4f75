//! Tracers against `bvh`: the same light samples, texel by texel, so that the error of a paper's tracer can be told from
//! that of its method.

mod judge;
mod keep;
mod picture;
mod report;

use std::ops::ControlFlow;

use super::LabError;
use crate::{
    gpu::{FrameTimes, Gpu},
    passes::{
        PlanError,
        light::{self, SIDE, TRACER},
    },
    renderer::{Frame, Job, Providers, RenderError, Renderer, all_settings},
    scene::PathClass,
    stats,
};

pub use judge::{Figures, Spread, Verdict};
pub use picture::tracer_map;
pub use report::{Subject, TracersReport};

/// The tracer that all are held against: it is exact.
const REFERENCE: &str = "bvh";
/// The camera and size of the picture, which nobody looks at.
const PICTURE: (&str, [u32; 2]) = ("region", [8, 8]);

/// What a tracer did with a scene's light.
pub struct Compared {
    /// Its name.
    pub tracer: &'static str,
    /// Texels a side of each view.
    pub side: usize,
    /// Its stages, with their medians over the frames and summed over the views, ms.
    pub stages: Vec<(String, f64)>,
    /// How far it is off, or why it cannot do the scene.
    pub result: Result<Figures, String>,
    /// What each texel of each view shows.
    pub verdicts: Vec<Vec<Verdict>>,
}

/// Runs every tracer on the job's scene and settings, `repeat` timed frames each; `watch` is asked before each whether to
/// go on. What the job says of the tracer, the method and the camera does not count.
///
/// # Errors
/// Those of `bvh`, and of any other but that it refuses the scene; in class `all:N`, which no other tracer has, always.
pub fn compare_tracers(
    gpu: &Gpu,
    job: &Job,
    repeat: u32,
    map_texel: f64,
    watch: &mut dyn FnMut(&str) -> ControlFlow<()>,
) -> Result<Vec<Compared>, LabError> {
    if let class @ PathClass::All(_) = light::paths(&job.scene, &job.settings) {
        return Err(RenderError::from(several(class)).into());
    }
    let mut trace = |tracer: &str| {
        if watch(tracer).is_break() { Err(LabError::Interrupted) } else { Ok(traced(gpu, job, tracer, repeat)) }
    };
    let (exact, stages) = trace(REFERENCE)??;
    // Of a light with a size, each point has its share of the photons.
    let side = exact.first().map_or(job.settings.whole(&SIDE) as usize, |view| view.len().isqrt());
    let mut all = Vec::new();
    for &tracer in TRACER.words {
        let tested = if tracer == REFERENCE { Ok((exact.clone(), stages.clone())) } else { trace(tracer)? };
        all.push(match tested {
            Ok((ends, stages)) => {
                let (figures, verdicts) = judge::judge(&ends, &exact, map_texel);
                Compared { tracer, side, stages, result: Ok(figures), verdicts }
            }
            Err(RenderError::Plan(refused @ PlanError::Refused { .. })) => {
                Compared { tracer, side, stages: vec![], result: Err(refused.to_string()), verdicts: vec![] }
            }
            Err(other) => return Err(other.into()),
        });
    }
    Ok(all)
}

fn several(class: PathClass) -> PlanError {
    PlanError::Refused {
        what: format!("a comparison of tracers in class {class}"),
        reason: "each light sample leaves several photons, and only bvh finds them".into(),
        remedy: "set light.paths to reflect-1, transmit-1 or transmit-2".into(),
    }
}

type Traced = (Vec<Vec<keep::End>>, Vec<(String, f64)>);

/// One tracer's photons, and the medians of its stages.
fn traced(gpu: &Gpu, job: &Job, tracer: &str, repeat: u32) -> Result<Traced, RenderError> {
    let mut job = Job { camera: PICTURE.0.to_owned(), size: PICTURE.1, ..job.clone() };
    job.providers = Providers { surface: Some(&keep::Keep), medium: None };
    job.settings.set(&all_settings(), TRACER.key, tracer).expect("a tracer is one of its setting's words");
    let mut renderer = Renderer::new(gpu, &job)?;
    renderer.frame(&Frame::default())?; // compiled at its first run
    let frames = (0..repeat).map(|_| renderer.frame(&Frame::default())).collect::<Result<Vec<_>, _>>()?;
    let stages = medians(&renderer.stages(), &frames);
    // Without light on anything specular there is nothing to keep.
    let kept = renderer.stages().iter().any(|stage| stage.starts_with("tracers/"));
    Ok((if kept { keep::ends(&renderer)? } else { Vec::new() }, stages))
}

/// Stages of the tracer, those of all views together.
fn medians(stages: &[String], frames: &[FrameTimes]) -> Vec<(String, f64)> {
    let base = |stage: &str| stage.split(':').next().unwrap_or_default().to_owned();
    let mut names: Vec<String> = Vec::new();
    for stage in stages.iter().filter(|stage| stage.starts_with("light/")) {
        if !names.contains(&base(stage)) {
            names.push(base(stage));
        }
    }
    let of = |name: &String| {
        let sum = |frame: &FrameTimes| {
            stages.iter().zip(&frame.passes).filter(|(s, _)| base(s) == *name).map(|(_, ms)| ms).sum()
        };
        let samples: Vec<f64> = frames.iter().map(sum).collect();
        stats::median(&samples)
    };
    names.iter().map(|name| (name.clone(), of(name))).collect()
}
