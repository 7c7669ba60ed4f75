//! Traverse `hierarchical`: its points against a model of the paper's listings, its map against `fetch`.

use nephroid::{
    gpu::Gpu,
    renderer::{Dump, Frame, Renderer},
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

/// Texels that photons of an exact cluster may land apart: `maps.spread` of 1, splats of three texels.
const APART: f32 = 0.75;

/// What the device does and what the model says.
fn both(
    gpu: &Gpu,
    scene: &str,
    side: &str,
    (way, merge): (&[(&str, &str)], Merge),
    map_side: &str,
) -> (Vec<u64>, Counts) {
    let set = [way, &[("light.side", side), ("maps.side", map_side)]].concat();
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
        let ways = [
            (&[("maps.gather", "hierarchical")][..], Merge::None),
            (&[("maps.gather", "combine-last")], Merge::Last),
            (&[("maps.gather", "combine-all")], Merge::All),
            (&[("maps.traverse", "hierarchical"), ("maps.merge", "exact"), ("maps.spread", "1")], Merge::Exact(APART)),
        ];
        for way in ways {
            let (device, model) = both(&gpu, scene, side, way, "64");
            println!("{scene}, {side}², {:?}: {device:?}, {} ready", way.0, model.ready);
            assert_eq!(device.len(), model.points.len());
            let off = device.iter().zip(&model.points).map(|(a, b)| a.abs_diff(*b) as f64 / *b as f64);
            assert!(off.fold(0.0, f64::max) <= allowed, "{scene}, {:?}: {device:?}, the model {model:?}", way.0);
        }
    }
}

/// Splats that the device counts below each texel of each level from 1 on, by layer.
fn below(renderer: &Renderer, side: usize, levels: usize) -> Vec<Vec<Vec<u32>>> {
    /// In the place of the counts of the children: the texel is one splat itself.
    const OWN: f32 = 2_147_483_648.0;
    let Dump::Image { extent, layers, .. } = renderer.dump("maps/pyramid.points").unwrap() else { panic!("an image") };
    let first_row = |level: usize| {
        let twice = 2 * side.div_ceil(2);
        twice - (twice >> (level - 1)) + 2 * (level - 1)
    };
    let of_level = |texels: &[f32], level: usize| -> Vec<u32> {
        let side = side.div_ceil(1 << level);
        let places = (0..side * side).map(|at| (first_row(level) + at / side) * extent[0] as usize + at % side);
        let children = places.map(|place| &texels[4 * place..][..4]);
        // The dump has two numbers, and two words as float32.
        children
            .map(|c| if c[0] == OWN { 1 } else { c[0] as u32 + c[1] as u32 + c[2].to_bits() + c[3].to_bits() })
            .collect()
    };
    layers.iter().map(|texels| (1..=levels).map(|level| of_level(texels, level)).collect()).collect()
}

#[test]
fn splats_below_every_texel_are_those_of_the_model() {
    let gpu = gpu();
    for (scene, side) in [("glass-sphere", 130), ("bunny", 97), ("ring", 129), ("gem", 48)] {
        for (merge, way) in [("last", Merge::Last), ("all", Merge::All), ("exact", Merge::Exact(APART))] {
            let (photons, spread) = (side.to_string(), ("maps.spread", "1"));
            let set = [("maps.merge", merge), ("light.side", photons.as_str()), ("maps.side", "64"), spread];
            let mut renderer = Renderer::new(&gpu, &job(scene, &set, "region", [16, 16])).unwrap();
            renderer.frame(&Frame::default()).unwrap();
            let model = Model::of(&renderer, way, 16).splats();
            let device = below(&renderer, side, model[0].len());
            let total: u32 = model.iter().filter_map(|levels| levels.last()).flatten().sum();
            let counted = counted(&mut renderer);
            println!("{scene}, {side}², {merge}: {counted:?} splats, the model {total}");
            if gpu.info().is_software() {
                assert!(device == model, "{scene}, {merge}");
            }
            let off = counted[0].abs_diff(u64::from(total)) as f64 / f64::from(total);
            assert!(
                counted.len() == 1 && off <= if gpu.info().is_software() { 0.0 } else { FUSED },
                "{scene}, {merge}"
            );
            assert_quiet(&gpu);
        }
    }
}

#[test]
fn a_focus_makes_one_of_256_photons() {
    let gpu = gpu();
    // All light of the mirror falls into a texel or four: the topmost level's points are ready at once.
    let (device, model) = both(&gpu, "paraboloid", "256", (&[("maps.gather", "combine-all")], Merge::All), "8");
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
