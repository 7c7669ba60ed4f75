//! Scenes that move: what is drawn at a time is the scene of that time, however it was come to.

use crate::common::{
    assert_quiet, gpu,
    picture::{job_of, picture, rewritten, scene, written},
};
use glam::DVec3;
use nephroid::{
    image::Layers,
    renderer::{Frame, Renderer},
    scene::{LightKind, Scene, Shape},
};

/// Float64 sums and products of numbers of order one.
const ROUNDING: f64 = 1e-14;

/// Of the mean: corners of cells lie on edges of the sheet's triangles, and which of two is met is for the tree to say, which is fitted to
/// a sheet that moves. Measured 4.4e-6.
const EDGES: f32 = 1e-5;
const SIDES: [(&str, &str); 3] = [("light.side", "128"), ("maps.side", "128"), ("eye.samples", "2")];

fn ball(scene: &Scene) -> (DVec3, f64) {
    let sphere = |shape: &Shape| match *shape {
        Shape::Sphere { center, radius } => Some((center, radius)),
        _ => None,
    };
    scene.objects.iter().find_map(|object| sphere(&object.shape)).expect("a sphere")
}

fn frame_at(renderer: &mut Renderer, time: f64) -> Layers {
    renderer.frame(&Frame { time, ..Frame::default() }).unwrap_or_else(|error| panic!("at {time} s: {error}"));
    renderer.layers().expect("the layers are read")
}

#[test]
fn the_sphere_is_on_its_way_where_its_keys_say() {
    let scene = scene("moving-sphere", &[]);
    assert!(scene.moves() && scene.keyed_span() == Some([-0.3, 0.9]));
    let at = |time: f64| ball(&scene.at(time)).0;
    for (time, center) in [
        (-0.3, [-2.0, 0.0, 0.0]),
        (0.3, [0.0, -0.6, 0.0]),
        (0.9, [2.2, 0.3, 0.0]),
        (-1e6, [-2.0, 0.0, 0.0]),
        (1e6, [2.2, 0.3, 0.0]),
    ] {
        assert_eq!(at(time), DVec3::from_array(center), "at {time} s");
    }
    let quarter = DVec3::new(-2.0 + 2.0 * 0.25, -0.6 * 0.25, 0.0);
    assert!((at(-0.15) - quarter).length() < ROUNDING, "{}", at(-0.15));
    assert_eq!(at(f64::NAN), at(0.0), "what is no time is time 0");
    // From any time to any other, and the hash says which.
    let there = scene.at(0.7).at(0.3);
    assert_eq!((ball(&there), &there.source.hash), (ball(&scene.at(0.3)), &scene.at(0.3).source.hash));
    assert_ne!(scene.at(0.4).source.hash, scene.source.hash);
    assert_eq!(scene.at(-0.0).source.hash, scene.source.hash);
}

#[test]
fn a_scene_that_stands_still_is_the_same_at_any_time() {
    let still = scene("glass-sphere", &[]);
    let later = still.at(3.0);
    assert!(!still.moves() && still.keyed_span().is_none());
    assert_eq!((later.source.hash, later.time), (still.source.hash, still.time));
}

/// Every kind of shape turned, scaled and carried by its keys is the shape that is written there.
#[test]
fn shapes_at_their_keys_are_those_written_there() {
    let cases = [
        ("[objects.ball.sphere]\ncenter = [0, 0, 0]\nradius = 1.0", "sphere.center", Some("sphere.radius")),
        ("[objects.ball.box]\ncenter = [0, 0, 0]\nhalf = [1, 0.5, 0.25]", "box.center", None),
        ("[objects.ball.quad]\ncenter = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]", "quad.center", None),
        ("[objects.ball.disk]\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 1", "disk.center", Some("disk.radius")),
        (
            "[objects.ball.sine]\ncenter = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\namplitude = 0.1\nwavelength = 1",
            "sine.center",
            None,
        ),
    ];
    let sphere = "[objects.ball.sphere]\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0";
    for (shape, place, size) in cases {
        let moving = "\n[objects.ball.motion]\nposition = [{ time = 1, value = [0, 0, 0] }, { time = 2, value = [0.3, 0.7, -0.1] }]\nscale = [{ time = 1, value = 1 }, { time = 2, value = 0.75 }]\n";
        let moving = written(&rewritten("glass-sphere", &[(sphere, shape)], moving), &[]);
        let still = written(&rewritten("glass-sphere", &[(sphere, shape)], ""), &[]);
        // A product may leave −0 where 0 is written.
        let shape = |scene: &Scene| format!("{:?}", scene.objects.iter().find(|o| o.name == "ball").unwrap().shape);
        let there = |scene: &Scene| shape(scene).replace("-0.0,", "0.0,").replace("-0.0)", "0.0)");
        assert_eq!(there(&moving), there(&still), "{place} at rest");
        let mut set = vec![(format!("objects.ball.{place}"), "[0.3, 0.7, -0.1]".to_owned())];
        let Some(size) = size else { continue };
        set.push((format!("objects.ball.{size}"), "0.75".to_owned()));
        let text = still.source.text.clone();
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("s.toml"), text).unwrap();
        let moved = Scene::load(folder.path().join("s.toml").to_str().unwrap(), &set).unwrap();
        assert_eq!(there(&moving.at(2.0)), there(&moved), "{place} at its last key");
    }
}

#[test]
fn a_turned_box_is_the_box_written_turned() {
    let sphere = "[objects.ball.sphere]\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0";
    let cuboid = |rotate: &str| {
        format!("[objects.ball.box]\ncenter = [0.2, 0.0, 0.0]\nhalf = [1, 0.5, 0.25]\nrotate = {rotate}")
    };
    let motion =
        "\n[objects.ball.motion]\nrotate = [{ time = 0, value = [0, 0, 0] }, { time = 1, value = [20, 50, -30] }]\n";
    let moving = written(&rewritten("glass-sphere", &[(sphere, &cuboid("[0, 0, 0]"))], motion), &[]);
    let turned = written(&rewritten("glass-sphere", &[(sphere, &cuboid("[20, 50, -30]"))], ""), &[]);
    let map = |scene: &Scene| match &scene.objects[0].shape {
        Shape::Canonical { to_world, .. } => *to_world,
        other => panic!("{other:?}"),
    };
    assert!(map(&moving.at(1.0)).abs_diff_eq(map(&turned), ROUNDING));
    // Half the way is half the angle about the same axis.
    let (whole, half) = (map(&moving.at(1.0)).matrix3, map(&moving.at(0.5)).matrix3);
    let rest = map(&moving).matrix3.inverse();
    let by_half = half * rest;
    assert!((by_half * by_half).abs_diff_eq(whole * rest, ROUNDING));
}

#[test]
fn lights_follow_their_keys_and_periods_begin_again() {
    let motion = "\n[lights.beam.motion]\nperiod = 2.0\nposition = [{ time = 0, value = [0, 9, 0] }, { time = 2, value = [4, 9, 0] }]\n\
                  direction = [{ time = 0, value = [0, -1, 0] }, { time = 1, value = [1, 0, 0] }]\n\
                  intensity = [{ time = 0, value = 100 }, { time = 1, value = [0, 50, 100] }]\n";
    let scene = written(&rewritten("moving-sphere", &[], motion), &[]);
    let at = |time: f64| match scene.at(time).lights[0].kind.clone() {
        LightKind::Spot { position, intensity, beam, .. } => (position, intensity, beam.axis),
        other => panic!("{other:?}"),
    };
    let (position, intensity, axis) = at(0.5);
    assert_eq!((position, intensity), (DVec3::new(1.0, 9.0, 0.0), [50.0, 75.0, 100.0]));
    assert!((axis - DVec3::new(0.5f64.sqrt(), -(0.5f64.sqrt()), 0.0)).length() < ROUNDING);
    assert_eq!(at(1_000_000.5), at(0.5), "10⁶ s are half a million periods");
    assert_eq!(at(-1.5), at(0.5));
}

/// What moved is drawn as what stands there: at a key of its way the scene is that with the sphere written there.
#[test]
fn a_moved_scene_is_the_still_one_byte_for_byte() {
    let gpu = gpu();
    let moving = scene("moving-sphere", &[]);
    for camera in ["main", "region"] {
        let mut renderer = Renderer::new(&gpu, &job_of(moving.clone(), &SIDES, camera, [48, 48])).unwrap();
        let moved = frame_at(&mut renderer, 0.3);
        let set = [("objects.ball.motion", "{}"), ("objects.ball.sphere.center", "[0.0, -0.6, 0.0]")];
        let still = picture(&gpu, &job_of(scene("moving-sphere", &set), &SIDES, camera, [48, 48]));
        assert!(!still.renderer.scene().moves());
        assert!(still.layer("irradiance.caustic").iter().any(|e| *e > 0.0), "{camera}: there is a caustic");
        assert_eq!(moved, still.layers, "{camera}");
    }
    assert_quiet(&gpu);
}

/// Through the whole sequence and back, without an allocation or a pipeline: the light leaves the sphere and comes back,
/// and each frame is that of a renderer that knows no other time.
#[test]
fn frames_do_not_depend_on_those_before_and_nothing_is_made_for_them() {
    let gpu = gpu();
    let job = job_of(scene("moving-sphere", &[]), &SIDES, "main", [48, 48]);
    let mut renderer = Renderer::new(&gpu, &job).unwrap();
    let times = [0.0, 0.2, 0.3, 1.0, 1e6, 0.7, 0.3, -1e6, 0.0, 0.4];
    frame_at(&mut renderer, 0.1);
    let before = gpu.calls();
    let live = gpu.live_allocations().len();
    for (index, time) in times.into_iter().enumerate() {
        renderer.frame(&Frame { time, index: index as u32, ..Frame::default() }).unwrap();
    }
    let after = gpu.calls();
    assert_eq!((after.allocations, after.pipelines, after.reads), (before.allocations, before.pipelines, before.reads));
    assert_eq!(after.submits - before.submits, times.len() as u64, "one submit a frame");
    assert_eq!(gpu.live_allocations().len(), live);
    assert_eq!((renderer.moved().moves, renderer.moved().replans), (11, 0));
    for time in [1.0, 0.3, 0.0] {
        let mut fresh = Renderer::new(&gpu, &job).unwrap();
        assert_eq!(frame_at(&mut renderer, time), frame_at(&mut fresh, time), "at {time} s");
        let planned = Renderer::new(&gpu, &job_of(scene("moving-sphere", &[]).at(time), &SIDES, "main", [48, 48]));
        assert_eq!(frame_at(&mut planned.unwrap(), time), frame_at(&mut fresh, time), "planned at {time} s");
    }
    frame_at(&mut renderer, 1.0);
    let account = renderer.account().unwrap();
    assert_eq!((account.emitted(), account.emitted_w()), (0, 0.0), "outside the beam nothing is emitted");
    frame_at(&mut renderer, 0.3);
    assert!(renderer.account().unwrap().valid_w() > 1.0, "and in it the light is back");
    assert_quiet(&gpu);
}

/// A lamp that flies through the glass needs six views inside, one outside: planned again, and right.
#[test]
fn a_lamp_that_enters_the_glass_is_planned_again() {
    let gpu = gpu();
    let lamp = "\n[lights.lamp.point]\nposition = [0, 3, 0]\nintensity = 5\n[lights.lamp.motion]\nposition = [{ time = 0, value = [0, 3, 0] }, { time = 1, value = [0, 0.2, 0] }]\n";
    let sun = "[lights.sun.directional]\ndirection = [0.0, -1.0, 0.0]   # in which the light travels\nirradiance = 1.0";
    let moving = written(&rewritten("glass-sphere", &[(sun, "")], lamp), &[]);
    let set = [("light.side", "64"), ("light.paths", "transmit-1")];
    let job = job_of(moving, &set, "region", [32, 32]);
    let mut renderer = Renderer::new(&gpu, &job).unwrap();
    let outside = frame_at(&mut renderer, 0.0);
    let stages = renderer.stages().len();
    let inside = frame_at(&mut renderer, 1.0);
    assert_eq!((renderer.moved().replans, renderer.stages().len() - stages), (1, 10), "six views for one");
    assert!(inside.get("irradiance.caustic").unwrap().data().iter().any(|e| *e > 0.0));
    assert_eq!(frame_at(&mut renderer, 0.0), outside);
    assert_eq!(renderer.moved().replans, 2);
    assert_eq!(frame_at(&mut renderer, 1.0), frame_at(&mut Renderer::new(&gpu, &job).unwrap(), 1.0));
    assert_quiet(&gpu);
}

/// An object that leaves the scene's bounds, far and fast, and one that comes down to a millionth of its size.
#[test]
fn far_fast_and_small_are_answered() {
    let gpu = gpu();
    let key = |time: f64, value: &str| format!("{{ time = {time}, value = {value} }}");
    for (name, track) in [
        ("position", [key(0.0, "[0, 0, 0]"), key(0.001, "[1e6, 0, 0]")]),
        ("scale", [key(0.0, "1"), key(0.001, "1e-6")]),
    ] {
        let motion = format!("\n[objects.ball.motion]\n{name} = [{}, {}]\n", track[0], track[1]);
        let moving = written(&rewritten("glass-sphere", &[], &motion), &[]);
        let mut renderer = Renderer::new(&gpu, &job_of(moving, &SIDES, "main", [32, 32])).unwrap();
        let there = frame_at(&mut renderer, 0.0);
        for layer in frame_at(&mut renderer, 1.0).iter() {
            assert!(layer.data().iter().all(|v| v.is_finite()), "{name}: {}", layer.name());
        }
        let gone = frame_at(&mut renderer, 1.0);
        let lit = gone.get("irradiance.direct").unwrap().data();
        assert!(name == "scale" || lit.iter().all(|e| *e == 0.0 || (*e - 1.0).abs() < 1e-5), "no shadow is left");
        assert_eq!(frame_at(&mut renderer, 0.0), there, "{name}: back again");
    }
    assert_quiet(&gpu);
}

#[test]
fn the_knot_clears_its_floor_however_it_is_twisted() {
    let scene = scene("bending", &[]);
    let lowest = |time: f64| scene.at(time).objects[1].shape.bounds().expect("a knot")[0].y;
    assert_eq!(scene.objects[1].name, "knot");
    let all: Vec<f64> = (0..80).map(|k| lowest(0.05 * f64::from(k))).collect();
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    println!("{least} m above the floor");
    assert!(least > 0.05, "{least} m");
    assert!((lowest(0.5) - lowest(1_000_000.5)).abs() < ROUNDING, "10⁶ s are a quarter of a million periods");
}

/// Refitted or built again, the tree holds the same triangles, and the picture is that of a renderer that knows no other
/// time; nothing is allocated for it.
#[test]
fn a_mesh_that_bends_is_drawn_as_it_is_whatever_it_was_before() {
    let gpu = gpu();
    let job = job_of(scene("bending", &[]), &SIDES, "main", [48, 48]);
    let mut renderer = Renderer::new(&gpu, &job).unwrap();
    frame_at(&mut renderer, 0.5);
    let before = gpu.calls();
    let times = [0.1, 0.2, 1.0, 3.0, 1.0, 2.0, 0.0];
    for time in times {
        renderer.frame(&Frame { time, ..Frame::default() }).unwrap();
    }
    let after = gpu.calls();
    assert_eq!((after.allocations, after.pipelines), (before.allocations, before.pipelines));
    let moved = renderer.moved();
    println!("{moved:?}");
    assert_eq!((moved.refitted + moved.rebuilt, moved.replans), (times.len() as u64 + 1, 0));
    assert!(moved.refitted > 0, "a small twist leaves the tree as good as it was");
    for time in [1.0, 3.0] {
        let mut fresh = Renderer::new(&gpu, &job_of(scene("bending", &[]).at(time), &SIDES, "main", [48, 48])).unwrap();
        assert_eq!(frame_at(&mut renderer, time), frame_at(&mut fresh, time), "at {time} s");
    }
    assert_quiet(&gpu);
}

/// A wave that runs: after the time of a wavelength it is where it was, after half of it crests are troughs.
#[test]
fn a_sine_runs_along_u_by_its_speed() {
    let speed = ("wavelength = 0.5", "wavelength = 0.5\nspeed = 0.25");
    let scene = written(&rewritten("sine-water", &[speed], ""), &[]);
    assert!(scene.moves() && scene.keyed_span().is_none() && scene.object_motion(1) == ["speed"]);
    let water = |time: f64| scene.at(time).objects[1].shape.clone();
    // Where a ray from above meets it, m.
    let height = |time: f64, x: f64| match water(time) {
        Shape::Canonical { kind, to_world } => {
            let back = to_world.inverse();
            let (o, d) = (DVec3::new(x, 1.0, 0.1), DVec3::NEG_Y);
            1.0 - kind.meet(back.transform_point3(o), back.transform_vector3(d), 0.0, false).expect("the water")
        }
        other => panic!("{other:?}"),
    };
    for time in [0.0, 0.3, 1.0, 7.7, -2.2, 1e6, 1e9] {
        for x in [-0.9, -0.31, 0.0, 0.125, 0.6] {
            let waves = x / 0.5 - (0.25 * time / 0.5_f64).fract();
            let exact = 0.02 * (std::f64::consts::TAU * waves).sin();
            // Roundings of the two phases, of up to 10⁹ waves, in radians over an amplitude of 0.02.
            assert!((height(time, x) - exact).abs() < 1e3 * ROUNDING, "{x} at {time} s: {} {exact}", height(time, x));
        }
    }
    assert_eq!(scene.at(0.5).source.hash, scene.at(0.2).at(0.5).source.hash);
    assert_ne!(scene.at(0.5).source.hash, scene.source.hash);
}

/// The picture of a sine that has run is the still one seen from as far behind, and no frame depends on another.
#[test]
fn a_wave_that_has_run_casts_the_light_of_one_that_stands_there() {
    let gpu = gpu();
    let set = [("light.side", "256"), ("maps.side", "128"), ("eye.samples", "2")];
    let speed = ("wavelength = 0.5", "wavelength = 0.5\nspeed = 0.25");
    let job = job_of(written(&rewritten("sine-water", &[speed], ""), &[]), &set, "region", [64, 64]);
    let mut renderer = Renderer::new(&gpu, &job).unwrap();
    let still = picture(&gpu, &job_of(scene("sine-water", &[]), &set, "region", [64, 64]));
    let caustic = |layers: &Layers| layers.get("irradiance.caustic").expect("a caustic").data().to_vec();
    assert_eq!(caustic(&frame_at(&mut renderer, 0.0)), caustic(&still.layers));
    // Columns of the region's 1 m: the waves have gone 0.25 m, 16 of 64 pixels, at 1 s.
    let column = |of: &[f32], x: usize| (0..64).map(|y| f64::from(of[(y * 64 + x) * 3])).sum::<f64>() / 64.0;
    let (run, rest) = (caustic(&frame_at(&mut renderer, 1.0)), caustic(&still.layers));
    let mean = (0..64).map(|x| column(&rest, x)).sum::<f64>() / 64.0;
    let worst = (16..64).map(|x| (column(&run, x) - column(&rest, x - 16)).abs() / mean).fold(0.0, f64::max);
    println!("columns differ by {worst:.4} of the mean");
    assert!(worst < COLUMN, "{worst}");
    assert_eq!(frame_at(&mut renderer, 0.0), still.layers, "and back");
    assert_quiet(&gpu);
}

/// Share of the mean by which a column of the picture above may differ: photons do not run with the waves, and at a fold,
/// eight times as bright as the mean, a pixel's share of them is a matter of where they start. Measured 0.024.
const COLUMN: f64 = 0.05;

/// A sheet of the wave function is at a time what the file says of that time, and each frame that of a fresh renderer.
#[test]
fn the_wave_function_follows_the_time_of_the_scene() {
    let gpu = gpu();
    let sine = "[objects.water.sine]\ncenter = [0.0, 0.0, 0.0]\nu = [1.0, 0.0, 0.0]      # half edges, at right angles; \
                the crests stand towards u × v\nv = [0.0, 0.0, -1.0]\namplitude = 0.02\nwavelength = 0.5\n";
    let wave = |more: &str| {
        let sheet = "[objects.water.wave]\ncenter = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\ngrid = 48\n";
        written(&rewritten("sine-water", &[(sine, &format!("{sheet}{more}\n"))], ""), &[])
    };
    let heights = |scene: &Scene| match &scene.objects[1].shape {
        Shape::Mesh { mesh, .. } => mesh.positions.clone(),
        other => panic!("{other:?}"),
    };
    let running = wave("time = 0.7");
    assert!(running.moves() && running.deforms(1) && running.object_motion(1) == ["speed"]);
    assert_eq!(heights(&running), heights(&wave("time = 0.7\nspeed = 2")));
    assert_eq!(heights(&running.at(0.5)), heights(&wave("time = 1.2")));
    assert_ne!(heights(&running.at(0.5)), heights(&running));
    assert!(!wave("speed = 0").moves(), "without a speed it stands still");
    for splat in ["fixed", "cells"] {
        let set = [&SIDES[..], &[("maps.splat", splat)]].concat();
        let of = |scene: Scene| Renderer::new(&gpu, &job_of(scene, &set, "main", [48, 48])).unwrap();
        let mut renderer = of(running.clone());
        let first = frame_at(&mut renderer, 0.0);
        let before = gpu.calls();
        for time in [0.1, 0.5, 1e6, 0.3] {
            renderer.frame(&Frame { time, ..Frame::default() }).unwrap();
        }
        let after = gpu.calls();
        assert_eq!((after.allocations, after.pipelines), (before.allocations, before.pipelines));
        let (there, planned_there) = (frame_at(&mut renderer, 0.3), frame_at(&mut of(running.at(0.3)), 0.3));
        match splat {
            "fixed" => assert!(there == planned_there),
            _ => assert!(apart(&there, &planned_there) <= EDGES),
        }
        assert!(frame_at(&mut renderer, 0.0) == first, "{splat}: back again");
    }
    assert_quiet(&gpu);
}

/// Of the mean of the caustic.
fn apart(a: &Layers, b: &Layers) -> f32 {
    let [a, b] = [a, b].map(|layers| layers.get("irradiance.caustic").expect("a caustic").data());
    let mean = b.iter().sum::<f32>() / b.len() as f32;
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) / mean;
    println!("apart by {apart:.1e} of the mean");
    apart
}
