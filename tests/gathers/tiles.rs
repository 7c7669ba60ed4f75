//! Views of more photons than the photon buffer, tile by tile: the picture is the one of a single tile.

use super::{
    common::{gpu, job, picture::picture},
    difference,
};
use nephroid::{gpu::Gpu, renderer};

/// Tiles of half the view's 64, and of three eighths, so that the last ones reach beyond the view.
const HALF: &str = "32";
const ODD: &str = "24";
/// Of the mean: on a silhouette a rasteriser takes texels of a tile and of its view by other roundings; measured 5e-9,
/// a texel is 3e-4.
const COVERAGE: f64 = 1e-3;
/// Of the mean: photons at a tile's end know no neighbour beyond, and clusters end there; measured 0.015.
const SEAMS: f64 = 0.03;
/// Of the mean: which cells pay for being traced finer is found tile by tile; measured 9.5e-4.
const CHOSEN: f64 = 1.5e-3;

/// How far the picture of tiles is from the whole one's, of its mean.
fn apart(gpu: &Gpu, scene: &str, set: &[(&str, &str)], tile: &str) -> f64 {
    let both = [("light.side", "64"), ("maps.side", "64"), ("eye.samples", "1")];
    let of = |more: &[(&str, &str)]| {
        let all: Vec<_> = both.iter().chain(set).chain(more).copied().collect();
        picture(gpu, &job(scene, &all, "region", [24, 24]))
    };
    let (whole, tiled) = (of(&[]), of(&[("light.tile", tile)]));
    assert!(whole.energy.valid_w > 0.0, "{scene} {set:?}: no light");
    let [one, many] = [&whole, &tiled].map(|picture| picture.account.counts);
    let off = one.iter().zip(many).map(|(a, b)| a.abs_diff(b)).max().unwrap();
    let apart = difference(&whole, &tiled);
    println!("{scene} {set:?} tile {tile}: {apart:.1e} of the mean, {off} photons of {}", one[0]);
    assert!(off as f64 <= COVERAGE * one[0] as f64, "{scene} {set:?}: {one:?} {many:?}");
    apart
}

/// A scene, what is set, and the side of tiles.
type Case = (&'static str, &'static [(&'static str, &'static str)], &'static str);

#[test]
fn tiles_sum_to_the_picture_of_one_bit_by_bit() {
    let gpu = gpu();
    let cases: [Case; 4] = [
        ("room", &[], HALF), // three lights, several photons a sample
        ("bunny", &[("maps.gather", "cells"), ("maps.adapt", "0")], ODD),
        ("glass-sphere", &[("light.view", "shared"), ("light.tracer", "march")], ODD),
        ("glass-sphere", &[("scene.lights.sun.angular_diameter", "5.0"), ("light.area_samples", "4")], "20"),
    ];
    for (scene, set, tile) in cases {
        assert_eq!(apart(&gpu, scene, set, tile), 0.0, "{scene} {set:?} tile {tile}");
    }
}

#[test]
fn where_a_tile_shows_it_is_by_little() {
    let gpu = gpu();
    let inside = [("light.tracer", "fixed-point"), ("light.total_reflection", "follow")];
    let levels = [("maps.gather", "varying-multires"), ("maps.top", "4")];
    assert!(apart(&gpu, "bunny", &inside, ODD) <= COVERAGE);
    assert!(apart(&gpu, "bunny", &levels, HALF) <= SEAMS);
    assert!(apart(&gpu, "bunny", &[("maps.gather", "cells")], ODD) <= CHOSEN);
}

#[test]
fn memory_is_a_tile_s() {
    let plan = |tile| {
        let set = [("light.side", "8192"), ("light.tile", tile), ("light.tracer", "march")];
        renderer::plan(&job("glass-sphere", &set, "region", [32, 32])).map(|planned| planned.plan)
    };
    let tiled = plan("1024").unwrap();
    let most = tiled.images.iter().filter(|image| image.name.starts_with("light/photons")).map(|image| image.extent);
    assert_eq!(most.max(), Some([1024; 2]));
    let traced = |name: &str| tiled.passes.iter().filter(|pass| pass.name.split(':').next() == Some(name)).count();
    assert_eq!([traced("light/photons"), traced("maps/gather"), traced("light/front")], [64, 64, 128]);
    assert_eq!(traced("light/back"), 2, "a view's tiles share what is behind them, in the frame and in the account");
    assert!(tiled.images.iter().all(|image| image.extent[0] <= 4096), "every device has such images");
    let refused = plan("64").map(drop).unwrap_err().to_string();
    assert!(refused.contains("light.tile=64") && refused.contains("raise light.tile"), "{refused}");
}
