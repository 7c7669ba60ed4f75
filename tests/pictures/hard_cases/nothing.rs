//! Cases in which there is nothing to see: no light, nothing specular, no surface.

use super::{NO_PHOTONS, SILHOUETTE, SIZE, SMALL, balanced, close, dark, main_view, region, with_object};
use crate::common::{
    gpu,
    picture::{job_of, picture, scene},
};
use nephroid::{methods, renderer::Providers, scene::Scene};

#[test]
fn no_light_is_black() {
    let mut scene = scene("glass-sphere", &[]);
    scene.lights.clear();
    let picture = main_view(&gpu(), scene);
    assert!(NO_PHOTONS.iter().all(|stage| !picture.ran(stage)), "{:?}", picture.renderer.stages());
    ["radiance", "direct", "caustic", "irradiance.direct"].iter().for_each(|layer| dark(&picture, layer));
    assert!(picture.layer("mask").contains(&1.0), "the sphere is still seen");
    assert_eq!((picture.account.emitted(), picture.energy.ratio), (0, None));
}

#[test]
fn a_light_without_power_is_no_light() {
    let picture = main_view(&gpu(), scene("glass-sphere", &[("lights.sun.irradiance", "0.0")]));
    assert!(NO_PHOTONS.iter().all(|stage| !picture.ran(stage)));
    dark(&picture, "radiance");
}

#[test]
fn nothing_specular_makes_no_caustic() {
    let picture = main_view(&gpu(), scene("diffuse", &[]));
    assert!(NO_PHOTONS.iter().chain(&["eye/trace"]).all(|stage| !picture.ran(stage)));
    dark(&picture, "caustic");
    dark(&picture, "mask");
    assert_eq!(picture.layer("radiance"), picture.layer("direct"));
    assert!(picture.sum("direct") > 0.0);
}

const EMPTY: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const FLAT: &str = "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n";

fn mesh(text: &str) -> Scene {
    let object = "\n[objects.mesh]\nmaterial = \"glass\"\n[objects.mesh.mesh]\nfile = \"m.obj\"\nfit = 0.5\ncenter = [1.2, 0, 0]\n";
    with_object(object, &[("m.obj", text)])
}

#[test]
fn an_empty_mesh_changes_nothing() {
    let gpu = gpu();
    let (with, without) = (region(&gpu, mesh(EMPTY)), region(&gpu, scene("glass-sphere", &[])));
    assert_eq!(with.account, without.account);
    assert_eq!(with.layers, without.layers);
    // Alone, it is something specular that has no surface.
    let mut alone = mesh(EMPTY);
    alone.objects.retain(|object| object.name != "ball");
    alone.region.receiver = 0;
    alone.extent.receiver = 0;
    let picture = region(&gpu, alone);
    dark(&picture, "caustic");
    assert_eq!((picture.account.emitted(), picture.energy.ratio), (0, None));
}

#[test]
fn a_zero_area_triangle_catches_no_light() {
    let gpu = gpu();
    let mut alone = mesh(FLAT);
    alone.objects.retain(|object| object.name != "ball");
    alone.region.receiver = 0;
    alone.extent.receiver = 0;
    let picture = region(&gpu, alone);
    balanced(&picture);
    dark(&picture, "caustic");
    assert_eq!(picture.account.emitted(), 0);
    // Beside the ball, the ball's light lands as before: the lattice is another, the flux the same.
    let (with, without) = (region(&gpu, mesh(FLAT)), region(&gpu, scene("glass-sphere", &[])));
    balanced(&with);
    close("emitted beside a flat triangle", with.energy.emitted_w, without.energy.emitted_w, 2.0 * SILHOUETTE);
}

#[test]
fn without_a_method_there_is_direct_light_alone() {
    let gpu = gpu();
    let mut job = job_of(scene("glass-sphere", &[]), &SMALL, "region", SIZE);
    let with = picture(&gpu, &job);
    job.providers = Providers { surface: None, medium: None };
    let without = picture(&gpu, &job);
    dark(&without, "caustic");
    assert_eq!(with.layer("direct"), without.layer("direct"));
    assert!(methods::ALL.iter().all(|m| !m.stages().iter().any(|stage| without.ran(stage))));
}
