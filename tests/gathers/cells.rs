//! Cells of light: what they bring is what arrives, whatever they are cut by, and the sphere's caustic is its closed form.

use std::f64::consts::TAU;

use super::common::{
    gpu, job,
    picture::{Picture, job_of, picture, rewritten, written},
};
use nephroid::{
    gpu::Gpu,
    renderer,
    truth::closed::{GlassSphere, Illumination, SphereCaustic},
};

/// Flux deposited against what arrived: float32 shares of quads down to 64 times as long as wide; measured 8·10⁻⁷.
const EXACT: f64 = 1e-5;
/// What arrives by cells against the centres' photons: a silhouette is cut at other places; measured 4·10⁻².
const SAMPLED: f64 = 0.06;

fn cells(gpu: &Gpu, scene: &str, set: &[(&str, &str)]) -> Picture {
    let all: Vec<_> = [("maps.splat", "cells"), ("maps.side", "64")].iter().chain(set).copied().collect();
    picture(gpu, &job(scene, &all, "region", [24, 24]))
}

/// Nothing is lost or made; what arrives is what photons say, within how coarsely they say it.
fn judge(what: &str, picture: &Picture, sampled: f64) {
    let counted = picture.energy.counted.expect("cells count themselves");
    let ratio = picture.energy.ratio.unwrap_or_else(|| panic!("{what}: nothing arrives"));
    let beside = counted.arrived_w / picture.energy.valid_w - 1.0;
    let points = counted.points_w / counted.arrived_w;
    println!("{what}: {:+.1e} deposited, {beside:+.1e} arrived, {points:.1e} as points, {counted:?}", ratio - 1.0);
    assert!((ratio - 1.0).abs() <= EXACT, "{what}: {ratio}");
    assert!(beside.abs() <= sampled, "{what}: {counted:?}, {:?}", picture.energy);
}

#[test]
fn all_that_arrives_is_deposited() {
    let gpu = gpu();
    for (scene, class, tracer, side) in [
        ("glass-sphere", "transmit-2", "bvh", "97"),
        ("glass-sphere", "transmit-2", "fixed-point", "64"),
        ("bunny", "transmit-2", "bvh", "40"),
        ("bunny", "transmit-2", "bvh follow", "32"),
        ("gem", "transmit-2", "bvh", "64"),
        ("paraboloid", "reflect-1", "bvh", "64"),
        ("sine-water", "transmit-1", "wyman2005", "3"), // each cell folds more than once
        ("bunny", "all:4", "bvh", "24"),
        ("room", "all:3", "bvh", "12"),
    ] {
        let (tracer, reflected) = tracer.split_once(' ').unwrap_or((tracer, "drop"));
        let reflected = ("light.total_reflection", reflected);
        let set = [("light.paths", class), ("light.tracer", tracer), reflected, ("light.side", side)];
        let what = format!("{scene} {class} {tracer} {side}²");
        judge(&what, &cells(&gpu, scene, &set), if ["3", "12"].contains(&side) { f64::INFINITY } else { SAMPLED });
    }
}

#[test]
fn a_map_s_border_cuts_cells_without_loss() {
    let gpu = gpu();
    for half in ["[0.3, 0.2]", "[0.01, 0.01]"] {
        let set = [("scene.region.half", half), ("light.side", "32"), ("maps.side", "16")];
        judge(&format!("region {half}"), &cells(&gpu, "glass-sphere", &set), f64::INFINITY);
    }
}

/// Texels beside the plate's edge that belong to the focus, which lies under it and is narrower than a splat.
const FOCUS: usize = 4;
/// Flux of the focus and of either side of the plate's edge, of all: splats blur across it; measured 0.0025.
const PARTED: f64 = 0.005;

/// Halves of a caustic on a plate and on the floor below it.
#[test]
fn cells_that_land_on_two_receivers_give_each_its_own() {
    let gpu = gpu();
    let plate = "\n[objects.plate]\nmaterial = \"white\"\n[objects.plate.quad]\ncenter = [1.0, -1.3, 0.0]\n\
                 u = [1.0, 0.0, 0.0]\nv = [0.0, 0.0, -2.0]\n";
    let scene = written(&rewritten("glass-sphere", &[], plate), &[]);
    let set = [("maps.splat", "cells"), ("light.side", "64"), ("maps.side", "128")];
    for camera in ["region", "main"] {
        judge(camera, &picture(&gpu, &job_of(scene.clone(), &set, camera, [32, 32])), SAMPLED);
    }
    // The floor's own map: what of it lies beside the plate and what under it, W, as many more photons have it.
    let halves = |set: &[(&str, &str)]| {
        let (map, side) = picture(&gpu, &job_of(scene.clone(), set, "region", [32, 32])).map();
        let flux = |columns: std::ops::Range<usize>| -> f64 {
            (0..side * side).filter(|k| columns.contains(&(k % side))).map(|k| f64::from(map[4 * k])).sum()
        };
        [flux(0..side / 2 - FOCUS), flux(side / 2 - FOCUS..side / 2 + FOCUS), flux(side / 2 + FOCUS..side)]
    };
    let (ours, splats) = (halves(&set), halves(&[("light.side", "512"), ("maps.side", "128")]));
    println!("beside the plate and under it: {ours:.4?} W, {splats:.4?} W by fixed splats");
    let all: f64 = splats.iter().sum();
    assert!(ours.iter().zip(splats).all(|(a, b)| (a - b).abs() < PARTED * all), "{ours:?} {splats:?}");
}

#[test]
fn one_cell_one_photon_and_none() {
    let gpu = gpu();
    // The sphere in one texel, whose corners all miss it.
    let one = cells(&gpu, "glass-sphere", &[("light.side", "1")]);
    judge("one cell", &one, f64::INFINITY);
    let counted = one.energy.counted.unwrap();
    assert_eq!((counted.samples, counted.refined), (1 + 4 + 36, 1), "no neighbour shares an edge");
    // A tracer that cannot look between texels leaves the one photon a point.
    let point = cells(&gpu, "glass-sphere", &[("light.side", "1"), ("light.tracer", "fixed-point")]);
    judge("one photon", &point, EXACT);
    let counted = point.energy.counted.unwrap();
    assert_eq!((counted.points_w, counted.samples), (counted.arrived_w, 1 + 4));
    // What water reflects goes up, and there is no ceiling.
    let none = cells(&gpu, "flat-water", &[("light.side", "16"), ("light.paths", "reflect-1")]);
    assert!(none.account.emitted() > 0 && none.account.counts[1] == 0, "{:?}", none.account.counts);
    assert_eq!((none.energy.ratio, none.sum("irradiance.caustic")), (None, 0.0));
}

#[test]
fn cells_repeat_themselves_bit_by_bit() {
    let gpu = gpu();
    for class in ["transmit-2", "all:4"] {
        let [a, b] = [(), ()].map(|()| cells(&gpu, "bunny", &[("light.side", "40"), ("light.paths", class)]));
        assert_eq!(a.layers, b.layers, "{class}");
        assert_eq!(a.energy, b.energy, "{class}");
    }
}

#[test]
fn what_cells_cannot_do_is_refused_with_the_reason() {
    for (set, reason) in [
        (("light.layers", "15"), "has memory for"),
        (("maps.traverse", "fetch"), "added in integers"),
        (("maps.target", "multires"), "however many"),
        (("maps.side", "4096"), "128 MiB"),
    ] {
        let all = [("light.paths", "all:4"), ("maps.splat", "cells"), set];
        let text = match renderer::plan(&job("glass-sphere", &all, "region", [8, 8])) {
            Err(error) => error.to_string(),
            Ok(_) => panic!("{set:?} is planned"),
        };
        assert!(text.contains("maps.splat=cells") && text.contains(reason), "{text}");
    }
}

#[test]
fn cells_that_nobody_asked_for_give_way_where_their_layers_have_no_room() {
    let shared = [("light.view", "shared"), ("scene.lights.sun.angular_diameter", "5.0"), ("light.area_samples", "32")];
    for (scene, camera, set, cells) in [
        ("two-lights", "main", &[("maps.side", "1024")][..], true),
        ("two-lights", "main", &[("maps.side", "1200")], false),
        ("two-lights", "region", &[("maps.side", "1200")], false), // as through any other camera
        ("glass-sphere", "main", &[("maps.side", "2048")], true),
        ("glass-sphere", "main", &[("maps.side", "4096")], false),
        ("glass-sphere", "region", &shared, false),
        ("glass-sphere", "region", &shared[..2], true),
    ] {
        let all = [&[("maps.splat", "auto")], set].concat();
        let plan =
            renderer::plan(&job(scene, &all, camera, [8, 8])).unwrap_or_else(|e| panic!("{scene}, {set:?}: {e}")).plan;
        let said = plan.left_out.iter().filter(|l| l.name == "maps/cells" && l.reason.contains("128 MiB")).count();
        assert_eq!(plan.passes.iter().any(|pass| pass.name.starts_with("maps/cells")), cells, "{scene}, {set:?}");
        assert_eq!(said, usize::from(!cells), "{scene}, {set:?}: said once");
    }
    let asked = [("maps.gather", "cells"), ("maps.side", "1200")];
    let Err(refused) = renderer::plan(&job("two-lights", &asked, "main", [8, 8])) else { panic!("it is planned") };
    assert!(refused.to_string().contains("maps.splat=fixed"), "{refused}");
}

/// Pixels a side of the pictures that are held against the closed form, and what they see of the floor, m.
const PIXELS: usize = 64;
const ACROSS: f64 = 3.0;
/// Parts of a pixel's side by which the closed form's rings and their arcs are cut: a pixel's irradiance is then right to
/// 10⁻³, and relMSE to 10⁻⁶.
const PARTS: f64 = 40.0;

/// W/m² of each pixel under the glass sphere, by the flux inside circles.
fn closed_form(floor: f64) -> Vec<f64> {
    let glass = GlassSphere { radius: 1.0, ior: 1.5, absorption: 0.0, floor };
    let caustic = SphereCaustic::new(glass, Illumination::Parallel { irradiance: 1.0 }).unwrap();
    let pixel = ACROSS / PIXELS as f64;
    let step = pixel / PARTS;
    let rings = (ACROSS / 2f64.sqrt() / step).ceil() as usize;
    let radii: Vec<f64> = (0..=rings).map(|k| k as f64 * step).collect();
    let mut picture = vec![0.0; PIXELS * PIXELS];
    for (k, pair) in caustic.table(&radii).windows(2).enumerate() {
        let r = (k as f64 + 0.5) * step;
        let arcs = (TAU * r / step).ceil().max(64.0);
        for arc in 0..arcs as usize {
            let (sin, cos) = (TAU * (arc as f64 + 0.5 + 0.618 * k as f64) / arcs).sin_cos();
            let [x, y] = [r * cos, r * sin].map(|at| ((at + 0.5 * ACROSS) / pixel).floor() as usize);
            if x < PIXELS && y < PIXELS && r * cos >= -0.5 * ACROSS && r * sin >= -0.5 * ACROSS {
                picture[y * PIXELS + x] += (pair[1] - pair[0]) / arcs / (pixel * pixel);
            }
        }
    }
    picture
}

/// Floor below the centre, photons a side, and bounds on relMSE by the judged measure of cells and of ellipses, twice what
/// was measured.
const CLOSED: [(f64, &str, [f64; 2]); 2] = [(1.2, "64", [2.5e-4, 8.5e-3]), (2.0, "64", [7e-4, 7.5e-3])];

#[test]
fn the_sphere_s_caustic_is_its_closed_form() {
    let gpu = gpu();
    for (floor, side, bounds) in CLOSED {
        let reference = closed_form(floor);
        let center = format!("[0, -{floor}, 0]");
        let relmse = |splat: &str| {
            let set = [
                ("scene.objects.floor.quad.center", center.as_str()),
                ("maps.splat", splat),
                ("light.side", side),
                ("maps.side", "512"),
            ];
            let seen = picture(&gpu, &job("glass-sphere", &set, "region", [PIXELS as u32; 2]));
            let floor = 0.1f64.powi(2); // of the sun's irradiance, 1 W/m²
            let each = seen.mean("irradiance.caustic").into_iter().zip(&reference);
            each.map(|(x, r)| (x - r).powi(2) / (r * r + floor)).sum::<f64>() / reference.len() as f64
        };
        let [cells, elliptic, fixed] = ["cells", "elliptic", "fixed"].map(relmse);
        println!("floor {floor}, {side}²: cells {cells:.2e}, ellipses {elliptic:.2e} of {bounds:?}, fixed {fixed:.2e}");
        assert!(cells <= bounds[0] && cells < 0.1 * fixed, "{cells} {fixed}");
        assert!(elliptic <= bounds[1] && elliptic < 0.1 * fixed, "{elliptic} {fixed}");
    }
}

/// Mean difference from the sun's irradiance where a sphere of index 1 vanishes: eye samples and cells cut at the edge of
/// the shadow and of the light that restores it, each where it finds it.
const VANISHES: f64 = 2e-2;

#[test]
fn a_sphere_of_index_one_vanishes() {
    let gpu = gpu();
    let set = [("maps.splat", "cells"), ("light.side", "128"), ("maps.side", "256")];
    let seen = picture(&gpu, &job("null", &set, "region", [PIXELS as u32; 2]));
    let both = seen.mean("irradiance.caustic").into_iter().zip(seen.mean("irradiance.direct"));
    let off: Vec<f64> = both.map(|(a, b)| (a + b - 1.0).abs()).collect();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    println!("off by {mean:.1e} in the mean");
    assert!(mean <= VANISHES, "{mean}");
}
