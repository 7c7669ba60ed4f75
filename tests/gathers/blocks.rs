//! Emission in blocks: as much light as uniform emission brings, from fewer photons, without a seam where densities meet.

use super::{
    common::{
        gpu, job,
        picture::{Picture, job_of, picture, scene},
    },
    difference,
};
use nephroid::{
    gpu::Gpu,
    renderer::{self, Dump, Frame},
};

/// Flux deposited against what the photons brought that were traced: rounding of sums.
const EXACT: f64 = 1e-6;
/// What arrives by blocks against what arrives by all photons: at an edge some stand for several; measured 4.8·10⁻³.
const ARRIVED: f64 = 8e-3;
/// Of even light, the worst pixel where densities meet. There a sum over photons h apart differs from the integral by h²/24 of the splat's
/// slope, 4 % where h is two deviations, less a quarter of that on the denser side; measured 4.7·10⁻², where an outline is near.
const SEAM: f64 = 0.06;
/// Of the mean: tiles choose for themselves at their borders; measured 3.8·10⁻³.
const TILES: f64 = 0.01;

/// Kinds of splats that take them.
const KINDS: [&str; 3] = ["fixed", "elliptic", "combine-exact"];
/// Water that lies over the floor with all of its outline.
const SMALL: [(&str, &str); 2] =
    [("objects.water.quad.u", "[0.9, 0.0, 0.0]"), ("objects.water.quad.v", "[0.0, 0.0, -0.9]")];

fn drawn(gpu: &Gpu, scene: &str, gather: &str, set: &[(&str, &str)]) -> Picture {
    let all: Vec<_> = [("maps.gather", gather), ("maps.side", "64")].iter().chain(set).copied().collect();
    picture(gpu, &job(scene, &all, "region", [24, 24]))
}

/// log2 of the strides of all blocks.
fn strides(picture: &Picture) -> Vec<u32> {
    let Dump::Buffer(bytes) = picture.renderer.dump("light/blocks.strides").unwrap() else { panic!("a buffer") };
    bytemuck::pod_collect_to_vec(&bytes)
}

/// Photons listed, and those of the coarse pass.
fn traced(picture: &mut Picture) -> [u64; 2] {
    let counters = picture.renderer.counters(&Frame::default()).unwrap();
    let listed = counters.iter().find(|(name, _)| name == "light/photons").and_then(|(_, c)| c.points);
    [listed.unwrap_or(0), strides(picture).len() as u64]
}

fn ratio_of(picture: &Picture) -> f64 {
    picture.energy.ratio.expect("light arrives")
}

#[test]
fn fewer_photons_bring_the_same_light_again_and_again() {
    let gpu = gpu();
    for (scene, kind) in
        [("bunny", KINDS[0]), ("bunny", KINDS[1]), ("glass-sphere", KINDS[1]), ("glass-sphere", KINDS[2])]
    {
        let [whole, mut blocks] =
            ["0", "2"].map(|levels| drawn(&gpu, scene, kind, &[("light.side", "122"), ("maps.blocks", levels)]));
        let (lost, [listed, coarse]) = (blocks.energy.valid_w / whole.energy.valid_w - 1.0, traced(&mut blocks));
        println!("{scene}, {kind}: {:+.1e}, {lost:+.1e}, {listed} + {coarse} photons", ratio_of(&blocks) - 1.0);
        assert!((ratio_of(&blocks) - 1.0).abs() <= EXACT && lost.abs() <= ARRIVED, "{scene}, {kind}: {lost}");
        assert_eq!(coarse, 31 * 31);
        assert!(2 * (listed + coarse) < 122 * 122 && blocks.account.emitted() <= listed + coarse, "{listed}");
        let [one, other] = [0, 1].map(|_| {
            blocks.renderer.frame(&Frame::default()).unwrap();
            blocks.map().0
        });
        assert_eq!(one, other, "{scene}, {kind}");
    }
}

#[test]
fn no_seam_shows_where_densities_meet() {
    let gpu = gpu();
    // Glass of index 1 leaves light even; at its outlines photons are dense.
    for kind in ["fixed", "elliptic"] {
        let of = |levels| drawn(&gpu, "null", kind, &[("light.side", "96"), ("maps.blocks", levels)]);
        let (whole, blocks) = (of("0"), of("3"));
        let strides = strides(&blocks);
        let kinds = (0..4).filter(|at| strides.contains(at)).count();
        let [all, own] = [&whole, &blocks].map(|picture| picture.mean("irradiance.caustic"));
        let mut lit: Vec<f64> = all.iter().copied().filter(|e| *e > 0.0).collect();
        lit.sort_by(f64::total_cmp);
        let even = lit[3 * lit.len() / 4];
        let inside: Vec<_> = (0..all.len()).filter(|&k| (all[k] / even - 1.0).abs() < 0.01).collect();
        let worst = inside.iter().map(|&k| (own[k] / even - 1.0).abs()).fold(0.0, f64::max);
        println!("{kind}: {worst:.1e} of {even:.2} in {} of {} pixels, {kinds} densities", inside.len(), lit.len());
        assert!(kinds >= 3 && inside.len() > 100, "{strides:?}");
        assert!(worst <= SEAM, "{kind}: {worst}");
    }
}

#[test]
fn blocks_of_all_their_photons_change_no_bit() {
    let gpu = gpu();
    // 33 photons a side are no whole blocks, and land seven texels apart.
    let of = |levels| {
        let set = [("light.side", "33"), ("maps.gather", "fixed"), ("maps.side", "256"), ("maps.blocks", levels)];
        picture(&gpu, &job_of(scene("flat-water", &SMALL), &set, "region", [64, 64]))
    };
    let (whole, blocks) = (of("0"), of("2"));
    assert_eq!(strides(&blocks), [0; 81]);
    assert_eq!(whole.layer("irradiance.caustic"), blocks.layer("irradiance.caustic"));
    assert_eq!(whole.account.valid(), blocks.account.valid());
}

#[test]
fn next_to_no_photons_are_blocks_too() {
    let gpu = gpu();
    for kind in KINDS {
        for (side, levels, expected) in [("1", "5", 1), ("2", "1", 4), ("7", "3", 49)] {
            let set = [("light.side", side), ("maps.blocks", levels), ("maps.gather", kind), ("maps.side", "64")];
            let few = picture(&gpu, &job_of(scene("flat-water", &SMALL), &set, "region", [24, 24]));
            assert_eq!(strides(&few).len(), 1, "one block");
            assert_eq!(
                few.account.valid(),
                expected,
                "no neighbour tells that fewer will do: {:?}",
                few.account.counts
            );
            assert!((ratio_of(&few) - 1.0).abs() <= EXACT, "{side}, {kind}: {}", ratio_of(&few));
        }
        // What water reflects goes up, and there is no ceiling.
        let mut dark = drawn(
            &gpu,
            "flat-water",
            kind,
            &[("light.side", "40"), ("maps.blocks", "3"), ("light.paths", "reflect-1")],
        );
        assert_eq!(
            (dark.account.valid(), traced(&mut dark)),
            (0, [0, 25]),
            "one photon a block says that none arrives"
        );
        assert_eq!(dark.sum("irradiance.caustic"), 0.0);
    }
}

#[test]
fn tiles_and_points_of_a_sun_have_blocks_of_their_own() {
    let gpu = gpu();
    let sun = [("scene.lights.sun.angular_diameter", "5.0"), ("light.area_samples", "4")];
    for (set, tile) in [(&sun[..0], "24"), (&sun[..], "20")] {
        let of = |more: &[(&str, &str)]| {
            let all: Vec<_> =
                [("light.side", "64"), ("maps.blocks", "2")].iter().chain(set).chain(more).copied().collect();
            drawn(&gpu, "glass-sphere", "elliptic", &all)
        };
        let (whole, tiled) = (of(&[]), of(&[("light.tile", tile)]));
        let apart = difference(&whole, &tiled);
        println!("tile {tile}: {apart:.1e}");
        assert!(apart <= TILES && (ratio_of(&tiled) - 1.0).abs() <= EXACT, "{apart}");
    }
}

#[test]
fn blocks_are_planned_where_they_are_asked_for() {
    let of = |levels| {
        let set = [("maps.gather", "fixed"), ("maps.blocks", levels), ("light.side", "64")];
        renderer::plan(&job("glass-sphere", &set, "region", [8, 8])).unwrap().plan
    };
    let names = |levels| of(levels).passes.iter().map(|pass| pass.name.clone()).collect::<Vec<_>>();
    let (none, some) = (names("0"), names("3"));
    let passes = ["light/photons.coarse", "light/blocks", "light/blocks.count", "light/photons"];
    assert!(some.iter().map(String::as_str).take(4).eq(passes), "{some:?}");
    assert!(none.iter().eq(some.iter().filter(|name| !passes[..3].contains(&name.as_str()))), "{none:?}");
    let plan = of("0");
    let kept = plan.buffers.iter().map(|b| &b.name).chain(plan.images.iter().map(|i| &i.name));
    assert!(kept.into_iter().all(|name| !name.contains("blocks") && name != "light/photons.way"));
}

/// A scene, what is set, and what the refusal says.
type Refused = (&'static str, &'static [(&'static str, &'static str)], &'static str);

#[test]
fn what_blocks_cannot_do_is_refused_with_the_reason() {
    let refused: [Refused; 9] = [
        ("glass-sphere", &[("maps.splat", "cells")], "maps.adapt"),
        ("glass-sphere", &[("maps.splat", "varying")], "one slot apart"),
        ("glass-sphere", &[("maps.splat", "thin-lens")], "one slot apart"),
        ("glass-sphere", &[("maps.gather", "combine-all")], "alike"),
        ("glass-sphere", &[("maps.gather", "fetch")], "maps.traverse=compute"),
        ("glass-sphere", &[("light.tracer", "march")], "light.tracer=bvh"),
        ("room", &[], "several photons"),
        ("room", &[("light.layers", "1")], "several photons"),
        ("glass-sphere", &[("light.side", "16384"), ("maps.blocks", "1")], "128 MiB"),
    ];
    for (scene, set, reason) in refused {
        let all: Vec<_> = [("maps.blocks", "2")].iter().chain(set).copied().collect();
        let text = renderer::plan(&job(scene, &all, "region", [8, 8])).map(drop).unwrap_err().to_string();
        assert!(text.contains("blocks") && text.contains(reason), "{scene} {set:?}: {text}");
    }
}
