//! Kinds of lights agree where one is the limit, the sum or a part of another.

use crate::common::{
    gpu,
    picture::{Picture, Pixels, job_of, picture, rewritten, scene, worst, written},
};
use glam::DVec3;
use nephroid::{
    gpu::Gpu,
    scene::{LightKind, MaterialKind, Scene, Shape},
    stats::percentile,
    truth::closed::direct_point,
};

/// Pixels a side, one of the map's texels each or more.
const SIDE: u32 = 64;
const SETTINGS: [(&str, &str); 2] = [("light.side", "512"), ("maps.side", "256")];

fn of(gpu: &Gpu, scene: &Scene) -> Picture {
    picture(gpu, &job_of(scene.clone(), &SETTINGS, "region", [SIDE; 2]))
}

/// Distance of the lamp that stands for the sun, in radii of what it lights.
const FAR: f64 = 10_000.0;
/// Of the light within the region: on the floor the lamp is 1.5 radii further than the middle of the object, 3·10⁻⁴ of power.
const FAR_TOTAL: f64 = 1e-3;
/// Of the light between two circles.
const FAR_ANNULUS: f64 = 5e-3;
const ANNULI: usize = 8;

/// The scene under a lamp so far in its sun's direction that it shines as the sun does, and the middle of what it lights.
fn under_a_far_lamp(name: &str) -> (Scene, Scene) {
    let (sun, mut lamp) = (scene(name, &[]), scene(name, &[]));
    let LightKind::Directional { direction, irradiance } = sun.lights[0].kind else { panic!("{name} has no sun") };
    let object = sun.objects.iter().find(|o| sun.materials[o.material].is_specular()).expect("something specular");
    let [low, high] = object.shape.bounds().expect("it has a surface");
    let (centre, radius) = (0.5 * (low + high), 0.5 * (high - low).max_element());
    let distance = FAR * radius;
    let intensity = irradiance.map(|e| e * distance * distance);
    lamp.lights[0].kind = LightKind::Point { position: centre - distance * direction, intensity };
    (sun, lamp)
}

/// The flux between circles about the middle of the light of the first, for both.
fn annuli(scene: &Scene, layers: [Vec<f64>; 2]) -> [[f64; 2]; ANNULI] {
    let centres: Vec<DVec3> = Pixels { region: &scene.region, size: [SIDE; 2] }.centres().collect();
    let total: f64 = layers[0].iter().sum();
    let middle = centres.iter().zip(&layers[0]).map(|(p, e)| *p * *e).sum::<DVec3>() / total;
    let reach = 0.5 * scene.region.u.length().min(scene.region.v.length());
    let mut rings = [[0.0; 2]; ANNULI];
    for (k, p) in centres.iter().enumerate() {
        let ring = (((*p - middle).length() / reach * (ANNULI - 1) as f64) as usize).min(ANNULI - 1);
        rings[ring][0] += layers[0][k];
        rings[ring][1] += layers[1][k];
    }
    rings
}

#[test]
fn a_far_lamp_is_the_sun() {
    let gpu = gpu();
    for name in ["glass-sphere", "bunny"] {
        let (sun, lamp) = under_a_far_lamp(name);
        let (by_sun, by_lamp) = (of(&gpu, &sun), of(&gpu, &lamp));
        let layers = [&by_sun, &by_lamp].map(|picture| picture.mean("irradiance.caustic"));
        let total = layers[1].iter().sum::<f64>() / layers[0].iter().sum::<f64>() - 1.0;
        let off = annuli(&sun, layers).map(|[a, b]| b / a - 1.0);
        println!("{name}: total {total:+.5} of {FAR_TOTAL}, annuli {off:+.4?} of {FAR_ANNULUS}");
        assert!(total.abs() <= FAR_TOTAL, "{name}: {total}");
        assert!(worst(off) <= FAR_ANNULUS, "{name}: {off:?}");
    }
}

/// A lamp's views over all six faces of a cube, of more photons each: the object takes a part of them alone.
const SPLIT: [(&str, &str); 3] = [("light.side", "1024"), ("maps.side", "128"), ("eye.samples", "2")];
/// As in `null`: mean and 99th percentile of the pixels' errors off the shadow's edge, and the region's.
const MEAN_ERROR: f64 = 0.005;
const PERCENTILE_99: f64 = 0.02;
const REGION_ERROR: f64 = 0.001;
/// Texels of the map on each side of the shadow's edge that mix light and shadow.
const BAND: f64 = 3.0;
/// Pixels on each side of where two faces of the cube meet on the floor, and how much brighter or darker they may be
/// together than by the closed form: the photons' lattice, of some hundred pixels.
const SEAM_PIXELS: f64 = 1.5;
const SEAM_ERROR: f64 = 0.002;

fn passes_of_photons(picture: &Picture) -> usize {
    picture.renderer.stages().iter().filter(|stage| stage.starts_with("light/photons")).count()
}

/// A null sphere under a lamp of 10 W/sr.
fn null_under(position: DVec3, class: &str, more: &str) -> Scene {
    let sun = "[lights.sun.directional]\ndirection = [0.0, -1.0, 0.0]\nirradiance = 1.0";
    let DVec3 { x, y, z } = position;
    let lamp = format!("[lights.lamp.point]\nposition = [{x:?}, {y:?}, {z:?}]\nintensity = 10.0");
    let class = format!("paths = \"{class}\"");
    written(&rewritten("null", &[(sun, &lamp), ("paths = \"transmit-2\"", &class)], more), &[])
}

/// Beside, inside and among spheres that must vanish: six views make one light, and where two meet is no seam.
#[test]
fn a_light_of_six_views_has_no_seam() {
    let gpu = gpu();
    let second = "\n[objects.second]\nmaterial = \"glass\"\nsphere = { center = [-2.1, 0.0, 0.0], radius = 1.0 }\n";
    for (what, position, class, more) in [
        ("beside", DVec3::new(0.912, 0.456, 0.0), "transmit-2", ""),
        ("inside", DVec3::new(0.1, -0.5, 0.05), "transmit-1", ""),
        ("among", DVec3::new(-1.05, -0.3, 0.0), "transmit-2", second),
    ] {
        let scene = null_under(position, class, more);
        let picture = picture(&gpu, &job_of(scene.clone(), &SPLIT, "region", [SIDE; 2]));
        assert_eq!(passes_of_photons(&picture), 6, "{what}: {:?}", picture.renderer.stages());
        judge_split(what, &scene, position, &picture);
    }
}

/// Least distance of the way from the lamp to a point of the floor from any sphere's surface, as a share of the way: how
/// far, m, the point lies from a shadow's edge, about.
fn from_edge(scene: &Scene, position: DVec3, p: DVec3) -> f64 {
    let way = (p - position).normalize();
    let spheres = scene.objects.iter().filter_map(|o| match o.shape {
        Shape::Sphere { center, radius } => Some((center, radius)),
        _ => None,
    });
    let aside = spheres.map(|(center, radius)| {
        let along = (center - position).dot(way).max(0.0);
        let edge = ((center - position - along * way).length() - radius).abs();
        // What is seen near the lamp is large on the floor.
        edge * (p - position).length() / along.max(0.1)
    });
    aside.fold(f64::INFINITY, f64::min)
}

fn judge_split(what: &str, scene: &Scene, position: DVec3, picture: &Picture) {
    let pixels = Pixels { region: &scene.region, size: [SIDE; 2] };
    let pixel = 2.0 * scene.region.u.length() / f64::from(SIDE);
    let (direct, caustic) = (picture.mean("irradiance.direct"), picture.mean("irradiance.caustic"));
    let (mut errors, mut seam, mut all) = (Vec::new(), [0.0; 2], [0.0; 2]);
    for (k, p) in pixels.centres().enumerate() {
        let (ours, exact) = (direct[k] + caustic[k], direct_point(position, 10.0, p, DVec3::Y));
        all = [all[0] + ours, all[1] + exact];
        if from_edge(scene, position, p) < BAND * pixel {
            continue;
        }
        errors.push((ours / exact - 1.0).abs());
        // Faces meet where x, y, z of the way are as large, two and two.
        let way = (p - position).abs();
        let on_seam = |a: f64, b: f64| (a - b).abs() < SEAM_PIXELS * pixel && caustic[k] > 0.0;
        if on_seam(way.x, way.y) || on_seam(way.z, way.y) {
            seam = [seam[0] + ours, seam[1] + exact];
        }
    }
    let (mean, high) = (errors.iter().sum::<f64>() / errors.len() as f64, percentile(&errors, 99.0));
    let (seam, region) = (seam[0] / seam[1] - 1.0, all[0] / all[1] - 1.0);
    println!("{what}: mean {mean:.5}, 99th percentile {high:.4}, seam {seam:+.5}, region {region:+.5}");
    assert!(worst([mean]) <= MEAN_ERROR && worst([high]) <= PERCENTILE_99, "{what}: {mean} {high}");
    assert!(worst([seam]) <= SEAM_ERROR && worst([region]) <= REGION_ERROR, "{what}: seam {seam}, region {region}");
}

/// A bead behind the lamp takes no light from the floor, but no one frustum holds it beside the sphere.
const BEAD: &str = "\n[objects.bead]\nmaterial = \"glass\"\nsphere = { center = [2.8, 1.8, 0.0], radius = 0.05 }\n";

/// The same caustic by one wide view and by six. Pixels of a tenth of the brightest and less are judged against that.
#[test]
fn six_views_are_one_wide_view() {
    let gpu = gpu();
    let position = DVec3::new(1.4, 0.9, 0.0);
    let of = |more: &str| {
        let mut scene = null_under(position, "transmit-2", more);
        let glass = scene.materials.iter().position(|m| m.is_specular()).expect("glass");
        scene.materials[glass].kind = MaterialKind::Dielectric { ior: [1.5; 3], absorption: [0.0; 3] };
        picture(&gpu, &job_of(scene, &SPLIT, "region", [SIDE; 2]))
    };
    let (one, six) = (of(""), of(BEAD));
    assert_eq!((passes_of_photons(&one), passes_of_photons(&six)), (1, 6));
    let (one, six) = (one.mean("irradiance.caustic"), six.mean("irradiance.caustic"));
    let dark = 0.1 * one.iter().copied().fold(0.0, f64::max);
    let errors: Vec<f64> = one.iter().zip(&six).map(|(a, b)| (a - b).abs() / (a + dark)).collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let (high, total) = (percentile(&errors, 99.0), six.iter().sum::<f64>() / one.iter().sum::<f64>() - 1.0);
    println!("six views for one: mean {mean:.5}, 99th percentile {high:.4}, total {total:+.5}");
    assert!(worst([mean]) <= MEAN_ERROR && worst([high]) <= PERCENTILE_99, "{mean} {high}");
    assert!(worst([total]) <= REGION_ERROR, "{total}");
}
