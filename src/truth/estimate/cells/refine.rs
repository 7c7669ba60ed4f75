//! A cell between four rays: whole sheets of light are spread, the others cut into four.
//!
//! A path (the objects met, and how each bent the light) is a whole sheet over a cell if its four corners and its centre
//! all go that way, land on one object, are seen alike, and lie where a flat sheet would have them. What is not whole at
//! the deepest level lands at the centre's place as a point: the share of the flux that does is counted as unresolved.

use glam::{DVec2, DVec3};

use super::spread::{Vertex, spread};
use crate::{
    scene::PathClass,
    truth::{
        estimate::BANDS,
        eye::Eye,
        light::{Emission, follow},
        trace::Space,
    },
};

/// Halvings of a cell's side at most.
const DEEPEST: u32 = 6;
/// Pixels by which a cell's centre may land beside the middle of its corners.
const BESIDE: f64 = 0.05;
/// The same, relative to how far apart the corners land: large cells are not held to small pixels' tolerance alone.
const BEND: f64 = 0.02;
/// Share of a sheet's flux by which its centre may differ from the mean of its corners.
const UNEVEN: f64 = 0.01;

/// A square of an emission's unit square.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Its lower corner.
    pub low: DVec2,
    /// Its side.
    pub size: f64,
    /// How often a cell of the grid was halved.
    pub level: u32,
}

/// One landing of a ray.
#[derive(Clone, Copy, Debug)]
pub struct Landed {
    path: u64,
    receiver: usize,
    /// Of the flux emitted, per band.
    share: DVec3,
    /// Where the eye sees it, if it does.
    seen: Option<Vertex>,
}

/// Flux by how it was dealt with, W, mean of the bands.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spent {
    /// Landed in all.
    pub landed: f64,
    /// Of it, as points.
    pub unresolved: f64,
}

impl Spent {
    /// How many numbers it is.
    pub const NUMBERS: usize = 2;

    /// Both together.
    pub fn plus(&self, other: &Self) -> Self {
        Self { landed: self.landed + other.landed, unresolved: self.unresolved + other.unresolved }
    }

    /// As numbers that can be added.
    pub fn to_numbers(self) -> [f64; Self::NUMBERS] {
        [self.landed, self.unresolved]
    }

    /// From [`Self::to_numbers`].
    pub fn from_numbers(numbers: &[f64]) -> Self {
        let at = |k: usize| numbers.get(k).copied().unwrap_or(0.0);
        Self { landed: at(0), unresolved: at(1) }
    }

    /// 0 where nothing landed.
    pub fn unresolved_share(&self) -> f64 {
        if self.landed > 0.0 { self.unresolved / self.landed } else { 0.0 }
    }
}

/// Settles the cells of one light into a picture.
pub struct Refiner<'a> {
    space: &'a Space<'a>,
    eye: &'a Eye,
    class: PathClass,
    light: &'a Emission,
    /// Share of a light that has a size that it stands for.
    part: f64,
    picture: &'a mut [f64],
    spent: Spent,
}

/// A cell's landings at its four corners, in their order round it.
pub type Corners<'c> = [&'c [Landed]; 4];

impl<'a> Refiner<'a> {
    /// For one light, and which part it is of one that has a size; `picture` gets irradiance.
    pub fn new(
        space: &'a Space<'a>,
        eye: &'a Eye,
        class: PathClass,
        (light, part): (&'a Emission, f64),
        picture: &'a mut [f64],
    ) -> Self {
        Self { space, eye, class, light, part, picture, spent: Spent::default() }
    }

    /// Where the flux went.
    pub fn spent(&self) -> Spent {
        self.spent
    }

    /// The landings of one ray, by path.
    pub fn look(&self, at: DVec2) -> Vec<Landed> {
        let mut landed = Vec::new();
        follow(self.space, self.class, self.light, at, |landing| {
            let seen = self.eye.project(landing.surface.p).and_then(|seen| {
                let cosine = seen.towards.dot(landing.normal);
                let from = landing.surface.ray(seen.towards);
                let lit = cosine > 0.0 && !self.eye.hidden(self.space, &from, seen.distance);
                lit.then_some(Vertex { at: seen.at, inverse: 1.0 / seen.scale, density: cosine * seen.density })
            });
            landed.push(Landed { path: landing.path, receiver: landing.surface.object, share: landing.flux, seen });
        });
        landed.sort_by_key(|l| l.path);
        landed
    }

    /// Spreads the whole sheets over the cell and goes into its quarters for the others; `done` are paths that were
    /// settled before.
    pub fn settle(&mut self, cell: &Cell, corners: Corners, done: &[u64]) {
        let half = 0.5 * cell.size;
        let centre = self.look(cell.low + half);
        let mut settled = done.to_vec();
        let mut broken = false;
        for path in paths(&corners, &centre).filter(|p| !done.contains(p)) {
            let five = [corners[0], corners[1], corners[2], corners[3], &centre].map(|landed| find(landed, path));
            if let Some(sheet) = whole(five) {
                self.spread(cell, &sheet);
            } else if cell.level < deepest(five, self.part) {
                broken = true;
                continue;
            } else if let Some(landed) = five[4] {
                self.point(cell, landed);
            }
            settled.push(path);
        }
        if broken {
            self.quarter(cell, corners, &centre, &settled);
        }
    }

    fn quarter(&mut self, cell: &Cell, [a, b, c, d]: Corners, centre: &[Landed], settled: &[u64]) {
        let half = 0.5 * cell.size;
        let place = |x: f64, y: f64| cell.low + half * DVec2::new(x, y);
        let [ab, bc, cd, da] =
            [place(1.0, 0.0), place(2.0, 1.0), place(1.0, 2.0), place(0.0, 1.0)].map(|at| self.look(at));
        let quarter = |x: f64, y: f64| Cell { low: place(x, y), size: half, level: cell.level + 1 };
        self.settle(&quarter(0.0, 0.0), [a, &ab, centre, &da], settled);
        self.settle(&quarter(1.0, 0.0), [&ab, b, &bc, centre], settled);
        self.settle(&quarter(1.0, 1.0), [centre, &bc, c, &cd], settled);
        self.settle(&quarter(0.0, 1.0), [&da, centre, &cd, d], settled);
    }

    /// Four triangles about the centre, each with a quarter of the cell's flux.
    fn spread(&mut self, cell: &Cell, sheet: &[Landed; 5]) {
        let flux = self.light.flux() * (0.25 * cell.size * cell.size);
        for k in 0..4 {
            let three = [sheet[k], sheet[(k + 1) % 4], sheet[4]];
            let landed = flux * three.iter().map(|l| l.share).sum::<DVec3>() / 3.0;
            self.spent.landed += landed.element_sum() / 3.0;
            if let [Some(a), Some(b), Some(c)] = three.map(|l| l.seen) {
                spread(self.eye, &[a, b, c], |pixel, share| add(self.picture, pixel, landed * share));
            }
        }
    }

    fn point(&mut self, cell: &Cell, landed: &Landed) {
        let flux = self.light.flux() * landed.share * (cell.size * cell.size);
        self.spent.landed += flux.element_sum() / 3.0;
        self.spent.unresolved += flux.element_sum() / 3.0;
        if let Some(seen) = landed.seen
            && let Some(pixel) = self.eye.pixel(seen.at)
        {
            add(self.picture, pixel, flux * seen.density);
        }
    }
}

fn add(picture: &mut [f64], pixel: usize, e: DVec3) {
    for band in 0..BANDS {
        picture[pixel * BANDS + band] += e[band];
    }
}

/// Every path of the five, each once, in their order.
fn paths<'c>(corners: &Corners<'c>, centre: &'c [Landed]) -> impl Iterator<Item = u64> {
    let mut all: Vec<u64> = corners.iter().copied().chain([centre]).flatten().map(|l| l.path).collect();
    all.sort_unstable();
    all.dedup();
    all.into_iter()
}

fn find(landed: &[Landed], path: u64) -> Option<&Landed> {
    landed.binary_search_by_key(&path, |l| l.path).ok().map(|at| &landed[at])
}

/// The level to which a path is followed: a branch of a quarter of the flux one level less, since it matters as much; of a
/// light of sixteen parts one level less too, since what is left of their errors is not alike.
fn deepest(five: [Option<&Landed>; 5], part: f64) -> u32 {
    let most = part.sqrt() * five.into_iter().flatten().map(|l| l.share.max_element()).fold(0.0, f64::max);
    let less = if most > 0.0 { -most.log2() / 2.0 } else { f64::INFINITY };
    DEEPEST.saturating_sub(less.max(0.0) as u32)
}

/// The five, if they are one sheet of light.
fn whole(five: [Option<&Landed>; 5]) -> Option<[Landed; 5]> {
    let [Some(a), Some(b), Some(c), Some(d), Some(centre)] = five else { return None };
    let corners = [a, b, c, d];
    if corners.iter().any(|l| l.receiver != centre.receiver || l.seen.is_some() != centre.seen.is_some()) {
        return None;
    }
    let mean = corners.iter().map(|l| l.share).sum::<DVec3>() / 4.0;
    if (mean - centre.share).abs().max_element() > UNEVEN * mean.max_element() {
        return None;
    }
    if let [Some(a), Some(b), Some(c), Some(d), Some(m)] = [a, b, c, d, centre].map(|l| l.seen.map(|s| s.at)) {
        let across = (c - a).length().max((d - b).length());
        let beside = (0.25 * (a + b + c + d) - m).length();
        if beside > BESIDE.max(BEND * across) {
            return None;
        }
    }
    Some([*a, *b, *c, *d, *centre])
}
