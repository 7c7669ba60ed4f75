//! From the light to the first diffuse surface: every specular path of a class, its light split by Fresnel's shares.
//!
//! The first [`SPLITS`] events always go both ways, so that a class gets the same flux from a photon whether it is
//! traced alone or among others. Later on, a branch of less than [`FAINT`] of the photon goes one way, chosen with
//! Fresnel's share as its chance, and keeps its flux: the mean is the same, the tree stays small. Where neighbouring
//! rays must take the same ways ([`Faint::Drop`]), branches go both ways until they carry less than [`DROPPED`].

use glam::DVec3;

use super::{
    chain::Chain,
    sequence::{draw, mix},
};
use crate::{
    optics::{fresnel_conductor, transmittance},
    scene::{MaterialKind, PathClass},
    truth::trace::{Bend, Media, Ray, Space, Surface, mask},
};

/// Events that always split.
const SPLITS: u32 = 2;
/// Share of a photon's flux below which later events choose.
const FAINT: f64 = 0.02;
/// Share of a photon's flux below which a branch is dropped where nothing is left to chance.
const DROPPED: f64 = 1e-5;

/// What becomes of faint branches.
#[derive(Clone, Copy, Debug)]
pub enum Faint {
    /// One of the two ways, by this stream of random numbers.
    Choose(u64),
    /// They end, and count as light of other paths.
    Drop,
}

/// A photon at its start.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Where, and where to.
    pub ray: Ray,
    /// W per band.
    pub flux: DVec3,
    /// The media about a light that has a place. Light from infinity starts in whatever its first surface bounds, and
    /// loses nothing on the way there: how far it came is not defined.
    pub media: Option<Media>,
    /// The band whose indices bend it; its flux has no other, unless all bands bend alike.
    pub band: usize,
}

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
    /// The objects that it met and how each bent it, mixed into a number: neighbours on one sheet of light share it.
    pub path: u64,
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

#[derive(Clone, Copy)]
struct Branch {
    ray: Ray,
    flux: DVec3,
    /// Share of the photon's flux that Fresnel left.
    share: f64,
    chain: Chain,
    path: u64,
    media: Media,
    /// Surfaces crossed, those without an interface too.
    crossed: u32,
}

/// Traces one photon and shows its landings to `land`.
pub fn walk(space: &Space, class: PathClass, start: &Start, faint: Faint, land: &mut impl FnMut(&Landing)) -> Balance {
    let (ray, flux) = (start.ray, start.flux);
    let mut walk = Walk { space, class, band: start.band, faint, open: vec![], balance: Balance::default() };
    let Some(mut surface) = space.nearest(&ray, mask::ALL) else { return walk.balance };
    if !space.material(&surface).is_specular() {
        return walk.balance; // direct light
    }
    walk.balance.emitted = flux;
    let mut media = start.media.unwrap_or_default();
    let dielectric = matches!(space.material(&surface).kind, MaterialKind::Dielectric { .. });
    if dielectric && surface.ng.dot(ray.d) > 0.0 && !media.holds(surface.material) {
        media = media.entered(surface.material); // from infinity, or through a hole
    }
    let path = if start.band == 0 { 0 } else { mix(start.band as u64) };
    let mut branch = Branch { ray, flux, share: 1.0, chain: Chain::default(), path, media, crossed: 0 };
    if start.media.is_some() {
        walk.travel(&mut branch, surface.distance);
    }
    walk.meet(&branch, &surface);
    while let Some(next) = walk.open.pop() {
        branch = next;
        surface = match space.nearest(&branch.ray, mask::ALL) {
            Some(surface) => surface,
            None => {
                walk.balance.missed += branch.flux;
                continue;
            }
        };
        walk.travel(&mut branch, surface.distance);
        if space.material(&surface).is_specular() {
            walk.meet(&branch, &surface);
        } else if branch.chain.is_of(class) {
            let Branch { ray: Ray { d, .. }, chain, path, flux, .. } = branch;
            walk.balance.landed += flux;
            land(&Landing { surface, normal: surface.facing(d), d, flux, chain, path });
        } else {
            walk.balance.other += branch.flux;
        }
    }
    walk.balance
}

/// A photon under way.
struct Walk<'a> {
    space: &'a Space<'a>,
    class: PathClass,
    band: usize,
    faint: Faint,
    open: Vec<Branch>,
    balance: Balance,
}

impl Walk<'_> {
    /// A way through the medium that the branch is in. Light that scatters on the way would leave the branch here.
    fn travel(&mut self, branch: &mut Branch, metres: f64) {
        let Some(medium) = branch.media.innermost() else { return };
        let MaterialKind::Dielectric { absorption, .. } = self.space.scene.materials[medium].kind else { return };
        let left = branch.flux * DVec3::from(absorption.map(|a| transmittance(a, metres)));
        self.balance.absorbed += branch.flux - left;
        branch.flux = left;
    }

    /// One specular surface: pushes the branches that go on.
    fn meet(&mut self, branch: &Branch, surface: &Surface) {
        let d = branch.ray.d;
        if branch.crossed >= 4 * PathClass::LONGEST {
            self.balance.other += branch.flux; // caught between surfaces of one place
            return;
        }
        let after = match self.space.material(surface).kind {
            MaterialKind::Dielectric { .. } if d.dot(surface.ng) < 0.0 => branch.media.entered(surface.material),
            _ => branch.media.left(surface.material),
        };
        let back = surface.reflect(d, 1.0, 1.0);
        if let Some(share) = self.mirror(&self.space.material(surface).kind, d, back.d, branch.media) {
            let flux = branch.flux * share;
            self.balance.absorbed += branch.flux - flux;
            self.push(branch.bent(surface, back, false, branch.media, flux, branch.share));
            return;
        }
        if after.innermost() == branch.media.innermost() {
            let (media, crossed) = (after, branch.crossed + 1);
            self.open.push(Branch { ray: surface.ray(d), media, crossed, ..*branch }); // no interface
            return;
        }
        self.split(branch, surface, after);
    }

    /// An interface: Fresnel's shares go on, or by chance one of them.
    fn split(&mut self, branch: &Branch, surface: &Surface, after: Media) {
        let d = branch.ray.d;
        let (from, to) = (self.index(branch.media), self.index(after));
        let through = surface.transmit(d, from, to);
        let back = surface.reflect(d, from, to);
        // The two are bent by one normal or, rarely, by two: what passes decides, the rest goes back.
        let passes = through.map_or(0.0, |t| t.share);
        let both = branch.chain.len() < SPLITS || branch.share >= FAINT || !matches!(self.class, PathClass::All(_));
        let chosen = match &mut self.faint {
            Faint::Choose(random) if !both => Some(draw(random) < passes),
            _ => None,
        };
        let weigh = |share: f64, is: bool| chosen.map_or(share, |c| f64::from(u8::from(c == is)));
        let w = weigh(passes, true);
        if let Some(bend) = through.filter(|_| w > 0.0) {
            self.push(branch.bent(surface, bend, true, after, branch.flux * w, branch.share * w));
        }
        let w = weigh(1.0 - passes, false);
        if w > 0.0 {
            self.push(branch.bent(surface, back, false, branch.media, branch.flux * w, branch.share * w));
        }
    }

    /// What an opaque mirror sends back, of light along d that goes on along r; of anything else, `None`.
    fn mirror(&self, kind: &MaterialKind, d: DVec3, r: DVec3, media: Media) -> Option<DVec3> {
        match kind {
            MaterialKind::Mirror { reflectance } => Some(DVec3::from(*reflectance)),
            MaterialKind::Conductor { eta, k } => {
                let cosine = (0.5 - 0.5 * d.dot(r)).max(0.0).sqrt();
                let share = |band: usize| {
                    let n = self.index_of(media, band);
                    fresnel_conductor(cosine, eta[band] / n, k[band] / n)
                };
                Some(DVec3::new(share(0), share(1), share(2)))
            }
            MaterialKind::Diffuse { .. } | MaterialKind::Dielectric { .. } => None,
        }
    }

    /// The index of the innermost medium for the band at hand.
    fn index(&self, media: Media) -> f64 {
        self.index_of(media, self.band)
    }

    /// The index of the innermost medium; of none, that of air.
    fn index_of(&self, media: Media, band: usize) -> f64 {
        match media.innermost().map(|m| &self.space.scene.materials[m].kind) {
            Some(MaterialKind::Dielectric { ior, .. }) => ior[band],
            _ => 1.0,
        }
    }

    fn push(&mut self, branch: Branch) {
        if branch.flux == DVec3::ZERO {
            return;
        }
        let dropped = matches!(self.faint, Faint::Drop) && branch.share < DROPPED;
        if branch.chain.begins(self.class) && !dropped {
            self.open.push(branch);
        } else {
            self.balance.other += branch.flux;
        }
    }
}

impl Branch {
    /// What goes on after one more event, with this flux and share.
    fn bent(&self, at: &Surface, bend: Bend, transmission: bool, media: Media, flux: DVec3, share: f64) -> Self {
        Self {
            ray: at.ray(bend.d),
            flux,
            share,
            chain: self.chain.then(transmission),
            path: mix(self.path ^ (2 * at.object as u64 + u64::from(transmission))),
            media,
            crossed: self.crossed + 1,
        }
    }
}
