//! How fast the truth is: photons a second and core, traced alone and counted in pixels, and seconds to an error.
//!
//! One JSON object a line on stdout. The error is measured, not estimated: against the other estimator, driven to a
//! change of 10⁻⁵ by its last doubling, a hundredth of what is asked for. The time of measuring is not counted.

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use nephroid::{
    image::Layers,
    metrics::{Pair, bare_irradiance, relmse, relmse_standard},
    scene::Scene,
    truth::{Estimator, Goal, Run, Task, light::Photons, trace::Space},
};

const SAMPLES: u64 = 5;
const PHOTONS: u64 = 1 << 20;
const SIDE: u32 = 256;
/// The error that is to be reached.
const ERROR: f64 = 1e-3;
/// The other estimator's change by doubling.
const REFERENCE: f64 = 1e-5;

fn main() {
    for scene in ["glass-sphere", "bunny"] {
        let scene = Scene::load(scene, &[]).expect("a shipped scene");
        line(&format!("truth/traced/{}", scene.name), "photons/s/core", &traced(&scene));
        line(&format!("truth/counted/{}", scene.name), "photons/s/core", &counted(&scene));
    }
    let scene = Scene::load("glass-sphere", &[]).expect("a shipped scene");
    let exact = finished(&scene, &task(Estimator::Cells, None, Some(REFERENCE)));
    let judged = to_error(&scene, &exact, Estimator::Photons, &caustic_error);
    line("truth/photons-to-relmse-1e-3/glass-sphere-256", "s", &judged);
    let standard = to_error(&scene, &exact, Estimator::Photons, &whole_error);
    line("truth/photons-to-relmse-standard-1e-3/glass-sphere-256", "s", &standard);
    let cells = to_error(&scene, &exact, Estimator::Cells, &caustic_error);
    line("truth/cells-to-relmse-1e-3/glass-sphere-256", "s", &cells);
}

fn line(name: &str, unit: &str, samples: &[f64]) {
    let median = nephroid::stats::median(samples);
    println!("{}", serde_json::json!({ "name": name, "unit": unit, "samples": samples, "median": median }));
}

fn task(estimator: Estimator, photons: Option<u64>, noise: Option<f64>) -> Task {
    task_of([SIDE; 2], estimator, Goal { photons, noise })
}

fn task_of(size: [u32; 2], estimator: Estimator, goal: Goal) -> Task {
    let paths = nephroid::scene::PathClass::Transmit2;
    Task { estimator, paths, camera: "region".to_owned(), size, seed: 1, goal }
}

fn alone<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread").install(work)
}

fn rate(mut work: impl FnMut(u64)) -> Vec<f64> {
    work(0);
    let sample = |k: u64| {
        let start = Instant::now();
        work(k);
        PHOTONS as f64 / start.elapsed().as_secs_f64()
    };
    (1..=SAMPLES).map(sample).collect()
}

fn traced(scene: &Scene) -> Vec<f64> {
    let space = Space::new(scene);
    let photons = Photons::new(&space, scene.paths, 1, PHOTONS);
    rate(|k| {
        let balance = photons.chunk(k, |_| ());
        assert!(balance.landed.x > 0.0, "nothing landed");
    })
}

fn counted(scene: &Scene) -> Vec<f64> {
    let space = Space::new(scene);
    let goal = Goal { photons: Some(PHOTONS), noise: None };
    rate(|seed| {
        let task = Task { seed, ..task_of([64; 2], Estimator::Photons, goal) };
        let mut run = Run::new(&space, &scene.cameras["region"], &task);
        assert!(alone(|| run.advance(1, |_, _| ControlFlow::Continue(()))).finished);
    })
}

fn finished(scene: &Scene, task: &Task) -> Layers {
    let space = Space::new(scene);
    let mut run = Run::new(&space, &scene.cameras["region"], task);
    run.advance(rayon::current_num_threads(), |_, _| ControlFlow::Continue(()));
    run.layers().expect("layers")
}

/// Seconds on all cores until the measured error is low enough, in each of some runs.
fn to_error(
    scene: &Scene,
    exact: &Layers,
    estimator: Estimator,
    error: &dyn Fn(&Scene, &Layers, &Layers) -> f64,
) -> Vec<f64> {
    let space = Space::new(scene);
    let once = |seed: u64| {
        let task = Task { seed, ..task(estimator, None, Some(f64::MIN_POSITIVE)) };
        let mut run = Run::new(&space, &scene.cameras["region"], &task);
        let (mut spent, mut since, mut next) = (Duration::ZERO, Instant::now(), 1);
        run.advance(rayon::current_num_threads(), |run, standing| {
            spent += since.elapsed();
            // Looked at every tenth more photons: no more of them is wasted.
            let reached = standing.photons >= next && {
                next = standing.photons + standing.photons / 10;
                error(scene, &run.layers().expect("layers"), exact) <= ERROR
            };
            since = Instant::now();
            if reached { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        spent.as_secs_f64()
    };
    (1..=3).map(once).collect()
}

fn values(layers: &Layers, names: &[&str]) -> Vec<f64> {
    let of = |name: &&str| layers.get(name).expect("a layer").data().iter().map(|x| f64::from(*x)).collect::<Vec<_>>();
    names.iter().map(of).reduce(|a, b| a.iter().zip(b).map(|(a, b)| a + b).collect()).unwrap_or_default()
}

fn pair(image: &Layers, exact: &Layers, names: &[&str]) -> Pair {
    Pair::new(3, values(image, names), values(exact, names), None).expect("layers of one size")
}

fn caustic_error(scene: &Scene, image: &Layers, exact: &Layers) -> f64 {
    relmse(&pair(image, exact, &["irradiance.caustic"]), bare_irradiance(scene)).value
}

fn whole_error(_: &Scene, image: &Layers, exact: &Layers) -> f64 {
    relmse_standard(&pair(image, exact, &["irradiance.caustic", "irradiance.direct"])).value
}
