//! The window's tone map is that of the pictures in files.

use nephroid::image::tone_map;

use crate::common::{Probe, gpu};

/// The greatest difference in steps of 8 bits: float32 against float64 moves a value across a rounding edge at most.
const STEPS: u8 = 1;
/// The share of bands that may differ by it: measured 0.00002.
const SHARE: f64 = 0.001;

#[test]
fn the_shader_s_tone_map_is_the_cpu_s() {
    let gpu = gpu();
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let mut inputs: Vec<[f32; 4]> = bad.map(|x| [0.25, x, 0.5, 1.0]).to_vec();
    for ev in [-30.0f32, -1.5, 0.0, 0.5, 3.0, 30.0, 60.0] {
        inputs.extend([[-1.0, 0.5, -0.1, ev], [0.0, 0.0, 0.0, ev], [1e30, 1e30, 1e29, ev], [1e-30, 0.0, 0.0, ev]]);
        inputs.extend((0..2000u16).map(|i| {
            let x = f32::from(i) * 2e-3;
            [x, 0.7 * x * x, 1.0 / (1.0 + x), ev]
        }));
    }
    let probe = Probe {
        includes: &["shared/tone.glsl"],
        input: "vec3 radiance; float ev;",
        output: "vec3 colour;",
        body: "r.colour = srgb(tone_map(q.radiance, exp2(q.ev)));",
        ..Default::default()
    };
    let outputs: Vec<[f32; 3]> = probe.run(&gpu, &inputs);
    let mut differ = 0;
    for (input, output) in inputs.iter().zip(&outputs) {
        let [r, g, b, ev] = *input;
        let wanted = tone_map([r, g, b], ev.into());
        let found = output.map(|band| if band.is_nan() { 0 } else { (band * 255.0).round() as u8 });
        for (found, wanted) in found.into_iter().zip(wanted) {
            assert!(found.abs_diff(wanted) <= STEPS, "{input:?}: {found} for {wanted}, {output:?}");
            differ += u32::from(found != wanted);
        }
    }
    let share = f64::from(differ) / (3 * inputs.len()) as f64;
    println!("{share:.5} of the bands differ by a step");
    assert!(share <= SHARE, "{share}");
}
