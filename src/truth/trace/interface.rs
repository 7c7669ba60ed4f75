//! What a smooth surface does to a ray: Snell, Fresnel, and the convention for interpolated normals.
//!
//! The interpolated normal bends the ray, the geometric one decides on which side it goes on: a ray that the
//! interpolated normal faces away from, or would bend through the surface, is bent by the geometric normal.

use glam::DVec3;

use super::Surface;
use crate::optics::{fresnel, reflect, refract};

/// Where a ray goes on, and the share of its light that does.
#[derive(Clone, Copy, Debug)]
pub struct Bend {
    /// Unit direction.
    pub d: DVec3,
    /// Fresnel's share, in [0, 1].
    pub share: f64,
}

impl Surface {
    /// The normal that bends a ray along `d`: the interpolated one, on the ray's side.
    fn bending(&self, d: DVec3) -> DVec3 {
        let n = if d.dot(self.ng) <= 0.0 { self.ns } else { -self.ns };
        if d.dot(n) < 0.0 { n } else { self.facing(d) }
    }

    /// Transmission from index `from` into `to`; `None` on total reflection.
    pub fn transmit(&self, d: DVec3, from: f64, to: f64) -> Option<Bend> {
        let (mut n, geometric) = (self.bending(d), self.facing(d));
        let mut t = refract(d, n, from / to)?;
        if n != geometric && t.dot(geometric) >= 0.0 {
            n = geometric;
            t = refract(d, n, from / to)?;
        }
        Some(Bend { d: t.normalize(), share: 1.0 - fresnel(-d.dot(n), from, to) })
    }

    /// Reflection; the share is Fresnel's between the two indices, and of no meaning to a mirror.
    pub fn reflect(&self, d: DVec3, from: f64, to: f64) -> Bend {
        let (mut n, geometric) = (self.bending(d), self.facing(d));
        let mut r = reflect(d, n);
        if n != geometric && r.dot(geometric) <= 0.0 {
            n = geometric;
            r = reflect(d, n);
        }
        Bend { d: r.normalize(), share: fresnel(-d.dot(n), from, to) }
    }
}
