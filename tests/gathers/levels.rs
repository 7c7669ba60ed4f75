//! Traverse `hierarchical`: its points against a model of the paper's listings, its map against `fetch`.

use nephroid::{
    gpu::Gpu,
    renderer::{Frame, Renderer},
};

use super::{
    common::{
        assert_quiet, gpu, job,
        picture::{Picture, picture},
    },
    difference,
    model::{Counts, Merge, Model},
};

/// Splats of a texel are added in another order: float32 sums of up to some hundred addends.
const ORDER: f64 = 1e-6;
/// On a GPU, sums and products may be fused, and a photon by a texel's edge fall on its other side: measured 0.25 % of the points
/// of `ring` (NVIDIA H100), whose photons lie in rows.
const FUSED: f64 = 5e-3;

/// Points that each step takes and the gather draws, as the device counts them.
fn counted(renderer: &mut Renderer) -> Vec<u64> {
    let counters = renderer.counters(&Frame::default()).expect("passes are counted");
    let steps =
        counters.iter().filter(|(name, _)| name.starts_with("maps/traverse") || name.starts_with("maps/gather"));
    steps.map(|(_, c)| c.points.expect("points are counted")).collect()
}

/// What the device does and what the model says.
fn both(gpu: &Gpu, scene: &str, side: &str, (gather, merge): (&str, Merge), map_side: &str) -> (Vec<u64>, Counts) {
    let set = [("maps.gather", gather), ("light.side", side), ("maps.side", map_side)];
    let mut renderer = Renderer::new(gpu, &job(scene, &set, "region", [16, 16])).unwrap();
    renderer.frame(&Frame::default()).unwrap();
    let model = Model::of(&renderer, merge, 16).counts();
    let device = counted(&mut renderer);
    assert_quiet(gpu);
    (device, model)
}

#[test]
fn points_of_every_level_are_those_of_the_listings() {
    let gpu = gpu();
    let allowed = if gpu.info().is_software() { 0.0 } else { FUSED };
    // A smooth body, a mesh, a mirror, water over its whole view, and photons of several layers; an odd side among them.
    for (scene, side) in [("glass-sphere", "256"), ("bunny", "200"), ("ring", "129"), ("water", "64"), ("gem", "96")] {
        let ways = [("hierarchical", Merge::None), ("combine-last", Merge::Last), ("combine-all", Merge::All)];
        for way in ways {
            let (device, model) = both(&gpu, scene, side, way, "64");
            println!("{scene}, {side}², {}: {device:?}, {} ready", way.0, model.ready);
            assert_eq!(device.len(), model.points.len());
            let off = device.iter().zip(&model.points).map(|(a, b)| a.abs_diff(*b) as f64 / *b as f64);
            assert!(off.fold(0.0, f64::max) <= allowed, "{scene}, {}: {device:?}, the model {model:?}", way.0);
        }
    }
}

#[test]
fn a_focus_makes_one_of_256_photons() {
    let gpu = gpu();
    // All light of the mirror falls into a texel or four: the topmost level's points are ready at once.
    let (device, model) = both(&gpu, "paraboloid", "256", ("combine-all", Merge::All), "8");
    println!("{device:?}, {} ready", model.ready);
    assert_eq!(device, model.points);
    let valid = device[1];
    assert!(model.ready > 100 && valid < 2 * model.ready, "{device:?}, {} ready", model.ready);
}

fn drawn(gpu: &Gpu, scene: &str, side: &str, set: &[(&str, &str)]) -> Picture {
    let all: Vec<_> = set.iter().copied().chain([("light.side", side), ("maps.side", "64")]).collect();
    picture(gpu, &job(scene, &all, "region", [48, 48]))
}

#[test]
fn a_traversal_leaves_out_nothing_that_is_seen() {
    let gpu = gpu();
    for (scene, side) in [("glass-sphere", "97"), ("room", "40"), ("glass-sphere", "16"), ("glass-sphere", "1")] {
        let fetched = drawn(&gpu, scene, side, &[("maps.gather", "fetch")]);
        for set in [("maps.gather", "hierarchical"), ("maps.traverse", "hierarchical")] {
            let off = difference(&fetched, &drawn(&gpu, scene, side, &[set]));
            assert!(off < ORDER, "{scene}, {side}² photons: {off}");
        }
        let culled = drawn(&gpu, scene, side, &[("maps.gather", "fetch"), ("maps.cull", "geometry")]);
        assert_eq!(fetched.layer("irradiance.caustic"), culled.layer("irradiance.caustic"), "{scene}");
    }
}
