//! Hard cases, each with what is expected of its picture and counts. Every picture is finite in every layer, and no
//! validation message is left: `common::picture` holds both for all of them.

mod interfaces;
mod lights;
mod meshes;
mod nothing;
mod pictures;
mod powers;
mod receivers;
mod refused;
mod shapes;
mod sizes;

use crate::common::{
    gpu,
    picture::{Picture, all_ended, job_of, picture, pixels_of_map, rewritten, scene, written},
};
use nephroid::{
    gpu::Gpu,
    passes::account::Account,
    scene::{LightKind, Scene},
};

/// Flux in the map against the flux of the photons it took, as in `energy`.
const DEPOSITED: f64 = 0.001;
/// Sums and products of a few float32 numbers.
const ROUNDING: f64 = 1e-5;
/// Flux through a silhouette by light.side 256 texels or more, as in `closed_forms`.
const SILHOUETTE: f64 = 0.001;
/// Flux through the region at light.side 512: the lattice of photons at the region's border.
const REGION_FLUX: f64 = 0.002;

/// Photons, map texels and picture small enough for a case to take a second; what is known of a pixel, is of its middle.
const SMALL: [(&str, &str); 3] = [("light.side", "256"), ("maps.side", "128"), ("eye.samples", "1")];
const SIZE: [u32; 2] = [64, 64];

const NO_PHOTONS: [&str; 3] = ["light/photons", "maps/gather", "eye/surface"];

fn region(gpu: &Gpu, scene: Scene) -> Picture {
    picture(gpu, &job_of(scene, &SMALL, "region", SIZE))
}

/// The region pixel by texel, and the flux that it shows, W.
fn region_flux(gpu: &Gpu, scene: Scene) -> (Picture, f64) {
    let set = [("light.side", "512"), ("maps.side", "128"), ("eye.samples", "2")];
    let pixels = pixels_of_map(128);
    let area = scene.region.area() / f64::from(pixels * pixels);
    let picture = picture(gpu, &job_of(scene, &set, "region", [pixels; 2]));
    let flux = picture.sum("irradiance.caustic") * area;
    (picture, flux)
}

/// The account alone of a scene's photons; counts and fluxes add up.
fn counted(scene: Scene) -> Account {
    let class = scene.paths;
    let account = crate::common::picture::account(&gpu(), &job_of(scene, &SMALL, "region", SIZE));
    all_ended(&account, class);
    let Account { flux_w, other_paths_w, .. } = account;
    let sum = flux_w[1..].iter().sum::<f64>() + other_paths_w;
    assert!((sum - flux_w[0]).abs() <= ROUNDING * flux_w[0], "{sum} W in buckets of {} W: {account:?}", flux_w[0]);
    account
}

/// `glass-sphere` with another shape in the place of the sphere, as TOML below `[objects.ball]`, and more.
fn shaped(shape: &str, more: &str, beside: &[(&str, &str)]) -> Scene {
    let sphere = "[objects.ball.sphere]\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0\n";
    let text = rewritten("glass-sphere", &[(sphere, &format!("{shape}\n"))], more);
    written(&text, beside)
}

fn main_view(gpu: &Gpu, scene: Scene) -> Picture {
    picture(gpu, &job_of(scene, &SMALL, "main", SIZE))
}

/// `glass-sphere` under a point light in the place of the sun.
fn lamp(position: [f64; 3], intensity: f64) -> Scene {
    let text = rewritten("glass-sphere", &[], "\n[lights.lamp.point]\nposition = [0, 9, 0]\nintensity = 1.0\n");
    let mut scene = written(&text, &[]);
    scene.lights.retain(|light| light.name == "lamp");
    scene.lights[0].kind = LightKind::Point { position: position.into(), intensity: [intensity; 3] };
    scene
}

/// `glass-sphere` with another object, as TOML.
fn with_object(toml: &str, beside: &[(&str, &str)]) -> Scene {
    written(&rewritten("glass-sphere", &[], toml), beside)
}

/// Counts add up, and what was valid lies in the map.
fn balanced(picture: &Picture) {
    all_ended(&picture.account, picture.renderer.scene().paths);
    match picture.energy.ratio {
        Some(ratio) => assert!((ratio - 1.0).abs() <= DEPOSITED, "ratio {ratio}"),
        None => assert_eq!(picture.energy.deposited_w, 0.0),
    }
}

fn dark(picture: &Picture, layer: &str) {
    assert!(picture.layer(layer).iter().all(|v| *v == 0.0), "{layer} is not dark");
}

fn close(what: &str, ours: f64, exact: f64, tolerance: f64) {
    println!("{what}: {:+.2e} of {tolerance:e}", ours / exact - 1.0);
    assert!((ours / exact - 1.0).abs() <= tolerance, "{what}: {ours} for {exact}");
}

#[test]
fn every_shipped_scene_is_finite_and_adds_up_its_layers() {
    let gpu = gpu();
    for (name, _) in Scene::shipped() {
        let picture = main_view(&gpu, scene(name, &[]));
        balanced(&picture);
        let (direct, caustic) = (picture.layer("direct"), picture.layer("caustic"));
        let sums = direct.iter().zip(caustic).map(|(d, c)| d + c);
        assert!(sums.eq(picture.layer("radiance").iter().copied()), "{name}: radiance is direct and caustic");
        assert!(picture.sum("radiance") > 0.0, "{name}");
        let looks_at_glass = picture.layer("mask").iter().any(|m| *m > 0.0);
        assert_eq!(looks_at_glass, picture.renderer.scene().has_specular(), "{name}");
    }
}
