//! Direct light with shadows, and the mask.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::ops::ControlFlow;

use super::{
    estimate::Sums,
    eye::Eye,
    light::{
        area,
        sequence::{draw, stream},
    },
    trace::{Space, Surface, mask},
};
use crate::{
    optics::transmittance,
    scene::{LightKind, MaterialKind},
};

/// What a seed's numbers are for: eye samples.
const SAMPLES: u64 = 3;
/// Independent pictures of direct light: their spread gives its variance.
const PICTURES: u64 = 8;
/// Each of them has this many samples a pixel along each axis, one anywhere in each cell.
const SIDE: usize = 2;
/// Points of a light with a size along each axis, for each sample, one anywhere in each cell.
const OF_LIGHT: usize = 2;

/// A light, and the absorption of the medium that it is in, 1/m per band.
type Lamp<'a> = (&'a LightKind, [f64; 3]);

fn lamps<'a>(space: &Space<'a>) -> Vec<Lamp<'a>> {
    space.scene.lights.iter().map(|l| (&l.kind, absorption(space, &l.kind))).collect()
}

fn absorption(space: &Space, kind: &LightKind) -> [f64; 3] {
    let Some(position) = kind.position() else { return [0.0; 3] };
    match space.media(position).innermost().map(|m| &space.scene.materials[m].kind) {
        Some(MaterialKind::Dielectric { absorption, .. }) => *absorption,
        _ => [0.0; 3],
    }
}

/// Irradiance (W/m² per band) of all lights at a surface seen along `d`. Points of lights with a size are drawn.
fn irradiance(space: &Space, lamps: &[Lamp], s: &Surface, d: DVec3, random: &mut u64) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for lamp in lamps {
        sum += if lamp.0.has_area() { by_points(space, lamp.0, s, d, random) } else { by_one(space, lamp, s, d) };
    }
    sum
}

/// The mean of what a light's points would give, were each all of it.
fn by_points(space: &Space, kind: &LightKind, s: &Surface, d: DVec3, random: &mut u64) -> DVec3 {
    let points = (0..OF_LIGHT * OF_LIGHT).map(|cell| {
        let place = DVec2::new((cell % OF_LIGHT) as f64, (cell / OF_LIGHT) as f64);
        (place + DVec2::new(draw(random), draw(random))) / OF_LIGHT as f64
    });
    let point = |on| Some(area::point(kind, on)?).map(|one| by_one(space, &(&one, absorption(space, &one)), s, d));
    points.filter_map(point).sum::<DVec3>() / (OF_LIGHT * OF_LIGHT) as f64
}

/// Of a light without size. All that there is casts shadows, so light that arrives has been in the light's own medium all
/// the way.
fn by_one(space: &Space, (kind, absorption): &Lamp, s: &Surface, d: DVec3) -> DVec3 {
    let normal = s.facing(d); // geometric: irradiance is flux over area
    let (towards, reach, facing) = match kind {
        LightKind::Sun { .. } | LightKind::Lamp { .. } => return DVec3::ZERO, // of their points
        LightKind::Directional { direction, irradiance } => (-*direction, f64::INFINITY, DVec3::from(*irradiance)),
        LightKind::Point { position, intensity }
        | LightKind::Spot { position, intensity, .. }
        | LightKind::Patch { position, intensity, .. } => {
            let way = *position - s.p;
            let (towards, left) = (way.normalize_or_zero(), absorption.map(|a| transmittance(a, way.length())));
            let intensity = DVec3::from(*intensity) * DVec3::from(left) * kind.share(-towards);
            (towards, way.length(), intensity / way.length_squared())
        }
    };
    let cosine = normal.dot(towards);
    let lit = cosine > 0.0 && facing != DVec3::ZERO && !space.blocked(&s.ray(towards), reach, mask::ALL);
    if lit { facing * cosine } else { DVec3::ZERO }
}

/// The layer of direct light, and what each pixel sees.
pub struct Direct {
    /// Its pictures.
    pub sums: Sums,
    /// Share of each pixel that looks at a specular object.
    pub mask: Vec<f64>,
}

/// Pixels between two looks at whether to go on.
const BLOCK: usize = 1 << 14;

/// Samples every pixel; the same bits for any number of threads. `watch` is told the share that is done; `None` if it breaks
/// off.
pub fn direct(space: &Space, eye: &Eye, seed: u64, watch: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Option<Direct> {
    let lamps = lamps(space);
    let sample = |pixel| sample(space, &lamps, eye, seed, pixel);
    let mut pixels: Vec<([DVec3; PICTURES as usize], f64)> = Vec::with_capacity(eye.pixels());
    while pixels.len() < eye.pixels() {
        let block = pixels.len()..(pixels.len() + BLOCK).min(eye.pixels());
        pixels.par_extend(block.into_par_iter().map(sample));
        if watch(pixels.len() as f64 / eye.pixels() as f64).is_break() {
            return None;
        }
    }
    let mut sums = Sums::new(eye.pixels());
    for k in 0..PICTURES as usize {
        let picture: Vec<f64> = pixels.iter().flat_map(|(e, _)| e[k].to_array()).collect();
        sums.add(&picture);
    }
    Some(Direct { sums, mask: pixels.iter().map(|(_, masked)| *masked).collect() })
}

fn sample(space: &Space, lamps: &[Lamp], eye: &Eye, seed: u64, pixel: usize) -> ([DVec3; PICTURES as usize], f64) {
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
                Some(s) => *picture += share * irradiance(space, lamps, &s, ray.d, &mut state),
                None => {}
            }
        }
    }
    (pictures, masked)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// The middle of one pixel of 64 stands for the point under the lamp: second order in 1/64.
    const PIXEL: f64 = 1e-3;

    /// Points drawn on the light, 128 of them: unshadowed, their mean strays by less than this.
    const DRAWN: f64 = 3e-3;

    /// Under the middle of a disk of radius R at height h, E = π L R² / (R² + h²).
    #[test]
    fn a_disk_that_shines_by_hand() {
        let text = Scene::load("flat-water", &[]).unwrap().source.text;
        let (above, _) = text.split_once("[lights.sun").unwrap();
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("area.toml");
        let disk = "{ disk = { center = [0, -0.5, 0], normal = [0, -1, 0], radius = 0.2, radiance = 3 } }";
        let exact = 3.0 * std::f64::consts::PI * 0.04 / (0.04 + 0.25);
        std::fs::write(&file, format!("{above}[lights]\nlamp = {disk}\n")).unwrap();
        let scene = Scene::load(file.to_str().unwrap(), &[]).unwrap();
        let (space, size) = (Space::new(&scene), 65);
        let eye = Eye::new(&scene.cameras["region"], [size; 2]);
        let sums = direct(&space, &eye, 1, &mut |_| ControlFlow::Continue(())).unwrap().sums;
        let found = sums.mean().nth((size * size / 2) as usize * 3).unwrap();
        assert!((found / exact - 1.0).abs() < DRAWN, "{found} for {exact}");
    }

    /// A lamp under coloured water lights the floor below it through the water between them.
    #[test]
    fn a_submerged_lamp_is_absorbed_on_its_way() {
        let text = Scene::load("flat-water", &[]).unwrap().source.text;
        let (above, _) = text.split_once("[lights.sun").unwrap();
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("lamp.toml");
        let text = above.replace("absorption = 0.0", "absorption = [0.0, 0.5, 2.0]");
        std::fs::write(&file, text + "[lights.lamp.point]\nposition = [0.0, -0.2, 0.0]\nintensity = 3.0\n").unwrap();
        let scene = Scene::load(file.to_str().unwrap(), &[]).unwrap();
        let (space, size) = (Space::new(&scene), 65);
        let eye = Eye::new(&scene.cameras["region"], [size; 2]);
        let layer: Vec<f64> =
            direct(&space, &eye, 1, &mut |_| ControlFlow::Continue(())).unwrap().sums.mean().collect();
        let middle = (size * size / 2) as usize * 3;
        for (band, absorption) in [0.0, 0.5, 2.0].into_iter().enumerate() {
            let exact = 3.0 / 0.64 * f64::exp(-0.8 * absorption);
            let found = layer[middle + band];
            assert!((found / exact - 1.0).abs() < PIXEL, "band {band}: {found} for {exact}");
        }
    }
}
