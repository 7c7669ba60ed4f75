//! Cells of light: a grid of rays cuts what a light emits into cells of equal flux, and each cell's flux is spread over
//! the area between the places where its rays land, sheet of light by sheet of light.
//!
//! Stages double the grid, each a whole estimate of its own. Nothing is random, so there is no noise to estimate; what
//! stands for the variance is the squared change from the stage before, which is larger than what is left as long as the
//! error falls at all. A light with a size is many without, whose number doubles from stage to stage as their grids do by
//! area: the sum over them has no noise either. Biased where cells cannot be resolved ([`refine`]), and by branches that carry less than 10⁻⁵ of
//! their photon (class `all:N`), which are dropped.

mod refine;
mod spread;

use glam::DVec2;

use super::{BANDS, Estimate, Judged};
use crate::{
    scene::{LightKind, PathClass},
    truth::{Goal, Standing, eye::Eye, light::Emission, trace::Space},
};
use refine::{Cell, Refiner, Spent};

/// Bands of rows that a stage is made of: what a killed run can lose.
const BANDS_A_STAGE: u64 = 64;
/// Cells a side of the first stage, at least, where a goal says how many the last one has.
const FIRST: u64 = 16;
/// Cells a side of the first stage where no goal says.
const START: u64 = 64;
/// Lights without size that stand for one that has a size, in the first stage.
const SAMPLES: u32 = 16;
/// Cells a side of the last stage at most: beyond it a cell's landing is lost in the rounding of its rays.
const LAST: u64 = 1 << 20;

/// The estimate by cells.
pub struct Cells<'a> {
    space: &'a Space<'a>,
    eye: Eye,
    class: PathClass,
    /// Without size.
    lights: Vec<Emission>,
    /// With a size.
    areas: Vec<LightKind>,
    judged: Judged,
    /// Cells a side of the first stage.
    start: u64,
    /// Of the stage under way: the irradiance so far, then [`Spent`].
    sum: Vec<f64>,
    /// Of the two stages before, the latest first; empty before there is one.
    stages: [Vec<f64>; 2],
    chunks: u64,
}

impl<'a> Cells<'a> {
    /// Of one path class, as this eye sees it. The first stage is such that doubling leads to the goal's photons.
    pub fn new(space: &'a Space<'a>, eye: Eye, class: PathClass, goal: &Goal, judged: Judged) -> Self {
        let shines = |kind: &&LightKind| kind.power().iter().any(|band| *band > 0.0);
        let kinds = space.scene.lights.iter().map(|light| &light.kind).filter(shines).cloned();
        let (areas, sizeless): (Vec<_>, Vec<_>) = kinds.partition(LightKind::has_area);
        let lights = lit(Emission::of_each(space, &sizeless));
        // Where nothing is specular they send no photon.
        let areas = if space.scene.has_specular() { areas } else { vec![] };
        let start = match goal.photons {
            None => START,
            Some(cells) => {
                let mut side = ((cells as f64 / (lights.len() + areas.len()).max(1) as f64).sqrt().ceil() as u64)
                    .clamp(FIRST, LAST);
                while side >= 2 * FIRST {
                    side = side.div_ceil(2);
                }
                side
            }
        };
        let sum = vec![0.0; eye.pixels() * BANDS + Spent::NUMBERS];
        Self { space, eye, class, lights, areas, judged, start, sum, stages: [vec![], vec![]], chunks: 0 }
    }

    fn side(&self, stage: u64) -> u64 {
        self.start << stage.min(32)
    }

    /// Lights that send photons.
    fn sources(&self) -> usize {
        self.lights.len() + self.areas.len()
    }

    /// Lights without size for one of those that have a size, and the cells a side of each: together as many cells as of a
    /// light without size, or few more.
    fn samples(&self, stage: u64) -> (u32, u64) {
        let count = SAMPLES << stage.min(16);
        (count, (self.side(stage) as f64 / f64::from(count).sqrt()).ceil() as u64)
    }

    /// Cells of all stages up to a chunk.
    fn cells(&self, chunks: u64) -> u64 {
        let (stage, band) = (chunks / BANDS_A_STAGE, chunks % BANDS_A_STAGE);
        let whole: u64 = (0..stage).map(|s| self.side(s).pow(2)).sum();
        let rows = self.side(stage) * band / BANDS_A_STAGE;
        (whole + rows * self.side(stage)) * self.sources() as u64
    }

    /// One band of rows of one light's grid.
    fn band(&self, light: (&Emission, f64), side: u64, rows: std::ops::Range<u64>, picture: &mut [f64]) -> Spent {
        let mut refiner = Refiner::new(self.space, &self.eye, self.class, light, picture);
        let size = 1.0 / side as f64;
        let at = |x: u64, y: u64| DVec2::new(x as f64, y as f64) * size;
        let looked = |refiner: &Refiner, y: u64| (0..=side).map(|x| refiner.look(at(x, y))).collect::<Vec<_>>();
        let mut above = if rows.is_empty() { vec![] } else { looked(&refiner, rows.start) };
        for y in rows {
            let below = looked(&refiner, y + 1);
            for x in 0..side {
                let k = x as usize;
                let cell = Cell { low: at(x, y), size, level: 0 };
                refiner.settle(&cell, [&above[k], &above[k + 1], &below[k + 1], &below[k]], &[]);
            }
            above = below;
        }
        refiner.spent()
    }

    fn picture<'s>(&self, stage: &'s [f64]) -> &'s [f64] {
        &stage[..stage.len().min(self.eye.pixels() * BANDS)]
    }

    fn spent(stage: &[f64]) -> Spent {
        Spent::from_numbers(&stage[stage.len().saturating_sub(Spent::NUMBERS)..])
    }
}

/// Those that send anything.
fn lit(emissions: Vec<Emission>) -> Vec<Emission> {
    emissions.into_iter().filter(|e| e.flux().max_element() > 0.0).collect()
}

impl Estimate for Cells<'_> {
    fn chunks(&self) -> u64 {
        self.chunks
    }

    fn chunk(&self, k: u64) -> Vec<f64> {
        let (side, band) = (self.side(k / BANDS_A_STAGE), k % BANDS_A_STAGE);
        let rows = |side: u64| side * band / BANDS_A_STAGE..side * (band + 1) / BANDS_A_STAGE;
        let mut picture = vec![0.0; self.eye.pixels() * BANDS];
        let (count, of_each) = self.samples(k / BANDS_A_STAGE);
        let part = 1.0 / f64::from(count);
        let samples: Vec<LightKind> = self.areas.iter().flat_map(|area| area.samples(count)).collect();
        let samples = if rows(of_each).is_empty() { vec![] } else { lit(Emission::of_each(self.space, &samples)) };
        let all = self.lights.iter().map(|l| ((l, 1.0), side)).chain(samples.iter().map(|l| ((l, part), of_each)));
        let spent = all.map(|(l, side)| self.band(l, side, rows(side), &mut picture));
        let spent = spent.fold(Spent::default(), |sum, one| sum.plus(&one));
        picture.extend(spent.to_numbers());
        picture
    }

    fn add(&mut self, chunk: &[f64]) {
        self.sum.iter_mut().zip(chunk).for_each(|(sum, x)| *sum += x);
        self.chunks += 1;
        if self.chunks.is_multiple_of(BANDS_A_STAGE) {
            let next = vec![0.0; self.sum.len()];
            let done = std::mem::replace(&mut self.sum, next);
            self.stages.swap(0, 1);
            self.stages[0] = done;
        }
    }

    fn may_be_finished(&self, _: &Goal) -> bool {
        self.sources() == 0 || self.chunks.is_multiple_of(BANDS_A_STAGE)
    }

    fn standing(&self, goal: &Goal) -> Standing {
        if self.sources() == 0 {
            return Standing { photons: 0, noise: 0.0, missing: 0.0, finished: true };
        }
        let (stage, between) = (self.chunks / BANDS_A_STAGE, self.chunks % BANDS_A_STAGE);
        let noise = self.judged.noise(self.mean().into_iter(), self.variance().into_iter());
        let enough = |stage: u64| {
            let side = self.side(stage - 1);
            let cells = side.saturating_mul(side).saturating_mul(self.sources() as u64);
            goal.photons.is_some_and(|n| cells >= n)
        };
        let quiet = stage > 1 && goal.noise.is_some_and(|most| noise <= most);
        let finished = between == 0 && stage > 0 && (enough(stage) || quiet);
        let last = (stage + 1..stage + 32).find(|s| enough(*s)).unwrap_or(stage + 1);
        let missing = (self.cells(last * BANDS_A_STAGE) - self.cells(self.chunks)) as f64;
        Standing { photons: self.cells(self.chunks), noise, missing, finished }
    }

    fn mean(&self) -> Vec<f64> {
        let done = if self.stages[0].is_empty() { &self.sum } else { &self.stages[0] };
        self.picture(done).to_vec()
    }

    fn variance(&self) -> Vec<f64> {
        let [fine, coarse] = &self.stages;
        let squared = |(a, b): (&f64, &f64)| (a - b) * (a - b);
        if coarse.is_empty() {
            return vec![f64::INFINITY; self.eye.pixels() * BANDS];
        }
        self.picture(fine).iter().zip(self.picture(coarse)).map(squared).collect()
    }

    fn about(&self) -> Vec<(&'static str, String)> {
        let stage = (self.chunks / BANDS_A_STAGE).saturating_sub(1);
        let spent = Self::spent(if self.stages[0].is_empty() { &self.sum } else { &self.stages[0] });
        vec![
            ("cells.side", self.side(stage).to_string()),
            ("cells.landed_w", format!("{:e}", spent.landed)),
            ("cells.unresolved", format!("{:e}", spent.unresolved_share())),
        ]
    }

    fn to_bytes(&self) -> Vec<u8> {
        let numbers = [&self.sum, &self.stages[0], &self.stages[1]].into_iter().flatten();
        self.chunks.to_le_bytes().into_iter().chain(numbers.flat_map(|x| x.to_le_bytes())).collect()
    }

    fn resume(&mut self, bytes: &[u8]) -> bool {
        let Some((count, numbers)) = bytes.split_first_chunk::<8>() else { return false };
        let (words, rest) = numbers.as_chunks::<8>();
        let chunks = u64::from_le_bytes(*count);
        let kept = 1 + (chunks / BANDS_A_STAGE).min(2) as usize;
        if !rest.is_empty() || words.len() != kept * self.sum.len() {
            return false;
        }
        let mut parts =
            words.chunks_exact(self.sum.len()).map(|part| part.iter().map(|w| f64::from_le_bytes(*w)).collect());
        let mut next = || parts.next().unwrap_or_default();
        (self.sum, self.stages, self.chunks) = (next(), [next(), next()], chunks);
        true
    }
}
