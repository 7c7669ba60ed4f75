//! The memory that a plan states is what is allocated for it, on every shipped scene.

mod common;

use common::{
    assert_quiet, gpu,
    picture::{job_of, scene},
};
use nephroid::{
    gpu::{Gpu, ImageDecl, Plan},
    renderer::{Frame, Job, Renderer},
    scene::Scene,
};

/// Live memory above what the plan states, as a share, for pictures of a usual size: measured 10⁻⁵ at 640 × 480, and 0.03 at
/// 301 × 201, since lavapipe pads rows.
const STATED: f64 = 0.05;
/// Texels that sides of small images are padded to, and bytes beside.
const TILE: u32 = 8;
const PADDING: u64 = 512;

/// The sum of all live allocations of a device, bytes.
fn live(gpu: &Gpu) -> u64 {
    gpu.live_allocations().iter().map(|(_, bytes)| bytes).sum()
}

/// The most that a device may take for what the plan states.
fn padded(plan: &Plan) -> u64 {
    let tiles = |side: u32| u64::from(side.next_multiple_of(TILE));
    let image = |i: &ImageDecl| tiles(i.extent[0]) * tiles(i.extent[1]) * u64::from(i.layers) * i.format.bytes();
    plan.images.iter().map(|i| image(i) + PADDING).sum::<u64>()
        + plan.buffers.iter().map(|b| b.bytes + PADDING).sum::<u64>()
        + plan.staging_bytes() // of scenes that move
}

/// Renders a frame and takes its account; the plan, and bytes that live for it.
fn live_of(gpu: &Gpu, job: &Job) -> (Plan, u64) {
    let before = live(gpu);
    let mut renderer = Renderer::new(gpu, job).unwrap_or_else(|error| panic!("{error}"));
    renderer.frame(&Frame::default()).expect("a frame is rendered");
    renderer.account().expect("photons are counted");
    assert_quiet(gpu);
    (renderer.plan().clone(), live(gpu) - before)
}

#[test]
fn what_a_plan_states_is_what_lives() {
    let gpu = gpu();
    let smallest = [("light.side", "1"), ("maps.side", "16")];
    let odd = [("light.side", "101"), ("maps.side", "99"), ("light.view", "shared")];
    let all = [(&[][..], [640, 480]), (&odd, [301, 201]), (&odd, [33, 17]), (&smallest, [1, 1])];
    for (name, _) in Scene::shipped() {
        for (set, size) in all {
            let (plan, live) = live_of(&gpu, &job_of(scene(name, &[]), set, "main", size));
            let (stated, most) = (plan.bytes(), padded(&plan));
            let off = live as f64 / stated as f64 - 1.0;
            println!("{name} {size:?}: {stated} bytes stated, {live} live, {off:+.5}");
            assert!(live >= stated && live <= most, "{name} {size:?}: {live} bytes live, {stated} to {most} stated");
            assert!(size[0] < 300 || off <= STATED, "{name} {size:?}: {live} bytes live, {stated} stated");
        }
    }
    assert_eq!(live(&gpu), 0, "left when the renderers are gone: {:?}", gpu.live_allocations());
}
