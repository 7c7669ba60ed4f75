//! `nephroid tracers`: a table, JSON, pictures; a tracer that refuses is a row that says why.

use std::fs;

use super::{column, names, nephroid, place};

const SMALL: &str = "--set light.side=32 --repeat 1";

#[test]
fn every_tracer_is_a_row_and_a_picture() {
    let (_folder, out) = place();
    let ran = nephroid(&format!("tracers glass-sphere {SMALL} --format json --out {}", out.display())).ok();
    let report = ran.json();
    assert_eq!((&report["schema"], &report["class"]), (&"nephroid.tracers/1".into(), &"transmit-2".into()));
    assert_eq!(column(&report["tracers"], "tracer"), ["bvh", "fixed-point", "march", "wyman2005"]);
    let of = |tracer: &str| report["tracers"].as_array().unwrap().iter().find(|r| r["tracer"] == tracer).unwrap();
    assert_eq!(of("bvh")["landing_m"]["worst"], 0.0);
    assert_eq!(of("march")["false_loss"], 0.0);
    let lost = of("wyman2005")["false_loss"].as_f64().unwrap();
    let total = of("wyman2005")["lost_to"]["total_internal_reflection"].as_f64().unwrap();
    assert!(lost > 0.1 && lost == total, "{lost} lost, {total} of it to total reflection");
    assert!(of("wyman2005")["stages_ms"]["light/back"].as_f64().unwrap() > 0.0);
    assert_eq!(names(&out), ["bvh.png", "fixed-point.png", "march.png", "tracers.json", "wyman2005.png"]);
    let written: serde_json::Value = serde_json::from_slice(&fs::read(out.join("tracers.json")).unwrap()).unwrap();
    assert_eq!(written["tracers"], report["tracers"]);
    for format in ["table", "csv", "md"] {
        let ran = nephroid(&format!("tracers flat-water {SMALL} --format {format}")).ok();
        assert!(ran.out.contains("wyman2005"), "{}", ran.out);
        if format == "csv" {
            assert_eq!(ran.rows().len(), 5, "{}", ran.out);
        } else {
            assert!(ran.out.contains("software device"), "{}", ran.out);
        }
    }
}

#[test]
fn a_tracer_that_refuses_says_why() {
    let inside = "--set scene.lights.sun={point={position=[0,0.2,0],intensity=1}}";
    let ran = nephroid(&format!("tracers glass-sphere {SMALL} {inside}")).ok();
    let refused =
        ran.out.lines().filter(|line| line.contains("inside a body") && line.contains("use light.tracer=bvh"));
    assert_eq!(refused.count(), 3, "{}", ran.out);
}

#[test]
fn a_class_with_several_photons_a_sample_is_not_compared() {
    let ran = nephroid("tracers ring --set light.paths=all:4 --set light.side=16");
    assert_eq!(ran.code, Some(2), "{}", ran.err);
    assert!(ran.err.contains("class all:4") && ran.err.contains("set light.paths"), "{}", ran.err);
}

#[test]
fn the_tracer_is_not_for_the_user_to_set() {
    let ran = nephroid("tracers glass-sphere --set light.tracer=march");
    assert_eq!(ran.code, Some(2), "{}", ran.err);
    assert!(ran.err.contains("every tracer is run"), "{}", ran.err);
}
