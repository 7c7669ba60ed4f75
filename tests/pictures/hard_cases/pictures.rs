//! Eyes and pictures at their limits: on surfaces, turned away, one pixel, the narrowest and the widest.

use super::*;
use glam::DVec3;
use nephroid::scene::CameraKind;
use std::f64::consts::PI;

/// A floor of albedo 0.8 in full sun.
const LIT: f64 = 0.8 / PI;

/// `glass-sphere` seen from another place.
fn seen_from(position: DVec3, target: DVec3, kind: CameraKind) -> Scene {
    let mut scene = scene("glass-sphere", &[]);
    let camera = scene.cameras.get_mut("main").unwrap();
    (camera.position, camera.target, camera.kind) = (position, target, kind);
    camera.up = if (target - position).normalize().y.abs() > 0.9 { DVec3::NEG_Z } else { DVec3::Y };
    scene
}

const WIDE: CameraKind = CameraKind::Pinhole { fov_y: 40.0 };

#[test]
fn a_camera_on_the_floor_sees_the_sphere() {
    let picture = main_view(&gpu(), seen_from(DVec3::new(0.0, -1.5, 4.0), DVec3::new(0.0, -0.5, 0.0), WIDE));
    balanced(&picture);
    assert!(picture.layer("mask").contains(&1.0), "the sphere stands before it");
}

#[test]
fn a_camera_on_the_glass_looks_through_it_or_away() {
    let gpu = gpu();
    let inwards = main_view(&gpu, seen_from(DVec3::Z, DVec3::ZERO, WIDE));
    assert!(inwards.layer("mask").iter().all(|m| *m == 1.0), "glass is all that it sees");
    let outwards = main_view(&gpu, seen_from(DVec3::Z, 3.0 * DVec3::Z - DVec3::Y, WIDE));
    dark(&outwards, "mask");
}

#[test]
fn a_sphere_outside_the_picture_leaves_the_floor_as_it_is() {
    let picture = main_view(&gpu(), seen_from(DVec3::new(4.0, 2.0, 0.0), DVec3::new(4.0, -1.5, 0.0), WIDE));
    dark(&picture, "mask");
    close("floor in the sun", picture.sum("direct") / 4096.0, LIT, ROUNDING);
}

#[test]
fn a_sphere_behind_the_camera_still_casts_its_light() {
    let picture = main_view(&gpu(), seen_from(DVec3::new(0.0, -1.2, 0.0), DVec3::new(0.0, -1.5, 0.0), WIDE));
    dark(&picture, "mask");
    dark(&picture, "irradiance.direct");
    assert!(picture.sum("irradiance.caustic") > 4096.0, "it gathers the sun below itself");
}

#[test]
fn a_floor_seen_from_below_is_black() {
    let picture = main_view(&gpu(), seen_from(DVec3::new(0.5, -4.0, 0.5), DVec3::new(0.0, -1.5, 0.0), WIDE));
    ["radiance", "irradiance.caustic", "mask"].iter().for_each(|layer| dark(&picture, layer));
}

/// A parallel eye of half the width sees the middle of what one of the whole width sees, to the bit.
#[test]
fn a_sphere_cut_by_the_picture_is_the_middle_of_the_whole() {
    let gpu = gpu();
    let of = |height: f64, size: u32| {
        let kind = CameraKind::Orthographic { height, width: None };
        let scene = seen_from(DVec3::new(0.0, 4.0, 4.0), DVec3::new(0.0, 0.0, 0.0), kind);
        picture(&gpu, &job_of(scene, &SMALL, "main", [size; 2]))
    };
    let (whole, part) = (of(2.5, 64), of(1.25, 32));
    let off = (0..32 * 32).map(|k| {
        let (x, y) = (k % 32 + 16, k / 32 + 16);
        let (a, b) = (whole.layer("mask")[y * 64 + x], part.layer("mask")[k]);
        f64::from((a - b).abs())
    });
    assert_eq!(crate::common::picture::worst(off), 0.0);
    let direct = |p: &Picture, at: usize| f64::from(p.layer("radiance")[3 * at]);
    let off = (0..32 * 32).filter(|k| {
        let at = (k / 32 + 16) * 64 + k % 32 + 16;
        (direct(&whole, at) - direct(&part, *k)).abs() > 1e-3 * LIT
    });
    // Rays round differently: those that leave the glass along an edge of the floor or of the map may see another side.
    assert!(off.count() <= 32 * 32 / 50);
}

#[test]
fn the_suns_view_may_stand_at_the_pole_or_beside_it() {
    // On both sides of where the view takes another hint for its upright, and on the pole itself.
    let of = |y: f64| {
        let x = (1.0 - y * y).sqrt();
        counted(scene("glass-sphere", &[("lights.sun.direction", &format!("[{x:?}, {:?}, 0.0]", -y))]))
    };
    for y in [1.0, 1.0 - 1e-15, 0.999_000_1, 0.998_999_9] {
        let account = of(y);
        close(&format!("emitted at {y}"), account.emitted_w(), PI, SILHOUETTE);
        assert!(account.counts[1] > account.counts[0] * 9 / 10, "{account:?}");
    }
}

#[test]
fn a_picture_of_one_pixel_and_one_of_one_row_have_the_light_of_all() {
    let gpu = gpu();
    for size in [[1, 1], [257, 1], [1, 257]] {
        let picture = picture(&gpu, &job_of(scene("flat-water", &[]), &SMALL, "region", size));
        // 1 − ((n − 1)/(n + 1))² of index 1.33; the lattice of photons of a single texel.
        let mean = picture.sum("irradiance.caustic") / f64::from(size[0] * size[1]);
        close(&format!("{size:?}"), mean, 1.0 - (0.33f64 / 2.33).powi(2), 0.01);
    }
}

#[test]
fn the_narrowest_and_the_widest_eye_see() {
    let gpu = gpu();
    let of = |height: f64, fov_y: f64| {
        let (position, target) = (DVec3::new(4.0, height - 1.5, 0.0), DVec3::new(4.0, -1.5, 0.0));
        main_view(&gpu, seen_from(position, target, CameraKind::Pinhole { fov_y }))
    };
    close("one spot of the floor", of(3.5, 0.001).sum("direct") / 4096.0, LIT, ROUNDING);
    // A pixel of the widest spans 36 times its height over the floor: of 64 some twenty see it, the others the sky.
    let wide = of(0.01, 179.9);
    let lit = wide.mean("direct").into_iter().filter(|l| (l / LIT - 1.0).abs() <= ROUNDING).count();
    assert!((200..2000).contains(&lit), "{lit} pixels of floor in the sun");
}

#[test]
fn a_caustic_on_the_maps_border_is_in_the_map_or_counted_beside_it() {
    let gpu = gpu();
    let of = |center: &str| {
        let mut beside = scene("glass-sphere", &[("region.center", center)]);
        beside.extent = beside.region.clone();
        let picture = region(&gpu, beside);
        balanced(&picture);
        assert!(picture.account.counts[1] > 0 && picture.account.counts[7] > 0, "{:?}", picture.account.counts);
        picture
    };
    // The border goes through the focus, which the map's margin still takes; from both sides alike.
    let (left, right) = (of("[-1.5, 0.0]"), of("[1.5, 0.0]"));
    close("left and right", left.energy.valid_w, right.energy.valid_w, REGION_FLUX);
    close("seen", left.sum("irradiance.caustic"), right.sum("irradiance.caustic"), REGION_FLUX);
    close(
        "inside and beside",
        left.energy.valid_w + left.account.outside_map_w(),
        right.energy.valid_w + right.account.outside_map_w(),
        REGION_FLUX,
    );
}

#[test]
fn two_floors_at_one_height_are_one() {
    let twin = "\n[objects.floor-twin]\nmaterial = \"white\"\nquad = { center = [0, -1.5, 0], u = [8, 0, 0], v = [0, 0, -8] }\n";
    let gpu = gpu();
    let (one, two) = (main_view(&gpu, scene("glass-sphere", &[])), main_view(&gpu, with_object(twin, &[])));
    assert_eq!(one.layer("irradiance.direct"), two.layer("irradiance.direct"));
    close(
        "arrived",
        two.account.valid_w() + two.account.outside_map_w(),
        one.account.valid_w() + one.account.outside_map_w(),
        ROUNDING,
    );
}
