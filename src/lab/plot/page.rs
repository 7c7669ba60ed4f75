//! The page: title, panels, legend, caption.

use std::collections::BTreeMap;

use super::{
    bars,
    chart::{BarPanel, Body, Chart, Kind, Panel},
    labels::Area,
    marks::{Layout, SMALL},
    style,
    svg::{Anchor, Svg, text_width},
};
use crate::image::Provenance;

/// px of one panel of marks inside its axes.
const PANEL: [f64; 2] = [600.0, 400.0];
/// px around it: left, right, above, below.
const AROUND: [f64; 4] = [76.0, 24.0, 30.0, 50.0];
/// px of a panel of bars, names included.
const BARS_WIDTH: f64 = 900.0;
/// px around the page.
const EDGE: f64 = 14.0;
/// px of a line of legend or caption.
const LINE: f64 = 17.0;
/// Most panels drawn, and most entries of a legend; the CSV has all.
const MOST_PANELS: usize = 24;
const MOST_ENTRIES: usize = 48;
/// px of a legend's sample.
const SAMPLE: f64 = 36.0;

/// The plot as SVG.
pub fn svg(chart: &Chart, provenance: &Provenance) -> String {
    match &chart.body {
        Body::Marks(panels) => marks_page(chart, panels, provenance),
        Body::Bars(unit, panels) => bars_page(chart, unit, panels, provenance),
    }
}

/// Panels of marks with their places, the page's frame first: what tests look at.
pub fn layouts(kind: Kind, panels: &[Panel]) -> (Area, Vec<Layout>) {
    let shown = &panels[..panels.len().min(MOST_PANELS)];
    let columns = if shown.len() > 1 { 2 } else { 1 };
    let [left, right, above, below] = AROUND;
    let cell = [PANEL[0] + left + right, PANEL[1] + above + below];
    let place = |at: usize| {
        let (column, row) = ((at % columns) as f64, (at / columns) as f64);
        let (x, y) = (EDGE + left + column * cell[0], EDGE + above + row * cell[1]);
        Area { x, y, w: PANEL[0], h: PANEL[1] }
    };
    let layouts = shown.iter().enumerate().map(|(at, panel)| Layout::new(kind, panel, place(at))).collect();
    let (w, h) = (columns as f64 * cell[0], shown.len().div_ceil(columns) as f64 * cell[1]);
    (Area { x: EDGE, y: EDGE, w, h }, layouts)
}

fn marks_page(chart: &Chart, panels: &[Panel], provenance: &Provenance) -> String {
    let (area, layouts) = layouts(chart.kind, panels);
    let names = panels.iter().flat_map(|panel| &panel.series).map(|series| series.name.as_str());
    let styles = numbered(names);
    let legend = Legend::new(&styles, area.w, chart.kind == Kind::ErrorTime);
    let mut caption = chart.caption.clone();
    caption.extend(more("panels", panels.len(), MOST_PANELS));
    caption.extend(more("series in the legend", styles.len(), MOST_ENTRIES));
    let caption = wrapped(&caption, area.w);
    let mut svg = Svg::new(page(area, legend.lines + caption.len()));
    let axes = match chart.kind {
        Kind::Cost => ["photons (N × N buffer)", "time, ms a frame"],
        _ => ["time, ms a frame", &chart.measure],
    };
    for (panel, layout) in panels.iter().zip(&layouts) {
        title(&mut svg, layout.frame, &panel.title);
        layout.draw(&mut svg, panel, |name| styles[name], axes);
    }
    let mut y = area.y + area.h + LINE;
    for (text, at, style) in &legend.entries {
        let ([x, row], half) = (*at, SAMPLE / 2.0);
        let line = y + row - 4.0;
        match style {
            Some(style) => {
                svg.element(format_args!(
                    r#"<path d="M{x:.1} {line:.1}h{SAMPLE}" stroke="{}" stroke-width="1.6" stroke-dasharray="{}"/>"#,
                    style::colour(*style),
                    style::dashes(*style)
                ));
                style::mark(&mut svg, *style, [x + half, line], false);
            }
            None => svg.element(format_args!(
                r##"<path d="M{:.1} {line:.1}h{:.1}" stroke="#ddd" stroke-width="11" stroke-linecap="round"/>"##,
                x + 5.0,
                SAMPLE - 10.0
            )),
        }
        svg.text([x + SAMPLE + 6.0, y + row], SMALL, Anchor::Start, "", text);
    }
    y += legend.lines as f64 * LINE;
    write_caption(&mut svg, y, &caption);
    svg.finish(&format!("nephroid plot: {}", chart.kind), provenance)
}

fn bars_page(chart: &Chart, unit: &str, panels: &[BarPanel], provenance: &Provenance) -> String {
    let shown = &panels[..panels.len().min(MOST_PANELS)];
    let [_, _, above, below] = AROUND;
    let left = bars::names_width(shown);
    let mut frames: Vec<Area> = Vec::new();
    for panel in shown {
        let y = frames.last().map_or(EDGE, |last| last.y + last.h + below) + above;
        let h = bars::PITCH * bars::drawn(panel).len() as f64;
        frames.push(Area { x: EDGE + left, y, w: BARS_WIDTH - left, h });
    }
    let bottom = frames.last().map_or(0.0, |last| last.y + last.h + below);
    let area = Area { x: EDGE, y: EDGE, w: BARS_WIDTH, h: bottom - EDGE };
    let parts = shown.iter().flat_map(bars::drawn).flat_map(|bar| &bar.parts).map(|(name, _)| name.as_str());
    let styles = numbered(parts);
    // A step's bar has its name beside it.
    let legend = if chart.kind == Kind::Stages { Legend::new(&styles, area.w, false) } else { Legend::default() };
    let mut caption = chart.caption.clone();
    caption.extend(more("panels", panels.len(), MOST_PANELS));
    let most_bars = panels.iter().map(|panel| panel.bars.len()).max().unwrap_or(0);
    caption.extend(more("bars of a panel", most_bars, bars::MOST));
    let caption = wrapped(&caption, area.w);
    let mut svg = Svg::new(page(area, legend.lines + caption.len()));
    for (panel, frame) in shown.iter().zip(&frames) {
        title(&mut svg, Area { x: EDGE, ..*frame }, &panel.title);
        bars::draw(&mut svg, panel, *frame, unit, |name| styles[name]);
    }
    let y = area.y + area.h + LINE;
    for (text, [x, row], style) in &legend.entries {
        let place = format!(r#"x="{x:.1}" y="{:.1}" width="{SAMPLE}" height="11""#, y + row - 9.5);
        style.iter().for_each(|style| bars::swatch(&mut svg, &place, *style));
        svg.text([x + SAMPLE + 6.0, y + row], SMALL, Anchor::Start, "", text);
    }
    write_caption(&mut svg, y + legend.lines as f64 * LINE, &caption);
    svg.finish(&format!("nephroid plot: {}", chart.kind), provenance)
}

/// Names in the order in which they come, from 0.
fn numbered<'a>(names: impl Iterator<Item = &'a str>) -> BTreeMap<&'a str, usize> {
    let mut numbers = BTreeMap::new();
    for name in names {
        let next = numbers.len();
        numbers.entry(name).or_insert(next);
    }
    numbers
}

/// Samples and names in lines that fit: text, place, style; the front has none.
#[derive(Default)]
struct Legend {
    entries: Vec<(String, [f64; 2], Option<usize>)>,
    lines: usize,
}

impl Legend {
    fn new(styles: &BTreeMap<&str, usize>, width: f64, with_front: bool) -> Self {
        let mut named: Vec<_> = styles.iter().map(|(name, style)| ((*name).to_owned(), Some(*style))).collect();
        named.sort_by_key(|(_, style)| *style);
        named.truncate(MOST_ENTRIES);
        if with_front {
            named.push(("what nothing beats: no other is both faster and less wrong".to_owned(), None));
        }
        let (mut x, mut line, mut entries) = (EDGE, 0, Vec::new());
        for (name, style) in named {
            let wide = SAMPLE + 6.0 + text_width(&name, SMALL) + 18.0;
            if x > EDGE && x + wide > EDGE + width {
                (x, line) = (EDGE, line + 1);
            }
            entries.push((name, [x, line as f64 * LINE], style));
            x += wide;
        }
        Self { lines: line + usize::from(!entries.is_empty()), entries }
    }
}

fn more(what: &str, count: usize, most: usize) -> Option<String> {
    (count > most).then(|| format!("Drawn are {most} of {count} {what}; the CSV has all."))
}

/// px of the page below whose panels stand so many lines.
fn page(area: Area, lines: usize) -> [f64; 2] {
    [area.x + area.w + EDGE, area.y + area.h + lines as f64 * LINE + LINE + EDGE]
}

fn title(svg: &mut Svg, frame: Area, text: &str) {
    svg.text([frame.x, frame.y - 10.0], SMALL + 2.0, Anchor::Start, r#"font-weight="600""#, text);
}

fn write_caption(svg: &mut Svg, y: f64, lines: &[String]) {
    for (at, text) in lines.iter().enumerate() {
        let y = y + 4.0 + at as f64 * LINE;
        svg.text([EDGE, y], SMALL, Anchor::Start, r##"fill="#555""##, text);
    }
}

/// Sentences in lines that fit, broken between words.
fn wrapped(sentences: &[String], width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in sentences.iter().flat_map(|sentence| sentence.split(' ')) {
        match lines.last_mut() {
            Some(line) if text_width(line, SMALL) + text_width(word, SMALL) + SMALL < width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
