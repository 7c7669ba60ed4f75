//! Where labels stand: beside what they name, on nothing else, or nowhere.

/// An upright box: x and y of its upper left corner, width, height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// Left edge.
    pub x: f64,
    /// Upper edge.
    pub y: f64,
    /// Width.
    pub w: f64,
    /// Height.
    pub h: f64,
}

impl Area {
    /// Do the insides meet?
    pub fn overlaps(&self, other: &Self) -> bool {
        self.x < other.x + other.w
            && other.x < self.x + self.w
            && self.y < other.y + other.h
            && other.y < self.y + self.h
    }

    /// Is `other` wholly inside?
    pub fn holds(&self, other: &Self) -> bool {
        self.x <= other.x
            && self.y <= other.y
            && other.x + other.w <= self.x + self.w
            && other.y + other.h <= self.y + self.h
    }
}

/// A label that wants to stand at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// The point it names.
    pub at: [f64; 2],
    /// Its width and height.
    pub size: [f64; 2],
}

/// From the point to the label's nearest edge, px.
const GAP: f64 = 7.0;
/// Of it, where the label touches with a corner: beyond the marker still.
const DIAGONAL: f64 = 0.75;
/// Where the label's centre stands from the point: right above first, then around.
const AROUND: [[f64; 2]; 8] =
    [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [0.0, -1.0], [0.0, 1.0], [1.0, 0.0], [-1.0, 0.0]];

/// Places labels in the order in which they come, inside `frame`, off `obstacles` and off each other. One that finds no
/// room among eight places has none: a plot without it is right, one with a covered point is not.
pub fn place(frame: &Area, obstacles: &[Area], wanted: &[Wanted]) -> Vec<Option<Area>> {
    let mut placed: Vec<Option<Area>> = Vec::with_capacity(wanted.len());
    for label in wanted {
        let free = |area: &Area| {
            frame.holds(area)
                && !obstacles.iter().any(|o| o.overlaps(area))
                && !placed.iter().flatten().any(|other| other.overlaps(area))
        };
        let found = AROUND.iter().map(|towards| beside(label, *towards)).find(free);
        placed.push(found);
    }
    placed
}

fn beside(label: &Wanted, [dx, dy]: [f64; 2]) -> Area {
    let ([x, y], [w, h]) = (label.at, label.size);
    // Diagonal places touch with a corner, which stands nearer than an edge would.
    let gap = if dx != 0.0 && dy != 0.0 { GAP * DIAGONAL } else { GAP };
    Area { x: x + dx * (gap + w / 2.0) - w / 2.0, y: y + dy * (gap + h / 2.0) - h / 2.0, w, h }
}
