//! The data drawn, and where labels stand.

use nephroid::lab::plot::{Body, Canvas, Kind, PlotFiles, draw};
use serde_json::{Value, json};

use super::{chart_of, curve, point, results};

/// Of boxes that touch, after sums in float64; px.
const TOUCHING: f64 = 1e-6;

#[track_caller]
fn assert_apart(canvas: &Canvas, case: &str) {
    let texts = canvas.texts();
    for (at, a) in texts.iter().enumerate() {
        let [width, height] = canvas.size;
        let inside =
            a.area.x >= 0.0 && a.area.y >= 0.0 && a.area.x + a.area.w <= width && a.area.y + a.area.h <= height;
        assert!(inside, "{case}: {a:?} leaves {width} × {height}");
        for b in &texts[at + 1..] {
            let mut smaller = a.area;
            (smaller.w, smaller.h) = (smaller.w - TOUCHING, smaller.h - TOUCHING);
            assert!(!smaller.overlaps(&b.area), "{case}: {a:?} on {b:?}");
        }
    }
}

/// Points that crowd, by a fixed sequence of fractions.
fn crowd(count: u64, methods: u64) -> Vec<Value> {
    let fraction = |at: u64, step: f64| (at as f64 * step).fract();
    let time = |at| 10f64.powf(4.0 * fraction(at, 0.618_033_988_749_895) - 1.0);
    let error = |at| 10f64.powf(-5.0 * fraction(at, 0.414_213_562_373_095));
    (0..count).map(|at| point("s", &format!("m{}", at % methods), 16 << (at % 8), time(at), json!(error(at)))).collect()
}

fn hard() -> Vec<Value> {
    let mut points = curve("s", "maps", 1.0);
    let values =
        [(5.0, json!(0.0)), (6.0, json!("infinity")), (7.0, json!("nan")), (0.0, json!(0.3)), (0.0, json!("nan"))];
    points.extend(values.into_iter().map(|(time, error)| point("s", "lines", 32, time, error)));
    points
}

#[test]
fn no_two_texts_overlap_and_none_leaves_the_page() {
    let long = "a-scene-of-a-name-".repeat(9);
    let huge = (0..9).map(|at| point("s", "maps", 2 << at, 10f64.powi(2 * at - 10), json!(10f64.powi(6 - 2 * at))));
    let cases = [
        ("curves", [curve("s", "lines", 1.0), curve("s", "maps", 2.0)].concat()),
        ("scenes", ["a", "b", &long].map(|scene| curve(scene, &"method".repeat(30), 1.0)).concat()),
        ("one", vec![point("s", "maps", 64, 1.0, json!(0.5))]),
        ("equal", (0..9).map(|at| point("s", &format!("m{at}"), 64, 1.0, json!(0.5))).collect()),
        ("close", (0..9).map(|at| point("s", "maps", 64, 1.0 + 1e-9 * f64::from(at), json!(0.5))).collect()),
        ("hard", hard()),
        ("huge", huge.collect()),
        ("crowd", crowd(300, 100)),
    ];
    for (case, points) in cases {
        for kind in [Kind::ErrorTime, Kind::Cost, Kind::Scale, Kind::Stages] {
            assert_apart(&draw(&chart_of(&points, kind)), &format!("{case}, {kind}"));
        }
    }
}

#[test]
fn labels_stand_where_they_stood() {
    let canvas = draw(&chart_of(&[curve("s", "maps", 1.0), curve("s", "lines", 2.0)].concat(), Kind::ErrorTime));
    let labels = canvas.texts().iter().filter(|written| written.text.starts_with("N="));
    let labels: Vec<_> = labels.map(|w| format!("{} {:.0} {:.0}", w.text, w.area.x, w.area.y)).collect();
    assert_eq!(labels, LABELS);
}

/// px of their upper left corners, whole ones; looked at.
const LABELS: [&str; 6] =
    ["N=64² 152 56", "N=128² 516 208", "N=256² 881 360", "N=64² 152 102", "N=128² 516 254", "N=256² 881 406"];

#[test]
fn the_csv_holds_every_point_drawn() {
    let points = [curve("s", "maps", 1.0), vec![point("s", "maps", 32, 20.0, json!("infinity"))]].concat();
    let results = results(&points);
    let chart = chart_of(&points, Kind::ErrorTime);
    let csv = String::from_utf8(PlotFiles::new(&chart, &results).unwrap().csv).unwrap();
    let cut: Vec<_> = csv.lines().map(|line| line.rsplit_once(',').unwrap().0).collect();
    assert_eq!(
        cut,
        [
            "scene,series,device,time_ms,time_low_ms,time_high_ms,error,error_low,error_high,photons,front",
            "\"s, camera region, 64 × 64\",maps,llvmpipe,20,18,22,inf,,,1024,no",
            "\"s, camera region, 64 × 64\",maps,llvmpipe,1,0.9,1.1,1,0.8,1.2,4096,yes",
            "\"s, camera region, 64 × 64\",maps,llvmpipe,10,9,11,0.1,0.08000000000000002,0.12,16384,yes",
            "\"s, camera region, 64 × 64\",maps,llvmpipe,100,90,110.00000000000001,0.01,0.008,0.012,65536,yes",
        ]
    );
}

#[test]
fn titles_and_names_state_what_differs_and_no_setting_of_another_method() {
    let depth = "scene.objects.floor.quad.center";
    let of = |method: &str, key: &str, value: &str, at: &str| {
        let mut point = point("s", method, 64, 1.0, json!(1.0));
        let set = [(depth, at), ("scene.lights.sun.power", "3"), (key, value)];
        point["set"] = set.into_iter().collect();
        point["settings"] = json!({ "maps.gather": "own", "waves.variant": "pixel", key: value });
        point["key"] = json!(format!("{method} {value} {at}"));
        point
    };
    let deep = |at| [of("maps", "maps.gather", "cells", at), of("waves", "waves.variant", "inverse", at)];
    let mut points = [deep("-1"), deep("-2")].concat();
    points.push(of("waves", "waves.variant", "vertex", "-2"));
    let Body::Marks(panels) = chart_of(&points, Kind::ErrorTime).body else { panic!("bars") };
    let titles: Vec<_> = panels.iter().map(|panel| panel.title.as_str()).collect();
    let shared = ", camera region, 64 × 64";
    assert_eq!(titles, ["-1", "-2"].map(|at| format!("s, objects.floor.quad.center={at}{shared}")));
    let names = |at: usize| panels[at].series.iter().map(|series| series.name.as_str()).collect::<Vec<_>>();
    assert_eq!(names(0), ["maps maps.gather=cells", "waves waves.variant=inverse"]);
    assert_eq!(names(1), ["maps maps.gather=cells", "waves waves.variant=inverse", "waves waves.variant=vertex"]);
}

#[test]
fn what_has_no_place_is_drawn_at_the_edge_and_said() {
    let chart = chart_of(&hard(), Kind::ErrorTime);
    let said = chart.caption.iter().find(|line| line.starts_with("Hollow")).expect("a sentence on the edge");
    assert!(said.contains("infinite: 1") && said.contains("not a number: 2") && said.contains("zero: 3"), "{said}");
    let Body::Marks(panels) = &chart.body else { panic!("bars") };
    assert_eq!(panels[0].series.iter().map(|series| series.marks.len()).sum::<usize>(), hard().len());
    let texts: Vec<_> = draw(&chart).texts().iter().map(|written| written.text.clone()).collect();
    for label in ["∞", "NaN", "0"] {
        assert!(texts.iter().any(|text| text == label), "{label} in {texts:?}");
    }
}

#[test]
fn software_devices_are_named_as_such() {
    for kind in [Kind::ErrorTime, Kind::Cost, Kind::Scale, Kind::Stages] {
        let caption = chart_of(&curve("s", "maps", 1.0), kind).caption;
        assert!(caption.iter().any(|line| line.starts_with("Software device: llvmpipe")), "{caption:?}");
    }
}

#[test]
fn ten_thousand_points_are_drawn() {
    let points = crowd(10_000, 3);
    let svg = draw(&chart_of(&points, Kind::ErrorTime)).svg("", "");
    let markers = ["<circle", "<polygon"].map(|tag| svg.matches(tag).count()).into_iter().sum::<usize>();
    assert_eq!(markers, 10_000 + 3, "a marker a point, and one a line of the key");
}
