//! Every watt and every photon is accounted for, on every shipped scene.

use crate::common::{
    gpu,
    picture::{Picture, all_ended, job_of, picture, rewritten, scene, written},
};
use glam::DVec3;
use nephroid::{
    gpu::Gpu,
    passes::account::Account,
    scene::{Light, LightKind, PathClass, Scene},
};

/// Flux in the finished map against the flux of the photons it took: float32 sums in texels, weights that sum to one.
const DEPOSITED: f64 = 0.001;
/// Buckets against what was emitted: a photon's own shares are a few float32 products, 64 of them added in float32.
const SUMS: f64 = 1e-5;
/// The picture's flux against the map's: look-ups between texels, which weigh a texel by up to 10⁻³ too much or little
/// where pixels and texels beat, and the map's margin, which the picture does not show.
const PICTURED: f64 = 0.005;

const SIDES: [(&str, &str); 2] = [("light.side", "256"), ("maps.side", "256")];

/// Counts are exact; fluxes to rounding; deposited is what was valid, and nothing where nothing was.
fn judge(name: &str, class: PathClass, picture: &Picture) {
    let Picture { account, energy, .. } = picture;
    let Account { counts, flux_w, other_paths_w, .. } = account;
    all_ended(account, class);
    let sum = flux_w[1..].iter().sum::<f64>() + other_paths_w;
    assert!((sum - flux_w[0]).abs() <= SUMS * flux_w[0], "{name}: {sum} W in buckets, {} W emitted", flux_w[0]);
    assert!(flux_w.iter().chain([other_paths_w]).all(|w| *w >= 0.0), "{name}: {flux_w:?} {other_paths_w}");
    assert_eq!((energy.emitted_w, energy.valid_w), (flux_w[0], flux_w[1]), "{name}");
    match energy.ratio {
        Some(ratio) => assert!((ratio - 1.0).abs() <= DEPOSITED, "{name}: ratio {ratio}"),
        None => assert_eq!((counts[1], energy.deposited_w), (0, 0.0), "{name}: nothing valid, nothing deposited"),
    }
    let ratio = energy.ratio.map_or("none".to_owned(), |r| format!("{:+.2e}", r - 1.0));
    println!("{name}: ratio − 1 {ratio}, sum {:+.1e}, counts {counts:?}", sum / flux_w[0].max(f64::MIN_POSITIVE) - 1.0);
}

/// One scene through both views and every class of paths.
fn all_ways(gpu: &Gpu, name: &str, scene: &Scene) {
    let own = scene.paths.to_string();
    let mut classes = vec!["reflect-1", "transmit-1", "transmit-2", "all:4", &own];
    classes[..4].contains(&&*own).then(|| classes.pop());
    for view in ["fitted", "shared"] {
        for class in classes.iter().copied() {
            let set = [SIDES[0], SIDES[1], ("light.view", view), ("light.paths", class)];
            let picture = picture(gpu, &job_of(scene.clone(), &set, "region", [16, 16]));
            let what = format!("{name} {view} {class}");
            judge(&what, class.parse().expect("a class"), &picture);
            let traces = scene.has_specular();
            assert_eq!(picture.ran("light/photons"), traces, "{what}");
            assert_eq!(picture.account.emitted() > 0, traces, "{what}");
            if own == class {
                assert_eq!(picture.account.counts[1] > 0, traces, "{what}: the scene's own class reaches the region");
            }
        }
    }
}

#[test]
fn shipped_scenes_under_their_own_sun() {
    let gpu = gpu();
    for (name, _) in Scene::shipped() {
        all_ways(&gpu, name, &scene(name, &[]));
    }
}

/// A lamp high above in place of the sun: the buckets then weigh photons by their solid angle.
#[test]
fn shipped_scenes_under_a_point_light() {
    let gpu = gpu();
    for (name, _) in Scene::shipped() {
        let mut scene = scene(name, &[]);
        let lamp = LightKind::Point { position: DVec3::new(0.5, 7.0, 1.0), intensity: [40.0, 30.0, 20.0] };
        scene.lights = vec![Light { name: "lamp".to_owned(), kind: lamp }];
        all_ways(&gpu, &format!("{name}, lamp"), &scene);
    }
}

/// Coloured glass: what it absorbs is in its bucket, band by band, and the picture shows what the map holds.
#[test]
fn coloured_glass_absorbs_what_it_does_not_pass() {
    let gpu = gpu();
    let tint = [("materials.glass.absorption", "[0.1, 0.4, 2.0]")];
    let job = job_of(scene("glass-sphere", &tint), &[SIDES[0], SIDES[1], ("eye.samples", "2")], "region", [251, 251]);
    let picture = picture(&gpu, &job);
    judge("coloured glass", job.scene.paths, &picture);
    assert!(picture.account.flux_w[5] > 0.2 * picture.account.emitted_w(), "{:?}", picture.account);
    let seen = picture.sum("irradiance.caustic") * job.scene.region.area() / (251.0 * 251.0);
    let error = seen / picture.energy.deposited_w - 1.0;
    println!("the picture holds {error:+.5} of the map");
    assert!(error.abs() <= PICTURED, "{seen} W seen, {} W in the map", picture.energy.deposited_w);
    let band = |k: usize| picture.layer("irradiance.caustic").iter().skip(k).step_by(3).sum::<f32>();
    assert!(band(0) > band(1) && band(1) > band(2) && band(2) > 0.0, "red passes best");
}

/// The bunny without the triangles about its `at`th vertex, within a share of its height.
fn bunny_with_a_hole(at: usize, share: f32) -> String {
    let obj = include_str!("../../scenes/bunny-lo.obj");
    let numbers = |line: &str| line.split_whitespace().skip(1).map(|w| w.parse::<f32>().unwrap()).collect::<Vec<_>>();
    let places: Vec<_> = obj.lines().filter(|l| l.starts_with("v ")).map(numbers).collect();
    let heights = || places.iter().map(|p| p[1]);
    let height = heights().fold(f32::MIN, f32::max) - heights().fold(f32::MAX, f32::min);
    let near = |k: usize| (0..3).map(|i| (places[k][i] - places[at][i]).powi(2)).sum::<f32>().sqrt() < share * height;
    let corner = |word: &str| word.split('/').next().unwrap().parse::<usize>().unwrap() - 1;
    let kept = |line: &&str| !line.starts_with("f ") || !line.split_whitespace().skip(1).any(|w| near(corner(w)));
    obj.lines().filter(kept).fold(String::new(), |all, line| all + line + "\n")
}

/// Of the truth's balance: float64 sums over 10⁵ photons; measured 3·10⁻¹³.
const BALANCE: f64 = 1e-10;

/// A hole lets light in and out of the glass without a surface. None of it may be lost from the count, on the device, to
/// the eye or in the truth; and the scene says where the hole is.
#[test]
fn a_bunny_with_a_hole_keeps_its_balance() {
    let gpu = gpu();
    let hole = bunny_with_a_hole(900, 0.2);
    let scene = written(&rewritten("bunny", &[], ""), &[("bunny-lo.obj", &hole)]);
    let [warning] = scene.warnings.as_slice() else { panic!("{:?}", scene.warnings) };
    assert!(warning.contains("`bunny` (bunny-lo.obj) is a dielectric with 1 hole, the largest"), "{warning}");
    println!("{warning}");
    all_ways(&gpu, "open bunny", &scene);
    judge("open bunny, main", scene.paths, &picture(&gpu, &job_of(scene.clone(), &SIDES, "main", [64, 64])));
    let whole = crate::common::picture::scene("bunny", &[]);
    assert_eq!(whole.warnings, Vec::<String>::new());
    let space = nephroid::truth::trace::Space::new(&scene);
    for class in [scene.paths, nephroid::scene::PathClass::All(8)] {
        let balance = nephroid::truth::light::Photons::new(&space, class, 1, 100_000).chunk(0, |_| ());
        let lost = (balance.spent() - balance.emitted).abs().max_element() / balance.emitted.max_element();
        println!("truth, {class}: {lost:.1e} of the light is not in a count");
        assert!(balance.landed.x > 0.0 && lost <= BALANCE, "{class}: {balance:?}");
    }
}
