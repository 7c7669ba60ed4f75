//! The sky in scene files: each fault is named, overrides reach it, its picture is part of the hash.
use nephroid::scene::Sky;
use png::{BitDepth, ColorType};

use super::{
    BASE, Folder,
    sheets::{exr, png},
};

const GRADIENT: &str = "[sky.gradient]\nzenith = [0.1, 0.2, 0.4]\nhorizon = 1\n";

/// What is added to the base scene, then the fault's key, and words of found and remedy.
type Case = (&'static str, &'static str, &'static str, &'static str);

#[rustfmt::skip]
const CASES: &[Case] = &[
    ("[sky]", "sky", "none", "add `[sky.gradient]`"),
    ("sky = 1", "sky", "integer `1`", "below a `[header]`"),
    ("[sky]\nzenith = 1", "sky.zenith", "unknown key `zenith`", ""),
    ("[sky]\ngradient = { zenith = 1, horizon = 1 }\nimage = { file = \"good.exr\" }", "sky", "gradient and image", "keep one"),
    ("[sky.gradient]\nzenith = 1", "sky.gradient.horizon", "none", "add it"),
    ("[sky.gradient]\nzenith = -1\nhorizon = 1", "sky.gradient.zenith", "-1", "zero or more"),
    ("[sky.gradient]\nzenith = 1\nhorizon = [1, nan, 1]", "sky.gradient.horizon", "NaN", "zero or more"),
    ("[sky.gradient]\nzenith = 1\nhorizon = 1\nground = 1e13", "sky.gradient.ground", "1e13", "finite number"),
    ("[sky.gradient]\nzenith = 1\nhorizon = 1\nup = [0, 0, 0]", "sky.gradient.up", "[0, 0, 0]", "not zero"),
    ("[sky.image]\nscale = 1", "sky.image.file", "none", "add it"),
    ("[sky.image]\nfile = \"none.exr\"", "sky.image.file", "none.exr: No such file", "relative to the scene file"),
    ("[sky.image]\nfile = \"scene.toml\"", "sky.image.file", "begins like neither", "save it as EXR"),
    ("[sky.image]\nfile = \"cut.exr\"", "sky.image.file", "cut.exr: ", "save it as EXR"),
    ("[sky.image]\nfile = \"sky.png\"", "sky.image.file", "is a PNG", "save it as EXR"),
    ("[sky.image]\nfile = \"square.exr\"", "sky.image.file", "2 × 2 pixels", "twice as wide as high"),
    ("[sky.image]\nfile = \"nan.exr\"", "sky.image.file", "pixel 1 from the left, 0 from the top is NaN", "make each finite"),
    ("[sky.image]\nfile = \"negative.exr\"", "sky.image.file", "pixel 0 from the left, 0 from the top is -0.5", "zero or more"),
    ("[sky.image]\nfile = \"endless.exr\"", "sky.image.file", "is inf", "make each finite"),
    ("[sky.image]\nfile = \"endless.exr\"\nscale = 0", "sky.image.file", "is inf", "make each finite"),
    ("[sky.image]\nfile = \"good.exr\"\nscale = 1e12", "sky.image.file", "is 3", "by `scale`"),
    ("[sky.image]\nfile = \"good.exr\"\nscale = -1", "sky.image.scale", "-1", "takes the picture as it is"),
    ("[sky.image]\nfile = \"good.exr\"\nturn = 400", "sky.image.turn", "400", "a whole turn"),
    ("[sky.image]\nfile = \"good.exr\"\nturn = nan", "sky.image.turn", "NaN", "a whole turn"),
    ("[sky.image]\nfile = \"good.exr\"\nup = [0, nan, 0]", "sky.image.up", "NaN", "not zero"),
];

/// A picture of two pixels of one channel.
fn pair(left: f32, right: f32) -> Vec<u8> {
    exr(&[("colour", 1, vec![left, right])])
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("cut.exr", &pair(1.0, 3.0)[..40]);
    folder.write("sky.png", png([2, 1], ColorType::Grayscale, BitDepth::Eight, &[1, 2]));
    folder.write("good.exr", pair(1.0, 3.0));
    folder.write("nan.exr", pair(0.0, f32::NAN));
    folder.write("negative.exr", pair(-0.5, 1.0));
    folder.write("endless.exr", pair(0.0, f32::INFINITY));
    let mut square = nephroid::image::Layers::new(2, 2);
    square.push("colour", 1, vec![1.0; 4]).unwrap();
    folder.write("square.exr", square.to_exr(&Default::default()).unwrap());
    folder
}

#[test]
fn every_fault_of_a_sky_is_named() {
    let folder = folder();
    for (more, key, found, remedy) in CASES {
        // Before all tables, so that a bare key can be tried too.
        let error = folder.load(BASE.replacen("[region]", &format!("{more}\n[region]"), 1), &[]).expect_err(more);
        assert_eq!(error.key, *key, "{more}\n{error}");
        assert!(error.found.contains(found) && error.remedy.contains(remedy), "{more}\n{error}");
        assert!(error.to_string().contains("scene.toml:"), "{error}");
    }
}

#[test]
fn what_is_left_out_has_its_default_and_can_be_set() {
    let folder = folder();
    let gradient =
        |text: String, set: &[(&str, &str)]| match folder.load(text, set).unwrap_or_else(|error| panic!("{error}")).sky
        {
            Some(Sky::Gradient { up, zenith, horizon, ground }) => (up.to_array(), zenith, horizon, ground),
            other => panic!("{other:?}"),
        };
    let (y, with) = ([0.0, 1.0, 0.0], || format!("{BASE}{GRADIENT}"));
    assert_eq!(gradient(with(), &[]), (y, [0.1, 0.2, 0.4], [1.0; 3], [1.0; 3]));
    // The kind may be left out, and a scene without a sky given one.
    let set = [("sky.zenith", "2"), ("sky.ground", "[0, 0, 1]"), ("sky.gradient.up", "[0, 0, 2]")];
    assert_eq!(gradient(with(), &set), ([0.0, 0.0, 1.0], [2.0; 3], [1.0; 3], [0.0, 0.0, 1.0]));
    let made = [("sky.gradient.zenith", "3"), ("sky.gradient.horizon", "4")];
    assert_eq!(gradient(BASE.to_owned(), &made), (y, [3.0; 3], [4.0; 3], [4.0; 3]));
    assert!(folder.load(BASE, &[]).unwrap().sky.is_none());

    let other = folder.load(with(), &[("sky.image.file", "good.exr")]).expect_err("another kind");
    assert!(other.found.contains("`image`") && other.remedy.contains("scene.sky={ image = "), "{other}");
    let none = folder.load(with(), &[("sky.zenit", "1")]).expect_err("no such key");
    assert!(none.remedy.contains("sky.gradient.zenith"), "{none}");
    let whole = folder.load(with(), &[("sky", "{ image = { file = \"good.exr\", scale = 2 } }")]).unwrap();
    let Some(Sky::Image { picture, .. }) = whole.sky else { panic!("an image") };
    assert_eq!(picture.pixels, [[2.0; 3], [6.0; 3]]);
}

#[test]
fn a_sky_and_its_picture_are_part_of_the_hash() {
    let folder = folder();
    let hash = |more: &str| folder.load(format!("{BASE}{more}"), &[]).unwrap_or_else(|e| panic!("{e}")).source.hash;
    let image = "[sky.image]\nfile = \"good.exr\"\n";
    let all = [hash(""), hash(GRADIENT), hash(&GRADIENT.replace("0.4", "0.5")), hash(image)];
    folder.write("good.exr", pair(1.0, 2.0));
    let all = [&all[..], &[hash(image)]].concat();
    for (at, one) in all.iter().enumerate() {
        assert!(all[..at].iter().all(|other| other != one), "{at}");
    }
    folder.write("good.exr", pair(1.0, 3.0));
    assert_eq!(hash(image), all[3]);
}
