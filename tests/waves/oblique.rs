//! `waves.variant=inverse` under the sun's disc, slanting: against photons of the truth, its noise taken off.

use nephroid::{
    metrics::{self, Correlation, Pair},
    scene::PathClass,
    truth::{Estimator, Goal, Run, Task, trace::Space},
};

use crate::{
    common::{gpu, picture::picture},
    inverse::inverse,
};

/// What issue and page ask: of relMSE, and of energy.
const ERROR: f64 = 1e-3;
const ENERGY: f64 = 5e-3;
/// Standard errors that an estimate may be above what it estimates.
const ERRORS: f64 = 2.0;
const SIZE: [u32; 2] = [16, 16];
/// Photons of each truth: of their noise 1e-4 to 5e-4 remain unknown.
const PHOTONS: u64 = 1_000_000;

const DIRECTION: &str = "scene.lights.sun.directional.direction";
const DISC: (&str, &str) = ("scene.lights.sun.directional.angular_diameter", "0.53");
const AT_30: &str = "[0.5, -0.8660254, 0]";
const AT_60: &str = "[0.8660254, -0.5, 0]";

#[test]
fn it_is_the_truth_under_a_slanting_sun() {
    hold(&[("water", AT_60)]);
}

#[test]
#[ignore = "five truths of a million photons: scripts/test --all"]
fn it_is_the_truth_of_all_waters_under_slanting_suns() {
    hold(&[("water", AT_30), ("scenes/papers/sea.toml", AT_30), ("scenes/papers/sea.toml", AT_60)]);
    hold(&[("sine-water", AT_30), ("sine-water", AT_60)]);
}

fn hold(cases: &[(&str, &str)]) {
    let gpu = gpu();
    for &(scene, sun) in cases {
        let job = inverse(scene, &[(DIRECTION, sun), DISC], "region", SIZE);
        let light = picture(&gpu, &job);
        let task = Task {
            estimator: Estimator::Photons,
            paths: PathClass::Transmit1,
            camera: "region".to_owned(),
            size: SIZE,
            seed: 3,
            goal: Goal { photons: Some(PHOTONS), noise: None },
        };
        let space = Space::new(&job.scene);
        let mut run = Run::new(&space, &job.scene.cameras["region"], &task);
        run.advance(8, |_, _| std::ops::ControlFlow::Continue(()));
        let (layers, about) = (run.layers().expect("pixels"), run.provenance());
        let layer = |layers: &nephroid::image::Layers, name: &str| {
            layers.get(name).expect("a layer").data().iter().map(|v| f64::from(*v)).collect::<Vec<_>>()
        };
        let number = |name: &str| about.get(name).and_then(|text| text.parse().ok());
        let variance = layer(&layers, "irradiance.caustic.variance");
        let [image, truth] = [&light.layers, &layers].map(|layers| layer(layers, "irradiance.caustic"));
        let pair = Pair::new(3, image, truth, Some(variance)).expect("of one size");
        let pair = pair.correlated(Correlation { freedom: number("noise.freedom"), total: number("noise.total") });
        let e0 = metrics::bare_irradiance(&job.scene);
        let (plain, debiased) =
            (metrics::relmse(&pair, e0), metrics::relmse_debiased(&pair, e0).expect("noise is known"));
        let energy = metrics::energy_ratio(&pair);
        let [error, of_energy] = [debiased, energy].map(|m| m.truth_noise.expect("noise is known"));
        println!(
            "{scene} {sun}: {:.1e}, without noise {:.1e} ± {error:.1e}, energy {:.5}",
            plain.value, debiased.value, energy.value
        );
        assert!(error < ERROR / ERRORS, "{scene} {sun}: the truth knows too little: ± {error:e}");
        assert!(debiased.value <= ERROR + ERRORS * error, "{scene} {sun}: {:e} ± {error:e}", debiased.value);
        assert!((energy.value - 1.0).abs() <= ENERGY + ERRORS * of_energy, "{scene} {sun}: {}", energy.value);
    }
}
