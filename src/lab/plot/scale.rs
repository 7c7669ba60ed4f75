//! How cost grows: time of each part of the frame and memory, over photons, a setting, or what the scene holds.

use serde::Serialize;

use super::{
    build::Made,
    chart::{Body, Mark, Panel, Series},
    result::{Estimate, Point},
    series::{Group, along_groups},
};
use crate::stats::Number;

/// What costs can be drawn over, beside any setting that is a number.
const OF_SCENE: [&str; 2] = ["lights", "triangles"];
const PHOTONS: &str = "photons";
/// What stands along an axis of photons.
pub const PHOTONS_AXIS: &str = "N (photons)";
/// Bytes of a MiB.
const MIB: f64 = 1_048_576.0;

/// How a series of a scale plot grows: y as x to the power of `overall`, and at its end to that of `last`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Growth {
    /// Scene, and what of it.
    pub panel: String,
    /// The series.
    pub series: String,
    /// Of all its marks, by least squares over logarithms.
    pub overall: Number,
    /// Between its last two.
    pub last: Number,
}

/// Panels over `along`: photons, lights, triangles, or a setting.
pub fn scale(points: &[Point], along: &str) -> Made {
    let scene = if OF_SCENE.contains(&along) { "scene." } else { "\0" };
    let mut panels = Vec::new();
    for group in &along_groups(points, along, scene) {
        let parts = parts(group);
        let of = |name: &str, unit: &str, y: &dyn Fn(&Point) -> Option<Estimate>| {
            let (title, axes) = (format!("{}: {name}", group.title), [along_name(along), format!("{name} ({unit})")]);
            let series = series(group, along, y);
            (!series.is_empty()).then_some(Panel { title, axes, series, front: Vec::new() })
        };
        panels.extend(of("frame", "ms", &|point| Some(point.time)));
        panels.extend(parts.iter().filter_map(|part| of(part, "ms", &|point| of_part(point, part))));
        panels.extend(of("memory", "MiB", &|point| Some(Estimate::plain(point.bytes? as f64 / MIB))));
    }
    let without = points.iter().filter(|point| place(point, along).is_none()).count();
    let mut caption = vec![
        "Time: sums of the medians of stages, by the first word of their names. Beside each last mark: the power of x \
         that y grows with, over all marks, and between the last two."
            .to_owned(),
    ];
    if without > 0 {
        caption.push(format!("Points left out that say no {along}: {without}."));
    }
    (Body::Marks(panels), caption)
}

fn along_name(along: &str) -> String {
    if along == PHOTONS { PHOTONS_AXIS.to_owned() } else { along.to_owned() }
}

/// First words of stages, in their order.
fn parts(group: &Group) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for (name, _) in group.series.values().flatten().flat_map(|point| &point.stages) {
        let part = first_word(name);
        if !parts.iter().any(|known| known == part) {
            parts.push(part.to_owned());
        }
    }
    parts
}

fn first_word(stage: &str) -> &str {
    stage.split('/').next().unwrap_or(stage)
}

/// Stages are timed together, so that their sum has no interval of its own.
fn of_part(point: &Point, part: &str) -> Option<Estimate> {
    let of = point.stages.iter().filter(|(name, _)| first_word(name) == part).map(|(_, time)| time.value.0);
    of.reduce(|a, b| a + b).map(Estimate::plain)
}

/// Where a point stands.
fn place(point: &Point, along: &str) -> Option<f64> {
    match along {
        PHOTONS => Some(point.photons as f64).filter(|n| *n > 0.0),
        "lights" => Some(point.lights? as f64),
        "triangles" => Some(point.triangles? as f64),
        key => point.settings.get(key)?.parse().ok(),
    }
}

fn series(group: &Group, along: &str, y: &dyn Fn(&Point) -> Option<Estimate>) -> Vec<Series> {
    let mark = |point: &&Point| {
        let x = Estimate::plain(place(point, along)?);
        Some(Mark { x, y: y(point)?, photons: point.photons, front: false, place: point.place.clone() })
    };
    let of = |(name, points): (&super::series::Name, &Vec<&Point>)| {
        let mut marks: Vec<Mark> = points.iter().filter_map(mark).collect();
        marks.sort_by(|a, b| a.x.value.0.total_cmp(&b.x.value.0));
        (!marks.is_empty()).then(|| Series { name: name.name.clone(), device: name.device.clone(), marks })
    };
    group.series.iter().filter_map(of).collect()
}

/// The growth of every series with two marks at least.
pub fn growth(panels: &[Panel]) -> Vec<Growth> {
    let of = |panel: &Panel, series: &Series| {
        let [overall, last] = powers(series)?.map(Number);
        Some(Growth { panel: panel.title.clone(), series: series.name.clone(), overall, last })
    };
    panels.iter().flat_map(|panel| panel.series.iter().filter_map(move |series| of(panel, series))).collect()
}

/// The power of x that y grows with: over all, and between the last two; none where x does not change.
pub fn powers(series: &Series) -> Option<[f64; 2]> {
    let placed = series.marks.iter().filter(|mark| mark.is_placeable());
    let logs: Vec<[f64; 2]> = placed.map(|mark| [mark.x.value.0.ln(), mark.y.value.0.ln()]).collect();
    let overall = slope(&logs)?;
    let last = logs.len().checked_sub(2).and_then(|from| slope(&logs[from..]));
    Some([overall, last.unwrap_or(overall)])
}

fn slope(points: &[[f64; 2]]) -> Option<f64> {
    let count = points.len() as f64;
    let mean = |at: usize| points.iter().map(|p| p[at]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let along: f64 = points.iter().map(|p| (p[0] - x).powi(2)).sum();
    let both: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    (along > 0.0).then(|| both / along)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[[f64; 2]]) -> Series {
        let [name, device] = [String::new(), String::new()];
        let mark = |&[x, y]: &[f64; 2]| {
            let [x, y] = [x, y].map(Estimate::plain);
            Mark { x, y, photons: 0, front: false, place: String::new() }
        };
        Series { name, device, marks: values.iter().map(mark).collect() }
    }

    #[test]
    fn powers_are_those_that_marks_were_made_of() {
        let cubes: Vec<[f64; 2]> = (1..6).map(|k| [f64::from(k), 5.0 * f64::from(k).powi(3)]).collect();
        let [overall, last] = powers(&of(&cubes)).unwrap();
        assert!((overall - 3.0).abs() < 1e-12 && (last - 3.0).abs() < 1e-12, "{overall} {last}");
        // A fixed cost hides growth at first.
        let [overall, last] = powers(&of(&[[1.0, 10.0], [10.0, 10.0], [100.0, 100.0]])).unwrap();
        assert!((overall - 0.5).abs() < 1e-12 && (last - 1.0).abs() < 1e-12, "{overall} {last}");
        assert!(powers(&of(&[[2.0, 1.0]])).is_none() && powers(&of(&[[2.0, 1.0], [2.0, 3.0]])).is_none());
        assert!(powers(&of(&[[2.0, 0.0], [4.0, f64::NAN]])).is_none(), "nothing of these has a place");
    }
}
