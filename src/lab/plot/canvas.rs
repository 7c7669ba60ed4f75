//! SVG, shape by shape; every text is kept with the box that it fills, so that what collides can be found.

use std::fmt::Write;

use super::{
    labels::Area,
    letters::{ASCENT, FAMILY, LINE, width},
    style::Shape,
};

/// A text where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// What it fills.
    pub area: Area,
    /// What it says.
    pub text: String,
}

/// Which part of a text stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
    /// Its right end.
    End,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Pen<'a> {
    /// As SVG writes it.
    pub colour: &'a str,
    /// px
    pub width: f64,
    /// As SVG writes it; empty for a whole line.
    pub dash: &'a str,
    /// From 0 to 1.
    pub opacity: f64,
}

/// A picture in the making, px from its upper left corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Canvas {
    /// Width and height.
    pub size: [f64; 2],
    shapes: String,
    texts: Vec<Written>,
}

impl Canvas {
    /// An empty one, this wide.
    pub fn new(width: f64) -> Self {
        Self { size: [width, 0.0], ..Self::default() }
    }

    /// Every text so far.
    pub fn texts(&self) -> &[Written] {
        &self.texts
    }

    /// A line through points.
    pub fn line(&mut self, points: &[[f64; 2]], pen: Pen) {
        let Pen { colour, width, dash, opacity } = pen;
        let points: Vec<_> = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        let dash = if dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dash}\"") };
        self.push(&format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-opacity=\"{opacity}\"{dash}/>",
            points.join(" ")
        ));
    }

    /// The picture of a file beside this one.
    pub fn picture(&mut self, file: &str, area: &Area) {
        let Area { x, y, w, h } = area;
        let file = escaped(file);
        self.push(&format!("<image href=\"{file}\" x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\"/>"));
    }

    /// A filled box.
    pub fn fill(&mut self, area: &Area, colour: &str, edge: &str) {
        let Area { x, y, w, h } = area;
        self.push(&format!(
            "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" fill=\"{colour}\" stroke=\"{edge}\" stroke-width=\"1\"/>"
        ));
    }

    /// A marker of a radius; hollow where it stands for what has no place.
    pub fn marker(&mut self, shape: Shape, [x, y]: [f64; 2], radius: f64, colour: &str, hollow: bool) {
        let polygon = |points: &[[f64; 2]]| {
            let points: Vec<_> =
                points.iter().map(|[dx, dy]| format!("{:.2},{:.2}", x + dx * radius, y + dy * radius)).collect();
            format!("<polygon points=\"{}\"", points.join(" "))
        };
        let outline = match shape {
            Shape::Disc => format!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\""),
            Shape::Square => polygon(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]),
            Shape::Up => polygon(&[[0.0, -1.2], [1.1, 0.8], [-1.1, 0.8]]),
            Shape::Diamond => polygon(&[[0.0, -1.3], [1.3, 0.0], [0.0, 1.3], [-1.3, 0.0]]),
            Shape::Down => polygon(&[[0.0, 1.2], [1.1, -0.8], [-1.1, -0.8]]),
            Shape::Plus => polygon(&PLUS),
        };
        let [fill, edge] = if hollow { ["#FFFFFF", colour] } else { [colour, "#FFFFFF"] };
        let pen = if hollow { 1.5 } else { 0.6 };
        self.push(&format!("{outline} fill=\"{fill}\" stroke=\"{edge}\" stroke-width=\"{pen}\"/>"));
    }

    /// A text of a size, in a colour; `at` is on its middle line.
    pub fn text(&mut self, text: &str, [x, y]: [f64; 2], size: f64, anchor: Anchor, colour: &str) {
        let area = area_of(text, [x, y], size, anchor);
        let base = area.y + ASCENT * size;
        self.push(&format!(
            "<text x=\"{:.2}\" y=\"{base:.2}\" font-size=\"{size}\" fill=\"{colour}\">{}</text>",
            area.x,
            escaped(text)
        ));
        self.texts.push(Written { area, text: text.to_owned() });
    }

    /// A text turned to read upwards; `at` is its middle.
    pub fn upwards(&mut self, text: &str, [x, y]: [f64; 2], size: f64) {
        let (w, h) = (LINE * size, width(text, size));
        let area = Area { x: x - w / 2.0, y: y - h / 2.0, w, h };
        let (base, start) = (area.x + ASCENT * size, area.y + h);
        self.push(&format!(
            "<text transform=\"translate({base:.2} {start:.2}) rotate(-90)\" font-size=\"{size}\" fill=\"#000000\">{}</text>",
            escaped(text)
        ));
        self.texts.push(Written { area, text: text.to_owned() });
    }

    fn push(&mut self, shape: &str) {
        self.shapes.push_str(shape);
        self.shapes.push('\n');
    }

    /// The whole file, with a title and metadata (any text).
    pub fn svg(&self, title: &str, metadata: &str) -> String {
        let [width, height] = self.size.map(f64::ceil);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"'{FAMILY}', Verdana, sans-serif\">\n"
        );
        let _ = writeln!(svg, "<title>{}</title>\n<metadata>{}</metadata>", escaped(title), escaped(metadata));
        let _ = writeln!(svg, "<rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n{}</svg>", self.shapes);
        svg
    }
}

/// What a text would fill.
pub fn area_of(text: &str, [x, y]: [f64; 2], size: f64, anchor: Anchor) -> Area {
    let (w, h) = (width(text, size), LINE * size);
    let left = match anchor {
        Anchor::Start => x,
        Anchor::Middle => x - w / 2.0,
        Anchor::End => x - w,
    };
    Area { x: left, y: y - h / 2.0, w, h }
}

const PLUS: [[f64; 2]; 12] = [
    [-0.4, -1.1],
    [0.4, -1.1],
    [0.4, -0.4],
    [1.1, -0.4],
    [1.1, 0.4],
    [0.4, 0.4],
    [0.4, 1.1],
    [-0.4, 1.1],
    [-0.4, 0.4],
    [-1.1, 0.4],
    [-1.1, -0.4],
    [-0.4, -0.4],
];

/// As XML holds it: characters that it has none for are left out.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '\n' | '\t' => out.push(c),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {}
            c => out.push(c),
        }
    }
    out
}
