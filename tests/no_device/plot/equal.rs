//! Equal time and equal error, against curves whose answers are known.

use nephroid::lab::plot::{Body, EqualRow, Kind, equal_rows};
use serde_json::Value;

use super::{chart_of, curve};

/// Of what a few logarithms and exponentials of float64 lose.
const ROUNDING: f64 = 1e-12;

fn rows(points: &[Value], times: &[f64], errors: &[f64]) -> Vec<EqualRow> {
    let Body::Marks(panels) = chart_of(points, Kind::ErrorTime).body else { panic!("bars") };
    panels.iter().flat_map(|panel| equal_rows(panel, times, errors)).collect()
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < ROUNDING, "{found}, expected {expected}");
}

fn two(factor: f64) -> Vec<Value> {
    [curve("s", "lines", 1.0), curve("s", "maps", factor)].concat()
}

#[test]
fn between_two_points_both_ways_are_the_power_law() {
    for (times, errors, expected) in [(&[20.0][..], &[1e3][..], 0.05), (&[1e3][..], &[0.05][..], 20.0)] {
        let rows: Vec<_> = rows(&two(2.3), times, errors).into_iter().filter(|row| row.value.is_some()).collect();
        assert_eq!(rows.len(), 2, "{rows:?}");
        near(rows[0].value.unwrap().0, expected);
        near(rows[1].value.unwrap().0, 2.3 * expected);
        near(rows[1].ratio.unwrap().0, 2.3);
        assert!(rows[1].verdict.starts_with("2.3× the "), "{}", rows[1].verdict);
    }
}

#[test]
fn outside_of_the_measured_range_nothing_is_claimed() {
    for row in rows(&two(2.3), &[0.99, 101.0], &[3.0, 1e-3]) {
        assert_eq!((row.value, row.ratio, row.verdict.as_str()), (None, None, "not measured"));
    }
    assert!(rows(&two(2.3), &[1.0, 100.0], &[2.3, 0.01]).iter().any(|row| row.value.is_some()));
}

#[test]
fn an_interval_that_holds_one_shows_no_difference() {
    let verdicts: Vec<_> = rows(&two(1.1), &[10.0], &[1e3]).into_iter().map(|row| row.verdict).collect();
    assert_eq!(verdicts[..2], ["least error", "no difference shown from lines"]);
}

#[test]
fn without_intervals_that_is_said() {
    let mut points = two(2.3);
    for point in &mut points {
        point["time"] = serde_json::json!({ "median": point["time"]["median"] });
    }
    let rows = rows(&points, &[10.0], &[1e3]);
    assert!(rows[1].ratio_interval.is_none() && rows[1].verdict.ends_with("without an interval"), "{rows:?}");
}

#[test]
fn values_are_chosen_inside_the_common_range() {
    let rows = rows(&two(2.0), &[], &[]);
    assert!(rows.len() >= 4 && rows.iter().all(|row| row.value.is_some()), "{rows:?}");
}

#[test]
fn devices_are_never_compared() {
    let mut other = curve("s", "maps", 5.0);
    other.iter_mut().for_each(|point| point["device"] = serde_json::json!({ "name": "card", "kind": "discrete" }));
    let all = [curve("s", "maps", 1.0), other].concat();
    assert!(rows(&all, &[10.0], &[]).iter().all(|row| row.verdict == "alone" || row.verdict == "not measured"));
    let Body::Marks(panels) = chart_of(&all, Kind::ErrorTime).body else { panic!("bars") };
    assert!(panels[0].series.len() == 2 && panels[0].front.is_empty());
}
