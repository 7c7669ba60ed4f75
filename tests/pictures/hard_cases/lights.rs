//! Lights in awkward places: inside the glass, on surfaces, between objects, below and along the floor.

use super::{
    REGION_FLUX, ROUNDING, SILHOUETTE, SIZE, SMALL, balanced, close, dark, lamp, main_view, region, region_flux,
    with_object,
};
use crate::common::{
    gpu,
    picture::{Pixels, job_of, picture, pixels_of_map, scene},
};
use glam::DVec3;
use nephroid::{
    passes::PlanError,
    renderer::{RenderError, plan},
    truth::closed::direct_point,
};
use std::f64::consts::PI;

#[test]
fn a_light_at_the_centre_of_the_glass_shines_straight_through() {
    let mut scene = lamp([0.0, 0.0, 0.0], 3.0);
    scene.paths = "transmit-1".parse().unwrap();
    let picture = region(&gpu(), scene.clone());
    balanced(&picture);
    // Six cube faces, every direction meets the glass from within, perpendicular: 4 % are reflected.
    assert_eq!(picture.account.emitted(), 6 * 256 * 256);
    assert_eq!(picture.account.counts[2], 0, "no total reflection: {:?}", picture.account.counts);
    close("emitted", picture.energy.emitted_w, 4.0 * PI * 3.0, ROUNDING);
    close("reflected", picture.account.other_paths_w, 0.04 * 4.0 * PI * 3.0, ROUNDING);
    dark(&picture, "irradiance.direct");
    let pixels = Pixels { region: &scene.region, size: SIZE };
    let exact: f64 = pixels.centres().map(|p| 0.96 * direct_point(DVec3::ZERO, 3.0, p, DVec3::Y)).sum();
    close("irradiance below", picture.sum("irradiance.caustic"), exact, REGION_FLUX);
}

#[test]
fn a_light_off_centre_inside_the_glass_is_partly_reflected_totally() {
    let mut scene = lamp([0.0, -0.8, 0.0], 1.0);
    scene.paths = "transmit-1".parse().unwrap();
    let picture = region(&gpu(), scene);
    balanced(&picture);
    close("emitted", picture.energy.emitted_w, 4.0 * PI, ROUNDING);
    // Total reflection where 0.8 sin θ > 1/1.5, θ from the axis: a share cos asin(5/6) of all directions.
    let share = (1.0f64 - (5.0f64 / 6.0).powi(2)).sqrt();
    close("totally reflected", picture.account.flux_w[2], 4.0 * PI * share, SILHOUETTE);
    assert!(picture.sum("irradiance.caustic") > 0.0);
    dark(&picture, "irradiance.direct");
}

#[test]
fn a_light_on_the_glass_shines_into_half_of_all_directions() {
    let picture = region(&gpu(), lamp([0.0, 1.0, 0.0], 1.0));
    balanced(&picture);
    close("emitted", picture.energy.emitted_w, 2.0 * PI, SILHOUETTE);
    dark(&picture, "irradiance.direct");
}

#[test]
fn a_light_on_the_floor_lights_nothing_of_it() {
    let picture = region(&gpu(), lamp([0.3, -1.5, 0.2], 1.0));
    balanced(&picture);
    let distance = 0.09 + 2.25 + 0.04;
    close("emitted", picture.energy.emitted_w, 2.0 * PI * (1.0 - (1.0f64 - 1.0 / distance).sqrt()), SILHOUETTE);
    dark(&picture, "irradiance.direct");
    assert_eq!(picture.account.counts[1], 0, "what goes up does not come down: {:?}", picture.account.counts);
}

#[test]
fn a_light_between_two_spheres_shines_on_both() {
    let gpu = gpu();
    let mut scene = lamp([0.0, 2.5, 0.0], 1.0);
    let mut above = scene.objects[0].clone();
    above.name = "above".into();
    above.shape = nephroid::scene::Shape::Sphere { center: DVec3::new(0.0, 5.0, 0.0), radius: 1.0 };
    scene.objects.push(above);
    // The second sphere lies behind the near plane of any one view of the first.
    let job = job_of(scene, &SMALL, "region", SIZE);
    let picture = picture(&gpu, &job);
    balanced(&picture);
    let each = 2.0 * PI * (1.0 - (1.0f64 - 1.0 / 6.25).sqrt());
    close("emitted to both", picture.energy.emitted_w, 2.0 * each, SILHOUETTE);
    assert!(picture.account.counts[1] > 0);
    let shared = job_of((*job.scene).clone(), &[("light.view", "shared")], "region", SIZE);
    let Err(RenderError::Plan(PlanError::Refused { what, remedy, .. })) = plan(&shared) else {
        panic!("no one view holds both")
    };
    assert!(what.contains("lamp") && remedy.contains("light.view=fitted"), "{what}: {remedy}");
}

const CEILING: &str = "\n[objects.ceiling]\nmaterial = \"white\"\n[objects.ceiling.quad]\ncenter = [0, 6, 0]\n\
                       u = [2, 0, 0]\nv = [0, 0, 2]\n[lights.lamp.point]\nposition = [0, 5, 0]\nintensity = 1.0\n";

#[test]
fn an_object_behind_the_light_changes_no_photon() {
    let gpu = gpu();
    let render = |keep: bool| {
        let mut scene = with_object(CEILING, &[]);
        scene.lights.retain(|light| light.name == "lamp");
        if !keep {
            scene.objects.retain(|object| object.name != "ceiling");
            scene.region.receiver = 1;
            scene.extent.receiver = 1;
        }
        region(&gpu, scene)
    };
    let (with, without) = (render(true), render(false));
    balanced(&with);
    assert!(with.account.counts[1] > 0);
    assert_eq!(with.account, without.account);
    assert_eq!(with.map().0, without.map().0);
}

#[test]
fn a_grazing_sun_lights_the_floor_through_the_glass_alone() {
    let (picture, flux) = region_flux(&gpu(), scene("glass-sphere", &[("lights.sun.direction", "[1.0, 0.0, 0.0]")]));
    balanced(&picture);
    dark(&picture, "irradiance.direct");
    close("emitted", picture.energy.emitted_w, PI, SILHOUETTE);
    assert!(flux > 0.0);
    // Both sides of the light's plane get the same.
    let n = pixels_of_map(128) as usize;
    let rows: Vec<f64> = picture.mean("irradiance.caustic").chunks(n).map(|row| row.iter().sum()).collect();
    let half = |rows: &mut dyn Iterator<Item = &f64>| rows.take(n / 2).sum::<f64>();
    close("far side against near side", half(&mut rows.iter()), half(&mut rows.iter().rev()), REGION_FLUX);
}

#[test]
fn a_sun_from_below_is_stopped_by_the_floor() {
    let picture = main_view(&gpu(), scene("glass-sphere", &[("lights.sun.direction", "[0.0, 1.0, 0.0]")]));
    let counts = picture.account.counts;
    assert!(counts[0] > 0 && counts[4] == counts[0], "all blocked: {counts:?}");
    dark(&picture, "radiance");
}

#[test]
fn two_lights_are_the_sum_of_each_alone() {
    let gpu = gpu();
    let lamp = "\n[lights.lamp.point]\nposition = [1.0, 4.0, 0.5]\nintensity = [9.0, 6.0, 3.0]\n";
    for view in ["fitted", "shared"] {
        let of = |names: &[&str]| {
            let mut scene = with_object(lamp, &[]);
            scene.lights.retain(|light| names.contains(&light.name.as_str()));
            picture(&gpu, &job_of(scene, &[SMALL[0], SMALL[1], ("light.view", view)], "region", SIZE))
        };
        let (both, sun, lamp) = (of(&["sun", "lamp"]), of(&["sun"]), of(&["lamp"]));
        balanced(&both);
        let counts = |k: usize| sun.account.counts[k] + lamp.account.counts[k];
        assert!((0..8).all(|k| both.account.counts[k] == counts(k)), "{view}: {:?}", both.account.counts);
        for layer in ["direct", "caustic", "irradiance.direct", "irradiance.caustic"] {
            let alone = sun.layer(layer).iter().zip(lamp.layer(layer)).map(|(a, b)| a + b);
            let peak = both.layer(layer).iter().copied().fold(0.0, f32::max);
            let worst = alone.zip(both.layer(layer)).map(|(a, b)| (a - b).abs() / peak).fold(0.0, f32::max);
            println!("{view} {layer}: {worst:.1e} of the peak");
            assert!(f64::from(worst) <= ROUNDING, "{view}: {layer} differs by {worst} of its peak");
        }
    }
}

/// `glass-sphere` under this in the place of the sun, as TOML.
fn under(light: &str) -> nephroid::scene::Scene {
    scene("glass-sphere", &[("lights.sun", light)])
}

/// Of the power that points of a surface send into half of all directions: texels that straddle its plane.
const HALF_SPACE: f64 = 0.005;

#[test]
fn a_surface_inside_the_glass_shines_out_of_it() {
    let mut scene = under("{ disk = { center = [0, 0, 0], normal = [0, -1, 0], radius = 0.1, power = 3 } }");
    scene.paths = "transmit-1".parse().unwrap();
    let picture = region(&gpu(), scene);
    balanced(&picture);
    close("emitted", picture.energy.emitted_w, 3.0, HALF_SPACE);
    assert_eq!(picture.account.counts[2], 0, "no total reflection so near to the middle: {:?}", picture.account.counts);
    dark(&picture, "irradiance.direct");
}

#[test]
fn a_surface_behind_the_receiver_lights_nothing() {
    let below = under("{ quad = { center = [0, -3, 0], u = [1, 0, 0], v = [0, 0, -1], radiance = 5 } }");
    let picture = region(&gpu(), below);
    balanced(&picture);
    let counts = picture.account.counts;
    assert!(counts[0] > 0 && counts[4] == counts[0], "all blocked: {counts:?}");
    dark(&picture, "irradiance.direct");
}

/// Of 16 directions' cosines the mean is that of half the sky, one half.
const FEW_DIRECTIONS: f64 = 0.02;

#[test]
fn half_the_sky_as_one_sun_is_finite() {
    let picture =
        region(&gpu(), under("{ directional = { direction = [0, -1, 0], irradiance = 1, angular_diameter = 180 } }"));
    balanced(&picture);
    // Each direction sees the ball as large; together they light a plane that faces each twice as much as one overhead.
    close("emitted", picture.energy.emitted_w, 2.0 * PI, FEW_DIRECTIONS);
}
