//! Textures with one fault each: named by key, with what was found and what to do.
use png::{BitDepth, ColorType};

use super::{
    BASE, Folder,
    sheets::{exr, png},
};

/// What stands for `albedo = 0.8` of the floor's material, then the fault's key, and words of found and remedy.
type Case = (&'static str, &'static str, &'static str, &'static str);

#[rustfmt::skip]
const CASES: &[Case] = &[
    ("", "materials.white.diffuse.albedo", "none", "add it"),
    ("repeat = [2, 2]\nalbedo = 1", "materials.white.diffuse.repeat", "none", "add `texture`"),
    ("texture = 3", "materials.white.diffuse.texture", "integer `3`", "in quotes"),
    ("texture = \"none.png\"", "materials.white.diffuse.texture", "none.png: No such file", "relative to the scene file"),
    ("texture = \"folder\"", "materials.white.diffuse.texture", "a folder", "relative to the scene file"),
    ("texture = \"scene.toml\"", "materials.white.diffuse.texture", "begins like neither", "PNG of 8 or 16 bits"),
    ("texture = \"cut.png\"", "materials.white.diffuse.texture", "cut.png: ", "PNG of 8 or 16 bits"),
    ("texture = \"large.png\"", "materials.white.diffuse.texture", "11560000 pixels", "save it smaller"),
    ("texture = \"clear.png\"", "materials.white.diffuse.texture",
        "pixel 1 from the left, 0 from the top lets light through", "without transparency"),
    ("texture = \"bright.exr\"", "materials.white.diffuse.texture",
        "pixel 1 from the left, 0 from the top is 1.5", "values from 0 to 1"),
    ("texture = \"nan.exr\"", "materials.white.diffuse.texture", "is NaN", "values from 0 to 1"),
    ("texture = \"negative.exr\"", "materials.white.diffuse.texture", "is -0.5", "values from 0 to 1"),
    ("texture = \"good.png\"\nalbedo = 1.5", "materials.white.diffuse.albedo", "1.5", "at most the light it gets"),
    ("texture = \"good.png\"\nrepeat = [0, 1]", "materials.white.diffuse.repeat", "0", "1 shows it once"),
    ("texture = \"good.png\"\nrepeat = [1, nan]", "materials.white.diffuse.repeat", "NaN", "1 shows it once"),
    ("texture = \"good.png\"\nrepeat = 2", "materials.white.diffuse.repeat", "one number", "write `[along u, along v]`"),
    ("texture = \"good.png\"\n[objects.tri]\nmaterial = \"white\"\n[objects.tri.mesh]\nfile = \"tri.obj\"\nfit = 1\ncenter = [0, 0, 0]",
        "objects.tri.material", "tri.obj, which has none, for `good.png`", "export it with them"),
];

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("large.png", png([3400, 3400], ColorType::Grayscale, BitDepth::Eight, &vec![7; 3400 * 3400]));
    let good = png([2, 1], ColorType::Rgb, BitDepth::Eight, &[0, 1, 2, 255, 254, 253]);
    folder.write("cut.png", &good[..good.len() / 2]);
    folder.write("good.png", good);
    folder.write("clear.png", png([2, 1], ColorType::Rgba, BitDepth::Eight, &[9, 9, 9, 255, 9, 9, 9, 254]));
    folder.write("bright.exr", exr(&[("colour", 3, vec![0.0, 0.5, 1.0, 1.0, 1.5, 1.0])]));
    folder.write("nan.exr", exr(&[("colour", 3, vec![0.0, 0.5, f32::NAN])]));
    folder.write("negative.exr", exr(&[("colour", 1, vec![0.0, -0.5])]));
    folder.write("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    std::fs::create_dir(folder.write("x", "").with_file_name("folder")).unwrap();
    folder
}

#[test]
fn every_fault_of_a_texture_is_named() {
    let folder = folder();
    for (diffuse, key, found, remedy) in CASES {
        let error = folder.load(BASE.replacen("albedo = 0.8", diffuse, 1), &[]).expect_err(diffuse);
        assert_eq!(error.key, *key, "{diffuse}\n{error}");
        assert!(error.found.contains(found) && error.remedy.contains(remedy), "{diffuse}\n{error}");
        assert!(error.to_string().contains("scene.toml:"), "{error}");
    }
}

#[test]
fn a_picture_of_one_pixel_will_do_and_is_part_of_the_hash() {
    let folder = folder();
    let hash = |bytes: Vec<u8>| {
        folder.write("one.png", bytes);
        let text = BASE.replacen("albedo = 0.8", "texture = \"one.png\"\nalbedo = 0", 1);
        folder.load(text, &[]).unwrap_or_else(|error| panic!("{error}")).source.hash
    };
    let grey = |value: u8| png([1, 1], ColorType::Grayscale, BitDepth::Eight, &[value]);
    assert_eq!(hash(grey(7)), hash(grey(7)));
    assert_ne!(hash(grey(7)), hash(grey(8)));
    let opaque = png([1, 1], ColorType::GrayscaleAlpha, BitDepth::Sixteen, &[1, 2, 255, 255]);
    assert_ne!(hash(opaque), hash(grey(7)));
}

/// What is wrong with texture coordinates: line, found.
#[test]
fn coordinates_that_are_none_are_named() {
    let folder = Folder::new();
    let mesh =
        "\n[objects.tri]\nmaterial = \"white\"\n[objects.tri.mesh]\nfile = \"tri.obj\"\nfit = 1\ncenter = [0, 0, 0]\n";
    for (obj, found, remedy) in [
        ("v 0 0 0\nvt\n", "fewer at tri.obj:2", "repair the line"),
        ("v 0 0 0\nvt 0 0\nf 1/9 1/1 1\n", "texture coordinates 9 at tri.obj:3", "export it again"),
        ("v 0 0 0\nvn 0 1 0\nf 1//9 1//1 1\n", "normal 9 at tri.obj:3", "export it again"),
        ("v 0 0 0\nvt 1 nan\n", "\"nan\" at tri.obj:2", "repair the line"),
        ("v 0 0 0\nvt 0 0\nf 1/1 1/1 1/2\n", "texture coordinates 2 at tri.obj:3", "export it again"),
        ("v 0 0 0\nvt 0 0\nf 1/1 1/1 1/0\n", "\"1/0\" at tri.obj:3", "from 1"),
        ("v 0 0 0\nvt 0 0\nf 1/1 1/1 1/x\n", "\"1/x\" at tri.obj:3", "from 1"),
    ] {
        folder.write("tri.obj", obj);
        let error = folder.load(BASE.to_owned() + mesh, &[]).expect_err(obj);
        assert!(error.found.contains(found) && error.remedy.contains(remedy), "{error}");
    }
}

/// A spot added to the base scene, then the fault's key, and words of found and remedy.
#[rustfmt::skip]
const SLIDES: &[Case] = &[
    ("outer = 20\nimage = \"none.png\"", "lights.beam.spot.image", "none.png: No such file", "relative to the scene file"),
    ("outer = 20\nimage = \"scene.toml\"", "lights.beam.spot.image", "begins like neither", "PNG of 8 or 16 bits"),
    ("outer = 20\nimage = \"clear.png\"", "lights.beam.spot.image", "lets light through", "without transparency"),
    ("outer = 20\nimage = \"bright.exr\"", "lights.beam.spot.image", "is 1.5", "values from 0 to 1"),
    ("outer = 20\nimage = 3", "lights.beam.spot.image", "integer `3`", "in quotes"),
    ("outer = 90\nimage = \"good.png\"", "lights.beam.spot.outer", "90", "make the beam narrower"),
    ("outer = 20\nup = [0, 0, 1]", "lights.beam.spot.up", "none", "add `image`"),
    ("outer = 20\nup = [0, 2, 0]\nimage = \"good.png\"", "lights.beam.spot.up", "one along it", "choose another upright"),
    ("outer = 20\nup = [0, 0, 0]\nimage = \"good.png\"", "lights.beam.spot.up", "[0, 0, 0]", "not zero"),
];

#[test]
fn every_fault_of_a_projected_picture_is_named() {
    let folder = folder();
    let with = |more: &str| {
        format!("{BASE}\n[lights.beam.spot]\nposition = [0, 3, 0]\ndirection = [0, -1, 0]\nintensity = 1\n{more}\n")
    };
    folder.load(with("outer = 20\nimage = \"good.png\""), &[]).unwrap_or_else(|error| panic!("{error}"));
    for (more, key, found, remedy) in SLIDES {
        let error = folder.load(with(more), &[]).expect_err(more);
        assert_eq!(error.key, *key, "{more}\n{error}");
        assert!(error.found.contains(found) && error.remedy.contains(remedy), "{more}\n{error}");
    }
}
