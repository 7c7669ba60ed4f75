//! `waves.variant=inverse` against references, closed forms and the caustic map, where its equations end, and what stands in
//! the way of light.

use glam::DVec2;
use nephroid::{
    gpu::Gpu,
    image::Layers,
    methods,
    renderer::{Frame, Job, Providers, Renderer, Unresolved, plan},
    truth::closed,
};

use crate::{
    PAPER,
    common::{
        Probe, gpu, job,
        picture::{Picture, Pixels, job_of, picture, worst, written},
        random::Random,
    },
};

pub const INVERSE: (&str, &str) = ("waves.variant", "inverse");

pub fn inverse(scene: &str, set: &[(&str, &str)], camera: &str, size: [u32; 2]) -> Job {
    let set = [&[INVERSE, ("eye.samples", "1")], set].concat();
    let providers = Providers::of(methods::find("waves").expect("waves is a method"));
    Job { providers, ..job(scene, &set, camera, size) }
}

pub fn light(gpu: &Gpu, job: &Job) -> Vec<f64> {
    picture(gpu, job).mean("irradiance.caustic")
}

/// The judged figure, E₀ being the sun's irradiance of a horizontal floor, W/m²; and the ratio of energies.
pub fn judged(light: &[f64], reference: &[f64], e0: f64) -> [f64; 2] {
    let one = |(x, r): (&f64, &f64)| (x - r).powi(2) / (r * r + (0.1 * e0).powi(2));
    let relmse = light.iter().zip(reference).map(one).sum::<f64>() / light.len() as f64;
    [relmse, light.iter().sum::<f64>() / reference.iter().sum::<f64>()]
}

/// What is asked of a picture; `bound` is three times what was measured.
#[track_caller]
fn assert_right(what: &str, [relmse, energy]: [f64; 2], bound: f64) {
    println!("{what}: relmse {relmse:.2e} of {bound:.1e}, energy {energy:.6}");
    assert!(relmse <= bound, "{what}: relmse {relmse:e}");
    assert!((energy - 1.0).abs() <= 0.005, "{what}: energy {energy}");
}

#[test]
fn it_is_the_truth() {
    let gpu = gpu();
    // Measured 4e-15, 5.0e-6 (3e-7 of it the reference's) and 3.3e-7.
    for (scene, cosine, bound) in [("flat-water", 1.0, 1e-12), ("sine-water", 1.0, 1.5e-5), ("water", 0.94, 1e-6)] {
        let bytes = std::fs::read(format!("tests/references/{scene}.exr")).expect("a reference");
        let (layers, _) = Layers::from_exr(&bytes).expect("an EXR file");
        let bands = layers.get("irradiance.caustic").expect("a caustic").data().chunks_exact(3);
        let reference: Vec<f64> = bands.map(|b| b.iter().map(|v| f64::from(*v)).sum::<f64>() / 3.0).collect();
        let light = light(&gpu, &inverse(scene, &[], "region", [128, 128]));
        assert_right(scene, judged(&light, &reference, cosine), bound);
    }
}

/// Area of a triangle in the unit disc, in float64: slices of it, the midpoint rule.
fn area_in_disc(t: [DVec2; 3]) -> f64 {
    const SLICES: u32 = 4000;
    let [low, high] = [t[0].min(t[1]).min(t[2]), t[0].max(t[1]).max(t[2])].map(|p| p.y.clamp(-1.0, 1.0));
    let step = (high - low) / f64::from(SLICES);
    let width = |k: u32| {
        let y = low + step * (f64::from(k) + 0.5);
        let half = (1.0 - y * y).max(0.0).sqrt();
        let crossed = |k: usize| {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            ((a.y < y) != (b.y < y)).then(|| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
        };
        let xs = || (0..3).filter_map(crossed).map(|x| x.clamp(-half, half));
        xs().fold(f64::NEG_INFINITY, f64::max) - xs().fold(f64::INFINITY, f64::min)
    };
    (0..SLICES).map(width).filter(|w| w.is_finite()).sum::<f64>() * step
}

#[test]
fn shares_of_triangles_in_a_disc_are_exact() {
    let probe = Probe {
        includes: &["waves/disc_share.glsl"],
        input: "vec2 a; vec2 b; vec2 c;",
        output: "float share; uint thin;",
        body: "Flat t = triangle_of(q.a, q.b, q.c); r.share = share_in_disc(t); r.thin = uint(is_thin(t));",
        ..Default::default()
    };
    let mut random = Random(5);
    let mut place = |size: f32| [0, 1].map(|_| size * (random.within(-1.0, 1.0) as f32));
    let mut triangles: Vec<[[f32; 2]; 3]> = Vec::new();
    for k in 0..3000 {
        let (size, at) = ([0.1, 1.0, 10.0, 100.0][k % 4], place(1.2));
        triangles.push([0; 3].map(|_| place(size)).map(|p| [p[0] + at[0], p[1] + at[1]]));
    }
    triangles.push([[0.0; 2]; 3]);
    triangles.push([[-4.0, -4.0], [4.0, -4.0], [0.0, 8.0]]);
    let shares: Vec<(f32, u32)> =
        probe.run::<_, [u32; 2]>(&gpu(), &triangles).into_iter().map(|[s, t]| (f32::from_bits(s), t)).collect();
    let [mut fat, mut thin] = [0.0_f64; 2];
    for (t, (share, is_thin)) in triangles.iter().zip(shares) {
        assert!((0.0..=1.0).contains(&share), "{t:?}: {share}");
        let t = t.map(|p| DVec2::from(p.map(f64::from)));
        let whole = 0.5 * (t[1] - t[0]).perp_dot(t[2] - t[0]).abs();
        let error = (f64::from(share) * whole - area_in_disc(t)).abs() / whole.min(1.0);
        match is_thin {
            0 => fat = fat.max(error),
            _ if whole > 0.0 => thin = thin.max(error * whole.min(1.0)),
            _ => {}
        }
    }
    println!("fat {fat:.1e}, thin {thin:.1e}");
    // Slices and float32; a thin one is displaced by up to 1/64, over the disc's width.
    assert!(fat < 2e-3 && thin < 2.0 / 64.0, "{fat:e} {thin:e}");
}

#[test]
fn more_cells_converge_at_second_order_on_what_is_smooth() {
    let region = inverse("sine-water", &[], "region", [64, 64]).scene.region.clone();
    let water = closed::SineWater::new(0.02, std::f64::consts::TAU / 0.5, 0.8, 1.33).expect("a wave over its floor");
    let pixels = Pixels { region: &region, size: [64, 64] };
    let column = |x: u32| {
        let [from, to] = [x, x + 1].map(|x| pixels.at(f64::from(x), 0.0).x);
        water.flux(from, to) / (to - from)
    };
    let exact: Vec<f64> = (0..64 * 64).map(|k| column(k % 64)).collect();
    let gpu = gpu();
    let errors = ["64", "128", "256"].map(|cells| {
        let light = light(&gpu, &inverse("sine-water", &[("waves.cells", cells)], "region", [64, 64]));
        judged(&light, &exact, 1.0)[0].sqrt()
    });
    println!("errors {errors:.5?}");
    // At folds linear rays miss by less than that: orders of 1.7 to 2.1 are seen.
    assert!(errors.windows(2).all(|pair| pair[0] > 3.0 * pair[1]) && errors[2] < 2e-3, "{errors:?}");
}

/// The error of a map of 256² texels from 256² cells, at 30° and at 60°: measured 8.7e-4 and 2.6e-3, a third of it at twice as many.
const MAP: f64 = 8e-3;

/// Other light, other code: the map's cells, whose own error is most of this.
#[test]
fn it_agrees_with_the_caustic_map_under_a_slanting_sun() {
    let gpu = gpu();
    for (direction, cosine) in [("[0.5, -0.866, 0.0]", 0.866), ("[0.612, -0.5, 0.612]", 0.5)] {
        let sun = ("scene.lights.sun.direction", direction);
        let light = light(&gpu, &inverse("water", &[sun], "region", [64, 64]));
        let maps = job_of(
            inverse("water", &[sun], "region", [1, 1]).scene.as_ref().clone(),
            &[("maps.splat", "cells"), ("light.side", "256"), ("maps.side", "256"), ("eye.samples", "4")],
            "region",
            [64, 64],
        );
        let maps = picture(&gpu, &maps).mean("irradiance.caustic");
        assert_right(direction, judged(&light, &maps, cosine), MAP);
    }
}

/// A block in the water under a sun at 45°: its top is lit at its own depth, its shadow lies where Snell's law says.
#[test]
fn what_stands_in_the_water_is_lit_and_shadows() {
    let block = "[objects.block]\nmaterial = \"white\"\n[objects.block.box]\ncenter = [-0.2, -0.5, 0]\nhalf = [0.2, 0.1, 0.3]\n";
    let text = nephroid::scene::Scene::load("flat-water", &[]).unwrap().source.text;
    let text = text
        .replace("absorption = 0.0", "absorption = 0.5")
        .replace("[0.0, -1.0, 0.0]\nirradiance", "[1.0, -1.0, 0.0]\nirradiance");
    let scene = written(&format!("{text}\n{block}"), &[]);
    let providers = Providers::of(methods::find("waves").expect("waves is a method"));
    let job = Job { providers, ..job_of(scene, &[INVERSE, ("eye.samples", "1")], "region", [80, 80]) };
    let pixels = Pixels { region: &job.scene.region, size: job.size };
    let light = light(&gpu(), &job);
    let slope = (0.5_f64.sqrt() / 1.33).asin().tan();
    let of = |depth: f64| closed::flat_water(1.33, 0.5_f64.sqrt(), depth, 0.5, 1.0);
    let [mut on_top, mut dark, mut lit] = [0; 3];
    for (p, e) in pixels.centres().zip(&light) {
        // From the floor towards the sun: heights 0.4 to 0.6 above it are the block's.
        let back = |height: f64| p.x - slope * height;
        let margin = 1.5 * 2.0 / 80.0;
        let (beside, across) = ((p.x + 0.2).abs() - 0.2, p.z.abs() - 0.3);
        let (near, far) = (back(0.6).max(-0.4), back(0.4).min(0.0));
        let edge = [beside, across, far - near].iter().any(|d| d.abs() < margin);
        let expected = match () {
            () if edge => continue,
            () if beside < 0.0 && across < 0.0 => (of(0.4), &mut on_top),
            () if across < 0.0 && near < far => (0.0, &mut dark),
            () => (of(1.0), &mut lit),
        };
        *expected.1 += 1;
        assert!((e - expected.0).abs() < 1e-4, "{e} for {} at {p}", expected.0);
    }
    assert!(on_top > 50 && dark > 20 && lit > 1000, "{on_top} {dark} {lit}");
}

#[test]
fn it_has_an_answer_everywhere() {
    let gpu = gpu();
    const FLOOR: &str = "scene.objects.floor.quad.center";
    const SUN: &str = "scene.lights.sun.directional.direction";
    const GRID: (&str, &str) = ("scene.objects.water.wave.grid", "64");
    let cases: [(&str, &[(&str, &str)]); 8] = [
        ("the origin, where the wave is a cone's tip", &[("scene.objects.water.wave.middle", "[0, 0]")]),
        ("a depth of nothing", &[("scene.objects.water.wave.vertex_size", "1e-6"), (FLOOR, "[0, 0, 0]")]),
        ("a depth of 10^4 m", &[(FLOOR, "[0, -1e4, 0]"), ("scene.materials.water.dielectric.absorption", "0")]),
        ("a floor above the troughs", &[(FLOOR, "[0, 0, 0]")]),
        ("slopes past total reflection", &[("scene.objects.water.wave.vertex_size", "0.1")]),
        ("an octave finer than cells", &[("scene.objects.water.wave.octaves", "16")]),
        ("the sun at 89.9 degrees", &[(SUN, "[1, -0.001745, 0]"), (FLOOR, "[0, -0.2, 0]")]),
        ("10^6 s later", &[("scene.objects.water.wave.time", "1e6")]),
    ];
    for (case, set) in &cases {
        let set = [*set, &[GRID, ("waves.cells", "64")]].concat();
        let light = light(&gpu, &inverse(PAPER, &set, "region", [15, 15]));
        assert!(light.iter().any(|x| *x > 0.0), "{case}");
    }
    let calm = [("scene.objects.water.sea.factor", "0"), ("scene.lights.sun.direction", "[0, -1, 0]")];
    let calm =
        [&calm[..], &[("scene.materials.water.absorption", "0"), ("scene.objects.water.sea.grid", "32")]].concat();
    let light = light(&gpu, &inverse("scenes/papers/sea.toml", &calm, "region", [15, 15]));
    // Float32 roundings, and a disc of 0.53° that Fresnel's equations take for its middle.
    assert!(worst(light.iter().map(|x| x - 0.979_941)) < 1e-4, "{light:?}");
}

fn unresolved(gpu: &Gpu, job: &Job) -> Unresolved {
    let mut renderer = Renderer::new(gpu, job).expect("a renderer");
    renderer.frame(&Frame::default()).expect("a frame");
    renderer.unresolved().expect("counted").expect("inverse says what it leaves out")
}

/// Under a sun at 89.9° about half of the wave faces away; between the halves the sun grazes. Straight above nothing is left out.
#[test]
fn what_it_leaves_out_is_counted() {
    let gpu = gpu();
    // One octave, that its waves are wider than cells.
    let small =
        [("scene.objects.water.wave.grid", "64"), ("waves.cells", "64"), ("scene.objects.water.wave.octaves", "1")];
    let of = |sun: &'static str| {
        let set = [&small[..], &[("scene.lights.sun.directional.direction", sun)]].concat();
        unresolved(&gpu, &inverse(PAPER, &set, "region", [15, 15]))
    };
    let low = of("[1, -0.001745, 0]");
    let (dark, grazed) = (low.dark as f64 / low.pieces as f64, low.grazed as f64 / low.pieces as f64);
    println!("{low:?}");
    assert!(low.pieces == 2 * 64 * 64 && (0.2..0.8).contains(&dark) && (0.005..0.2).contains(&grazed), "{low:?}");
    assert_eq!(low.cut_pixels, 0);
    let high = of("[0, -1, 0]");
    assert_eq!([high.dark, high.grazed, high.cut_pixels], [0; 3]);
    let other = Job {
        settings: inverse(PAPER, &[("waves.variant", "pixel")], "region", [8, 8]).settings,
        ..inverse(PAPER, &small, "region", [8, 8])
    };
    assert_eq!(Renderer::new(&gpu, &other).expect("a renderer").unresolved().expect("counts nothing"), None);
}

/// Of a pixel that goes on for too long, as llvmpipe has it, light is lost, and the pixel is counted; where none is, none is.
#[test]
fn pixels_whose_search_the_device_ends_are_counted() {
    let gpu = gpu();
    let of = |samples: &'static str| {
        let job = inverse(PAPER, &[("eye.samples", samples)], "region", [6, 6]);
        (light(&gpu, &job).iter().sum::<f64>(), unresolved(&gpu, &job).cut_pixels)
    };
    let ((whole, none), (many, cut)) = (of("1"), of("8"));
    println!("{cut} pixels of 36 were cut; light {many} of {whole}");
    assert_eq!(none, 0);
    // Without a cut, samples move light between pixels alone.
    assert_eq!(cut > 0, many < 0.99 * whole, "{cut} pixels, {many} of {whole}");
}

/// As well of what is seen through the water, where a pixel's samples go through one loop more.
#[test]
fn pixels_whose_search_through_water_the_device_ends_are_counted() {
    let gpu = gpu();
    let of = |samples: &'static str, size: u32| {
        let job = inverse(PAPER, &[("eye.samples", samples)], "main", [size; 2]);
        let picture = picture(&gpu, &job);
        (picture.sum("caustic"), unresolved(&gpu, &job).cut_pixels)
    };
    // The same samples across the picture.
    let ((whole, none), (many, cut)) = (of("1", 24), of("4", 6));
    println!("{cut} pixels of 36 were cut; light {many} of {whole}");
    assert_eq!(none, 0);
    assert_eq!(cut > 0, many < 0.95 * whole, "{cut} pixels, {many} of {whole}");
}

#[test]
fn an_eye_in_the_water_sees_the_same_twice() {
    let place = ("scene.cameras.main.pinhole.position", "[0, -0.2, 0.1]");
    let job = inverse(PAPER, &[place, ("scene.objects.water.wave.grid", "64")], "main", [24, 24]);
    let [once, twice]: [Picture; 2] = [0, 1].map(|_| picture(&gpu(), &job));
    assert!(once.sum("irradiance.caustic") > 0.0);
    assert_eq!(once.layers, twice.layers);
}

#[test]
fn what_is_too_much_is_refused_and_what_shows_nothing_is_left_out() {
    let error = plan(&inverse("flat-water", &[("waves.cells", "4096")], "region", [8, 8])).map(|_| ()).unwrap_err();
    assert!(error.to_string().contains("lower waves.cells"), "{error}");
    let dry = plan(&inverse("glass-sphere", &[], "region", [8, 8])).unwrap().plan;
    assert!(dry.left_out.iter().any(|left| left.reason.contains("no water")), "{:?}", dry.left_out);
    let alone = plan(&inverse("flat-water", &[], "region", [8, 8])).unwrap().plan;
    let defined = |name: &str| alone.passes.iter().flat_map(|p| &p.defines).any(|(define, _)| define == name);
    assert!(!["SHADED", "BLOCKED", "DISCS", "INVERSE_BANDS"].into_iter().any(defined), "what it lacks is not compiled");
}
