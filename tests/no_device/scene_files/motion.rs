//! Motion with one fault each: named by its key, what was found, and what to do.
use glam::DVec3;
use nephroid::scene::LightKind;

use super::{BASE, Folder};

/// Tables added to the base scene, then the key of the fault, and words of found and remedy.
type Case = (&'static str, &'static str, &'static str, &'static str);

#[rustfmt::skip]
const CASES: &[Case] = &[
    // Keys of a track.
    ("[objects.ball.motion]\nposition = []", "objects.ball.motion.position", "none", "add one, such as"),
    ("[objects.ball.motion]\nposition = [{ time = 0 }]", "objects.ball.motion.position.value", "none", "add it"),
    ("[objects.ball.motion]\nposition = [{ value = [0, 0, 0] }]", "objects.ball.motion.position.time", "none", "add it"),
    ("[objects.ball.motion]\nposition = [{ time = 0, value = [0, 0] }]",
        "objects.ball.motion.position.value", "an array of 2", "write `[x, y, z]`"),
    ("[objects.ball.motion]\nposition = [{ time = 0, value = [0, 0, 0], ease = 1 }]",
        "objects.ball.motion.position.ease", "unknown key `ease`", "choose one of"),
    ("[objects.ball.motion]\nposition = [{ time = 1, value = [0, 0, 0] }, { time = 1, value = [1, 0, 0] }]",
        "objects.ball.motion.position.1.time", "1", "sort the keys"),
    ("[objects.ball.motion]\nposition = [{ time = 2, value = [0, 0, 0] }, { time = 1, value = [1, 0, 0] }]",
        "objects.ball.motion.position.1.time", "1", "sort the keys"),
    ("[objects.ball.motion]\nposition = [{ time = nan, value = [0, 0, 0] }]",
        "objects.ball.motion.position.0.time", "NaN", "0 is where a scene begins"),
    ("[objects.ball.motion]\nposition = [{ time = 1e10, value = [0, 0, 0] }]",
        "objects.ball.motion.position.0.time", "1e10", "0 is where a scene begins"),
    ("[objects.ball.motion]\nposition = [{ time = \"soon\", value = [0, 0, 0] }]",
        "objects.ball.motion.position.time", "string \"soon\"", "without quotes"),
    ("[objects.ball.motion]\nposition = [{ time = 0, value = [inf, 0, 0] }]",
        "objects.ball.motion.position.0.value", "inf", ""),
    ("[objects.ball.motion]\nrotate = [{ time = 0, value = [0, 720, 0] }]",
        "objects.ball.motion.rotate.0.value", "720", "a full turn is 360"),
    ("[objects.ball.motion]\nscale = [{ time = 0, value = 0 }]",
        "objects.ball.motion.scale.0.value", "0", "move it away instead"),
    ("[objects.ball.motion]\nscale = [{ time = 0, value = -1 }]",
        "objects.ball.motion.scale.0.value", "-1", "move it away instead"),
    ("[objects.ball.motion]\nscale = [{ time = 0, value = [1, 2, 1] }]", "objects.ball.motion.scale.value", "", ""),
    ("[objects.ball.motion]\nperiod = 0\nscale = [{ time = 0, value = 1 }]",
        "objects.ball.motion.period", "0", "leave it out to move once"),
    ("[objects.ball.motion]\nspin = [{ time = 0, value = 1 }]", "objects.ball.motion.spin", "unknown key `spin`", ""),
    // What does not move, or does not bend.
    ("[objects.floor.motion]\nposition = [{ time = 0, value = [0, 0, 0] }]",
        "objects.floor.motion", "motion of `floor`", "what is judged stands still"),
    ("[objects.ball.motion.twist]\naxis = [0, 1, 0]\nangle = [{ time = 0, value = 5 }]",
        "objects.ball.motion.twist", "its equation makes", "use a mesh of the shape"),
    ("[objects.ball.motion.bend]\nalong = [0, 1, 0]\ntowards = [1, 0, 0]\nangle = [{ time = 0, value = 5 }]",
        "objects.ball.motion.bend", "its equation makes", "use a mesh of the shape"),
    ("[objects.ball.motion.wave]\nalong = [0, 1, 0]\ntowards = [1, 0, 0]\namplitude = [{ time = 0, value = 5 }]\nwavelength = 1",
        "objects.ball.motion.wave", "its equation makes", "use a mesh of the shape"),
    // Deformers of a mesh.
    ("[objects.tri.motion.twist]\naxis = [0, 0, 0]\nangle = [{ time = 0, value = 5 }]",
        "objects.tri.motion.twist.axis", "", ""),
    ("[objects.tri.motion.twist]\naxis = [0, 1, 0]", "objects.tri.motion.twist.angle", "none", "add it"),
    ("[objects.tri.motion.twist]\naxis = [0, 1, 0]\nangle = []", "objects.tri.motion.twist.angle", "none", "add one, such as"),
    ("[objects.tri.motion.twist]\naxis = [0, 1, 0]\nangle = [{ time = 0, value = 1e12 }]",
        "objects.tri.motion.twist.angle.0.value", "1e12", "per length"),
    ("[objects.tri.motion.bend]\nalong = [0, 1, 0]\ntowards = [0, 2, 0]\nangle = [{ time = 0, value = 5 }]",
        "objects.tri.motion.bend.towards", "one along it", "turn one of the two"),
    ("[objects.tri.motion.wave]\nalong = [0, 1, 0]\ntowards = [1, 0, 0]\namplitude = [{ time = 0, value = 5 }]\nwavelength = 0",
        "objects.tri.motion.wave.wavelength", "0", ""),
    // Lights.
    ("[lights.sun.motion]\nposition = [{ time = 0, value = [0, 0, 0] }]",
        "lights.sun.motion.position", "`position`", "a directional light has `direction` and `irradiance`"),
    ("[lights.sun.motion]\nintensity = [{ time = 0, value = 1 }]",
        "lights.sun.motion.intensity", "`intensity`", "a directional light has `direction` and `irradiance`"),
    ("[lights.lamp.motion]\ndirection = [{ time = 0, value = [0, -1, 0] }]",
        "lights.lamp.motion.direction", "`direction`", "a point light has `position` and `intensity`"),
    ("[lights.panel.disk]\ncenter = [0, 3, 0]\nnormal = [0, -1, 0]\nradius = 1\npower = 1\n[lights.panel.motion]\n\
      intensity = [{ time = 0, value = 1 }]",
        "lights.panel.motion.intensity", "`intensity`", "a surface that shines has `position` and `radiance`"),
    ("[lights.lamp.motion]\nintensity = [{ time = 0, value = -1 }]", "lights.lamp.motion.intensity.0.value", "-1", ""),
    ("[lights.sun.motion]\ndirection = [{ time = 0, value = [0, 0, 0] }]", "lights.sun.motion.direction.0.value", "", ""),
    ("[lights.sun.motion]\ndirection = [{ time = 0, value = [0, -1, 0] }, { time = 1, value = [0, 1, 0] }]",
        "lights.sun.motion.direction.1", "its opposite", "put a key between the two"),
];

const MESH: &str =
    "[objects.tri]\nmaterial = \"white\"\n[objects.tri.mesh]\nfile = \"tri.obj\"\nfit = 1\ncenter = [0, 0, 0]\n";

#[test]
fn every_fault_of_a_motion_is_named_by_its_key() {
    let folder = Folder::new();
    folder.write("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let moving = |motion: &str| folder.load(format!("{BASE}\n{MESH}\n{motion}\n"), &[]);
    moving("[objects.ball.motion]\nposition = [{ time = 0, value = [0, 0, 0] }]").expect("motion without a fault");
    for (motion, key, found, remedy) in CASES {
        let error = moving(motion).expect_err(motion);
        assert_eq!(error.key, *key, "{motion}\n{error}");
        assert!(error.found.contains(found) && error.remedy.contains(remedy), "{motion}\n{error}");
        assert!(!error.found.is_empty() && !error.remedy.is_empty(), "{motion}\n{error}");
        assert!(error.to_string().contains("scene.toml:"), "{error}");
    }
}

/// Surfaces that run by themselves.
#[test]
fn a_speed_that_is_none_is_named() {
    let folder = Folder::new();
    let sphere = "[objects.ball.sphere]\ncenter = [0, 0, 0]\nradius = 1";
    let sheet = "center = [0, 0, 0]\nu = [1, 0, 0]\nv = [0, 0, -1]\n";
    let sine = |speed: &str| format!("[objects.ball.sine]\n{sheet}amplitude = 0.1\nwavelength = 1\nspeed = {speed}");
    let wave = |speed: &str| format!("[objects.ball.wave]\n{sheet}speed = {speed}");
    for (shape, key, found) in [
        (sine("inf"), "objects.ball.sine.speed", "inf"),
        (sine("nan"), "objects.ball.sine.speed", "NaN"),
        (sine("1e12"), "objects.ball.sine.speed", "1e12"),
        (wave("1e12"), "objects.ball.wave.speed", "1e12"),
        (wave("nan"), "objects.ball.wave.speed", "NaN"),
    ] {
        let text = BASE.replacen(sphere, &shape, 1);
        assert_ne!(text, BASE, "the base scene has another sphere");
        let error = folder.load(text, &[]).expect_err(&shape);
        assert!(error.key == key && error.found.contains(found), "{error}");
        assert!(error.remedy.contains("0 stands still"), "{error}");
    }
}

/// A surface that shines moves by its centre, a sun with a disc as one without.
#[test]
fn lights_with_a_size_move() {
    let moves = "angular_diameter = 2\n[lights.sun.motion]\nirradiance = [{ time = 0, value = 1 }, { time = 2, value = 3 }]\n\
                 [lights.panel.disk]\ncenter = [0, 3, 0]\nnormal = [0, -1, 0]\nradius = 1\nradiance = 1\n\
                 [lights.panel.motion]\nposition = [{ time = 0, value = [0, 3, 0] }, { time = 2, value = [4, 3, 0] }]\n\
                 radiance = [{ time = 0, value = 1 }, { time = 2, value = [3, 1, 5] }]\n";
    let text = BASE.replacen("irradiance = 1\n", &format!("irradiance = 1\n{moves}"), 1);
    let scene = Folder::new().load(text, &[]).expect("a scene that moves").at(1.0);
    let of = |name: &str| &scene.lights.iter().find(|light| light.name == name).expect(name).kind;
    assert_eq!(of("panel").position(), Some(DVec3::new(2.0, 3.0, 0.0)));
    assert_eq!((of("panel").power(), of("sun").power()), ([2.0, 1.0, 3.0], [2.0; 3]));
    assert!(matches!(of("sun"), LightKind::Sun { radius, .. } if (radius.to_degrees() - 1.0).abs() < 1e-12));
}
