//! What a plot shows, as data: nothing here draws.

use std::fmt;

use super::result::Estimate;

/// What is plotted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Error against time, with the front of what nothing beats.
    ErrorTime,
    /// Time against the number of photons.
    Cost,
    /// Time by part and memory against what they grow with, and the power of it.
    Scale,
    /// Time by stage.
    Stages,
    /// Signed steps of an error budget.
    Budget,
}

impl Kind {
    /// All kinds, in the order in which a plot without `--kind` tries them.
    pub const ALL: [Self; 5] = [Self::ErrorTime, Self::Cost, Self::Scale, Self::Stages, Self::Budget];

    /// As it is typed, and as files are named.
    pub fn name(self) -> &'static str {
        match self {
            Self::ErrorTime => "error-time",
            Self::Cost => "cost",
            Self::Scale => "scale",
            Self::Stages => "stages",
            Self::Budget => "budget",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What is plotted.
    pub kind: Kind,
    /// The measure of the error, where there is one.
    pub measure: String,
    /// What is drawn.
    pub body: Body,
    /// What a reader must know, a sentence each: they stand below the plot.
    pub caption: Vec<String>,
}

/// Marks over two axes, or bars over one.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// A panel a scene, both axes logarithmic.
    Marks(Vec<Panel>),
    /// A panel a scene, one linear axis in this unit.
    Bars(&'static str, Vec<BarPanel>),
}

/// One scene's marks.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The scene, its camera and size.
    pub title: String,
    /// What stands along and up, with units.
    pub axes: [String; 2],
    /// One method under one set of settings on one device, each.
    pub series: Vec<Series>,
    /// Through the points that no other of the panel beats, (x, y) by x; empty where devices are mixed.
    pub front: Vec<[f64; 2]>,
}

/// Marks that belong together, by x.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Method and what tells it from others.
    pub name: String,
    /// The device's name.
    pub device: String,
    /// By x.
    pub marks: Vec<Mark>,
}

/// A point of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Along.
    pub x: Estimate,
    /// Up.
    pub y: Estimate,
    /// Photons, 0 without.
    pub photons: u64,
    /// On its series' front.
    pub front: bool,
    /// Where it was read.
    pub place: String,
}

impl Mark {
    /// Can both its values stand on a logarithmic axis?
    pub fn is_placeable(&self) -> bool {
        self.x.is_placeable() && self.y.is_placeable()
    }
}

/// One scene's bars.
#[derive(Clone, Debug, PartialEq)]
pub struct BarPanel {
    /// The scene, its camera and size.
    pub title: String,
    /// From the top.
    pub bars: Vec<Bar>,
}

/// A bar of one or more parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// What stands beside it.
    pub name: String,
    /// From zero outwards.
    pub parts: Vec<(String, Estimate)>,
    /// The whole, where that was measured by itself.
    pub whole: Option<Estimate>,
    /// What stands behind it.
    pub remark: String,
    /// Where it was read.
    pub place: String,
}

/// N as it is spoken of: `512²` where it is a square, else the count.
pub fn side(photons: u64) -> String {
    let side = photons.isqrt();
    if side * side == photons { format!("{side}²") } else { photons.to_string() }
}
