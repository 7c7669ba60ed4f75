//! Bars: stages stacked along the time of a frame, steps of a budget to either side of zero.

use super::{
    axis::{linear_ticks, number},
    canvas::{Anchor, Canvas, Pen, area_of},
    chart::{Bar, BarPanel},
    draw::{BLACK, GREY, LARGE, MIDDLE, SMALL, STEP, WIDTH},
    labels::Area,
    letters::{fitted, width},
    style,
};

/// A bar's height and the distance to the next, px.
const HEIGHT: f64 = 18.0;
const PITCH: f64 = 28.0;
/// Room for names, before the bars, and for remarks, behind them, px: no more than this.
const NAMES: f64 = 300.0;
const REMARKS: f64 = 250.0;
/// Bars of a panel that are drawn; the CSV has them all.
const DRAWN: usize = 60;
const FAINT: &str = "#DDDDDD";

/// Draws panels one below the other; gives where they and their key end.
pub fn draw_bars(canvas: &mut Canvas, unit: &str, panels: &[BarPanel]) -> f64 {
    let key = key(panels);
    let mut y = 0.0;
    for panel in panels {
        y = draw_panel(canvas, unit, panel, &key, y);
    }
    for (at, name) in key.iter().enumerate() {
        let (colour, box_of) = (style::colour(at), Area { x: 24.0, y: y + 1.0, w: 28.0, h: STEP - 4.0 });
        canvas.fill(&box_of, colour, "#FFFFFF");
        let number = (at + 1).to_string();
        canvas.text(&number, [38.0, y + STEP / 2.0 - 1.0], SMALL, Anchor::Middle, style::ink_on(colour));
        let name = fitted(name, MIDDLE, WIDTH - 90.0);
        canvas.text(&name, [62.0, y + STEP / 2.0 - 1.0], MIDDLE, Anchor::Start, BLACK);
        y += STEP;
    }
    y
}

/// The names of parts, each once, where parts have names.
fn key(panels: &[BarPanel]) -> Vec<&str> {
    let mut key: Vec<&str> = Vec::new();
    for (name, _) in panels.iter().flat_map(|panel| &panel.bars).take(DRAWN).flat_map(|bar| &bar.parts) {
        if !name.is_empty() && !key.contains(&name.as_str()) {
            key.push(name);
        }
    }
    key
}

/// Where zero is, and how long a unit.
struct Scale {
    ends: [f64; 2],
    left: f64,
    length: f64,
}

impl Scale {
    fn at(&self, value: f64) -> f64 {
        self.left + (value - self.ends[0]) / (self.ends[1] - self.ends[0]) * self.length
    }
}

fn draw_panel(canvas: &mut Canvas, unit: &str, panel: &BarPanel, key: &[&str], top: f64) -> f64 {
    let bars = &panel.bars[..panel.bars.len().min(DRAWN)];
    let title = match panel.bars.len() - bars.len() {
        0 => panel.title.clone(),
        more => format!("{} (the first {DRAWN} bars; the CSV has {more} more)", panel.title),
    };
    canvas.text(&fitted(&title, LARGE, WIDTH - 40.0), [WIDTH / 2.0, top + 20.0], LARGE, Anchor::Middle, BLACK);
    let widest =
        |of: fn(&Bar) -> &str, most: f64| bars.iter().map(|bar| width(of(bar), MIDDLE)).fold(0.0, f64::max).min(most);
    let [names, remarks] = [widest(|bar| &bar.name, NAMES), widest(|bar| &bar.remark, REMARKS)];
    let left = 24.0 + names + 12.0;
    let scale = Scale { ends: ends(bars), left, length: WIDTH - left - remarks - 40.0 };
    let first = top + 44.0;
    let bottom = first + bars.len() as f64 * PITCH;
    draw_axis(canvas, unit, &scale, [first - 4.0, bottom]);
    for (at, bar) in bars.iter().enumerate() {
        let y = first + at as f64 * PITCH;
        canvas.text(&fitted(&bar.name, MIDDLE, names), [24.0, y + HEIGHT / 2.0], MIDDLE, Anchor::Start, BLACK);
        draw_bar(canvas, bar, key, &scale, y);
        let behind = scale.left + scale.length + 12.0;
        let remark = fitted(&bar.remark, MIDDLE, remarks);
        canvas.text(&remark, [behind, y + HEIGHT / 2.0], MIDDLE, Anchor::Start, BLACK);
    }
    bottom + 56.0
}

/// Around zero and all that is drawn.
fn ends(bars: &[Bar]) -> [f64; 2] {
    let mut ends = [0.0, 0.0];
    let mut hold = |value: f64| {
        if value.is_finite() {
            ends = [f64::min(ends[0], value), f64::max(ends[1], value)];
        }
    };
    for bar in bars {
        let parts = || bar.parts.iter().map(|(_, part)| part).chain(&bar.whole);
        parts().flat_map(|part| part.interval().into_iter().flatten()).for_each(&mut hold);
        parts().for_each(|part| hold(part.value.0));
        hold(bar.parts.iter().map(|(_, part)| part.value.0).filter(|v| v.is_finite() && *v > 0.0).sum());
    }
    let margin = 0.04 * (ends[1] - ends[0]);
    match ends {
        _ if !(margin > 0.0 && margin.is_finite()) => [0.0, 1.0],
        [low, high] if low < 0.0 => [low - margin, high + margin],
        [_, high] => [0.0, high + margin],
    }
}

fn draw_axis(canvas: &mut Canvas, unit: &str, scale: &Scale, [top, bottom]: [f64; 2]) {
    let pen = |colour| Pen { colour, width: 1.0, dash: "", opacity: 1.0 };
    let mut written: Vec<Area> = Vec::new();
    for tick in linear_ticks(scale.ends) {
        let (x, label) = (scale.at(tick), number(tick));
        canvas.line(&[[x, top], [x, bottom]], pen(if tick == 0.0 { GREY } else { FAINT }));
        let place = area_of(&label, [x, bottom + 12.0], SMALL, Anchor::Middle);
        if !written.iter().any(|other| other.overlaps(&place)) {
            canvas.text(&label, [x, bottom + 12.0], SMALL, Anchor::Middle, BLACK);
            written.push(place);
        }
    }
    canvas.line(&[[scale.left, bottom], [scale.left + scale.length, bottom]], pen(GREY));
    canvas.text(unit, [scale.left + scale.length / 2.0, bottom + 32.0], MIDDLE, Anchor::Middle, BLACK);
}

fn draw_bar(canvas: &mut Canvas, bar: &Bar, key: &[&str], scale: &Scale, y: f64) {
    let mut from = 0.0;
    for (name, part) in bar.parts.iter().filter(|(_, part)| part.value.0.is_finite()) {
        let of_key = key.iter().position(|known| known == name);
        // Without names, the sign is what the colour says; where the bar stands says it in grey.
        let colour = style::colour(of_key.unwrap_or(usize::from(part.value.0 < 0.0)));
        let [a, b] = [scale.at(from), scale.at(from + part.value.0)];
        let area = Area { x: a.min(b), y, w: (b - a).abs(), h: HEIGHT };
        canvas.fill(&area, colour, "#FFFFFF");
        if let Some(at) = of_key {
            let label = (at + 1).to_string();
            if width(&label, SMALL) + 4.0 < area.w {
                let middle = [area.x + area.w / 2.0, y + HEIGHT / 2.0];
                canvas.text(&label, middle, SMALL, Anchor::Middle, style::ink_on(colour));
            }
            from += part.value.0.max(0.0);
        } else if let Some(ends) = part.interval() {
            whisker(canvas, ends.map(|end| scale.at(end)), y + HEIGHT / 2.0);
        }
    }
    if let Some(whole) = bar.whole.filter(|whole| whole.value.0.is_finite()) {
        let x = scale.at(whole.value.0);
        canvas.line(&[[x, y - 3.0], [x, y + HEIGHT + 3.0]], Pen { colour: BLACK, width: 2.0, dash: "", opacity: 1.0 });
        if let Some(ends) = whole.interval() {
            whisker(canvas, ends.map(|end| scale.at(end)), y + HEIGHT / 2.0);
        }
    }
}

fn whisker(canvas: &mut Canvas, [a, b]: [f64; 2], y: f64) {
    let pen = Pen { colour: BLACK, width: 1.2, dash: "", opacity: 1.0 };
    canvas.line(&[[a, y], [b, y]], pen);
    [a, b].into_iter().for_each(|x| canvas.line(&[[x, y - 4.0], [x, y + 4.0]], pen));
}
