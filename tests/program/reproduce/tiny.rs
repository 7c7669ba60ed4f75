//! A table run at a tiny size: what its report must hold.

use std::ops::ControlFlow;

use nephroid::{
    gpu::Gpu,
    lab::{self, Extent, Format, LabError, Report, papers},
    store::Store,
};
use serde_json::Value;

use crate::common::{assert_quiet, gpu};

/// One N of the paper, few pixels, a truth of a second.
fn extent() -> Extent {
    Extent { quick: true, most_side: 256, rounds: 8, seconds: 60.0, truth_seconds: 1.0, size: [32, 32] }
}

fn run(gpu: &Gpu, id: &str, extent: &Extent) -> Value {
    let published = papers::find(id).unwrap();
    let go = &mut |_: &str| ControlFlow::Continue(());
    let report = lab::reproduce(gpu, &Store::open(), &published, extent, go).unwrap_or_else(|e| panic!("{id}: {e}"));
    serde_json::from_slice(&report.write(Format::Json).unwrap()).unwrap()
}

#[test]
fn what_runs_is_measured_with_all_that_it_depends_on() {
    let gpu = gpu();
    for (id, columns) in [("maps.table2", 3), ("maps.table3", 10), ("maps.table4", 6)] {
        let report = run(&gpu, id, &extent());
        assert_eq!(report["schema"], "nephroid.reproduce/1");
        let rows = report["rows"].as_array().unwrap();
        assert_eq!(rows.len(), papers::find(id).unwrap().figures.len());
        let keys = [
            "row",
            "column",
            "unit",
            "published",
            "measured",
            "ratio",
            "relmse",
            "relmse_fitted",
            "scale",
            "kept",
            "points",
            "missing",
        ];
        for row in rows {
            let row = row.as_object().unwrap();
            assert_eq!(row.keys().collect::<Vec<_>>(), keys);
            assert_eq!(row["measured"].is_null(), row["missing"].is_string(), "{row:?}");
            assert_eq!(row["measured"].is_null(), row["relmse"].is_null(), "{row:?}");
        }
        let measured: Vec<&Value> = rows.iter().filter(|row| !row["measured"].is_null()).collect();
        assert_eq!(measured.len(), columns, "{id}: one N alone");
        for row in measured {
            let of = |key: &str| row["measured"][key].as_f64().unwrap();
            assert_eq!(row["row"], 256);
            assert!(of("value") > 0.0 && of("low") <= of("value") && of("value") <= of("high"), "{row}");
            assert!(row["relmse"]["value"].as_f64().unwrap() > 0.0);
        }
        for known in ["scene", "device", "size", "repeats", "reference"] {
            assert!(!report[known].is_null(), "{id}: {known}");
        }
        assert_eq!(report["settings"]["light.tracer"], "wyman2005");
        assert_eq!(report["settings"]["light.view"], "shared");
        let shares = report["photons"].as_array().unwrap();
        assert!(shares.iter().all(|p| p["valid_photons"].as_f64().is_some_and(|share| share > 0.1 && share < 1.0)));
        assert_eq!(report["shape"].as_array().unwrap().len(), columns - 1, "each column beside the first");
    }
    assert_quiet(&gpu);
}

/// The water paper's pictures: no photons, and both errors of each.
#[test]
fn what_is_right_up_to_a_scale_is_told_raw_and_fitted() {
    let gpu = gpu();
    let report = run(&gpu, "waves.figure9", &Extent { most_side: 128, ..extent() });
    let rows = report["rows"].as_array().unwrap();
    let measured: Vec<&Value> = rows.iter().filter(|row| !row["measured"].is_null()).collect();
    let names: Vec<_> = measured.iter().map(|row| row["row"].as_str().unwrap()).collect();
    assert_eq!(names, ["per vertex, 32", "per vertex, 128", "per pixel", "texture, 128"]);
    for row in measured {
        let [raw, fitted] = ["relmse", "relmse_fitted"].map(|key| row[key]["value"].as_f64().unwrap());
        assert!(row["measured"]["value"].as_f64() > Some(0.0) && row["scale"].as_f64() > Some(0.0), "{row}");
        assert!(0.0 < fitted && fitted <= raw, "{row}");
    }
    assert!(report["photons"].as_array().unwrap().iter().all(|p| p["valid_photons"].is_null()));
    assert_quiet(&gpu);
}

/// The water paper's prose: constants are the paper's, exponents those of what is counted, shares and errors within bounds.
#[test]
fn what_the_water_papers_prose_claims_is_measured() {
    let gpu = gpu();
    let report = run(&gpu, "waves.text", &Extent { rounds: 2, size: [16, 16], ..extent() });
    let rows = report["rows"].as_array().unwrap();
    let missing: Vec<&Value> = rows.iter().filter(|row| row["measured"].is_null()).map(|row| &row["column"]).collect();
    assert_eq!(missing, ["index_of_refraction"], "what the scene says is no measurement");
    let all = |column: &str| {
        let found: Vec<f64> = rows
            .iter()
            .filter(|row| row["column"] == column)
            .map(|row| row["measured"]["value"].as_f64().unwrap())
            .collect();
        assert!(!found.is_empty(), "{column}");
        found
    };
    for constant in
        ["octaves", "wave_size", "factor", "speed", "vertex_size", "texture_work_exponent", "pixel_work_exponent"]
    {
        let row = rows.iter().find(|row| row["column"] == constant).unwrap();
        assert_eq!(row["measured"]["value"].as_f64(), row["published"].as_f64(), "{constant}");
    }
    // e^-0.24 is left of a metre; depths are within some centimetres of 0.8 m.
    assert!(all("absorbed_per_metre").iter().all(|share| (share - (1.0 - f64::exp(-0.24))).abs() < 0.01));
    // A thousandth of what is claimed: the disc covers 1e-5 of the hemisphere above water.
    assert!(all("useful_rays_least")[0] < 1e-3);
    let vertical = all("useful_vertical_rays")[0];
    assert!(vertical > 0.0 && vertical < 0.1, "{vertical}");
    assert_eq!(all("shortcut_relmse").len(), 3);
    for [raw, fitted] in all("shortcut_relmse").into_iter().zip(all("shortcut_relmse_fitted")).map(|(a, b)| [a, b]) {
        assert!(0.0 < fitted && fitted <= raw, "{fitted} {raw}");
    }
    assert!(all("shortcut_contrast_deeper")[0] > 1.0, "deeper is sharper");
    assert!(all("contrast_at_60_degrees")[0] > 0.0 && all("texture_relmse")[0] < 0.1);
    assert_quiet(&gpu);
}

#[test]
fn what_the_time_does_not_allow_is_left_out_and_said() {
    let gpu = gpu();
    let report = run(&gpu, "maps.table2", &Extent { most_side: 4096, seconds: 1e-3, ..extent() });
    let rows = report["rows"].as_array().unwrap();
    let late = rows.iter().filter(|row| row["missing"].as_str().is_some_and(|why| why.contains("--max-seconds")));
    assert_eq!(late.count(), 12, "all but the smallest N");
}

#[test]
fn whoever_watches_can_stop_it() {
    let stop = &mut |_: &str| ControlFlow::Break(());
    let stopped = lab::reproduce(&gpu(), &Store::open(), &papers::find("maps.table2").unwrap(), &extent(), stop);
    assert!(matches!(stopped, Err(LabError::Interrupted)));
}
