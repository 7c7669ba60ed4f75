//! The three files of a plot: SVG, the PNG of it, and the CSV of what stands in it.

use std::{
    io::{self, Write},
    sync::Arc,
};

use resvg::{tiny_skia, usvg};
use serde_json::json;

use super::{
    chart::{Body, Chart},
    draw::draw,
    letters::{FAMILY, FONT},
    read::Results,
    result::Estimate,
};
use crate::{
    image::{Provenance, rgb_to_png},
    lab::{Cell, Table, table::to_csv},
    stats::Number,
    whole::{FileError, OutFolder},
};

/// Pixels of the PNG a px of the SVG.
const SCALE: f32 = 2.0;

/// The files' contents.
#[derive(Debug)]
pub struct PlotFiles {
    /// The plot, with its provenance as metadata.
    pub svg: String,
    /// The same in pixels, provenance in its text.
    pub png: Vec<u8>,
    /// The data drawn.
    pub csv: Vec<u8>,
}

impl PlotFiles {
    /// Draws a chart of results.
    ///
    /// # Errors
    /// Those of the encoders: none is expected.
    pub fn new(chart: &Chart, results: &Results) -> io::Result<Self> {
        let metadata = json!({
            "program": "nephroid", "version": env!("CARGO_PKG_VERSION"), "commit": env!("NEPHROID_COMMIT"),
            "kind": chart.kind.name(), "measure": chart.measure, "sources": results.sources,
            "commits": commits(results), "left_out": results.notes, "caption": chart.caption,
        });
        let metadata = metadata.to_string();
        let svg = draw(chart).svg(&format!("{} of {}", chart.kind, results.sources.join(", ")), &metadata);
        let png = rasterised(&svg, &metadata)?;
        Ok(Self { svg, png, csv: to_csv(&[csv_table(chart)]).map_err(io::Error::other)? })
    }

    /// Writes them as `stem` with the three endings into a folder prepared for them: all, or none.
    ///
    /// # Errors
    /// [`FileError`] of the file that the disk does not take.
    pub fn write(&self, mut folder: OutFolder, stem: &str) -> Result<(), FileError> {
        let files = [("svg", self.svg.as_bytes()), ("png", &self.png), ("csv", &self.csv)];
        for (ending, bytes) in files {
            folder.write(&format!("{stem}.{ending}"), |out| out.write_all(bytes))?;
        }
        folder.commit()
    }
}

/// Of the program that made the results.
fn commits(results: &Results) -> Vec<&str> {
    let mut commits: Vec<_> = results.points.iter().map(|p| p.commit.as_str()).filter(|c| !c.is_empty()).collect();
    commits.sort_unstable();
    commits.dedup();
    commits
}

fn rasterised(svg: &str, metadata: &str) -> io::Result<Vec<u8>> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    let options = usvg::Options { fontdb: Arc::new(fonts), font_family: FAMILY.to_owned(), ..Default::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(io::Error::other)?;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * SCALE).ceil() as u32);
    let too_large = || io::Error::other(format!("the plot is too large for a PNG: {width} × {height} pixels"));
    let mut pixels = tiny_skia::Pixmap::new(width, height).ok_or_else(too_large)?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    // The page is white and whole: nothing of it is transparent.
    let colours: Vec<[u8; 3]> = pixels.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
    let about = Provenance::from([("nephroid".to_owned(), metadata.to_owned())]);
    rgb_to_png([width as usize, height as usize], &colours, &about).map_err(io::Error::other)
}

/// What is drawn, a row a point or a part of a bar.
pub fn csv_table(chart: &Chart) -> Table {
    match &chart.body {
        Body::Marks(panels) => {
            let marks = panels.iter().flat_map(|panel| {
                panel.series.iter().flat_map(move |series| series.marks.iter().map(move |mark| (panel, series, mark)))
            });
            let row = |(panel, series, mark): (&super::Panel, &super::Series, &super::Mark)| {
                let mut row = [&panel.title, &series.name, &series.device].map(Cell::text).to_vec();
                row.extend(cells(&mark.x));
                row.extend(cells(&mark.y));
                row.extend([Cell::Count(mark.photons), Cell::text(if mark.front { "yes" } else { "no" })]);
                row.push(Cell::text(&mark.place));
                row
            };
            let [x, y] = axes(chart);
            let columns = ["scene", "series", "device"].into_iter().chain(x).chain(y);
            let columns = columns.chain(["photons", "front", "from"]).collect();
            Table { name: "points", columns, rows: marks.map(row).collect() }
        }
        Body::Bars(unit, panels) => {
            let mut rows = Vec::new();
            for panel in panels {
                for bar in &panel.bars {
                    let whole = bar.whole.as_ref().map(|whole| ("whole", whole));
                    for (name, value) in bar.parts.iter().map(|(name, value)| (name.as_str(), value)).chain(whole) {
                        let mut row = [panel.title.as_str(), &bar.name, name].map(Cell::text).to_vec();
                        row.extend(cells(value));
                        row.extend([Cell::text(*unit), Cell::text(&bar.place)]);
                        rows.push(row);
                    }
                }
            }
            Table { name: "bars", columns: vec!["scene", "bar", "part", "value", "low", "high", "unit", "from"], rows }
        }
    }
}

fn axes(chart: &Chart) -> [[&'static str; 3]; 2] {
    match chart.kind {
        super::Kind::ErrorTime => [["time_ms", "time_low_ms", "time_high_ms"], ["error", "error_low", "error_high"]],
        super::Kind::Scale => [["x", "x_low", "x_high"], ["y", "y_low", "y_high"]],
        _ => [["n", "n_low", "n_high"], ["time_ms", "time_low_ms", "time_high_ms"]],
    }
}

fn cells(estimate: &Estimate) -> [Cell; 3] {
    let cell = |value: f64| Cell::Real(value, decimals(value));
    let end = |end: Option<Number>| end.map_or(Cell::None, |end| cell(end.0));
    [cell(estimate.value.0), end(estimate.low), end(estimate.high)]
}

/// Of four digits that count.
fn decimals(value: f64) -> usize {
    let power = if value == 0.0 || !value.is_finite() { 0.0 } else { value.abs().log10().floor() };
    (3.0 - power).clamp(0.0, 15.0) as usize
}
