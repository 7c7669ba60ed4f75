//! Caustic maps from emission to finished irradiance: seconds to an error, beside the light tracer on the CPU; and energy.
//!
//! One JSON object a line on stdout. `gathers/to-…` is the least time of a frame (device, all stages) among photons, map sides, eye samples
//! and ways to gather that reach the error, `gathers/cpu-to-…` what the truth's own photons take to it on all cores, and
//! `gathers/share-of-cpu/…` the first over the second. The error is measured twice, against a reference without either: the
//! judged one of the caustic, and the standard one of direct light and caustic together. What the CPU does not reach
//! in its time is extrapolated, its squared error being one over its photons: such lines say so.

use std::{
    ops::ControlFlow,
    path::Path,
    sync::Arc,
    time::{Duration, Instant},
};

use nephroid::{
    gpu::{Gpu, GpuOptions},
    image::Layers,
    lab::timing::least_warmup,
    methods,
    metrics::{Pair, bare_irradiance, relmse, relmse_standard},
    renderer::{Frame, Job, Providers, Renderer, all_settings},
    scene::Scene,
    settings::Settings,
    stats::median,
    truth::{Estimator, Goal, Run, Task, trace::Space},
};
use serde_json::json;

type Fault = Box<dyn std::error::Error>;

/// Scenes and errors that are reached for.
const SCENES: [&str; 3] = ["glass-sphere", "water", "bunny"];
const ERRORS: [f64; 2] = [1e-2, 1e-3];
/// What is tried.
const GATHERS: [&str; 4] = ["fixed", "cells", "elliptic", "combine-exact"];
const PHOTONS: [&str; 6] = ["32", "64", "128", "256", "512", "1024"];
const MAPS: [&str; 3] = ["128", "256", "512"];
/// Samples a pixel along each axis: the map is filtered already, so that more of them cost more than they show.
const EYE: [&str; 2] = ["1", "2"];
/// Pixels a side, those of the references.
const SIDE: u32 = 128;
/// Timed frames, after one.
const FRAMES: usize = 5;
/// The most time of the CPU's tracer for an error.
const PATIENCE: Duration = Duration::from_secs(60);
/// Of the CPU's time that a frame takes.
const SHARE: f64 = 1e-2;
/// Deposited over arrived, off one by.
const ENERGY: f64 = 1e-3;

fn main() {
    if let Err(error) = bench() {
        eprintln!("error: {error}");
        std::process::exit(1);
    }
}

fn bench() -> Result<(), Fault> {
    let gpu = Gpu::new(&GpuOptions::default())?;
    eprintln!("device: {}", gpu.info().label());
    for name in SCENES {
        to_errors(&gpu, &Arc::new(Scene::load(name, &[])?))?;
    }
    for (name, _) in Scene::shipped() {
        let scene = Arc::new(Scene::load(name, &[])?);
        for gather in GATHERS {
            let job = job(&scene, &[("maps.gather", gather), ("light.side", "256")], "region")?;
            energy(&gpu, &job, &format!("{name}/{gather}"))?;
        }
    }
    // Receivers that lie behind each other, each with a layer of its own, which the region's camera does not see.
    let room = Arc::new(Scene::load("room", &[])?);
    for gather in GATHERS {
        // Few photons: cells of so many branches are dear.
        let job = job(&room, &[("maps.gather", gather), ("light.side", "64")], "main")?;
        energy(&gpu, &job, &format!("room-main/{gather}"))?;
    }
    Ok(())
}

/// Flux in the map against what arrived.
fn energy(gpu: &Gpu, job: &Job, what: &str) -> Result<(), Fault> {
    let mut renderer = Renderer::new(gpu, job)?;
    renderer.frame(&Frame::default())?;
    let account = renderer.account()?;
    if let Some(ratio) = renderer.energy(&account)?.ratio {
        at_most(&format!("gathers/energy/{what}"), "1", &[(ratio - 1.0).abs()], ENERGY, false);
    }
    Ok(())
}

fn renderer(gpu: &Gpu, scene: &Arc<Scene>, set: &[(&str, &str)]) -> Result<Renderer, Fault> {
    Ok(Renderer::new(gpu, &job(scene, set, "region")?)?)
}

fn job(scene: &Arc<Scene>, set: &[(&str, &str)], camera: &str) -> Result<Job, Fault> {
    let mut settings = Settings::default();
    for (key, value) in set {
        settings.set(&all_settings(), key, value)?;
    }
    let providers = Providers::of(methods::find("maps")?);
    Ok(Job { scene: scene.clone(), providers, settings, camera: camera.to_owned(), size: [SIDE; 2] })
}

/// Both errors of a picture.
fn errors(scene: &Scene, image: &Layers, exact: &Layers) -> [f64; 2] {
    let pair =
        |names: &[&str]| Pair::new(3, values(image, names), values(exact, names), None).expect("layers of one size");
    let judged = relmse(&pair(&["irradiance.caustic"]), bare_irradiance(scene)).value;
    [judged, relmse_standard(&pair(&["irradiance.caustic", "irradiance.direct"])).value]
}

fn values(layers: &Layers, names: &[&str]) -> Vec<f64> {
    let of = |name: &&str| layers.get(name).expect("a layer").data().iter().map(|x| f64::from(*x)).collect::<Vec<_>>();
    names.iter().map(of).reduce(|a, b| a.iter().zip(b).map(|(a, b)| a + b).collect()).unwrap_or_default()
}

/// One way to render: its frames, s, and its errors.
struct Tried {
    seconds: Vec<f64>,
    errors: [f64; 2],
    what: String,
}

fn to_errors(gpu: &Gpu, scene: &Arc<Scene>) -> Result<(), Fault> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/references").join(format!("{}.exr", scene.name));
    let (exact, _) = Layers::from_exr(&std::fs::read(file)?)?;
    let mut tried = Vec::new();
    let ways = GATHERS.iter().flat_map(|gather| MAPS.iter().flat_map(move |map| EYE.map(|eye| [*gather, *map, eye])));
    for [gather, map, eye] in ways {
        for photons in PHOTONS {
            let set = [("maps.gather", gather), ("light.side", photons), ("maps.side", map), ("eye.samples", eye)];
            let mut renderer = renderer(gpu, scene, &set)?;
            renderer.frame(&Frame::default())?;
            let errors = errors(scene, &renderer.layers()?, &exact);
            if errors.iter().all(|error| *error > ERRORS[0]) {
                continue; // no time of its is asked for
            }
            let begun = Instant::now();
            while begun.elapsed() < least_warmup(gpu.info()) {
                renderer.frame(&Frame::default())?;
            }
            let mut frame = || renderer.frame(&Frame::default()).map(|times| times.span_ms / 1e3);
            let seconds = (0..FRAMES).map(|_| frame()).collect::<Result<Vec<_>, _>>()?;
            let what = format!("{gather}, {photons}² photons, map {map}², {eye} x {eye} eye samples");
            tried.push(Tried { seconds, errors, what });
            if errors.iter().all(|error| *error <= ERRORS[1]) {
                break; // more photons only take longer
            }
        }
    }
    let cpu = on_cpu(scene, &exact);
    for (measure, name) in ["relmse", "relmse-standard"].into_iter().enumerate() {
        for (at, error) in ERRORS.into_iter().enumerate() {
            let of = format!("{name}-{error:.0e}/{}-{SIDE}", scene.name);
            let reached = tried.iter().filter(|t| t.errors[measure] <= error);
            let best = reached.min_by(|a, b| median(&a.seconds).total_cmp(&median(&b.seconds)));
            let (cpu, extrapolated) = cpu[measure][at];
            line(json!({ "name": format!("gathers/cpu-to-{of}"), "unit": "s", "samples": [cpu], "median": cpu,
                "extrapolated": extrapolated }));
            let Some(best) = best else {
                eprintln!("{of}: reached by nothing that was tried");
                continue;
            };
            eprintln!("{of}: {}", best.what);
            line(json!({ "name": format!("gathers/to-{of}"), "unit": "s", "samples": best.seconds,
                "median": median(&best.seconds) }));
            let shares: Vec<f64> = best.seconds.iter().map(|s| s / cpu).collect();
            at_most(&format!("gathers/share-of-cpu/{of}"), "ratio", &shares, SHARE, extrapolated);
        }
    }
    Ok(())
}

/// By measure and error, seconds on all cores until photons of the truth reach it, and whether that was extrapolated. What
/// the looks at the error take is not counted.
fn on_cpu(scene: &Scene, exact: &Layers) -> [[(f64, bool); 2]; 2] {
    let space = Space::new(scene);
    let goal = Goal { photons: None, noise: Some(f64::MIN_POSITIVE) };
    let (paths, camera) = (scene.paths, "region".to_owned());
    let task = Task { estimator: Estimator::Photons, paths, camera, size: [SIDE; 2], seed: 1, goal };
    let mut run = Run::new(&space, &scene.cameras["region"], &task);
    let (mut spent, mut since, mut next) = (Duration::ZERO, Instant::now(), 1);
    let (mut now, mut reached) = ([f64::INFINITY; 2], [[None; 2]; 2]);
    run.advance(rayon::current_num_threads(), |run, standing| {
        spent += since.elapsed();
        if standing.photons >= next || spent >= PATIENCE {
            // Looked at every tenth more photons: no more of them is wasted.
            next = standing.photons + standing.photons / 10;
            now = errors(scene, &run.layers().expect("layers"), exact);
            for (reached, now) in reached.iter_mut().zip(now) {
                for (reached, _) in reached.iter_mut().zip(ERRORS).filter(|(_, error)| now <= *error) {
                    reached.get_or_insert(spent.as_secs_f64());
                }
            }
        }
        since = Instant::now();
        let done = reached.iter().flatten().all(Option::is_some) || spent >= PATIENCE;
        if done { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let spent = spent.as_secs_f64();
    std::array::from_fn(|measure| {
        std::array::from_fn(|at| match reached[measure][at] {
            Some(seconds) => (seconds, false),
            None => (spent * now[measure] / ERRORS[at], true),
        })
    })
}

fn line(value: serde_json::Value) {
    println!("{value}");
}

fn at_most(name: &str, unit: &str, samples: &[f64], bound: f64, extrapolated: bool) {
    let median = median(samples);
    line(json!({ "name": name, "unit": unit, "samples": samples, "median": median, "at_most": bound,
        "holds": median <= bound, "extrapolated": extrapolated }));
}
