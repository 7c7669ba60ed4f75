//! Pictures on surfaces: the look-up against float64, radiance against its closed form, and what a texture may not touch.

use crate::common::{
    Binder, Probe, gpu,
    picture::{job_of, picture, png, rewritten, scene},
    random::Random,
};
use glam::{DVec2, DVec3};
use nephroid::{
    passes::{accel::SceneArrays, scene::SceneBuffers},
    scene::{MaterialKind, Scene, Shape},
};

/// Roundings of coordinates of up to the repeats, 2⁻²⁴ each, over a pixel of 1/16 and a step between pixels of 1; three mixes.
const LOOK_UP: f64 = 4.0 * 16.0 * 8.0 / 16_777_216.0;
/// Of products of float32 of order one.
const ROUNDING: f64 = 1e-6;

const SIDES: [(&str, &str); 3] = [("light.side", "64"), ("maps.side", "64"), ("eye.samples", "1")];

fn linear(byte: u8) -> f64 {
    let value = f64::from(byte) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// A scene with files beside it.
fn beside(text: &str, files: &[(&str, &[u8])]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, bytes)| std::fs::write(folder.path().join(name), bytes).unwrap());
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    Scene::load(path.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn noise(width: u32, height: u32) -> Vec<[u8; 3]> {
    let mut random = Random(3);
    (0..width * height).map(|_| [0; 3].map(|_: u8| random.below(256) as u8)).collect()
}

/// In float64, bilinear, repeated, its lower edge at 0.
fn looked_up(pixels: &[[u8; 3]], [width, height]: [usize; 2], repeat: DVec2, place: DVec2) -> DVec3 {
    let at = place * repeat;
    let pixel = |x: f64, y: f64| {
        let (x, y) = (x.rem_euclid(width as f64) as usize, y.rem_euclid(height as f64) as usize);
        DVec3::from(pixels[y * width + x].map(linear))
    };
    let (x, y) = (at.x * width as f64 - 0.5, -at.y * height as f64 - 0.5);
    let row = |y: f64| pixel(x.floor(), y).lerp(pixel(x.floor() + 1.0, y), x - x.floor());
    row(y.floor()).lerp(row(y.floor() + 1.0), y - y.floor())
}

#[test]
fn the_look_up_is_bilinear_and_repeats() {
    let size = [16usize, 5];
    let pixels = noise(16, 5);
    let text = rewritten("diffuse", &[("albedo = 0.8", "texture = \"t.png\"\nrepeat = [3, 0.5]")], "");
    let scene = beside(&text, &[("t.png", &png(16, &pixels))]);
    let arrays = SceneArrays::build(&scene).unwrap();
    let mut random = Random(7);
    // Anywhere, on edges and middles of pixels, beyond 0 to 1, far off, and no place at all.
    let mut rows: Vec<[f32; 2]> = (0..20_000).map(|_| [0; 2].map(|_| random.within(-2.0, 3.0) as f32)).collect();
    rows.extend((0..=96).flat_map(|x| (0..=20).map(move |y| [x as f32 / 96.0, y as f32 / 10.0])));
    let told = rows.len();
    rows.extend([[1e9, 1.0], [-1e30, 0.5], [f32::NAN, 0.5], [f32::INFINITY, f32::NEG_INFINITY], [0.5, f32::MAX]]);
    let probe = Probe {
        includes: &["shared/albedo.glsl"],
        input: "vec2 place;",
        output: "vec3 colour;",
        body: "r.colour = texture_at(scene_textures.data[0], q.place);",
        ..Default::default()
    };
    let buffers = |plan: &mut nephroid::gpu::Plan| -> Binder {
        let buffers = SceneBuffers::upload(plan, &scene, &arrays);
        Box::new(move |pass| buffers.colours(buffers.tracing(pass)))
    };
    let found: Vec<[f32; 3]> = probe.run_with(&gpu(), &rows, buffers);
    let mut worst = 0.0_f64;
    for (row, colour) in rows.iter().zip(&found) {
        assert!(colour.iter().all(|band| (0.0..=1.0).contains(band)), "{row:?}: {colour:?}");
    }
    for (row, colour) in rows.iter().zip(&found).take(told) {
        let exact = looked_up(&pixels, size, DVec2::new(3.0, 0.5), DVec2::from(row.map(f64::from)));
        worst = worst.max((DVec3::from(colour.map(f64::from)) - exact).abs().max_element());
    }
    println!("worst {worst:.1e}");
    assert!(worst < LOOK_UP, "{worst:e}");
}

/// Under a sun of 1 W/m² a Lambertian surface of albedo ρ sends out ρ/π; irradiance knows nothing of ρ.
#[test]
fn radiance_is_the_pictures_and_irradiance_is_not() {
    let gpu = gpu();
    let pixels = [[255, 255, 255], [255, 0, 0], [0, 128, 0], [10, 20, 200]];
    let text = rewritten("glass-sphere", &[("albedo = 0.8", "albedo = [1.0, 0.5, 1.0]\ntexture = \"t.png\"")], "");
    let shown = beside(&text, &[("t.png", &png(2, &pixels))]);
    let plain = scene("glass-sphere", &[]);
    let of = |scene: &Scene| picture(&gpu, &job_of(scene.clone(), &SIDES, "region", [64; 2]));
    let (shown_picture, plain_picture) = (of(&shown), of(&plain));
    let direct = plain_picture.layer("irradiance.direct");
    assert_eq!(shown_picture.layer("irradiance.direct"), direct);
    let Shape::Quad { center, u, v } = shown.objects[shown.region.receiver].shape else { panic!("no quad") };
    let region = &shown.region;
    let mut worst = 0.0_f64;
    for (k, radiance) in shown_picture.layer("direct").chunks_exact(3).enumerate() {
        let at = |k: usize| 2.0 * (k as f64 + 0.5) / 64.0 - 1.0;
        let p = region.center + region.u * at(k % 64) - region.v * at(k / 64);
        let place = DVec2::new((p - center).dot(u) / u.length_squared(), (p - center).dot(v) / v.length_squared());
        let albedo = looked_up(&pixels, [2, 2], DVec2::ONE, 0.5 + 0.5 * place) * DVec3::new(1.0, 0.5, 1.0);
        for band in 0..3 {
            let exact = albedo[band] * f64::from(direct[3 * k + band]) / std::f64::consts::PI;
            worst = worst.max((f64::from(radiance[band]) - exact).abs());
        }
    }
    println!("worst {worst:.1e}");
    assert!(worst < ROUNDING, "{worst:e}");
}

/// Around a sphere, around a tube, on the faces of a box: where a picture's colours go.
#[test]
fn shapes_without_edges_have_their_coordinates_too() {
    let gpu = gpu();
    // Left half red, right half blue: +z, where the coordinates' middle is, is their border.
    let pixels: Vec<[u8; 3]> = (0..64).map(|x| if x < 32 { [255, 0, 0] } else { [0, 0, 255] }).collect();
    for shape in [
        "[objects.ball.sphere]\ncenter = [0, 0.5, 0]\nradius = 0.5",
        "[objects.ball.cylinder]\nbase = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 0.5\nheight = 1",
        "[objects.ball.box]\ncenter = [0, 0.5, 0]\nhalf = [0.5, 0.5, 0.5]",
        "[objects.ball.disk]\ncenter = [0, 0.5, 0]\nnormal = [0, 0, 1]\nradius = 0.5",
    ] {
        let more = format!(
            "\n[objects.ball]\nmaterial = \"painted\"\n{shape}\n[materials.painted.diffuse]\ntexture = \"t.png\"\n\
             [lights.front.directional]\ndirection = [0, 0, -1]\nirradiance = 1\n\
             [cameras.front.pinhole]\nposition = [0, 0.5, 4]\ntarget = [0, 0.5, 0]\nfov_y = 12\n"
        );
        let text = EMPTY.to_owned() + &more;
        let scene = beside(&text, &[("t.png", &png(64, &pixels))]);
        let picture = picture(&gpu, &job_of(scene, &SIDES, "front", [32; 2]));
        let radiance = picture.layer("direct");
        let colours = radiance.chunks_exact(3).filter(|c| c.iter().sum::<f32>() > 0.01);
        let (mut red, mut blue) = (0, 0);
        for colour in colours {
            assert!(colour[1] == 0.0, "{shape}: {colour:?}");
            red += usize::from(colour[0] > colour[2]);
            blue += usize::from(colour[2] > colour[0]);
        }
        println!("{shape}: {red} red, {blue} blue");
        assert!(red > 50 && blue > 50, "{shape}: {red} red, {blue} blue");
    }
}

/// A floor far below, and no light: what is added to it is alone.
const EMPTY: &str = "version = 1\ntitle = \"Painted\"\npaths = \"reflect-1\"\n[region]\nreceiver = \"floor\"\ncenter = [0, 0]\n\
    half = [1, 1]\n[cameras.main.pinhole]\nposition = [0, 2, 4]\ntarget = [0, 0, 0]\nfov_y = 40\n[objects.floor]\n\
    material = \"black\"\n[objects.floor.quad]\ncenter = [0, -9, 0]\nu = [2, 0, 0]\nv = [0, 0, -2]\n\
    [materials.black.diffuse]\nalbedo = 0\n";

/// A square of two triangles in a file, its coordinates turned and repeated, is the quad that has them.
#[test]
fn a_mesh_shows_what_its_coordinates_say() {
    let gpu = gpu();
    let obj = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\nf 1/1 2/2 3/3 4/4\n";
    let camera =
        "[cameras.above.orthographic]\nposition = [0, 3, 0]\ntarget = [0, 0, 0]\nup = [0, 0, -1]\nheight = 2\n";
    let light = "[lights.sun.directional]\ndirection = [0, -1, 0]\nirradiance = 1\n";
    let of = |shape: &str, repeat: &str| {
        let more = format!(
            "\n[objects.sheet]\nmaterial = \"painted\"\n{shape}\n[materials.painted.diffuse]\ntexture = \"t.png\"\n\
             repeat = {repeat}\n{light}{camera}"
        );
        let files: [(&str, &[u8]); 2] = [("t.png", &png(4, &noise(4, 4))), ("sheet.obj", obj.as_bytes())];
        let scene = beside(&(EMPTY.to_owned() + &more), &files);
        picture(&gpu, &job_of(scene, &SIDES, "above", [48; 2])).layer("direct").to_vec()
    };
    let mesh = of("[objects.sheet.mesh]\nfile = \"sheet.obj\"\nfit = 2\ncenter = [0, 0, 0]", "[1, 1]");
    let quad = of("[objects.sheet.quad]\ncenter = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]", "[2, 2]");
    let worst = mesh.iter().zip(&quad).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
    println!("worst {worst:.1e}");
    assert!(worst < LOOK_UP && quad.iter().any(|v| *v > 0.1), "{worst:e}");
}

/// At a seam corners part, but the surface does not.
#[test]
fn normals_are_whole_where_coordinates_part() {
    let cube = |corner: &dyn Fn(usize) -> String| {
        let faces = [[1, 4, 3, 2], [5, 6, 7, 8], [1, 2, 6, 5], [3, 4, 8, 7], [2, 3, 7, 6], [4, 1, 5, 8]];
        let positions =
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
        let face = |f: [usize; 4]| {
            format!(
                "f {}\n",
                f.iter().enumerate().map(|(k, v)| format!("{v}{}", corner(k))).collect::<Vec<_>>().join(" ")
            )
        };
        positions.to_owned() + &faces.map(face).concat()
    };
    let (plain, seamed) = (cube(&|_| String::new()), cube(&|k| format!("/{}", k + 1)));
    let of = |obj: &str| {
        let more = "\n[objects.cube]\nmaterial = \"black\"\n[objects.cube.mesh]\nfile = \"c.obj\"\nfit = 1\ncenter = [0, 0, 0]\n";
        let scene = beside(&(EMPTY.to_owned() + more), &[("c.obj", obj.as_bytes())]);
        match &scene.objects[0].shape {
            Shape::Mesh { mesh, .. } => mesh.clone(),
            other => panic!("{other:?}"),
        }
    };
    let (plain, seamed) = (of(&plain), of(&seamed));
    assert_eq!((plain.positions.len(), plain.coordinates.len()), (8, 0));
    assert_eq!((seamed.coordinates.len(), seamed.normals.len()), (seamed.positions.len(), seamed.positions.len()));
    assert!(seamed.positions.len() > 8, "corners with two places are two vertices");
    for (a, b) in plain.triangles.iter().flatten().zip(seamed.triangles.iter().flatten()) {
        let at = |mesh: &nephroid::scene::Mesh, i: u32| (mesh.positions[i as usize], mesh.normals[i as usize]);
        assert_eq!(at(&plain, *a), at(&seamed, *b));
    }
}

/// Caustic and account are those of the plain floor; a scene without a texture has no part of any.
#[test]
fn light_does_not_see_textures_and_other_scenes_have_none() {
    let gpu = gpu();
    let text = rewritten("glass-sphere", &[("albedo = 0.8", "texture = \"t.png\"\nrepeat = [5, 5]")], "");
    let painted = beside(&text, &[("t.png", &png(8, &noise(8, 8)))]);
    let of = |scene: Scene| picture(&gpu, &job_of(scene, &SIDES, "main", [64; 2]));
    let (painted, plain) = (of(painted), of(scene("glass-sphere", &[])));
    for layer in ["irradiance.direct", "irradiance.caustic", "mask"] {
        assert_eq!(painted.layer(layer), plain.layer(layer), "{layer}");
    }
    assert_eq!(painted.account.counts, plain.account.counts);
    assert_ne!(painted.layer("radiance"), plain.layer("radiance"));
    let names = |picture: &crate::common::picture::Picture, of: &str| {
        let plan = picture.renderer.plan();
        plan.buffers.iter().filter(|buffer| buffer.name.starts_with(of)).count()
    };
    assert_eq!((names(&painted, "scene/tex"), names(&plain, "scene/tex")), (2, 0));
    assert_eq!((names(&painted, "scene/coordinates"), names(&plain, "scene/coordinates")), (0, 0));
}

/// One picture on two materials is held once.
#[test]
fn a_picture_is_held_once() {
    let more = "\n[materials.other.diffuse]\ntexture = \"t.png\"\nrepeat = [2, 2]\n";
    let text = rewritten("diffuse", &[("albedo = 0.8", "texture = \"t.png\"")], more);
    let arrays = SceneArrays::build(&beside(&text, &[("t.png", &png(2, &noise(2, 2)))])).unwrap();
    assert_eq!((arrays.textures.all.len(), arrays.textures.texels.len()), (2, 4 * 12));
    let scene = beside(&text, &[("t.png", &png(2, &noise(2, 2)))]);
    let of = |name: &str| scene.materials.iter().find(|m| m.name == name).unwrap().kind.clone();
    assert!(matches!(of("other"), MaterialKind::Diffuse { albedo: [1.0, 1.0, 1.0], texture: Some(_) }));
}
