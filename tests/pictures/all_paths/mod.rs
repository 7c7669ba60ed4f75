//! Path class `all:N`: trees of reflections and transmissions, and the layers that hold what arrives.

mod energies;
mod layers;
mod null;

use crate::common::{
    gpu,
    picture::{account, job_of, scene, written},
};
use nephroid::{gpu::Gpu, passes::account::Account, scene::Scene};

/// The room with passages of its file replaced.
fn room(replaced: &[(&str, &str)]) -> Scene {
    let text = replaced.iter().fold(include_str!("room.toml").to_owned(), |text, (old, new)| {
        assert!(text.contains(old), "the room holds no {old:?}");
        text.replace(old, new)
    });
    written(&text, &[])
}

const BALL: &str = "sphere = { center = [0.0, 0.0, 0.0], radius = 1.0 }";

/// The account of a scene's photons in a class.
fn count(gpu: &Gpu, scene: &Scene, class: &str, side: &str, layers: &str) -> Account {
    let set = [("light.paths", class), ("light.side", side), ("light.layers", layers), ("maps.side", "16")];
    account(gpu, &job_of(scene.clone(), &set, "region", [8, 8]))
}

/// All that arrives at receivers, W.
fn arrives(account: &Account) -> f64 {
    account.valid_w() + account.outside_map_w() + account.no_layer_w()
}

/// W in the bucket of that name.
fn bucket(account: &Account, name: &str) -> f64 {
    let at = nephroid::passes::account::BUCKETS.iter().position(|bucket| *bucket == name);
    account.flux_w[at.unwrap_or_else(|| panic!("no bucket {name}"))]
}

#[track_caller]
fn close(what: &str, ours: f64, exact: f64, tolerance: f64) {
    println!("{what}: {ours:.6} for {exact:.6}, {:+.1e} of {tolerance:.0e}", ours / exact - 1.0);
    assert!((ours / exact - 1.0).abs() <= tolerance, "{what}: {ours} for {exact}");
}
