//! Light stays on the receiver it falls on, and no layer of a map shows what another frame left in it.

use super::*;
use nephroid::renderer::{Frame, Renderer};

/// A plaster plate over the caustic's middle, lit by the sun alone: the glass throws no light up to it.
const PLATE: &str = "
[objects.plate]
material = \"white\"
[objects.plate.quad]
center = [2.2, 1.5, 0.0]
u = [0.4, 0.0, 0.0]
v = [0.0, 0.0, -0.4]
";

#[test]
fn a_plate_over_the_floor_shows_none_of_the_floor_s_caustic() {
    let gpu = gpu();
    // The camera region sees the plate before the floor, and the map covers the floor below it.
    let sun = [
        ("direction = [0.0, -1.0, 0.0]", "direction = [1.0, -1.0, 0.0]"),
        ("center = [0.0, 0.0]", "center = [1.5, 0.0]"),
    ];
    let scene = written(&rewritten("glass-sphere", &sun, PLATE), &[]);
    let without = region(&gpu, written(&rewritten("glass-sphere", &sun, ""), &[]));
    let with = region(&gpu, scene);
    let pixel = |x: f64, z: f64| {
        let at = |v: f64| (((v + 1.5) / 3.0) * f64::from(SIZE[0])) as usize;
        at(z) * SIZE[0] as usize + at(x - 1.5)
    };
    let plate = pixel(2.2, 0.0);
    assert!(without.mean("irradiance.caustic")[plate] > 0.05, "the floor below the plate is lit through the glass");
    assert_eq!(with.mean("irradiance.caustic")[plate], 0.0, "the plate is not");
    assert!(with.energy.ratio.is_some_and(|r| (r - 1.0).abs() <= DEPOSITED));
}

#[test]
fn a_light_that_went_out_leaves_nothing_in_a_shared_view() {
    let gpu = gpu();
    let lamps = |second: &str| {
        let more = format!("\n[lights.second.directional]\ndirection = [0.2, -1.0, 0.1]\nirradiance = {second}\n");
        let set = [("light.side", "128"), ("maps.side", "64"), ("light.view", "shared")];
        job_of(written(&rewritten("glass-sphere", &[], &more), &[]), &set, "region", [32, 32])
    };
    let mut renderer = Renderer::new(&gpu, &lamps("1.0")).unwrap();
    renderer.frame(&Frame::default()).unwrap();
    let mut renderer = renderer.replan(&lamps("0.0")).unwrap();
    renderer.frame(&Frame::default()).unwrap();
    let fresh = picture(&gpu, &lamps("0.0"));
    assert_eq!(renderer.layers().unwrap(), fresh.layers);
}

#[test]
fn an_eye_inside_the_glass_sees_glass_in_every_direction() {
    let gpu = gpu();
    // A floor so small that the scene ends where the sphere does.
    let small = [("u = [8.0, 0.0, 0.0]", "u = [1.6, 0.0, 0.0]"), ("v = [0.0, 0.0, -8.0]", "v = [0.0, 0.0, -1.6]")];
    for target in ["[1, 0.1, 0]", "[-1, 0.1, 0]", "[0.1, 1, 0]", "[0.1, -1, 0]", "[0, 0.1, 1]", "[0.5, 1, 0.5]"] {
        let aimed = [
            ("position = [0.0, 4.5, 5.5]", "position = [0.0, 0.0, 0.0]"),
            ("target = [0.0, -0.9, 0.0]", &format!("target = {target}")),
            ("fov_y = 34.0", "fov_y = 60.0"),
        ];
        let replaced: Vec<_> = small.iter().copied().chain(aimed).collect();
        let seen = main_view(&gpu, written(&rewritten("glass-sphere", &replaced, ""), &[]));
        assert!(seen.layer("mask").iter().all(|m| *m == 1.0), "towards {target}");
    }
}

#[test]
fn every_receiver_shows_what_it_would_show_alone() {
    let gpu = gpu();
    // The sun comes in flat: half of what the sphere bends falls on a screen behind it, half on the floor.
    const SCREEN: &str = "
[objects.screen]
material = \"white\"
[objects.screen.quad]
center = [3.0, 0.5, 0.0]
u = [0.0, 0.0, 2.0]
v = [0.0, 2.0, 0.0]
[cameras.screen.orthographic]
position = [-9.0, 0.5, 0.0]
target = [3.0, 0.5, 0.0]
height = 4.0
hides_specular = true
";
    let sun = [("direction = [0.0, -1.0, 0.0]", "direction = [1.0, -0.3, 0.0]")];
    let judged =
        [sun[0], ("receiver = \"floor\"", "receiver = \"screen\""), ("half = [1.5, 1.5]", "half = [2.0, 2.0]")];
    let both = written(&rewritten("glass-sphere", &sun, SCREEN), &[]);
    let alone = written(&rewritten("glass-sphere", &judged, SCREEN), &[]);
    let seen = |scene: &Scene, camera: &str, more: &[(&str, &str)]| {
        let set: Vec<_> = SMALL.iter().chain(more).copied().collect();
        picture(&gpu, &job_of(scene.clone(), &set, camera, SIZE))
    };
    let (one, two) = (seen(&alone, "region", &[]), seen(&both, "screen", &[]));
    assert!(one.sum("irradiance.caustic") > 10.0, "the screen is lit through the glass");
    let apart = one.layer("irradiance.caustic").iter().zip(two.layer("irradiance.caustic"));
    let scale = one.layer("irradiance.caustic").iter().copied().fold(0.0, f32::max);
    let worst = apart.map(|(a, b)| f64::from((a - b).abs() / scale)).fold(0.0, f64::max);
    assert!(worst <= ROUNDING, "the screen's light differs by {worst} of the brightest");
    balanced(&two);
    let region = seen(&both, "screen", &[("maps.receivers", "region")]);
    dark(&region, "irradiance.caustic");
    balanced(&region);
    let lost = region.account.outside_map_w() - two.account.outside_map_w();
    close("what one map holds and the other leaves", two.account.valid_w() - region.account.valid_w(), lost, ROUNDING);
}
