//! Bodies that flow under a jaw or a force that is driven: hunting controllers, recoveries, ruptures, rows that stray.

use palpate::analysis::{AnalysisOptions, analyze};
use palpate::record::Record;
use palpate::segment::HoldMode;
use palpate::test_problems::Rng;

use super::phases;

/// A body that flows: two Maxwell arms beside a spring, in steps of 2 ms; of what is driven, the other column follows.
struct Body {
    arms: [(f64, f64, f64); 2],
    at: f64,
}

impl Body {
    fn new() -> Self {
        Self {
            arms: [(1.0, 0.5, 0.0), (0.8, 12.0, 0.0)],
            at: 0.0,
        }
    }

    const STEP: f64 = 2e-3;

    /// Force with the jaw at this place (mm) after a step.
    fn squeezed(&mut self, to: f64) -> f64 {
        let mut force = 1.5 * to;
        for (stiffness, time, left) in &mut self.arms {
            *left = *left * (-Self::STEP / *time).exp() + *stiffness * (to - self.at);
            force += *left;
        }
        self.at = to;
        force
    }

    /// Place of the jaw under this force after a step.
    fn pressed(&mut self, force: f64) -> f64 {
        let faded: f64 = self.arms.iter().map(|(_, time, left)| left * (-Self::STEP / time).exp()).sum();
        let stiffness: f64 = self.arms.iter().map(|arm| arm.0).sum();
        let to = (force - faded + stiffness * self.at) / (1.5 + stiffness);
        self.squeezed(to);
        to
    }
}

/// What a machine holds at a time: a place of the jaw (mm) or a force (N).
enum Drive {
    Place(f64),
    Force(f64),
}

/// The record of a body under a drive, at 20 Hz, with 2 µm and 0.05 N of noise.
fn driven(duration: f64, drive: impl Fn(f64) -> Drive) -> Record {
    measured(duration, [2e-3, 0.05], drive)
}

/// The same with this noise of jaw (mm) and force (N).
fn measured(duration: f64, noise: [f64; 2], drive: impl Fn(f64) -> Drive) -> Record {
    let (mut body, mut random) = (Body::new(), Rng::new(11));
    let (mut time, mut jaw, mut force) = (Vec::new(), Vec::new(), Vec::new());
    for step in 0..(duration / Body::STEP) as u32 {
        let t = Body::STEP * f64::from(step);
        let (place, load) = match drive(t) {
            Drive::Place(to) => (to, body.squeezed(to)),
            Drive::Force(load) => (body.pressed(load), load),
        };
        if step % 25 == 0 {
            time.push(t);
            jaw.push(1e-3 * (place + noise[0] * random.normal()));
            force.push(load + noise[1] * random.normal());
        }
    }
    Record::new(time, Some(jaw), force).unwrap()
}

/// Holds as first and last time with what is held.
fn holds(record: &Record) -> Vec<(f64, f64, HoldMode)> {
    let found = phases(record).unwrap();
    let time = record.time();
    found.holds().map(|hold| (time[hold.start], time[hold.end - 1], hold.mode.unwrap())).collect()
}

fn near(found: &[(f64, f64, HoldMode)], expected: &[(f64, f64, HoldMode)], within: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        let off = (found.0 - expected.0).abs().max((found.1 - expected.1).abs());
        assert!(off <= within && found.2 == expected.2, "{found:?} {expected:?}");
    }
}

#[test]
fn a_jaw_that_hunts_holds_all_the_same_and_that_is_stated() {
    let place = |t: f64| match t {
        _ if t < 3.0 => 0.0,
        _ if t < 5.0 => 3.0 * (t - 3.0),
        _ if t < 65.0 => 6.0,
        _ if t < 67.0 => 6.0 + 3.0 * (t - 65.0),
        _ => 12.0,
    };
    for (share, rate) in [(0.002, 0.5), (0.002, 0.1), (0.01, 2.0), (0.02, 0.5)] {
        let swing = |t: f64| if t < 3.0 { 0.0 } else { 12.0 * share * (std::f64::consts::TAU * rate * t).sin() };
        let record = driven(127.0, |t| Drive::Place(place(t) + swing(t)));
        let found = phases(&record).unwrap();
        let held: Vec<f64> =
            found.holds().map(|hold| record.time()[hold.end - 1] - record.time()[hold.start]).collect();
        assert!(held.len() == 2 && held.iter().all(|held| *held > 58.0), "{share} {rate}: {held:?}");
        let ripple = found.ripple.unwrap();
        assert!(
            (ripple.height / (24e-3 * share) - 1.0).abs() < 0.2 && (ripple.period * rate - 1.0).abs() < 0.1,
            "{ripple:?}"
        );
    }
    let calm = driven(127.0, |t| Drive::Place(place(t)));
    assert_eq!(phases(&calm).unwrap().ripple, None);
}

/// A body that a jaw had left by the end of unloading was held by a force near zero, with the end of the ramp to the rest of the jaw and the start of
/// the next.
#[test]
fn a_jaw_that_rests_clear_of_the_body_holds_no_force() {
    let cycle = [(5.0, 3.0), (10.4, 0.3), (15.4, 0.3), (20.8, 3.0)];
    let place = |t: f64| match t {
        _ if t < 8.0 => (0.5 * (t - 2.0)).max(0.0),
        _ if t < 91.2 => {
            let t = (t - 8.0) % 20.8;
            let next = cycle.partition_point(|knot| knot.0 <= t);
            let ((from, start), (until, end)) = (if next == 0 { (0.0, 3.0) } else { cycle[next - 1] }, cycle[next]);
            start + (end - start) * (t - from) / (until - from)
        }
        _ if t < 151.2 => 3.0,
        _ => (3.0 - 0.5 * (t - 151.2)).max(0.0),
    };
    let often = measured(170.0, [3e-4, 0.0], |t| Drive::Place(place(t)));
    for (every, seed) in [(10, 1), (10, 2), (4, 1), (4, 2), (2, 1), (1, 1)] {
        let mut random = Rng::new(seed);
        let some = |column: &[f64]| -> Vec<f64> { column.iter().copied().step_by(every).collect() };
        // A jaw cannot pull.
        let force = some(often.force()).iter().map(|force| force.max(0.0) + 0.007 * random.normal()).collect();
        let record = Record::new(some(often.time()), often.displacement().map(some), force).unwrap();
        let found = phases(&record).unwrap();
        let jaw = record.displacement().unwrap();
        for hold in found.holds() {
            let (first, last) = (jaw[hold.start], jaw[hold.end - 1]);
            assert!(hold.mode == Some(HoldMode::DisplacementHeld) && (last - first).abs() < 3e-6, "{every}: {hold:?}");
        }
        assert!(found.holds().count() >= 9, "{every}: {:?}", holds(&record));
    }
}

#[test]
fn the_recovery_after_a_creep_is_a_hold_of_the_small_force() {
    for low in [0.2, 1.0, 5.0] {
        let record = driven(130.0, |t| {
            Drive::Force(match t {
                _ if t < 2.0 => low,
                _ if t < 3.0 => low + (20.0 - low) * (t - 2.0),
                _ if t < 63.0 => 20.0,
                _ if t < 64.0 => 20.0 - (20.0 - low) * (t - 63.0),
                _ => low,
            })
        });
        let found = holds(&record);
        let [.., crept, recovered] = found.as_slice() else {
            panic!("{low}: {found:?}")
        };
        near(
            &[*crept, *recovered],
            &[(3.0, 63.0, HoldMode::ForceHeld), (64.0, 129.95, HoldMode::ForceHeld)],
            0.11,
        );
    }
}

#[test]
fn a_machine_that_goes_over_from_the_jaw_to_the_force_makes_two_holds() {
    let record = driven(63.0, |t| match t {
        _ if t < 2.0 => Drive::Place(0.0),
        _ if t < 3.0 => Drive::Place(10.0 * (t - 2.0)),
        _ if t < 33.0 => Drive::Place(10.0),
        // What the body bears by then.
        _ => Drive::Force(15.64),
    });
    near(
        &holds(&record),
        &[(3.0, 32.95, HoldMode::DisplacementHeld), (33.0, 62.95, HoldMode::ForceHeld)],
        0.4,
    );
}

#[test]
fn a_body_that_breaks_in_a_ramp_of_few_samples_is_observed() {
    let place = |t: f64| match t {
        _ if t < 3.0 => 0.0,
        _ if t < 5.0 => 3.0 * (t - 3.0),
        _ if t < 35.0 => 6.0,
        _ if t < 37.0 => 6.0 + 3.0 * (t - 35.0),
        _ => 12.0,
    };
    let whole = driven(67.0, |t| Drive::Place(place(t)));
    // Every second row, and of the force a tenth is left from 36.3 s on.
    let rows: Vec<usize> = (0..whole.len()).step_by(2).collect();
    let time: Vec<f64> = rows.iter().map(|i| whole.time()[*i]).collect();
    let jaw = rows.iter().map(|i| whole.displacement().unwrap()[*i]).collect();
    let force = rows.iter().map(|i| whole.force()[*i] * if whole.time()[*i] < 36.3 { 1.0 } else { 0.1 }).collect();
    let found = phases(&Record::new(time, Some(jaw), force).unwrap()).unwrap();
    let [rupture] = found.ruptures.as_slice() else {
        panic!("{found:?}")
    };
    assert!((rupture.time - 36.3).abs() < 0.11 && found.holds().count() == 1, "{rupture:?}");
}

/// A rest of six samples and a ramp of three or four were one line, which met the level seconds after the jaw had stopped; and the rest counted as
/// part of the time in which the displacement was applied.
#[test]
fn a_hold_after_a_short_rest_and_a_short_ramp_begins_where_the_jaw_stops() {
    for (rest, ramp, rate) in [(5.0, 2.0, 1.0), (5.0, 3.0, 1.0), (5.0, 4.0, 1.0), (20.0, 4.0, 1.0), (0.5, 0.4, 10.0)] {
        let jaw =
            |t: f64| 5.0 * (((t - rest) / ramp).clamp(0.0, 1.0) - ((t - rest - ramp - 60.0) / ramp).clamp(0.0, 1.0));
        let times: Vec<f64> = (0..=((rest + 2.0 * ramp + 80.0) * rate) as usize).map(|i| i as f64 / rate).collect();
        let force = |t: &f64| {
            let held = t - rest - ramp;
            if held < 0.0 { 2.0 * jaw(*t) } else { jaw(*t) / 5.0 * (4.0 + 6.0 / (1.0 + held).sqrt()) }
        };
        let displacement = times.iter().map(|t| 1e-3 * jaw(*t)).collect();
        let record = Record::new(times.clone(), Some(displacement), times.iter().map(force).collect()).unwrap();
        let options = AnalysisOptions {
            compare: None,
            ..AnalysisOptions::default()
        };
        let analysis = analyze(&record, &options).unwrap();
        let hold = &analysis.holds[0];
        assert!((hold.start - rest - ramp).abs() < 1e-9, "{rest} {ramp}: {}", hold.start);
        assert!((hold.end - rest - ramp - 60.0).abs() < 1e-9, "{rest} {ramp}: {}", hold.end);
        let applied = analysis.hold_report(hold).applied_in.unwrap();
        assert!((applied - ramp).abs() < 1e-9, "{rest} {ramp}: {applied}");
    }
}

/// Two rows of 0 N in a hold of a minute, and a spike of three times the force, hid the hold: the displacement stands there all the time.
#[test]
fn a_few_rows_of_force_that_stray_hide_no_hold() {
    let time: Vec<f64> = (0..1300).map(|i| 0.05 * f64::from(i)).collect();
    let displacement = time
        .iter()
        .map(|t| 5e-3 * (t - 1.0).clamp(0.0, 1.0) * (63.0 - t).clamp(0.0, 1.0))
        .collect::<Vec<f64>>();
    let mut random = Rng::new(1);
    let force: Vec<f64> = time
        .iter()
        .zip(&displacement)
        .map(|(t, d)| d / 5e-3 * (6.0 + 4.0 * (-(t - 2.0).max(0.0) / 8.0).exp()) + 0.01 * random.normal())
        .collect();
    for (rows, value) in [(600..602, 0.0), (600..601, 30.0), (600..605, 100.0), (10..11, 30.0), (300..301, -50.0)] {
        let mut stray = force.clone();
        stray[rows.clone()].fill(value);
        let record = Record::new(time.clone(), Some(displacement.clone()), stray).unwrap();
        let hold = phases(&record).unwrap().holds().next().map(|hold| (time[hold.start], time[hold.end - 1])).unwrap();
        assert!((hold.0 - 2.0).abs() < 0.2 && (hold.1 - 62.0).abs() < 0.2, "{rows:?} of {value} N: {hold:?}");
    }
}

/// Where a record began without a force, a recovery at a hundredth of the creep's began 40 s late, and was unloading until then.
#[test]
fn a_recovery_at_a_hundredth_of_the_force_begins_as_the_force_is_reached() {
    for low in [0.0, 0.1, 0.2] {
        let record = driven(190.0, |t| {
            Drive::Force(match t {
                _ if t < 2.0 => 0.0,
                _ if t < 3.0 => 20.0 * (t - 2.0),
                _ if t < 63.0 => 20.0,
                _ if t < 64.0 => 20.0 - (20.0 - low) * (t - 63.0),
                _ => low,
            })
        });
        near(&holds(&record), &[(3.0, 63.0, HoldMode::ForceHeld), (64.0, 189.95, HoldMode::ForceHeld)], 0.16);
    }
}

/// The one step of such a force was its rounding, so that only the end of the creep, where the jaw stands, was a hold.
#[test]
fn a_force_that_is_exactly_a_dead_weight_is_held_from_its_first_sample() {
    let reached = |weights: &[f64], ramp: f64, t: f64| -> f64 {
        let since = |index: usize| t - 2.0 - 40.0 * index as f64;
        weights
            .iter()
            .enumerate()
            .map(|(index, weight)| weight * (since(index) / ramp).clamp(0.0, 1.0))
            .sum()
    };
    for weights in [&[20.0][..], &[5.0; 4]] {
        for ramp in [1e-3, 0.1, 0.15, 0.2, 1.0] {
            let last = 2.0 + 40.0 * weights.len() as f64;
            for noise in [[0.0; 2], [2e-3, 0.0]] {
                let record = measured(last, noise, |t| Drive::Force(reached(weights, ramp, t)));
                let expected: Vec<_> = (0..weights.len())
                    .map(|index| 2.0 + 40.0 * index as f64)
                    .map(|start| (start + ramp, start + 40.0 - 0.05, HoldMode::ForceHeld))
                    .collect();
                near(&holds(&record), &expected, 0.16);
            }
        }
    }
}

/// A force that relaxed by less than a tenth of what it was let go by was rest, and its signs were suspicious.
#[test]
fn a_record_that_begins_in_its_hold_does_not_begin_at_rest() {
    let time: Vec<f64> = (0..1200).map(|i| 0.05 * f64::from(i)).collect();
    let jaw = |t: f64| 5e-3 - 3e-3 * (t - 30.0).clamp(0.0, 1.0);
    let mut random = Rng::new(4);
    let force = time.iter().map(|t| {
        let held = 12.0 + (-t / 8.0).exp() - 11.0 * (t - 30.0).clamp(0.0, 1.0);
        held + 0.3 * (1.0 - (-(t - 31.0).max(0.0) / 8.0).exp()) + 0.01 * random.normal()
    });
    let record = Record::new(time.clone(), Some(time.iter().map(|t| jaw(*t)).collect()), force.collect()).unwrap();
    near(
        &holds(&record),
        &[(0.0, 30.0, HoldMode::DisplacementHeld), (31.0, 59.95, HoldMode::DisplacementHeld)],
        0.11,
    );
    let found = analyze(&record, &AnalysisOptions::default()).unwrap().findings;
    assert!(found.iter().all(|finding| finding.code() != "sign_suspicious"), "{found:?}");
}

/// One to five samples of 130 % at the start of a hold were the first term of its law.
#[test]
fn a_fit_begins_behind_rows_that_stray_where_it_would_begin() {
    let time: Vec<f64> = (0..1200).map(|i| 0.05 * f64::from(i)).collect();
    let jaw: Vec<f64> = time.iter().map(|t| 5e-3 * (t - 2.0).clamp(0.0, 1.0)).collect();
    let mut random = Rng::new(4);
    let relaxes = |t: f64| 12.0 + 8.0 * (-(t - 3.0).max(0.0) / 8.0).exp();
    let force: Vec<f64> = time.iter().zip(&jaw).map(|(t, d)| d / 5e-3 * relaxes(*t) + 0.01 * random.normal()).collect();
    for (start, length) in [(60, 1), (60, 3), (60, 5), (61, 2), (63, 5)] {
        let mut stray = force.clone();
        stray[start..start + length].iter_mut().for_each(|force| *force *= 1.3);
        let found = phases(&Record::new(time.clone(), Some(jaw.clone()), stray).unwrap()).unwrap();
        let hold = found.holds().next().unwrap();
        let begins = start + length..start + length + 3;
        assert!(begins.contains(&hold.fit_start), "{start} {length}: {hold:?}");
    }
}

/// A plate that leaves the body as it unloads and turns in the air: each turn was "a force that is held, the body creeps", 48 of 72 cycles.
#[test]
fn a_plate_that_turns_clear_of_the_body_holds_no_force() {
    for (seed, speed) in [(1, 0.83), (2, 1.67), (3, 4.2)] {
        let mut random = Rng::new(seed);
        let (deepest, cycle) = (20.0, 40.0 / speed);
        let rested = 3.0 * cycle + 60.0;
        let (mut time, mut jaw, mut force) = (vec![], vec![], vec![]);
        for i in 0..((rested + 200.0) / 0.1) as usize {
            let t = 0.1 * f64::from(i as u32);
            let (through, way) = ((t / cycle).floor(), speed * (t % cycle));
            let pressed = speed * (t - rested).max(0.0);
            let (at, of_body) = match () {
                // The body follows the plate late, and meets it above where it was at first.
                () if t < 3.0 * cycle && way <= deepest => (way, 75.0 * ((way - 2.5 * through.min(1.0)) / deepest)),
                () if t < 3.0 * cycle => (40.0 - way, 75.0 * ((34.0 - way) / 14.0)),
                () if pressed < 12.5 => (pressed, 3.6 * pressed),
                () => (12.5, 36.0 + 9.0 * (-(t - rested - 12.5 / speed) / 40.0).exp()),
            };
            time.push(t);
            jaw.push(1e-3 * at + 1e-7 * random.normal());
            force.push(of_body.max(0.0) + 0.05 * random.normal());
        }
        let segmentation = phases(&Record::new(time, Some(jaw), force).unwrap()).unwrap();
        let found: Vec<f64> = segmentation.holds().map(|hold| 0.1 * hold.start as f64).collect();
        let expected = rested + 12.5 / speed;
        assert!(found.iter().all(|start| *start >= 3.0 * cycle - 0.5), "{speed}: {found:?}");
        assert!(found.iter().any(|start| (start - expected).abs() < 0.5), "{speed}: {found:?} {expected}");
    }
}
