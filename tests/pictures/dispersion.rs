//! Bands bent apart: each is what a scene of its own index makes of it, on the device, for the eye and in the truth.

use std::ops::ControlFlow;

use crate::common::{
    gpu,
    picture::{Picture, job_of, picture, scene},
};
use nephroid::{
    gpu::Gpu,
    image::Layers,
    renderer,
    scene::{MaterialKind, Scene},
    truth::{Estimator, Goal, Run, Task, trace::Space},
};

const INDICES: [f64; 3] = [1.45, 1.5, 1.6];
const SETTINGS: [(&str, &str); 2] = [("light.side", "128"), ("maps.side", "64")];

fn glass(ior: &str) -> Scene {
    scene("glass-sphere", &[("materials.glass.dielectric.ior", ior)])
}

fn apart() -> Scene {
    glass(&format!("{INDICES:?}"))
}

fn of(gpu: &Gpu, scene: Scene, camera: &str) -> Picture {
    picture(gpu, &job_of(scene, &SETTINGS, camera, [48, 48]))
}

fn band(layer: &[f32], band: usize) -> Vec<f32> {
    layer.iter().skip(band).step_by(3).copied().collect()
}

#[test]
fn each_band_is_a_scene_of_its_own_index() {
    let gpu = gpu();
    for camera in ["region", "main"] {
        let together = of(&gpu, apart(), camera);
        for (k, ior) in INDICES.into_iter().enumerate() {
            let alone = of(&gpu, glass(&ior.to_string()), camera);
            for layer in ["irradiance.caustic", "irradiance.direct", "direct", "radiance"] {
                let [a, b] = [&together, &alone].map(|picture| band(picture.layer(layer), k));
                assert!(a == b, "{camera}, {layer}: band {k} is not that of index {ior}");
            }
        }
        let [red, blue] = [0, 2].map(|k| band(together.layer("radiance"), k));
        assert!(red != blue, "{camera}: nothing was bent apart");
    }
}

fn truth(scene: &Scene, estimator: Estimator) -> Layers {
    let photons = if estimator == Estimator::Cells { 32 * 32 } else { 20_000 };
    let goal = Goal { photons: Some(photons), noise: None };
    let task = Task { estimator, paths: scene.paths, camera: "region".to_owned(), size: [16; 2], seed: 5, goal };
    let space = Space::new(scene);
    let mut run = Run::new(&space, &scene.cameras["region"], &task);
    run.advance(2, |_, _| ControlFlow::Continue(()));
    run.layers().unwrap()
}

#[test]
fn the_truth_bends_them_alike() {
    for estimator in [Estimator::Photons, Estimator::Cells] {
        let caustic = |scene: &Scene| truth(scene, estimator).get("irradiance.caustic").unwrap().data().to_vec();
        let together = caustic(&apart());
        for (k, ior) in INDICES.into_iter().enumerate() {
            let alone = caustic(&glass(&ior.to_string()));
            let [a, b] = [&together, &alone].map(|layer| band(layer, k));
            // Cells add the sheets of all bands in the order of their paths: the sums may differ by their rounding.
            let same = a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= f32::EPSILON * b.abs());
            assert!(same, "{estimator}: band {k} is not that of index {ior}");
        }
    }
}

/// The three passes that a scene without dispersion does not pay for, and the account that adds them up.
#[test]
fn only_dispersive_scenes_trace_bands_apart() {
    let photons = |scene: Scene| {
        let planned = renderer::plan(&job_of(scene, &SETTINGS, "region", [8, 8])).unwrap();
        let names = planned.plan.passes.iter().map(|p| p.name.clone());
        names.filter(|name| name.starts_with("light/photons")).collect::<Vec<_>>()
    };
    assert_eq!(photons(glass("1.5")), ["light/photons"]);
    assert_eq!(photons(glass("[1.5, 1.5, 1.5]")), ["light/photons"]);
    let bands = ["red", "green", "blue"].map(|band| format!("light/photons:sun.{band}"));
    assert_eq!(photons(apart()), bands);
    let gpu = gpu();
    let [apart, one] = [apart(), glass("1.5")].map(|scene| of(&gpu, scene, "region").account.emitted_w());
    assert!((apart / one - 1.0).abs() < 1e-6, "{apart} W of {one} W");
}

/// Crown glass by Cauchy's equation, and by name.
#[test]
fn indices_by_equation_and_by_name() {
    let index = |ior: &str| match &glass(ior).materials[0].kind {
        MaterialKind::Dielectric { ior, .. } => *ior,
        other => panic!("{other:?}"),
    };
    let bk7 = index("{ cauchy = [1.5046, 0.0042] }");
    // Tabulated for 0.611, 0.549 and 0.464 µm: 1.5159, 1.5186, 1.5245.
    for (found, tabulated) in bk7.into_iter().zip([1.5159, 1.5186, 1.5245]) {
        assert!((found - tabulated).abs() < 1e-3, "{found} for {tabulated}");
    }
    assert_eq!(index("diamond"), [2.4175; 3]);
    let error = Scene::load("glass-sphere", &[("materials.glass.ior".to_owned(), "diamont".to_owned())]).unwrap_err();
    assert!(error.to_string().contains("diamond"), "{error}");
    let error = Scene::load("glass-sphere", &[("materials.glass.ior".to_owned(), "{ cauchy = [99, 0] }".to_owned())]);
    assert!(error.unwrap_err().to_string().contains("index of refraction"));
}
