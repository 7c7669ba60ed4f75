//! A triangle's flux, spread evenly over the triangle and shared out among the pixels that it covers.

use glam::DVec2;

use crate::truth::eye::Eye;

/// A corner as the eye sees it.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Pixels from the left and from the top.
    pub at: DVec2,
    /// Of the scale of the projection there: linear in the picture's plane, as places on the triangle times it are.
    pub inverse: f64,
    /// Share of the pixel per square metre of receiver, 1/m².
    pub density: f64,
}

/// A corner of what is left of the triangle inside a pixel: its place, and (1, b1, b2) times the inverse scale.
#[derive(Clone, Copy, Debug, Default)]
struct Point {
    at: DVec2,
    weights: [f64; 3],
}

impl Point {
    fn between(&self, other: &Self, t: f64) -> Self {
        let weights = std::array::from_fn(|k| self.weights[k] + t * (other.weights[k] - self.weights[k]));
        Self { at: self.at.lerp(other.at, t), weights }
    }

    /// Weights of the second and third corner of the triangle.
    fn barycentric(&self) -> DVec2 {
        DVec2::new(self.weights[1], self.weights[2]) / self.weights[0]
    }
}

/// A convex polygon: a triangle cut by four lines has seven corners at most.
#[derive(Clone, Copy, Default)]
struct Polygon {
    points: [Point; 8],
    len: usize,
}

impl Polygon {
    fn push(&mut self, point: Point) {
        if self.len < self.points.len() {
            self.points[self.len] = point;
            self.len += 1;
        }
    }

    fn points(&self) -> &[Point] {
        &self.points[..self.len]
    }

    /// What lies on one side of a line across `axis`: beyond it if `sign` is 1, before it if −1 (Sutherland & Hodgman
    /// 1974).
    fn cut(&self, axis: usize, line: f64, sign: f64) -> Self {
        let mut kept = Self::default();
        let beyond = |p: &Point| sign * (p.at[axis] - line);
        for (k, p) in self.points().iter().enumerate() {
            let next = &self.points[(k + 1) % self.len];
            let (here, there) = (beyond(p), beyond(next));
            if here >= 0.0 {
                kept.push(*p);
            }
            // Of strictly different sides, so that the divisor is not 0.
            if here * there < 0.0 {
                kept.push(p.between(next, here / (here - there)));
            }
        }
        kept
    }

    fn between(&self, axis: usize, cell: i64) -> Self {
        self.cut(axis, cell as f64, 1.0).cut(axis, (cell + 1) as f64, -1.0)
    }

    fn bounds(&self, axis: usize) -> (f64, f64) {
        let fold = |(low, high): (f64, f64), p: &Point| (low.min(p.at[axis]), high.max(p.at[axis]));
        self.points().iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold)
    }

    /// Share of the triangle's area in the world (twice the area in its own coordinates, in which it is one half, however
    /// thin it looks), and where its middle is in them.
    fn share(&self) -> (f64, DVec2) {
        let corners: [DVec2; 8] =
            std::array::from_fn(|k| if k < self.len { self.points[k].barycentric() } else { DVec2::ZERO });
        let corners = &corners[..self.len];
        let area =
            (1..self.len.saturating_sub(1)).map(|k| (corners[k] - corners[0]).perp_dot(corners[k + 1] - corners[0]));
        (area.sum::<f64>().abs(), corners.iter().sum::<DVec2>() / self.len as f64)
    }
}

/// Calls `add` with each pixel that the triangle covers and with what its flux (W) is to be multiplied by to give the
/// pixel's irradiance (W/m²).
pub fn spread(eye: &Eye, corners: &[Vertex; 3], mut add: impl FnMut(usize, f64)) {
    let width = i64::from(eye.size[0]);
    let limits = [width, i64::from(eye.size[1])];
    let density = |b: DVec2| {
        let [k0, k1, k2] = corners.map(|c| c.density);
        k0 + b.x * (k1 - k0) + b.y * (k2 - k0)
    };
    let mut triangle = Polygon::default();
    for (k, corner) in corners.iter().enumerate() {
        let q = corner.inverse;
        triangle
            .push(Point { at: corner.at, weights: [q, if k == 1 { q } else { 0.0 }, if k == 2 { q } else { 0.0 }] });
    }
    let [columns, rows] = [0, 1].map(|axis| covered(triangle.bounds(axis), limits[axis]));
    if within(triangle.bounds(0), &columns) && within(triangle.bounds(1), &rows) {
        return add((rows.start * width + columns.start) as usize, density(DVec2::splat(1.0 / 3.0)));
    }
    for row in rows {
        let strip = triangle.between(1, row);
        for column in covered(strip.bounds(0), width) {
            let (share, middle) = strip.between(0, column).share();
            if share > 0.0 {
                add((row * width + column) as usize, share * density(middle));
            }
        }
    }
}

/// Pixels from `low` to `high` along an axis that has so many; none if `low` is above `high`.
fn covered((low, high): (f64, f64), pixels: i64) -> std::ops::Range<i64> {
    let place = |x: f64| x.floor().clamp(-1.0, pixels as f64) as i64;
    if low <= high { place(low).max(0)..(place(high) + 1).min(pixels) } else { 0..0 }
}

/// Whether all of it lies in the one pixel there is.
fn within((low, high): (f64, f64), pixels: &std::ops::Range<i64>) -> bool {
    pixels.end - pixels.start == 1 && low >= pixels.start as f64 && high <= pixels.end as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Sums of some hundred roundings.
    const ROUNDING: f64 = 1e-12;

    fn picture(eye: &Eye, corners: [DVec2; 3], inverse: [f64; 3]) -> Vec<f64> {
        let mut picture = vec![0.0; eye.pixels()];
        let vertex = |k: usize| Vertex { at: corners[k], inverse: inverse[k], density: 1.0 };
        spread(eye, &[vertex(0), vertex(1), vertex(2)], |pixel, share| picture[pixel] += share);
        picture
    }

    fn eye() -> Eye {
        Eye::new(&Scene::load("glass-sphere", &[]).unwrap().cameras["region"], [8, 6])
    }

    #[test]
    fn all_of_a_triangle_is_shared_out_whatever_its_shape() {
        let at = |x: f64, y: f64| DVec2::new(x, y);
        for corners in [
            [at(0.5, 0.5), at(7.2, 1.0), at(3.0, 5.9)],
            [at(1.0, 1.0), at(1.0, 1.0), at(1.0, 1.0)],
            [at(1.0, 1.0), at(5.0, 1.0), at(3.0, 1.0)],
            [at(0.1, 0.1), at(6.1, 4.1), at(3.1, 2.1)],
            [at(2.2, 2.2), at(2.3, 2.9), at(2.9, 2.3)],
        ] {
            for inverse in [[1.0; 3], [0.2, 1.0, 0.5]] {
                let sum: f64 = picture(&eye(), corners, inverse).iter().sum();
                assert!((sum - 1.0).abs() < ROUNDING, "{corners:?}: {sum}");
            }
        }
    }

    #[test]
    fn a_right_triangle_fills_its_pixels_by_hand() {
        let picture = picture(&eye(), [DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(0.0, 2.0)], [1.0; 3]);
        for (pixel, share) in [(0, 0.5), (1, 0.25), (8, 0.25), (9, 0.0)] {
            assert!((picture[pixel] - share).abs() < ROUNDING, "{pixel}: {}", picture[pixel]);
        }
    }

    /// Far corners stand for more of the world: half-way in the picture is two thirds of the way to a near corner.
    #[test]
    fn perspective_weighs_by_area_in_the_world() {
        let corners = [DVec2::new(0.0, 0.0), DVec2::new(2.0, 0.0), DVec2::new(0.0, 1e-9)];
        let picture = picture(&eye(), corners, [1.0, 0.5, 1.0]);
        // s = t/2 / (1 − t + t/2) at t = 1/2 is 1/3; the triangle left of it has 1 − (2/3)² of the area.
        assert!((picture[0] - 5.0 / 9.0).abs() < ROUNDING, "{}", picture[0]);
    }

    #[test]
    fn what_lies_outside_the_picture_adds_nothing() {
        let far = [DVec2::new(-30.0, -3.0), DVec2::new(-9.0, 4.0), DVec2::new(-1.0, 90.0)];
        assert!(picture(&eye(), far, [1.0; 3]).iter().all(|x| *x == 0.0));
        let half = [DVec2::new(-2.0, 0.0), DVec2::new(2.0, 0.0), DVec2::new(0.0, 2.0)];
        let sum: f64 = picture(&eye(), half, [1.0; 3]).iter().sum();
        assert!((sum - 0.5).abs() < ROUNDING, "{sum}");
    }
}
