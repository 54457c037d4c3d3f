//! Holds found in records whose truth is known: fast ramps, slow ramps, coarse encoders, servos, cyclic tests.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

mod behind_spring;
mod delayed;
mod driven;
mod rare;

use palpate::analysis::{AnalysisOptions, Finding, analyze};
use palpate::record::{Correction, LabelledSegment, Record};
use palpate::segment::{After, FitStartRule, HoldMode, Phase, SegmentError, SegmentOptions, Segmentation, find_phases};
use palpate::test_problems::Rng;

/// A step: to mm, at mm/s, hold s.
type Step = (f64, f64, f64);

/// The displacement in mm at a time, and the holds with their ends and what came before.
fn path(steps: &[Step]) -> (impl Fn(f64) -> f64, Vec<(f64, f64, After)>) {
    let (mut time, mut at) = (0.0, 0.0);
    let (mut knots, mut holds) = (vec![(0.0, 0.0)], Vec::new());
    for &(to, rate, hold) in steps {
        time += (to - at).abs() / rate;
        knots.push((time, to));
        holds.push((time, time + hold, if to > at { After::Loading } else { After::Unloading }));
        time += hold;
        knots.push((time, to));
        at = to;
    }
    let displacement = move |t: f64| {
        let index = knots.partition_point(|knot| knot.0 < t).clamp(1, knots.len() - 1);
        let ((t0, d0), (t1, d1)) = (knots[index - 1], knots[index]);
        d0 + (d1 - d0) * ((t - t0) / (t1 - t0)).clamp(0.0, 1.0)
    };
    (displacement, holds)
}

/// A record of a displacement in mm, with noise and quantum in µm.
fn record(shape: impl Fn(f64) -> f64, duration: f64, rate: f64, noise: f64, quantum: f64) -> Record {
    let mut numbers = Rng::new(7);
    let count = (duration * rate + 1e-6) as usize + 1;
    let time: Vec<f64> = (0..count).map(|i| i as f64 / rate).collect();
    let rounded = |d: f64| if quantum > 0.0 { (d / quantum).round() * quantum } else { d };
    let displacement: Vec<f64> =
        time.iter().map(|t| 1e-6 * rounded(1e3 * shape(*t) + noise * numbers.normal())).collect();
    let force = displacement.iter().map(|d| 1e3 * d).collect();
    Record::new(time, Some(displacement), force).unwrap()
}

fn phases(record: &Record) -> Result<Segmentation, SegmentError> {
    find_phases(record, &SegmentOptions::default())
}

/// Every hold is found, within so many samples, and none besides.
fn check(steps: &[Step], rate: f64, noise: f64, quantum: f64, samples: f64) {
    let (shape, truth) = path(steps);
    let record = record(shape, truth[truth.len() - 1].1, rate, noise, quantum);
    let found = phases(&record).unwrap();
    assert_eq!(found.holds().count(), truth.len(), "{steps:?}: {found:?}");
    for (hold, (start, end, after)) in found.holds().zip(truth) {
        let off = [record.time()[hold.start] - start, record.time()[hold.end - 1] - end];
        assert!(off.iter().all(|off| off.abs() <= samples / rate), "{steps:?}: {hold:?} off by {off:?} s");
        assert_eq!(hold.after, Some(after), "{steps:?}: {hold:?}");
    }
}

#[test]
fn small_steps_faster_than_the_samples() {
    for step in [0.1, 0.2] {
        check(&[(20.0, 500.0 / 60.0, 10.0), (20.0 + step, 500.0 / 60.0, 10.0)], 50.0, 1.0, 0.0, 1.0);
    }
    // No sample lies in a ramp.
    check(&[(5.0, 1000.0, 5.0), (10.0, 1000.0, 5.0), (4.0, 1000.0, 5.0)], 50.0, 0.0, 0.0, 1.0);
}

#[test]
fn slow_ramps_with_a_coarse_encoder() {
    let steps = [(5.0, 0.36, 10.0), (10.0, 2.4, 5.0), (12.0, 0.5, 10.0), (8.0, 1.0, 10.0), (3.0, 0.4, 20.0)];
    check(&steps, 200.0, 0.0, 10.0, 25.0);
}

#[test]
fn short_holds_after_long_ramps() {
    check(&[(25.0, 5.0 / 60.0, 10.0), (0.0, 5.0 / 60.0, 10.0)], 10.0, 0.0, 0.0, 1.0);
    check(&[(10.0, 0.33, 2.0), (20.0, 0.25, 2.0)], 50.0, 0.0, 0.0, 1.0);
}

#[test]
fn a_servo_that_overshoots() {
    for (share, lag) in [(0.002, 0.1), (0.005, 0.2), (0.01, 0.3)] {
        let steps = [(10.0, 10.0, 10.0), (20.0, 10.0, 10.0), (5.0, 10.0, 10.0)];
        let (shape, truth) = path(&steps);
        let kicks: Vec<(f64, f64)> =
            [10.0, 10.0, -15.0].iter().zip(&truth).map(|(a, hold)| (hold.0, share * a)).collect();
        let servo = |t: f64| {
            let kick = |(at, high): &(f64, f64)| {
                let z = ((t - at) / lag).max(0.0);
                high * z * (1.0 - z).exp()
            };
            shape(t) + kicks.iter().map(kick).sum::<f64>()
        };
        let found = phases(&record(servo, truth[2].1, 100.0, 0.3, 0.0)).unwrap();
        let after: Vec<_> = found.holds().map(|hold| hold.after).collect();
        assert_eq!(after, [Some(After::Loading), Some(After::Loading), Some(After::Unloading)], "{found:?}");
        assert!(found.holds().all(|hold| hold.len() > 850), "{found:?}");
    }
}

#[test]
fn cyclic_tests_have_no_hold() {
    for period in [2.0, 10.0, 60.0, 600.0] {
        for noise in [0.0, 5.0, 50.0] {
            let sine = |t: f64| 5.0 - 5.0 * (std::f64::consts::TAU * t / period).cos();
            let triangle = |t: f64| 10.0 * (1.0 - (2.0 * (t / period).fract() - 1.0).abs());
            for (name, record) in [
                ("sine", record(sine, 3.0 * period, 50.0, noise, 0.0)),
                ("triangle", record(triangle, 3.0 * period, 50.0, noise, 0.0)),
            ] {
                let found = phases(&record);
                assert!(matches!(found, Err(SegmentError::NoHold { .. })), "{name} {period} s {noise} µm: {found:?}");
            }
        }
    }
}

#[test]
fn a_fast_ramp_is_no_rest() {
    let (shape, truth) = path(&[(5.0, 1e4, 5.0), (10.0, 1e4, 5.0)]);
    let found = phases(&record(shape, truth[1].1, 20.0, 0.0, 0.0)).unwrap();
    assert!(found.segments[1..].iter().all(|segment| segment.phase != Phase::Rest), "{found:?}");
}

/// The fit began at the peak of a jaw that swung, before the hold; and seconds before it where a controller fell short.
#[test]
fn the_fit_starts_in_the_hold_after_the_swing() {
    let time: Vec<f64> = (0..=1100).map(|i| 0.01 * f64::from(i)).collect();
    let swing = |t: f64| if t < 1.0 { 0.0 } else { 0.3 * (-(t - 1.0) / 0.15).exp() * (40.0 * (t - 1.0)).sin() };
    let jaw: Vec<f64> = time.iter().map(|t| 1e-3 * (10.0 * t.min(1.0) + swing(*t))).collect();
    let relaxed = |t: f64| 0.6 + 0.4 * (1.0 + (t - 1.0).max(0.0)).powf(-1.0);
    let force = time.iter().zip(&jaw).map(|(t, d)| 1e3 * d * relaxed(*t)).collect();
    let found = phases(&Record::new(time.clone(), Some(jaw), force).unwrap()).unwrap();
    let hold = found.holds().next().unwrap();
    assert!(hold.fit_start >= hold.start && time[hold.fit_start] > 1.2 && time[hold.fit_start] < 2.0, "{hold:?}");
    assert!(matches!(hold.fit_start_rule, Some(FitStartRule::DriveSettled | FitStartRule::Extreme)), "{hold:?}");
}

/// A crosshead that stood for 150 s and then moved had "no hold, or is at rest from the start".
#[test]
fn the_reason_for_no_hold_names_what_is_there() {
    let moves = record(|t| (t - 150.0).max(0.0), 200.0, 10.0, 1.0, 0.0);
    let error = phases(&moves).unwrap_err().to_string();
    assert_eq!(error, "no hold found: 150 s of standstill, then motion to the end");
    let always = record(|t| t, 20.0, 10.0, 1.0, 0.0);
    assert_eq!(
        phases(&always).unwrap_err().to_string(),
        "no hold found: the jaw moves from the first sample to the last"
    );
}

/// A triangle of a force alone named a jaw and a tolerance, which it does not have.
#[test]
fn a_force_alone_without_a_hold_names_no_jaw() {
    let time: Vec<f64> = (0..=200).map(|i| 0.1 * f64::from(i)).collect();
    let force = time.iter().map(|t| 10.0 - (t - 10.0).abs()).collect();
    let error = phases(&Record::new(time, None, force).unwrap()).unwrap_err();
    assert_eq!(error, SegmentError::NoHoldInForce);
    let hint = error.hint();
    assert!(!error.to_string().contains("jaw") && !hint.contains("⟨tolerance⟩") && hint.contains("[[phases.hold]]"));
}

/// Labels of the file go before what is found: extend and retract hold nothing, a pause does.
#[test]
fn labels_of_a_file_go_before_what_is_found() {
    let (shape, _) = path(&[(10.0, 10.0, 5.0), (0.0, 10.0, 5.0)]);
    let press = record(shape, 12.0, 100.0, 0.3, 0.0);
    assert_eq!(phases(&press).unwrap().holds().count(), 2);
    let label = |name, from, to| LabelledSegment::new(name, from, to).unwrap();
    let none = press.clone().labelled(vec![label("extend", 0.0, 5.9), label("retract", 6.0, 12.0)]);
    let error = phases(&none).unwrap_err();
    assert!(matches!(&error, SegmentError::NoneLabelled { names } if names == &["extend", "retract"]), "{error}");
    let one = press.labelled(vec![label("extend", 0.0, 0.99), label("pause", 1.0, 5.9), label("retract", 6.0, 12.0)]);
    let found = phases(&one).unwrap();
    let holds: Vec<_> = found.holds().map(|hold| (hold.start, hold.end)).collect();
    assert_eq!(holds, [(100, 591)]);
    let check = found.labels.unwrap();
    assert_eq!((check.labelled, check.missed, check.extra), (1, 0, 1));
}

/// A rheometer whose rotor swings up to its strain stood for a moment on the way, which was a hold of its own; the file calls the
/// whole step a relaxation.
#[test]
fn a_step_that_its_file_calls_a_relaxation_is_one_hold() {
    let time: Vec<f64> = (0..600).map(|i| 1e-3 * f64::from(i) + 1e-3 * 1.028f64.powi(i)).collect();
    let strain = |t: f64| 4.5e-3 * (1.0 - (-60.0 * t).exp() * (300.0 * t).cos());
    let torque = |t: f64| 1.0 / (1.0 + 30.0 * t).powf(0.3) + 8.0 * (-60.0 * t).exp() * (300.0 * t).sin();
    let displacement = time.iter().map(|t| strain(*t)).collect();
    let step = Record::new(time.clone(), Some(displacement), time.iter().map(|t| torque(*t)).collect()).unwrap();
    let labelled = |name| step.clone().labelled(vec![LabelledSegment::new(name, time[0], time[599]).unwrap()]);
    for name in ["Stress relaxation - 7", "Step (Transient) - Stress Relaxation", "relaxation"] {
        let found = phases(&labelled(name)).unwrap();
        let holds: Vec<_> = found.holds().map(|hold| (hold.end, hold.mode, hold.after)).collect();
        assert_eq!(holds, [(600, Some(HoldMode::DisplacementHeld), Some(After::Loading))], "{name}");
        let start = found.holds().next().unwrap().start;
        assert!((0.05..0.3).contains(&time[start]), "{name}: {}", time[start]);
    }
    // What only waits may wait before anything is touched, and is taken as labelled.
    let waits = phases(&labelled("pause")).map(|found| found.holds().count());
    assert!(waits.is_err() || waits == Ok(1), "{waits:?}");
}

/// A label names one hold: another inside it is one more of the search.
#[test]
fn a_search_that_parts_a_labelled_hold_disagrees_with_its_label() {
    let (shape, _) = path(&[(10.0, 10.0, 5.0), (11.0, 10.0, 5.0), (0.0, 10.0, 5.0)]);
    let press = record(shape, 18.0, 100.0, 0.3, 0.0);
    let label = |name, from, to| LabelledSegment::new(name, from, to).unwrap();
    let press =
        press.labelled(vec![label("extend", 0.0, 0.99), label("pause", 1.0, 10.5), label("retract", 10.51, 18.0)]);
    let check = phases(&press).unwrap().labels.unwrap();
    assert_eq!((check.labelled, check.missed, check.extra), (1, 0, 2));
}

/// A ramp alone has no hold, and a hold alone no loading.
#[test]
fn a_ramp_and_its_hold_are_one_test() {
    let time = |count: u32| (0..count).map(|i| 0.1 * f64::from(i)).collect::<Vec<f64>>();
    let jaw = time(100).iter().map(|t| 1e-3 * t).collect();
    let ramp = Record::new(time(100), Some(jaw), time(100)).unwrap();
    let force = time(600).iter().map(|t| 6.0 + 4.0 * (-t / 15.0).exp()).collect();
    let hold = Record::new(time(600), Some(vec![9.9e-3; 600]), force).unwrap();
    assert!(phases(&ramp).is_err());
    let test = ramp.then(&hold, None).unwrap();
    assert!((test.time()[100] - 10.0).abs() < 1e-9);
    let found = phases(&test).unwrap();
    let kinds: Vec<Phase> = found.segments.iter().map(|segment| segment.phase).collect();
    assert_eq!(kinds, [Phase::Loading, Phase::Hold]);
    assert!(found.segments[1].start.abs_diff(100) <= 1, "{found:?}");
    assert_eq!(found.segments[1].mode, Some(HoldMode::DisplacementHeld));
    let Some(Correction::Continued { gap, shift, .. }) = test.corrections().last() else {
        panic!("{test:?}")
    };
    assert!((gap - 0.1).abs() < 1e-9 && (shift - 10.0).abs() < 1e-9);
}

/// A record that begins with its hold was "nothing moves", a creep under a force that never varies "no hold".
#[test]
fn a_record_that_is_one_hold_is_that_hold() {
    let time: Vec<f64> = (0..1000).map(|i| 0.05 * f64::from(i)).collect();
    let mut noise = Rng::new(3);
    let relaxing = |t: &f64| 1.0 + (1.0 + 4.0 * t).powf(-0.25);
    let force: Vec<f64> = time.iter().map(|t| relaxing(t) + 0.002 * noise.normal()).collect();
    let standing: Vec<f64> = time.iter().map(|_| 5e-3 + 5e-7 * noise.normal()).collect();
    let creeping: Vec<f64> = time.iter().map(|t| 5e-3 - 2e-3 * (-t / 10.0).exp()).collect();
    let pressed: Vec<f64> = time.iter().map(|_| 2.0).collect();
    let hunted: Vec<f64> = time.iter().map(|_| 2.0 + 0.005 * noise.normal()).collect();
    for (displacement, force, mode) in [
        (Some(standing), &force, HoldMode::DisplacementHeld),
        (None, &force, HoldMode::DisplacementHeld),
        (Some(creeping.clone()), &pressed, HoldMode::ForceHeld),
        (Some(creeping), &hunted, HoldMode::ForceHeld),
    ] {
        let record = Record::new(time.clone(), displacement, force.clone()).unwrap();
        if mode == HoldMode::DisplacementHeld {
            // That the force falls from the first sample on is what it does in a hold, and no wrong sign.
            let options = AnalysisOptions {
                compare: None,
                ..AnalysisOptions::default()
            };
            let findings = analyze(&record, &options).unwrap().findings;
            let codes: Vec<&str> = findings.iter().map(Finding::code).collect();
            assert!(codes.contains(&"one_hold") && !codes.contains(&"sign_suspicious"), "{codes:?}");
        }
        let found = phases(&record).unwrap();
        let hold = found.segments[0];
        assert_eq!((found.segments.len(), hold.phase, hold.start, hold.end), (1, Phase::Hold, 0, 1000), "{found:?}");
        assert_eq!((hold.mode, hold.fit_start < 10), (Some(mode), true), "{found:?}");
    }
}

/// A creep that was logged at even steps of ln t, noisy where it is small.
#[test]
fn a_creep_logged_ever_more_seldom_is_one_hold_too() {
    let mut noise = Rng::new(5);
    let time: Vec<f64> = (0..300).map(|i| 1e-3 * (0.04 * f64::from(i)).exp()).collect();
    let creeping: Vec<f64> = time.iter().map(|t| 1e-3 * t.powf(0.3) + 2e-6 * noise.normal()).collect();
    let found = phases(&Record::new(time, Some(creeping), vec![10.0; 300]).unwrap()).unwrap();
    assert_eq!((found.segments.len(), found.segments[0].mode), (1, Some(HoldMode::ForceHeld)), "{found:?}");
}

/// What is let go, squeezed on, or moved through the air goes on without a hold.
#[test]
fn a_ramp_alone_is_no_hold() {
    let time: Vec<f64> = (0..1000).map(|i| 0.05 * f64::from(i)).collect();
    let jaw: Vec<f64> = time.iter().map(|t| 1e-4 * t).collect();
    let let_go: Vec<f64> = time.iter().map(|t| (50.0 - t).powf(1.5)).collect();
    let squeezed: Vec<f64> = time.iter().map(|t| 1.0 + t.sqrt()).collect();
    let offset: Vec<f64> = time.iter().map(|_| 0.3).collect();
    for (displacement, force) in
        [(None, let_go.clone()), (None, squeezed), (Some(jaw.clone()), offset), (Some(jaw), let_go)]
    {
        let found = phases(&Record::new(time.clone(), displacement, force).unwrap());
        assert!(found.is_err(), "{found:?}");
    }
}

#[test]
fn a_few_odd_rows_are_no_motion() {
    let odd = |t: f64| if [100.0, 400.0, 700.0].contains(&(100.0 * t).round()) { 5.0 } else { 0.0 };
    let found = phases(&record(odd, 10.0, 100.0, 0.0, 0.0));
    assert!(matches!(found, Err(SegmentError::NoMotion { .. })), "{found:?}");
}

/// A creep under 10 N that ripples by 0.3 N at 3 Hz was one long ramp.
#[test]
fn a_controller_that_hunts_holds_the_force() {
    let (mut noise, mut creep) = (Rng::new(1), 0.0);
    let held = |t: f64| match t {
        t if t < 2.0 => 0.0,
        t if t < 4.0 => 5.0 * (t - 2.0),
        t if t < 34.0 => 10.0,
        t if t < 35.0 => 10.0 - 8.0 * (t - 34.0),
        t if t < 65.0 => 2.0,
        t => 2.0 - 0.4 * (t - 65.0),
    };
    let time: Vec<f64> = (0..7000).map(|i| 0.01 * f64::from(i)).collect();
    let mut displacement = Vec::new();
    let mut force = Vec::new();
    for t in &time {
        let now = held(*t);
        creep += (0.08 * now - creep) * 0.01 / 8.0;
        displacement.push(1e-3 * (0.2 * now + creep + 5e-4 * noise.normal()));
        let ripple = if now > 1.0 { 0.3 * (std::f64::consts::TAU * 3.0 * t).sin() } else { 0.0 };
        force.push(now + ripple + 0.01 * noise.normal());
    }
    let record = Record::new(time, Some(displacement), force).unwrap();
    let found = phases(&record).unwrap();
    let holds: Vec<_> = found.holds().collect();
    assert_eq!(holds.len(), 2, "{holds:?}");
    for (hold, (start, end)) in holds.iter().zip([(4.0, 34.0), (35.0, 65.0)]) {
        let off = [record.time()[hold.start] - start, record.time()[hold.end - 1] - end];
        assert!(off.iter().all(|off| off.abs() < 0.035), "{off:?}");
        assert_eq!(hold.mode, Some(HoldMode::ForceHeld));
    }
}

/// Rest, a ramp of 1 s and 20 s of relaxation from 9.5 to 5.1 N, by the force alone: no hold was found.
#[test]
fn a_slow_relaxation_is_a_hold_of_the_force_alone() {
    let mut noise = Rng::new(2);
    let time: Vec<f64> = (0..2600).map(|i| 0.01 * f64::from(i)).collect();
    let force = time.iter().map(|t| {
        let held = match *t {
            t if t < 2.0 => 0.0,
            t if t < 3.0 => 9.5 * (t - 2.0),
            t if t < 23.0 => 5.0 + 4.5 * (-(t - 3.0) / 5.0).exp(),
            t => (5.08 - 10.0 * (t - 23.0)).max(0.0),
        };
        held + 0.02 * noise.normal()
    });
    let record = Record::new(time.clone(), None, force.collect()).unwrap();
    let found = phases(&record).unwrap();
    let first = found.holds().next().unwrap();
    let ends = [record.time()[first.start], record.time()[first.end - 1]];
    assert!((ends[0] - 3.0).abs() < 0.06 && (ends[1] - 23.0).abs() < 0.06, "{ends:?}");
    assert_eq!(first.after, Some(After::Loading));
}
