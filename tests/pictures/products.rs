//! Scenes, tracers, classes, lights, views and cameras together: every pair of values of two of them meets in a picture
//! that is finite, keeps its balance and is the same again. `scripts/test --all` takes the whole product.
//!
//! Values are read from the shipped scenes and the settings' own words, so that what is added there is tested here.

use crate::common::{
    gpu,
    picture::{Picture, all_ended, job_of, picture, scene},
};
use glam::DVec3;
use nephroid::{
    gpu::Gpu,
    passes::{PlanError, account::Account},
    renderer::{Job, RenderError, all_settings, plan},
    scene::{Beam, Light, LightKind, Scene},
    settings::Setting,
};
use std::collections::BTreeSet;

/// Buckets against what was emitted, and the map against what it took, as in `energy`.
const SUMS: f64 = 1e-5;
const DEPOSITED: f64 = 0.001;
/// Lights in the places of the scene's own: a lamp over the specular object, one beside it that no one view serves, a spot
/// that it lies half in, and its own with the lamp.
const LIGHTS: [&str; 5] = ["own", "lamp", "beside", "spot", "two"];
const CAMERAS: [&str; 2] = ["main", "region"];

/// One value of each dimension.
type Row = [&'static str; 6];

/// Stands for the family of classes `all:N`.
const ALL_PATHS: &str = "all:4";

/// The words of a setting; of a family of words, those that are written out.
fn words(key: &str) -> Vec<&'static str> {
    let setting = all_settings().into_iter().find(|s| s.key() == key);
    match setting {
        Some(Setting::Choice(choice)) => choice.words.to_vec(),
        Some(Setting::Word(word)) => word.forms.iter().copied().filter(|form| (word.accepts)(form)).collect(),
        _ => panic!("{key} is no choice among words"),
    }
}

/// Values of scene, tracer, class, view, light, camera.
fn dimensions() -> [Vec<&'static str>; 6] {
    let scenes = Scene::shipped().map(|(name, _)| name).collect();
    let mut classes = words("light.paths");
    classes.push(ALL_PATHS);
    [scenes, words("light.tracer"), classes, words("light.view"), LIGHTS.to_vec(), CAMERAS.to_vec()]
}

/// Every combination.
fn product(of: &[Vec<&'static str>; 6]) -> Vec<Row> {
    let none = vec![["" as &'static str; 6]];
    (0..6).fold(none, |rows, k| {
        let with =
            |row: Row| of[k].iter().map(move |value| std::array::from_fn(|i| if i == k { *value } else { row[i] }));
        rows.into_iter().flat_map(with).collect()
    })
}

/// Pairs of values that meet in a row.
fn pairs(row: &Row) -> impl Iterator<Item = (usize, &'static str, usize, &'static str)> {
    let row = *row;
    (0..6).flat_map(move |a| (a + 1..6).map(move |b| (a, row[a], b, row[b])))
}

/// Few rows in which every pair meets: always the first of those that hold most that have not met.
fn pairwise(all: &[Row]) -> Vec<Row> {
    let mut open: BTreeSet<_> = all.iter().flat_map(pairs).collect();
    let mut chosen = Vec::new();
    while !open.is_empty() {
        let gain = |row: &Row| pairs(row).filter(|pair| open.contains(pair)).count();
        let best = all.iter().rev().max_by_key(|row| gain(row)).expect("a row for every pair");
        let met: BTreeSet<_> = pairs(best).collect();
        open.retain(|pair| !met.contains(pair));
        chosen.push(*best);
    }
    chosen
}

/// Where a scene's specular things lie: their middle and half their largest side.
fn specular(scene: &Scene) -> (DVec3, f64) {
    let of =
        scene.objects.iter().filter(|o| scene.materials[o.material].is_specular()).filter_map(|o| o.shape.bounds());
    let all = of.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]).unwrap_or([-DVec3::ONE, DVec3::ONE]);
    (0.5 * (all[0] + all[1]), 0.5 * (all[1] - all[0]).max_element())
}

fn lit(name: &str, light: &str) -> Scene {
    let mut scene = scene(name, &[]);
    let (middle, reach) = specular(&scene);
    let at = |x: f64, y: f64| middle + reach * DVec3::new(x, y, 0.2);
    let point = |position| LightKind::Point { position, intensity: [3.0, 2.0, 1.0] };
    let cosine = |degrees: f64| degrees.to_radians().cos();
    let spot = |position: DVec3| {
        let axis = (at(0.5, 0.0) - position).normalize();
        let beam = Beam { axis, inner: 1.0 - cosine(4.0), outer: 1.0 - cosine(12.0) };
        LightKind::Spot { position, beam, intensity: [1.0, 2.0, 3.0], slide: None }
    };
    let lamp = |kind| Light { name: "lamp".to_owned(), kind };
    match light {
        "lamp" => scene.lights = vec![lamp(point(at(0.4, 4.0)))],
        "beside" => scene.lights = vec![lamp(point(at(0.1, 1.02)))],
        "spot" => scene.lights = vec![lamp(spot(at(0.2, 4.0)))],
        "two" => scene.lights.push(lamp(point(at(-0.4, 3.0)))),
        _ => {}
    }
    scene
}

fn job(row: &Row) -> Job {
    let [name, tracer, class, view, light, camera] = *row;
    let set = [
        ("light.tracer", tracer),
        ("light.paths", class),
        ("light.view", view),
        ("light.side", "64"),
        ("maps.side", "48"),
        ("eye.samples", "1"),
    ];
    job_of(lit(name, light), &set, camera, [16, 12])
}

/// A refusal says what, why and what to do instead.
fn is_refused(row: &Row, job: &Job) -> bool {
    match plan(job) {
        Ok(_) => false,
        Err(RenderError::Plan(PlanError::Refused { what, reason, remedy })) => {
            assert!(!what.is_empty() && !reason.is_empty() && !remedy.is_empty(), "{row:?}");
            println!("{row:?}: {what}: {reason}");
            true
        }
        Err(error) => panic!("{row:?}: {error}"),
    }
}

fn judge(row: &Row, picture: &Picture) {
    let Account { counts, flux_w, other_paths_w, .. } = &picture.account;
    all_ended(&picture.account, row[2].parse().unwrap_or(picture.renderer.scene().paths));
    let sum = flux_w[1..].iter().sum::<f64>() + other_paths_w;
    assert!((sum - flux_w[0]).abs() <= SUMS * flux_w[0], "{row:?}: {sum} W in buckets, {} W emitted", flux_w[0]);
    assert!(flux_w.iter().chain([other_paths_w]).all(|w| *w >= 0.0), "{row:?}: {flux_w:?} {other_paths_w}");
    match picture.energy.ratio {
        Some(ratio) => assert!((ratio - 1.0).abs() <= DEPOSITED, "{row:?}: ratio {ratio}"),
        None => assert_eq!((counts[1], picture.energy.deposited_w), (0, 0.0), "{row:?}"),
    }
    for layer in picture.layers.iter() {
        assert!(layer.data().iter().all(|v| *v >= 0.0), "{row:?}: {} is below zero", layer.name());
    }
}

/// Renders each row twice. A layer that differs, or a balance that does not hold, is named with its row.
fn hold(gpu: &Gpu, rows: &[Row]) {
    let (mut rendered, mut lit, mut refused) = (BTreeSet::new(), 0, 0);
    for row in rows {
        let job = job(row);
        if is_refused(row, &job) {
            refused += 1;
            continue;
        }
        let (once, again) = (picture(gpu, &job), picture(gpu, &job));
        judge(row, &once);
        assert!(once.layers == again.layers && once.account == again.account, "{row:?}: two runs differ");
        rendered.insert((row[0], row[1]));
        lit += u32::from(once.account.counts[1] > 0);
    }
    println!("{} rows: {refused} refused, {lit} with light in the map", rows.len());
    // No scene may be refused, or dark, with every tracer and class.
    let [scenes, tracers, ..] = dimensions();
    let all = scenes.iter().flat_map(|s| tracers.iter().map(move |t| (*s, *t)));
    let missing: Vec<_> = all.filter(|pair| !rendered.contains(pair)).collect();
    assert!(missing.is_empty(), "never rendered: {missing:?}");
    assert!(3 * lit as usize > rows.len() - refused, "{lit} of {} rows have light in the map", rows.len());
}

#[test]
fn every_pair_of_values_holds() {
    let all = product(&dimensions());
    let mut rows = pairwise(&all);
    let met: BTreeSet<_> = rows.iter().flat_map(pairs).collect();
    assert_eq!(met, all.iter().flat_map(pairs).collect());
    // A tracer may refuse the rows in which it meets a scene: then one more, which it does not.
    let planned = |row: &Row| plan(&job(row)).is_ok();
    let rendered: BTreeSet<_> = rows.iter().filter(|row| planned(row)).map(|row| (row[0], row[1])).collect();
    let pairs: BTreeSet<_> = all.iter().map(|row| (row[0], row[1])).collect();
    for pair in pairs.difference(&rendered) {
        rows.extend(all.iter().find(|row| (row[0], row[1]) == *pair && planned(row)));
    }
    println!("{} rows of {}", rows.len(), all.len());
    hold(&gpu(), &rows);
}

#[test]
#[ignore = "the whole product, a quarter of an hour: scripts/test --all"]
fn every_combination_holds() {
    hold(&gpu(), &product(&dimensions()));
}
