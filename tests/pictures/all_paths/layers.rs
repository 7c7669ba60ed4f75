//! The layers of the photon buffer: a sample's brightest photons, and the flux of the others in its bucket.

use nephroid::{
    gpu::{Gpu, ImageId, Resource},
    passes::account::STATUSES,
    renderer::{Dump, Frame, Job, Renderer},
    scene::Scene,
};

use super::{arrives, close, count, gpu, job_of, room, scene};
use crate::common::assert_quiet;

/// Sums of the same float32 numbers in another order.
const ROUNDING: f64 = 1e-5;
const SIDE: usize = 64;

fn job(scene: Scene, layers: &str) -> Job {
    let set = [("light.paths", "all:12"), ("light.side", "64"), ("light.layers", layers), ("maps.side", "64")];
    job_of(scene, &set, "region", [16, 16])
}

fn rendered(gpu: &Gpu, job: &Job) -> Renderer {
    let mut renderer = Renderer::new(gpu, job).unwrap();
    renderer.frame(&Frame::default()).unwrap();
    assert_quiet(gpu);
    renderer
}

/// Flux of each photon of each sample, brightest first.
fn photons(renderer: &Renderer) -> Vec<Vec<f32>> {
    let of = |name: &str| match renderer.dump(name).unwrap() {
        Dump::Image { layers, .. } => layers,
        Dump::Buffer(_) => panic!("{name} is an image"),
    };
    let (hit, flux) = (of("light/photons.hit"), of("light/photons.flux"));
    let of_sample = |texel: usize| {
        let arrived = hit.iter().zip(&flux).filter(|(hit, _)| hit[4 * texel + 3] != 0.0);
        let mut all: Vec<f32> = arrived.map(|(_, flux)| flux[4 * texel..4 * texel + 3].iter().sum()).collect();
        all.sort_by(|a, b| b.total_cmp(a));
        all
    };
    (0..SIDE * SIDE).map(of_sample).collect()
}

#[test]
fn the_brightest_photons_of_a_sample_are_kept() {
    let (gpu, scene) = (gpu(), room(&[("ior = 1.5", "ior = 2.4175")]));
    let all = photons(&rendered(&gpu, &job(scene.clone(), "64")));
    assert!(all.iter().filter(|photons| photons.len() >= 6).count() > 1000, "samples of diamond leave many photons");
    for layers in [1, 2, 5] {
        let kept = photons(&rendered(&gpu, &job(scene.clone(), &layers.to_string())));
        for (kept, all) in kept.iter().zip(&all) {
            assert_eq!(kept[..], all[..all.len().min(layers)], "of {layers} layers");
        }
    }
}

#[test]
fn what_has_no_layer_is_booked() {
    let (gpu, scene) = (gpu(), room(&[("ior = 1.5", "ior = 2.4175")]));
    let all = count(&gpu, &scene, "all:12", "128", "64");
    assert_eq!(all.no_layer_w(), 0.0);
    let mut before = 0.0;
    for layers in ["1", "2", "4", "8"] {
        let some = count(&gpu, &scene, "all:12", "128", layers);
        close(&format!("{layers} layers"), arrives(&some), arrives(&all), ROUNDING);
        let held = some.valid_w() + some.outside_map_w();
        assert!(held > before, "more layers hold more");
        before = held;
        // Every branch ends once, with layer or without: `no_layer` counts what others no longer do.
        assert_eq!(some.counts.iter().sum::<u64>(), all.counts.iter().sum::<u64>());
        assert!(some.counts[8] > 0 || layers == "8", "samples of diamond leave more than {layers} photons");
        assert_eq!(some.counts.len(), STATUSES);
    }
}

#[test]
fn arrays_are_made_for_this_class_alone() {
    let gpu = gpu();
    for (class, layers, array) in [("all:4", 8, true), ("transmit-2", 1, false)] {
        let job = job_of(
            scene("glass-sphere", &[]),
            &[("light.paths", class), ("light.side", "32"), ("light.layers", "8")],
            "region",
            [8, 8],
        );
        let renderer = rendered(&gpu, &job);
        let Some(Resource::Image(image)) = renderer.plan().find("light/photons.hit") else { panic!("no hits") };
        let image: ImageId = image;
        let image = renderer.plan().image_decl(image);
        assert_eq!(
            (image.layers, image.array, image.bytes()),
            (layers, array, 32 * 32 * 16 * u64::from(layers)),
            "{class}"
        );
    }
}

#[test]
fn twice_the_same_bytes() {
    let gpu = gpu();
    let job = job(scene("bunny", &[]), "3");
    let [first, second] = [0, 1].map(|_| {
        let renderer = rendered(&gpu, &job);
        let Dump::Image { layers, .. } = renderer.dump("maps/map").unwrap() else { panic!("an image") };
        layers
    });
    assert!(first == second && first[0].iter().any(|v| *v > 0.0));
}
