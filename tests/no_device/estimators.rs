//! Two estimators that share no reconstruction, photons in pixels and cells of light, hold each other on every shipped
//! scene; where they must differ, that is measured too.

use std::ops::ControlFlow;

use nephroid::{
    image::{Layers, Provenance},
    metrics::bare_irradiance,
    scene::{PathClass, Scene},
    truth::{Estimator, Goal, Run, Task, trace::Space},
};

/// Pixels a side of the pictures, and of the blocks over which they are held against each other.
const SIDE: usize = 64;
const BLOCK: usize = 8;
const BLOCKS: usize = (SIDE / BLOCK) * (SIDE / BLOCK);
/// Independent runs of photons: their spread is the standard error.
const RUNS: u64 = 16;

/// Share of the total flux by which the two may differ.
const TOTAL: f64 = 0.002;
/// Standard errors, or share of E₀, by which a block may differ.
const ERRORS: f64 = 4.0;
const OF_E0: f64 = 0.01;
/// The standard error of the median lit block, a share of its irradiance: with less the bound above would be the one of
/// E₀ alone, with more it would hold anything.
const MEDIAN_ERROR: std::ops::RangeInclusive<f64> = 0.003..=0.005;
/// A block is lit from this share of E₀ on.
const LIT: f64 = 0.1;
/// Share of the flux that cells may leave unresolved; measured up to 0.2 %, where flat water's border meets the grid.
const UNRESOLVED: f64 = 0.004;

fn scene(name: &str) -> Scene {
    Scene::load(name, &[]).unwrap()
}

fn task(estimator: Estimator, paths: PathClass, camera: &str, seed: u64, photons: u64) -> Task {
    let goal = Goal { photons: Some(photons), noise: None };
    Task { estimator, paths, camera: camera.to_owned(), size: [SIDE as u32; 2], seed, goal }
}

fn run(scene: &Scene, task: &Task) -> (Layers, Provenance) {
    let space = Space::new(scene);
    let mut run = Run::new(&space, &scene.cameras[&task.camera], task);
    assert!(run.advance(rayon::current_num_threads(), |_, _| ControlFlow::Continue(())).finished);
    (run.layers().unwrap(), run.provenance())
}

/// Mean irradiance (all bands) of each block without a masked pixel.
fn blocks(layers: &Layers) -> Vec<Option<f64>> {
    let (caustic, mask) = (layers.get("irradiance.caustic").unwrap().data(), layers.get("mask").unwrap().data());
    let block = |k: usize| {
        let (x, y) = (k % (SIDE / BLOCK) * BLOCK, k / (SIDE / BLOCK) * BLOCK);
        let pixels = || (0..BLOCK * BLOCK).map(move |p| (y + p / BLOCK) * SIDE + x + p % BLOCK);
        let clear = pixels().all(|p| mask[p] == 0.0);
        let sum: f64 = pixels().flat_map(|p| &caustic[3 * p..3 * p + 3]).map(|e| f64::from(*e)).sum();
        clear.then_some(sum / (3 * BLOCK * BLOCK) as f64)
    };
    (0..BLOCKS).map(block).collect()
}

/// Mean and standard error of each block over independent runs.
fn photons(scene: &Scene, paths: PathClass, camera: &str, each: u64) -> Vec<Option<(f64, f64)>> {
    let runs: Vec<_> =
        (0..RUNS).map(|seed| blocks(&run(scene, &task(Estimator::Photons, paths, camera, seed, each)).0)).collect();
    let n = RUNS as f64;
    let of_block = |k: usize| {
        let values: Vec<f64> = runs.iter().map(|r| r[k]).collect::<Option<_>>()?;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
        Some((mean, (variance / n).sqrt()))
    };
    (0..BLOCKS).map(of_block).collect()
}

/// Holds cells on a grid of `cells`² against RUNS times `each` photons, block by block.
fn hold(name: &str, paths: Option<PathClass>, camera: &str, each: u64, cells: u64) {
    let scene = scene(name);
    let (paths, e0) = (paths.unwrap_or(scene.paths), bare_irradiance(&scene));
    let grid = |side: u64| run(&scene, &task(Estimator::Cells, paths, camera, 0, side * side));
    let (coarse, (fine, about)) = (blocks(&grid(cells).0), grid(2 * cells));
    let fine = blocks(&fine);
    let counted = photons(&scene, paths, camera, each);
    let both: Vec<_> =
        (0..BLOCKS).filter_map(|k| Some((counted[k]?, fine[k]?, (fine[k]? - coarse[k]?).abs()))).collect();
    let (mut sums, mut worst, mut moved, mut lit) = ([0.0; 2], 0.0f64, 0.0f64, vec![]);
    for ((mean, error), cell, change) in &both {
        sums = [sums[0] + cell, sums[1] + mean];
        let allowed = (ERRORS * error).max(OF_E0 * e0);
        worst = worst.max((cell - mean).abs() / allowed);
        moved = moved.max(change / (0.5 * allowed));
        if *mean >= LIT * e0 {
            lit.push(error / mean);
        }
    }
    let (total, median) = (sums[0] / sums[1] - 1.0, nephroid::stats::median(&lit));
    println!(
        "{name} {paths} {camera}: {} blocks, {} lit, median error {:.2} %; total {total:+.5}, worst block {worst:.2} of \
         what is allowed, own change {moved:.2}; unresolved {}",
        both.len(),
        lit.len(),
        100.0 * median,
        about["cells.unresolved"]
    );
    assert!(both.len() >= BLOCKS / 4 && !lit.is_empty(), "{name}: too little is seen to compare");
    // Through `main` few blocks are lit, and the total needs more photons than they; in a focus one block is the total.
    let wrong = camera == "region" && lit.len() > 1 && !MEDIAN_ERROR.contains(&median);
    assert!(!wrong, "{name}: the photons' median error is {median}: change their number");
    assert!(total.abs() <= TOTAL, "{name}: total {total}");
    assert!(worst <= 1.0, "{name}: a block is {worst} times what is allowed apart");
    assert!(moved <= 1.0, "{name}: doubling the grid moves a block by {moved} times what is allowed");
    assert!(about["cells.unresolved"].parse::<f64>().unwrap() <= UNRESOLVED, "{name}");
}

#[test]
fn on_the_glass_sphere() {
    hold("glass-sphere", None, "region", 76_000, 64);
}

#[test]
fn on_index_one() {
    hold("null", None, "region", 24_000, 64);
}

#[test]
fn on_the_moving_sphere() {
    hold("moving-sphere", None, "region", 17_000, 64);
}

#[test]
fn on_the_bending_knot() {
    hold("bending", None, "region", 60_000, 128);
}

#[test]
fn on_the_bunny() {
    hold("bunny", None, "region", 40_000, 128);
}

#[test]
fn on_flat_water() {
    hold("flat-water", None, "region", 190_000, 32);
}

#[test]
fn on_the_ring() {
    hold("ring", None, "region", 80_000, 128);
}

#[test]
fn on_a_sine_of_water() {
    hold("sine-water", None, "region", 190_000, 64);
}

#[test]
fn on_the_knot() {
    hold("knot", None, "region", 40_000, 128);
}

#[test]
fn on_a_pool() {
    hold("water", None, "region", 190_000, 128);
}

#[test]
fn in_a_focus() {
    hold("paraboloid", None, "region", 20_000, 32);
}

#[test]
fn through_a_pinhole() {
    hold("glass-sphere", None, "main", 200_000, 64);
}

#[test]
fn by_every_path() {
    hold("glass-sphere", Some(PathClass::All(8)), "region", 76_000, 64);
}

/// Share of their flux that few cells, each for one point of a light, may leave unresolved: those about a focus.
const FEW_CELLS: f64 = 0.1;

/// Photons start anywhere on a light with a size, cells at 64 points of it, by another map from the square.
fn hold_area(kind: &str, lamp: &str) {
    let scene = Scene::load("glass-sphere", &[("lights.sun".to_owned(), lamp.to_owned())]).unwrap();
    let e0 = bare_irradiance(&scene);
    let (layers, about) = run(&scene, &task(Estimator::Cells, scene.paths, "region", 0, 64 * 64));
    let counted = photons(&scene, scene.paths, "region", 20_000);
    let (mut sums, mut worst) = ([0.0; 2], 0.0f64);
    for (cell, counted) in blocks(&layers).into_iter().zip(counted) {
        let (Some(cell), Some((mean, error))) = (cell, counted) else { panic!("{kind}: the region is bare") };
        sums = [sums[0] + cell, sums[1] + mean];
        worst = worst.max((cell - mean).abs() / (ERRORS * error).max(OF_E0 * e0));
    }
    let (total, unresolved) = (sums[0] / sums[1] - 1.0, about["cells.unresolved"].parse::<f64>().unwrap());
    println!("{kind}: total {total:+.5}, worst block {worst:.2} of what is allowed, unresolved {unresolved:.3}");
    assert!(total.abs() <= TOTAL && worst <= 1.0 && unresolved <= FEW_CELLS, "{kind}: {total} {worst} {unresolved}");
}

#[test]
fn under_a_sun_of_five_degrees() {
    hold_area("sun", "{ directional = { direction = [0, -1, 0], irradiance = 1, angular_diameter = 5 } }");
}

#[test]
fn under_a_rectangle_that_shines() {
    hold_area("quad", "{ quad = { center = [0.5, 4, 0], u = [0.2, 0.1, 0], v = [0, 0, 0.3], power = 20 } }");
}
