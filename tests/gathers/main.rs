//! Gather `copy`: the picture of `fetch` blended where nothing is rounded, and what float16 costs where it is.

mod adapt;
mod blocks;
mod cells;
#[path = "../common/mod.rs"]
mod common;
mod exact;
mod hard;
mod levels;
mod model;
mod receivers;
mod tiles;
mod varying;

use common::{
    assert_quiet, gpu, job,
    picture::{Picture, picture},
};
use nephroid::{gpu::Work, renderer};

/// Copies of a scene, bits of image and buffer.
const COPIES: [&str; 3] = ["32-32", "16-32", "16-16"];
/// Flux in float16 keeps eleven bits; roundings of thousands of photons cancel to well below one of them. What lands
/// by the map's border may land beyond it: of the spheres' light some thousandths.
const HALF_ENERGY: f64 = 5e-3;
/// Float32 sums of some thousand photons.
const SUMS: f64 = 1e-4;

fn gathered(gpu: &nephroid::gpu::Gpu, scene: &str, gather: &str, copy: &str, side: &str) -> Picture {
    let set = [("maps.gather", gather), ("maps.copy", copy), ("light.side", side), ("maps.side", "64")];
    picture(gpu, &job(scene, &set, "region", [48, 48]))
}

/// Relative to the mean of the first.
fn difference(a: &Picture, b: &Picture) -> f64 {
    let [a, b] = [a, b].map(|p| p.layer("irradiance.caustic"));
    let mean = a.iter().map(|v| f64::from(*v)).sum::<f64>() / a.len() as f64;
    a.iter().zip(b).map(|(x, y)| f64::from(x - y).abs()).sum::<f64>() / a.len() as f64 / mean
}

#[test]
fn a_copy_in_float32_changes_no_bit() {
    let gpu = gpu();
    // One light; three lights with several photons a sample; a single photon.
    for (scene, side) in [("glass-sphere", "97"), ("room", "64"), ("glass-sphere", "1")] {
        let [fetched, copied] = ["fetch", "copy"].map(|gather| gathered(&gpu, scene, gather, "32-32", side));
        assert_eq!(fetched.layer("irradiance.caustic"), copied.layer("irradiance.caustic"), "{scene}, {side}² photons");
    }
}

#[test]
fn float16_rounds_where_photons_land_and_loses_no_light() {
    let gpu = gpu();
    let exact = gathered(&gpu, "glass-sphere", "copy", "32-32", "128");
    let [converted, half] = ["16-32", "16-16"].map(|copy| gathered(&gpu, "glass-sphere", "copy", copy, "128"));
    assert_eq!(
        converted.layer("irradiance.caustic"),
        half.layer("irradiance.caustic"),
        "float16 is read as the float32 that it was converted to"
    );
    let off = difference(&exact, &half);
    println!("float16: {off:.2e} of the mean");
    assert!(off > 1e-4 && off < 0.1, "{off}");
    for (picture, tolerance) in [(exact, SUMS), (converted, HALF_ENERGY), (half, HALF_ENERGY)] {
        let ratio = picture.energy.ratio.expect("light lands");
        assert!((ratio - 1.0).abs() < tolerance, "{ratio}");
    }
}

#[test]
fn a_copy_is_planned_where_it_is_asked_for() {
    for copy in COPIES {
        let set = [("maps.gather", "copy"), ("maps.copy", copy), ("light.side", "100")];
        let plan = renderer::plan(&job("glass-sphere", &set, "region", [32, 32])).unwrap().plan;
        let at = |name: &str| plan.passes.iter().position(|p| p.name == name);
        assert!(at("light/photons") < at("maps/copy") && at("maps/copy") < at("maps/gather"));
        assert_eq!(at("maps/resolve"), None, "drawn splats are blended");
        let pass = &plan.passes[at("maps/copy").unwrap()];
        assert_eq!(matches!(pass.work, Work::Copy { .. }), copy != "16-32", "only what converts is computed");
        let (image, buffer) = match copy {
            "32-32" => (16, 16),
            "16-32" => (8, 16),
            _ => (8, 8),
        };
        let bytes_of = |name: &str| {
            let images = plan.images.iter().filter(|i| i.name == name).map(|i| i.bytes());
            images.chain(plan.buffers.iter().filter(|b| b.name == name).map(|b| b.bytes)).sum::<u64>()
        };
        for column in ["hit", "flux"] {
            assert_eq!(bytes_of(&format!("light/photons.{column}")), image * 10_000);
            assert_eq!(bytes_of(&format!("maps/vertices.{column}")), buffer * 10_000);
        }
        assert_eq!(plan.bytes_written(pass), 2 * buffer * 10_000);
    }
    let fetched = renderer::plan(&job("glass-sphere", &[("maps.copy", "16-16")], "region", [32, 32])).unwrap().plan;
    assert!(fetched.passes.iter().all(|p| p.name != "maps/copy"));
    assert!(fetched.buffers.iter().all(|b| !b.name.starts_with("maps/vertices")));
    let bits = fetched.images.iter().filter(|i| i.name.starts_with("light/photons.")).map(|i| i.format.bytes());
    assert!(bits.into_iter().all(|bytes| bytes == 16), "only a copy takes float16");
    assert_quiet(&gpu());
}
