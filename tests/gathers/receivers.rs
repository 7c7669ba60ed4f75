//! Receivers of any shape, one behind another, turned from the light or edge-on: each has its own light and no one else's.

use super::common::{
    gpu,
    picture::{Picture, job_of, picture, rewritten, written},
};
use nephroid::{gpu::Gpu, scene::Scene};

/// Flux deposited against what arrived.
const ENERGY: f64 = 1e-5;
const SIZE: [u32; 2] = [96, 72];

/// Diffuse shapes on a floor under a slanting sun: through a slab that bends nothing, or not.
fn shapes(slab: &str) -> Scene {
    let text = format!(
        "version = 1\ntitle = \"shapes\"\npaths = \"transmit-2\"\nexposure = 0.0\n\
         [region]\nreceiver = \"floor\"\ncenter = [0.0, 0.0]\nhalf = [1.5, 1.5]\n\
         [cameras.main.pinhole]\nposition = [0.0, 2.5, 3.5]\ntarget = [0.0, -0.6, 0.2]\nfov_y = 38.0\n{slab}\
         [objects.ball]\nmaterial = \"white\"\n[objects.ball.sphere]\ncenter = [-0.8, -0.5, 0.3]\nradius = 0.5\n\
         [objects.cube]\nmaterial = \"white\"\n[objects.cube.box]\ncenter = [0.2, -0.7, 0.6]\nhalf = [0.3, 0.3, 0.3]\n\
         rotate = [0.0, 20.0, 0.0]\n\
         [objects.gem]\nmaterial = \"white\"\n[objects.gem.mesh]\nfile = \"gem.obj\"\nfit = 0.7\ncenter = [0.9, -1.0, 0.2]\n\
         [objects.floor]\nmaterial = \"white\"\n[objects.floor.quad]\ncenter = [0.0, -1.0, 0.0]\nu = [2.0, 0.0, 0.0]\n\
         v = [0.0, 0.0, -2.0]\n\
         [materials.glass.dielectric]\nior = 1.0\n[materials.white.diffuse]\nalbedo = 0.8\n\
         [lights.sun.directional]\ndirection = [0.3, -1.0, -0.4]\nirradiance = 1.0\n"
    );
    written(&text, &[("gem.obj", include_str!("../../scenes/gem.obj"))])
}

const SLAB: &str = "[objects.slab]\nmaterial = \"glass\"\nvisible_to_camera = false\n[objects.slab.box]\n\
                    center = [-0.3, 1.0, 0.4]\nhalf = [2.4, 0.1, 2.4]\n";

/// Splats, and the mean difference of a pixel, of the sun's irradiance: shadows' edges are blurred, and faces that the light
/// grazes are met by few photons; half more than measured.
const VANISHES: [(&str, f64); 2] = [("fixed", 0.021), ("cells", 0.005)];

#[test]
fn light_that_nothing_bends_falls_on_shapes_as_if_no_slab_were_there() {
    let gpu = gpu();
    let bare = picture(&gpu, &job_of(shapes(""), &[], "main", SIZE));
    let sun = bare.mean("irradiance.direct");
    for (splat, bound) in VANISHES {
        let set = [("light.side", "320"), ("maps.side", "256"), ("maps.splat", splat)];
        let seen = picture(&gpu, &job_of(shapes(SLAB), &set, "main", SIZE));
        let both = seen.mean("irradiance.caustic").into_iter().zip(seen.mean("irradiance.direct"));
        let off: Vec<_> = both.zip(&sun).map(|((a, b), c)| (a + b - c).abs()).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        println!("{splat}: off by {mean:.1e} in the mean, {:?}", seen.energy);
        assert!(mean <= bound, "{splat}: {mean}");
        balanced(splat, &seen);
        assert_eq!(seen.account.outside_map_w(), 0.0, "{splat}: everything that is seen has a part of the map");
    }
}

/// All that arrives is in the map, and every pixel is a number.
fn balanced(what: &str, picture: &Picture) {
    let ratio = picture.energy.ratio.unwrap_or_else(|| panic!("{what}: nothing arrives"));
    assert!((ratio - 1.0).abs() <= ENERGY, "{what}: {ratio}");
    assert!(picture.layer("irradiance.caustic").iter().all(|v| v.is_finite()), "{what}");
}

/// A table over a floor, lit from above and, by a mirror that stands beside it, from below.
fn table() -> Scene {
    let more = "
[objects.table]
material = \"white\"
[objects.table.quad]
center = [0.0, -1.25, 0.0]
u = [0.5, 0.0, 0.0]
v = [0.0, 0.0, -0.5]
[cameras.under.orthographic]
position = [0.0, -1.26, 0.0]
target = [0.0, -1.5, 0.0]
up = [0.0, 0.0, -1.0]
height = 1.0
hides_specular = true
";
    written(&rewritten("glass-sphere", &[], more), &[])
}

fn seen(gpu: &Gpu, scene: &Scene, camera: &str, set: &[(&str, &str)]) -> Picture {
    let all: Vec<_> = [("light.side", "128"), ("maps.side", "96")].iter().chain(set).copied().collect();
    picture(gpu, &job_of(scene.clone(), &all, camera, [32, 32]))
}

#[test]
fn a_floor_under_a_table_has_none_of_the_table_s_light() {
    let gpu = gpu();
    let scene = table();
    // Under the table no light lands: what is seen there is the table's, which leaks through it.
    for (splat, view, bind, leaks) in [
        ("fixed", "shared", "none", true),
        ("fixed", "shared", "receiver", false),
        ("cells", "shared", "none", true),
        ("cells", "shared", "receiver", false),
        ("fixed", "fitted", "none", false),
    ] {
        let set = [("maps.splat", splat), ("light.view", view), ("maps.bind", bind)];
        let under = seen(&gpu, &scene, "under", &set);
        let mean = under.sum("irradiance.caustic") / 1024.0;
        println!("{splat}, {view}, bind {bind}: {mean:.3} W/m² under the table");
        balanced(&format!("{splat} {view} {bind}"), &under);
        assert!(if leaks { mean > 0.5 } else { mean < LEAK }, "{splat} {view} {bind}: {mean}");
    }
}

/// W/m² under the table: splats at its edge reach under it; measured 0.004.
const LEAK: f64 = 0.01;

/// A mirror on the floor throws the sun up to a board, whose front or back is below.
fn board(front_below: bool) -> Scene {
    let v = if front_below { "[0.0, 0.0, 0.4]" } else { "[0.0, 0.0, -0.4]" };
    let text = format!(
        "version = 1\ntitle = \"board\"\npaths = \"reflect-1\"\nexposure = 0.0\n\
         [region]\nreceiver = \"floor\"\ncenter = [0.0, 0.0]\nhalf = [1.4, 1.4]\n\
         [cameras.main.orthographic]\nposition = [1.0, -0.5, 0.0]\ntarget = [1.0, 0.0, 0.0]\nup = [0.0, 0.0, -1.0]\nheight = 0.7\n\
         [objects.mirror]\nmaterial = \"gold\"\n[objects.mirror.quad]\ncenter = [0.3, -1.0, 0.0]\nu = [0.8, 0.0, 0.0]\n\
         v = [0.0, 0.0, -0.8]\n\
         [objects.board]\nmaterial = \"white\"\n[objects.board.quad]\ncenter = [1.0, 0.0, 0.0]\nu = [0.4, 0.0, 0.0]\nv = {v}\n\
         [objects.floor]\nmaterial = \"white\"\n[objects.floor.quad]\ncenter = [0.0, -1.1, 0.0]\nu = [3.0, 0.0, 0.0]\n\
         v = [0.0, 0.0, -3.0]\n\
         [materials.gold.conductor]\neta = 0.2\nk = 3.0\n[materials.white.diffuse]\nalbedo = 0.8\n\
         [lights.sun.directional]\ndirection = [0.6, -0.8, 0.0]\nirradiance = 1.0\n"
    );
    written(&text, &[])
}

/// Relative, between views that look at the same evenly lit board with texels of another size.
const ALIKE: f64 = 0.02;

#[test]
fn the_side_that_is_turned_from_the_light_has_its_own() {
    let gpu = gpu();
    let mean = |scene: &Scene, set: &[(&str, &str)]| {
        let picture = seen(&gpu, scene, "main", set);
        (picture.sum("irradiance.caustic") / 1024.0, picture.account.outside_map_w() / picture.energy.emitted_w)
    };
    let (front, none) = mean(&board(true), &[]);
    assert!(front > 0.5 && none < 0.01, "the board is lit: {front} W/m², {none} beside the map");
    for splat in ["fixed", "cells"] {
        for (more, lit) in [
            ([("light.view", "fitted"), ("maps.receivers", "all")], true),
            ([("light.view", "fitted"), ("maps.receivers", "quads")], false),
            ([("light.view", "shared"), ("maps.bind", "receiver")], true),
            ([("light.view", "shared"), ("maps.bind", "none")], false),
        ] {
            let set: Vec<_> = [("maps.splat", splat)].into_iter().chain(more).collect();
            let (back, outside) = mean(&board(false), &set);
            println!("{set:?}: {back:.4} W/m² of {front:.4}, {outside:.3} outside");
            let right =
                if lit { (back / front - 1.0).abs() < ALIKE && outside < 0.01 } else { back == 0.0 && outside > 0.1 };
            assert!(right, "{set:?}: {back} W/m² of {front}, {outside} outside");
        }
    }
}

#[test]
fn a_receiver_edge_on_to_the_light_s_view_keeps_its_books() {
    let gpu = gpu();
    // The wall stands along the sun's way, in the light that the sphere bends.
    let wall = "\n[objects.wall]\nmaterial = \"white\"\n[objects.wall.quad]\ncenter = [0.3, -1.25, 0.0]\nu = [0.0, 0.0, 0.8]\n\
                v = [0.0, 0.2, 0.0]\n[cameras.side.orthographic]\nposition = [0.0, -1.25, 0.0]\ntarget = [0.3, -1.25, 0.0]\n\
                height = 0.4\nhides_specular = true\n";
    let scene = written(&rewritten("glass-sphere", &[], wall), &[]);
    let mut own = Vec::new();
    for splat in ["fixed", "cells"] {
        for (view, bind) in [("fitted", "none"), ("shared", "none"), ("shared", "receiver")] {
            let set = [("maps.splat", splat), ("light.view", view), ("maps.bind", bind)];
            let side = seen(&gpu, &scene, "side", &set);
            let mean = side.sum("irradiance.caustic") / 1024.0;
            println!("{splat}, {view}, bind {bind}: {mean:.3} W/m² on the wall");
            balanced(&format!("{splat} {view} {bind}"), &side);
            if view == "fitted" {
                own.push(mean);
            }
        }
    }
    assert!(own[0] > 0.1 && (own[1] / own[0] - 1.0).abs() < SAMPLED, "the wall is lit: {own:?}");
}

/// Relative, cells against splats over a wall that light grazes: how coarsely both are sampled; measured 0.02.
const SAMPLED: f64 = 0.06;

#[test]
fn the_room_s_receivers_get_all_that_arrives_one_behind_another() {
    let gpu = gpu();
    let scene = super::common::picture::scene("room", &[]);
    for (column, side) in [("fixed", "64"), ("fetch", "64"), ("cells", "16")] {
        let set = [("maps.gather", column), ("light.side", side), ("light.paths", "all:3"), ("maps.side", "96")];
        let all: Vec<_> = set.to_vec();
        let room = picture(&gpu, &job_of(scene.clone(), &all, "main", [24, 18]));
        let outside = room.account.outside_map_w() / (room.account.valid_w() + room.account.outside_map_w());
        println!("room, {column}: {:?}, {outside:.1e} of what arrives is outside", room.energy);
        balanced(column, &room);
        assert!(outside <= OUTSIDE, "{column}: {outside}");
    }
}

/// Of what arrives in the room, what falls beyond the extent that the scene states of the table.
const OUTSIDE: f64 = 0.01;
