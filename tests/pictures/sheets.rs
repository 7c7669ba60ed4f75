//! Sheets, heights over a rectangle: how far their triangles are from the surface that they stand for, and what is below them.

use crate::common::{
    gpu,
    picture::{job_of, picture, rewritten, worst, written},
};
use glam::{DVec2, DVec3};
use nephroid::{
    image::{Layers, Provenance},
    scene::{Scene, Shape, Wave},
    truth::trace::{Ray, Space, mask},
};
use std::{f64::consts::TAU, path::PathBuf};

const SINE: &str = "[objects.water.sine]\ncenter = [0.0, 0.0, 0.0]\nu = [1.0, 0.0, 0.0]      # half edges, at right angles; \
                    the crests stand towards u × v\nv = [0.0, 0.0, -1.0]\namplitude = 0.02\nwavelength = 0.5\n";
/// Of `sine-water`, m.
const AMPLITUDE: f64 = 0.02;
const WAVELENGTH: f64 = 0.5;

/// A scene with files beside it.
fn beside(text: &str, files: &[(&str, Vec<u8>)]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| -> PathBuf {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    files.iter().for_each(|(name, bytes)| drop(write(name, bytes)));
    let file = write("scene.toml", text.as_bytes());
    Scene::load(file.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// `sine-water` under another sheet of water.
fn under(sheet: &str, files: &[(&str, Vec<u8>)]) -> Scene {
    beside(&rewritten("sine-water", &[(SINE, sheet)], ""), files)
}

/// An EXR of one channel, from a height at each place of [−1, 1]², +1 on top.
fn exr(pixels: usize, height: impl Fn(DVec2) -> f64) -> Vec<u8> {
    let at = |k: usize| 2.0 * k as f64 / (pixels - 1) as f64 - 1.0;
    let samples = (0..pixels * pixels).map(|k| height(DVec2::new(at(k % pixels), -at(k / pixels))) as f32).collect();
    let mut layers = Layers::new(pixels, pixels);
    layers.push("height", 1, samples).unwrap();
    layers.to_exr(&Provenance::new()).unwrap()
}

/// The sine of `sine-water` as heights, one cell between two pixels.
fn sampled_sine(cells: usize) -> Scene {
    let sheet =
        "[objects.water.heights]\nfile = \"h.exr\"\ncenter = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\nheight = 0.02\n";
    under(sheet, &[("h.exr", exr(cells + 1, |at| (TAU / WAVELENGTH * at.x).sin()))])
}

fn waves(cells: usize) -> Scene {
    let sheet = "[objects.water.wave]\ncenter = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\ntime = 0.7\n";
    under(&format!("{sheet}grid = {cells}\n"), &[])
}

/// Rays straight down from above, at places that no grid has: where each is, and what it meets.
fn down(scene: &Scene) -> Vec<(DVec2, nephroid::truth::trace::Surface)> {
    let space = Space::new(scene);
    let places =
        (0..20_000).map(|k| DVec2::new(0.754_877_666 * k as f64, 0.569_840_291 * k as f64).fract() * 2.0 - 1.0);
    let found = |at: DVec2| {
        let ray = Ray { o: DVec3::new(at.x, 1.0, -at.y), d: DVec3::NEG_Y, left: None };
        (at, space.nearest(&ray, mask::SPECULAR).expect("water"))
    };
    places.map(found).collect()
}

/// Root mean square and worst of height (m) and normal (rad) against the surface.
fn errors(scene: &Scene, surface: impl Fn(DVec2) -> (f64, DVec3)) -> [[f64; 2]; 2] {
    let off = down(scene).into_iter().map(|(at, met)| {
        let (height, normal) = surface(at);
        // The sheet's v is −z.
        let normal = DVec3::new(normal.x, normal.z, -normal.y);
        [(met.p.y - height).abs(), met.ns.cross(normal).length().atan2(met.ns.dot(normal))]
    });
    let all: Vec<[f64; 2]> = off.collect();
    [0, 1].map(|k| {
        let squares = all.iter().map(|e| e[k] * e[k]).sum::<f64>() / all.len() as f64;
        [squares.sqrt(), all.iter().fold(0.0, |most: f64, e| most.max(e[k]))]
    })
}

/// By how much halving the cells lessens a root mean square: the square, 4; measured 3.9 to 4.0.
const SECOND_ORDER: std::ops::RangeInclusive<f64> = 3.2..=4.4;

/// Of the finer of two grids: root mean squares of height, a share of the edge, and normal, rad, a quarter above what was
/// measured.
#[track_caller]
fn judge(what: &str, cells: [usize; 2], scenes: [Scene; 2], surface: impl Fn(DVec2) -> (f64, DVec3), most: [f64; 2]) {
    let [coarse, fine] = scenes.map(|scene| errors(&scene, &surface));
    for (cells, errors) in cells.into_iter().zip([coarse, fine]) {
        let [[height, highest], [normal, widest]] = errors;
        println!(
            "{what}, {cells} cells: height {height:.2e} m, worst {highest:.2e}; normal {normal:.2e} rad, worst {widest:.2e}"
        );
    }
    for k in [0, 1] {
        let gain = coarse[k][0] / fine[k][0];
        assert!(SECOND_ORDER.contains(&gain), "{what}: halving the cells gains {gain}");
        assert!(fine[k][0] <= 1.25 * most[k], "{what}: {} where {} was measured", fine[k][0], most[k]);
    }
}

#[test]
fn a_wave_is_its_function_to_the_square_of_its_cells() {
    let surface = |at: DVec2| {
        let at = 0.5 + 0.5 * at;
        (2.0 * Wave::PAPER.height(at, 0.7), Wave::PAPER.normal(at, 0.7))
    };
    judge("wave", [256, 512], [waves(256), waves(512)], surface, [2.2e-5, 1.6e-3]);
}

#[test]
fn heights_of_a_sine_are_the_sine_to_the_square_of_its_cells() {
    let surface = |at: DVec2| {
        let (sin, cos) = (TAU / WAVELENGTH * at.x).sin_cos();
        (AMPLITUDE * sin, DVec3::new(-AMPLITUDE * TAU / WAVELENGTH * cos, 0.0, 1.0).normalize())
    };
    judge("sine", [64, 128], [sampled_sine(64), sampled_sine(128)], surface, [5.0e-5, 1.7e-3]);
}

/// A picture's own row order: white above on the left, everything else black.
#[test]
fn the_upper_left_pixel_is_at_minus_u_plus_v() {
    let mut colours = vec![[0; 3]; 9];
    colours[0] = [255; 3];
    let grey = grey_png(3, &colours);
    let sheet = "[objects.water.heights]\nfile = \"h.png\"\ncenter = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\nheight = 0.5\nbase = 0.1\n";
    let scene = under(sheet, &[("h.png", grey)]);
    let Shape::Mesh { mesh, to_world } = &scene.objects.iter().find(|o| o.name == "water").unwrap().shape else {
        panic!("no mesh")
    };
    let highest =
        mesh.positions.iter().map(|p| to_world.transform_point3(p.as_dvec3())).max_by(|a, b| a.y.total_cmp(&b.y));
    // Heights are kept in single precision.
    assert!((highest.unwrap() - DVec3::new(-1.0, 0.6, -1.0)).length() < 1e-6, "{highest:?}");
    assert_eq!(mesh.triangles.len(), 8);
}

/// One channel of 8 bits, of the first of three.
fn grey_png(side: usize, colours: &[[u8; 3]]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, side as u32, side as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&colours.iter().map(|c| c[0]).collect::<Vec<_>>()).unwrap();
    writer.finish().unwrap();
    bytes
}

/// m, farther than any triangle of 128 cells is from its surface: the wave at 256 measured 9·10⁻⁴, which is a fourth of it.
const OFF: f64 = 4e-3;

/// Points about the sheet: both answers, the scene's and the truth's, are water below the surface and within the outline.
#[test]
fn what_is_below_a_sheet_and_within_its_sides_is_in_its_water() {
    let wave = |at: DVec2| 2.0 * Wave::PAPER.height(0.5 + 0.5 * at, 0.7);
    let sine = |at: DVec2| AMPLITUDE * (TAU / WAVELENGTH * at.x).sin();
    let cases: [(Scene, &dyn Fn(DVec2) -> f64); 2] = [(waves(128), &wave), (sampled_sine(128), &sine)];
    for (scene, height) in cases {
        let space = Space::new(&scene);
        let water = scene.materials.iter().position(|m| m.name == "water");
        let mut inside = 0;
        for k in 0..4000 {
            let turn = |factor: f64| (f64::from(k) * factor).sin();
            let p = DVec3::new(1.2 * turn(1.3), 0.2 * turn(2.1), 1.2 * turn(3.7));
            let at = DVec2::new(p.x, -p.z);
            let depth = height(at.clamp(DVec2::NEG_ONE, DVec2::ONE)) - p.y;
            if depth.abs() < OFF {
                continue;
            }
            let expected = (depth > 0.0 && at.abs().max_element() <= 1.0).then_some(water).flatten();
            assert_eq!(scene.medium_at(p), expected, "{p}");
            assert_eq!(space.media(p).innermost(), expected, "{p}, in the truth");
            inside += usize::from(expected.is_some());
        }
        assert!((500..2500).contains(&inside), "{inside}");
        for p in [DVec3::NAN, DVec3::NEG_INFINITY, DVec3::Y * 1e300] {
            assert_eq!(scene.medium_at(p), None, "{p}");
        }
        assert_eq!(scene.medium_at(DVec3::new(1.0, -1e6, -1.0)), water, "however deep, to the very corner");
    }
}

/// Root mean square by which a picture through 256 cells a side differs from one through the sine itself, over the mean of the
/// latter; measured up to 3·10⁻³. From below, where the picture is of reflections alone, 1.5·10⁻²: the border of total
/// reflection moves with the normals.
const PICTURED: [(&str, &str, f64); 4] = [
    ("main", "radiance", 0.005),
    ("region", "irradiance.caustic", 0.005),
    ("below", "radiance", 0.02),
    ("down", "radiance", 0.005),
];
/// Flux in a bucket of the account, a share of all that was emitted: measured up to 6·10⁻⁵.
const COUNTED: f64 = 2e-4;

/// An eye above and an eye below, a sun above and a lamp below: through triangles as through the sine that they stand for.
#[test]
fn pictures_through_heights_of_a_sine_are_those_through_the_sine() {
    let gpu = gpu();
    let tint = ("absorption = 0.0", "absorption = [2.0, 0.5, 0.1]");
    let lamp = "\n[lights.lamp.point]\nposition = [0.2, -0.3, 0.1]\nintensity = 1.0\n\
                [cameras.below.pinhole]\nposition = [0.1, -0.4, 0.2]\ntarget = [0.0, 0.1, -0.2]\nfov_y = 60\n\
                [cameras.down.pinhole]\nposition = [0.1, -0.4, 0.2]\ntarget = [0.0, -0.8, -0.2]\nfov_y = 60\n";
    let exact = written(&rewritten("sine-water", &[tint], lamp), &[]);
    let sheet =
        "[objects.water.heights]\nfile = \"h.exr\"\ncenter = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\nheight = 0.02\n";
    let text = rewritten("sine-water", &[tint, (SINE, sheet)], lamp);
    let sampled = beside(&text, &[("h.exr", exr(257, |at| (TAU / WAVELENGTH * at.x).sin()))]);
    let set = [("light.side", "256"), ("maps.side", "128"), ("eye.samples", "2")];
    for (camera, layer, most) in PICTURED {
        let [a, b] = [&exact, &sampled].map(|scene| picture(&gpu, &job_of(scene.clone(), &set, camera, [96, 96])));
        let (a, b) = (a.mean(layer), b.mean(layer));
        let mean = a.iter().sum::<f64>() / a.len() as f64;
        let squares = a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64;
        println!("{camera}: {:.2e} of the mean {mean:.4}", squares.sqrt() / mean);
        assert!(mean > 0.0 && worst([squares.sqrt() / mean]) <= most, "{camera}");
    }
    for light in ["lamp", "sun"] {
        let [a, b] = [&exact, &sampled].map(|scene| {
            let mut scene = scene.clone();
            scene.lights.retain(|l| l.name == light);
            picture(&gpu, &job_of(scene, &set, "region", [16, 16])).account
        });
        let emitted = a.flux_w[0];
        for (a, b) in a.flux_w.iter().zip(b.flux_w) {
            println!("{light}: {a:.6} W and {b:.6} W, {:.1e} of what was emitted", (a - b).abs() / emitted);
            assert!((a - b).abs() <= COUNTED * emitted, "{light}: {a} W and {b} W");
        }
    }
}

/// One pixel, or two of one height, are a flat sheet: water as a quad makes it.
#[test]
fn a_picture_of_one_height_is_flat_water() {
    let gpu = gpu();
    let sheet = |file: &str| {
        format!(
            "[objects.water.heights]\nfile = \"{file}\"\ncenter = [0, -0.1, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\nheight = 0.1\n"
        )
    };
    let quad = under("[objects.water.quad]\ncenter = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\n", &[]);
    let set = [("light.side", "128"), ("maps.side", "64")];
    let map = |scene: Scene| picture(&gpu, &job_of(scene, &set, "region", [32, 32])).mean("irradiance.caustic");
    let expected = map(quad);
    for (side, file) in [(1, "h.png"), (2, "h.png")] {
        let scene = under(&sheet(file), &[(file, grey_png(side, &vec![[255; 3]; side * side]))]);
        // Two triangles round otherwise than a quad.
        let error = worst(map(scene).iter().zip(&expected).map(|(a, b)| a / b - 1.0));
        println!("{side}²: {error:.1e}");
        assert!(error <= 1e-5, "{side}²: {error}");
    }
}
