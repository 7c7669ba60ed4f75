//! What nothing beats: the points of which no other is both faster and less wrong; and what lies between them.

use super::{chart::Mark, result::Estimate};

/// Marks on a front, by x, y falling; and between them straight lines over logarithms.
pub struct Front<'a>(Vec<&'a Mark>);

/// What is read off a front between two of its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The value itself.
    pub value: f64,
    /// Half its interval, of the logarithm, downwards and upwards; absent where a point of it has none.
    pub spread: Option<[f64; 2]>,
}

/// One of the two axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Along.
    X,
    /// Up.
    Y,
}

impl Axis {
    fn of(self, mark: &Mark) -> Estimate {
        match self {
            Self::X => mark.x,
            Self::Y => mark.y,
        }
    }

    fn other(self) -> Self {
        if self == Self::X { Self::Y } else { Self::X }
    }
}

impl<'a> Front<'a> {
    /// Of all marks that can be placed; of equal ones the first.
    pub fn of(marks: impl IntoIterator<Item = &'a Mark>) -> Self {
        let mut sorted: Vec<_> = marks.into_iter().filter(|mark| mark.is_placeable()).collect();
        sorted.sort_by(|a, b| a.x.value.0.total_cmp(&b.x.value.0).then(a.y.value.0.total_cmp(&b.y.value.0)));
        let mut least = f64::INFINITY;
        sorted.retain(|mark| {
            let better = mark.y.value.0 < least;
            least = least.min(mark.y.value.0);
            better
        });
        Self(sorted)
    }

    /// (x, y) of its points.
    pub fn places(&self) -> Vec<[f64; 2]> {
        self.0.iter().map(|mark| [mark.x.value.0, mark.y.value.0]).collect()
    }

    /// The measured range along an axis.
    pub fn range(&self, axis: Axis) -> Option<[f64; 2]> {
        let [first, last] = [self.0.first()?, self.0.last()?].map(|mark| axis.of(mark).value.0);
        Some([first.min(last), first.max(last)])
    }

    /// The other coordinate where `axis` is `at`; nothing outside of the measured range.
    pub fn read(&self, axis: Axis, at: f64) -> Option<Reading> {
        let here = |mark: &Mark| axis.of(mark).value.0;
        if let Some(mark) = self.0.iter().find(|mark| here(mark) == at) {
            let value = axis.other().of(mark).value.0;
            return Some(Reading { value, spread: self.spread(mark, mark, axis) });
        }
        let [a, b] = self.0.array_windows().find(|[a, b]| (here(a) < at) == (at < here(b)))?;
        let share = (at / here(a)).ln() / (here(b) / here(a)).ln();
        let there = |mark: &Mark| axis.other().of(mark).value.0;
        let value = (there(a).ln() * (1.0 - share) + there(b).ln() * share).exp();
        let ends = [self.spread(a, b, axis), self.spread(b, a, axis)];
        let spread = match ends {
            [Some(a), Some(b)] => Some([0, 1].map(|side| a[side] * (1.0 - share) + b[side] * share)),
            _ => None,
        };
        Some(Reading { value, spread })
    }

    /// What `mark` is uncertain by along the other axis: its own interval, and that along `axis` by the slope towards
    /// its neighbour. Ends of an interval at or below zero leave it open, so that nothing is claimed.
    fn spread(&self, mark: &Mark, neighbour: &Mark, axis: Axis) -> Option<[f64; 2]> {
        let half = |estimate: Estimate| {
            let [low, high] = estimate.interval()?;
            let value = estimate.value.0;
            Some([if low > 0.0 { (value / low).ln() } else { f64::INFINITY }, (high / value).ln()])
        };
        let [own, along] = [half(axis.other().of(mark))?, half(axis.of(mark))?];
        let run = (axis.of(neighbour).value.0 / axis.of(mark).value.0).ln();
        let rise = (axis.other().of(neighbour).value.0 / axis.other().of(mark).value.0).ln();
        let slope = if run == 0.0 { self.slope_at(mark, axis) } else { (rise / run).abs() };
        // The front falls: what is found too low along one axis is too high along the other.
        Some([0, 1].map(|side| own[side].hypot(if slope == 0.0 { 0.0 } else { slope * along[1 - side] })))
    }

    /// The steeper of the two slopes at a point of the front, over logarithms; 0 for a front of one point.
    fn slope_at(&self, mark: &Mark, axis: Axis) -> f64 {
        let log = |axis: Axis, mark: &Mark| axis.of(mark).value.0.ln();
        let touching = self.0.array_windows().filter(|[a, b]| *a == mark || *b == mark);
        let slopes = touching
            .map(|[a, b]| ((log(axis.other(), b) - log(axis.other(), a)) / (log(axis, b) - log(axis, a))).abs());
        slopes.fold(0.0, f64::max)
    }
}

/// Sets `front` of each mark.
pub fn mark_front(marks: &mut [Mark]) {
    let front = Front::of(marks.iter()).places();
    let mut open: Vec<_> = front.into_iter().map(Some).collect();
    for mark in marks {
        let place = [mark.x.value.0, mark.y.value.0];
        let found = open.iter_mut().find(|of_front| **of_front == Some(place));
        mark.front = found.is_some_and(|of_front| of_front.take().is_some());
    }
}
