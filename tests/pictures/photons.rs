//! The photon buffer with all its columns, against the scene in float64.

use crate::common::{assert_quiet, gpu, picture::scene};
use glam::DVec3;
use nephroid::{
    gpu::{Access, BufferId, ImageId, Phase, Plan, Program, Resource, Sources},
    passes::{
        accel::SceneArrays,
        account::{self, Account, AccountRow},
        light::{self, Bench, Column, Tracer, Tracing},
        scene::SceneBuffers,
    },
    renderer::all_settings,
    scene::Scene,
    settings::Settings,
    store::Store,
};

/// Photons a side.
const SIDE: usize = 64;
const ALL: [Column; 4] = [Column::Hit, Column::Flux, Column::Exit, Column::Direction];
/// Coordinates of a few metres in float32, through maps and an intersection.
const ROUNDING: f64 = 2e-6;
/// A component of a direction in float16: eleven significant bits, rounded or cut.
const HALF: f64 = 1.0 / 1024.0;
/// `PHOTON_VALID`.
const VALID: usize = 1;

/// A method's file: takes every photon.
const TAKES_ALL: &str = "bool captured(vec3 p, vec3 n, uint receiver, uint light) { return true; }\n";

struct Traced {
    plan: Plan,
    bytes_each: u64,
    account: BufferId,
}

/// Plans the photons of the scene's one light with these columns, and their account.
fn traced(scene: &Scene, columns: &[Column]) -> Traced {
    let mut settings = Settings::default();
    settings.set(&all_settings(), "light.side", &SIDE.to_string()).unwrap();
    let mut plan = Plan::default();
    let arrays = SceneArrays::build(scene).unwrap();
    let buffers = SceneBuffers::upload(&mut plan, scene, &arrays);
    let emissions = light::emissions(scene, &settings, &scene.region).unwrap();
    assert_eq!(emissions.len(), 1, "one sun, one view");
    let class = light::paths(scene, &settings);
    let photons = light::photon_buffer(&mut plan, &settings, class, columns, None, &light::sides(&emissions)).remove(0);
    let views = plan.upload("light/views", &[emissions[0].view.data()]);
    let (emissions, settings) = (&emissions, &settings);
    let bench = Bench { scene, arrays: &arrays, buffers: &buffers, settings, class, emissions, views, base: "light" };
    let tracer = Tracer::plan(&mut plan, &bench).unwrap();
    let (emission, tracer) = (&emissions[0], &tracer);
    let tracing =
        Tracing { scene: &buffers, views, tracer, class, photons: &photons, emission, index: 0, blocks: None };
    light::photons(&mut plan, "light/photons", &tracing);
    let account = account::account(&mut plan, "light/account", &tracing, &("takes_all.glsl", vec![]));
    Traced { plan, bytes_each: photons.bytes_each(), account }
}

fn column(program: &Program, which: Column) -> Vec<[f64; 4]> {
    let name = format!("light/photons.{}", which.name());
    let Some(Resource::Image(image)) = program.plan().find(&name) else { panic!("no {name}") };
    let image: ImageId = image;
    program.read_image(image).unwrap().chunks_exact(4).map(|t| [0, 1, 2, 3].map(|k| f64::from(t[k]))).collect()
}

fn point(texel: &[f64; 4]) -> DVec3 {
    DVec3::new(texel[0], texel[1], texel[2])
}

#[test]
fn columns_agree_with_the_scene_and_the_account() {
    let (gpu, scene) = (gpu(), scene("glass-sphere", &[]));
    let planned = traced(&scene, &ALL);
    let mut sources = Sources::default();
    sources.replace("takes_all.glsl", TAKES_ALL);
    let mut program = Program::new(&gpu, planned.plan, &sources, &Store::open(), None).unwrap();
    program.run(Phase::Frame, &[]).unwrap();
    program.run(Phase::Account, &[]).unwrap();
    let rows: Vec<AccountRow> = bytemuck::pod_collect_to_vec(&program.read_buffer(planned.account).unwrap());
    let account = Account::of(&rows);
    let [hit, flux, exit, direction] = ALL.map(|c| column(&program, c));
    assert_quiet(&gpu);

    let floor = scene.objects.iter().position(|o| o.name == "floor").unwrap();
    let (mut counts, mut watts) = ([0u64; account::STATUSES], 0.0);
    for k in 0..SIDE * SIDE {
        let (d, status) = (point(&direction[k]), exit[k][3] as usize);
        counts[status] += 1;
        assert_eq!(direction[k][3], exit[k][3], "photon {k}: both columns say how it ended");
        if status != VALID {
            assert_eq!((hit[k], flux[k]), ([0.0; 4], [0.0; 4]), "photon {k} did not arrive");
            continue;
        }
        watts += point(&flux[k]).element_sum() / 3.0;
        let (from, to) = (point(&exit[k]), point(&hit[k]));
        assert!((from.length() - 1.0).abs() <= ROUNDING, "photon {k} leaves the ball at {from}");
        assert!((d.length() - 1.0).abs() <= HALF, "photon {k}: a direction of length {}", d.length());
        assert_eq!(hit[k][3], 1.0 + floor as f64, "photon {k}: receiver");
        assert!((to.y + 1.5).abs() <= ROUNDING, "photon {k} lands at {to}");
        // Each component of the direction is off by HALF at most, over t metres, and so is t, by its own share.
        let t = (-1.5 - from.y) / d.y;
        let error = (from + t * d - to).length();
        assert!(error <= 2.0 * HALF * t / d.y.abs(), "photon {k}: {error} m off after {t} m");
    }
    println!("statuses {counts:?}, account {:?}", account.counts);
    assert!(counts[VALID] > 2000, "a disc in a square: {counts:?}");
    assert_eq!(counts[1..], account.counts[1..]);
    assert_eq!(counts[1..].iter().sum::<u64>(), account.emitted());
    assert!((watts / account.valid_w() - 1.0).abs() <= ROUNDING, "{watts} W for {} W", account.valid_w());
}

#[test]
fn what_is_not_declared_is_not_in_the_plan() {
    let scene = scene("glass-sphere", &[]);
    for (columns, bytes) in [(&ALL[..1], 16), (&ALL[..2], 32), (&ALL[2..3], 16), (&ALL[..], 56)] {
        let Traced { plan, bytes_each, .. } = traced(&scene, columns);
        assert_eq!(bytes_each, bytes, "{columns:?}");
        let images: Vec<_> = plan.images.iter().map(|i| i.name.clone()).collect();
        let names: Vec<_> = columns.iter().map(|c| format!("light/photons.{}", c.name())).collect();
        assert_eq!(images, names);
        assert_eq!(plan.images.iter().map(|i| i.bytes()).sum::<u64>(), bytes * (SIDE * SIDE) as u64);
        let pass = plan.passes.iter().find(|p| p.name == "light/photons").unwrap();
        let written = pass.bindings.iter().filter(|b| b.access == Access::ComputeWrite).count();
        assert_eq!(written, columns.len());
    }
}
