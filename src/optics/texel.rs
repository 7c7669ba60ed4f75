//! How much of the light, and of a receiver, one texel of a light's view holds.

use glam::DVec3;

/// Solid angle, in steradians, of the rectangle [x0, x1] × [y0, y1] on the plane at unit distance from the light.
///
/// Exact, by the antiderivative S(x, y) = atan(xy / √(1 + x² + y²)) taken at the four corners. (The midpoint rule,
/// area / (1 + x² + y²)^{3/2}, is 4·10⁻³ off for 16 × 16 texels, 1.5·10⁻⁵ for 256 × 256.)
///
/// Edges: 0 for an empty rectangle, negative for one traversed backwards, 2π for the whole plane (infinite corners).
pub fn texel_solid_angle(x0: f64, y0: f64, x1: f64, y1: f64) -> f64 {
    corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
}

/// S(x, y): the solid angle of the rectangle from the axis' foot to (x, y). An infinite corner is the limit.
fn corner(x: f64, y: f64) -> f64 {
    match (x.is_infinite(), y.is_infinite()) {
        (true, true) => (x.signum() * y.signum()).atan2(0.0),
        (true, false) => (y * x.signum()).atan(),
        (false, true) => (x * y.signum()).atan(),
        (false, false) => (x * y).atan2((1.0 + x * x + y * y).sqrt()),
    }
}

/// Area, in m², that a texel of a directional light's view covers on a receiver: a / |n·d|.
///
/// `area`: the texel's area across the light (m²); `d` unit direction of travel, `n` unit normal of the receiver.
/// A receiver seen edge-on is covered without bound: infinite, so that flux ÷ footprint is 0 and never NaN.
pub fn footprint_directional(area: f64, d: DVec3, n: DVec3) -> f64 {
    spread(area, d.dot(n).abs())
}

/// Area, in m², that a texel of a point light's view covers on a receiver: Ω r² / |n·d|.
///
/// `solid_angle`: the texel's, from [`texel_solid_angle`]; `to_point`: from the light to the receiver (m, not unit);
/// `n` unit normal of the receiver. Right to first order in the texel's size; infinite edge-on and at the light.
pub fn footprint_point(solid_angle: f64, to_point: DVec3, n: DVec3) -> f64 {
    let r = to_point.length();
    spread(solid_angle * r * r * r, to_point.dot(n).abs())
}

fn spread(area: f64, cos: f64) -> f64 {
    if cos > 0.0 { area / cos } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Sums of a few atan of order one, and their differences.
    const ROUNDING: f64 = 1e-14;
    /// First-order footprints of a texel 1e-3 wide: the second order is (texel / distance)² and its slope.
    const FIRST_ORDER: f64 = 1e-5;
    /// Area of a millimetre square from coordinates of order one: 2⁻⁵² · 10³ in each side.
    const SMALL_AREA: f64 = 1e-10;

    /// Van Oosterom & Strackee 1983, eq. 8: the solid angle of a triangle seen from the origin.
    fn triangle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        2.0 * a.dot(b.cross(c)).atan2(la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la)
    }

    #[test]
    fn solid_angle_agrees_with_two_triangles() {
        for (x0, y0, x1, y1) in [(-0.5, -0.5, 0.5, 0.5), (0.2, -0.1, 0.9, 0.4), (2.0, 3.0, 2.5, 3.5)] {
            let p = |x, y| DVec3::new(x, y, 1.0);
            let by_triangles = triangle(p(x0, y0), p(x1, y0), p(x1, y1)) + triangle(p(x0, y0), p(x1, y1), p(x0, y1));
            let ours = texel_solid_angle(x0, y0, x1, y1);
            assert!((ours - by_triangles).abs() < ROUNDING, "{ours} against {by_triangles}");
        }
    }

    #[test]
    fn solid_angle_of_a_cube_face_and_of_half_space() {
        assert!((texel_solid_angle(-1.0, -1.0, 1.0, 1.0) - 4.0 * PI / 6.0).abs() < ROUNDING);
        let inf = f64::INFINITY;
        assert!((texel_solid_angle(-inf, -inf, inf, inf) - 2.0 * PI).abs() < ROUNDING);
        assert!((texel_solid_angle(0.0, -inf, inf, inf) - PI).abs() < ROUNDING);
        assert_eq!(texel_solid_angle(0.3, 0.1, 0.3, 0.9), 0.0);
    }

    #[test]
    fn texels_add_up_to_their_view() {
        let (n, t) = (64, 0.8);
        let edge = |i: i32| -t + 2.0 * t * f64::from(i) / f64::from(n);
        let sum: f64 = (0..n * n)
            .map(|k| (k % n, k / n))
            .map(|(i, j)| texel_solid_angle(edge(i), edge(j), edge(i + 1), edge(j + 1)))
            .sum();
        let whole = texel_solid_angle(-t, -t, t, t);
        // 4096 terms, each rounded relative to S, not to itself.
        assert!((sum - whole).abs() < 4096.0 * ROUNDING, "{sum} against {whole}");
    }

    /// Area on the plane {p·n = h} of the beam through the four corners, by intersecting its edges.
    fn cut(origins: [DVec3; 4], dirs: [DVec3; 4], n: DVec3, h: f64) -> f64 {
        let p: Vec<DVec3> = (0..4).map(|i| origins[i] + dirs[i] * ((h - origins[i].dot(n)) / dirs[i].dot(n))).collect();
        0.5 * ((p[1] - p[0]).cross(p[2] - p[0]) + (p[2] - p[0]).cross(p[3] - p[0])).length()
    }

    #[test]
    fn footprints_agree_with_the_beam_cut_by_the_receiver() {
        let n = DVec3::new(0.3, 1.0, -0.2).normalize();
        let corners = [(0.0, 0.0), (1e-3, 0.0), (1e-3, 1e-3), (0.0, 1e-3)].map(|(x, y)| (x + 0.4, y - 0.3));
        let flat = corners.map(|(x, z)| DVec3::new(x, 0.0, z));
        let exact = cut(flat, [DVec3::NEG_Y; 4], n, -2.0);
        assert!((footprint_directional(1e-6, DVec3::NEG_Y, n) / exact - 1.0).abs() < SMALL_AREA);

        let rays = corners.map(|(x, z)| DVec3::new(x, -1.0, z));
        let exact = cut([DVec3::ZERO; 4], rays, n, -2.0);
        let centre = DVec3::new(0.4005, -1.0, -0.2995);
        let hit = centre * (-2.0 / centre.dot(n));
        let ours = footprint_point(texel_solid_angle(0.4, -0.3, 0.401, -0.299), hit, n);
        assert!((ours / exact - 1.0).abs() < FIRST_ORDER, "{ours} against {exact}");
    }

    #[test]
    fn edge_on_receivers_take_no_irradiance() {
        assert_eq!(footprint_directional(1.0, DVec3::NEG_Y, DVec3::X), f64::INFINITY);
        assert_eq!(footprint_directional(0.0, DVec3::NEG_Y, DVec3::X), f64::INFINITY);
        assert_eq!(footprint_point(1.0, DVec3::ZERO, DVec3::X), f64::INFINITY);
        assert_eq!(1.0 / footprint_point(1.0, DVec3::NEG_Y, DVec3::Z), 0.0);
    }
}
