//! From the light to the first diffuse surface: every specular path of a class, its light split by Fresnel's shares.
//!
//! The first [`SPLITS`] events always go both ways, so that a class gets the same flux from a photon whether it is
//! traced alone or among others. Later on a branch of less than [`FAINT`] of the photon goes one way, chosen with
//! Fresnel's share as its chance, and keeps its flux: the mean is the same, the tree stays small.

use glam::DVec3;

use super::{chain::Chain, sequence::draw};
use crate::{
    optics::transmittance,
    scene::{MaterialKind, PathClass},
    truth::trace::{Bend, Ray, Space, Surface, mask},
};

/// Events that always split.
const SPLITS: u32 = 2;
/// Share of a photon's flux below which later events choose.
const FAINT: f64 = 0.02;
/// Media that can lie about a point at once; more are treated as if the innermost of these went on.
const NESTED: usize = 16;

/// A photon at the first diffuse surface of its path.
#[derive(Clone, Copy, Debug)]
pub struct Landing {
    /// Where.
    pub surface: Surface,
    /// Unit geometric normal on the side it came from.
    pub normal: DVec3,
    /// Unit direction of travel.
    pub d: DVec3,
    /// W per band.
    pub flux: DVec3,
    /// What it went through.
    pub chain: Chain,
}

/// Where a photon's flux went, W per band.
#[derive(Clone, Copy, Debug, Default)]
pub struct Balance {
    /// On its way to a specular surface.
    pub emitted: DVec3,
    /// On diffuse surfaces, in the class.
    pub landed: DVec3,
    /// Kept by mirrors and inside media.
    pub absorbed: DVec3,
    /// Left the scene.
    pub missed: DVec3,
    /// Into branches that are not of the class.
    pub other: DVec3,
}

/// The media about a point, outermost first, by material. A material twice is one medium: where two shapes of one
/// material touch or overlap there is no interface between them.
#[derive(Clone, Copy, Debug, Default)]
struct Media {
    held: [u32; NESTED],
    depth: usize,
}

impl Media {
    fn innermost(&self) -> Option<usize> {
        self.depth.checked_sub(1).map(|top| self.held[top] as usize)
    }

    fn entered(mut self, material: usize) -> Self {
        if self.depth < NESTED {
            self.held[self.depth] = material as u32;
            self.depth += 1;
        }
        self
    }

    fn left(mut self, material: usize) -> Self {
        if let Some(at) = self.held[..self.depth].iter().rposition(|m| *m as usize == material) {
            self.held.copy_within(at + 1..self.depth, at);
            self.depth -= 1;
        }
        self
    }
}

#[derive(Clone, Copy)]
struct Branch {
    ray: Ray,
    flux: DVec3,
    /// Share of the photon's flux that Fresnel left.
    share: f64,
    chain: Chain,
    media: Media,
    /// Surfaces crossed, those without an interface too.
    crossed: u32,
}

/// Traces one photon; `random` is its own stream.
pub fn walk(
    space: &Space,
    class: PathClass,
    (ray, flux): (Ray, DVec3),
    mut random: u64,
    land: &mut impl FnMut(&Landing),
) -> Balance {
    let mut balance = Balance::default();
    let Some(first) = space.nearest(&ray, mask::ALL) else { return balance };
    if !space.material(&first).is_specular() {
        return balance; // direct light
    }
    balance.emitted = flux;
    let mut media = Media::default();
    if first.ng.dot(ray.d) > 0.0 {
        media = media.entered(first.material); // the light is inside
    }
    let mut open = vec![Branch { ray, flux, share: 1.0, chain: Chain::default(), media, crossed: 0 }];
    while let Some(mut branch) = open.pop() {
        let Some(surface) = space.nearest(&branch.ray, mask::ALL) else {
            balance.missed += branch.flux;
            continue;
        };
        travel(space, &mut branch, surface.distance, &mut balance);
        if space.material(&surface).is_specular() {
            meet(space, class, &branch, &surface, &mut random, &mut open, &mut balance);
        } else if branch.chain.is_of(class) {
            let (d, chain, flux) = (branch.ray.d, branch.chain, branch.flux);
            balance.landed += flux;
            land(&Landing { surface, normal: surface.facing(d), d, flux, chain });
        } else {
            balance.other += branch.flux;
        }
    }
    balance
}

/// A way through the medium that the branch is in. Light that scatters on the way would leave the branch here.
fn travel(space: &Space, branch: &mut Branch, metres: f64, balance: &mut Balance) {
    let Some(medium) = branch.media.innermost() else { return };
    let MaterialKind::Dielectric { absorption, .. } = space.scene.materials[medium].kind else { return };
    let left = branch.flux * DVec3::from(absorption.map(|a| transmittance(a, metres)));
    balance.absorbed += branch.flux - left;
    branch.flux = left;
}

/// One specular surface: pushes the branches that go on.
fn meet(
    space: &Space,
    class: PathClass,
    branch: &Branch,
    surface: &Surface,
    random: &mut u64,
    open: &mut Vec<Branch>,
    balance: &mut Balance,
) {
    let d = branch.ray.d;
    if branch.crossed >= 4 * PathClass::LONGEST {
        balance.other += branch.flux; // caught between surfaces of one place
        return;
    }
    let after = match space.material(surface).kind {
        MaterialKind::Dielectric { .. } if d.dot(surface.ng) < 0.0 => branch.media.entered(surface.material),
        _ => branch.media.left(surface.material),
    };
    let go = |bend: Bend, transmission: bool, flux: DVec3, share: f64| Branch {
        ray: surface.ray(bend.d),
        flux,
        share,
        chain: branch.chain.then(transmission),
        media: if transmission { after } else { branch.media },
        crossed: branch.crossed + 1,
    };
    if let MaterialKind::Mirror { reflectance } = space.material(surface).kind {
        let flux = branch.flux * DVec3::from(reflectance);
        balance.absorbed += branch.flux - flux;
        push(class, go(surface.reflect(d, 1.0, 1.0), false, flux, branch.share), open, balance);
        return;
    }
    if after.innermost() == branch.media.innermost() {
        let (media, crossed) = (after, branch.crossed + 1);
        open.push(Branch { ray: surface.ray(d), media, crossed, ..*branch }); // no interface
        return;
    }
    let (from, to) = (index(space, branch.media), index(space, after));
    let through = surface.transmit(d, from, to);
    let back = surface.reflect(d, from, to);
    // The two are bent by one normal or, rarely, by two: what passes decides, the rest goes back.
    let passes = through.map_or(0.0, |t| t.share);
    let both = branch.chain.len() < SPLITS || branch.share >= FAINT || !matches!(class, PathClass::All(_));
    let chosen = if both { None } else { Some(draw(random) < passes) };
    let weigh = |share: f64, is: bool| chosen.map_or(share, |c| f64::from(u8::from(c == is)));
    if let Some(bend) = through.filter(|_| weigh(passes, true) > 0.0) {
        let w = weigh(passes, true);
        push(class, go(bend, true, branch.flux * w, branch.share * w), open, balance);
    }
    let w = weigh(1.0 - passes, false);
    if w > 0.0 {
        push(class, go(back, false, branch.flux * w, branch.share * w), open, balance);
    }
}

fn push(class: PathClass, branch: Branch, open: &mut Vec<Branch>, balance: &mut Balance) {
    if branch.flux == DVec3::ZERO {
        return;
    }
    if branch.chain.begins(class) {
        open.push(branch);
    } else {
        balance.other += branch.flux;
    }
}

/// The index of the innermost medium; of none, that of air.
fn index(space: &Space, media: Media) -> f64 {
    match media.innermost().map(|m| &space.scene.materials[m].kind) {
        Some(MaterialKind::Dielectric { ior, .. }) => *ior,
        _ => 1.0,
    }
}
