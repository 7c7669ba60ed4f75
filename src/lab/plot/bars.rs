//! Bars over a linear axis: parts from zero outwards, those below zero to the left.

use super::{
    axis::{linear_ticks, number},
    chart::{Bar, BarPanel},
    labels::Area,
    marks::SMALL,
    style,
    svg::{Anchor, Svg, text_width},
};

/// px from bar to bar, and of a bar.
pub const PITCH: f64 = 24.0;
const THICK: f64 = 15.0;
/// px between a bar's end and what stands behind it.
const BEHIND: f64 = 8.0;
/// Most bars of a panel that are drawn; the CSV has all.
pub const MOST: usize = 40;
/// Longest name beside a bar, px.
const LONGEST_NAME: f64 = 330.0;

/// The bars of a panel that are drawn.
pub fn drawn(panel: &BarPanel) -> &[Bar] {
    &panel.bars[..panel.bars.len().min(MOST)]
}

/// px beside the bars that their names take.
pub fn names_width(panels: &[BarPanel]) -> f64 {
    let widths = panels.iter().flat_map(drawn).map(|bar| text_width(&bar.name, SMALL));
    widths.fold(40.0, f64::max).min(LONGEST_NAME) + 12.0
}

/// Sums of parts to the left and to the right of zero; what is not finite has no length.
fn reach(bar: &Bar) -> [f64; 2] {
    let lengths = || bar.parts.iter().map(|(_, part)| part.value.0).filter(|v| v.is_finite());
    let whole = bar.whole.map(|whole| whole.interval().map_or(whole.value.0, |[_, high]| high));
    let right: f64 = lengths().filter(|v| *v > 0.0).sum();
    [lengths().filter(|v| *v < 0.0).sum(), right.max(whole.filter(|v| v.is_finite()).unwrap_or(0.0))]
}

/// What stands behind a bar: its whole with the interval, its remark, and what of it has no length.
fn behind(bar: &Bar) -> String {
    let whole = bar.whole.map(|whole| match whole.interval() {
        Some([low, high]) => format!("{} ms ({} to {})", short(whole.value.0), short(low), short(high)),
        None => format!("{} ms", short(whole.value.0)),
    });
    let lost = bar.parts.iter().filter(|(_, part)| !part.value.0.is_finite());
    let lost =
        lost.map(
            |(name, part)| {
                if bar.parts.len() > 1 { format!("{name} is {}", part.value.0) } else { part.value.0.to_string() }
            },
        );
    let signed = bar.parts.first().filter(|(_, p)| bar.whole.is_none() && p.value.0.is_finite());
    let signed = signed.map(|(_, part)| format!("{:+.2e}", part.value.0).replace('-', "−"));
    let remark = Some(bar.remark.clone()).filter(|remark| !remark.is_empty());
    signed.into_iter().chain(whole).chain(remark).chain(lost).collect::<Vec<_>>().join("; ")
}

/// Three digits.
fn short(value: f64) -> String {
    match value.abs() {
        v if !v.is_finite() => value.to_string(),
        v if v >= 100.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

/// Draws a panel; `style_of` is the number of a part's style.
pub fn draw(svg: &mut Svg, panel: &BarPanel, frame: Area, unit: &str, style_of: impl Fn(&str) -> usize) {
    let bars = drawn(panel);
    let ends = bars.iter().map(reach).fold([0.0f64, 0.0f64], |[l, h], [a, b]| [l.min(a), h.max(b)]);
    let room = bars.iter().map(|bar| text_width(&behind(bar), SMALL) + 2.0 * BEHIND).fold(0.0, f64::max);
    let width = (frame.w - room).max(frame.w * 0.35);
    let span = if ends[1] > ends[0] { ends[1] - ends[0] } else { 1.0 };
    let at = |value: f64| frame.x + width * (value - ends[0]) / span;
    for tick in linear_ticks([ends[0], ends[0] + span]) {
        let x = at(tick);
        let (top, bottom) = (frame.y, frame.y + frame.h);
        let rule = if tick == 0.0 { "#555" } else { "#e6e6e6" };
        svg.element(format_args!(r#"<path d="M{x:.1} {top:.1}V{bottom:.1}" stroke="{rule}"/>"#));
        svg.text([x, bottom + 16.0], SMALL, Anchor::Middle, "", &number(tick));
    }
    svg.text([at(ends[0] + span / 2.0), frame.y + frame.h + 36.0], SMALL + 1.0, Anchor::Middle, "", unit);
    for (row, bar) in bars.iter().enumerate() {
        let y = frame.y + PITCH * (row as f64 + 0.5);
        svg.text([frame.x - 8.0, y + 4.0], SMALL, Anchor::End, "", &cut(&bar.name));
        let mut reached = [0.0f64; 2];
        for (name, part) in bar.parts.iter().filter(|(_, part)| part.value.0.is_finite()) {
            let side = usize::from(part.value.0 > 0.0);
            let from = reached[side];
            reached[side] += part.value.0;
            let (a, b) = (at(from.min(reached[side])), at(from.max(reached[side])));
            part_of(svg, Area { x: a, y: y - THICK / 2.0, w: b - a, h: THICK }, style_of(name));
            if bar.parts.len() == 1 {
                whisker(svg, part.interval().map(|ends| ends.map(at)), y);
            }
        }
        whisker(svg, bar.whole.and_then(|whole| whole.interval()).map(|ends| ends.map(at)), y);
        svg.text([at(reach(bar)[1]) + BEHIND, y + 4.0], SMALL, Anchor::Start, r##"fill="#444""##, &behind(bar));
    }
}

fn part_of(svg: &mut Svg, Area { x, y, w, h }: Area, style: usize) {
    let place = format!(r#"x="{x:.2}" y="{y:.1}" width="{w:.2}" height="{h:.1}""#);
    swatch(svg, &place, style);
}

/// A rectangle filled as part `style` is.
pub fn swatch(svg: &mut Svg, place: &str, style: usize) {
    svg.element(format_args!(r#"<rect {place} fill="{}"/>"#, style::colour(style)));
    if let Some(hatch) = style::hatch(style) {
        svg.element(format_args!(r##"<rect {place} fill="url(#hatch{hatch})"/>"##));
    }
    svg.element(format_args!(r##"<rect {place} fill="none" stroke="#fff" stroke-width="0.6"/>"##));
}

fn whisker(svg: &mut Svg, ends: Option<[f64; 2]>, y: f64) {
    let Some([a, b]) = ends.filter(|ends| ends.iter().all(|end| end.is_finite())) else { return };
    let (top, bottom) = (y - 4.0, y + 4.0);
    svg.element(format_args!(
        r##"<path d="M{a:.1} {y:.1}H{b:.1}M{a:.1} {top:.1}V{bottom:.1}M{b:.1} {top:.1}V{bottom:.1}" stroke="#222" fill="none"/>"##
    ));
}

/// A name that fits beside the bars.
fn cut(name: &str) -> String {
    if text_width(name, SMALL) <= LONGEST_NAME {
        return name.to_owned();
    }
    let mut short = String::from("…");
    // Names differ at their ends: settings come after the method, N comes last.
    for c in name.chars().rev() {
        if text_width(&short, SMALL) + SMALL > LONGEST_NAME {
            break;
        }
        short.insert('…'.len_utf8(), c);
    }
    short
}
