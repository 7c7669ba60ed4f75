//! The device floor: a compute pass on any device, and errors that name both sides.

use crate::common::{Probe, assert_quiet, gpu};
use nephroid::{
    gpu::{Blend, DeviceChoice, Format, Gpu, GpuError, GpuOptions, Lifetime, Phase, Plan, Program, Sources},
    store::Store,
};

fn prepare(gpu: &Gpu, plan: Plan, sources: &Sources, old: Option<Program>) -> Result<Program, GpuError> {
    Program::new(gpu, plan, sources, &Store::open(), old.as_ref())
}

const HEAD: &str = "#version 460\n#extension GL_EXT_scalar_block_layout : require\n";

#[test]
fn a_compute_pass_doubles_every_number() {
    let gpu = gpu();
    let inputs: Vec<f32> = (0..1000).map(|i| i as f32).collect();
    let outputs: Vec<f32> = Probe { body: "r.y = 2.0 * q.x;", ..Default::default() }.run(&gpu, &inputs);
    assert!(outputs.iter().zip(&inputs).all(|(y, x)| *y == 2.0 * x));
}

#[test]
fn passes_wait_for_each_other_and_are_timed() {
    let gpu = gpu();
    let mut sources = Sources::default();
    sources
        .replace("fill.frag", format!("{HEAD}layout(location = 0) out vec4 o;\nvoid main() {{ o = vec4(0.25); }}\n"));
    sources.replace(
        "sum.comp",
        format!(
            "{HEAD}layout(local_size_x = 64) in;\nlayout(set = 0, binding = 0) uniform sampler2D picture;\n\
             layout(set = 0, binding = 1, scalar) buffer Sums {{ float at[]; }} sums;\n\
             void main() {{ uint x = gl_GlobalInvocationID.x; if (x >= 64) return; float s = 0;\n\
             for (int y = 0; y < 64; ++y) s += texelFetch(picture, ivec2(x, y), 0).r; sums.at[x] = s; }}\n"
        ),
    );
    let mut plan = Plan::default();
    let picture = plan.image("picture", [64, 64], Format::Rgba32f, Lifetime::Frame);
    let sums = plan.buffer("sums", 256, Lifetime::Frame);
    for _ in 0..3 {
        plan.pass("test/fill").target(picture, 0, None, Blend::Add).screen("fill.frag");
    }
    if let nephroid::gpu::Work::Raster { targets, .. } = &mut plan.passes[0].work {
        targets[0].clear = Some([0.0; 4]);
    }
    plan.pass("test/sum").fetch("picture", picture).write("sums", sums).dispatch("sum.comp", [1, 1, 1], 64);
    let mut program = prepare(&gpu, plan, &sources, None).unwrap();
    for _ in 0..3 {
        let times = program.run(Phase::Frame, &[]).unwrap();
        assert_eq!(times.passes.len(), 4);
        assert!(times.passes.iter().all(|t| *t > 0.0) && times.span_ms >= times.passes.iter().sum::<f64>());
        let sums: Vec<f32> = bytemuck::pod_collect_to_vec(&program.read_buffer(sums).unwrap());
        assert!(sums.iter().all(|s| *s == 0.75 * 64.0), "three additions of a quarter in 64 rows: {sums:?}");
    }
    let counters = program.count(Phase::Frame, &[]).unwrap();
    assert_eq!(counters[1].1.fragments, Some(64 * 64));
    assert_eq!(counters[3].1.invocations, Some(64));
    assert_quiet(&gpu);
}

#[test]
fn a_binding_that_one_side_lacks_is_an_error_naming_both() {
    let gpu = gpu();
    let mut sources = Sources::default();
    sources.replace(
        "a.comp",
        format!(
            "{HEAD}layout(local_size_x = 64) in;\n\
             layout(set = 0, binding = 3, scalar) buffer B {{ float at[]; }} wanted;\n\
             void main() {{ wanted.at[0] = 1.0; }}\n"
        ),
    );
    let mut plan = Plan::default();
    let buffer = plan.buffer("b", 64, Lifetime::Frame);
    plan.pass("test/names").write("offered", buffer).dispatch("a.comp", [1, 1, 1], 64);
    let text = prepare(&gpu, plan, &sources, None).err().expect("names differ").to_string();
    for part in ["test/names", "'wanted'", "'offered'"] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn shader_errors_carry_file_and_line() {
    let gpu = gpu();
    let mut sources = Sources::default();
    sources.replace("shared/broken.glsl", "float f() {\n  return missing;\n}\n");
    sources.replace(
        "b.comp",
        "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"shared/broken.glsl\"\nvoid main() {}\n",
    );
    let mut plan = Plan::default();
    plan.pass("test/broken").dispatch("b.comp", [1, 1, 1], 64);
    let text = prepare(&gpu, plan, &sources, None).err().expect("it cannot compile").to_string();
    assert!(text.contains("shared/broken.glsl:2"), "{text}");
}

#[test]
fn devices_are_found_by_index_name_and_uuid_or_refused() {
    let best = gpu();
    let info = best.info().clone();
    let part = info.name.split_whitespace().next().unwrap().to_uppercase();
    for asked in [info.index.to_string(), part, info.uuid.clone()] {
        let options = GpuOptions { device: DeviceChoice::Named(asked.clone()), ..Default::default() };
        assert_eq!(Gpu::new(&options).expect(&asked).info().uuid, info.uuid);
    }
    for asked in ["99", "no such device", ""] {
        let options = GpuOptions { device: DeviceChoice::Named(asked.into()), ..Default::default() };
        let text = Gpu::new(&options).err().expect("refused").to_string();
        assert!(text.contains(&info.name), "{text}");
    }
}

#[test]
fn a_replanned_program_keeps_what_did_not_change() {
    let gpu = gpu();
    let plan = |side| {
        let mut plan = Plan::default();
        plan.upload("kept", &[1.0f32; 64]);
        plan.image("changed", [side, side], Format::R32f, Lifetime::Frame);
        plan
    };
    let first = prepare(&gpu, plan(16), &Sources::default(), None).unwrap();
    let second = prepare(&gpu, plan(32), &Sources::default(), Some(first)).unwrap();
    assert_eq!((second.reused().kept, second.reused().made), (1, 1));
    drop(second);
    assert!(gpu.live_allocations().is_empty(), "{:?}", gpu.live_allocations());
    assert_quiet(&gpu);
}

#[test]
fn an_image_beyond_the_device_is_refused_by_name() {
    let gpu = gpu();
    let mut plan = Plan::default();
    plan.image("light/photons.hit", [1 << 20, 4], Format::Rgba32f, Lifetime::Frame);
    let text = prepare(&gpu, plan, &Sources::default(), None).err().expect("too large").to_string();
    assert!(text.contains("light/photons.hit"), "{text}");
}

#[test]
fn a_plan_beyond_the_device_s_memory_is_refused_before_anything_is_allocated() {
    let gpu = gpu();
    let side = gpu.info().max_image_side;
    let each = u64::from(side) * u64::from(side) * 16;
    let mut plan = Plan::default();
    for k in 0..=gpu.info().memory_bytes / each {
        plan.image(&format!("large/{k}"), [side, side], Format::Rgba32f, Lifetime::Frame);
    }
    let text = prepare(&gpu, plan, &Sources::default(), None).err().expect("too large").to_string();
    assert!(text.contains("large/") && text.contains("light.side"), "{text}");
    assert!(gpu.live_allocations().is_empty());
    assert_quiet(&gpu);
}
