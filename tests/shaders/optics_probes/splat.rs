//! Splat weights: what a splat covers, and that its shares sum to one.
use super::{UNIT_ROUNDOFF, worst};
use crate::common::{Probe, assert_quiet, gpu, random::Random};
use nephroid::{
    gpu::{Blend, Draw, Format, Lifetime, Phase, Plan, Program, Sources, Topology},
    store::Store,
};

/// A sum of up to 17 exponentials, each allowed 3 + 2·2 units in the last place by Vulkan.
const SUM: f64 = (3.0 + 2.0 * 2.0 + 17.0) * UNIT_ROUNDOFF;
const SIDE: i32 = 16;
const DIAMETERS: [f32; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 17.0];

/// Weights of the texels whose centres lie in [p − D/2, p + D/2) and in the map, by the definition.
fn covered(p: f64, diameter: f64) -> Vec<(i32, f64)> {
    let lowered = |c: f64| ((-0.5 * ((c - p) * 4.0 / diameter).powi(2)).exp() - (-2f64).exp()).max(0.0);
    let weight = |c: f64| if diameter == 1.0 { 1.0 } else { lowered(c) };
    let centre = |k: i32| f64::from(k) + 0.5;
    let inside = |k: &i32| centre(*k) >= p - 0.5 * diameter && centre(*k) < p + 0.5 * diameter;
    (0..SIDE).filter(inside).map(|k| (k, weight(centre(k)))).collect()
}

/// Positions on the rasteriser's grid, every 1/256 of a texel about the borders and the middle, and far away.
fn positions() -> Vec<[f32; 2]> {
    let steps = (-12 * 256..(SIDE + 12) * 256).step_by(13).chain(7 * 256..9 * 256).chain(-128..129);
    steps.flat_map(|i| DIAMETERS.map(|d| [i as f32 / 256.0, d])).collect()
}

#[test]
fn the_norm_is_the_sum_over_what_is_covered() {
    let inputs = positions();
    let probe = Probe {
        includes: &["shared/splat.glsl"],
        input: "float p; float diameter;",
        output: "float norm; float shares;",
        body: "r.norm = splat_norm(q.p, q.diameter, 16); r.shares = 0.0;\
               for (int k = 0; k < 16; k++) { float c = float(k) + 0.5;\
                 if (c >= q.p - 0.5 * q.diameter && c < q.p + 0.5 * q.diameter)\
                   r.shares += splat_weight(c, q.p, q.diameter) / r.norm; }",
        ..Default::default()
    };
    let outputs: Vec<[f32; 2]> = probe.run(&gpu(), &inputs);
    let mut empty = 0;
    for ([p, d], [norm, shares]) in inputs.iter().zip(outputs) {
        let expected: f64 = covered(f64::from(*p), f64::from(*d)).iter().map(|(_, w)| w).sum();
        if expected == 0.0 && norm == 0.0 {
            empty += 1;
        } else {
            // Of the window's edge alone so little is left that it is judged beside the whole.
            assert!((f64::from(norm) - expected).abs() <= SUM * expected.max(1.0), "{p} {d}: {norm} for {expected}");
            assert!((f64::from(shares) - 1.0).abs() <= SUM, "{p} {d}: {shares}");
        }
    }
    assert!(empty > 100, "positions beyond the border were meant to be among them");
}

#[test]
fn a_splat_of_one_texel_is_one_and_nonsense_is_nothing() {
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    let rows: [([f32; 2], f32); 7] = [
        ([3.5, 1.0], 1.0),
        ([nan, 3.0], 0.0),
        ([inf, 3.0], 0.0),
        ([-inf, 3.0], 0.0),
        ([1e30, 3.0], 0.0),
        ([-1e30, 1e30], 0.0),
        ([-0.5, 1.0], 0.0),
    ];
    let probe = Probe {
        includes: &["shared/splat.glsl"],
        input: "float p; float diameter;",
        output: "float norm; float one;",
        body: "r.norm = splat_norm(q.p, q.diameter, 16);\
               r.one = splat_weight(3.5, 3.7109375, 1.0) / splat_norm(3.7109375, 1.0, 16);",
        ..Default::default()
    };
    let outputs: Vec<[f32; 2]> = probe.run(&gpu(), &rows.map(|r| r.0));
    for ((input, expected), y) in rows.iter().zip(outputs) {
        assert_eq!(y, [*expected, 1.0], "{input:?}");
    }
}

const POINTS: usize = 600;

/// The rasteriser covers what `splat_norm` sums over: points of every size at random places, borders included.
#[test]
fn rasterised_points_deposit_their_whole_flux() {
    let gpu = gpu();
    let mut random = Random(30);
    let sizes = [1.0f32, 2.0, 3.0, 4.0, 7.0];
    let points: Vec<[f32; 3]> = (0..POINTS)
        .map(|i| [random.within(-0.4, 16.4) as f32, random.within(-0.4, 16.4) as f32, sizes[i % sizes.len()]])
        .collect();
    let head = "#version 460\n#extension GL_GOOGLE_include_directive : require\n\
                #extension GL_EXT_scalar_block_layout : require\n#include \"shared/splat.glsl\"\n";
    let mut sources = Sources::default();
    // Every point has a tile of its own, 32 texels wide with the map's 16 in the middle: nothing is shared, nothing cut.
    sources.replace(
        "probe.vert",
        format!(
            "{head}
        layout(set = 0, binding = 8, scalar) readonly buffer Points {{ vec3 at[]; }} points;
        layout(location = 0) flat out vec2 centre;
        layout(location = 1) flat out float diameter;
        layout(location = 2) flat out vec2 norm;
        void main() {{
            vec3 p = points.at[gl_VertexIndex];
            vec2 local = vec2(splat_snap(p.x), splat_snap(p.y));
            norm = vec2(splat_norm(local.x, p.z, 16), splat_norm(local.y, p.z, 16));
            vec2 tile = vec2(gl_VertexIndex % 32, gl_VertexIndex / 32) * 32.0 + 8.0;
            centre = tile + local;
            diameter = p.z;
            gl_Position = vec4(centre / 512.0 - 1.0, 0.0, 1.0);
            gl_PointSize = p.z;
        }}\n"
        ),
    );
    sources.replace(
        "probe.frag",
        format!(
            "{head}
        layout(location = 0) flat in vec2 centre;
        layout(location = 1) flat in float diameter;
        layout(location = 2) flat in vec2 norm;
        layout(location = 0) out float share;
        void main() {{
            vec2 inside = mod(gl_FragCoord.xy - 8.0, 32.0);
            if (inside.x >= 16.0 || inside.y >= 16.0) discard;
            share = splat_weight(gl_FragCoord.x, centre.x, diameter) / norm.x
                * splat_weight(gl_FragCoord.y, centre.y, diameter) / norm.y;
        }}\n"
        ),
    );
    let mut plan = Plan::default();
    let buffer = plan.upload("points", &points);
    let map = plan.image("map", [1024, 1024], Format::R32f, Lifetime::Frame);
    let pass = plan.pass("probe").read("points", buffer).target(map, 0, Some([0.0; 4]), Blend::Add);
    let draws = vec![Draw { vertices: POINTS as u32, first_vertex: 0, instances: 1, first_instance: 0 }];
    pass.draw(&["probe.vert", "probe.frag"], Topology::Points, draws);
    let mut program = Program::new(&gpu, plan, &sources, &Store::open(), None).expect("prepared");
    program.run(Phase::Frame, &[]).expect("runs");
    let texels: Vec<f32> = bytemuck::pod_collect_to_vec(&program.read_image(map).expect("read"));
    assert_quiet(&gpu);
    let of = |i: usize| {
        let (x, y) = (i % 32 * 32, i / 32 * 32);
        (0..32).flat_map(|row| &texels[(y + row) * 1024 + x..][..32]).map(|t| f64::from(*t)).sum::<f64>()
    };
    let snap = |x: f32| (f64::from(x) * 256.0 + 0.5).floor() / 256.0;
    let mut deposited = 0;
    let error = worst(points.iter().enumerate().map(|(i, [x, y, d])| {
        let some = [x, y].iter().all(|c| !covered(snap(**c), f64::from(*d)).is_empty());
        deposited += usize::from(some);
        (of(i) - f64::from(u8::from(some))).abs()
    }));
    assert!(deposited > POINTS / 2 && deposited < POINTS, "{deposited}");
    assert!(error <= 4.0 * SUM, "{error:e}: two axes, each a quotient of sums");
}
