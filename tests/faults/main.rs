//! Does it bite? Faults planted in the shipped GLSL, each caught by the check named for it; the table says by how much.
//!
//! `cargo test --test faults the_table -- --nocapture` prints it. Each fault is one passage replaced (`list`); each
//! check holds pictures or accounts against closed forms, the float64 truth or the energy (`checks`).

mod checks;
#[path = "../common/mod.rs"]
mod common;
mod list;
mod patch;

use common::gpu;
use list::FAULTS;
use nephroid::{
    gpu::Sources,
    lab::{Cell, Table},
};
use patch::Fault;
use rayon::prelude::*;

/// Times the bound that a fault has to reach: less, and another device's rounding could hide it.
const CLEARLY: f64 = 3.0;

const COLUMNS: [&str; 6] = ["fault", "check", "sound", "faulty", "bound", "times the bound"];

/// A fault's row: the figures of its check on sound shaders and on faulty ones.
fn row(fault: &Fault, sound: f64, faulty: f64) -> Vec<Cell> {
    let figure = |value: f64| Cell::text(format!("{value:.1e}"));
    let times = Cell::Real(faulty / fault.check.bound, 0);
    let [name, check] = [fault.name, fault.check.name].map(Cell::text);
    vec![name, check, figure(sound), figure(faulty), figure(fault.check.bound), times]
}

/// What does not hold of a fault.
fn complaint(fault: &Fault, sound: f64, faulty: f64) -> Option<String> {
    let (name, check, bound) = (fault.name, fault.check.name, fault.check.bound);
    if sound > bound {
        return Some(format!("{check}: {sound} on sound shaders, at most {bound} is allowed"));
    }
    (faulty < CLEARLY * bound).then(|| format!("{name} is not caught by {check}: {faulty} of {bound}"))
}

/// Faults of one check, whose figure on sound shaders they share: rows, and what is wrong.
fn judge(faults: &[&Fault]) -> (Vec<Vec<Cell>>, Vec<String>) {
    let (gpu, check) = (gpu(), faults[0].check);
    let sound = check.judge(&gpu, &Sources::default());
    let (mut rows, mut wrong) = (Vec::new(), Vec::new());
    for fault in faults {
        match fault.plant() {
            Ok(sources) => {
                let faulty = check.judge(&gpu, &sources);
                rows.push(row(fault, sound, faulty));
                wrong.extend(complaint(fault, sound, faulty));
            }
            Err(stale) => wrong.push(stale),
        }
    }
    (rows, wrong)
}

#[test]
fn the_table() {
    let mut of_check: Vec<Vec<&Fault>> = Vec::new();
    for fault in FAULTS {
        match of_check.iter_mut().find(|faults| std::ptr::eq(faults[0].check, fault.check)) {
            Some(faults) => faults.push(fault),
            None => of_check.push(vec![fault]),
        }
    }
    let judged: Vec<_> = of_check.par_iter().map(|faults| judge(faults)).collect();
    let (rows, wrong): (Vec<_>, Vec<_>) = judged.into_iter().unzip();
    let (rows, wrong) = (rows.concat(), wrong.concat());
    println!("\n{}\n", Table { name: "faults", columns: COLUMNS.to_vec(), rows }.to_text());
    assert!(wrong.is_empty(), "\n{}\n", wrong.join("\n"));
}

#[test]
fn a_patch_that_no_longer_applies_fails_by_name() {
    let stale = |old: &'static str, file: &'static str| {
        let check = &checks::caustic::SPHERE;
        let fault = Fault { name: "a stale fault", file, old, new: "", check };
        fault.plant().err().expect("it does not apply")
    };
    let gone = stale("float eta = n_from * n_to;", "shared/interface.glsl");
    assert!(gone.contains("a stale fault") && gone.contains("0 times"), "{gone}");
    let twice = stale("bent++;", "shared/interface.glsl");
    assert!(twice.contains("a stale fault") && twice.contains("times, not once"), "{twice}");
    let lost = stale("", "shared/nothing.glsl");
    assert!(lost.contains("a stale fault") && lost.contains("no glsl/shared/nothing.glsl"), "{lost}");
}

#[test]
fn every_patch_applies() {
    let stale: Vec<_> = FAULTS.iter().filter_map(|fault| fault.plant().err()).collect();
    assert!(stale.is_empty(), "\n{}\n", stale.join("\n"));
}

#[test]
fn what_slips_through_is_named() {
    let (fault, bound) = (&FAULTS[0], FAULTS[0].check.bound);
    assert_eq!(complaint(fault, 0.5 * bound, 10.0 * bound), None);
    assert_eq!(complaint(fault, 0.5 * bound, f64::INFINITY), None, "no number is worse than any");
    let missed = complaint(fault, 0.5 * bound, 2.0 * bound).expect("too near to the bound");
    assert!(missed.contains(fault.name) && missed.contains(fault.check.name), "{missed}");
    let unsound = complaint(fault, f64::INFINITY, f64::INFINITY).expect("sound shaders fail");
    assert!(unsound.contains(fault.check.name) && unsound.contains("sound"), "{unsound}");
}
