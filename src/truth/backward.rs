//! A backward tracer's rays: from a receiver up to the lights, to count how many of them come to anything.
//!
//! They are the candidates of a Monte Carlo sum over the hemisphere: what a ray meets bends it by Snell's law in reverse, and it is
//! of use if it leaves the scene towards a sun's disc. A sun without a disc is met by none.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{
    light::sequence::{draw, stream},
    trace::{Ray, Space, mask},
};
use crate::scene::{LightKind, MaterialKind, PathClass};

/// What a seed's numbers are for: rays backward.
const BACKWARD: u64 = 5;
/// How far above its place the receiver is looked for, relative to the region's size.
const CLEAR: f64 = 1e-6;
/// Rays of a chunk.
const CHUNK: u64 = 1 << 12;

/// Which ways rays leave a point of the receiver's region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beam {
    /// All of the hemisphere above it, evenly by solid angle.
    Hemisphere,
    /// Along its normal alone.
    Vertical,
}

/// Rays, and how many of them met a sun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Useful {
    /// All of them.
    pub rays: u64,
    /// Those that went through something specular and met a sun's disc.
    pub met: u64,
}

/// Sends about `rays` from places all over the region, whole chunks of them. The same numbers for any number of threads.
pub fn useful(space: &Space, beam: Beam, rays: u64, seed: u64) -> Useful {
    let chunks = rays.div_ceil(CHUNK);
    let of_chunk = |k: u64| {
        let mut state = stream(&[seed, BACKWARD, beam as u64, k]);
        (0..CHUNK).filter(|_| meets(space, beam, &mut state)).count() as u64
    };
    Useful { rays: chunks * CHUNK, met: (0..chunks).into_par_iter().map(of_chunk).sum() }
}

/// Whether one ray, drawn at random, is of use.
fn meets(space: &Space, beam: Beam, random: &mut u64) -> bool {
    let region = &space.scene.region;
    let at = 2.0 * DVec2::new(draw(random), draw(random)) - 1.0;
    let (normal, place) = (region.normal(), region.center + at.x * region.u + at.y * region.v);
    let up = match beam {
        Beam::Vertical => normal,
        Beam::Hemisphere => {
            let (cosine, turn) = (draw(random), std::f64::consts::TAU * draw(random));
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let (x, y) = normal.any_orthonormal_pair();
            cosine * normal + sine * (turn.cos() * x + turn.sin() * y)
        }
    };
    // Looked for from just above, so that the ray knows what it starts on and does not meet it again.
    let above = CLEAR * (region.u.length() + region.v.length());
    let down = Ray { o: place + above * normal, d: -normal, left: None };
    let Some(floor) = space.nearest(&down, mask::DIFFUSE) else { return false };
    leaves(space, floor.ray(up)).is_some_and(|d| is_lit(space, d))
}

/// The direction in which a ray leaves the scene, if it went through something specular and met nothing else.
fn leaves(space: &Space, mut ray: Ray) -> Option<DVec3> {
    for event in 0..=PathClass::LONGEST {
        let Some(surface) = space.nearest(&ray, mask::ALL) else { return (event > 0).then_some(ray.d) };
        let MaterialKind::Dielectric { ior, .. } = space.material(&surface).kind else { return None };
        let (from, to) = if ray.d.dot(surface.ng) > 0.0 { (ior[0], 1.0) } else { (1.0, ior[0]) };
        ray = surface.ray(surface.transmit(ray.d, from, to)?.d);
    }
    None
}

fn is_lit(space: &Space, d: DVec3) -> bool {
    space.scene.lights.iter().any(|light| match &light.kind {
        LightKind::Sun { direction, radius, .. } => d.angle_between(-*direction) <= *radius,
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn flat(sun: &str, width: &str) -> Scene {
        let set = [("lights.sun.directional.direction", sun), ("lights.sun.directional.angular_diameter", width)];
        let set = set.map(|(key, value)| (key.to_owned(), value.to_owned()));
        Scene::load("flat-water", &set).unwrap()
    }

    /// Below flat water a disc of half angle α overhead is one of asin(sin α / n): the share of the hemisphere is 1 − cos of it.
    #[test]
    fn the_share_below_flat_water_is_the_discs_solid_angle() {
        let scene = flat("[0, -1, 0]", "40");
        let space = Space::new(&scene);
        let Useful { rays, met } = useful(&space, Beam::Hemisphere, 1 << 16, 1);
        let exact = 1.0 - (20f64.to_radians().sin() / 1.33).asin().cos();
        let (found, sigma) = (met as f64 / rays as f64, (exact / rays as f64).sqrt());
        assert!((found - exact).abs() < 4.0 * sigma, "{found} for {exact}");
        assert_eq!(useful(&space, Beam::Hemisphere, 1 << 16, 1).met, met, "the same again");
        assert_eq!(useful(&space, Beam::Vertical, 1, 1), Useful { rays: CHUNK, met: CHUNK });
    }

    #[test]
    fn a_slanting_sun_is_met_by_no_vertical_ray_and_a_sun_without_a_disc_by_none() {
        let slanting = flat("[1, -1, 0]", "0.53");
        assert_eq!(useful(&Space::new(&slanting), Beam::Vertical, 1, 1).met, 0);
        let point = Scene::load("flat-water", &[]).unwrap();
        assert_eq!(useful(&Space::new(&point), Beam::Hemisphere, 1, 1).met, 0);
    }
}
