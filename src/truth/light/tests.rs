use super::*;
use crate::scene::Scene;

/// Roundings of float64 added up over some 10⁴ photons.
const ROUNDING: f64 = 1e-10;

/// A glass sphere in a closed box of diffuse walls, the light 3 m above its centre.
const BOX: &str = r#"
version = 1
title = "box"
unit = 1.0
paths = "transmit-2"
exposure = 0.0
[region]
receiver = "floor"
center = [0.0, 0.0]
half = [1.0, 1.0]
[cameras.main.pinhole]
position = [0.0, 3.0, 3.0]
target = [0.0, 0.0, 0.0]
fov_y = 40.0
[objects.ball]
material = "glass"
visible_to_camera = true
sphere = { center = [0.0, 0.0, 0.0], radius = 1.0 }
[objects.floor]
material = "white"
quad = { center = [0.0, -4.0, 0.0], u = [4.0, 0.0, 0.0], v = [0.0, 0.0, -4.0] }
[objects.roof]
material = "white"
quad = { center = [0.0, 4.0, 0.0], u = [4.0, 0.0, 0.0], v = [0.0, 0.0, 4.0] }
[objects.left]
material = "white"
quad = { center = [-4.0, 0.0, 0.0], u = [0.0, 4.0, 0.0], v = [0.0, 0.0, 4.0] }
[objects.right]
material = "white"
quad = { center = [4.0, 0.0, 0.0], u = [0.0, 4.0, 0.0], v = [0.0, 0.0, -4.0] }
[objects.back]
material = "white"
quad = { center = [0.0, 0.0, -4.0], u = [4.0, 0.0, 0.0], v = [0.0, 4.0, 0.0] }
[objects.front]
material = "white"
quad = { center = [0.0, 0.0, 4.0], u = [-4.0, 0.0, 0.0], v = [0.0, 4.0, 0.0] }
[materials.glass.dielectric]
ior = 1.5
absorption = 0.0
[materials.white.diffuse]
albedo = 0.5
[lights.lamp.point]
position = [0.0, 3.0, 0.0]
intensity = 1.0
"#;

/// A cube without its lid.
const OPEN_CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 -1 1\nv -1 -1 1\nv -1 1 -1\nv 1 1 -1\nv 1 1 1\nv -1 1 1\n\
                         f 1 2 3 4\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

fn load(text: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("box.toml");
    std::fs::write(folder.path().join("open.obj"), OPEN_CUBE).unwrap();
    std::fs::write(&file, text).unwrap();
    Scene::load(file.to_str().unwrap(), &[]).unwrap()
}

fn flux(scene: &Scene, class: PathClass, count: u64) -> (Balance, Vec<Landing>) {
    let space = Space::new(scene);
    let mut landings = vec![];
    let balance = Photons::new(&space, class, 1, count).chunk(0, |l| landings.push(*l));
    (balance, landings)
}

#[test]
fn classes_part_the_light_of_every_photon() {
    let scene = load(BOX);
    let (whole, landings) = flux(&scene, PathClass::All(8), 4096);
    let of = |class: PathClass| landings.iter().filter(move |l| l.chain.is_of(class));
    for class in [PathClass::Reflect1, PathClass::Transmit2] {
        let (_, alone) = flux(&scene, class, 4096);
        let among: Vec<_> = of(class).collect();
        assert_eq!(alone.len(), among.len(), "{class}");
        for (a, b) in alone.iter().zip(among) {
            assert!(a.surface.p == b.surface.p && a.flux == b.flux, "{class}: {a:?} against {b:?}");
        }
    }
    let part = |class| of(class).map(|l| l.flux.x).sum::<f64>();
    let rest: f64 = landings
        .iter()
        .filter(|l| l.chain.len() > 2 || l.chain.len() == 2 && !l.chain.is_of(PathClass::Transmit2))
        .map(|l| l.flux.x)
        .sum();
    let sum = part(PathClass::Reflect1) + part(PathClass::Transmit2) + rest;
    assert!((sum / whole.landed.x - 1.0).abs() < ROUNDING, "{sum} of {}", whole.landed.x);
}

#[test]
fn nothing_is_lost_in_a_closed_box() {
    let scene = load(BOX);
    for class in [PathClass::Reflect1, PathClass::Transmit2, PathClass::All(3)] {
        let (balance, landings) = flux(&scene, class, 16384);
        let (spent, emitted) = (balance.spent().x, balance.emitted.x);
        assert!((spent / emitted - 1.0).abs() < ROUNDING, "{class}: {spent} of {emitted}");
        assert_eq!(balance.missed, DVec3::ZERO, "{class}");
        let landed: f64 = landings.iter().map(|l| l.flux.x).sum();
        assert!((landed / balance.landed.x - 1.0).abs() < ROUNDING);
    }
}

/// The lamp and a mirror ball under coloured water: what lands has been in water all the way, whatever it met first.
#[test]
fn light_starts_in_the_medium_about_it() {
    let water = "[objects.water]\nmaterial = \"water\"\nvisible_to_camera = true\nquad = { center = [0.0, 3.5, 0.0], \
                 u = [4.0, 0.0, 0.0], v = [0.0, 0.0, -4.0] }\n[materials.water.dielectric]\nior = 1.33\n\
                 absorption = [0.0, 0.1, 0.5]\n[materials.white";
    let scene =
        load(&BOX.replace("material = \"glass\"", "material = \"silver\"").replace("[materials.white", water).replace(
            "[materials.glass.dielectric]\nior = 1.5\nabsorption = 0.0",
            "[materials.silver.mirror]\nreflectance = 1.0",
        ));
    let (balance, landings) = flux(&scene, PathClass::Reflect1, 16384);
    let from_the_ball = landings.iter().filter_map(|l| {
        let back = l.surface.p.dot(l.d);
        let half = (1.0 - (l.surface.p.length_squared() - back * back)).sqrt();
        (half >= 0.0).then_some((l, back - half))
    });
    let mut seen = 0;
    for (landing, after) in from_the_ball {
        let bounce = landing.surface.p - after * landing.d;
        let metres = after + (bounce - DVec3::new(0.0, 3.0, 0.0)).length();
        let left = landing.flux / landing.flux.x;
        let expected = DVec3::new(0.0, -0.1 * metres, -0.5 * metres).exp();
        assert!((left - expected).length() < ROUNDING, "{left} after {metres} m, not {expected}");
        seen += 1;
    }
    assert!(seen > 100 && balance.absorbed.z > balance.absorbed.y, "{seen} from the ball");
}

#[test]
fn hard_cases_are_finite_and_the_same_twice() {
    let inside = BOX.replace("position = [0.0, 3.0, 0.0]", "position = [0.2, 0.9, 0.0]");
    let on_the_axis = BOX.replace("position = [0.0, 3.0, 0.0]", "position = [0.0, 0.0, 0.0]");
    let touching = BOX.replace("position = [0.0, 3.0, 0.0]", "position = [0.0, 1.0, 0.0]");
    let ball = "sphere = { center = [0.0, 0.0, 0.0], radius = 1.0 }";
    let twin = format!("[objects.twin]\nmaterial = \"glass\"\nvisible_to_camera = true\n{ball}\n[objects.floor]");
    let coincident = BOX.replace("[objects.floor]", &twin);
    let mirrors = BOX
        .replace(
            "material = \"white\"\nquad = { center = [0.0, -4.0",
            "material = \"silver\"\nquad = { center = [0.0, -4.0",
        )
        .replace(
            "material = \"white\"\nquad = { center = [0.0, 4.0",
            "material = \"silver\"\nquad = { center = [0.0, 4.0",
        )
        .replace("receiver = \"floor\"", "receiver = \"back\"")
        .replace("[materials.white", "[materials.silver.mirror]\nreflectance = 1.0\n[materials.white");
    // A lid of a cube, gone: light goes in without meeting glass, and comes out of it.
    let open = BOX.replace(
        ball,
        "mesh = { file = \"open.obj\", fit = 1.5, center = [0.0, -0.75, 0.0], rotate = [0.0, 0.0, 0.0] }",
    );
    let tiny = BOX.replace("unit = 1.0", "unit = 1e-3");
    let huge = BOX.replace("unit = 1.0", "unit = 1e3");
    for (name, text) in [
        ("inside", inside),
        ("centre", on_the_axis),
        ("touching", touching),
        ("coincident", coincident),
        ("mirrors", mirrors),
        ("open mesh", open),
        ("tiny", tiny),
        ("huge", huge),
    ] {
        let scene = load(&text);
        let (a, first) = flux(&scene, PathClass::All(8), 4096);
        let (b, second) = flux(&scene, PathClass::All(8), 4096);
        assert!(first.iter().all(|l| l.surface.p.is_finite() && l.flux.is_finite() && l.normal.is_finite()), "{name}");
        assert!(a.emitted.x > 0.0 && a.spent() == b.spent() && first.len() == second.len(), "{name}");
        let kept = a.spent().x / a.emitted.x;
        assert!((kept - 1.0).abs() < ROUNDING, "{name}: {kept} of the light is accounted for");
    }
}

/// The classes' flux over the box, by 65 536 points of the R2 sequence.
const CLASS_FLUX: f64 = 1e-4;

#[test]
fn each_class_brings_to_the_box_what_the_sphere_passes() {
    let scene = load(BOX);
    // A lamp at 3 radii: evenly in cosα over the cone of sinα < 1/3, sinθ = 3 sinα.
    let lowest = (1.0f64 - 1.0 / 9.0).sqrt();
    let (steps, mut emitted, mut reflected, mut through) = (1_000_000, 0.0, 0.0, 0.0);
    for k in 0..steps {
        let cosine = lowest + (1.0 - lowest) * (f64::from(k) + 0.5) / f64::from(steps);
        let sine2 = 9.0 * (1.0 - cosine * cosine);
        let f = crate::optics::fresnel((1.0 - sine2).sqrt(), 1.0, 1.5);
        let ring = std::f64::consts::TAU * (1.0 - lowest) / f64::from(steps);
        emitted += ring;
        reflected += ring * f;
        through += ring * (1.0 - f) * (1.0 - f);
    }
    for (class, exact) in [
        (PathClass::Reflect1, reflected),
        (PathClass::Transmit2, through),
        // Of what enters, F·(1 − F) leaves at the third event and F²·(1 − F) at the fourth: nearly all has left.
        (PathClass::All(64), emitted),
    ] {
        let (balance, _) = flux(&scene, class, 65_536);
        let off = balance.landed.x / exact - 1.0;
        assert!(off.abs() < CLASS_FLUX, "{class}: {} against {exact}, off {off:.1e}", balance.landed.x);
    }
}
