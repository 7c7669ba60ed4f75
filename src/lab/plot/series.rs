//! Which points belong together: one scene a panel; in it one method, one set of settings and one device a series.

use std::collections::{BTreeMap, BTreeSet};

use super::{
    chart::{Mark, Panel, Series},
    pareto::{Front, mark_front},
    result::Point,
};
use crate::methods;

/// The axis along which a series runs: never part of its name.
const ALONG: &str = "light.side";
/// Settings of the scene make another scene.
const OF_SCENE: &str = "scene.";

/// The points of one scene, by series.
pub struct Group<'a> {
    /// Scene, camera, size.
    pub title: String,
    /// By name.
    pub series: BTreeMap<Name, Vec<&'a Point>>,
}

/// What a series is called, and where it ran.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Name {
    /// Method and settings.
    pub name: String,
    /// The device.
    pub device: String,
}

/// Points by scene and series, each in the order of their names.
pub fn groups(points: &[Point]) -> Vec<Group<'_>> {
    along_groups(points, ALONG, ALONG)
}

/// As [`groups`], of series that run along the setting `along`, and along all that begin with `scene`.
pub fn along_groups<'a>(points: &'a [Point], along: &str, scene: &str) -> Vec<Group<'a>> {
    let along = |key: &str| key == along || (along == "photons" && key == ALONG) || key.starts_with(scene);
    let mut by_scene: BTreeMap<&str, Vec<&Point>> = BTreeMap::new();
    for point in points {
        by_scene.entry(&point.scene).or_default().push(point);
    }
    let mut titled: BTreeMap<String, Vec<&Point>> = BTreeMap::new();
    for points in by_scene.values() {
        let changed = changed(points, &along);
        for point in points {
            titled.entry(title(point, &changed)).or_default().push(point);
        }
    }
    // Of all points, so that a series is called the same in every panel.
    let differing = differing(points, &along);
    titled.into_iter().map(|(title, points)| Group { title, series: split(&points, &differing) }).collect()
}

/// Of one scene's own settings, those in which its points differ: what all share needs no place in a title.
fn changed<'a>(points: &[&'a Point], along: &dyn Fn(&str) -> bool) -> Vec<&'a str> {
    let keys: BTreeSet<&str> = points.iter().flat_map(|point| point.set.keys()).map(String::as_str).collect();
    let differs = |key: &&str| points.iter().map(|point| point.set.get(*key)).collect::<BTreeSet<_>>().len() > 1;
    keys.into_iter().filter(|key| key.starts_with(OF_SCENE) && !along(key)).filter(differs).collect()
}

fn title(point: &Point, changed: &[&str]) -> String {
    let [width, height] = point.size;
    let stated = changed.iter().filter_map(|key| Some((key, point.set.get(*key)?)));
    let stated: String = stated.map(|(key, value)| format!(", {}={value}", &key[OF_SCENE.len()..])).collect();
    let camera = if point.camera.is_empty() { String::new() } else { format!(", camera {}", point.camera) };
    format!("{}{stated}{camera}, {width} × {height}", point.scene)
}

fn split<'a>(points: &[&'a Point], differing: &[&str]) -> BTreeMap<Name, Vec<&'a Point>> {
    let devices: BTreeSet<_> = points.iter().map(|point| &point.device).collect();
    let mut series: BTreeMap<Name, Vec<&Point>> = BTreeMap::new();
    for point in points {
        let settings = differing.iter().filter_map(|key| value(point, key).map(|value| format!(" {key}={value}")));
        let on = if devices.len() > 1 { format!(" on {}", point.device) } else { String::new() };
        let name = format!("{}{}{on}", point.method, settings.collect::<String>());
        series.entry(Name { name, device: point.device.clone() }).or_default().push(point);
    }
    for points in series.values_mut() {
        points.sort_by(|a, b| a.photons.cmp(&b.photons).then(a.time.value.0.total_cmp(&b.time.value.0)));
    }
    series
}

/// Keys that some point sets, and in which points differ.
fn differing<'a>(points: &'a [Point], along: &dyn Fn(&str) -> bool) -> Vec<&'a str> {
    let along = |key: &str| along(key) || key.starts_with(OF_SCENE);
    let keys: BTreeSet<_> =
        points.iter().flat_map(|point| point.set.keys()).map(String::as_str).filter(|key| !along(key)).collect();
    let differs = |key: &&str| points.iter().map(|point| value(point, key)).collect::<BTreeSet<_>>().len() > 1;
    keys.into_iter().filter(differs).collect()
}

/// What the point sets, or else what is in force; nothing of another method's settings.
fn value<'a>(point: &'a Point, key: &str) -> Option<&'a str> {
    let others = key
        .split_once('.')
        .is_some_and(|(owner, _)| owner != point.method && methods::ALL.iter().any(|method| method.name() == owner));
    let of_point = (!others).then(|| point.settings.get(key)).flatten();
    point.set.get(key).or(of_point).map(String::as_str)
}

/// A panel of a group, `mark` giving the point's place, if it has one. Series without marks are left out.
pub fn panel(group: &Group, axes: [&str; 2], mark: impl Fn(&Point) -> Option<Mark>, with_front: bool) -> Option<Panel> {
    let mut series: Vec<Series> = Vec::new();
    for (name, points) in &group.series {
        let mut marks: Vec<Mark> = points.iter().filter_map(|point| mark(point)).collect();
        if with_front {
            mark_front(&mut marks);
        }
        if !marks.is_empty() {
            series.push(Series { name: name.name.clone(), device: name.device.clone(), marks });
        }
    }
    let devices: BTreeSet<_> = series.iter().map(|series| &series.device).collect();
    let front = match with_front && devices.len() == 1 {
        true => Front::of(series.iter().flat_map(|series| &series.marks)).places(),
        false => Vec::new(),
    };
    (!series.is_empty()).then(|| Panel { title: group.title.clone(), axes: axes.map(str::to_owned), series, front })
}
