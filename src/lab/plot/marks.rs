//! Marks over logarithmic axes, laid out and drawn.

use super::{
    axis::LogAxis,
    chart::{Kind, Mark, Panel, side},
    labels::{Area, Wanted, place},
    style::{self, RADIUS},
    svg::{Anchor, Svg, text_width},
};

/// px of letters beside axes and marks.
pub const SMALL: f64 = 11.0;
/// px that marks without a place on the axis have at an edge.
const STRIP: f64 = 26.0;
/// Most marks that are all labelled; of more, the ends of each series are.
const LABELLED: usize = 40;
/// Most series whose ends are labelled.
const ENDS_LABELLED: usize = 12;
/// px between the boxes along a line that labels keep off.
const ALONG_LINE: f64 = 6.0;

/// A panel with every mark at its place.
pub struct Layout {
    /// Inside the axes.
    pub frame: Area,
    x: LogAxis,
    y: LogAxis,
    /// Of marks at an edge: left, right, bottom, top.
    strips: [bool; 4],
    /// Text and place of each label.
    pub labels: Vec<(String, Area)>,
}

impl Layout {
    /// Lays a panel out in `frame`.
    pub fn new(kind: Kind, panel: &Panel, frame: Area) -> Self {
        let marks = || panel.series.iter().flat_map(|series| &series.marks);
        let values = |of: fn(&Mark) -> super::result::Estimate| {
            marks().flat_map(move |mark| {
                let estimate = of(mark);
                [estimate.value.0].into_iter().chain(estimate.interval().into_iter().flatten())
            })
        };
        let over = if kind == Kind::Cost { LogAxis::over_photons } else { LogAxis::over };
        let (below, above) = (|v: f64| v <= 0.0, |v: f64| v == f64::INFINITY || v.is_nan());
        let strips = [
            marks().any(|mark| below(mark.x.value.0)),
            marks().any(|mark| above(mark.x.value.0)),
            marks().any(|mark| below(mark.y.value.0)),
            marks().any(|mark| above(mark.y.value.0)),
        ];
        let (x, y) = (over(values(|mark| mark.x).collect::<Vec<_>>()), LogAxis::over(values(|mark| mark.y)));
        let mut layout = Self { frame, x, y, strips, labels: Vec::new() };
        layout.labels = layout.place_labels(panel);
        layout
    }

    /// Inside the strips.
    fn inner(&self) -> Area {
        let [left, right, bottom, top] = self.strips.map(|strip| if strip { STRIP } else { 0.0 });
        let Area { x, y, w, h } = self.frame;
        Area { x: x + left, y: y + top, w: w - left - right, h: h - top - bottom }
    }

    fn x(&self, value: f64) -> f64 {
        let (inner, frame) = (self.inner(), self.frame);
        match value {
            value if value <= 0.0 => frame.x + STRIP / 2.0,
            value if value.is_finite() => inner.x + inner.w * self.x.place(value).clamp(0.0, 1.0),
            _ => frame.x + frame.w - STRIP / 2.0,
        }
    }

    fn y(&self, value: f64) -> f64 {
        let (inner, frame) = (self.inner(), self.frame);
        match value {
            value if value <= 0.0 => frame.y + frame.h - STRIP / 2.0,
            value if value.is_finite() => inner.y + inner.h * (1.0 - self.y.place(value).clamp(0.0, 1.0)),
            _ => frame.y + STRIP / 2.0,
        }
    }

    fn at(&self, mark: &Mark) -> [f64; 2] {
        [self.x(mark.x.value.0), self.y(mark.y.value.0)]
    }

    /// What labels keep off: marks, their intervals, and the lines between them.
    fn obstacles(&self, panel: &Panel) -> Vec<Area> {
        let mut areas = Vec::new();
        let around = |[x, y]: [f64; 2], [w, h]: [f64; 2]| Area { x: x - w / 2.0, y: y - h / 2.0, w, h };
        for series in &panel.series {
            for mark in &series.marks {
                let [x, y] = self.at(mark);
                areas.push(around([x, y], [2.0 * RADIUS; 2]));
                for [a, b] in self.whiskers(mark) {
                    areas.push(around(middle(a, b), [(b[0] - a[0]).abs() + 2.0, (b[1] - a[1]).abs() + 2.0]));
                }
            }
            for [a, b] in self.line(&series.marks).array_windows() {
                let steps = ((b[0] - a[0]).hypot(b[1] - a[1]) / ALONG_LINE).ceil().max(1.0) as usize;
                let share = |step: usize| step as f64 / steps as f64;
                let along = |axis: usize, step| a[axis] + (b[axis] - a[axis]) * share(step);
                areas.extend((0..=steps).map(|step| around([along(0, step), along(1, step)], [3.0; 2])));
            }
        }
        areas
    }

    fn place_labels(&self, panel: &Panel) -> Vec<(String, Area)> {
        let count: usize = panel.series.iter().map(|series| series.marks.len()).sum();
        let mut named: Vec<&Mark> = match panel.series.len() {
            _ if count <= LABELLED => panel.series.iter().flat_map(|series| &series.marks).collect(),
            few if few <= ENDS_LABELLED => {
                panel.series.iter().flat_map(|s| s.marks.first().into_iter().chain(s.marks.last())).collect()
            }
            _ => Vec::new(),
        };
        named.retain(|mark| mark.photons > 0);
        let texts: Vec<_> = named.iter().map(|mark| side(mark.photons)).collect();
        let wanted = named.iter().zip(&texts);
        let wanted = wanted.map(|(mark, text)| Wanted { at: self.at(mark), size: [text_width(text, SMALL), SMALL] });
        let wanted: Vec<_> = wanted.collect();
        if wanted.is_empty() {
            return Vec::new();
        }
        let places = place(&self.frame, &self.obstacles(panel), &wanted);
        texts.into_iter().zip(places).filter_map(|(text, area)| area.map(|area| (text, area))).collect()
    }

    /// Ends of a mark's intervals, both ways; those of a mark at an edge stay there.
    fn whiskers(&self, mark: &Mark) -> Vec<[[f64; 2]; 2]> {
        let [x, y] = self.at(mark);
        let along = mark.x.interval().map(|[a, b]| [[self.x(a), y], [self.x(b), y]]);
        let up = mark.y.interval().map(|[a, b]| [[x, self.y(a)], [x, self.y(b)]]);
        along.into_iter().chain(up).collect()
    }

    /// Through the marks of the series' front, where it has one, else through all that have a place.
    fn line(&self, marks: &[Mark]) -> Vec<[f64; 2]> {
        let fronted = marks.iter().any(|mark| mark.front);
        let mut on: Vec<_> = marks.iter().filter(|m| m.is_placeable() && (m.front || !fronted)).collect();
        on.sort_by(|a, b| a.x.value.0.total_cmp(&b.x.value.0));
        on.into_iter().map(|mark| self.at(mark)).collect()
    }

    /// Draws the panel; `style_of` is the number of a series' style, `axes` the titles of x and y.
    pub fn draw(&self, svg: &mut Svg, panel: &Panel, style_of: impl Fn(&str) -> usize, axes: [&str; 2]) {
        self.draw_axes(svg, axes);
        if panel.front.len() > 1 {
            let front: Vec<_> = panel.front.iter().map(|[x, y]| [self.x(*x), self.y(*y)]).collect();
            line(svg, &front, r##"stroke="#ddd" stroke-width="11" stroke-linecap="round" stroke-linejoin="round""##);
        }
        for series in &panel.series {
            let style = style_of(&series.name);
            let (colour, dashes) = (style::colour(style), style::dashes(style));
            line(
                svg,
                &self.line(&series.marks),
                &format!(r#"stroke="{colour}" stroke-width="1.6" stroke-dasharray="{dashes}""#),
            );
            for mark in &series.marks {
                for ends in self.whiskers(mark) {
                    line(svg, &ends, &format!(r#"stroke="{colour}" stroke-width="1""#));
                }
            }
            series.marks.iter().for_each(|mark| style::mark(svg, style, self.at(mark), !mark.is_placeable()));
        }
        for (text, area) in &self.labels {
            svg.text([area.x, area.y + area.h - 2.0], SMALL, Anchor::Start, r##"fill="#444""##, text);
        }
    }

    fn draw_axes(&self, svg: &mut Svg, [along, up]: [&str; 2]) {
        let Area { x, y, w, h } = self.frame;
        let (bottom, rule) = (y + h, r##"stroke="#e6e6e6""##);
        for (value, label) in &self.x.ticks {
            let at = self.x(*value);
            line(svg, &[[at, y], [at, bottom]], rule);
            svg.text([at, bottom + 16.0], SMALL, Anchor::Middle, "", label);
        }
        for (value, label) in &self.y.ticks {
            let at = self.y(*value);
            line(svg, &[[x, at], [x + w, at]], rule);
            svg.text([x - 7.0, at + 4.0], SMALL, Anchor::End, "", label);
        }
        let inner = self.inner();
        let dotted = r##"stroke="#888" stroke-dasharray="1 3""##;
        let (right, low) = (inner.x + inner.w, inner.y + inner.h);
        let edges = [
            ([[inner.x, y], [inner.x, bottom]], [x + STRIP / 2.0, bottom + 16.0], Anchor::Middle, "0"),
            ([[right, y], [right, bottom]], [x + w - STRIP / 2.0, bottom + 16.0], Anchor::Middle, "∞, NaN"),
            ([[x, low], [x + w, low]], [x - 7.0, bottom - STRIP / 2.0 + 4.0], Anchor::End, "0"),
            ([[x, inner.y], [x + w, inner.y]], [x - 7.0, y + STRIP / 2.0 + 4.0], Anchor::End, "∞, NaN"),
        ];
        for ((edge, at, anchor, text), _) in edges.iter().zip(self.strips).filter(|(_, strip)| *strip) {
            line(svg, edge, dotted);
            svg.text(*at, SMALL, *anchor, "", text);
        }
        svg.element(format_args!(
            r##"<rect x="{x:.1}" y="{y:.1}" width="{w:.1}" height="{h:.1}" fill="none" stroke="#888"/>"##
        ));
        svg.text([x + w / 2.0, bottom + 36.0], SMALL + 1.0, Anchor::Middle, "", along);
        let (cx, cy) = (x - 56.0, y + h / 2.0);
        let turned = format!(r#"transform="rotate(-90 {cx:.1} {cy:.1})""#);
        svg.text([cx, cy], SMALL + 1.0, Anchor::Middle, &turned, up);
    }
}

fn middle(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].midpoint(b[0]), a[1].midpoint(b[1])]
}

fn line(svg: &mut Svg, points: &[[f64; 2]], style: &str) {
    if points.len() > 1 {
        let path: Vec<_> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        svg.element(format_args!(r#"<polyline points="{}" fill="none" {style}/>"#, path.join(" ")));
    }
}
