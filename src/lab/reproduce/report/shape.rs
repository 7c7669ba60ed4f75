//! How the figures of a table compare with each other, published and here.

use serde::Serialize;

use super::row::{cells, short};
use crate::{
    gpu::FrameTimes,
    lab::{
        Cell, Table,
        papers::{Figure, Published},
        reproduce::{
            asked::{Asked, Place},
            columns,
            measure::Run,
        },
    },
    stats::Interval,
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

/// Of the paper's Table 3, its times behind each other whose ratio its text dwells on: the second's over the first's.
const BESIDE: [[&str; 2]; 3] = [
    ["gather_combine_all", "gather_fetch"],
    ["gather_varying_multires", "gather_varying_single"],
    ["gather_fetch", "gather_copy"],
];
/// The column that grows least with N.
const GROWS: &str = "gather_combine_all";

/// Of Table 3, what each of its steps gains, at the largest N that was measured of both columns, and how its last one
/// grows from the least N to the largest.
pub fn gains(published: &Published, run: &Run) -> Vec<Shape> {
    if published.id != "maps.table3" {
        return Vec::new();
    }
    let placed: Vec<Placed> = published.figures.iter().filter_map(|f| placed(published, f, run)).collect();
    let of = |column: &'static str| placed.iter().filter(move |(figure, ..)| figure.column == column);
    let beside = BESIDE.into_iter().filter_map(|[from, to]| {
        let both = of(to).rev().find_map(|to| Some((of(from).find(|from| from.0.row == to.0.row)?, to)));
        both.and_then(|(from, to)| Shape::of("columns", from, to, run))
    });
    let mut all: Vec<Shape> = beside.collect();
    let ends = [of(GROWS).next(), of(GROWS).next_back()];
    if let [Some(least), Some(most)] = ends
        && least.0.row != most.0.row
    {
        all.extend(Shape::of("growth", least, most, run));
    }
    all
}

impl Shape {
    pub fn table(name: &'static str, shapes: &[Self]) -> Table {
        let rows = shapes.iter().map(|s| {
            let [measured, interval] = cells(Some(&s.measured));
            let within = Cell::text(if s.within { "yes" } else { "no" });
            vec![Cell::text(&s.from), Cell::text(&s.to), Cell::text(short(s.published)), measured, interval, within]
        });
        let columns = vec!["from", "to", "published ratio", "measured ratio", "99 %", "within"];
        Table { name, columns, rows: rows.collect() }
    }

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
