//! The sky: every direction of both kinds, and what flat water, spheres and cameras make of it.

use crate::common::{
    Binder, Probe, gpu,
    picture::{Picture, job_of, picture, scene, worst},
    random::Random,
};
use glam::DVec3;
use nephroid::{
    gpu::{Gpu, Plan},
    image::{Layers, Provenance as About},
    optics::{fresnel, refract},
    passes::{accel::SceneArrays, extents, eye, scene::SceneBuffers, sky::SkyBuffers},
    renderer::{Job, Providers},
    scene::{CameraKind, Scene, Sky},
};

const SIZE: [u32; 2] = [32, 32];
/// Of a few products and sums in float32, an arctangent of lavapipe's among them.
const FLOAT32: f64 = 5e-6;
/// Beside the critical angle, where T falls as a root of the distance from it: measured 1.2e-5.
const FRESNEL: f64 = 3e-5;
/// How near to the critical angle's sine float32 may take one side for the other, and T loses its digits.
const CRITICAL: f64 = 1e-3;

/// A wide sheet of water over a black floor, which is all that can be seen below it, under a sky.
const WATER: &str = r#"
version = 1
title = "Water under a sky"
paths = "transmit-1"
region = { receiver = "floor", center = [0, 0], half = [1, 1] }
[cameras.main.pinhole]
position = [0, 1, 0]
target = [0, 0.5, -1]
fov_y = 120
[objects.water]
material = "water"
quad = { center = [0, 0, 0], u = [1e4, 0, 0], v = [0, 0, -1e4] }
[objects.floor]
material = "black"
quad = { center = [0, -10, 0], u = [1e5, 0, 0], v = [0, 0, -1e5] }
[materials.water.dielectric]
ior = 1.33
[materials.black.diffuse]
albedo = 0
"#;
const EVEN: &str = "[sky.gradient]\nzenith = [1, 2, 4]\nhorizon = [1, 2, 4]\n";
const L: [f64; 3] = [1.0, 2.0, 4.0];
/// Nothing of it is like another.
const UNEVEN: &str =
    "[sky.gradient]\nzenith = [0.1, 0.4, 1.6]\nhorizon = [2, 1.5, 1]\nground = [0.3, 0.2, 0.05]\nup = [0.2, 1, 0.1]\n";

fn loaded(text: &str, image: Option<Vec<u8>>, set: &[(&str, &str)]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    std::fs::write(folder.path().join("sky.exr"), image.unwrap_or_default()).unwrap();
    let set: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let path = folder.path().join("scene.toml");
    Scene::load(path.to_str().unwrap(), &set).unwrap_or_else(|error| panic!("{error}"))
}

/// No method: what the eye alone makes.
fn seen(gpu: &Gpu, scene: &Scene, set: &[(&str, &str)], camera: &str) -> Picture {
    picture(gpu, &Job { providers: Providers::default(), ..job_of(scene.clone(), set, camera, SIZE) })
}

/// Unit directions of the pixels' middles.
fn directions(scene: &Scene, camera: &str) -> Vec<DVec3> {
    let view = eye::view(&scene.cameras[camera], SIZE, &extents::everything(scene));
    let at = |k: u32| glam::DVec2::new(f64::from(k % SIZE[0]) + 0.5, f64::from(k / SIZE[0]) + 0.5);
    (0..SIZE[0] * SIZE[1]).map(|k| view.ray(at(k) / f64::from(SIZE[0])).1.normalize()).collect()
}

/// Pixels of the layer, and the largest error relative to what is expected of them, or to 1 where that is less.
fn off(picture: &Picture, expected: &[Option<[f64; 3]>]) -> f64 {
    let pixels = picture.layer("sky").chunks_exact(3).zip(expected);
    worst(pixels.flat_map(|(pixel, expected)| {
        let error = |k: usize| expected.map_or(0.0, |e| (f64::from(pixel[k]) - e[k]) / e[k].max(1.0));
        [0, 1, 2].map(error)
    }))
}

#[test]
fn water_from_above_mirrors_by_fresnel_and_from_below_has_its_window() {
    let gpu = gpu();
    let text = WATER.to_owned() + EVEN;
    let above = loaded(&text, None, &[]);
    let mut angles = [0; 2];
    let expected: Vec<_> = directions(&above, "main")
        .iter()
        .map(|d| {
            angles[usize::from(d.y < 0.0)] += 1;
            // What goes into the water ends on the black floor.
            let share = if d.y < 0.0 { fresnel(-d.y, 1.0, 1.33) } else { 1.0 };
            // The horizon itself is the sheet's end, 10 km away.
            (d.y.abs() > 1e-3).then(|| L.map(|l| l * share))
        })
        .collect();
    let from_above = off(&seen(&gpu, &above, &[], "main"), &expected);
    assert!(angles.iter().all(|count| *count > 300), "{angles:?}");

    let below =
        loaded(&text, None, &[("cameras.main.position", "[0, -1, 0]"), ("cameras.main.target", "[0, 0, -0.6]")]);
    let mut kinds = [0; 3]; // in the window, beyond it, down
    let expected: Vec<_> = directions(&below, "main")
        .iter()
        .map(|d| {
            let sine = 1.33 * (1.0 - d.y * d.y).sqrt();
            let out = if d.y > 0.0 { refract(*d, DVec3::NEG_Y, 1.33) } else { None };
            kinds[if out.is_some() { 0 } else { 1 + usize::from(d.y <= 0.0) }] += 1;
            let share = out.map_or(0.0, |_| (1.0 - fresnel(d.y, 1.33, 1.0)) * 1.33 * 1.33);
            ((sine - 1.0).abs() > CRITICAL).then(|| L.map(|l| l * share))
        })
        .collect();
    let from_below = off(&seen(&gpu, &below, &[], "main"), &expected);
    println!("from above {from_above:.1e} {angles:?}, from below {from_below:.1e} {kinds:?}");
    assert!(kinds[0] > 200 && kinds[1] > 200, "{kinds:?}");
    assert!(from_above <= FLOAT32 && from_below <= FRESNEL, "{from_above:e} {from_below:e}");
}

/// A glass sphere, a sheet and a mirror over a small floor far below, the sky all round.
const THINGS: &str = r#"
version = 1
title = "Things in the air"
paths = "transmit-2"
region = { receiver = "floor", center = [0, 0], half = [1, 1] }
[cameras.main.pinhole]
position = [0, 1, 5]
target = [0, 0, 0]
fov_y = 60
[cameras.bare.pinhole]
position = [0, 1, 5]
target = [0, 0, 0]
fov_y = 60
hides_specular = true
[cameras.level.orthographic]
position = [0, 0, 5]
target = [0, 1, 0]
height = 0.5
[objects.ball]
material = "glass"
sphere = { center = [-1, 0.5, 0], radius = 1 }
[objects.sheet]
material = "glass"
quad = { center = [1, 0, 0], u = [1, 0, 0], v = [0, 0, -2] }
[objects.mirror]
material = "silver"
visible_to_camera = true
quad = { center = [1.5, 1.5, -1], u = [0.5, 0, 0], v = [0, 0.5, 0] }
[objects.floor]
material = "black"
quad = { center = [0, -1e4, 0], u = [1, 0, 0], v = [0, 0, -1] }
[materials.glass.dielectric]
ior = 1.5
[materials.silver.mirror]
reflectance = 1
[materials.black.diffuse]
albedo = 0
"#;

/// Alike from everywhere, L is what is seen along every path: Fresnel's shares and L/n² make up for each other, in a medium
/// without an end too.
#[test]
fn clear_things_vanish_in_an_even_sky() {
    let (gpu, depth) = (gpu(), [("eye.depth", "16")]);
    let scene = loaded(&(THINGS.to_owned() + EVEN), None, &[]);
    let picture = seen(&gpu, &scene, &depth, "main");
    assert!(picture.layer("mask").iter().filter(|m| **m == 1.0).count() > 150, "things are seen");
    let bands = picture
        .layer("sky")
        .chunks_exact(3)
        .flat_map(|p| [0, 1, 2].map(|k| f64::from(p[k]) / L[k]))
        .collect::<Vec<_>>();
    let (least, most) = bands.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
    let mean = bands.iter().sum::<f64>() / bands.len() as f64;
    println!("even sky: {least:.5} to {most:.7}, mean {mean:.6}");
    // Measured 0.9834 to 1 + 1e-7, mean 0.99997: branches below 1e-4 are left, and near grazing some of the light goes round
    // the sphere for longer than 16 events.
    let mut layers = Layers::new(2, 1);
    layers.push("sky", 3, [0.5, 1.0, 2.0].repeat(2)).unwrap();
    let image = format!("{THINGS}[sky.image]\nfile = \"sky.exr\"\nscale = 2\n");
    let image = seen(&gpu, &loaded(&image, Some(layers.to_exr(&About::new()).unwrap()), &[]), &depth, "main");
    let expected: Vec<_> =
        picture.layer("sky").chunks_exact(3).map(|l| Some([0, 1, 2].map(|k| f64::from(l[k])))).collect();
    assert!(off(&image, &expected) <= FLOAT32, "an image that is alike all over is the same sky");
    assert!(most <= 1.0 + FLOAT32 && mean >= 0.9995 && least >= 0.9, "{least} {most} {mean}");
}

#[test]
fn what_has_index_one_shows_the_bare_sky() {
    let gpu = gpu();
    let null = [("materials.glass.ior", "1.0"), ("objects.mirror.center", "[0, 0, 50]")];
    let scene = loaded(&(THINGS.to_owned() + UNEVEN), None, &null);
    let [through, bare] = ["main", "bare"].map(|camera| seen(&gpu, &scene, &[], camera));
    assert!(!bare.ran("eye/trace") && bare.ran("eye/sky"));
    // The mirror is behind the eye, where nothing looks.
    let pairs = through.layer("sky").chunks_exact(3).zip(bare.layer("sky").chunks_exact(3));
    let other = pairs.filter(|(a, b)| (0..3).any(|k| f64::from(a[k] - b[k]).abs() > FLOAT32)).count();
    let glass = through.layer("mask").iter().filter(|m| **m == 1.0).count();
    println!("{glass} pixels of glass, {other} of them otherwise");
    assert!(glass > 150 && other == 0, "{other} of {glass}");
    assert!(through.layer("radiance") == through.layer("sky"), "nothing else shines");
}

/// L of the gradient in float64.
fn gradient(sky: &Sky, d: DVec3) -> DVec3 {
    let Sky::Gradient { up, zenith, horizon, ground } = sky else { panic!("a gradient") };
    let s = up.dot(d);
    let end = DVec3::from(if s < 0.0 { *ground } else { *zenith });
    DVec3::from(*horizon).lerp(end, s * s * (3.0 - 2.0 * s.abs()))
}

#[test]
fn where_nothing_is_the_pixel_is_the_sky_of_its_direction() {
    let gpu = gpu();
    let scene = loaded(&(THINGS.to_owned() + UNEVEN), None, &[]);
    let sky = scene.sky.clone().unwrap();
    for camera in ["bare", "level"] {
        assert!((camera == "level") == matches!(scene.cameras[camera].kind, CameraKind::Orthographic { .. }));
        let expected: Vec<_> = directions(&scene, camera).iter().map(|d| Some(gradient(&sky, *d).to_array())).collect();
        let mut moved = scene.clone();
        // The level eye looks past all.
        moved.cameras.get_mut("level").unwrap().position += DVec3::new(0.0, 100.0, 0.0);
        moved.cameras.get_mut("level").unwrap().target += DVec3::new(0.0, 100.0, 0.0);
        let off = off(&seen(&gpu, &moved, &[("eye.samples", "1")], camera), &expected);
        println!("{camera}: {off:.1e}");
        assert!(off <= FLOAT32, "{camera}: {off:e}");
    }
}

/// The sky as a shader has it, along each direction.
fn radiance(gpu: &Gpu, scene: &Scene, directions: &[DVec3]) -> Vec<DVec3> {
    let arrays = SceneArrays::build(scene).unwrap();
    let rows: Vec<[f32; 3]> = directions.iter().map(|d| d.as_vec3().to_array()).collect();
    let probe = Probe {
        includes: &["eye/sky.glsl"],
        input: "vec3 d;",
        output: "vec3 l;",
        body: "r.l = sky_radiance(q.d);",
        ..Default::default()
    };
    let buffers = |plan: &mut Plan| -> Binder {
        let buffers = SceneBuffers::upload(plan, scene, &arrays);
        let sky = SkyBuffers::upload(plan, scene, &arrays).expect("a sky");
        Box::new(move |pass| sky.give(buffers.surfaces(pass)))
    };
    let found: Vec<[f32; 3]> = probe.run_with(gpu, &rows, buffers);
    let found: Vec<DVec3> = found.iter().map(|l| DVec3::from(l.map(f64::from))).collect();
    assert!(found.iter().all(|l| l.is_finite()));
    found
}

#[test]
fn a_gradient_is_what_its_formula_says_at_its_ends_and_between() {
    let scene = loaded(&(THINGS.to_owned() + UNEVEN), None, &[]);
    let sky = scene.sky.clone().unwrap();
    let Sky::Gradient { up, zenith, horizon, ground } = sky else { panic!("a gradient") };
    let level = up.any_orthonormal_vector();
    let mut random = Random(5);
    let mut all = vec![up, -up, level, -level];
    all.extend((0..1000).map(|_| random.direction()));
    let found = radiance(&gpu(), &scene, &all);
    for (at, end) in [zenith, ground, horizon, horizon].into_iter().enumerate() {
        assert!((found[at] - DVec3::from(end)).length() < FLOAT32, "{}: {}", all[at], found[at]);
    }
    let off = worst(all.iter().zip(&found).map(|(d, l)| (gradient(&sky, *d) - *l).length()));
    assert!(off < FLOAT32, "{off:e}");
}

#[test]
fn an_image_has_its_middle_ahead_no_seam_and_one_value_over_each_pole() {
    let (wide, high) = (8, 4);
    let mut random = Random(7);
    let texels: Vec<f32> = (0..3 * wide * high).map(|_| 10.0 * random.unit() as f32).collect();
    let mut layers = Layers::new(wide, high);
    layers.push("sky", 3, texels.clone()).unwrap();
    let bytes = layers.to_exr(&About::new()).unwrap();
    let texel = |x: usize, y: usize| {
        DVec3::from_slice(&texels[3 * (y * wide + x)..][..3].iter().map(|t| f64::from(*t)).collect::<Vec<_>>())
    };
    let gpu = gpu();
    // Up, ahead and scale as the file says them, and as they are.
    for (more, up, ahead, scale) in [
        ("", DVec3::Y, DVec3::NEG_Z, 1.0),
        ("turn = 90\nscale = 2", DVec3::Y, DVec3::NEG_X, 2.0),
        ("up = [0, 0, 3]\nturn = -90", DVec3::Z, DVec3::X, 1.0),
    ] {
        let text = format!("{THINGS}[sky.image]\nfile = \"sky.exr\"\n{more}\n");
        let scene = loaded(&text, Some(bytes.clone()), &[]);
        let right = ahead.cross(up);
        let at = |x: f64, y: f64| {
            let (azimuth, elevation) =
                ((x / wide as f64 - 0.5) * std::f64::consts::TAU, (0.5 - y / high as f64) * std::f64::consts::PI);
            elevation.cos() * (azimuth.sin() * right + azimuth.cos() * ahead) + elevation.sin() * up
        };
        let mut all: Vec<(DVec3, DVec3)> = Vec::new();
        for y in 0..high {
            for x in 0..wide {
                let middle = (x as f64 + 0.5, y as f64 + 0.5);
                let beside = texel((x + 1) % wide, y);
                all.push((at(middle.0, middle.1), texel(x, y)));
                // Between two columns, the last and the first among them.
                all.push((at(middle.0 + 0.5, middle.1), 0.5 * (texel(x, y) + beside)));
            }
        }
        // Over a pole, half-way to the column opposite: the mean of both, from either side.
        for x in 0..wide {
            for (y, row) in [(1e-4, 0), (high as f64 - 1e-4, high - 1)] {
                let mean = 0.5 * (texel(x, row) + texel((x + wide / 2) % wide, row));
                all.push((at(x as f64 + 0.5, y), mean));
            }
        }
        let mut directions: Vec<DVec3> = all.iter().map(|(d, _)| *d).collect();
        directions.extend([up, -up]);
        let found = radiance(&gpu, &scene, &directions);
        for ((d, l), found) in all.iter().zip(&found) {
            // 1e-4 of a row beside the pole, of texels up to 10.
            let error = (scale * *l - *found).abs().max_element();
            assert!(error < 2e-3 * scale, "{more}: {d}: {found} for {l}");
        }
    }
}

#[test]
fn the_sky_adds_a_layer_and_changes_no_other() {
    let gpu = gpu();
    let without = scene("glass-sphere", &[]);
    let with = scene("glass-sphere", &[("sky.gradient.zenith", "[1, 2, 3]"), ("sky.gradient.horizon", "0.5")]);
    assert_ne!(without.source.hash, with.source.hash);
    let set = [("light.side", "64"), ("maps.side", "64")];
    let [a, b] = [&without, &with].map(|scene| picture(&gpu, &job_of(scene.clone(), &set, "main", SIZE)));
    for name in ["direct", "caustic", "irradiance.direct", "irradiance.caustic", "mask"] {
        assert!(a.layer(name) == b.layer(name), "{name}");
    }
    let sum = |p: &Picture, sky: &[f32]| -> Vec<f32> {
        let parts = p.layer("direct").iter().zip(p.layer("caustic")).zip(sky);
        parts.map(|((direct, caustic), sky)| (direct + caustic) + sky).collect()
    };
    assert!(b.sum("sky") > 0.1 && b.layer("radiance") == sum(&b, b.layer("sky")));
    let none = vec![0.0; a.layer("direct").len()];
    assert!(a.layer("radiance") == sum(&a, &none) && a.layers.get("sky").is_none());
    // Nothing of it is planned where there is none, ...
    let plan = a.renderer.plan();
    let defined = plan.passes.iter().any(|pass| format!("{pass:?}").contains("SKY"));
    assert!(!defined && !a.ran("eye/sky") && plan.images.iter().all(|image| image.name != "eye/sky"));
    // ... nor where the receiver is all that is seen.
    let judged = picture(&gpu, &job_of(with, &set, "region", SIZE));
    let plan = judged.renderer.plan();
    let left_out = format!("{:?}", plan.left_out);
    assert!(!judged.ran("eye/sky") && left_out.contains("the receiver fills the picture"), "{left_out}");
    assert!(judged.layer("sky").iter().all(|l| *l == 0.0) && judged.sum("irradiance.caustic") > 0.0);
}

/// A pass through absorbing water that has no end shows nothing of the band that it takes.
#[test]
fn water_without_an_end_shows_only_what_it_does_not_absorb() {
    let text = WATER
        .replace("ior = 1.33", "ior = 1.33\nabsorption = [0.1, 0, 0]")
        .replace("[0, -10, 0], u = [1e5, 0, 0]", "[0, -10, 0], u = [2, 0, 0]")
        + EVEN;
    let set = [
        ("cameras.main.position", "[0, -1, 0]"),
        ("cameras.main.target", "[0, -10, -2]"),
        ("cameras.main.fov_y", "20"),
    ];
    let picture = seen(&gpu(), &loaded(&text.replace("-1e5]", "-2]"), None, &set), &[], "main");
    let past: Vec<_> = picture.layer("sky").chunks_exact(3).filter(|l| l[1] > 0.0).collect();
    assert!(past.len() > 100 && past.len() < 1024, "{} pixels look past the floor", past.len());
    let squared = 1.33 * 1.33;
    let error = worst(
        past.iter().flat_map(|l| [l[0].into(), f64::from(l[1]) / squared - 2.0, f64::from(l[2]) / squared - 4.0]),
    );
    assert!(error < FLOAT32, "{error:e}");
}
