//! Two thousand frames leave memory as it was. A test binary of its own: resident memory is the whole process's.

mod common;

use common::job;
use nephroid::{
    gpu::{Gpu, GpuOptions},
    renderer::{Frame, Renderer},
};

/// Resident memory may differ by this over 1,900 frames, KiB.
const RESIDENT_SLACK_KIB: u64 = 2048;

#[test]
fn two_thousand_frames_leak_nothing() {
    let gpu = Gpu::new(&GpuOptions::default()).expect("tests need a Vulkan device: run scripts/setup");
    let mut renderer =
        Renderer::new(&gpu, &job("glass-sphere", &[("light.side", "8"), ("maps.side", "16")], "main", [8, 8])).unwrap();
    let mut at_hundred = None;
    for index in 0..2000 {
        renderer.frame(&Frame { index, ..Default::default() }).unwrap();
        if index == 100 {
            at_hundred = Some((gpu.live_allocations(), resident_kib()));
        }
    }
    let (allocations, resident) = at_hundred.expect("frame 100 was rendered");
    assert_eq!(gpu.live_allocations(), allocations);
    let now = resident_kib();
    assert!(now <= resident + RESIDENT_SLACK_KIB, "{resident} KiB at frame 100, {now} KiB at frame 2000");
}

/// Resident memory of this process, KiB.
fn resident_kib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("this test reads /proc");
    let line = status.lines().find(|l| l.starts_with("VmRSS:")).expect("the kernel says how much is resident");
    line.split_whitespace().nth(1).and_then(|v| v.parse().ok()).expect("a number of KiB")
}
