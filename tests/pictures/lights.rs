//! Kinds of lights against each other, against closed forms and against the truth.

use std::ops::ControlFlow;

use crate::common::{
    gpu,
    picture::{Picture, Pixels, job_of, picture, rewritten, worst, written},
};
use glam::DVec3;
use nephroid::{
    gpu::Gpu,
    optics::{fresnel, refract},
    scene::{Beam, LightKind, Scene},
    truth::{Estimator, Goal, Run, Task, trace::Space},
};

const SIDE: u32 = 64;
const SETTINGS: [(&str, &str); 2] = [("light.side", "512"), ("maps.side", "256")];

/// A shipped scene under other lights, in the words of the file.
pub fn under(name: &str, lights: &str) -> Scene {
    let sun = rewritten(name, &[], "");
    let (above, _) = sun.split_once("[lights.sun").expect("a sun");
    written(&format!("{above}{lights}"), &[])
}

fn spot(position: &str, direction: &str, inner: f64, outer: f64) -> String {
    format!(
        "[lights.lamp.spot]\nposition = {position}\ndirection = {direction}\nintensity = [1.0, 2.0, 4.0]\n\
         inner = {inner:?}\nouter = {outer:?}\n"
    )
}

fn point(position: &str) -> String {
    format!("[lights.lamp.point]\nposition = {position}\nintensity = [1.0, 2.0, 4.0]\n")
}

fn of(gpu: &Gpu, scene: Scene) -> Picture {
    picture(gpu, &job_of(scene, &SETTINGS, "region", [SIDE; 2]))
}

/// Direct and caustic irradiance of every pixel, all bands.
fn irradiance(picture: &Picture) -> Vec<f64> {
    let [direct, caustic] = ["irradiance.direct", "irradiance.caustic"].map(|name| picture.layer(name));
    direct.iter().zip(caustic).map(|(a, b)| f64::from(a + b)).collect()
}

fn beam(scene: &Scene) -> (DVec3, Beam) {
    match scene.lights[0].kind {
        LightKind::Spot { position, beam, .. } => (position, beam),
        _ => panic!("no spot"),
    }
}

/// Both lights send the same into the same view; the product with a share of exactly one changes no bit.
#[test]
fn a_spot_wider_than_the_object_is_the_point_light() {
    let gpu = gpu();
    let lamp = of(&gpu, under("glass-sphere", &point("[0.3, 3.0, 0.2]")));
    let wide = of(&gpu, under("glass-sphere", &spot("[0.3, 3.0, 0.2]", "[0, -1, 0]", 80.0, 85.0)));
    assert!(lamp.layer("irradiance.caustic") == wide.layer("irradiance.caustic"));
    assert!((lamp.account.emitted_w() / wide.account.emitted_w() - 1.0).abs() < 1e-12);
    // 179° and 180° light all that the point does, the floor too.
    for outer in [179.0, 180.0] {
        let all = of(&gpu, under("glass-sphere", &spot("[0.3, 3.0, 0.2]", "[0, -1, 0]", outer, outer)));
        assert!(irradiance(&lamp) == irradiance(&all), "{outer}");
    }
}

/// Mean relative error of a spot's null, against its brightest pixel: the photons' lattice, as in `null`, of fewer photons
/// a texel; and the largest of it, where a pixel of the shadow's edge mixes both.
const NULL_MEAN: f64 = 5e-3;
const NULL_WORST: f64 = 0.1;
/// Share of all the light that may be lost or made.
const NULL_TOTAL: f64 = 1e-3;

/// A sphere of index one vanishes in a beam whose smooth edge crosses it.
#[test]
fn a_sphere_of_index_one_vanishes_in_a_beam() {
    let scene = under("null", &spot("[0.4, 4.0, 0.0]", "[-0.05, -1, 0.05]", 4.0, 14.0));
    let ((position, beam), region) = (beam(&scene), scene.region.clone());
    let found = irradiance(&of(&gpu(), scene));
    let exact: Vec<f64> = Pixels { region: &region, size: [SIDE; 2] }
        .centres()
        .flat_map(|p| {
            let way = p - position;
            let e = beam.share(way.normalize()) * -way.normalize().y / way.length_squared();
            [1.0, 2.0, 4.0].map(|intensity| intensity * e)
        })
        .collect();
    let brightest = worst(exact.iter().copied());
    let errors: Vec<f64> = found.iter().zip(&exact).map(|(a, b)| (a - b).abs() / brightest).collect();
    let (mean, most) = (errors.iter().sum::<f64>() / errors.len() as f64, worst(errors.iter().copied()));
    let total = found.iter().sum::<f64>() / exact.iter().sum::<f64>() - 1.0;
    println!("null in a beam: mean {mean:.5}, worst {most:.4}, total {total:+.6}");
    assert!(mean <= NULL_MEAN && most <= NULL_WORST && total.abs() <= NULL_TOTAL, "{mean} {most} {total}");
}

/// Flat water under a spot: E = I share T cosθ/(s²) times what refraction does to the beam's cross-section.
const WATER: f64 = 5e-3;
/// Dark pixels, where few photons fall, are judged against this share of the brightest.
const DARK: f64 = 0.1;
/// Points of a pixel a side, whose mean stands for it.
const POINTS: usize = 4;

fn mean_over_pixel(pixels: &Pixels, pixel: usize, of: impl Fn(DVec3) -> f64) -> f64 {
    let within = |k: usize| (k as f64 + 0.5) / POINTS as f64;
    let (x, y) = ((pixel % SIDE as usize) as f64, (pixel / SIDE as usize) as f64);
    let points = (0..POINTS * POINTS).map(|k| pixels.at(x + within(k % POINTS), y + within(k / POINTS)));
    points.map(of).sum::<f64>() / (POINTS * POINTS) as f64
}

#[test]
fn a_spot_over_flat_water() {
    let scene = under("flat-water", &spot("[0.1, 1.5, 0.0]", "[0, -1, 0]", 10.0, 25.0));
    let ((position, beam), region) = (beam(&scene), scene.region.clone());
    // Some twenty photons a texel: with five, their lattice beats against the map's by a percent.
    let dense = [("light.side", "1024"), ("maps.side", "256")];
    let found = picture(&gpu(), &job_of(scene, &dense, "region", [SIDE; 2]));
    let (mut total, mut off) = ([0.0; 2], Vec::new());
    let (pixels, brightest) =
        (Pixels { region: &region, size: [SIDE; 2] }, below_water(position, &beam, DVec3::new(0.1, -1.0, 0.0)));
    for k in 0..(SIDE * SIDE) as usize {
        let exact = mean_over_pixel(&pixels, k, |p| below_water(position, &beam, p));
        let e = f64::from(found.layer("irradiance.caustic")[3 * k]);
        total = [total[0] + e, total[1] + exact];
        // Where the receiver ends, splats are cut and the look-up has no neighbour: those pixels are in the total alone.
        let border = [k % SIDE as usize, k / SIDE as usize].iter().any(|x| *x == 0 || *x == SIDE as usize - 1);
        if !border {
            off.push((e - exact) / (exact + DARK * brightest));
        }
    }
    let (worst, total) = (worst(off.iter().copied()), total[0] / total[1] - 1.0);
    println!("spot over flat water: total {total:+.5}, worst of {} pixels {worst:.5}", off.len());
    assert!(total.abs() <= WATER && worst <= WATER, "{total} {worst}");
}

/// Irradiance (first band) at p, a metre below the water: the flux between two angles lands between two radii.
fn below_water(position: DVec3, beam: &Beam, p: DVec3) -> f64 {
    let (height, depth, ior) = (position.y, -p.y, 1.33);
    let radius = (p - position).with_y(0.0).length();
    let lands = |theta: f64| {
        let t = refract(DVec3::new(theta.sin(), -theta.cos(), 0.0), DVec3::Y, 1.0 / ior).expect("into water");
        height * theta.tan() - depth * t.x / t.y
    };
    let (mut low, mut high) = (0.0f64, 1.5f64);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        (low, high) = if lands(middle) < radius { (middle, high) } else { (low, middle) };
    }
    let theta = 0.5 * (low + high);
    let step = 1e-5;
    // dΩ = sinθ dθ dφ over dA = r dr dφ; on the axis both vanish alike.
    let slope = (lands(theta + step) - lands((theta - step).max(0.0))) / (theta + step - (theta - step).max(0.0));
    let spread = if radius > 1e-6 { theta.sin() / (radius * slope) } else { 1.0 / (slope * slope) };
    beam.share(DVec3::new(theta.sin(), -theta.cos(), 0.0)) * (1.0 - fresnel(theta.cos(), 1.0, ior)) * spread
}

/// The caustic's energy in a picture may miss that of the truth by this.
const ENERGY: f64 = 0.01;

/// A slanting spot through glass that lies half in the beam, against the float64 truth.
#[test]
fn a_spots_caustic_has_the_truths_energy() {
    let scene = under("glass-sphere", &spot("[1.5, 3.0, 0.5]", "[-0.35, -1, -0.2]", 3.0, 15.0));
    let goal = Goal { photons: Some(128 * 128), noise: None };
    let (estimator, paths) = (Estimator::Cells, scene.paths);
    let task = Task { estimator, paths, camera: "region".to_owned(), size: [SIDE; 2], seed: 0, goal };
    let space = Space::new(&scene);
    let mut run = Run::new(&space, &scene.cameras["region"], &task);
    run.advance(2, |_, _| ControlFlow::Continue(()));
    let truth: f64 =
        run.layers().unwrap().get("irradiance.caustic").unwrap().data().iter().map(|e| f64::from(*e)).sum();
    let found: f64 = of(&gpu(), scene.clone()).layer("irradiance.caustic").iter().map(|e| f64::from(*e)).sum();
    println!("spot through glass: {:+.5}", found / truth - 1.0);
    assert!(truth > 0.0 && (found / truth - 1.0).abs() <= ENERGY, "{found} of {truth}");
}

/// "A light that reaches nothing specular gets no photon pass."
#[test]
fn a_spot_that_turns_away_gets_no_photon_pass() {
    let away = under("glass-sphere", &spot("[0.0, 3.0, 0.0]", "[0, 1, 0]", 10.0, 30.0));
    let plan = nephroid::renderer::plan(&job_of(away, &SETTINGS, "region", [SIDE; 2])).unwrap().plan;
    assert!(plan.passes.iter().all(|p| !p.name.starts_with("light/")), "{:?}", plan.passes);
    assert!(plan.left_out.iter().any(|l| l.name == "light/photons" && l.reason.contains("reaches a specular object")));
    // Beside another that does, it costs nothing.
    let both = spot("[0.0, 3.0, 0.0]", "[0, 1, 0]", 10.0, 30.0) + &point("[0.0, 3.0, 0.0]").replace("lamp", "other");
    let plan = nephroid::renderer::plan(&job_of(under("glass-sphere", &both), &SETTINGS, "region", [SIDE; 2])).unwrap();
    assert_eq!(plan.plan.passes.iter().filter(|p| p.name.starts_with("light/photons")).count(), 1);
}

/// The view narrows to the beam, so that a thin one still fills the photon buffer; and its emitted flux is I·Ω.
#[test]
fn a_thin_beam_fills_its_view() {
    let gpu = gpu();
    for degrees in [5.0f64, 0.1, 0.01] {
        let picture = of(&gpu, under("glass-sphere", &spot("[0.0, 3.0, 0.0]", "[0, -1, 0]", degrees, degrees)));
        let cone = 4.0 * std::f64::consts::PI * (0.5 * degrees.to_radians()).sin().powi(2) * 7.0 / 3.0;
        let (count, flux) = (picture.account.emitted(), picture.account.emitted_w() / cone);
        println!("{degrees}°: {count} photons, flux {flux:.5}");
        assert!(count > 200_000, "{degrees}°: {count} of 262,144 photons are in the beam");
        assert!((flux - 1.0).abs() < 2e-3, "{degrees}°: {flux}");
    }
}
