//! `waves.variant=inverse` under suns: their discs, several of them, and what stands above the water.

use std::sync::Arc;

use nephroid::{renderer::Job, scene::Light, truth::closed};

use crate::{
    common::{
        gpu,
        picture::{Pixels, job_of, rewritten, written},
    },
    inverse::{INVERSE, inverse, judged, light},
};

/// The same under other lights.
fn under(job: &Job, lights: Vec<Light>) -> Job {
    let mut scene = job.scene.as_ref().clone();
    scene.lights = lights;
    Job { scene: Arc::new(scene), ..job.clone() }
}

/// A scene of this text.
fn of_text(text: &str, size: u32) -> Job {
    let providers = inverse("flat-water", &[], "region", [1, 1]).providers;
    Job { providers, ..job_of(written(text, &[]), &[INVERSE, ("eye.samples", "1")], "region", [size; 2]) }
}

/// A disc is many suns without any width, all over it. On a sea, seen by pixels a fifth as wide as the disc is on
/// the floor: measured 6.6e-6, and the energy 6e-4 off.
#[test]
fn a_disc_over_a_sea_is_the_sum_of_its_directions() {
    let gpu = gpu();
    let of = |width| {
        let set = [
            ("scene.objects.water.sea.grid", "64"),
            ("waves.cells", "64"),
            ("scene.region.half", "[0.12, 0.12]"),
            ("scene.lights.sun.directional.angular_diameter", width),
        ];
        inverse("scenes/papers/sea.toml", &set, "region", [20, 20])
    };
    let job = of("3");
    let sun = &job.scene.lights[0];
    let directions = sun.kind.samples(128).into_iter().map(|kind| Light { name: sun.name.clone(), kind }).collect();
    let sum = light(&gpu, &under(&job, directions));
    let [disc, energy] = judged(&light(&gpu, &job), &sum, 1.0);
    let [point, _] = judged(&light(&gpu, &of("0.01")), &sum, 1.0);
    println!("disc: relmse {disc:.1e}, energy {energy:.5}; its middle alone {point:.1e}");
    assert!(disc < 2e-5 && (energy - 1.0).abs() < 2e-3, "{disc:e} {energy}");
    assert!(point > 100.0 * disc, "the disc is to be seen: {point:e}");
}

#[test]
fn several_suns_are_the_sum_of_each() {
    let gpu = gpu();
    let more = "[lights.low.directional]\ndirection = [0.8, -1, 0.3]\nirradiance = [0.2, 0.5, 0.8]\n\
                [lights.wide.directional]\ndirection = [-0.2, -1, 0]\nirradiance = 0.7\nangular_diameter = 2\n";
    let job = of_text(&rewritten("sine-water", &[], more), 16);
    let mut sum = vec![0.0; 256];
    for one in &job.scene.lights {
        light(&gpu, &under(&job, vec![one.clone()])).iter().zip(&mut sum).for_each(|(e, sum)| *sum += e);
    }
    assert_eq!(job.scene.lights.len(), 3);
    let [relmse, energy] = judged(&light(&gpu, &job), &sum, 1.0);
    println!("relmse {relmse:.1e}, energy {energy}");
    assert!(relmse < 1e-10 && (energy - 1.0).abs() < 1e-6, "{relmse:e} {energy}");
}

/// A block above the water under a sun at 45° shades it; its shadow is bent towards its foot in the water.
#[test]
fn what_stands_above_the_water_shades_it() {
    let block =
        "[objects.block]\nmaterial = \"white\"\n[objects.block.box]\ncenter = [-0.7, 0.5, 0]\nhalf = [0.2, 0.1, 0.3]\n";
    let sun = ("[0.0, -1.0, 0.0]\nirradiance", "[1.0, -1.0, 0.0]\nirradiance");
    let job = of_text(&rewritten("flat-water", &[sun], block), 48);
    let pixels = Pixels { region: &job.scene.region, size: job.size };
    let whole = closed::flat_water(1.33, 0.5_f64.sqrt(), 1.0, 0.0, 1.0);
    let bent = (0.5_f64.sqrt() / 1.33).asin().tan();
    let margin = 1.5 * 2.0 / 48.0;
    let [mut on_top, mut dark, mut lit] = [0; 3];
    for (p, e) in pixels.centres().zip(&light(&gpu(), &job)) {
        // How far inside; the block's sides are 0.4 to 0.6 m above the water.
        let across = 0.3 - p.z.abs();
        let top = (0.2 - (p.x + 0.7).abs()).min(across);
        let shadow = (p.x - bent - (-0.9 + 0.4)).min(-0.5 + 0.6 + bent - p.x).min(across);
        let (expected, count) = match () {
            () if top.abs() < margin || shadow.abs() < margin => continue,
            () if top > 0.0 => (0.0, &mut on_top),
            () if shadow > 0.0 => (0.0, &mut dark),
            () => (whole, &mut lit),
        };
        *count += 1;
        assert!((e - expected).abs() < 1e-4, "{e} for {expected} at {p}");
    }
    assert!(on_top > 30 && dark > 50 && lit > 1000, "{on_top} {dark} {lit}");
}
