//! Mirrors of metal: Fresnel's equations for a complex index, on the device and in the truth.

use std::ops::ControlFlow;

use crate::common::{
    Probe, gpu,
    picture::{job_of, picture, written},
    random::Random,
};
use nephroid::{
    optics::fresnel_conductor,
    scene::{PathClass, Scene},
    truth::{Estimator, Goal, Run, Task, trace::Space},
};

/// Gold in red, green and blue.
const ETA: [f64; 3] = [0.18, 0.42, 1.37];
const K: [f64; 3] = [3.4, 2.35, 1.77];

/// Some thirty operations, and the square root of a difference where eta is small and the angle near grazing.
const ROUNDING: f64 = 1e-5;

#[test]
fn reflectance_agrees_with_float64() {
    let mut random = Random(3);
    let usual =
        (0..20_000).map(|_| [random.unit(), random.within(0.0, 4.0), random.within(0.0, 8.0)].map(|x| x as f32));
    let edges =
        [[0.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.5, 0.0, 3.0], [0.5, 1.0, 0.0], [1e-6, 0.2, 3.0], [1.0, 100.0, 100.0]];
    let inputs: Vec<[f32; 3]> = usual.chain(edges).collect();
    let probe = Probe {
        includes: &["shared/optics.glsl"],
        input: "float cos_i; float eta; float k;",
        output: "float y;",
        body: "r.y = fresnel_conductor(q.cos_i, q.eta, q.k);",
        ..Default::default()
    };
    for (input, y) in inputs.iter().zip(probe.run::<_, f32>(&gpu(), &inputs)) {
        let [cos_i, eta, k] = input.map(f64::from);
        let expected = fresnel_conductor(cos_i, eta, k);
        assert!((f64::from(y) - expected).abs() <= ROUNDING, "{input:?}: {y} for {expected}");
    }
}

/// A wall at x = 1 that mirrors a sun at 45° on to the floor before it, maybe under water.
fn wall(material: &str, water: bool) -> Scene {
    let sheet = "[objects.water]\nmaterial = \"water\"\nquad = { center = [0.0, 2.0, 0.0], u = [9.0, 0.0, 0.0], \
                 v = [0.0, 0.0, -9.0] }\n[materials.water.dielectric]\nior = 1.33\n";
    let light = if water {
        "[lights.lamp.point]\nposition = [0.2, 0.8, 0.1]\nintensity = 1.0\n"
    } else {
        "[lights.sun.directional]\ndirection = [1.0, -1.0, 0.0]\nirradiance = 1.0\n"
    };
    let text = format!(
        "version = 1\ntitle = \"wall\"\nunit = 1.0\npaths = \"reflect-1\"\nexposure = 0.0\n[region]\nreceiver = \"floor\"\n\
         center = [0.5, 0.0]\nhalf = [0.2, 0.2]\n[cameras.main.pinhole]\nposition = [0.0, 1.5, 3.0]\n\
         target = [0.5, 0.0, 0.0]\nfov_y = 40.0\n[objects.floor]\nmaterial = \"white\"\nquad = {{ center = [0.0, 0.0, 0.0], \
         u = [3.0, 0.0, 0.0], v = [0.0, 0.0, -3.0] }}\n[objects.wall]\nmaterial = \"wall\"\nquad = {{ \
         center = [1.0, 0.6, 0.0], u = [0.0, 0.0, 1.0], v = [0.0, 0.6, 0.0] }}\n[materials.white.diffuse]\nalbedo = 0.8\n\
         {material}\n{light}{}",
        if water { sheet } else { "" }
    );
    written(&text, &[])
}

fn gold() -> String {
    format!("[materials.wall.conductor]\neta = {ETA:?}\nk = {K:?}")
}

/// Photons on a lattice, mean over the region.
const LATTICE: f64 = 5e-3;

/// Mean irradiance of each band by maps and by the truth.
fn means(scene: &Scene, side: &str) -> [[f64; 3]; 2] {
    let set = [("light.side", side), ("maps.side", "64"), ("light.paths", "reflect-1")];
    let found = picture(&gpu(), &job_of(scene.clone(), &set, "region", [16, 16]));
    let goal = Goal { photons: Some(96 * 96), noise: None };
    let (estimator, paths) = (Estimator::Cells, PathClass::Reflect1);
    let task = Task { estimator, paths, camera: "region".to_owned(), size: [16; 2], seed: 0, goal };
    let space = Space::new(scene);
    let mut run = Run::new(&space, &scene.cameras["region"], &task);
    run.advance(2, |_, _| ControlFlow::Continue(()));
    let truth = run.layers().unwrap();
    let truth = truth.get("irradiance.caustic").unwrap().data();
    [found.layer("irradiance.caustic"), truth].map(|layer| {
        std::array::from_fn(|band| layer.iter().skip(band).step_by(3).map(|e| f64::from(*e)).sum::<f64>() / 256.0)
    })
}

#[test]
fn gold_at_45_degrees() {
    let cosine = 0.5f64.sqrt();
    for (name, found) in ["maps", "truth"].into_iter().zip(means(&wall(&gold(), false), "512")) {
        for band in 0..3 {
            // The mirrored sun meets the floor at 45° too.
            let exact = cosine * fresnel_conductor(cosine, ETA[band], K[band]);
            println!("{name}, band {band}: {:+.5}", found[band] / exact - 1.0);
            assert!((found[band] / exact - 1.0).abs() <= LATTICE, "{name}, band {band}: {} for {exact}", found[band]);
        }
    }
}

/// The lamp is seen all round: six faces, of which the wall fills little, so it takes many photons. Under water the index is that
/// against water: less is reflected, and both say how much less.
#[test]
fn gold_under_water() {
    let [maps, truth] = means(&wall(&gold(), true), "2048");
    let [bright, _] = means(&wall("[materials.wall.mirror]\nreflectance = 1.0", true), "512");
    for band in 0..3 {
        println!(
            "band {band}: maps/truth {:.5}, of a perfect mirror {:.4}",
            maps[band] / truth[band],
            maps[band] / bright[band]
        );
        assert!((maps[band] / truth[band] - 1.0).abs() <= 2.0 * LATTICE, "band {band}: {maps:?} {truth:?}");
        assert!(maps[band] < bright[band]);
    }
}
