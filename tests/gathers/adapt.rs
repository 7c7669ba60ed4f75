//! Adaptive emission: cells traced finer level by level bring what arrives, the same at any limit, and tell what they leave.

use super::common::{
    gpu, job,
    picture::{Picture, picture},
};
use nephroid::{
    gpu::Gpu,
    renderer::{self, Counted, Frame},
};

/// Flux deposited against what arrived: as of cells that are traced finer once; measured 1·10⁻⁷.
const EXACT: f64 = 1e-5;
/// Of even light, where cells of four levels lie side by side, at the receiver's edge; measured 3·10⁻⁶.
const SEAM: f64 = 1e-4;

/// Rays of a cell of the view that is traced finer, at most: five of its 41 are known, and where its neighbours are traced
/// finer it shares two edges, of three rays each, with them; and of a smaller one, or one that is left.
const FINER: u64 = 36;
const SHARED: u64 = 6;
const DEEPER: u64 = 41;
const LEFT: u64 = 5;

fn adapted(gpu: &Gpu, scene: &str, set: &[(&str, &str)]) -> (Picture, Counted) {
    let all: Vec<_> = [("maps.splat", "cells"), ("maps.side", "256")].iter().chain(set).copied().collect();
    let picture = picture(gpu, &job(scene, &all, "region", [24, 24]));
    let counted = picture.energy.counted.expect("cells count themselves");
    (picture, counted)
}

/// Rays of the view's cells that are traced finer once: some of them lie side by side, and not all within others.
fn judge_rays(counted: Counted, own: u64) {
    let rays = counted.samples - own;
    let [least, most] = [FINER - SHARED, FINER].map(|each| each * counted.refined);
    assert!(least < rays && rays < most && rays.is_multiple_of(3), "{rays} of {least} to {most}: {counted:?}");
}

#[test]
fn each_level_brings_what_arrives_and_cuts_finer() {
    let gpu = gpu();
    let of = ["0", "1", "2"].map(|levels| adapted(&gpu, "bunny", &[("light.side", "16"), ("maps.adapt", levels)]));
    for (picture, counted) in &of {
        let ratio = picture.energy.ratio.expect("light arrives");
        println!("{:+.1e} {counted:?}", ratio - 1.0);
        assert!((ratio - 1.0).abs() <= EXACT, "{counted:?}");
        assert_eq!(counted.left, 0);
    }
    let [none, once, twice] = [0, 1, 2].map(|k| of[k].1);
    assert_eq!((none.refined, none.samples), (0, 16 * 16 + 17 * 17), "uniform emission traces centres and corners");
    assert!(twice.refined > once.refined);
    judge_rays(once, none.samples);
    assert_eq!(twice.samples, once.samples + DEEPER * (twice.refined - once.refined));
    assert!(twice.points_w < 0.7 * once.points_w && once.points_w < 0.7 * none.points_w, "{none:?} {once:?} {twice:?}");
}

#[test]
fn what_is_too_much_for_a_level_is_left_and_counted() {
    let gpu = gpu();
    let set = |levels, most| [("light.side", "16"), ("maps.adapt", levels), ("maps.adapt_most", most)];
    let own = 16 * 16 + 17 * 17;
    // Of the view's own grid what is left takes no ray.
    let few = adapted(&gpu, "bunny", &set("1", "40")).1;
    assert!(few.refined <= 40 && few.left > 0, "{few:?}");
    assert_eq!(few.samples, own + FINER * few.refined, "one of them, beside none");
    // Here the first level takes all of its cells, the second not.
    let once = adapted(&gpu, "bunny", &set("1", "100")).1;
    assert_eq!((once.refined, once.left), (few.refined + few.left, 0), "{once:?}");
    let (mut picture, counted) = adapted(&gpu, "bunny", &set("2", "100"));
    assert!(counted.refined <= once.refined + 100 && counted.left > 0, "{counted:?}");
    let deeper = counted.refined - once.refined;
    assert_eq!(counted.samples, once.samples + DEEPER * deeper + LEFT * counted.left);
    assert!((picture.energy.ratio.unwrap() - 1.0).abs() <= EXACT, "{:?}", picture.energy);
    let before = picture.map().0;
    picture.renderer.frame(&Frame::default()).unwrap();
    assert_eq!(before, picture.map().0, "which are left is no chance");
}

#[test]
fn no_more_is_traced_finer_than_makes_the_error_small_enough() {
    let gpu = gpu();
    let of = ["0", "0.03", "1"].map(|enough| {
        adapted(&gpu, "bunny", &[("light.side", "16"), ("maps.adapt", "1"), ("maps.adapt_error", enough)])
    });
    let [all, some, none] = of.each_ref().map(|(picture, counted)| {
        let ratio = picture.energy.ratio.expect("light arrives");
        assert!((ratio - 1.0).abs() <= EXACT && counted.left == 0, "{counted:?}");
        counted.refined
    });
    println!("{all} {some} {none}");
    assert!(all > some && some > none && none == 0, "{all} {some} {none}");
}

#[test]
fn no_seam_shows_where_levels_meet() {
    // Light through a flat sheet is even. Cells that the floor's edge cuts go down four levels; those within do not.
    let gpu = gpu();
    let (picture, counted) = adapted(&gpu, "flat-water", &[("light.side", "31"), ("maps.adapt", "3")]);
    let lit = picture.mean("irradiance.caustic");
    let middle = lit[lit.len() / 2 + 12];
    let worst = lit.iter().map(|e| (e / middle - 1.0).abs()).fold(0.0, f64::max);
    println!("{worst:.1e} of {middle:.2}, {counted:?}");
    // 189: of more than one level, and only what pays; before cells were weighed all that were cut went down, and it was over 500.
    assert!(counted.refined > 150 && middle > 0.0 && worst <= SEAM, "{worst} of {middle}, {counted:?}");
}

#[test]
fn levels_are_planned_where_they_can_be() {
    let passes = |set: &[(&str, &str)]| {
        let plan = renderer::plan(&job("glass-sphere", set, "region", [8, 8])).unwrap().plan;
        let names = plan.passes.iter().filter(|pass| pass.name.starts_with("maps/cells.refine"));
        (names.map(|pass| pass.name.clone()).collect::<Vec<_>>(), plan)
    };
    let cells = ("maps.splat", "cells");
    assert_eq!(
        passes(&[cells, ("maps.adapt", "3")]).0,
        ["maps/cells.refine", "maps/cells.refine.1", "maps/cells.refine.2"]
    );
    for set in [[cells, ("maps.adapt", "0")], [cells, ("light.tracer", "march")]] {
        let (names, plan) = passes(&set);
        assert!(names.is_empty() && plan.left_out.iter().any(|left| left.name == "maps/cells.refine"), "{set:?}");
    }
}
