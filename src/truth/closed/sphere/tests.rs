//! The closed form against a plain three-dimensional ray trace that shares no formula with it.

use super::*;
use crate::optics::texel_solid_angle;
use glam::DVec3;
use rayon::prelude::*;

/// Rays a side of the square grid over the silhouette.
const SIDE: i32 = 1200;
/// Of the emitted flux. A grid counts a cell wholly or not at all along the silhouette and along the circle's preimage:
/// some 10·SIDE cells of 0.8·SIDE², each wrong by 0.4 at random, that is 4e-5. Measured over 900 comparisons: at worst
/// 4.6e-5, and with 600 and 2400 rays a side 1.5e-4 and 1.8e-5; twice the worst is allowed.
const GRID: f64 = 1e-4;
/// Sums of a thousand panels in float64.
const ROUNDING: f64 = 1e-12;

fn glass(ior: f64, floor: f64) -> GlassSphere {
    GlassSphere { radius: 1.0, ior, absorption: 0.0, floor }
}

fn parallel(glass: GlassSphere, irradiance: f64) -> SphereCaustic {
    SphereCaustic::new(glass, Illumination::Parallel { irradiance }).unwrap()
}

fn point(glass: GlassSphere, distance: f64, intensity: f64) -> SphereCaustic {
    SphereCaustic::new(glass, Illumination::Point { distance, intensity }).unwrap()
}

/// Snell in tangent and normal parts, and Fresnel by the transmitted amplitudes: (direction, share that passes).
fn cross(d: DVec3, outward: DVec3, from: f64, to: f64) -> (DVec3, f64) {
    let n = if d.dot(outward) < 0.0 { outward } else { -outward };
    let cos_i = -d.dot(n);
    let tangent = (d + cos_i * n) * (from / to);
    let cos_t = (1.0 - tangent.length_squared()).sqrt();
    let s = 2.0 * from * cos_i / (from * cos_i + to * cos_t);
    let p = 2.0 * from * cos_i / (to * cos_i + from * cos_t);
    (tangent - cos_t * n, to * cos_t / (from * cos_i) * 0.5 * (s * s + p * p))
}

/// Parameters of the two intersections of a line with the sphere about the origin.
fn meet(o: DVec3, d: DVec3, radius: f64) -> Option<(f64, f64)> {
    let b = o.dot(d);
    let root = (b * b - o.length_squared() + radius * radius).sqrt();
    (!root.is_nan()).then_some((-b - root, -b + root))
}

/// Traces one ray; (distance from the axis on the floor or infinity, flux left), or nothing past the sphere.
fn trace(glass: GlassSphere, o: DVec3, d: DVec3, flux: f64) -> Option<(f64, f64)> {
    let enter = o + d * meet(o, d, glass.radius)?.0;
    let (inside, passes_in) = cross(d, enter.normalize(), 1.0, glass.ior);
    let length = meet(enter, inside, glass.radius)?.1;
    let leave = enter + inside * length;
    let (out, passes_out) = cross(inside, leave.normalize(), glass.ior, 1.0);
    let left = flux * passes_in * passes_out * (-glass.absorption * length).exp();
    let hit = leave + out * ((-glass.floor - leave.y) / out.y);
    Some((if out.y < 0.0 { hit.x.hypot(hit.z) } else { f64::INFINITY }, left))
}

/// A grid of rays over the square about the silhouette, each somewhere in its cell (Roberts' R2 sequence: a regular
/// grid has the sphere's own symmetries, and its errors would add), with the flux of its cell.
fn grid(glass: GlassSphere, light: Illumination) -> Vec<(f64, f64)> {
    let half = match light {
        Illumination::Parallel { .. } => glass.radius,
        Illumination::Point { distance, .. } => glass.radius / (distance * distance - glass.radius.powi(2)).sqrt(),
    };
    let step = 2.0 * half / f64::from(SIDE);
    let ray = |k: i32| {
        let (x, z) = (f64::from(k % SIDE) * step - half, f64::from(k / SIDE) * step - half);
        let at = DVec3::new(
            x + step * (f64::from(k) * 0.754_877_666).fract(),
            0.0,
            z + step * (f64::from(k) * 0.569_840_291).fract(),
        );
        match light {
            Illumination::Parallel { irradiance } => {
                trace(glass, at + DVec3::Y * 2.0 * glass.radius, DVec3::NEG_Y, irradiance * step * step)
            }
            Illumination::Point { distance, intensity } => {
                let flux = intensity * texel_solid_angle(x, z, x + step, z + step);
                trace(glass, DVec3::Y * distance, (at + DVec3::NEG_Y).normalize(), flux)
            }
        }
    };
    (0..SIDE * SIDE).into_par_iter().filter_map(ray).collect()
}

/// Encircled flux at many radii, the total, and what misses the floor: all against the grid.
fn agrees(glass: GlassSphere, light: Illumination) {
    let caustic = SphereCaustic::new(glass, light).unwrap();
    let traced = grid(glass, light);
    let sum = |keep: &dyn Fn(f64) -> bool| traced.iter().filter(|(r, _)| keep(*r)).map(|(_, f)| f).sum::<f64>();
    let close = |what: &str, ours: f64, theirs: f64| {
        let error = (ours - theirs).abs() / caustic.emitted();
        assert!(error < GRID, "{what} of {glass:?}, {light:?}: {ours} W against {theirs} W traced");
    };
    for k in 1..=60 {
        let r = 0.05 * f64::from(k) * glass.radius;
        close(&format!("flux within {r} m"), caustic.encircled(r), sum(&|hit| hit <= r));
    }
    close("total", caustic.total(), sum(&|hit| hit.is_finite()));
    close("missed", caustic.missed(), sum(&|hit| hit.is_infinite()));
}

#[test]
fn parallel_light_agrees_with_a_traced_grid() {
    for (ior, floor) in [(1.5, 1.2), (1.5, 1.5), (1.5, 2.0), (1.5, 1.0), (1.33, 4.0), (2.42, 3.0), (1.0, 1.5)] {
        agrees(glass(ior, floor), Illumination::Parallel { irradiance: 2.0 });
    }
    let coloured = GlassSphere { radius: 0.25, ior: 1.5, absorption: 3.0, floor: 0.4 };
    agrees(coloured, Illumination::Parallel { irradiance: 10.0 });
}

#[test]
fn point_light_agrees_with_a_traced_grid() {
    for (ior, floor, distance) in [(1.5, 1.5, 3.0), (1.5, 1.2, 1.3), (1.33, 6.0, 4.0), (1.0, 2.0, 2.0)] {
        agrees(glass(ior, floor), Illumination::Point { distance, intensity: 5.0 });
    }
    let coloured = GlassSphere { radius: 3.0, ior: 1.5, absorption: 0.2, floor: 5.0 };
    agrees(coloured, Illumination::Point { distance: 9.0, intensity: 5.0 });
}

#[test]
fn index_one_leaves_the_light_as_it_was() {
    let none = parallel(glass(1.0, 1.7), 3.0);
    let seen = point(glass(1.0, 1.7), 2.0, 3.0);
    for r in [0.1, 0.5, 0.9] {
        let (disc, cone) = (3.0 * PI * r * r, 3.0 * TAU * (1.0 - (r / 3.7f64).atan().cos()));
        assert!((none.encircled(r) - disc).abs() < ROUNDING, "{} against {disc}", none.encircled(r));
        assert!((seen.encircled(r) - cone).abs() < ROUNDING, "{} against {cone}", seen.encircled(r));
    }
    for caustic in [none, seen] {
        assert!((caustic.total() - caustic.emitted()).abs() < 10.0 * ROUNDING);
        assert!(caustic.missed().abs() < 10.0 * ROUNDING);
        // Beyond the silhouette's shadow (1.7 + 2 over √3 for the point light) there is nothing more.
        assert!((caustic.encircled(2.2) - caustic.total()).abs() < 10.0 * ROUNDING);
    }
}

#[test]
fn a_far_point_light_is_parallel_light() {
    let distance = 1e6;
    let (near, far) = (parallel(glass(1.5, 1.5), 1.0), point(glass(1.5, 1.5), distance, distance * distance));
    // The rays differ by an angle of 1/distance.
    let allowed = 10.0 / distance;
    assert!((near.emitted() - far.emitted()).abs() < allowed);
    assert!((near.total() - far.total()).abs() < allowed);
    assert!((near.encircled(0.3) - far.encircled(0.3)).abs() < allowed);
}

#[test]
fn size_scales_areas_and_no_angle() {
    let small = GlassSphere { radius: 1e-3, ior: 1.5, absorption: 700.0, floor: 1.5e-3 };
    let large = GlassSphere { radius: 1e3, ior: 1.5, absorption: 700e-6, floor: 1.5e3 };
    let ratio = parallel(large, 1.0).encircled(400.0) / parallel(small, 1.0).encircled(400e-6);
    assert!((ratio / 1e12 - 1.0).abs() < ROUNDING, "{ratio}");
}

#[test]
fn encircled_flux_grows_from_nothing_to_the_total() {
    let caustic = parallel(glass(1.5, 1.2), 1.0);
    let radii: Vec<f64> = (0..500).map(|k| f64::from(k) * 0.01).chain([1e3, 1e9]).collect();
    let table = caustic.table(&radii);
    assert_eq!(table[0], 0.0);
    assert!(table.windows(2).all(|w| w[1] >= w[0] - ROUNDING), "not monotone");
    // At a distance r only rays within 1/r of the horizon are left: 1e-9 of the flux.
    assert!((table.last().unwrap() - caustic.total()).abs() < 1e-8);
    assert!(caustic.missed() > 0.0, "an index of 1.5 bends grazing rays by 96°");
    assert_eq!(caustic.encircled(-1.0), 0.0);
}

#[test]
fn what_has_no_closed_form_is_refused() {
    let sun = Illumination::Parallel { irradiance: 1.0 };
    let refused = |g: GlassSphere, l: Illumination| SphereCaustic::new(g, l).unwrap_err().to_string();
    assert!(refused(glass(1.5, 0.9), sun).contains("floor cuts"));
    assert!(refused(glass(0.9, 2.0), sun).contains("index"));
    assert!(refused(glass(f64::NAN, 2.0), sun).contains("finite"));
    assert!(refused(glass(1.5, 2.0), Illumination::Point { distance: 1.0, intensity: 1.0 }).contains("inside"));
}
