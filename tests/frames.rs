//! Frames are honest and lean: stages cover the span, recording is cheap, nothing is made, waited for or read inside.

mod common;

use common::{assert_quiet, gpu, job};
use nephroid::{
    gpu::{Gpu, GpuOptions, Phase},
    renderer::{Frame, Renderer},
};

/// Stages beside the frame's span: between passes lie barriers and labels alone.
const COVERED: std::ops::RangeInclusive<f64> = 0.95..=1.02;
/// Recording beside the span, for frames long enough that a scheduler's slice does not decide.
const RECORDING: f64 = 0.05;
/// Frames from here on are long enough, ms.
const LONG_FRAME_MS: f64 = 20.0;

#[test]
fn stages_cover_the_span_and_recording_is_cheap() {
    let gpu = Gpu::new(&GpuOptions::default()).expect("tests need a Vulkan device: run scripts/setup");
    for scene in ["glass-sphere", "bunny"] {
        let mut renderer = long_enough(&gpu, scene);
        let mut covered = Vec::new();
        let mut recorded = Vec::new();
        for _ in 0..5 {
            let times = renderer.frame(&Frame::default()).unwrap();
            assert!(times.passes.iter().all(|&ms| ms > 0.0), "{scene}: {:?}", times.passes);
            covered.push(times.passes.iter().sum::<f64>() / times.span_ms);
            recorded.push(times.record_ms / times.span_ms);
        }
        // The median: another process may take the processor between two timestamps of one frame.
        let (covered, recorded) = (nephroid::stats::median(&covered), nephroid::stats::median(&recorded));
        assert!(COVERED.contains(&covered), "{scene}: stages cover {covered} of the span");
        let span = renderer.frame(&Frame::default()).unwrap().span_ms;
        assert!(recorded <= RECORDING || span < LONG_FRAME_MS, "{scene}: recording takes {recorded} of the span");
    }
}

/// A frame of a scene with as few photons as last long enough, if any number that fits does.
fn long_enough(gpu: &Gpu, scene: &str) -> Renderer {
    let mut sides = ["256", "1024", "4096"].into_iter().peekable();
    loop {
        let side = sides.next().expect("the last one is returned");
        let job = job(scene, &[("light.side", side), ("eye.samples", "2")], "main", [192, 192]);
        let mut renderer = Renderer::new(gpu, &job).unwrap();
        renderer.frame(&Frame::default()).unwrap();
        let span = renderer.frame(&Frame::default()).unwrap().span_ms;
        if span > LONG_FRAME_MS || sides.peek().is_none() {
            println!("{scene}, light.side {side}: {span} ms");
            return renderer;
        }
    }
}

#[test]
fn no_pass_is_charged_for_another() {
    // Ten times the photons, the same picture: the photon pass grows, the eye's passes stay.
    let gpu = Gpu::new(&GpuOptions::default()).expect("tests need a Vulkan device: run scripts/setup");
    let times = |side: &str| {
        let set = [("light.side", side), ("eye.samples", "1")];
        let mut renderer = Renderer::new(&gpu, &job("bunny", &set, "region", [64, 64])).unwrap();
        renderer.frame(&Frame::default()).unwrap();
        let stages = renderer.stages();
        let samples: Vec<_> = (0..5).map(|_| renderer.frame(&Frame::default()).unwrap().passes).collect();
        let median = |name: &str| {
            let at = stages.iter().position(|s| s == name).expect("the stage is there");
            nephroid::stats::median(&samples.iter().map(|s| s[at]).collect::<Vec<_>>())
        };
        (median("light/photons"), median("eye/direct"))
    };
    // A GPU has to be filled before more work costs more.
    let sides = if gpu.info().is_software() { ["64", "512"] } else { ["512", "4096"] };
    let [few, many] = sides.map(times);
    assert!(many.0 > 8.0 * few.0, "64 times the photons: {few:?} -> {many:?} ms");
    assert!(many.0 > 2.0 * many.1, "262,144 photons or more cost more than 4,096 shadow rays: {many:?} ms");
}

#[test]
fn a_frame_submits_once_waits_once_and_makes_nothing() {
    let gpu = gpu();
    let mut renderer = Renderer::new(&gpu, &job("bunny", &[("light.side", "32")], "main", [32, 32])).unwrap();
    renderer.frame(&Frame::default()).unwrap();
    let before = gpu.calls();
    for index in 0..10 {
        renderer.frame(&Frame { index, time: 0.1 * f64::from(index), ..Default::default() }).unwrap();
    }
    let after = gpu.calls();
    assert_eq!((after.allocations, after.pipelines, after.reads), (before.allocations, before.pipelines, before.reads));
    assert_eq!((after.submits - before.submits, after.waits - before.waits), (10, 10), "one each, at the frame's end");
    assert_quiet(&gpu);
}

#[test]
fn the_plan_printed_is_the_list_recorded() {
    let gpu = gpu();
    for scene in ["glass-sphere", "diffuse"] {
        let job = job(scene, &[("light.side", "32")], "main", [32, 32]);
        let planned = nephroid::renderer::plan(&job).unwrap();
        let mut renderer = Renderer::new(&gpu, &job).unwrap();
        assert_eq!(renderer.plan(), &planned.plan);
        let frame: Vec<_> =
            planned.plan.passes.iter().filter(|p| p.phase == Phase::Frame).map(|p| p.name.clone()).collect();
        assert_eq!(renderer.stages(), frame);
        assert_eq!(renderer.frame(&Frame::default()).unwrap().passes.len(), frame.len());
    }
    assert_quiet(&gpu);
}

#[test]
fn what_the_scene_does_not_need_is_not_compiled_allocated_or_recorded() {
    let gpu = gpu();
    let before = gpu.calls();
    let mut renderer = Renderer::new(&gpu, &job("diffuse", &[], "main", [32, 32])).unwrap();
    renderer.frame(&Frame::default()).unwrap();
    let stages = renderer.stages();
    assert_eq!(stages, ["eye/gbuffer", "eye/direct", "eye/compose"]);
    assert_eq!(gpu.calls().pipelines - before.pipelines, stages.len() as u64);
    let names: Vec<_> = gpu.live_allocations().into_iter().map(|(name, _)| name).collect();
    assert!(!names.iter().any(|n| n.starts_with("light/") || n.starts_with("maps/")), "{names:?}");
    for left_out in ["light/photons", "maps/gather", "eye/surface", "eye/trace", "light/account"] {
        let reason = renderer.plan().left_out.iter().find(|l| l.name == left_out);
        assert!(reason.is_some_and(|l| l.reason.contains("specular")), "{left_out}: {reason:?}");
    }
    assert_quiet(&gpu);
}

#[test]
fn a_changed_setting_keeps_what_did_not_change() {
    let gpu = gpu();
    let with = |side: &str| job("bunny", &[("light.side", "64"), ("maps.side", side)], "main", [32, 32]);
    let mut renderer = Renderer::new(&gpu, &with("64")).unwrap();
    renderer.frame(&Frame::default()).unwrap();
    let mut renderer = renderer.replan(&with("128")).unwrap();
    assert_eq!(renderer.reused().made, 3, "the map, its sums, and the view whose margin its side decides");
    assert!(renderer.reused().kept > 10);
    renderer.frame(&Frame::default()).unwrap();
    let kept = renderer.layers().unwrap();
    let mut fresh = Renderer::new(&gpu, &with("128")).unwrap();
    fresh.frame(&Frame::default()).unwrap();
    assert_eq!(kept, fresh.layers().unwrap(), "a re-planned renderer draws what a fresh one does");
    assert_quiet(&gpu);
}
