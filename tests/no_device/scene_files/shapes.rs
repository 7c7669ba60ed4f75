//! Boxes, disks, cylinders, paraboloids and sines: what their keys mean, and each fault with its line, key and remedy.
use glam::{DVec3, dvec3};
use nephroid::scene::{Canonical, Place, Shape, WHOLE};

use super::{BASE, Folder};

/// Rounding of a handful of double-precision operations on numbers of order one.
const ROUNDING: f64 = 1e-12;

/// The base scene with a mirror in the ball's place.
fn with(shape: &str) -> String {
    let text = BASE.replacen("\"glass\"", "\"silver\"", 1);
    text.replace("[objects.ball.sphere]\ncenter = [0, 0, 0]\nradius = 1", shape)
}

const BOX: &str = "[objects.ball.box]\ncenter = [0, 1, 0]\nhalf = [1, 2, 3]\nrotate = [0, 90, 0]";
const DISK: &str = "[objects.ball.disk]\ncenter = [0, 1, 0]\nnormal = [0, 0, 2]\nradius = 2";
const CYLINDER: &str = "[objects.ball.cylinder]\nbase = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 1\nheight = 2\narc = 180\n\
                        middle = [3, 1, 0]";
const PARABOLOID: &str = "[objects.ball.paraboloid]\nvertex = [0, 0, 0]\naxis = [0, 1, 0]\nfocal_length = 0.5\nrim = 1\n\
                          from = 0.2\nmiddle = [1, 0, 0]";

const SINE: &str =
    "[objects.ball.sine]\ncenter = [0, 1, 0]\nu = [2, 0, 0]\nv = [0, 0, -3]\namplitude = 0.1\nwavelength = 0.5";

fn canonical(text: &str) -> (Canonical, impl Fn([f64; 3]) -> DVec3 + use<>) {
    let scene = Folder::new().load(text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let Shape::Canonical { kind, to_world } = scene.objects[0].shape else { panic!("{:?}", scene.objects[0]) };
    (kind, move |p: [f64; 3]| to_world.transform_point3(p.into()))
}

#[track_caller]
fn close(a: DVec3, b: DVec3) {
    assert!((a - b).length() <= ROUNDING, "{a} is not {b}");
}

#[test]
fn shapes_land_where_the_file_puts_them() {
    let (kind, at) = canonical(&with(BOX));
    assert_eq!(kind, Canonical::Box);
    close(at([1.0, 1.0, 0.0]), dvec3(0.0, 3.0, -1.0));
    close(at([0.0, 0.0, 1.0]), dvec3(3.0, 1.0, 0.0));
    let (kind, at) = canonical(&with(DISK));
    assert_eq!(kind, Canonical::Disk);
    close(at([0.0, 0.0, 1.0]) - at([0.0; 3]), dvec3(0.0, 0.0, 2.0));
    assert!((at([0.6, 0.8, 0.0]).z.abs()) <= ROUNDING && (at([0.6, 0.8, 0.0]) - DVec3::Y).length() - 2.0 <= ROUNDING);
    let (kind, at) = canonical(&with(CYLINDER));
    let Canonical::Cylinder { cut } = kind else { panic!("{kind:?}") };
    assert!(cut.abs() < ROUNDING, "a half tube ends at x = 0");
    close(at([1.0, 0.0, 1.0]), dvec3(1.0, 2.0, 0.0));
    let (kind, at) = canonical(&with(PARABOLOID));
    assert_eq!(kind, Canonical::Paraboloid { cut: 0.2 });
    close(at([1.0, 0.0, 1.0]), dvec3(1.0, 0.5, 0.0));
    let (kind, at) = canonical(&with(SINE));
    assert_eq!(kind, Canonical::Sine { wave: 4.0 * std::f64::consts::TAU, phase: 0.0 });
    close(at([1.0, 1.0, 1.0]), dvec3(2.0, 1.1, -3.0));
    let whole = CYLINDER.replace("arc = 180\nmiddle = [3, 1, 0]", "");
    assert_eq!(canonical(&with(&whole)).0, Canonical::Cylinder { cut: WHOLE });
}

#[test]
fn every_key_of_a_shape_can_be_set() {
    for (shape, key, value) in [
        (BOX, "objects.ball.box.half", "[2, 2, 2]"),
        (BOX, "objects.ball.half", "[2, 2, 2]"),
        (DISK, "objects.ball.radius", "3"),
        (CYLINDER, "objects.ball.arc", "90"),
        (PARABOLOID, "objects.ball.paraboloid.rim", "0.5"),
        (SINE, "objects.ball.amplitude", "0.2"),
    ] {
        let (plain, set) =
            (Folder::new().load(with(shape), &[]).unwrap(), Folder::new().load(with(shape), &[(key, value)]).unwrap());
        assert_ne!(format!("{:?}", plain.objects[0].shape), format!("{:?}", set.objects[0].shape), "{key}");
    }
}

/// A shape, one passage of it changed, then the line of the fault, its key, and words of found and remedy.
type Case = (&'static str, &'static str, &'static str, usize, &'static str, &'static str, &'static str);

#[rustfmt::skip]
const CASES: &[Case] = &[
    (BOX, "half = [1, 2, 3]", "half = [1, 0, 3]", 22, "box.half", "0", "correct it"),
    (BOX, "half = [1, 2, 3]", "half = 1", 22, "box.half", "one number", "write `[x, y, z]`"),
    (BOX, "half = [1, 2, 3]", "", 20, "box.half", "none", "add it"),
    (BOX, "center = [0, 1, 0]", "center = [0, nan, 0]", 21, "box.center", "NaN", "correct it"),
    (BOX, "[0, 90, 0]", "[0, 400, 0]", 23, "box.rotate", "400", "a full turn is 360"),
    (BOX, "half = [1, 2, 3]", "hafl = [1, 2, 3]", 22, "box.hafl", "unknown key", "did you mean `half`?"),
    (DISK, "normal = [0, 0, 2]", "normal = [0, 0, 0]", 22, "disk.normal", "[0, 0, 0]", "not zero"),
    (DISK, "radius = 2", "radius = -2", 23, "disk.radius", "-2", "correct it"),
    (DISK, "[objects.ball.disk]", "[objects.ball.disc]", 20, "disc", "unknown key `disc`", "did you mean `disk`?"),
    (DISK, "radius = 2", "radius = 2\n[objects.ball.sphere]\ncenter = [0, 0, 0]\nradius = 1",
        17, "", "sphere and disk", "keep one"),
    (CYLINDER, "axis = [0, 1, 0]", "axis = [0, inf, 0]", 22, "cylinder.axis", "inf", "finite vector"),
    (CYLINDER, "radius = 1", "radius = 0", 23, "cylinder.radius", "0", "correct it"),
    (CYLINDER, "height = 2", "height = 1e300", 24, "cylinder.height", "1e300", "correct it"),
    (CYLINDER, "arc = 180", "arc = 0", 25, "cylinder.arc", "0", "360 makes the whole tube"),
    (CYLINDER, "arc = 180", "arc = 361", 25, "cylinder.arc", "361", "360 makes the whole tube"),
    (CYLINDER, "middle = [3, 1, 0]", "", 20, "cylinder.middle", "none", "add `middle`"),
    (CYLINDER, "middle = [3, 1, 0]", "middle = [0, -1, 0]", 26, "cylinder.middle", "one along it", "turn one"),
    (PARABOLOID, "focal_length = 0.5", "focal_length = 0", 23, "paraboloid.focal_length", "0", "correct it"),
    (PARABOLOID, "rim = 1", "rim = -1", 24, "paraboloid.rim", "-1", "correct it"),
    (PARABOLOID, "from = 0.2", "from = 1", 25, "paraboloid.from", "1", "leave some of the mirror"),
    (PARABOLOID, "middle = [1, 0, 0]", "", 20, "paraboloid.middle", "none", "add `middle`"),
    (SINE, "amplitude = 0.1", "amplitude = 0", 24, "sine.amplitude", "0", "correct it"),
    (SINE, "wavelength = 0.5", "wavelength = 1e-6", 25, "sine.wavelength", "2000000", "make them longer"),
    (SINE, "v = [0, 0, -3]", "v = [1, 0, 0]", 23, "sine.v", "0.000°", "turn one of the two"),
    (SINE, "u = [2, 0, 0]", "", 20, "sine.u", "none", "add it"),
    (PARABOLOID, "vertex = [0, 0, 0]", "vertex = [0, 0]", 21, "paraboloid.vertex", "an array of 2", "write `[x, y, z]`"),
];

#[test]
fn every_fault_of_a_shape_names_line_key_and_remedy() {
    for (shape, from, to, at, key, found, remedy) in CASES {
        assert!(shape.contains(from), "{from}");
        let error = Folder::new().load(with(&shape.replacen(from, to, 1)), &[]).expect_err(to);
        assert_eq!(error.key, format!("objects.ball.{key}").trim_end_matches('.'), "{error}");
        assert!(error.found.contains(found) && error.remedy.contains(remedy), "{error}");
        let Place::File { line, .. } = &*error.place else { panic!("{error}") };
        assert_eq!(line, at, "{error}");
    }
}

#[test]
fn a_shell_of_glass_is_refused_where_its_material_stands() {
    for (shape, name) in [(CYLINDER, "cylinder"), (PARABOLOID, "paraboloid")] {
        let text = with(shape).replacen("\"silver\"", "\"glass\"", 1);
        let error = Folder::new().load(text, &[]).unwrap_err();
        assert_eq!(error.key, "objects.ball.material");
        assert!(error.to_string().contains("scene.toml:18:12"), "{error}");
        assert!(error.expected.contains(name) && error.found.contains("`glass` on an open shell"), "{error}");
        assert!(error.remedy.contains("not built yet"), "{error}");
    }
    for shape in [BOX, DISK, SINE] {
        let text = with(shape).replacen("\"silver\"", "\"glass\"", 1);
        Folder::new().load(text, &[]).unwrap_or_else(|error| panic!("{error}"));
    }
}
