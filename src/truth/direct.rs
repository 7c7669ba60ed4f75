//! Direct light with shadows, the mask, and the scene's irradiance of reference E₀.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{
    eye::Eye,
    light::sequence::{draw, stream},
    sums::{BANDS, Sums},
    trace::{Ray, Space, Surface, mask},
};
use crate::scene::{LightKind, Region, Scene};

/// What a seed's numbers are for: eye samples.
const SAMPLES: u64 = 3;
/// Independent pictures of direct light: their spread gives its variance.
const PICTURES: u64 = 8;
/// Each of them has this many samples a pixel along each axis, one anywhere in each cell.
const SIDE: usize = 2;
/// Samples of the region along each axis, for E₀.
const REGION_SIDE: usize = 64;

/// Irradiance (W/m² per band) of all lights at a surface seen along `d`; what is in `mask` casts shadows.
fn irradiance(space: &Space, s: &Surface, d: DVec3, mask: u8) -> DVec3 {
    let geometric = s.facing(d);
    let shading = if geometric == s.ng { s.ns } else { -s.ns };
    let one = |kind: &LightKind| {
        let (towards, reach, facing) = match kind {
            LightKind::Directional { direction, irradiance } => (-*direction, f64::INFINITY, DVec3::from(*irradiance)),
            LightKind::Point { position, intensity } => {
                let way = *position - s.p;
                (way.normalize_or_zero(), way.length(), DVec3::from(*intensity) / way.length_squared())
            }
        };
        let cosine = shading.dot(towards);
        if cosine > 0.0 && geometric.dot(towards) > 0.0 && !space.blocked(&s.ray(towards), reach, mask) {
            facing * cosine
        } else {
            DVec3::ZERO
        }
    };
    space.scene.lights.iter().map(|l| one(&l.kind)).sum()
}

/// The layer of direct light, and what each pixel sees.
pub struct Direct {
    /// Its pictures.
    pub sums: Sums,
    /// Share of each pixel that looks at a specular object.
    pub mask: Vec<f64>,
}

/// Samples every pixel; the same bits for any number of threads.
pub fn direct(space: &Space, eye: &Eye, seed: u64) -> Direct {
    let pixels: Vec<_> = (0..eye.pixels()).into_par_iter().map(|pixel| sample(space, eye, seed, pixel)).collect();
    let mut sums = Sums::new(eye.pixels());
    for k in 0..PICTURES as usize {
        let picture: Vec<f64> = pixels.iter().flat_map(|(e, _)| e[k].to_array()).collect();
        sums.add(&picture);
    }
    Direct { sums, mask: pixels.iter().map(|(_, masked)| *masked).collect() }
}

fn sample(space: &Space, eye: &Eye, seed: u64, pixel: usize) -> ([DVec3; PICTURES as usize], f64) {
    let mut state = stream(&[seed, SAMPLES, pixel as u64]);
    let mut pictures = [DVec3::ZERO; PICTURES as usize];
    let (mut masked, share) = (0.0, 1.0 / (SIDE * SIDE) as f64);
    for picture in &mut pictures {
        for cell in 0..SIDE * SIDE {
            let place = DVec2::new((cell % SIDE) as f64, (cell / SIDE) as f64);
            let at = (place + DVec2::new(draw(&mut state), draw(&mut state))) / SIDE as f64;
            let ray = eye.ray(pixel, at);
            match eye.look(space, &ray) {
                Some(s) if space.material(&s).is_specular() => masked += share / PICTURES as f64,
                Some(s) => *picture += share * irradiance(space, &s, ray.d, mask::ALL),
                None => {}
            }
        }
    }
    (pictures, masked)
}

/// E₀, W/m²: the mean over the region, and over the bands, of all lights' irradiance without the specular objects; if
/// that is 0, the sum of what each light brings to a plane facing it at the region's centre.
pub fn reference_irradiance(space: &Space) -> f64 {
    let region = &space.scene.region;
    let n = REGION_SIDE;
    let mid = |i: usize| 2.0 * (i as f64 + 0.5) / n as f64 - 1.0;
    let at = |k: usize| region.center + mid(k % n) * region.u + mid(k / n) * region.v;
    let sum: DVec3 = (0..n * n).map(|k| on_region(space, region, at(k))).sum();
    let mean = sum.element_sum() / (n * n * BANDS) as f64;
    if mean > 0.0 { mean } else { facing(space.scene, region.center) }
}

fn on_region(space: &Space, region: &Region, p: DVec3) -> DVec3 {
    // Found by a ray from just above, so that it starts on its own surface from there on.
    let normal = region.normal();
    let above = Ray { o: p + normal * region.u.length().min(region.v.length()) * 1e-6, d: -normal, left: None };
    let found = space.nearest(&above, mask::DIFFUSE).filter(|s| s.object == region.receiver);
    found.map_or(DVec3::ZERO, |s| irradiance(space, &s, -normal, mask::DIFFUSE))
}

fn facing(scene: &Scene, p: DVec3) -> f64 {
    let mean = |bands: &[f64; 3]| bands.iter().sum::<f64>() / BANDS as f64;
    let one = |kind: &LightKind| match kind {
        LightKind::Directional { irradiance, .. } => mean(irradiance),
        LightKind::Point { position, intensity } => mean(intensity) / position.distance_squared(p),
    };
    scene.lights.iter().map(|l| one(&l.kind)).sum()
}

/// The pixels whose middle looks at the region, and that see nothing specular.
pub fn judged(space: &Space, eye: &Eye, mask: &[f64]) -> Vec<bool> {
    let region = &space.scene.region;
    let inside = |p: DVec3| {
        let from = p - region.center;
        from.dot(region.u).abs() <= region.u.length_squared() && from.dot(region.v).abs() <= region.v.length_squared()
    };
    let looks = |pixel: usize| {
        let seen = eye.look(space, &eye.ray(pixel, DVec2::splat(0.5)));
        seen.is_some_and(|s| s.object == region.receiver && inside(s.p))
    };
    (0..eye.pixels()).map(|pixel| mask[pixel] == 0.0 && looks(pixel)).collect()
}
