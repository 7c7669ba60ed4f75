//! A picture in a spot's beam, as a projector throws it.
use std::sync::Arc;

use glam::DVec3;

use super::{Beam, Picture, error::SceneError, file::Floats, locate::Key};

/// Sine between the axis and the upright below which the picture does not know how to stand.
const PARALLEL: f64 = 1e-6;
/// Widest half angle, degrees: beyond it the picture's middle would be a point beside its rim.
const WIDEST: f64 = 85.0;
/// Points along each side by which a picture's flux is summed, at least: as many in each pixel, of a large one its middle.
const POINTS: usize = 1024;

/// A picture's rectangle across a beam, its corners on the outer cone.
#[derive(Clone, Debug, PartialEq)]
pub struct Slide {
    /// By whose colours the intensity is multiplied.
    pub picture: Arc<Picture>,
    /// Unit vector, upright in the picture; need not be across the axis.
    pub up: DVec3,
    /// Half width and half height, a unit along the axis.
    pub half: [f64; 2],
}

impl Slide {
    /// In a cone of this outer half angle (degrees); `key` is that of the spot.
    pub fn new(
        key: &Key,
        picture: Arc<Picture>,
        up: Option<Floats<3>>,
        axis: DVec3,
        outer: f64,
    ) -> Result<Self, SceneError> {
        if outer > WIDEST {
            let expected = format!("at most {WIDEST}° with an image");
            return Err(key.key("outer").fault(expected, outer.to_string(), "make the beam narrower"));
        }
        let up = match up {
            Some(up) => key.key("up").direction(up)?,
            None if axis.cross(DVec3::Y).length() < PARALLEL => DVec3::NEG_Z,
            None => DVec3::Y,
        };
        if axis.cross(up).length() < PARALLEL {
            let remedy = "choose another upright, such as [0, 0, -1] for a beam that points down";
            return Err(key.key("up").fault("a direction across the beam", "one along it", remedy));
        }
        let (aspect, reach) = (picture.width as f64 / picture.height as f64, outer.to_radians().tan());
        let height = reach / (1.0 + aspect * aspect).sqrt();
        Ok(Self { picture, up, half: [aspect * height, height] })
    }

    /// Vectors to the right and up: their products with a direction, over its product with the axis, are −1 to 1 on the
    /// picture.
    pub fn axes(&self, axis: DVec3) -> [DVec3; 2] {
        // A beam that turns may pass its upright.
        let right = axis.cross(self.up).try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
        [right / self.half[0], right.cross(axis) / self.half[1]]
    }

    /// Share of the intensity along a direction, bilinear between the middles of pixels; none beside the picture.
    pub fn share(&self, axis: DVec3, d: DVec3) -> DVec3 {
        let [x, y] = self.axes(axis).map(|across| across.dot(d) / axis.dot(d));
        // Not a number across the axis; behind it the picture would stand on its head.
        if axis.dot(d) > 0.0 && x.abs() <= 1.0 && y.abs() <= 1.0 { self.at(x, y) } else { DVec3::ZERO }
    }

    fn at(&self, x: f64, y: f64) -> DVec3 {
        let Picture { width, height, pixels, .. } = &*self.picture;
        let along = |share: f64, count: usize| {
            let at = (share * count as f64 - 0.5).clamp(0.0, (count - 1) as f64);
            (at as usize, (at as usize + 1).min(count - 1), at.fract())
        };
        let (left, right, across) = along(0.5 + 0.5 * x, *width);
        let (upper, lower, down) = along(0.5 - 0.5 * y, *height);
        let pixel = |x: usize, y: usize| DVec3::from(pixels[y * width + x].map(f64::from));
        let row = |y: usize| pixel(left, y).lerp(pixel(right, y), across);
        row(upper).lerp(row(lower), down)
    }

    /// Integral of the beam's share times the picture's over all directions, sr per band: by the midpoint rule.
    pub fn solid_angle(&self, beam: &Beam) -> DVec3 {
        let [right, up] = self.axes(beam.axis);
        let [w, h] = self.half;
        let (x, y) = (right * w * w, up * h * h); // across the picture, a unit along the axis
        let [columns, rows] = [self.picture.width, self.picture.height].map(|side| side * POINTS.div_ceil(side));
        let cell = 4.0 * w * h / (columns * rows) as f64;
        let at = |k: usize, count: usize| 2.0 * (k as f64 + 0.5) / count as f64 - 1.0;
        let point = |k: usize| {
            let (u, v) = (at(k % columns, columns), at(k / columns, rows));
            let way = beam.axis + u * x + v * y;
            let far = way.length();
            self.at(u, v) * (beam.share(way / far) * cell / (far * far * far))
        };
        (0..columns * rows).map(point).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::texel_solid_angle;

    /// Of the midpoint rule on a smooth integrand.
    const MIDPOINT: f64 = 1e-5;

    fn slide(pixels: Vec<[f32; 3]>, width: usize) -> (Slide, Beam) {
        let picture = Picture { file: "s.png".to_owned(), width, height: pixels.len() / width, pixels };
        let half = [0.4, 0.3];
        let beam = Beam { axis: DVec3::NEG_Y, inner: 3.0, outer: 3.0 };
        (Slide { picture: Arc::new(picture), up: DVec3::NEG_Z, half }, beam)
    }

    #[test]
    fn a_picture_stands_upright_and_ends_at_its_rim() {
        let (slide, beam) = slide(vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]], 2);
        let share = |x: f64, z: f64| slide.share(beam.axis, DVec3::new(x, -1.0, z).normalize());
        // Seen along the beam, x is to the right and −z is up.
        assert_eq!(share(-0.3, -0.2), DVec3::new(1.0, 0.0, 0.0), "upper left");
        assert_eq!(share(0.3, -0.2), DVec3::new(0.0, 1.0, 0.0), "upper right");
        assert_eq!(share(-0.3, 0.2), DVec3::new(0.0, 0.0, 1.0), "lower left");
        assert_eq!(share(0.3, 0.2), DVec3::ONE, "lower right");
        assert!((share(0.0, 0.0) - DVec3::splat(0.5)).length() < 1e-12, "the middle is a quarter of each");
        for beside in
            [share(0.41, 0.0), share(0.0, -0.31), slide.share(beam.axis, DVec3::Y), slide.share(beam.axis, DVec3::X)]
        {
            assert_eq!(beside, DVec3::ZERO);
        }
    }

    #[test]
    fn a_white_picture_fills_its_rectangle() {
        let (slide, beam) = slide(vec![[1.0, 0.5, 0.0]; 6], 3);
        let exact = texel_solid_angle(-0.4, -0.3, 0.4, 0.3);
        assert!((slide.solid_angle(&beam) - exact * DVec3::new(1.0, 0.5, 0.0)).length() < MIDPOINT * exact);
    }

    /// One column of three is white: a third of the rectangle, whatever the number of points.
    #[test]
    fn a_large_picture_is_summed_pixel_by_pixel() {
        for lit in 0..3 {
            let pixels = (0..3072).map(|x| if x % 3 == lit { [1.0; 3] } else { [0.0; 3] }).collect();
            let (slide, beam) = slide(pixels, 3072);
            let exact = texel_solid_angle(-0.4, -0.3, 0.4, 0.3) / 3.0;
            assert!((slide.solid_angle(&beam).x - exact).abs() < 1e-3 * exact, "{lit}");
        }
    }

    #[test]
    fn a_beam_along_its_upright_has_a_picture_too() {
        let (slide, _) = slide(vec![[1.0; 3]], 1);
        let [x, y] = slide.axes(DVec3::Z);
        assert!(x.is_finite() && y.is_finite() && x.dot(y).abs() < 1e-12);
    }
}
