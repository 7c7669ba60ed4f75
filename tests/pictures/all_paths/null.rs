//! A concave body of index 1 must vanish: light that enters it again belongs to `all:16`.

use nephroid::{scene::LightKind, stats::percentile, truth::closed::direct_parallel};

use super::{gpu, scene};
use crate::common::picture::{Picture, job_of, picture, pixels_of_map, worst};

/// Bounds of `tests/null.rs`, each with its cause there.
const BAND: i32 = 3;
const MEAN_ERROR: f64 = 0.005;
const PERCENTILE_99: f64 = 0.02;
const REGION_ERROR: f64 = 0.001;
/// A caustic this much too bright is wrong, and must be found so.
const TOO_BRIGHT: f64 = 1.02;

const PIXELS: u32 = pixels_of_map(256);

/// Pixels in light or shadow whole, and no pixel within the band that is otherwise.
fn outside_band(direct: &[f64], lit: f64) -> Vec<bool> {
    let side = PIXELS as i32;
    let state = |x: i32, y: i32| {
        let share = direct[(y * side + x) as usize] / lit;
        if share < 0.001 {
            0
        } else if share > 0.999 {
            2
        } else {
            1
        }
    };
    let of = |x: i32, y: i32| {
        let here = state(x, y);
        let around = (-BAND..=BAND).flat_map(|dy| (-BAND..=BAND).map(move |dx| (x + dx, y + dy)));
        here != 1
            && around.filter(|(x, y)| (0..side).contains(x) && (0..side).contains(y)).all(|(x, y)| state(x, y) == here)
    };
    (0..side).flat_map(|y| (0..side).map(move |x| of(x, y))).collect()
}

/// Mean and 99th percentile in the shadow but for its edge, and the whole region: shares.
fn figures(picture: &Picture, lit: f64, gain: f64) -> [f64; 3] {
    let (direct, caustic) = (picture.mean("irradiance.direct"), picture.mean("irradiance.caustic"));
    let sum: Vec<f64> = direct.iter().zip(&caustic).map(|(d, c)| d + gain * c).collect();
    let judged = outside_band(&direct, lit);
    let errors: Vec<f64> =
        sum.iter().zip(&judged).filter(|(_, shadow)| **shadow).map(|(e, _)| (e / lit - 1.0).abs()).collect();
    assert!(errors.len() > 3000, "{} pixels of shadow are judged", errors.len());
    let region = sum.iter().sum::<f64>() / (sum.len() as f64 * lit) - 1.0;
    [errors.iter().sum::<f64>() / errors.len() as f64, percentile(&errors, 99.0), region]
}

#[test]
fn a_bunny_of_index_one_vanishes() {
    let gpu = gpu();
    let scene = scene("bunny", &[("materials.glass.ior", "1.0")]);
    let LightKind::Directional { direction, irradiance } = scene.lights[0].kind else { panic!("no sun") };
    let lit = direct_parallel(direction, scene.region.normal(), irradiance[0]);
    let set = |class| [("light.side", "1024"), ("maps.side", "256"), ("eye.samples", "4"), ("light.paths", class)];
    let render = |class| picture(&gpu, &job_of(scene.clone(), &set(class), "region", [PIXELS; 2]));
    let all = render("all:16");
    let bounds = [MEAN_ERROR, PERCENTILE_99, REGION_ERROR];
    let holds = |figures: [f64; 3]| figures.iter().zip(bounds).all(|(f, bound)| worst([*f]) <= bound);
    let sound = figures(&all, lit, 1.0);
    println!("all:16: mean {:.6}, 99th percentile {:.6}, region {:+.7}", sound[0], sound[1], sound[2]);
    assert!(holds(sound), "{sound:?} of {bounds:?}");
    assert!(worst([figures(&all, lit, TOO_BRIGHT)[2]]) > REGION_ERROR, "too bright");
    assert!(worst([figures(&all, lit, 0.0)[2]]) > REGION_ERROR, "no caustic");
    let short = figures(&render("transmit-2"), lit, 1.0);
    println!("transmit-2: mean {:.6}, 99th percentile {:.6}, region {:+.7}", short[0], short[1], short[2]);
    assert!(!holds(short), "light that goes in again is of no smaller class");
}
