//! Lights with a size on the device: against closed forms, against lights without, and against the truth.

use std::{f64::consts::PI, ops::ControlFlow};

use glam::DVec2;
use nephroid::{
    gpu::Gpu,
    metrics::{Pair, relmse},
    optics::fresnel,
    passes::light,
    renderer::plan,
    scene::Scene,
    settings::Settings,
    truth::{Estimator, Goal, Run, Task, trace::Space},
};

use crate::{
    common::{
        gpu,
        picture::{Picture, Pixels, all_ended, job_of, picture, worst, written},
    },
    lights::under,
};

/// Pixels a side.
const SIDE: u32 = 64;

/// A floor alone, under these lights.
fn bare(lights: &str) -> Scene {
    let scene = under("diffuse", lights);
    let text = scene.source.text;
    let (above, below) = text.split_once("[objects.ball]").expect("a ball");
    let (_, below) = below.split_once("[objects.floor]").expect("a floor");
    written(&format!("{above}[objects.floor]{below}"), &[])
}

fn of(gpu: &Gpu, scene: &Scene, set: &[(&str, &str)]) -> Picture {
    picture(gpu, &job_of(scene.clone(), set, "region", [SIDE; 2]))
}

/// Irradiance of a plane under a disk parallel to it, `height` above, at a distance from its axis.
fn below_a_disk(radiance: f64, radius: f64, height: f64, aside: f64) -> f64 {
    let (h, r, a) = (height * height, radius * radius, aside * aside);
    let root = ((h + a + r).powi(2) - 4.0 * a * r).sqrt();
    0.5 * PI * radiance * (1.0 - (h + a - r) / root)
}

/// The same under a rectangle, at a place relative to its middle: four of which the place is the corner.
fn below_a_rectangle(radiance: f64, half: DVec2, height: f64, at: DVec2) -> f64 {
    let corner = |x: f64, y: f64| {
        let (x, y) = (x / height, y / height);
        let side = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
        0.5 * radiance * (side(x, y) + side(y, x))
    };
    let [(x0, x1), (y0, y1)] = [(half.x, at.x), (half.y, at.y)].map(|(h, p)| (-h - p, h - p));
    corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
}

const DISK: &str =
    "[lights.lamp.disk]\ncenter = [0.2, 1, 0.1]\nnormal = [0, -1, 0]\nradius = 0.6\nradiance = [1, 2, 4]\n";
const QUAD: &str = "[lights.lamp.quad]\ncenter = [0.2, 1, 0.1]\nu = [0.8, 0, 0]\nv = [0, 0, 0.3]\npower = 2\n";
/// The points of a light, 64 or more a pixel, against its integral.
const QUADRATURE: f64 = 1e-3;

#[test]
fn a_floor_below_a_surface_that_shines() {
    let gpu = gpu();
    let (disk, quad) = (bare(DISK), bare(QUAD));
    let radiance = 2.0 / (PI * 4.0 * 0.8 * 0.3);
    for (what, scene) in [("disk", &disk), ("quad", &quad)] {
        let found = of(&gpu, scene, &[]);
        assert!(!found.ran("light/photons"), "nothing is specular");
        let pixels = Pixels { region: &scene.region, size: [SIDE; 2] };
        let errors = pixels.centres().zip(found.layer("irradiance.direct").chunks(3)).map(|(p, e)| {
            let aside = DVec2::new(p.x - 0.2, p.z - 0.1);
            let exact = match what {
                "disk" => below_a_disk(1.0, 0.6, 2.0, aside.length()),
                _ => below_a_rectangle(radiance, DVec2::new(0.8, 0.3), 2.0, aside),
            };
            f64::from(e[0]) / exact - 1.0
        });
        let worst = worst(errors);
        println!("floor below a {what}: worst pixel {worst:.1e}");
        assert!(worst < QUADRATURE, "{what}: {worst}");
    }
}

fn sun(degrees: f64) -> String {
    format!(
        "[lights.sun.directional]\ndirection = [0.0, -1.0, 0.0]\nirradiance = [1.0, 2.0, 4.0]\n\
         angular_diameter = {degrees:?}\n"
    )
}

const FEW: [(&str, &str); 3] = [("light.side", "256"), ("maps.side", "128"), ("light.area_samples", "4")];
/// Of the flux of a texel, by which a photon's place on the map's grid moves a splat when light turns by a millionth.
const GRAIN: f64 = 1e-3;

/// A disc too small to be told from none shines as none does; one of no width is none.
#[test]
fn the_smallest_suns_are_parallel_light() {
    let gpu = gpu();
    let of = |lights: &str, samples: &str| {
        let set = [FEW[0], FEW[1], ("light.area_samples", samples), ("eye.samples", "2")];
        of(&gpu, &under("glass-sphere", lights), &set)
    };
    let none = of(&sun(0.0).replace("angular_diameter = 0.0\n", ""), "4");
    assert!(none.layers == of(&sun(0.0), "4").layers, "no width is no disc");
    let least = of(&sun(1e-6), "1");
    for layer in ["irradiance.direct", "irradiance.caustic"] {
        let brightest = worst(none.layer(layer).iter().map(|e| f64::from(*e)));
        let apart = none.layer(layer).iter().zip(least.layer(layer)).map(|(a, b)| f64::from(a - b) / brightest);
        let apart = worst(apart);
        println!("{layer}: {apart:.1e}");
        assert!(apart < GRAIN, "{layer}: {apart}");
    }
}

/// Photons' lattices of 16 directions, and of the directions what Fresnel differs by.
const EVEN: f64 = 0.015;

/// Below flat water a sun's disc lights all evenly, by what passes; emitted is what the account finds again.
#[test]
fn a_sun_over_flat_water_is_even() {
    let scene = under("flat-water", &sun(10.0));
    let set = [("light.side", "1024"), ("maps.side", "128"), ("light.area_samples", "16"), ("eye.samples", "2")];
    let found = of(&gpu(), &scene, &set);
    all_ended(&found.account, scene.paths);
    let sum = found.account.flux_w[1..].iter().sum::<f64>() + found.account.other_paths_w;
    assert!((sum / found.account.emitted_w() - 1.0).abs() < 1e-5, "{sum} of {}", found.account.emitted_w());
    // The middle, to which light from outside the surface cannot come.
    let n = SIDE as usize;
    let middle: Vec<f64> = found
        .mean("irradiance.caustic")
        .chunks(n)
        .skip(n / 4)
        .take(n / 2)
        .flat_map(|row| row[n / 4..3 * n / 4].to_vec())
        .collect();
    let exact = 7.0 / 3.0 * (1.0 - fresnel(1.0, 1.0, 1.33));
    let worst = worst(middle.iter().map(|e| e / exact - 1.0));
    println!("sun over flat water: worst of {} pixels {worst:.4}", middle.len());
    assert!(worst < EVEN, "{worst}");
}

/// A wall's shadow: the light grows from none to all over the width of the disc's shadow.
const EDGE: f64 = 0.01;

#[test]
fn a_half_shadow_is_as_wide_as_the_disc() {
    // A wall 1 m over the floor whose edge is x = 0, below a sun of 20 degrees.
    let wall = "\n[objects.wall]\nmaterial = \"white\"\nvisible_to_camera = false\n[objects.wall.quad]\ncenter = [-2, 0, 0]\nu = [2, 0, 0]\nv = [0, 0, -8]\n";
    let scene = written(&(bare(&sun(20.0)).source.text + wall), &[]);
    let found = of(&gpu(), &scene, &[("eye.light_samples", "64"), ("eye.samples", "2")]);
    let reach = 10f64.to_radians().tan();
    let pixels = Pixels { region: &scene.region, size: [SIDE; 2] };
    let mut errors = Vec::new();
    for (p, e) in pixels.centres().zip(found.mean("irradiance.direct")) {
        // Of a disc of even radiance by projected area (small angles), what lies on one side of a chord.
        let x = (p.x / reach).clamp(-1.0, 1.0);
        let share = 0.5 + (x.asin() + x * (1.0 - x * x).sqrt()) / PI;
        errors.push(e / (7.0 / 3.0) - share);
    }
    let worst = worst(errors);
    println!("half-shadow: worst pixel {worst:.4}");
    assert!(worst < EDGE, "{worst}");
}

/// The truth's caustic by cells: a light with a size is many without.
fn truth(scene: &Scene, cells: u64) -> nephroid::image::Layers {
    let goal = Goal { photons: Some(cells * cells), noise: None };
    let (estimator, paths) = (Estimator::Cells, scene.paths);
    let task = Task { estimator, paths, camera: "region".to_owned(), size: [SIDE; 2], seed: 0, goal };
    let space = Space::new(scene);
    let mut run = Run::new(&space, &scene.cameras["region"], &task);
    run.advance(2, |_, _| ControlFlow::Continue(()));
    run.layers().unwrap()
}

/// relMSE of the caustic at 1, 4, 16 and 64 points of the light, 512² photons in all: measured 0.025, 0.014, 0.009 and 0.003,
/// and a quarter. Too few are as many copies of the caustic, one over the other.
const BY_POINTS: [(&str, f64); 4] = [("1", 0.031), ("4", 0.018), ("16", 0.0115), ("64", 0.004)];
/// Of the flux in the region.
const ENERGY: f64 = 2e-3;

#[test]
fn more_points_of_a_lamp_come_nearer_to_the_truth() {
    let gpu = gpu();
    let lamp = "[lights.lamp.disk]\ncenter = [0, 4, 0]\nnormal = [0, -1, 0]\nradius = 0.5\nradiance = 20\n";
    let scene = under("glass-sphere", lamp);
    let truth = truth(&scene, 128);
    let reference = truth.get("irradiance.caustic").unwrap();
    let e0 = nephroid::metrics::bare_irradiance(&scene);
    let mut before = f64::INFINITY;
    for (points, most) in BY_POINTS {
        let set = [("light.side", "512"), ("maps.side", "128"), ("light.area_samples", points), ("eye.samples", "4")];
        let found = of(&gpu, &scene, &set);
        let wide = |e: &[f32]| e.iter().map(|e| f64::from(*e)).collect();
        let pair = Pair::new(3, wide(found.layer("irradiance.caustic")), wide(reference.data()), None).unwrap();
        let error = relmse(&pair, e0).value;
        let total = |e: &[f32]| e.iter().map(|e| f64::from(*e)).sum::<f64>();
        let energy = total(found.layer("irradiance.caustic")) / total(reference.data()) - 1.0;
        println!("{points} points: relMSE {error:.2e} of {most}, energy {energy:+.5}");
        assert!(error <= most && error < before, "{points}: {error} after {before}");
        assert!(points == "1" || energy.abs() <= ENERGY, "{points}: {energy}");
        before = error;
    }
}

/// What the plan has of views: their sides, and one a point.
#[test]
fn points_share_the_photons_of_a_light() {
    let both = DISK.replace("[0.2, 1, 0.1]", "[0.2, 4, 0.1]") + &sun(0.0);
    let sides = |lights: &str, samples: &str| {
        let scene = under("glass-sphere", lights);
        let mut settings = Settings::default();
        settings.set(light::SETTINGS, "light.area_samples", samples).unwrap();
        let all = light::emissions(&scene, &settings, &scene.region).unwrap();
        all.iter().map(|emission| emission.side).collect::<Vec<_>>()
    };
    assert_eq!(sides(&both, "16"), [[128; 16].as_slice(), &[512]].concat());
    assert_eq!(sides(&both, "1"), [512, 512]);
    // From within the ball no one frustum of a point holds it: six faces of a cube do.
    let within = DISK.replace("[0.2, 1, 0.1]", "[0, 0, 0]");
    assert_eq!(sides(&within, "5"), [229; 30]);
    assert_eq!(sides(&both, "256").len(), 257);
    let job = job_of(under("glass-sphere", &both), &[("light.area_samples", "4")], "region", [SIDE; 2]);
    let plan = plan(&job).unwrap().plan;
    let extent = |name: &str| plan.images.iter().find(|image| image.name == name).map(|image| image.extent);
    assert_eq!(extent("light/photons.hit"), Some([512; 2]));
    assert_eq!(extent("light/photons.256.hit"), Some([256; 2]));
}

/// A lamp that is seen edge-on from all specular things, or turned away, or below the receiver, sends no photon there; beside
/// a sun, of other sides, all ways to gather agree.
#[test]
fn lamps_that_face_away_send_no_photons() {
    let gpu = gpu();
    for normal in ["[0, 1, 0]", "[1e-9, 1, 0]"] {
        let away = DISK.replace("[0.2, 1, 0.1]", "[0, 4, 0]").replace("[0, -1, 0]", normal);
        let found = of(&gpu, &under("glass-sphere", &away), &FEW);
        assert!(!found.ran("light/photons"), "{normal}");
        assert!(found.layer("irradiance.direct").iter().all(|e| *e == 0.0), "{normal}");
    }
    // Half of the ball lies before the plane of the disk, which sees it edge-on.
    let edge = DISK.replace("[0.2, 1, 0.1]", "[3, 0, 0]").replace("[0, -1, 0]", "[0, 1, 0]");
    let found = of(&gpu, &under("glass-sphere", &edge), &FEW);
    all_ended(&found.account, found.renderer.scene().paths);
    assert!(found.account.emitted_w() > 0.0);
}

#[test]
fn a_lamp_beside_a_sun_by_every_gather_and_view() {
    let gpu = gpu();
    let both = DISK.replace("[0.2, 1, 0.1]", "[0.2, 4, 0.1]") + &sun(0.0);
    let scene = under("glass-sphere", &both);
    let by = |more: &[(&str, &str)]| of(&gpu, &scene, &[&FEW[..], more].concat());
    let fetch = by(&[]);
    let [disk, alone] = [&scene.lights[0], &scene.lights[1]].map(|light| {
        let mut one = scene.clone();
        one.lights = vec![light.clone()];
        of(&gpu, &one, &FEW)
    });
    let total = |picture: &Picture| picture.sum("irradiance.caustic");
    let apart = total(&fetch) / (total(&disk) + total(&alone)) - 1.0;
    assert!(apart.abs() < 1e-6, "the sum of both: {apart}");
    for more in [
        ("maps.gather", "copy"),
        ("maps.gather", "hierarchical"),
        ("maps.splat", "cells"),
        ("light.view", "shared"),
        ("light.tracer", "fixed-point"),
    ] {
        let other = by(&[more]);
        all_ended(&other.account, scene.paths);
        let apart = total(&other) / total(&fetch) - 1.0;
        println!("{more:?}: {apart:+.1e}");
        let allowed = if more.0 == "maps.gather" { 1e-5 } else { 0.03 };
        assert!(apart.abs() < allowed, "{more:?}: {apart}");
    }
}
