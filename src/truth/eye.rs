//! The eye: which pixel sees a point, and how much of the pixel a square metre there fills.

use glam::{DVec2, DVec3};

use super::trace::{Ray, Space, Surface, mask};
use crate::scene::{Camera, CameraKind};

/// A camera and its picture.
#[derive(Clone, Debug)]
pub struct Eye {
    position: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Half the window: metres if orthographic, tangents if perspective.
    half: DVec2,
    perspective: bool,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// What it sees (see [`mask`]).
    mask: u8,
}

/// A point as the eye sees it.
#[derive(Clone, Copy, Debug)]
pub struct Projected {
    /// Pixels from the left and from the top; outside the picture too.
    pub at: DVec2,
    /// By what a length across the axis is divided in the picture's plane: metres along the axis, or 1 if orthographic.
    pub scale: f64,
    /// Unit direction to the eye.
    pub towards: DVec3,
    /// Metres to the eye (to the camera's plane, if orthographic).
    pub distance: f64,
    /// Share of the pixel per square metre facing the eye, 1/m².
    pub density: f64,
}

impl Eye {
    /// A camera of the scene with a picture of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let forward = (camera.target - camera.position).normalize_or(DVec3::NEG_Z);
        let right = forward.cross(camera.up).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
        let aspect = f64::from(size[0]) / f64::from(size[1].max(1));
        let (half, perspective) = match camera.kind {
            CameraKind::Pinhole { fov_y } => (DVec2::new(aspect, 1.0) * (0.5 * fov_y.to_radians()).tan(), true),
            CameraKind::Orthographic { height, width } => {
                (0.5 * DVec2::new(width.unwrap_or(height * aspect), height), false)
            }
        };
        let mask = mask::SEEN_DIFFUSE | if camera.hides_specular { 0 } else { mask::SEEN_SPECULAR };
        Self { position: camera.position, right, up: right.cross(forward), forward, half, perspective, size, mask }
    }

    /// Pixels of the picture.
    pub fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// The ray through a point of a pixel (0..1, y downwards).
    pub fn ray(&self, pixel: usize, at: DVec2) -> Ray {
        let [width, height] = self.size.map(f64::from);
        let (x, y) = (pixel % self.size[0] as usize, pixel / self.size[0] as usize);
        let window = DVec2::new((x as f64 + at.x) / width, (y as f64 + at.y) / height) * 2.0 - 1.0;
        let across = self.right * (window.x * self.half.x) - self.up * (window.y * self.half.y);
        if self.perspective {
            Ray { o: self.position, d: (self.forward + across).normalize(), left: None }
        } else {
            Ray { o: self.position + across, d: self.forward, left: None }
        }
    }

    /// The first surface that the eye sees along a ray of its own.
    pub fn look(&self, space: &Space, ray: &Ray) -> Option<Surface> {
        space.nearest(ray, self.mask)
    }

    /// Where a point is in the picture's plane, whatever lies between; `None` behind the eye.
    pub fn project(&self, p: DVec3) -> Option<Projected> {
        let way = p - self.position;
        let depth = way.dot(self.forward);
        if depth.is_nan() || depth <= 0.0 {
            return None;
        }
        let scale = if self.perspective { depth } else { 1.0 };
        let window = DVec2::new(way.dot(self.right), -way.dot(self.up)) / (scale * self.half);
        let [width, height] = self.size.map(f64::from);
        let at = DVec2::new((window.x + 1.0) * 0.5 * width, (window.y + 1.0) * 0.5 * height);
        let area = 4.0 * self.half.x * self.half.y / (width * height);
        if self.perspective {
            // Solid angle to area of the window: 1/cos³ of the angle to the axis.
            let distance = way.length();
            let cosine = depth / distance;
            let density = 1.0 / (distance * distance * cosine * cosine * cosine * area);
            Some(Projected { at, scale, towards: -way / distance, distance, density })
        } else {
            Some(Projected { at, scale, towards: -self.forward, distance: depth, density: 1.0 / area })
        }
    }

    /// The pixel at a place of the picture's plane; `None` outside the picture.
    pub fn pixel(&self, at: DVec2) -> Option<usize> {
        let [width, height] = self.size.map(f64::from);
        let inside = at.x >= 0.0 && at.x < width && at.y >= 0.0 && at.y < height;
        inside.then(|| at.y as usize * self.size[0] as usize + at.x as usize)
    }

    /// Whether anything that the eye sees hides a point of a surface from it. `from` starts on the surface.
    pub fn hidden(&self, space: &Space, from: &Ray, distance: f64) -> bool {
        space.blocked(from, distance, self.mask)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Midpoint rule over 200² cells of a smooth density.
    const MIDPOINT: f64 = 1e-4;

    #[test]
    fn a_ray_of_a_pixel_is_seen_by_it() {
        let scene = Scene::load("glass-sphere", &[]).unwrap();
        for name in ["main", "region"] {
            let eye = Eye::new(&scene.cameras[name], [12, 7]);
            for pixel in 0..eye.pixels() {
                let ray = eye.ray(pixel, DVec2::new(0.3, 0.9));
                let seen = eye.project(ray.o + 2.5 * ray.d).unwrap();
                let found = eye.pixel(seen.at) == Some(pixel);
                assert!(found && (seen.towards + ray.d).length() < 1e-12, "{name} {pixel}: {seen:?}");
            }
            assert!(eye.project(eye.position - eye.forward).is_none());
        }
    }

    #[test]
    fn densities_over_a_plane_add_up_to_the_pixels() {
        let scene = Scene::load("glass-sphere", &[]).unwrap();
        for name in ["main", "region"] {
            let eye = Eye::new(&scene.cameras[name], [1, 1]);
            // A plane across the axis at 2 m, cut into cells: each fills its share of the one pixel.
            let reach = eye.half * if eye.perspective { 2.0 } else { 1.0 };
            let cells = 200;
            let cell = 4.0 * reach.x * reach.y / f64::from(cells * cells);
            let mid = |i: i32| 2.0 * (f64::from(i) + 0.5) / f64::from(cells) - 1.0;
            let at = |k: i32| eye.right * (reach.x * mid(k % cells)) + eye.up * (reach.y * mid(k / cells));
            let points = (0..cells * cells).map(|k| eye.position + 2.0 * eye.forward + at(k));
            let sum: f64 =
                points.filter_map(|p| eye.project(p)).map(|s| cell * -s.towards.dot(eye.forward) * s.density).sum();
            assert!((sum - 1.0).abs() < MIDPOINT, "{name}: {sum}");
        }
    }
}
