//! Media within media: told apart by their identity, on the device and in the truth, for light and for the eye.

use std::ops::ControlFlow;

use crate::common::{
    gpu,
    picture::{Picture, job_of, picture, worst, written},
};
use nephroid::{
    optics::fresnel,
    scene::{PathClass, Scene},
    truth::{Estimator, Goal, Run, Task, trace::Space},
};

const SIDE: u32 = 24;
const SETTINGS: [(&str, &str); 2] = [("light.side", "512"), ("maps.side", "64")];
/// Photons on a lattice of texels: [`SETTINGS`] gives dozens a texel.
const LATTICE: f64 = 2e-3;
/// Directions and shares in float32 over a few surfaces.
const TRACED: f64 = 1e-4;
/// Cells a side: those of a lamp all round are curved, and cut the region's border with an error of the order of their size
/// squared, 10⁻³ at 64.
const CELLS: u64 = 200;
/// What is left of that.
const CURVED: f64 = 3e-4;
/// The truth by cells under parallel light on flat sheets: float32 of its file.
const EXACT: f64 = 1e-6;

const INDICES: [f64; 4] = [1.33, 1.5, 1.7, 2.4];
/// 1/m, first band.
const ABSORPTION: [f64; 4] = [0.3, 0.1, 0.7, 0.2];

/// Sheets a tenth of a metre apart from y = 0 down, of these materials (m0, m1 …), over a floor at −1, under a sun.
fn sheets(materials: &[usize], sun: &str, camera: &str) -> Scene {
    let mut text = format!(
        "version = 1\ntitle = \"sheets\"\nunit = 1.0\npaths = \"transmit-1\"\nexposure = 0.0\n[region]\nreceiver = \"floor\"\n\
         center = [0.0, 0.0]\nhalf = [0.5, 0.5]\n[cameras.main.orthographic]\n{camera}\ntarget = [0.0, -1.0, 0.0]\n\
         up = [0.0, 0.0, -1.0]\nheight = 0.5\n[objects.floor]\nmaterial = \"white\"\n[objects.floor.quad]\n\
         center = [0.0, -1.0, 0.0]\nu = [1.0, 0.0, 0.0]\nv = [0.0, 0.0, -1.0]\n[materials.white.diffuse]\nalbedo = 0.8\n\
         [lights.sun.directional]\ndirection = {sun}\nirradiance = 1.0\n"
    );
    for (k, material) in materials.iter().enumerate() {
        let y = -0.1 * k as f64;
        text += &format!(
            "[objects.sheet{k}]\nmaterial = \"m{material}\"\n[objects.sheet{k}.quad]\ncenter = [0.0, {y}, 0.0]\n\
             u = [4.0, 0.0, 0.0]\nv = [0.0, 0.0, -4.0]\n"
        );
    }
    let mut used = materials.to_vec();
    used.sort_unstable();
    used.dedup();
    for m in used {
        let (ior, absorption) = (INDICES[m], ABSORPTION[m]);
        text += &format!("[materials.m{m}.dielectric]\nior = {ior:?}\nabsorption = [{absorption:?}, 0.0, 0.0]\n");
    }
    written(&text, &[])
}

/// Share of a ray's flux that passes the sheets to the floor, first band, from an angle of this cosine.
fn passes(materials: &[usize], cosine: f64) -> f64 {
    let (mut share, mut index, mut cosine) = (1.0, 1.0, cosine);
    for (k, m) in materials.iter().enumerate() {
        let next = INDICES[*m];
        share *= 1.0 - fresnel(cosine, index, next);
        let sine2 = (1.0 - cosine * cosine) * (index / next) * (index / next);
        (cosine, index) = ((1.0 - sine2).sqrt(), next);
        let metres = if k + 1 == materials.len() { 1.0 - 0.1 * k as f64 } else { 0.1 };
        share *= (-ABSORPTION[*m] * metres / cosine).exp();
    }
    share
}

const OVERHEAD: &str = "[0.0, -1.0, 0.0]";
const ABOVE: &str = "position = [0.0, 1.0, 0.0]";
/// A sun at 45°.
const SLANTING: &str = "[1.0, -1.0, 0.0]";

fn truth(scene: &Scene, paths: PathClass) -> Vec<f64> {
    let goal = Goal { photons: Some(CELLS * CELLS), noise: None };
    let task = Task { estimator: Estimator::Cells, paths, camera: "region".to_owned(), size: [SIDE; 2], seed: 0, goal };
    let space = Space::new(scene);
    let mut run = Run::new(&space, &scene.cameras["region"], &task);
    run.advance(2, |_, _| ControlFlow::Continue(()));
    let layers = run.layers().unwrap();
    layers.get("irradiance.caustic").unwrap().data().iter().step_by(3).map(|e| f64::from(*e)).collect()
}

fn first_band(picture: &Picture, layer: &str) -> Vec<f64> {
    picture.layer(layer).iter().step_by(3).map(|e| f64::from(*e)).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn light_through_two_sheets_meets_both_indices() {
    let gpu = gpu();
    for (sun, cosine) in [(OVERHEAD, 1.0), (SLANTING, 0.5f64.sqrt())] {
        for materials in [[0, 1], [1, 0], [3, 0]] {
            let scene = sheets(&materials, sun, ABOVE);
            let exact = cosine * passes(&materials, cosine);
            let exactly = truth(&scene, PathClass::Transmit2);
            let set = [SETTINGS[0], SETTINGS[1], ("light.paths", "transmit-2")];
            let found = first_band(&picture(&gpu, &job_of(scene, &set, "region", [SIDE; 2])), "irradiance.caustic");
            let of_truth = worst(exactly.iter().map(|e| e / exact - 1.0));
            let of_maps = mean(&found) / exact - 1.0;
            println!("{materials:?} {sun}: truth {of_truth:.1e}, maps {of_maps:+.1e}");
            assert!(of_truth <= EXACT && of_maps.abs() <= LATTICE, "{materials:?} {sun}: {of_truth} {of_maps}");
        }
    }
}

/// Two sheets of one material: the second lies within the medium that the first bounds, and is no interface.
#[test]
fn a_surface_within_its_own_medium_is_not_there() {
    let (gpu, scene) = (gpu(), sheets(&[0, 0], SLANTING, ABOVE));
    let cosine = 0.5f64.sqrt();
    let exact = cosine * passes(&[0, 0], cosine) / (1.0 - fresnel(refracted(cosine, 1.33), 1.33, 1.33));
    let exactly = truth(&scene, PathClass::Transmit1);
    let picture = picture(&gpu, &job_of(scene, &SETTINGS, "region", [SIDE; 2]));
    let found = mean(&first_band(&picture, "irradiance.caustic"));
    let of_truth = worst(exactly.iter().map(|e| e / exact - 1.0));
    println!("truth {of_truth:.1e}, maps {:+.1e}", found / exact - 1.0);
    assert!(of_truth <= EXACT && (found / exact - 1.0).abs() <= LATTICE, "{of_truth}, {found} for {exact}");
    assert_eq!(picture.account.counts[6], 0, "no photon met a surface too many");
}

fn refracted(cosine: f64, ior: f64) -> f64 {
    (1.0 - (1.0 - cosine * cosine) / (ior * ior)).sqrt()
}

/// A lamp in the middle of a ball of water in a ball of glass: both media are about it from the start.
#[test]
fn a_lamp_in_nested_balls() {
    let text = "version = 1\ntitle = \"balls\"\nunit = 1.0\npaths = \"transmit-2\"\nexposure = 0.0\n[region]\n\
        receiver = \"floor\"\ncenter = [0.0, 0.0]\nhalf = [1.0, 1.0]\n[cameras.main.pinhole]\n\
        position = [0.0, 3.0, 3.0]\ntarget = [0.0, 0.0, 0.0]\nfov_y = 30.0\n[objects.floor]\nmaterial = \"white\"\n\
        quad = { center = [0.0, -2.0, 0.0], u = [3.0, 0.0, 0.0], v = [0.0, 0.0, -3.0] }\n[objects.a]\n\
        material = \"m1\"\nsphere = { center = [0.0, 0.0, 0.0], radius = 1.0 }\n[objects.b]\nmaterial = \"m0\"\n\
        sphere = { center = [0.0, 0.0, 0.0], radius = 0.5 }\n[materials.white.diffuse]\nalbedo = 0.8\n\
        [materials.m0.dielectric]\nior = 1.33\nabsorption = [0.3, 0.0, 0.0]\n[materials.m1.dielectric]\nior = 1.5\n\
        absorption = [0.1, 0.0, 0.0]\n[lights.lamp.point]\nposition = [0.0, 0.0, 0.0]\nintensity = 1.0\n";
    let scene = written(text, &[]);
    let passes = (1.0 - fresnel(1.0, 1.33, 1.5)) * (1.0 - fresnel(1.0, 1.5, 1.0)) * f64::exp(-0.5 * (0.3 + 0.1));
    // Solid angle of the region from two metres above its middle: 4 asin(ab / …) of half edges 1 and 1.
    let solid_angle = 4.0 * (1.0f64 / 5.0).asin();
    let exact = passes * solid_angle / 4.0;
    let of_truth = mean(&truth(&scene, PathClass::Transmit2)) / exact - 1.0;
    let found = picture(&gpu(), &job_of(scene, &SETTINGS, "region", [SIDE; 2]));
    let of_maps = mean(&first_band(&found, "irradiance.caustic")) / exact - 1.0;
    println!("truth {of_truth:+.1e}, maps {of_maps:+.1e}");
    assert!(of_truth.abs() <= CURVED && of_maps.abs() <= LATTICE, "{of_truth} {of_maps}");
}

/// Four media deep: the truth by every path, and the eye straight down through all of them.
#[test]
fn four_media_deep() {
    let materials = [0, 1, 2, 3];
    let scene = sheets(&materials, SLANTING, ABOVE);
    let cosine = 0.5f64.sqrt();
    // Light that was reflected between sheets comes later, and adds what four transmissions alone do not bring.
    let (all, exact) = (truth(&scene, PathClass::All(4)), cosine * passes(&materials, cosine));
    let off = worst(all.iter().map(|e| e / exact - 1.0));
    assert!(off <= EXACT, "{off}");
    let picture = picture(&gpu(), &job_of(scene, &[("light.paths", "transmit-2"), SETTINGS[0]], "main", [SIDE; 2]));
    // Direct light reaches no floor under water: a lamp of its own does.
    assert!(first_band(&picture, "direct").iter().all(|l| *l == 0.0));
    let lamp = sheets(&materials, OVERHEAD, ABOVE);
    let text = lamp.source.text.replace(
        "[lights.sun.directional]\ndirection = [0.0, -1.0, 0.0]\nirradiance = 1.0",
        "[lights.lamp.point]\nposition = [0.0, -0.6, 0.0]\nintensity = 1.0",
    );
    let scene = written(&text, &[]);
    let set = [SETTINGS[0], ("eye.depth", "4")];
    let found = crate::common::picture::picture(&gpu(), &job_of(scene, &set, "main", [1, 1]));
    // Below the lamp: 0.4 m of the last medium, E = I/r²; the eye's ray passes four interfaces and the media between.
    let e = (-ABSORPTION[3] * 0.4f64).exp() / 0.16;
    let down = passes(&materials, 1.0);
    let exact = e * 0.8 / std::f64::consts::PI * down / (INDICES[3] * INDICES[3]);
    let off = first_band(&found, "direct")[0] / exact - 1.0;
    println!("truth {off:.1e}; eye {off:+.1e}");
    assert!(off.abs() <= TRACED, "{off}");
}
