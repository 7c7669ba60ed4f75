//! How the figures of a table compare with each other, published and here.

use serde::Serialize;

use crate::stats::Interval;
use crate::{
    gpu::FrameTimes,
    lab::{
        papers::{Figure, Published},
        reproduce::{
            asked::{Asked, Place},
            columns,
            measure::Run,
        },
    },
};

/// How one figure of the table compares with another: what does not depend on how fast the machine is.
#[derive(Clone, Debug, Serialize)]
pub struct Shape {
    /// `growth`: one column, from one N to the next; `columns`: two columns at one N.
    pub kind: &'static str,
    pub from: String,
    pub to: String,
    pub published: f64,
    pub measured: Interval,
    /// Whether the published ratio lies in the measured interval.
    pub within: bool,
}

/// A figure that is a time, and where it was run.
type Placed<'p> = (&'p Figure, Place, usize);

fn placed<'p>(published: &Published, figure: &'p Figure, run: &Run) -> Option<Placed<'p>> {
    match columns::asked(published, figure).ok()? {
        Asked::Time(place) => Some((figure, place, run.find(place).ok()?)),
        _ => None,
    }
}

/// Each column from one N to the next, and each column beside the table's first at the same N.
pub fn shape(published: &Published, run: &Run) -> Vec<Shape> {
    let placed: Vec<Placed> = published.figures.iter().filter_map(|f| placed(published, f, run)).collect();
    let alike = |pair: &&[Placed]| pair[0].0.column == pair[1].0.column && pair[0].1.variant == pair[1].1.variant;
    let growth = placed.windows(2).filter(alike).filter_map(|pair| Shape::of("growth", &pair[0], &pair[1], run));
    let mut all: Vec<Shape> = growth.collect();
    let Some(first) = placed.first().map(|(figure, ..)| &figure.column) else { return all };
    for to in placed.iter().filter(|(figure, ..)| figure.column != *first) {
        let from = placed.iter().find(|(figure, ..)| figure.column == *first && figure.row == to.0.row);
        all.extend(from.and_then(|from| Shape::of("columns", from, to, run)));
    }
    all
}

impl Shape {
    /// None where the published figure is zero.
    fn of(kind: &'static str, from: &Placed, to: &Placed, run: &Run) -> Option<Self> {
        let take = |&(_, place, at): &Placed| move |frame: &FrameTimes| place.part.of(&run.all[at].stages, frame);
        let measured = run.timed.ratio((from.2, &take(from)), (to.2, &take(to)));
        let published = to.0.value? / from.0.value?;
        let name = |figure: &Figure| format!("{} {}", figure.column, figure.row.text());
        published.is_finite().then(|| Self {
            kind,
            from: name(from.0),
            to: name(to.0),
            published,
            within: measured.interval.contains(published),
            measured: measured.interval,
        })
    }
}
