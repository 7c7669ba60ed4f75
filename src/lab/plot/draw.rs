//! A chart as a picture: panels in one or two columns, below them the key and the caption.

use super::{
    axis::LogAxis,
    canvas::{Anchor, Canvas, Pen, area_of},
    chart::{Body, Chart, Kind, Mark, Panel, Series, side},
    draw_bars::draw_bars,
    labels::{Area, Wanted, place},
    letters::{fitted, wrapped},
    result::Estimate,
    scale::{PHOTONS_AXIS, powers},
    style::{self, Style},
};

/// Of the whole picture, px.
pub(super) const WIDTH: f64 = 960.0;
/// Of letters, px.
pub(super) const SMALL: f64 = 11.0;
pub(super) const MIDDLE: f64 = 12.0;
pub(super) const LARGE: f64 = 14.0;
/// Between lines of the key and of the caption.
pub(super) const STEP: f64 = 18.0;
pub(super) const BLACK: &str = "#000000";
pub(super) const GREY: &str = "#767676";
const FAINT: &str = "#DDDDDD";
/// From a panel's box to its plot: left, top, right, bottom.
const MARGINS: [f64; 4] = [84.0, 40.0, 24.0, 58.0];
const MARKER: f64 = 4.5;
/// Marks of a series that a line still leads through.
const LINED: usize = 60;
/// Labels of a panel.
const LABELLED: usize = 40;
/// Lines of the key; the CSV has every series.
const KEYED: usize = 40;
/// From the frame to what has no place inside, px.
const INSET: f64 = 7.0;

/// Draws a chart.
pub fn draw(chart: &Chart) -> Canvas {
    let mut canvas = Canvas::new(WIDTH);
    let bottom = match &chart.body {
        Body::Marks(panels) => draw_panels(&mut canvas, chart, panels),
        Body::Bars(unit, panels) => draw_bars(&mut canvas, unit, panels),
    };
    let bottom = draw_caption(&mut canvas, &chart.caption, bottom + 8.0);
    canvas.size[1] = bottom + 8.0;
    canvas
}

fn draw_caption(canvas: &mut Canvas, caption: &[String], mut y: f64) -> f64 {
    for line in caption.iter().flat_map(|text| wrapped(text, SMALL, WIDTH - 40.0)) {
        canvas.text(&line, [20.0, y + STEP / 2.0], SMALL, Anchor::Start, "#444444");
        y += STEP - 2.0;
    }
    y
}

fn draw_panels(canvas: &mut Canvas, chart: &Chart, panels: &[Panel]) -> f64 {
    let [columns, height] = if panels.len() > 1 { [2.0, 370.0] } else { [1.0, 520.0] };
    let width = WIDTH / columns;
    let key = key(panels);
    for (at, panel) in panels.iter().enumerate() {
        let (column, row) = (at % columns as usize, at / columns as usize);
        let area = Area { x: column as f64 * width, y: row as f64 * height, w: width, h: height };
        Drawing { canvas, chart, key: &key, panel }.draw(&area);
    }
    draw_key(canvas, &key, (panels.len() as f64 / columns).ceil() * height)
}

/// Every series once, in the order in which it is met.
fn key(panels: &[Panel]) -> Vec<(&str, &str)> {
    let mut key = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for series in panels.iter().flat_map(|panel| &panel.series) {
        let name = (series.name.as_str(), series.device.as_str());
        if seen.insert(name) {
            key.push(name);
        }
    }
    key
}

fn draw_key(canvas: &mut Canvas, key: &[(&str, &str)], top: f64) -> f64 {
    let mut y = top + STEP / 2.0;
    for (at, (name, _)) in key.iter().enumerate().take(KEYED) {
        let Style { colour, shape, dash } = style::of(at);
        canvas.line(&[[24.0, y], [64.0, y]], Pen { colour, width: 1.6, dash, opacity: 1.0 });
        canvas.marker(shape, [44.0, y], MARKER, colour, false);
        canvas.text(&fitted(name, MIDDLE, WIDTH - 96.0), [74.0, y], MIDDLE, Anchor::Start, BLACK);
        y += STEP;
    }
    if key.len() > KEYED {
        let more = format!("and {} more series: the CSV names them", key.len() - KEYED);
        canvas.text(&more, [74.0, y], MIDDLE, Anchor::Start, BLACK);
        y += STEP;
    }
    y - STEP / 2.0
}

struct Drawing<'a> {
    canvas: &'a mut Canvas,
    chart: &'a Chart,
    key: &'a [(&'a str, &'a str)],
    panel: &'a Panel,
}

/// Where values stand in a panel.
struct Frame {
    area: Area,
    x: LogAxis,
    y: LogAxis,
}

impl Frame {
    /// px; what has no place stands at an edge: infinite and not a number at the far one.
    fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let along = |axis: &LogAxis, value: f64, length: f64| {
            if value.is_finite() && value > 0.0 {
                axis.place(value) * length
            } else if value.is_nan() || value > 0.0 {
                length - INSET
            } else {
                INSET
            }
        };
        let Area { x: left, y: top, w, h } = self.area;
        [left + along(&self.x, x, w), top + h - along(&self.y, y, h)]
    }

    fn of(&self, mark: &Mark) -> [f64; 2] {
        self.at(mark.x.value.0, mark.y.value.0)
    }
}

impl Drawing<'_> {
    fn draw(&mut self, outer: &Area) {
        let [left, top, right, bottom] = MARGINS;
        let area = Area { x: outer.x + left, y: outer.y + top, w: outer.w - left - right, h: outer.h - top - bottom };
        let title = fitted(&self.panel.title, LARGE, outer.w - 40.0);
        self.canvas.text(&title, [outer.x + outer.w / 2.0, outer.y + 20.0], LARGE, Anchor::Middle, BLACK);
        let frame = self.frame(area);
        self.axes(&frame, outer);
        self.front(&frame);
        for series in &self.panel.series {
            self.series(&frame, series);
        }
        self.labels(&frame);
    }

    fn frame(&self, area: Area) -> Frame {
        let marks = || self.panel.series.iter().flat_map(|series| &series.marks);
        let values = |of: fn(&Mark) -> Estimate| {
            marks().flat_map(move |mark| {
                let estimate = of(mark);
                [Some(estimate.value.0), estimate.low.map(|v| v.0), estimate.high.map(|v| v.0)].into_iter().flatten()
            })
        };
        let x = values(|mark| mark.x);
        let photons = self.panel.axes[0] == PHOTONS_AXIS;
        let x = if photons { LogAxis::over_photons(x) } else { LogAxis::over(x) };
        Frame { area, x, y: LogAxis::over(values(|mark| mark.y)) }
    }

    fn axes(&mut self, frame: &Frame, outer: &Area) {
        let area = &frame.area;
        let (right, bottom) = (area.x + area.w, area.y + area.h);
        let faint = Pen { colour: FAINT, width: 1.0, dash: "", opacity: 1.0 };
        let mut written: Vec<Area> = Vec::new();
        for (value, label) in &frame.x.ticks {
            let x = area.x + frame.x.place(*value) * area.w;
            self.canvas.line(&[[x, area.y], [x, bottom]], faint);
            let place = area_of(label, [x, bottom + 14.0], SMALL, Anchor::Middle);
            if !written.iter().any(|other| other.overlaps(&place)) {
                self.canvas.text(label, [x, bottom + 14.0], SMALL, Anchor::Middle, BLACK);
                written.push(place);
            }
        }
        for (value, label) in &frame.y.ticks {
            let y = bottom - frame.y.place(*value) * area.h;
            self.canvas.line(&[[area.x, y], [right, y]], faint);
            let place = area_of(label, [area.x - 8.0, y], SMALL, Anchor::End);
            if !written.iter().any(|other| other.overlaps(&place)) {
                self.canvas.text(label, [area.x - 8.0, y], SMALL, Anchor::End, BLACK);
                written.push(place);
            }
        }
        let corners = [[area.x, area.y], [right, area.y], [right, bottom], [area.x, bottom], [area.x, area.y]];
        self.canvas.line(&corners, Pen { colour: GREY, ..faint });
        let [along, up] = &self.panel.axes;
        self.canvas.text(along, [area.x + area.w / 2.0, bottom + 36.0], MIDDLE, Anchor::Middle, BLACK);
        self.canvas.upwards(&fitted(up, MIDDLE, outer.h - 40.0), [outer.x + 20.0, area.y + area.h / 2.0], MIDDLE);
    }

    fn front(&mut self, frame: &Frame) {
        let front: Vec<_> = self.panel.front.iter().map(|[x, y]| frame.at(*x, *y)).collect();
        if front.len() > 1 {
            self.canvas.line(&front, Pen { colour: "#BBBBBB", width: 7.0, dash: "", opacity: 0.7 });
        }
    }

    fn series(&mut self, frame: &Frame, series: &Series) {
        let name = (series.name.as_str(), series.device.as_str());
        let Style { colour, shape, dash } = style::of(self.key.iter().position(|n| *n == name).unwrap_or(0));
        let placed: Vec<_> = series.marks.iter().filter(|mark| mark.is_placeable()).collect();
        if series.marks.len() <= LINED {
            let through: Vec<_> = placed.iter().map(|mark| frame.of(mark)).collect();
            self.canvas.line(&through, Pen { colour, width: 1.4, dash, opacity: 0.9 });
        }
        let thin = Pen { colour, width: 1.0, dash: "", opacity: 0.8 };
        for mark in placed {
            let Mark { x, y, .. } = mark;
            if let Some(ends) = x.interval() {
                self.canvas.line(&ends.map(|end| frame.at(end, y.value.0)), thin);
            }
            if let Some(ends) = y.interval() {
                self.canvas.line(&ends.map(|end| frame.at(x.value.0, end)), thin);
            }
        }
        for mark in &series.marks {
            self.canvas.marker(shape, frame.of(mark), MARKER, colour, !mark.is_placeable());
        }
    }

    /// N beside the points of the front, first those of the panel's; and at an edge, what stands there.
    fn labels(&mut self, frame: &Frame) {
        let all = || self.panel.series.iter().flat_map(|series| &series.marks);
        let edge = |mark: &&Mark| !mark.is_placeable();
        let fronts = |mark: &&Mark| self.chart.kind == Kind::ErrorTime && mark.front && mark.photons > 0;
        let texts = all().filter(edge).map(|mark| (mark, at_edge(mark)));
        let texts = texts.chain(all().filter(fronts).map(|mark| (mark, format!("N={}", side(mark.photons)))));
        let texts = texts.chain(growth(self.chart.kind, self.panel));
        let texts: Vec<(&Mark, String)> = texts.take(LABELLED).collect();
        let size = |text: &str| {
            let area = area_of(text, [0.0, 0.0], SMALL, Anchor::Start);
            [area.w, area.h]
        };
        let wanted: Vec<_> = texts.iter().map(|(mark, text)| Wanted { at: frame.of(mark), size: size(text) }).collect();
        for (place, (_, text)) in place(&frame.area, &self.obstacles(frame), &wanted).iter().zip(&texts) {
            if let Some(Area { x, y, h, .. }) = place {
                self.canvas.text(text, [*x, y + h / 2.0], SMALL, Anchor::Start, "#333333");
            }
        }
    }

    /// Marks and lines through them, as boxes.
    fn obstacles(&self, frame: &Frame) -> Vec<Area> {
        let around = |[x, y]: [f64; 2], r: f64| Area { x: x - r, y: y - r, w: 2.0 * r, h: 2.0 * r };
        let mut boxes = Vec::new();
        for series in &self.panel.series {
            boxes.extend(series.marks.iter().map(|mark| around(frame.of(mark), MARKER)));
            boxes.extend(series.marks.iter().filter(|mark| mark.is_placeable()).flat_map(|mark| bars(frame, mark)));
            if series.marks.len() > LINED {
                continue;
            }
            let placed: Vec<_> = series.marks.iter().filter(|m| m.is_placeable()).map(|m| frame.of(m)).collect();
            for [a, b] in placed.array_windows() {
                let steps = ((b[0] - a[0]).hypot(b[1] - a[1]) / 4.0).ceil().max(1.0) as u32;
                let along = (0..=steps).map(|at| f64::from(at) / f64::from(steps));
                boxes.extend(along.map(|s| around([a[0] + (b[0] - a[0]) * s, a[1] + (b[1] - a[1]) * s], 1.0)));
            }
        }
        boxes
    }
}

/// Of a scale plot, the powers beside the last mark of each series.
fn growth(kind: Kind, panel: &Panel) -> Vec<(&Mark, String)> {
    let of = |series: &Series| powers(series).map(|[all, last]| format!("^{all:.2}, ^{last:.2}"));
    let series = panel.series.iter().filter(|_| kind == Kind::Scale);
    series.filter_map(|series| Some((series.marks.last()?, of(series)?))).collect()
}

/// The boxes that a mark's intervals fill.
fn bars(frame: &Frame, mark: &Mark) -> impl Iterator<Item = Area> {
    let (x, y) = (mark.x.value.0, mark.y.value.0);
    let along = mark.x.interval().map(|ends| ends.map(|end| frame.at(end, y)));
    let up = mark.y.interval().map(|ends| ends.map(|end| frame.at(x, end)));
    let around = |[a, b]: [[f64; 2]; 2]| Area {
        x: a[0].min(b[0]) - 1.0,
        y: a[1].min(b[1]) - 1.0,
        w: (b[0] - a[0]).abs() + 2.0,
        h: (b[1] - a[1]).abs() + 2.0,
    };
    along.into_iter().chain(up).map(around)
}

/// Which values of a mark have no place.
fn at_edge(mark: &Mark) -> String {
    let name = |value: f64| match value {
        v if v.is_nan() => Some("NaN"),
        v if v.is_infinite() => Some("∞"),
        0.0 => Some("0"),
        v if v < 0.0 => Some("< 0"),
        _ => None,
    };
    let [x, y] = [mark.x.value.0, mark.y.value.0].map(name);
    match [x, y] {
        [Some(x), Some(y)] => format!("{x}, {y}"),
        [x, y] => x.or(y).unwrap_or_default().to_owned(),
    }
}
