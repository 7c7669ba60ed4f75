//! What the window shows is what `render` writes, caustic and colours and all.

use std::path::Path;

use glam::{DVec2, DVec3};
use nephroid::{
    passes::{extents, eye},
    scene::Scene,
};

use crate::{SMALL, display::Display, program, ran};

const SIZE: [u32; 2] = [160, 120];
/// A floor whose bands differ, so that bands in the wrong order are seen.
const COLOURED: &str = "--set scene.materials.white.albedo=[0.9,0.5,0.2]";
/// Steps of 8 bits, mean over all bands: measured 0 where the window stores what is written, 0.035 where it applies the
/// sRGB curve itself, which devices may approximate. The curve twice, or never, would be tens of steps.
const ROUNDING: f64 = 0.1;

/// Colours of a PNG, rows from the top.
pub struct Picture {
    pub size: [u32; 2],
    pub bytes: Vec<u8>,
}

impl Picture {
    pub fn read(path: &Path) -> Self {
        let file = std::fs::File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG");
        let mut bytes = vec![0; reader.output_buffer_size().expect("it fits")];
        let info = reader.next_frame(&mut bytes).expect("a whole PNG");
        let about = |name: &&str| reader.info().utf8_text.iter().any(|t| t.keyword == *name);
        assert!(["scene.hash", "device.name", "arguments"].iter().all(about), "provenance");
        assert_eq!(info.color_type, png::ColorType::Rgb);
        Self { size: [info.width, info.height], bytes }
    }

    /// Mean of each band over the 5×5 pixels where `point` is seen by the camera `main`.
    fn at(&self, scene: &Scene, point: DVec3) -> [f64; 3] {
        let view = eye::view(&scene.cameras["main"], SIZE, &extents::everything(scene));
        let at = view.project(point).expect("it is in front of the eye") * DVec2::from(SIZE.map(f64::from));
        let (x, y) = (at.x as usize, at.y as usize);
        let pixels = (y - 2..=y + 2).flat_map(|y| (x - 2..=x + 2).map(move |x| 3 * (y * SIZE[0] as usize + x)));
        let sums = pixels.fold([0.0; 3], |sums, p| [0, 1, 2].map(|band| sums[band] + f64::from(self.bytes[p + band])));
        sums.map(|sum| sum / 25.0)
    }
}

/// Of two pictures of one size.
pub fn mean_difference(a: &Picture, b: &Picture) -> f64 {
    assert_eq!(a.size, b.size);
    let sum: f64 = a.bytes.iter().zip(&b.bytes).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
    sum / a.bytes.len() as f64
}

#[test]
fn the_window_shows_the_caustic_as_render_writes_it() {
    let display = Display::start();
    let folder = tempfile::tempdir().unwrap();
    let (shot, out) = (folder.path().join("shot.png"), folder.path().join("out"));
    let options = format!("glass-sphere --method maps {SMALL} {COLOURED}");
    let view = format!("view {options} --frames 5 --validation --format csv --screenshot {}", shot.display());
    let (code, csv, err) = ran(display.program(&view).output().unwrap());
    assert_eq!(code, Some(0), "{err}");
    assert!(err.contains("software device"), "the device is named: {err}");
    for stage in ["light/photons", "maps/cells", "eye/trace", "window/show", "frame/wall"] {
        let row = csv.lines().find_map(|line| line.strip_prefix(&format!("{stage},"))).expect(stage);
        let median: f64 = row.split(',').next().unwrap().parse().expect("milliseconds");
        assert!(median > 0.0 && median.is_finite(), "{csv}");
    }
    let render = format!("render {options} --warmup 0 --repeat 1 --out {}", out.display());
    let (code, _, err) = ran(program(&render).output().unwrap());
    assert_eq!(code, Some(0), "{err}");

    let (shown, written) = (Picture::read(&shot), Picture::read(&out.join("image.png")));
    assert_eq!(shown.size, SIZE);
    let difference = mean_difference(&shown, &written);
    println!("mean difference {difference:.5} steps");
    assert!(difference <= ROUNDING, "{difference}");

    let scene = Scene::load("glass-sphere", &[]).unwrap();
    // The caustic's middle is just seen past the sphere; beside the shadow the sun falls on the bare floor.
    let [caustic, shadow, floor] =
        [[0.0, -1.5, 0.15], [0.7, -1.5, 0.3], [1.8, -1.5, 0.3]].map(|p| shown.at(&scene, DVec3::from(p)));
    println!("caustic {caustic:?}, shadow {shadow:?}, floor {floor:?}");
    assert!((0..3).all(|band| caustic[band] > floor[band] + 20.0 && floor[band] > shadow[band] + 20.0));
    assert!(floor[0] > floor[1] + 20.0 && floor[1] > floor[2] + 20.0, "red, green, blue: {floor:?}");
}

#[test]
fn a_screenshot_that_cannot_be_written_is_an_error_and_leaves_nothing() {
    let display = Display::start();
    let folder = tempfile::tempdir().unwrap();
    let shot = folder.path().join("none").join("shot.png");
    let view = format!("view null {SMALL} --frames 1 --screenshot {}", shot.display());
    let (code, out, err) = ran(display.program(&view).output().unwrap());
    assert_eq!((code, out.as_str()), (Some(1), ""), "{err}");
    assert!(err.contains("shot.png") && !folder.path().join("none").exists(), "{err}");
}
