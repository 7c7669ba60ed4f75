//! Plots of results: error against time, cost against N, stages, error budgets; and equal-time, equal-error rows.
//!
//! [`Results`] are read, a [`Chart`] is made of them as data, and a chart is drawn: one SVG, from which the PNG is
//! rendered, and the CSV of what stands in it.

mod axis;
mod build;
mod canvas;
mod chart;
mod draw;
mod draw_bars;
mod equal;
mod files;
mod labels;
mod letters;
mod pareto;
mod read;
mod report;
mod result;
mod scale;
mod series;
mod style;

pub use build::{PlotError, chart};
pub use canvas::{Anchor, Canvas, Written};
pub use chart::{Bar, BarPanel, Body, Chart, Kind, Mark, Panel, Series};
pub use draw::draw;
pub use equal::{EqualRow, equal_rows};
pub use files::{PlotFiles, csv_table};
pub use labels::Area;
pub use read::{ReadError, Results};
pub use report::PlotReport;
pub use result::{Budget, Estimate, Point, Published, PublishedRow, Step};
pub use scale::Growth;
