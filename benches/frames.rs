//! What moving costs a frame, and what a second light view does.
//!
//! One JSON object a line on stdout, samples in turn within one run. `frames/moving` is the device's time of a frame of
//! `moving-sphere` right after the scene has moved over that of the same frame again; what the host does before it (the
//! tree over the instances, the plan, the buffers' contents) is `frames/move`. `frames/two-views` is the time of all
//! stages of light and map under two suns over that under one.

use std::sync::Arc;

use nephroid::{
    gpu::{Gpu, GpuOptions},
    methods,
    renderer::{Frame, Job, Providers, Renderer, all_settings},
    scene::{Light, LightKind, Scene},
    settings::Settings,
    stats::median,
};

const SAMPLES: usize = 15;
/// Frames before timing begins.
const WARMUP: usize = 2;
/// A frame of a scene that has moved over one that has not.
const MOVING: f64 = 1.1;
/// Two views over one.
const VIEWS: f64 = 2.1;

fn main() {
    if let Err(error) = bench() {
        eprintln!("error: {error}");
        std::process::exit(1);
    }
}

fn bench() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::new(&GpuOptions::default())?;
    eprintln!("device: {}", gpu.info().label());
    moving(&gpu)?;
    two_views(&gpu)
}

fn renderer(gpu: &Gpu, scene: Scene) -> Result<Renderer, Box<dyn std::error::Error>> {
    let mut settings = Settings::default();
    settings.set(&all_settings(), "light.side", "1024")?;
    let providers = Providers::of(methods::find("maps")?);
    let job = Job { scene: Arc::new(scene), providers, settings, camera: "main".to_owned(), size: [256, 256] };
    let mut renderer = Renderer::new(gpu, &job)?;
    for _ in 0..WARMUP {
        renderer.frame(&Frame::default())?;
    }
    Ok(renderer)
}

/// On its way through the middle of the beam, a hundredth of a second a frame.
fn moving(gpu: &Gpu) -> Result<(), Box<dyn std::error::Error>> {
    let mut renderer = renderer(gpu, Scene::load("moving-sphere", &[])?)?;
    let (mut ratios, mut moves) = (vec![], vec![]);
    for k in 0..SAMPLES {
        let frame = Frame { time: 0.25 + 0.01 * k as f64, ..Frame::default() };
        let [moved, again] = [renderer.frame(&frame)?, renderer.frame(&frame)?].map(|times| times.span_ms);
        ratios.push(moved / again);
        moves.push(renderer.moved().ms);
    }
    at_most("frames/moving/moving-sphere", "ratio", &ratios, MOVING);
    line("frames/move/moving-sphere", "ms", &moves);
    Ok(())
}

/// The second sun stands a degree beside the first.
fn two_views(gpu: &Gpu) -> Result<(), Box<dyn std::error::Error>> {
    let one = Scene::load("glass-sphere", &[])?;
    let mut two = one.clone();
    let LightKind::Directional { direction, irradiance } = one.lights[0].kind else { return Err("no sun".into()) };
    let direction = (direction + glam::DVec3::X * 1f64.to_radians()).normalize();
    two.lights.push(Light { name: "second".to_owned(), kind: LightKind::Directional { direction, irradiance } });
    let (mut one, mut two) = (renderer(gpu, one)?, renderer(gpu, two)?);
    let of_light = |renderer: &mut Renderer| -> Result<f64, Box<dyn std::error::Error>> {
        let times = renderer.frame(&Frame::default())?.passes;
        let stages = renderer.stages();
        Ok(stages.iter().zip(times).filter(|(name, _)| !name.starts_with("eye/")).map(|(_, ms)| ms).sum())
    };
    let ratios = (0..SAMPLES).map(|_| Ok(of_light(&mut two)? / of_light(&mut one)?));
    at_most(
        "frames/two-views/glass-sphere",
        "ratio",
        &ratios.collect::<Result<Vec<_>, Box<dyn std::error::Error>>>()?,
        VIEWS,
    );
    Ok(())
}

fn line(name: &str, unit: &str, samples: &[f64]) {
    println!("{}", serde_json::json!({ "name": name, "unit": unit, "samples": samples, "median": median(samples) }));
}

fn at_most(name: &str, unit: &str, samples: &[f64], bound: f64) {
    let median = median(samples);
    println!(
        "{}",
        serde_json::json!({ "name": name, "unit": unit, "samples": samples, "median": median, "at_most": bound,
            "holds": median <= bound })
    );
}
