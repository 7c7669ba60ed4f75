//! On a made-up machine: what is called, how seldom it is called wrongly, and what is warned of.

use std::{cell::RefCell, ops::ControlFlow, time::Duration};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::*;

const TICK_MS: f64 = 1e-6;
/// More than a few calls take on a busy machine.
const LATER: Duration = Duration::from_millis(500);

/// A frame of two passes, in whole ticks of a clock of 1 ns.
fn frame(ms: f64) -> FrameTimes {
    let ticks = (ms / TICK_MS).round();
    let first = (0.3 * ticks).round();
    let passes = vec![first * TICK_MS, (ticks - first - 1.0) * TICK_MS];
    FrameTimes { passes, span_ms: ticks * TICK_MS, wall_ms: ms, record_ms: 0.0 }
}

/// Times variants whose frame at beat k takes what `ms` says.
fn time(rounds: u32, variants: usize, seed: u64, ms: impl Fn(usize, usize) -> f64) -> (Timed, Vec<usize>) {
    let called = RefCell::new(Vec::new());
    let frame_of = |variant: usize| {
        let (called, ms) = (&called, &ms);
        let render = move || {
            called.borrow_mut().push(variant);
            Ok(frame(ms(variant, called.borrow().len())))
        };
        Variant { name: format!("v{variant}"), stages: vec!["a".into(), "b".into()], frame: Box::new(render) }
    };
    let mut list: Vec<_> = (0..variants).map(frame_of).collect();
    let timed = Rounds { rounds, most_warmup: 20, least_warmup: Duration::ZERO, seed, until: None }
        .run(&mut list, &mut |_| ControlFlow::Continue(()))
        .unwrap();
    drop(list);
    (timed, called.into_inner())
}

/// A machine of 3 % noise, slow spikes, and a level that wanders by 30 % over the beats.
fn machine(seed: u64, slower: f64) -> impl Fn(usize, usize) -> f64 {
    let random = RefCell::new(Pcg64Mcg::seed_from_u64(seed));
    move |variant, beat| {
        let mut random = random.borrow_mut();
        let noise = 0.03 * (random.random::<f64>() + random.random::<f64>() - 1.0);
        let spike = if random.random::<f64>() < 0.05 { 1.5 } else { 1.0 };
        let level = 1.0 + 0.3 * (0.05 * beat as f64).sin();
        5.0 * level * (1.0 + noise) * spike * if variant == 1 { slower } else { 1.0 }
    }
}

#[test]
fn rounds_hold_each_variant_once_in_changing_order() {
    let (timed, called) = time(12, 3, 5, |_, _| 2.0);
    let warmup: usize = timed.series.iter().map(|s| s.warmup as usize).sum();
    assert_eq!(warmup, 3 * 2 * WINDOW, "steady from the start");
    let rounds: Vec<&[usize]> = called[warmup..].chunks(3).collect();
    assert_eq!(rounds.len(), 12);
    for round in &rounds {
        let mut sorted = round.to_vec();
        sorted.sort_unstable();
        assert_eq!(sorted, [0, 1, 2]);
    }
    assert!(rounds.windows(2).any(|pair| pair[0] != pair[1]), "always one order");
    assert_eq!(time(12, 3, 5, |_, _| 2.0).1, called, "one seed, one order");
    assert!(timed.series.iter().all(|s| s.frames.len() == 12 && s.settled));
}

#[test]
fn alike_is_seldom_called_different_and_a_tenth_is_found() {
    let called = |slower: f64| {
        let verdict = |seed| time(15, 2, seed, machine(seed, slower)).0.span_ratio(0, 1).verdict;
        (0..200).map(verdict).filter(|v| *v == Verdict::Slower).count()
    };
    // Half of one per cent of two hundred on either side, and chance.
    assert!(called(1.0) <= 5, "false alarms: {}", called(1.0));
    assert!(called(1.1) >= 190, "found: {}", called(1.1));
}

#[test]
fn a_warm_up_is_not_timed() {
    let (timed, _) = time(10, 1, 0, |_, beat| 2.0 + 8.0 * (-0.4 * beat as f64).exp());
    let series = &timed.series[0];
    assert!(series.settled && series.warmup > 8, "{}", series.warmup);
    assert!(series.span().median < 2.2);
    let (wild, _) = time(10, 1, 0, |_, beat| if beat / 3 % 2 == 0 { 1.0 } else { 3.0 });
    assert!(!wild.series[0].settled);
    assert!(wild.warnings(TICK_MS).iter().any(|w| w.contains("did not settle")));
}

#[test]
fn what_disturbs_is_said() {
    let said = |timed: &Timed, what: &str| timed.warnings(TICK_MS).iter().any(|warning| warning.contains(what));
    let quiet = |mut timed: Timed| {
        timed.others = Some(0.0);
        timed
    };
    let still = quiet(time(20, 1, 0, |_, _| 2.0).0);
    assert_eq!(still.warnings(TICK_MS), Vec::<String>::new());
    assert!(said(&quiet(time(20, 1, 0, |_, beat| 2.0 * 1.02f64.powi(beat as i32)).0), "drifted by +"));
    let step = quiet(time(20, 1, 0, |_, beat| if beat < 16 { 2.0 } else { 2.5 }).0);
    assert!(said(&step, "jumped by +25 % at round"), "{:?}", step.warnings(TICK_MS));
    assert!(said(&quiet(time(20, 1, 0, |_, beat| 5e-5 + 1e-6 * (beat % 3) as f64).0), "ticks of the device's clock"));
    // A clock that ticks 32 times as coarse as it says: of a thousand ns it has seen 31.
    let mut coarse = quiet(time(20, 1, 0, |_, _| 1e-3).0);
    for frame in &mut coarse.series[0].frames {
        *frame =
            FrameTimes { passes: vec![320.0 * TICK_MS, 672.0 * TICK_MS], span_ms: 992.0 * TICK_MS, ..frame.clone() };
    }
    assert!(said(&coarse, "is 31 ticks of the device's clock"), "{:?}", coarse.warnings(TICK_MS));
    assert!(said(&quiet(time(5, 1, 0, |_, _| 2.0).0), "too few"));
    assert!(said(&Timed { others: Some(0.4), ..still }, "40 % of this machine's cores"));
}

#[test]
fn what_was_not_measured_shows_nothing() {
    let (timed, _) = time(12, 2, 0, |variant, _| if variant == 1 { f64::NAN } else { 2.0 });
    assert_eq!(timed.span_ratio(0, 1).verdict, Verdict::None);
    let (none, _) = time(0, 2, 0, |_, _| 2.0);
    assert_eq!(none.span_ratio(0, 1).verdict, Verdict::None);
    assert_eq!(none.series[0].span().median, f64::INFINITY);
    assert!(none.series[0].stage("no such").is_none());
}

/// Time that is up before anything began leaves the first round whole; up in the middle of a later one, those before it.
#[test]
fn rounds_end_when_the_time_is_up() {
    for (whole, from) in [(1, 0), (2, 5)] {
        let drawn = std::cell::Cell::new(0);
        let until = std::time::Instant::now() + if from == 0 { Duration::ZERO } else { LATER };
        let variant = |name: &str| {
            let render = || {
                drawn.set(drawn.get() + 1);
                if drawn.get() == from {
                    std::thread::sleep(LATER);
                }
                Ok(frame(1.0))
            };
            Variant { name: name.into(), stages: vec![], frame: Box::new(render) as RenderFrame<'_> }
        };
        let mut two = [variant("a"), variant("b")];
        let rounds = Rounds { rounds: 9, most_warmup: 0, least_warmup: Duration::ZERO, seed: 0, until: Some(until) };
        let timed = rounds.run(&mut two, &mut |_| ControlFlow::Continue(())).unwrap();
        drop(two);
        assert_eq!(timed.rounds(), whole);
        assert!(timed.series.iter().all(|series| series.frames.len() == whole as usize), "each as often");
        assert_eq!(drawn.get(), from.max(2));
    }
}

#[test]
fn whoever_watches_can_stop_it() {
    let render = || Ok(frame(1.0));
    let mut one = [Variant { name: "a".into(), stages: vec![], frame: Box::new(render) }];
    let stopped = Rounds { rounds: 3, most_warmup: 3, least_warmup: Duration::ZERO, seed: 0, until: None }.run(
        &mut one,
        &mut |beat| {
            if matches!(beat, Beat::Timed { round: 1, .. }) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        },
    );
    assert!(matches!(stopped, Err(LabError::Interrupted)));
}

#[test]
fn a_device_that_sleeps_is_woken_however_steady_it_is() {
    let least_warmup = Duration::from_millis(30);
    let begun = Instant::now();
    let mut two = ["a", "b"].map(|name| Variant {
        name: name.into(),
        stages: vec!["a".into(), "b".into()],
        frame: Box::new(move || Ok(frame(if begun.elapsed() < least_warmup { 20.0 } else { 4.0 }))),
    });
    let rounds = Rounds { rounds: 3, most_warmup: 8, least_warmup, seed: 0, until: None };
    let timed = rounds.run(&mut two, &mut |_| ControlFlow::Continue(())).unwrap();
    assert!(timed.series.iter().all(|series| series.span().samples.iter().all(|ms| *ms < 5.0)));
}
