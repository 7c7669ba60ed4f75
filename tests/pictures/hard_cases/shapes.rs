//! Shapes and views at their limits: a camera in the glass, a sphere on the floor, strong bending, mirrors, receivers edge-on.

use super::{REGION_FLUX, SILHOUETTE, SIZE, SMALL, balanced, close, dark, main_view, region_flux, with_object};
use crate::common::{
    gpu,
    picture::{flux_in_square, job_of, picture, scene},
};
use glam::DVec3;
use nephroid::{
    scene::CameraKind,
    truth::closed::{GlassSphere, Illumination, SphereCaustic},
};
use std::f64::consts::PI;

#[test]
fn a_camera_inside_the_glass_sees_through_it() {
    let gpu = gpu();
    let inside = |ior: &str| {
        let mut scene = scene("glass-sphere", &[("materials.glass.ior", ior)]);
        let camera = scene.cameras.get_mut("main").unwrap();
        camera.kind = CameraKind::Pinhole { fov_y: 40.0 };
        (camera.position, camera.target, camera.up) = (DVec3::new(0.1, 0.2, 0.0), DVec3::NEG_Y, DVec3::NEG_Z);
        main_view(&gpu, scene)
    };
    let picture = inside("1.5");
    assert!(picture.layer("mask").iter().all(|m| *m == 1.0), "glass is all round");
    assert!(picture.sum("caustic") > 0.0);
    // At index 1 what it sees of the floor is what the sun does there, restored by the caustic.
    let picture = inside("1.0");
    let mean = picture.sum("radiance") / f64::from(SIZE[0] * SIZE[1]);
    close("radiance through index 1", mean, 0.8 / PI, 0.01);
}

/// Closed form of the region's flux below a glass sphere, and what Fresnel sends elsewhere.
fn below_sphere(ior: f64, floor: f64) -> (f64, f64) {
    let glass = GlassSphere { radius: 1.0, ior, absorption: 0.0, floor };
    let truth = SphereCaustic::new(glass, Illumination::Parallel { irradiance: 1.0 }).unwrap();
    (flux_in_square(1.5, 0.005, |r| truth.encircled(r)), truth.emitted() - truth.total() - truth.missed())
}

#[test]
fn a_sphere_may_touch_the_floor() {
    let (picture, flux) = region_flux(&gpu(), scene("glass-sphere", &[("objects.floor.quad.center", "[0, -1, 0]")]));
    balanced(&picture);
    close("flux below a sphere on the floor", flux, below_sphere(1.5, 1.0).0, REGION_FLUX);
}

/// Photons that leave along the surface, whose sine rounds to more than one: 4 on an NVIDIA H200, none on lavapipe. They
/// carry next to nothing.
const GRAZING: u64 = 10;

#[test]
fn index_ten_bends_hard_and_loses_nothing() {
    let (picture, flux) = region_flux(&gpu(), scene("glass-sphere", &[("materials.glass.ior", "10.0")]));
    balanced(&picture);
    let (exact, reflected) = below_sphere(10.0, 1.5);
    close("flux below index 10", flux, exact, REGION_FLUX);
    close("reflected by index 10", picture.account.other_paths_w, reflected, SILHOUETTE);
    let total = picture.account.counts[2];
    assert!(total <= GRAZING, "a sphere reflects nothing totally that it let in: {total}");
}

#[test]
fn a_mirror_sphere_casts_its_ring() {
    let mut mirror = scene("glass-sphere", &[]);
    let material = mirror.objects[0].material;
    mirror.materials[material].kind = nephroid::scene::MaterialKind::Mirror { reflectance: [0.9; 3] };
    mirror.paths = "reflect-1".parse().unwrap();
    let (picture, flux) = region_flux(&gpu(), mirror);
    balanced(&picture);
    close("absorbed", picture.account.flux_w[5], 0.1 * PI, SILHOUETTE);
    // A ray that meets the sphere under θ > 45° lands at sin θ + (z + cos θ) tan(180° − 2θ), nearer for larger θ: within
    // a circle lies what meets the sphere beyond its θ, 0.9 π cos²θ.
    let landing = |t: f64| t.sin() + (1.5 + t.cos()) * (PI - 2.0 * t).tan();
    let encircled = |r: f64| {
        let (mut low, mut high) = (PI / 4.0, PI / 2.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if landing(middle) > r { low = middle } else { high = middle }
        }
        0.9 * PI * high.cos().powi(2)
    };
    close("flux of the ring", flux, flux_in_square(1.5, 0.005, encircled), REGION_FLUX);
    let (map, side) = picture.map();
    assert_eq!(map[4 * (side / 2 * side + side / 2)], 0.0, "none below the sphere");
}

/// A tall wall along the sun's light, seen face to face.
const WALL: &str = "\n[objects.wall]\nmaterial = \"white\"\n[objects.wall.quad]\ncenter = [0, 0, -3]\n\
                    u = [4, 0, 0]\nv = [0, 1.5, 0]\n\
                    [cameras.wall.pinhole]\nposition = [0, 0, -2]\ntarget = [0, 0, -3]\nfov_y = 40\n";

#[test]
fn a_receiver_edge_on_to_sun_and_map_is_dark() {
    let gpu = gpu();
    let picture = self::picture(&gpu, &job_of(with_object(WALL, &[]), &SMALL, "wall", SIZE));
    balanced(&picture);
    assert!(picture.energy.deposited_w > 0.0);
    dark(&picture, "radiance");
    dark(&picture, "mask");
}

#[test]
fn a_map_that_sees_its_receiver_edge_on_takes_no_photon() {
    let set = [SMALL[0], SMALL[1], ("light.view", "shared")];
    let grazing = scene("glass-sphere", &[("lights.sun.direction", "[1.0, 0.0, 0.0]")]);
    let picture = picture(&gpu(), &job_of(grazing, &set, "region", SIZE));
    balanced(&picture);
    assert!(picture.account.counts[7] > 0 && picture.account.counts[1] == 0, "{:?}", picture.account.counts);
    dark(&picture, "irradiance.caustic");
}
