//! `nephroid budget`: the steps sum to the whole, and each means what it says.

use std::ops::ControlFlow;

use crate::common::{assert_quiet, gpu, job};
use nephroid::{
    gpu::Gpu,
    lab::budget::{Budget, Chain},
    methods::{self, Shown},
    renderer::{self, Frame, Renderer},
    scene::PathClass,
    store::Store,
    truth::{Estimator, Goal, Run, Task, trace::Space},
};

/// One a class of paths: through two surfaces, a mesh, a mirror, water.
const SCENES: [&str; 4] = ["glass-sphere", "bunny", "ring", "water"];
const SIZE: [u32; 2] = [20, 16];
const SIDE: &str = "64";
const PHOTONS: u64 = 60_000;
/// Of sums of four differences of float32 pictures, of E₀ or the pixel.
const ROUNDING: f64 = 1e-5;

const BUDGET: Budget = Budget {
    fine: 160,
    all: PathClass::All(4),
    goal: Goal { photons: Some(PHOTONS), noise: None },
    seconds: f64::INFINITY,
    seed: 0,
};

/// A store that the test's truths are kept in, so that each is made once.
struct Bench {
    gpu: Gpu,
    store: Store,
    _folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        Self { gpu: gpu(), store: Store::at(folder.path()), _folder: folder }
    }

    fn chain(&self, scene: &str, set: &[(&str, &str)], budget: &Budget) -> Chain {
        self.chain_of("maps", scene, set, budget)
    }

    fn chain_of(&self, method: &str, scene: &str, set: &[(&str, &str)], budget: &Budget) -> Chain {
        let settings = [&[("light.side", SIDE), ("maps.side", "32"), ("eye.samples", "2")], set].concat();
        let method = methods::find(method).unwrap();
        let job = job(scene, &settings, "region", SIZE);
        budget.chain(&self.gpu, &job, method, &self.store, &mut |_| ControlFlow::Continue(())).unwrap()
    }
}

/// The names of the steps that differ between two chains, bit by bit, and of the pictures.
fn moved(a: &Chain, b: &Chain) -> Vec<Shown> {
    let pictures = a.shots.iter().zip(&b.shots);
    pictures.filter(|(a, b)| a.irradiance != b.irradiance).map(|(a, _)| a.link.shown).collect()
}

fn step<'c>(chain: &'c Chain, name: &str) -> &'c nephroid::lab::budget::Step {
    chain.steps.iter().find(|step| step.name == name).expect("a step of maps")
}

#[test]
fn the_steps_sum_to_what_the_picture_is_off() {
    let bench = Bench::new();
    for scene in SCENES {
        let chain = bench.chain(scene, &[], &BUDGET);
        let settings = [("light.side", SIDE), ("maps.side", "32"), ("eye.samples", "2")];
        let job = job(scene, &settings, "region", SIZE);
        let mut renderer = Renderer::new(&bench.gpu, &job).unwrap();
        renderer.frame(&Frame::default()).unwrap();
        let picture = renderer.layers().unwrap();
        let picture = picture.get("irradiance.caustic").unwrap().data();
        let (space, camera) = (Space::new(&job.scene), "region".to_owned());
        let Budget { all: paths, goal, seed, .. } = BUDGET;
        let task = Task { estimator: Estimator::Photons, paths, camera, size: SIZE, seed, goal };
        let mut run = Run::new(&space, &job.scene.cameras["region"], &task);
        run.advance(2, |_, _| ControlFlow::Continue(()));
        let truth = run.layers().unwrap();
        let truth = truth.get("irradiance.caustic").unwrap().data();
        assert!(chain.e0 > 0.0);
        for (at, (x, r)) in picture.iter().zip(truth).enumerate() {
            let sum: f64 = chain.steps.iter().map(|step| step.gain[at]).sum();
            let off = f64::from(*x) - f64::from(*r);
            let most = ROUNDING * chain.e0.max(f64::from(x.abs()));
            assert!((sum - off).abs() <= most, "{scene}, value {at}: {sum} for {off}");
        }
        let shares: f64 = chain.steps.iter().filter_map(|step| step.share).sum();
        assert!((shares - 1.0).abs() < ROUNDING, "{scene}: shares sum to {shares}");
    }
    assert_quiet(&bench.gpu);
}

#[test]
fn each_setting_moves_its_step_and_none_before() {
    let bench = Bench::new();
    for scene in SCENES {
        let plain = bench.chain(scene, &[], &BUDGET);
        let with = |key, value| bench.chain(scene, &[(key, value)], &BUDGET);
        assert_eq!(moved(&plain, &with("light.side", "40")), [Shown::AsAsked], "{scene}");
        let wide = with("maps.splat_size", "9");
        assert_eq!(moved(&plain, &wide), [Shown::Fine, Shown::AsAsked], "{scene}");
        let [fine, wider] = [&plain, &wide].map(|chain| step(chain, "reconstruction").relmse.value);
        assert!(wider > 1.5 * fine, "{scene}: a splat three times as wide: {fine} -> {wider}");
        let class = if ["glass-sphere", "bunny"].contains(&scene) { "transmit-1" } else { "transmit-2" };
        let moved_by_class = moved(&plain, &with("light.paths", class));
        assert!(!moved_by_class.contains(&Shown::AllPaths), "{scene}: {moved_by_class:?}");
        assert_eq!(moved_by_class.first(), Some(&Shown::PathClass), "{scene}");
    }
    for scene in ["glass-sphere", "bunny"] {
        let (plain, other) =
            (bench.chain(scene, &[], &BUDGET), bench.chain(scene, &[("light.tracer", "wyman2005")], &BUDGET));
        assert_eq!(moved(&plain, &other), [Shown::Landings, Shown::Fine, Shown::AsAsked], "{scene}");
        let [exact, estimated] = [&plain, &other].map(|chain| step(chain, "tracer").relmse.value);
        assert!(estimated > 2.0 * exact, "{scene}: the estimate's own error: {exact} -> {estimated}");
    }
    assert_quiet(&bench.gpu);
}

/// Figures of other photons lie where the interval of the first says, and theirs: of both intervals at 95 %, on sixteen
/// steps of three seeds, the widest miss stays below this many half widths.
const WIDTHS: f64 = 2.0;

#[test]
fn other_photons_tell_the_same() {
    let bench = Bench::new();
    for scene in SCENES {
        let chains = [0, 1, 2].map(|seed| bench.chain(scene, &[], &Budget { seed, ..BUDGET }));
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            for (x, y) in chains[a].steps.iter().zip(&chains[b].steps) {
                let relmse = [x, y].map(|s| (s.relmse.low.unwrap(), s.relmse.high.unwrap()));
                let energy = [x, y].map(|s| (s.energy.low, s.energy.high));
                for (what, [p, q]) in [("relMSE", relmse), ("energy", energy)] {
                    let [middle, half] = [0.5 * (p.0 + p.1 - q.0 - q.1), 0.5 * (p.1 - p.0).hypot(q.1 - q.0)];
                    assert!(middle.abs() <= WIDTHS * half + 1e-12, "{scene}, {}: {what} {p:?} and {q:?}", x.name);
                }
            }
        }
    }
}

#[test]
fn every_setting_of_light_and_method_has_its_step() {
    for method in methods::ALL {
        let keys: Vec<_> = method.chain().iter().flat_map(|link| link.moved_by).copied().collect();
        let of_light = |key: &str| key.starts_with("light.") && (method.shoots() || method.reads().contains(&key));
        let theirs = |key: &str| of_light(key) || key.starts_with(method.name());
        for setting in renderer::all_settings().iter().filter(|s| theirs(s.key())) {
            let count = keys.iter().filter(|key| **key == setting.key()).count();
            assert_eq!(count, 1, "{} in the chain of {}", setting.key(), method.name());
        }
        assert_eq!(method.chain().first().map(|link| link.shown), Some(Shown::AllPaths));
        assert_eq!(method.chain().last().map(|link| link.shown), Some(Shown::AsAsked));
    }
}

/// Two steps, since no photon is shot; and the scale that fits best, which makes the whole no worse.
#[test]
fn a_picture_right_up_to_a_scale_is_fitted() {
    let bench = Bench::new();
    let chain = bench.chain_of("waves", "water", &[], &BUDGET);
    assert_eq!(chain.steps.iter().map(|step| step.name.as_str()).collect::<Vec<_>>(), ["path class", "variant"]);
    let fitted = chain.fitted.expect("the picture is right only up to a scale");
    assert!(fitted.scale > 0.0 && fitted.relmse.value <= chain.whole.relmse.value, "{fitted:?}");
    assert!(bench.chain("diffuse", &[], &BUDGET).fitted.is_none());
    assert_quiet(&bench.gpu);
}

#[test]
fn without_a_caustic_every_step_is_nothing() {
    let bench = Bench::new();
    let chain = bench.chain("diffuse", &[], &BUDGET);
    assert!(chain.steps.iter().all(|s| s.gain.iter().all(|x| *x == 0.0) && s.share.is_none() && s.relmse.value == 0.0));
    assert_quiet(&bench.gpu);
}
