//! Every scene by every tracer: photons and watts are accounted for, values are finite, and the bytes are the same twice.

use nephroid::{
    passes::account::{Account, BUCKETS},
    renderer::{Dump, plan},
    scene::{PathClass, Scene},
};

use super::tracers;
use crate::common::{
    gpu,
    picture::{job_of, picture, scene},
};

/// As in `energy`: a photon's own shares are a few float32 products, 64 of them added in float32.
const SUMS: f64 = 1e-5;
/// As in `energy`: float32 sums in texels, weights that sum to one.
const DEPOSITED: f64 = 0.001;

const SMALL: [(&str, &str); 2] = [("light.side", "48"), ("maps.side", "64")];

fn balanced(name: &str, account: &Account) {
    let Account { counts, flux_w, other_paths_w, .. } = account;
    assert_eq!(counts[1..].iter().sum::<u64>(), counts[0], "{name}: {BUCKETS:?} {counts:?}");
    let sum = flux_w[1..].iter().sum::<f64>() + other_paths_w;
    assert!((sum - flux_w[0]).abs() <= SUMS * flux_w[0], "{name}: {sum} W in buckets, {} W emitted", flux_w[0]);
    assert!(flux_w.iter().chain([other_paths_w]).all(|w| *w >= 0.0), "{name}: {flux_w:?} {other_paths_w}");
}

#[test]
fn every_scene_by_every_tracer() {
    let gpu = gpu();
    for (name, _) in Scene::shipped() {
        let shipped = scene(name, &[]);
        // No image shows what a class of any chains needs.
        let class = if matches!(shipped.paths, PathClass::All(_)) { "transmit-2" } else { "scene" };
        let small = [SMALL[0], SMALL[1], ("light.paths", class)];
        let exact = picture(&gpu, &job_of(shipped.clone(), &small, "region", [8, 8])).account;
        for tracer in tracers() {
            let set = [small[0], small[1], small[2], ("light.tracer", tracer)];
            let what = format!("{name}, {tracer}");
            let job = job_of(shipped.clone(), &set, "region", [8, 8]);
            if let Err(refused) = plan(&job) {
                println!("{what}: {refused}");
                assert!(refused.to_string().contains("use light.tracer=bvh"), "{what}: {refused}");
                continue;
            }
            let picture = picture(&gpu, &job);
            balanced(&what, &picture.account);
            if let Some(ratio) = picture.energy.ratio {
                assert!((ratio - 1.0).abs() <= DEPOSITED, "{what}: ratio {ratio}");
            }
            // Rasteriser and rays may differ about a texel whose centre lies on the silhouette of a mesh.
            let (emitted, expected) = (picture.account.emitted() as i64, exact.emitted() as i64);
            println!("{what}: {emitted} photons, {expected} by bvh; {:?}", picture.account.counts);
            assert!((emitted - expected).abs() <= 2, "{what}: {emitted} photons, {expected} by bvh");
            assert_eq!(picture.account.valid_w() > 0.0, exact.valid_w() > 0.0, "{what}");
        }
    }
}

#[test]
fn the_same_bytes_twice() {
    let gpu = gpu();
    for tracer in tracers() {
        let set = [SMALL[0], SMALL[1], ("light.tracer", tracer), ("light.total_reflection", "follow")];
        let job = job_of(scene("bunny", &[]), &set, "region", [8, 8]);
        let bytes = || {
            let picture = picture(&gpu, &job);
            balanced(&format!("bunny, {tracer}, followed"), &picture.account);
            let dumps = ["light/photons.hit", "light/photons.flux", "maps/map"].map(|name| {
                let Dump::Image { layers, .. } = picture.renderer.dump(name).expect("it is in the plan") else {
                    panic!("{name} is an image")
                };
                layers.concat().iter().map(|v| v.to_bits()).collect::<Vec<_>>()
            });
            (dumps, picture.account)
        };
        assert!(bytes() == bytes(), "{tracer}");
    }
}
