//! Lights many, twice, faint and fierce; photons few.

use super::*;
use crate::common::picture::Pixels;
use glam::DVec3;
use nephroid::{
    scene::{Light, MaterialKind},
    truth::closed::direct_point,
};
use std::f64::consts::PI;

/// Powers of two scale every product and sum without rounding.
#[test]
fn a_faint_and_a_fierce_sun_make_the_same_picture_but_for_their_power() {
    let gpu = gpu();
    let of = |power: i32| {
        let mut scene = scene("glass-sphere", &[]);
        let LightKind::Directional { irradiance, .. } = &mut scene.lights[0].kind else { panic!("no sun") };
        *irradiance = [2f64.powi(power); 3];
        main_view(&gpu, scene)
    };
    let one = of(0);
    for power in [-60, 40] {
        let other = of(power);
        for layer in ["radiance", "irradiance.direct", "irradiance.caustic"] {
            let scaled = other.layer(layer).iter().map(|v| f64::from(*v) * 2f64.powi(-power));
            let off = scaled.zip(one.layer(layer)).map(|(a, b)| a - f64::from(*b));
            assert_eq!(crate::common::picture::worst(off), 0.0, "{layer} of 2^{power}");
        }
    }
}

/// A lamp a metre above the sphere's top, and turned about it.
fn hundred() -> Vec<Light> {
    let place = |k: usize| {
        let angle = k as f64 * 2.4;
        DVec3::new(0.6 * angle.cos(), 2.5 + 0.01 * k as f64, 0.6 * angle.sin())
    };
    let kind = |k: usize| LightKind::Point { position: place(k), intensity: [1.0; 3] };
    (0..100).map(|k| Light { name: format!("lamp{k}"), kind: kind(k) }).collect()
}

/// A ray that passes the sphere this near, m, may be taken for one that meets it: the points of a rasterised picture lie
/// some 2·10⁻⁵ m beside their pixels' centres on GPUs (NVIDIA H200; on lavapipe not).
const TANGENT: f64 = 1e-4;

#[test]
fn a_hundred_lights_are_the_sum_of_each() {
    let mut many = scene("glass-sphere", &[]);
    many.lights = hundred();
    let set = [("light.side", "128"), ("maps.side", "32"), ("eye.samples", "1")];
    let picture = picture(&gpu(), &job_of(many.clone(), &set, "region", [16; 2]));
    balanced(&picture);
    let places: Vec<DVec3> = many.lights.iter().filter_map(|light| light.kind.position()).collect();
    let emitted: f64 = places.iter().map(|p| 2.0 * PI * (1.0 - (1.0 - 1.0 / p.length_squared()).sqrt())).sum();
    // The outline by 128 texels, by all of them alike: measured 3·10⁻³ at 64.
    close("emitted", picture.energy.emitted_w, emitted, 3.0 * SILHOUETTE);
    // Past the sphere, the sum of what each sends there.
    let pixels = Pixels { region: &many.region, size: [16; 2] };
    let beside = |from: DVec3, to: DVec3| {
        let way = (to - from).normalize();
        (from - way * from.dot(way)).length() - 1.0
    };
    let passes = |from: DVec3, to: DVec3| beside(from, to) > 0.0;
    let exact = pixels
        .centres()
        .map(|p| places.iter().filter(|l| passes(**l, p)).map(|l| direct_point(*l, 1.0, p, DVec3::Y)).sum::<f64>());
    let sum: f64 = exact.sum();
    let pairs = pixels.centres().flat_map(|p| places.iter().map(move |l| (*l, p)));
    let doubtful =
        pairs.filter(|(l, p)| beside(*l, *p).abs() < TANGENT).map(|(l, p)| direct_point(l, 1.0, p, DVec3::Y));
    close("direct light", picture.sum("irradiance.direct"), sum, ROUNDING + doubtful.sum::<f64>() / sum);
}

#[test]
fn two_lights_at_one_place_are_one_of_twice_the_power() {
    let gpu = gpu();
    let mut twins = lamp([0.5, 4.0, 0.2], 1.0);
    twins.lights.push(Light { name: "twin".into(), ..twins.lights[0].clone() });
    let (two, one) = (region(&gpu, twins), region(&gpu, lamp([0.5, 4.0, 0.2], 2.0)));
    balanced(&two);
    close("emitted", two.energy.emitted_w, one.energy.emitted_w, 1e-12);
    for layer in ["irradiance.direct", "irradiance.caustic"] {
        let peak = f64::from(one.layer(layer).iter().copied().fold(0.0, f32::max));
        let off = one.layer(layer).iter().zip(two.layer(layer)).map(|(a, b)| f64::from(a - b) / peak);
        assert!(crate::common::picture::worst(off) <= ROUNDING, "{layer}");
    }
}

#[test]
fn black_and_white_floors_send_back_nothing_and_all() {
    let gpu = gpu();
    let of = |albedo: f64| {
        let mut scene = scene("glass-sphere", &[]);
        let white = scene.materials.iter_mut().find(|m| !m.is_specular()).unwrap();
        white.kind = MaterialKind::Diffuse { albedo: [albedo; 3], texture: None };
        region(&gpu, scene)
    };
    let black = of(0.0);
    dark(&black, "radiance");
    assert!(black.sum("irradiance.caustic") > 0.0, "light still arrives");
    let white = of(1.0);
    let (sent, arrived) = (white.sum("radiance"), white.sum("irradiance.caustic") + white.sum("irradiance.direct"));
    close("radiance of a white floor", sent, arrived / PI, ROUNDING);
}

/// The outline of a sphere by few texels: its area errs by no more than texels that it crosses, and mostly far less.
#[test]
fn a_coarse_view_counts_silhouette_texels_whole() {
    let gpu = gpu();
    for (side, text) in [(4, "4"), (16, "16"), (64, "64"), (255, "255")] {
        let set = [("light.side", text), SMALL[1], SMALL[2]];
        let job = job_of(scene("glass-sphere", &[]), &set, "region", SIZE);
        let account = crate::common::picture::account(&gpu, &job);
        let off = account.emitted_w() / PI - 1.0;
        let crossed = 4.0 * f64::from(side) * (2.0 / f64::from(side)).powi(2) / PI;
        println!("{side}: {off:+.4}, of {crossed:.4}");
        assert!(off.abs() <= crossed, "{side}: {off}");
        // Each sample that met the sphere stands for one whole texel.
        close("per photon", account.emitted_w() / account.emitted() as f64, (2.0 / f64::from(side)).powi(2), ROUNDING);
    }
}

#[test]
fn a_scene_of_a_floor_alone_is_evenly_lit() {
    let mut empty = scene("glass-sphere", &[("lights.sun.direction", "[0.6, -0.8, 0.0]")]);
    empty.objects.retain(|object| object.name == "floor");
    empty.region.receiver = 0;
    empty.extent.receiver = 0;
    let picture = region(&gpu(), empty);
    assert!(NO_PHOTONS.iter().all(|stage| !picture.ran(stage)));
    let off = picture.mean("irradiance.direct").into_iter().map(|e| e / 0.8 - 1.0);
    assert!(crate::common::picture::worst(off) <= ROUNDING);
    dark(&picture, "caustic");
}

#[test]
fn spheres_of_a_micrometre_and_of_a_thousand_kilometres_gather_alike() {
    let one = counted(scene("glass-sphere", &[]));
    for (unit, metres) in [("1e-6", 1e-6), ("1e6", 1e6)] {
        let picture = region(&gpu(), scene("glass-sphere", &[("unit", unit)]));
        balanced(&picture);
        close(&format!("emitted at {unit}"), picture.energy.emitted_w, PI * metres * metres, SILHOUETTE);
        close("through", picture.energy.valid_w / (metres * metres), one.valid_w(), SILHOUETTE);
    }
}

#[test]
fn a_micrometre_of_glass_over_metres_of_floor_is_counted() {
    let account = counted(scene("glass-sphere", &[("objects.ball.sphere.radius", "1e-6")]));
    close("emitted", account.emitted_w(), PI * 1e-12, SILHOUETTE);
    // Seen from a metre and a half it is a point; all that it passes goes on to the floor or past its end.
    let arrived = account.valid_w() + account.outside_map_w() + account.flux_w[3];
    close("passed", arrived + account.other_paths_w, account.emitted_w(), 10.0 * SILHOUETTE);
}
