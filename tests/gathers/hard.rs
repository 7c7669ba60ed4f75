//! Hard cases of every column: next to no photons, all of them, none that is valid, odd sides, several lights and layers.

use super::{
    common::{
        gpu, job,
        picture::{Picture, job_of, picture, scene},
    },
    difference,
};
use nephroid::{renderer::all_settings, settings::Setting};

/// Of flux deposited, where clusters of photons that are alike are blended in float32; measured 7·10⁻⁷.
const MERGED: f64 = 1e-5;
/// Splats of a texel are added in another order: float32 sums of up to some hundred addends.
const ORDER: f64 = 1e-6;

/// The presets of `maps.gather`, all but `own`.
fn columns() -> &'static [&'static str] {
    let known = all_settings().into_iter().find_map(|setting| match setting {
        Setting::Choice(choice) if choice.key == "maps.gather" => Some(choice.words),
        _ => None,
    });
    &known.expect("maps.gather is a setting")[1..]
}

fn drawn(gpu: &nephroid::gpu::Gpu, scene: &str, column: &str, set: &[(&str, &str)]) -> Picture {
    let all: Vec<_> = set.iter().copied().chain([("maps.gather", column), ("maps.side", "40")]).collect();
    picture(gpu, &job(scene, &all, "region", [24, 24]))
}

#[test]
fn every_column_repeats_itself_bit_by_bit() {
    let gpu = gpu();
    for (scene, side) in [("glass-sphere", "33"), ("room", "20"), ("paraboloid", "17"), ("glass-sphere", "1")] {
        for column in columns() {
            let [a, b] = [(), ()].map(|()| drawn(&gpu, scene, column, &[("light.side", side)]));
            assert_eq!(a.layer("irradiance.caustic"), b.layer("irradiance.caustic"), "{scene}, {side}², {column}");
        }
    }
}

#[test]
fn a_stream_that_is_full_to_the_last_point_loses_none() {
    let gpu = gpu();
    // All of the water lies over the floor.
    let small = [("objects.water.quad.u", "[0.9, 0.0, 0.0]"), ("objects.water.quad.v", "[0.0, 0.0, -0.9]")];
    let [fetched, mut streamed] = ["fetch", "hierarchical"].map(|column| {
        let set = [("light.side", "48"), ("maps.gather", column), ("maps.side", "40")];
        picture(&gpu, &job_of(scene("flat-water", &small), &set, "region", [24, 24]))
    });
    assert!(difference(&fetched, &streamed) < ORDER);
    let counters = streamed.renderer.counters(&Default::default()).unwrap();
    let points = counters.iter().find(|(name, _)| name == "maps/gather").and_then(|(_, c)| c.points);
    assert_eq!(points, Some(48 * 48), "every photon of flat water is valid");
}

#[test]
fn without_a_valid_photon_the_map_is_dark() {
    let gpu = gpu();
    for column in columns() {
        // What water reflects goes up, and there is no ceiling.
        let mut dark = drawn(&gpu, "flat-water", column, &[("light.side", "48"), ("light.paths", "reflect-1")]);
        assert!(dark.account.emitted() > 0 && dark.account.counts[1] == 0, "{:?}", dark.account.counts);
        assert_eq!(dark.sum("irradiance.caustic"), 0.0, "{column}");
        let counters = dark.renderer.counters(&Default::default()).unwrap();
        let steps = counters.iter().filter(|(name, _)| name.starts_with("maps/traverse"));
        let points: Vec<_> = steps.map(|(_, c)| c.points.unwrap_or(0)).collect();
        assert!(points.iter().skip(1).all(|&p| p == 0), "the first step drops everything: {points:?}");
    }
}

#[test]
fn merging_invents_no_light_where_sides_are_odd() {
    let gpu = gpu();
    for column in ["combine-last", "combine-all"] {
        // Flat water is lit to its very edge, and a map of few texels merges all over it.
        for (side, tile) in [("63", "4096"), ("100", "4096"), ("129", "4096"), ("64", "13")] {
            let set = [("light.side", side), ("light.tile", tile), ("maps.gather", column), ("maps.side", "4")];
            let small = [("objects.water.quad.u", "[0.9, 0.0, 0.0]"), ("objects.water.quad.v", "[0.0, 0.0, -0.9]")];
            let picture = picture(&gpu, &job_of(scene("flat-water", &small), &set, "region", [24, 24]));
            let ratio = picture.energy.ratio.expect("light lands");
            println!("{column}, {side}² photons, tiles of {tile}: {:+.1e}", ratio - 1.0);
            assert!((ratio - 1.0).abs() <= MERGED, "{column}, {side}², {tile}: {ratio}");
        }
    }
}
