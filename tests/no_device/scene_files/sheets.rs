//! Heights and waves: what their keys mean, each fault with its key and remedy, and pictures that are none.
use nephroid::{
    image::{Layers, Provenance},
    scene::{Scene, Shape},
};
use png::{BitDepth, ColorType, Encoder};

use super::{BASE, Folder};

/// A line of the scene changed, the key of the fault, and words of found and remedy.
type Case = (&'static str, &'static str, &'static str, &'static str, &'static str);

const HEIGHTS: &str = "[objects.ball.heights]\nfile = \"h.png\"\ncenter = [0, 1, 0]\nu = [2, 0, 0]\nv = [0, 0, -3]\n\
                       height = 0.5\nbase = -0.1\n";
const SEA: &str = "[objects.ball.sea]\ncenter = [0, 1, 0]\nu = [1, 0, 0]\nv = [0, 0, -2]\nwind = 2\ndirection = 30\nspread = 4\n\
                   count = 5\nshortest = 0.5\nlongest = 2\nfactor = 1\nspeed = 1\nseed = 7\ntime = 3\ngrid = 64\n";
const WAVE: &str = "[objects.ball.wave]\ncenter = [0, 1, 0]\nu = [1, 0, 0]\nv = [0, 0, -2]\nlength = 2\n\
                    middle = [0.5, 1]\noctaves = 3\nwave_size = 10\nfactor = 1\nspeed = 2\nvertex_size = 0.01\n\
                    time = 0.5\ngrid = 32\n";

const BENT: &str =
    "[objects.ball.motion.bend]\nalong = [1, 0, 0]\ntowards = [0, 1, 0]\nangle = [{ time = 0, value = 5 }]";

fn with(sheet: &str) -> String {
    BASE.replace("[objects.ball.sphere]\ncenter = [0, 0, 0]\nradius = 1\n", sheet)
}

pub fn png(size: [u32; 2], color: ColorType, depth: BitDepth, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    bytes
}

fn grey(size: [u32; 2]) -> Vec<u8> {
    let count = size[0] * size[1];
    png(size, ColorType::Grayscale, BitDepth::Sixteen, &vec![0x80; 2 * count as usize])
}

pub fn exr(layers: &[(&str, usize, Vec<f32>)]) -> Vec<u8> {
    let (_, channels, first) = &layers[0];
    let mut image = Layers::new(first.len() / channels, 1);
    layers.iter().for_each(|(name, channels, data)| image.push(name, *channels, data.clone()).unwrap());
    image.to_exr(&Provenance::new()).unwrap()
}

fn sheet_of(scene: &Scene) -> (&nephroid::scene::Mesh, glam::DAffine3) {
    match &scene.objects[0].shape {
        Shape::Mesh { mesh, to_world } => (mesh, *to_world),
        other => panic!("{other:?}"),
    }
}

#[test]
fn heights_lie_over_their_rectangle() {
    let folder = Folder::new();
    folder.write("h.png", png([2, 2], ColorType::Grayscale, BitDepth::Sixteen, &[0, 0, 255, 255, 128, 0, 0, 0]));
    let scene = folder.load(with(HEIGHTS), &[]).unwrap_or_else(|error| panic!("{error}"));
    let (mesh, to_world) = sheet_of(&scene);
    assert_eq!(mesh.sheet.as_ref().map(|s| (s.kind(), s.cells)), Some(("heights", [1, 1])));
    let corners: Vec<_> = mesh.positions.iter().map(|p| to_world.transform_point3(p.as_dvec3())).collect();
    // From the lower left, which is at −u −v, along u: black 0, white 1, and 32768 of 65535.
    let half = 32768.0 / 65535.0;
    for (corner, [x, z, value]) in
        corners.iter().zip([[-2.0, 3.0, half], [2.0, 3.0, 0.0], [-2.0, -3.0, 0.0], [2.0, -3.0, 1.0]])
    {
        assert!((corner - glam::dvec3(x, 1.0 - 0.1 + 0.5 * value, z)).length() < 1e-6, "{corner}");
    }
    let finer = folder.load(with(&format!("{HEIGHTS}grid = 6\n")), &[]).unwrap();
    assert_eq!(sheet_of(&finer).0.sheet.as_ref().map(|s| s.cells), Some([4, 6]));
    assert_ne!(finer.source.hash, scene.source.hash);
    folder.write("h.png", grey([2, 2]));
    let other = folder.load(with(HEIGHTS), &[]).unwrap();
    assert_ne!(other.source.hash, scene.source.hash, "the picture is part of the scene");
}

#[test]
fn a_cliff_is_a_slope_of_one_pixel_and_its_normals_are_finite() {
    let folder = Folder::new();
    let mut data = vec![0.0; 64];
    data[32..].fill(1e6);
    folder.write("h.exr", exr(&[("height", 1, data)]));
    let scene = folder.load(with(HEIGHTS).replace("h.png", "h.exr"), &[]).unwrap_or_else(|error| panic!("{error}"));
    let (mesh, _) = sheet_of(&scene);
    assert!(mesh.normals.iter().all(|n| n.is_normalized() && n.z > 0.0));
    assert!(mesh.normals.iter().any(|n| n.x < -0.99), "the cliff faces −u");
}

#[test]
fn a_wave_has_the_papers_constants_where_the_file_is_silent() {
    let folder = Folder::new();
    let short = "[objects.ball.wave]\ncenter = [0, 1, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\ngrid = 16\n";
    let full = "length = 2\nmiddle = [0.5, 0.5]\noctaves = 5\nwave_size = 10\nfactor = 1\nspeed = 2\n\
                vertex_size = 0.01\ntime = 0\n";
    let [a, b] = [short.to_owned(), format!("{short}{full}")].map(|text| folder.load(with(&text), &[]).unwrap());
    assert_eq!(sheet_of(&a).0.positions, sheet_of(&b).0.positions);
    // Moved by one unit along u and v, the wave is seen elsewhere; a second later it is another.
    for change in ["middle = [1.5, 1.5]\n", "time = 1\n", "octaves = 4\n"] {
        let other = folder.load(with(&format!("{short}{change}")), &[]).unwrap();
        assert_ne!(sheet_of(&a).0.positions, sheet_of(&other).0.positions, "{change}");
    }
}

/// Of nothing, of another seed, and still: by their keys.
#[test]
fn a_sea_is_that_of_its_seed_and_runs_by_its_speed() {
    let folder = Folder::new();
    let of = |from: &str, to: &str| folder.load(with(&SEA.replace(from, to)), &[]).unwrap();
    let (sea, calm, other) = (of("", ""), of("factor = 1", "factor = 0"), of("seed = 7", "seed = 8"));
    assert!(sheet_of(&calm).0.positions.iter().all(|p| p.z == 0.0));
    assert_ne!(sheet_of(&sea).0.positions, sheet_of(&other).0.positions);
    assert_ne!(sheet_of(&sea).0.positions, sheet_of(&sea.at(1.0)).0.positions);
    // Three seconds at its own speed are one at three times it.
    let fast = of("speed = 1", "speed = 3").at(1.0);
    assert_eq!(sheet_of(&sea.at(3.0)).0.positions, sheet_of(&fast).0.positions);
    assert!(!of("speed = 1", "speed = 0").moves());
    assert!(sheet_of(&sea.at(1e6)).0.positions.iter().all(|p| p.is_finite()));
}

#[rustfmt::skip]
const KEYS: &[Case] = &[
    ("height = 0.5", "height = nan", "heights.height", "NaN", "correct it"),
    ("height = 0.5", "height = 1e10", "heights.height", "1e10", "correct it"),
    ("base = -0.1", "base = inf", "heights.base", "inf", "correct it"),
    ("base = -0.1", "grid = 0", "heights.grid", "0", "256 is usual"),
    ("base = -0.1", "grid = 4096", "heights.grid", "4096", "256 is usual"),
    ("base = -0.1", "grid = 2.5", "heights.grid", "2.5", "write one of zero or more"),
    ("base = -0.1", "grid = -1", "heights.grid", "-1", "write one of zero or more"),
    ("v = [0, 0, -3]", "v = [1, 0, -3]", "heights.v", "°", "turn one"),
    ("u = [2, 0, 0]", "u = [0, 0, 0]", "heights.u", "0", "correct it"),
    ("file = \"h.png\"", "file = \"none.png\"", "heights.file", "none.png: No such file", "relative to the scene file"),
    ("file = \"h.png\"", "", "heights.file", "none", "add it"),
    ("base = -0.1", BENT, "motion.bend", "a height over a rectangle", "save the surface as a mesh"),
    ("octaves = 3", "octaves = 0", "wave.octaves", "0", "half as long"),
    ("octaves = 3", "octaves = 40", "wave.octaves", "40", "half as long"),
    ("wave_size = 10", "wave_size = 0", "wave.wave_size", "0", "the paper's are the defaults"),
    ("factor = 1", "factor = -1", "wave.factor", "-1", "the paper's are the defaults"),
    ("speed = 2", "speed = nan", "wave.speed", "NaN", "0 stands still"),
    ("vertex_size = 0.01", "vertex_size = nan", "wave.vertex_size", "NaN", "the paper's are the defaults"),
    ("vertex_size = 0.01", "vertex_size = 1e6\nfactor = 1e6", "wave.vertex_size", "e1", "make it smaller"),
    ("time = 0.5", "time = inf", "wave.time", "inf", "correct it"),
    ("length = 2", "length = 0", "wave.length", "0", "correct it"),
    ("length = 2", "length = 1e-6", "wave.middle", "1000000.5", "a greater `length`"),
    ("middle = [0.5, 1]", "middle = [nan, 0]", "wave.middle", "NaN", "a greater `length`"),
    ("middle = [0.5, 1]", "middle = 1", "wave.middle", "one number", "[along u, along v]"),
    ("wind = 2", "wind = 0", "sea.wind", "0", "a breeze on a pool is 1"),
    ("wind = 2", "wind = nan", "sea.wind", "NaN", "a gale 20"),
    ("direction = 30", "direction = 400", "sea.direction", "400", "a full turn is 360"),
    ("spread = 4", "spread = -1", "sea.spread", "-1", "8 is usual"),
    ("count = 5", "count = 0", "sea.count", "0", "64 is usual"),
    ("count = 5", "count = 5000", "sea.count", "5000", "64 is usual"),
    ("shortest = 0.5", "shortest = 0", "sea.shortest", "0", "correct it"),
    ("shortest = 0.5", "shortest = 9", "sea.shortest", "9 m, where the longest is 2 m", "make it shorter"),
    ("factor = 1", "factor = -1", "sea.factor", "-1", "the spectrum's own"),
    ("speed = 1", "speed = inf", "sea.speed", "inf", "0 stands still"),
    ("time = 3", "time = inf", "sea.time", "inf", "correct it"),
    ("seed = 7", "seed = -1", "sea.seed", "-1", "write one of zero or more"),
    ("grid = 64", "grid = 9000", "sea.grid", "9000", "256 is usual"),
    ("grid = 32", "grid = 9000", "wave.grid", "9000", "256 is usual"),
];

#[track_caller]
fn judge(folder: &Folder, text: &str, key: &str, found: &str, remedy: &str) {
    let error = folder.load(text, &[]).expect_err(found);
    assert_eq!(error.key, format!("objects.ball.{key}"), "{error}");
    assert!(error.found.contains(found) && error.remedy.contains(remedy), "{error}");
    assert!(error.to_string().contains("scene.toml:"), "{error}");
}

#[test]
fn every_fault_of_a_sheet_names_its_key_and_remedy() {
    let folder = Folder::new();
    folder.write("h.png", grey([3, 3]));
    for (from, to, key, found, remedy) in KEYS {
        let sheet = match key.split('.').next() {
            Some("wave") => WAVE,
            Some("sea") => SEA,
            _ => HEIGHTS,
        };
        // A factor that is given twice would be the fault instead.
        let sheet = if to.contains("factor = 1e6") { sheet.replace("factor = 1\n", "") } else { sheet.to_owned() };
        assert!(sheet.contains(from), "{from}");
        judge(&folder, &with(&sheet.replacen(from, to, 1)), key, found, remedy);
    }
}

#[test]
fn every_picture_that_holds_no_heights_says_why() {
    let sound = grey([8, 8]);
    let cut = |bytes: &[u8], at: usize| bytes[..at].to_vec();
    let with_byte = |at: usize, byte: u8| {
        let mut bytes = sound.clone();
        bytes[at] = byte;
        bytes
    };
    let flat = exr(&[("height", 1, vec![1.0; 16])]);
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        ("nothing", vec![], "begins like neither"),
        ("text", b"P5 2 2 255".to_vec(), "begins like neither"),
        ("a JPEG", b"\xff\xd8\xff\xe0\0\x10JFIF".to_vec(), "begins like neither"),
        ("a PNG's first bytes", cut(&sound, 8), "not a readable PNG file"),
        ("a PNG without pixels", cut(&sound, 33), "not a readable PNG file"),
        ("half a PNG", cut(&sound, sound.len() / 2), "not a readable PNG file"),
        ("a PNG of no depth", with_byte(24, 3), "not a readable PNG file"),
        ("a PNG of no colour", with_byte(25, 9), "not a readable PNG file"),
        ("a PNG whose header was changed", with_byte(19, 9), "not a readable PNG file"),
        ("a coloured PNG", png([1, 1], ColorType::Rgb, BitDepth::Eight, &[1, 2, 3]), "has 3 channels"),
        ("a PNG with alpha", png([1, 1], ColorType::GrayscaleAlpha, BitDepth::Eight, &[1, 2]), "has 2 channels"),
        ("an EXR's first bytes", cut(&flat, 8), "not a readable EXR file"),
        ("half an EXR", cut(&flat, flat.len() / 2), "not a readable EXR file"),
        ("a coloured EXR", exr(&[("radiance", 3, vec![0.5; 12])]), "has 3 channels"),
        (
            "an EXR that is no number",
            exr(&[("height", 1, vec![0.0, 1.0, f32::NAN])]),
            "pixel 2 from the left, 0 from the top",
        ),
        ("an EXR of infinity", exr(&[("height", 1, vec![f32::INFINITY])]), "pixel 0 from the left"),
        ("an EXR beyond the world", exr(&[("height", 1, vec![1e30, 0.0])]), "5"),
        ("a picture of too many cells", grey([2050, 1]), "2049"),
    ];
    for (what, bytes, found) in cases {
        let folder = Folder::new();
        folder.write("h.png", bytes);
        println!("{what}: {}", folder.load(with(HEIGHTS), &[]).expect_err(what));
        let key = if what.ends_with("world") { "heights.height" } else { "heights.file" };
        let remedy = match what {
            _ if what.ends_with("world") => "make `height` smaller",
            _ if what.ends_with("cells") => "set `grid`",
            _ => "save it again as greyscale",
        };
        judge(&folder, &with(HEIGHTS), key, found, remedy);
    }
    // With a grid of its own, the wide picture is sampled.
    let folder = Folder::new();
    folder.write("h.png", grey([2050, 1]));
    assert!(folder.load(with(&format!("{HEIGHTS}grid = 8\n")), &[]).is_ok());
}

/// Whatever stands in place of a value: it is refused, or the sheet is finite.
#[test]
fn any_value_of_a_sheet_is_refused_or_finite() {
    const VALUES: [&str; 12] = [
        "nan",
        "inf",
        "0",
        "-0.0",
        "-1",
        "1",
        "1e308",
        "-1e308",
        "1e-308",
        "9223372036854775807",
        "[1e308, 1]",
        "[2, 2, 2]",
    ];
    let folder = Folder::new();
    folder.write("h.png", grey([3, 2]));
    let mut loaded = 0;
    for sheet in [HEIGHTS, WAVE] {
        for line in sheet.lines().filter(|line| line.contains(" = ")) {
            let (key, _) = line.split_once(" = ").unwrap();
            for value in VALUES {
                if let Ok(scene) = folder.load(with(&sheet.replacen(line, &format!("{key} = {value}"), 1)), &[]) {
                    loaded += 1;
                    let (mesh, to_world) = sheet_of(&scene);
                    let finite = mesh.positions.iter().chain(&mesh.normals).all(|v| v.is_finite());
                    assert!(finite && to_world.is_finite(), "{key} = {value}");
                }
            }
        }
    }
    assert!(loaded > 10, "{loaded}");
}
