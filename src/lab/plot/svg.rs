//! SVG as text, and the same SVG as pixels.

use std::{fmt::Write, sync::Arc};

use resvg::{
    tiny_skia::{Pixmap, Transform},
    usvg::{Options, Tree, fontdb::Database},
};

use crate::image::{ImageError, Provenance, rgb_to_png};

/// Any browser has one of these; Verdana's letters are as wide as those of DejaVu Sans.
const FAMILIES: &str = "DejaVu Sans, Verdana, Arial, sans-serif";
/// The letters of PNG pictures, and those by which labels are measured.
const FONT: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");
/// Pixels of a PNG for a px of the SVG.
const SCALE: f32 = 2.0;
/// Longest side of a PNG, pixels: beyond it a plot is drawn smaller.
const LONGEST: f32 = 16384.0;
/// Widths of the letters from space to `~`, thousandths of the size.
const WIDTHS: [u16; 95] = [
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636, 636, 636, 636, 636,
    636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632, 575, 775, 752, 295, 295, 656, 557, 863,
    748, 787, 603, 787, 695, 635, 611, 732, 684, 989, 685, 611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635,
    615, 352, 635, 634, 278, 278, 579, 278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636,
    337, 636, 838,
];
/// Of letters beyond: raised digits, and all others, which are at most so wide.
const RAISED: u16 = 401;
const WIDEST: u16 = 1000;

/// How wide a line of text is, in the unit of `size`.
pub fn text_width(text: &str, size: f64) -> f64 {
    let width = |c: char| match c {
        ' '..='~' => WIDTHS[c as usize - ' ' as usize],
        '²' | '³' | '¹' | '⁰' | '⁴'..='⁹' => RAISED,
        '⁻' => 528,
        '×' | '−' => 838,
        _ => WIDEST,
    };
    text.chars().map(|c| f64::from(width(c))).sum::<f64>() / 1000.0 * size
}

/// Where a text's point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Left end.
    Start,
    /// Middle.
    Middle,
    /// Right end.
    End,
}

/// A drawing that grows.
pub struct Svg {
    size: [f64; 2],
    body: String,
}

impl Svg {
    /// White, of a size in px.
    pub fn new(size: [f64; 2]) -> Self {
        Self { size, body: String::new() }
    }

    /// Any element, as it is written.
    pub fn element(&mut self, element: std::fmt::Arguments) {
        self.body.write_fmt(element).and_then(|()| self.body.write_str("\n")).expect("a string takes all");
    }

    /// A line of text; its baseline starts, is centred or ends at the point.
    pub fn text(&mut self, [x, y]: [f64; 2], size: f64, anchor: Anchor, style: &str, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escape(text);
        self.element(format_args!(
            r#"<text x="{x:.1}" y="{y:.1}" font-size="{size}" text-anchor="{anchor}" {style}>{text}</text>"#
        ));
    }

    /// The file: `title` for readers that show none of it, provenance as metadata.
    pub fn finish(self, title: &str, provenance: &Provenance) -> String {
        let [width, height] = self.size.map(f64::ceil);
        let mut said = String::new();
        for (key, value) in provenance {
            let (key, value) = (escape(key), escape(value));
            writeln!(said, r#"<entry xmlns="urn:nephroid" key="{key}">{value}</entry>"#).expect("a string takes all");
        }
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
             {height}\" font-family=\"{FAMILIES}\" fill=\"#222\" role=\"img\">\n<title>{}</title>\n<metadata>\n{said}\
             </metadata>\n{HATCHES}<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n{}</svg>\n",
            escape(title),
            self.body
        )
    }
}

/// White lines over a colour: `#hatch1` to `#hatch3`.
const HATCHES: &str = r##"<defs>
<pattern id="hatch1" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)"><rect width="2" height="7" fill="#fff"/></pattern>
<pattern id="hatch2" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(-45)"><rect width="2" height="7" fill="#fff"/></pattern>
<pattern id="hatch3" width="6" height="6" patternUnits="userSpaceOnUse"><circle cx="3" cy="3" r="1.3" fill="#fff"/></pattern>
</defs>
"##;

/// As text of an element or an attribute; what XML has no place for becomes �.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// The picture of an SVG of ours, two pixels a px, with provenance as text.
///
/// # Errors
/// [`ImageError`] if the picture cannot be encoded.
pub fn to_png(svg: &str, provenance: &Provenance) -> Result<Vec<u8>, ImageError> {
    let refused = |problem: String| ImageError::Format { format: "SVG", problem };
    let mut fonts = Database::new();
    fonts.load_font_data(FONT.to_vec());
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|error| refused(error.to_string()))?;
    let scale = SCALE.min(LONGEST / tree.size().width().max(tree.size().height()));
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| (side * scale).ceil() as u32);
    let mut pixels = Pixmap::new(width, height).ok_or_else(|| refused(format!("{width} × {height} pixels")))?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    let colours: Vec<_> = pixels.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
    rgb_to_png([width as usize, height as usize], &colours, provenance)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// px: what rounding to thousandths and the side bearings of the outer letters leave at size 100.
    const BEARINGS: f64 = 25.0;

    #[test]
    fn texts_are_as_wide_as_they_are_drawn() {
        let mut fonts = Database::new();
        fonts.load_font_data(FONT.to_vec());
        let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
        for text in ["512²", "light.tracer=wyman2005", "10⁻¹²", "2×10⁻⁵", "WMiljI|{}"] {
            let mut svg = Svg::new([4000.0, 200.0]);
            svg.text([0.0, 100.0], 100.0, Anchor::Start, "", text);
            let tree = Tree::from_str(&svg.finish("", &Provenance::new()), &options).unwrap();
            let drawn = tree.root().children().last().expect("the text").abs_bounding_box();
            let (drawn, said) = (f64::from(drawn.width()), text_width(text, 100.0));
            assert!((drawn - said).abs() <= BEARINGS, "{text}: {drawn} px drawn, {said} px said");
        }
    }

    #[test]
    fn what_files_name_cannot_break_the_svg() {
        let mut svg = Svg::new([100.0, 100.0]);
        let nasty = "<b a=\"1\">&\u{1}\n</svg>";
        svg.text([0.0, 50.0], 12.0, Anchor::End, "", nasty);
        let provenance = Provenance::from([(nasty.to_owned(), nasty.to_owned())]);
        let svg = svg.finish(nasty, &provenance);
        assert!(Tree::from_str(&svg, &Options::default()).is_ok(), "{svg}");
    }
}
