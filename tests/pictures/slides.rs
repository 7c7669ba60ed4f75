//! Pictures that spots project: the share of a direction on both sides, and what arrives on the floor.

use std::ops::ControlFlow;

use crate::common::{
    Binder, Probe, gpu,
    picture::{Picture, Pixels, job_of, picture, png, rewritten, worst},
    random::Random,
};
use glam::DVec3;
use nephroid::{
    gpu::Gpu,
    passes::{accel::SceneArrays, scene::SceneBuffers},
    renderer::{Frame, Renderer},
    scene::{LightKind, Scene},
    truth::{Estimator, Goal, Run, Task, trace::Space},
};

const SIDE: u32 = 64;
const SETTINGS: [(&str, &str); 2] = [("light.side", "512"), ("maps.side", "256")];

/// Smooth enough that a map's texel does not see its pixels, and of other colours at each corner.
fn smooth() -> Vec<u8> {
    let pixel = |k: u32| {
        let (x, y) = (f64::from(k % 12) / 11.0, f64::from(k / 12) / 7.0);
        [120.0 + 100.0 * x, 90.0 + 150.0 * y, 220.0 - 80.0 * x * y].map(|band| band as u8)
    };
    png(12, &(0..96).map(pixel).collect::<Vec<_>>())
}

/// A shipped scene under one spot with a picture.
fn under(name: &str, spot: &str, picture: &[u8]) -> Scene {
    let text = rewritten(name, &[], "");
    let (above, _) = text.split_once("[lights.sun").expect("a sun");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("slide.png"), picture).unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, format!("{above}[lights.lamp.spot]\n{spot}\n")).unwrap();
    Scene::load(path.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn of(gpu: &Gpu, scene: &Scene) -> Picture {
    picture(gpu, &job_of(scene.clone(), &SETTINGS, "region", [SIDE; 2]))
}

/// Direct and caustic irradiance of every pixel, all bands.
fn irradiance(picture: &Picture) -> Vec<f64> {
    let [direct, caustic] = ["irradiance.direct", "irradiance.caustic"].map(|name| picture.layer(name));
    direct.iter().zip(caustic).map(|(a, b)| f64::from(a + b)).collect()
}

/// Of the picture's coordinates in float32, some roundings over a pixel of a twelfth; at its rim they decide about all.
const SHARE: f64 = 1e-4;
/// How near to the rim float32 may take a direction for one on the other side.
const RIM: f64 = 1e-5;

#[test]
fn shaders_and_scene_agree_about_every_direction() {
    let spot = "position = [0, 3, 0]\ndirection = [0.2, -1, 0.1]\nintensity = 1\ninner = 15\nouter = 25\nimage = \"slide.png\"\nup = [1, 0, 0]";
    let scene = under("glass-sphere", spot, &smooth());
    let kind = scene.lights[0].kind.clone();
    let LightKind::Spot { beam, slide: Some(slide), .. } = &kind else { panic!("no slide") };
    let arrays = SceneArrays::build(&scene).unwrap();
    let mut random = Random(11);
    let mut rows: Vec<[f32; 3]> = (0..20_000)
        .map(|_| (beam.axis + random.direction() * random.unit() * 0.6).normalize().as_vec3().to_array())
        .collect();
    rows.extend((0..1000).map(|_| random.direction().as_vec3().to_array()));
    let probe = Probe {
        includes: &["shared/scene.glsl"],
        input: "vec3 d;",
        output: "vec3 share;",
        body: "r.share = light_share(scene_lights.data[0], q.d);",
        ..Default::default()
    };
    let buffers = |plan: &mut nephroid::gpu::Plan| -> Binder {
        let buffers = SceneBuffers::upload(plan, &scene, &arrays);
        Box::new(move |pass| buffers.lights(buffers.tracing(pass)))
    };
    let found: Vec<[f32; 3]> = probe.run_with(&gpu(), &rows, buffers);
    let (mut lit, mut at_rim) = (0, 0);
    for (row, share) in rows.iter().zip(&found) {
        let d = DVec3::from(row.map(f64::from));
        let (exact, share) = (kind.share(d), DVec3::from(share.map(f64::from)));
        let [x, y] = slide.axes(beam.axis).map(|across| across.dot(d) / beam.axis.dot(d));
        let rim = (x.abs() - 1.0).abs().min((y.abs() - 1.0).abs()) < RIM;
        at_rim += usize::from(rim);
        lit += usize::from(exact.max_element() > 0.0);
        assert!(rim || (share - exact).abs().max_element() < SHARE, "{row:?}: {share} for {exact}");
    }
    println!("{lit} lit of {}, {at_rim} at the rim", rows.len());
    assert!(lit > 3000 && at_rim < 20, "{lit} {at_rim}");
}

/// As in `lights`: mean relative error of a spot's null, its largest, and the share of light lost or made.
const NULL: [f64; 3] = [5e-3, 0.1, 1e-3];

/// A sphere of index one vanishes in a projected picture whose rim lies beyond the region: each pixel has I share cos / r².
#[test]
fn a_sphere_of_index_one_vanishes_in_a_picture() {
    let spot = "position = [0.4, 4.0, 0.0]\ndirection = [-0.05, -1, 0.05]\nintensity = [1.0, 2.0, 4.0]\nouter = 40\nimage = \"slide.png\"";
    let scene = under("null", spot, &smooth());
    let found = irradiance(&of(&gpu(), &scene));
    let light = &scene.lights[0].kind;
    let position = light.position().unwrap();
    let exact: Vec<f64> = Pixels { region: &scene.region, size: [SIDE; 2] }
        .centres()
        .flat_map(|p| {
            let way = p - position;
            let e = light.share(way.normalize()) * (-way.normalize().y / way.length_squared());
            (DVec3::new(1.0, 2.0, 4.0) * e).to_array()
        })
        .collect();
    let brightest = worst(exact.iter().copied());
    let errors: Vec<f64> = found.iter().zip(&exact).map(|(a, b)| (a - b).abs() / brightest).collect();
    let (mean, most) = (errors.iter().sum::<f64>() / errors.len() as f64, worst(errors.iter().copied()));
    let total = found.iter().sum::<f64>() / exact.iter().sum::<f64>() - 1.0;
    println!("null in a picture: mean {mean:.5}, worst {most:.4}, total {total:+.6}");
    assert!(mean <= NULL[0] && most <= NULL[1] && total.abs() <= NULL[2], "{mean} {most} {total}");
}

/// Within its rectangle a white picture is none.
#[test]
fn a_white_picture_is_the_plain_beam_inside_its_rim() {
    let gpu = gpu();
    let spot = "position = [0, 4, 0]\ndirection = [0, -1, 0]\nintensity = [1.0, 2.0, 4.0]\nouter = 40";
    let white = under("glass-sphere", &format!("{spot}\nimage = \"slide.png\""), &png(2, &[[255; 3]; 4]));
    let plain = under("glass-sphere", spot, &[]);
    let (white, plain) = (of(&gpu, &white), of(&gpu, &plain));
    // The rim is 2.36 m a unit along the axis from the middle, on the floor 3.3 m away: the region lies within.
    assert_eq!(irradiance(&white), irradiance(&plain));
    assert_eq!(white.account.counts, plain.account.counts);
}

/// Share of the light that truth and map may differ by, of 2¹⁸ photons each: one over their root. Measured 8·10⁻⁴.
const ENERGY: f64 = 2e-3;

/// The truth throws the same picture: the caustic's light, band by band, and the direct light of every pixel.
#[test]
fn the_truth_throws_the_same_picture() {
    let spot = "position = [0, 6, 0]\ndirection = [0, -1, 0]\nintensity = 60\nouter = 30\nimage = \"slide.png\"";
    let scene = under("glass-sphere", spot, &smooth());
    let picture = of(&gpu(), &scene);
    let task = Task {
        estimator: Estimator::Photons,
        paths: scene.paths,
        camera: "region".to_owned(),
        size: [SIDE; 2],
        seed: 1,
        goal: Goal { photons: Some(1 << 18), noise: None },
    };
    let space = Space::new(&scene);
    let mut run = Run::new(&space, &scene.cameras["region"], &task);
    run.advance(2, |_, _| ControlFlow::Continue(()));
    let truth = run.layers().unwrap();
    for layer in ["irradiance.caustic", "irradiance.direct"] {
        let sums =
            |data: &[f32]| [0, 1, 2].map(|band| data.iter().skip(band).step_by(3).map(|v| f64::from(*v)).sum::<f64>());
        let (ours, exact) = (sums(picture.layer(layer)), sums(truth.get(layer).unwrap().data()));
        let ratios = [0, 1, 2].map(|band| ours[band] / exact[band] - 1.0);
        println!("{layer}: {ratios:+.5?}");
        assert!(ratios.iter().all(|off| off.abs() < ENERGY), "{layer}: {ratios:?}");
    }
}

/// A picture goes with its beam: a frame at a time is that of a renderer that knows no other.
#[test]
fn a_picture_turns_with_its_beam() {
    let gpu = gpu();
    let spot = "position = [0, 6, 0]\ndirection = [0, -1, 0]\nintensity = 60\nouter = 30\nimage = \"slide.png\"\nup = [0, 0, -1]\n\
                [lights.lamp.motion]\ndirection = [{ time = 0, value = [0, -1, 0] }, { time = 1, value = [0.3, -1, 0.1] }]";
    let scene = under("glass-sphere", spot, &smooth());
    let small = [("light.side", "128"), ("maps.side", "128"), ("eye.samples", "1")];
    let frame = |renderer: &mut Renderer, time: f64| {
        renderer.frame(&Frame { time, ..Frame::default() }).unwrap();
        renderer.layers().unwrap()
    };
    let mut moved = Renderer::new(&gpu, &job_of(scene.clone(), &small, "region", [32; 2])).unwrap();
    let mut there = Renderer::new(&gpu, &job_of(scene.at(1.0), &small, "region", [32; 2])).unwrap();
    let before = frame(&mut moved, 0.0);
    assert_eq!(frame(&mut moved, 1.0), frame(&mut there, 1.0));
    assert_ne!(frame(&mut moved, 1.0), before);
    assert_eq!(frame(&mut moved, 0.0), before);
    crate::common::assert_quiet(&gpu);
}
