//! Interfaces at their limits: none, thin, shared, overlapping, nested; bending from nothing to total.

use super::*;
use nephroid::{optics::fresnel, scene::MaterialKind};
use std::f64::consts::PI;

/// Indices in float32, and Fresnel's terms of them.
const ONE: f64 = 1e-6;
/// Flux whose edge runs along rows of the light's view: one row of some hundred either way.
const ROW: f64 = 0.01;
/// Light at right angles through a face of index 1.5.
const FACE: f64 = 0.96;

/// A plate of glass 1.4 m wide and as deep, its faces level.
fn plate(middle: f64, half: f64) -> String {
    format!("box = {{ center = [0.0, {middle:?}, 0.0], half = [0.7, {half:?}, 0.7] }}")
}

fn of_index(scene: &mut Scene, index: f64, tint: f64) {
    let glass = scene.materials.iter_mut().find(|m| m.is_specular()).expect("glass");
    glass.kind = MaterialKind::Dielectric { ior: [index; 3], absorption: [tint; 3] };
}

fn above(text: &str, class: &str) -> Scene {
    let mut scene = shaped(text, "", &[]);
    scene.paths = class.parse().unwrap();
    scene
}

#[test]
fn two_plates_that_share_a_face_are_one() {
    let lower = format!("\n[objects.lower]\nmaterial = \"glass\"\n{}\n", plate(-0.3, 0.3));
    let account = counted(shaped(&plate(0.3, 0.3), &lower, &[]));
    close("through both", account.valid_w(), 1.96 * FACE * FACE, SILHOUETTE);
}

/// Surfaces that coincide count as one: here the first plate's lower face, and the second begins as if it were not there
/// until it is left. Between equal indices that is what light does.
#[test]
fn two_materials_of_one_index_that_share_a_face_lose_at_their_outer_faces_alone() {
    let lower = format!(
        "\n[objects.lower]\nmaterial = \"other\"\n{}\n[materials.other.dielectric]\nior = 1.5\n",
        plate(-0.3, 0.3)
    );
    let account = counted(shaped(&plate(0.3, 0.3), &lower, &[]));
    close("through both", account.valid_w(), 1.96 * FACE * FACE, SILHOUETTE);
}

#[test]
fn a_plate_of_a_tenth_of_a_millimetre_has_two_faces() {
    for half in [1e-3, 1e-4, 5e-5] {
        let account = counted(shaped(&plate(0.3, half), "", &[]));
        close(&format!("through {half} m"), account.valid_w(), 1.96 * FACE * FACE, SILHOUETTE);
    }
}

#[test]
fn a_soap_bubble_counts_every_photon() {
    let inner = "\n[objects.inside]\nmaterial = \"air\"\nsphere = { center = [0, 0, 0], radius = 0.99999 }\n\
                 [materials.air.dielectric]\nior = 1.0\n";
    let account = counted(with_object(inner, &[]));
    close("emitted", account.emitted_w(), PI, SILHOUETTE);
    // In, out into the air inside, and on to two more surfaces that transmit-2 does not pass; at the rim, where the skin
    // is seen along, through it.
    assert!(account.counts[6] > account.counts[0] * 98 / 100, "{account:?}");
}

#[test]
fn a_sphere_listed_twice_is_one() {
    let twin = "\n[objects.twin]\nmaterial = \"glass\"\nsphere = { center = [0, 0, 0], radius = 1.0 }\n";
    let (once, twice) = (counted(scene("glass-sphere", &[])), counted(with_object(twin, &[])));
    close("through both", twice.valid_w(), once.valid_w(), ONE);
    close("reflected", twice.other_paths_w, once.other_paths_w, ONE);
}

#[test]
fn two_overlapping_spheres_are_one_body() {
    let second = "\n[objects.second]\nmaterial = \"glass\"\nsphere = { center = [1.0, 0, 0], radius = 1.0 }\n";
    let account = counted(with_object(second, &[]));
    let both = 2.0 * 0.5f64.acos() - 0.5 * 3f64.sqrt();
    close("their outline", account.emitted_w(), 2.0 * PI - both, SILHOUETTE);
    assert!(account.counts[1] > 0 && account.counts[4] == 0, "{account:?}");
}

#[test]
fn a_sphere_half_below_the_floor_lights_the_floor_inside_it() {
    let mut scene = scene("glass-sphere", &[("objects.floor.quad.center", "[0, 0, 0]")]);
    scene.paths = "transmit-1".parse().unwrap();
    let picture = region(&gpu(), scene);
    balanced(&picture);
    // What enters at height sqrt(1 − b²) meets the floor before the lower half.
    let steps = 4000;
    let ring = |k: usize| {
        let b = (k as f64 + 0.5) / f64::from(steps);
        2.0 * PI * b / f64::from(steps) * (1.0 - fresnel((1.0 - b * b).sqrt(), 1.0, 1.5))
    };
    let exact: f64 = (0..steps as usize).map(ring).sum();
    close("on the floor inside", picture.account.valid_w(), exact, SILHOUETTE);
    let seen = picture.mean("irradiance.direct");
    assert_eq!(seen[32 * 64 + 32], 0.0, "the sun itself does not shine there");
}

#[test]
fn a_cube_reflects_totally_what_meets_its_sides_from_within() {
    let mut scene = above("box = { center = [0.0, 0.0, 0.0], half = [1.0, 1.0, 1.0] }", "transmit-2");
    scene.lights[0].kind =
        LightKind::Directional { direction: glam::DVec3::new(1.0, -1.0, 0.0).normalize(), irradiance: [1.0; 3] };
    let account = counted(scene);
    let cosine = 0.5f64.sqrt();
    // In by the top or a side; across the cube it moves on by 2 tan θt, and so that share meets the next face, at 62°.
    let sine = cosine / 1.5;
    let share = sine / (1.0 - sine * sine).sqrt();
    let entered = 2.0 * 4.0 * cosine * (1.0 - fresnel(cosine, 1.0, 1.5));
    close("totally reflected", account.flux_w[2], entered * share, ROW);
}

#[test]
fn a_lamp_in_a_cube_of_diamond_gets_out_by_six_cones() {
    let mut scene = lamp([0.0, 0.0, 0.0], 1.0);
    let cube = above("box = { center = [0.0, 0.0, 0.0], half = [1.0, 1.0, 1.0] }", "transmit-1");
    (scene.objects, scene.paths) = (cube.objects, cube.paths);
    of_index(&mut scene, 2.4, 0.0);
    let account = counted(scene);
    let out = 6.0 * 2.0 * PI * (1.0 - (1.0 - (1.0f64 / 2.4).powi(2)).sqrt());
    close("emitted", account.emitted_w(), 4.0 * PI, ROUNDING);
    close("totally reflected", account.flux_w[2], 4.0 * PI - out, SILHOUETTE);
}

#[test]
fn a_bubble_of_lower_index_reflects_totally_outside_its_critical_angle() {
    let mut scene = scene("glass-sphere", &[]);
    of_index(&mut scene, 0.75, 0.0);
    let account = counted(scene);
    close("totally reflected", account.flux_w[2], PI * (1.0 - 0.75 * 0.75), 2.0 * SILHOUETTE);
}

#[test]
fn an_index_next_to_one_bends_next_to_nothing() {
    let mut scene = scene("glass-sphere", &[]);
    of_index(&mut scene, 1.000_000_1, 0.0);
    let account = counted(scene);
    close("through", account.valid_w(), account.emitted_w(), 1e-4);
    assert!(account.other_paths_w >= 0.0 && account.other_paths_w < 1e-4 * account.emitted_w(), "{account:?}");
}

#[test]
fn ink_takes_all_that_enters() {
    let mut scene = scene("glass-sphere", &[]);
    of_index(&mut scene, 1.5, 1e6);
    let account = counted(scene);
    assert_eq!(account.counts[1], 0, "{account:?}");
    close("absorbed and reflected", account.flux_w[5] + account.other_paths_w, account.emitted_w(), ROUNDING);
    assert!(account.flux_w[5] > 0.9 * account.emitted_w(), "{account:?}");
}

#[test]
fn a_lamp_four_media_deep_meets_the_innermost_first() {
    let mut text = String::new();
    for (k, index) in [1.2, 1.4, 1.6].iter().enumerate() {
        let radius = 0.2 * (k + 1) as f64;
        text +=
            &format!("\n[objects.s{k}]\nmaterial = \"m{k}\"\nsphere = {{ center = [0, 0, 0], radius = {radius:?} }}\n");
        text += &format!("[materials.m{k}.dielectric]\nior = {index}\n");
    }
    let mut scene = with_object(&text, &[]);
    scene.lights[0].kind = LightKind::Point { position: glam::DVec3::ZERO, intensity: [1.0; 3] };
    scene.paths = "transmit-1".parse().unwrap();
    let account = counted(scene);
    close("emitted", account.emitted_w(), 4.0 * PI, ROUNDING);
    let passed = 1.0 - fresnel(1.0, 1.2, 1.4);
    close("past the first surface", account.flux_w[6], 4.0 * PI * passed, ROUNDING);
}

fn mirror(reflectance: f64) -> Scene {
    let mut scene = scene("glass-sphere", &[]);
    let material = scene.objects[0].material;
    scene.materials[material].kind = MaterialKind::Mirror { reflectance: [reflectance; 3] };
    scene.paths = "reflect-1".parse().unwrap();
    scene
}

#[test]
fn a_black_mirror_takes_all() {
    let account = counted(mirror(0.0));
    close("absorbed", account.flux_w[5], account.emitted_w(), ROUNDING);
    assert_eq!(account.counts[1], 0);
}

#[test]
fn a_perfect_mirror_takes_nothing() {
    let account = counted(mirror(1.0));
    assert_eq!((account.flux_w[5], account.other_paths_w), (0.0, 0.0), "{account:?}");
    // Within 45° of the top light goes up, and beyond to the floor or past its end.
    close("to the sky and past the floor", account.flux_w[3] + account.valid_w() + account.flux_w[7], PI, SILHOUETTE);
    assert!(account.flux_w[3] >= 0.5 * PI * (1.0 - SILHOUETTE), "{account:?}");
}

#[test]
fn a_mirror_edge_on_to_the_sun_takes_no_light() {
    let mut scene = shaped("quad = { center = [0, 0, 0], u = [0, 1, 0], v = [0, 0, 1] }", "", &[]);
    let material = scene.objects[0].material;
    scene.materials[material].kind = MaterialKind::Mirror { reflectance: [1.0; 3] };
    scene.paths = "reflect-1".parse().unwrap();
    let picture = region(&gpu(), scene);
    balanced(&picture);
    assert!(picture.energy.emitted_w <= ROUNDING, "{:?}", picture.energy);
    // Nor does it take any from the floor.
    assert!(picture.mean("irradiance.direct").iter().filter(|e| **e > 0.999).count() >= 63 * 64);
}

#[test]
fn a_mirror_on_its_back_sends_all_to_the_sky() {
    let mut scene = shaped("quad = { center = [0, 0, 0], u = [1, 0, 0], v = [0, 0, -1] }", "", &[]);
    let material = scene.objects[0].material;
    scene.materials[material].kind = MaterialKind::Mirror { reflectance: [0.75; 3] };
    scene.paths = "reflect-1".parse().unwrap();
    let account = counted(scene);
    close("emitted", account.emitted_w(), 4.0, ROUNDING);
    close("to the sky", account.flux_w[3], 3.0, ROUNDING);
}
