//! What a published figure asks of a run: a time, or what follows from several, or from counts.

use super::{
    claims::Claim,
    columns::{Part, Variant},
    measure::{Measured, Run},
    subject::Subject,
};
use crate::{
    gpu::FrameTimes,
    lab::timing::{Ratio, Summary},
    stats::Interval,
};

/// A part of the frames of one variant at one N.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub variant: Variant,
    pub side: u32,
    pub part: Part,
}

/// Which of several values a paper states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pick {
    Least,
    Most,
}

/// What a figure asks.
#[derive(Clone, Debug, PartialEq)]
pub enum Asked {
    /// How long it takes, or how often a second.
    Time(Place),
    /// How many times as long as the second the first takes.
    Times(Place, Place),
    /// Share of the first's time that the second saves: of several pairs, the least or the most.
    Saved(Vec<(Place, Place)>, Pick),
    /// N from which on the second is the faster, of pairs at rising N.
    PaysFrom(Vec<(Place, Place)>),
    /// Points that gathering draws in all.
    Points(Place),
    /// Photons emitted, over those points.
    Fewer(Place),
    /// Share of what is left that a level of the traversal drops: the least or the most of levels beyond the first few.
    Dropped(Place, Pick),
    /// Triangles of the scene.
    Triangles(Subject),
    /// What the paper on water says.
    Claim(Claim),
}

/// Coarsest levels of a traversal that are "the first few".
const FIRST_FEW: usize = 2;
/// Children of a point.
const CHILDREN: f64 = 4.0;

impl Pick {
    fn of(self, all: impl Iterator<Item = Interval>) -> Option<Interval> {
        let by = |a: &Interval, b: &Interval| a.value.total_cmp(&b.value);
        match self {
            Self::Least => all.min_by(by),
            Self::Most => all.max_by(by),
        }
    }
}

impl Asked {
    /// All that must be run for it.
    pub fn places(&self) -> Vec<Place> {
        match self {
            Self::Time(place) | Self::Points(place) | Self::Fewer(place) | Self::Dropped(place, _) => vec![*place],
            Self::Times(a, b) => vec![*a, *b],
            Self::Saved(pairs, _) | Self::PaysFrom(pairs) => pairs.iter().flat_map(|(a, b)| [*a, *b]).collect(),
            Self::Triangles(_) => Vec::new(),
            Self::Claim(claim) => claim.places(),
        }
    }

    /// Of them those whose time it asks; of the others one frame is enough.
    pub fn timed(&self) -> Vec<Place> {
        match self {
            Self::Claim(claim) => claim.timed(),
            Self::Points(_) | Self::Fewer(_) | Self::Dropped(..) => Vec::new(),
            Self::Time(_) | Self::Times(..) | Self::Saved(..) | Self::PaysFrom(_) | Self::Triangles(_) => self.places(),
        }
    }

    /// The one variant and N that it is of, if it is of one.
    pub fn place(&self) -> Option<Place> {
        <[Place; 1]>::try_from(self.places()).ok().map(|[place]| place)
    }

    /// Its value.
    ///
    /// # Errors
    /// Why there is none.
    pub fn measure(&self, run: &Run) -> Result<Interval, String> {
        match self {
            Self::Time(place) => {
                let at = run.find(*place)?;
                let samples = run.timed.series[at].frames.iter().map(|frame| place.part.of(&run.all[at].stages, frame));
                let Summary { median: value, low, high, .. } = Summary::of(samples.collect());
                Ok(Interval { value, low, high })
            }
            Self::Times(a, b) => Ok(ratio(run, *b, *a)?.interval),
            Self::Saved(pairs, pick) => {
                let saved = |r: Ratio| Interval {
                    value: 1.0 - r.interval.value,
                    low: 1.0 - r.interval.high,
                    high: 1.0 - r.interval.low,
                };
                // The least of some N is not the least of all.
                let of = |(a, b): &(Place, Place)| {
                    ratio(run, *a, *b).map(saved).map_err(|why| format!("N = {}: {why}", a.side))
                };
                let all: Vec<_> = pairs.iter().map(of).collect::<Result<_, _>>()?;
                pick.of(all.into_iter()).ok_or_else(|| "of no N".to_owned())
            }
            Self::Claim(claim) => claim.measure(run),
            Self::PaysFrom(pairs) => pays_from(run, pairs),
            Self::Points(place) => Ok(Interval::exact(points(run, *place)?)),
            Self::Fewer(place) => {
                let emitted = run.all[run.find(*place)?].emitted;
                Ok(Interval::exact(emitted as f64 / points(run, *place)?.max(1.0)))
            }
            Self::Dropped(place, pick) => {
                let dropped = dropped(&run.all[run.find(*place)?]);
                let none = || "N is too small for so many levels".to_owned();
                pick.of(dropped.into_iter().map(Interval::exact)).ok_or_else(none)
            }
            Self::Triangles(subject) => {
                let of = |m: &&Measured| m.variant.subject == *subject;
                let found = run.all.iter().find(of).ok_or_else(|| "was not run".to_owned())?;
                Ok(Interval::exact(found.triangles as f64))
            }
        }
    }
}

fn points(run: &Run, place: Place) -> Result<f64, String> {
    let measured = &run.all[run.find(place)?];
    measured.points().map(|points| points as f64).ok_or_else(|| "this device counts no points".to_owned())
}

/// How many times as long as `a` it is that `b` takes.
pub(super) fn ratio(run: &Run, a: Place, b: Place) -> Result<Ratio, String> {
    let [at, bt] = [run.find(a)?, run.find(b)?];
    let take = |at: usize, part: Part| move |frame: &FrameTimes| part.of(&run.all[at].stages, frame);
    Ok(run.timed.ratio((at, &take(at, a.part)), (bt, &take(bt, b.part))))
}

/// Between the N that were run, as if ratios were powers of N.
fn pays_from(run: &Run, pairs: &[(Place, Place)]) -> Result<Interval, String> {
    let ratios: Vec<(f64, f64)> =
        pairs.iter().filter_map(|(a, b)| Some((f64::from(a.side), ratio(run, *a, *b).ok()?.interval.value))).collect();
    let (Some(first), Some(last)) = (ratios.first(), ratios.last()) else {
        return Err(run.why(pairs.first().map_or(0, |(a, _)| a.side)));
    };
    let Some(dear) = ratios.iter().rposition(|(_, ratio)| *ratio > 1.0) else {
        return Ok(Interval { value: first.0, low: 0.0, high: first.0 });
    };
    let Some(cheap) = ratios.get(dear + 1) else {
        return Err(format!("at no N up to {}", last.0));
    };
    let [from, to] = [ratios[dear], *cheap];
    let along = from.1.ln() / (from.1.ln() - to.1.ln());
    Ok(Interval { value: from.0 * (to.0 / from.0).powf(along), low: from.0, high: to.0 })
}

/// Of each step of the traversal beyond the first few, the share of children that are not drawn.
fn dropped(measured: &Measured) -> Vec<f64> {
    let drawn: Vec<f64> = measured.counts.iter().map(|(_, points)| *points as f64).collect();
    let steps = drawn.windows(2).filter(|step| step[0] > 0.0);
    steps.skip(FIRST_FEW).map(|step| 1.0 - step[1] / (CHILDREN * step[0])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_and_the_most_are_picked() {
        let all = || [0.3, 0.1, 0.2].into_iter().map(Interval::exact);
        assert_eq!(Pick::Least.of(all()).map(|k| k.value), Some(0.1));
        assert_eq!(Pick::Most.of(all()).map(|k| k.value), Some(0.3));
        assert!(Pick::Most.of(std::iter::empty()).is_none());
    }
}
