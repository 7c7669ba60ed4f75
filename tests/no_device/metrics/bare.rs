//! E₀ of scenes whose brightness is known.

use nephroid::{metrics::bare_irradiance, scene::Scene};

fn e0(name: &str, overrides: &[(&str, &str)]) -> f64 {
    let overrides: Vec<_> = overrides.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    bare_irradiance(&Scene::load(name, &overrides).expect("the scene loads"))
}

/// Sums of 128² equal numbers.
const ROUNDING: f64 = 1e-9;
/// The midpoint rule on 128² points, of a light two thirds of a region's side away: some (1/128)² = 6·10⁻⁵.
const SMOOTH: f64 = 1e-4;
/// A shadow's edge, as it falls between the points: about 128^-1.5 of the region, 7·10⁻⁴.
const EDGE: f64 = 2e-3;

#[track_caller]
fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() < tolerance, "{found} W/m² for {expected}");
}

/// The sun over the glass: the sphere is taken away, the cosine stays.
#[test]
fn parallel_light_times_the_cosine() {
    near(e0("glass-sphere", &[]), 1.0, ROUNDING);
    let slanted = ("lights.sun.directional.direction", "[0.6, -0.8, 0.0]");
    let bands = ("lights.sun.directional.irradiance", "[1.0, 2.0, 6.0]");
    near(e0("glass-sphere", &[slanted, bands]), 0.8 * 3.0, ROUNDING);
}

/// A plaster sphere of radius 1 stands in the slanted sun. Its shadow is an ellipse; the part of it inside the region of
/// 3 × 3 m² is found with four million points of its own equation.
#[test]
fn diffuse_objects_cast_their_shadows() {
    let d = glam::DVec3::new(0.5, -1.0, -0.3).normalize();
    let side = 2000;
    let lit = (0..side * side).filter(|at| {
        let along = |at: usize| 3.0 * (at as f64 + 0.5) / side as f64 - 1.5;
        let to_centre = glam::DVec3::new(-along(at % side), 1.0, -along(at / side));
        // The sun is at −d: the sphere's centre lies ahead on the way to it, within a radius of that line.
        (to_centre - to_centre.dot(-d) * -d).length() > 1.0
    });
    let expected = -d.y * lit.count() as f64 / (side * side) as f64;
    near(e0("diffuse", &[]), expected, EDGE);
}

/// A point light 2 m above the middle of a square of half side a = 1.5 m: the mean is I Ω/A, with the square's solid
/// angle Ω = 4 atan(a²/(h √(2a² + h²))).
#[test]
fn a_point_light_by_the_solid_angle() {
    let light = ("lights.sun", "{ point = { position = [0.0, 0.5, 0.0], intensity = 3.0 } }");
    let (a, h) = (1.5_f64, 2.0_f64);
    let angle = 4.0 * (a * a / (h * (2.0 * a * a + h * h).sqrt())).atan();
    near(e0("glass-sphere", &[light]), 3.0 * angle / (4.0 * a * a), SMOOTH);
}

/// From below the floor is dark: what is left is the sun's strength on a plane that faces it.
#[test]
fn a_dark_region_falls_back_on_the_lights_themselves() {
    let below = ("lights.sun.directional.direction", "[0.0, 1.0, 0.0]");
    near(e0("glass-sphere", &[below]), 1.0, ROUNDING);
}

/// Under the sun overhead a plaster box, a disk and a bowl shadow their outline of the region's 9 m²; an upright tube
/// has none. Straight edges run between the points.
#[test]
fn canonical_shapes_cast_their_shadows() {
    let from_above = ("lights.sun.direction", "[0.0, -1.0, 0.0]");
    let pi = std::f64::consts::PI;
    for (shape, shadow) in [
        ("box = { center = [0, 0, 0], half = [0.75, 0.2, 0.375] }", 1.125),
        ("disk = { center = [0, 0, 0], normal = [0, 1, 0], radius = 1.0 }", pi),
        ("disk = { center = [0, 0, 0], normal = [0, 0.6, 0.8], radius = 1.0 }", 0.6 * pi),
        ("paraboloid = { vertex = [0, 0, 0], axis = [0, 1, 0], focal_length = 0.3, rim = 0.8 }", 0.64 * pi),
        ("cylinder = { base = [0, 0, -0.75], axis = [0, 0, 1], radius = 0.375, height = 1.5 }", 1.125),
        ("cylinder = { base = [0, 0, 0], axis = [0, 1, 0], radius = 0.5, height = 1.0 }", 0.0),
    ] {
        let object = format!("{{ material = \"plaster\", {shape} }}");
        near(e0("diffuse", &[("objects.ball", &object), from_above]), 1.0 - shadow / 9.0, EDGE);
    }
}
