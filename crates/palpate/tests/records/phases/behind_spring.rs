//! Holds of a machine that stands still behind a soft spring, such as the cantilever of an AFM.

use super::{Step, path, phases};
use palpate::record::Record;
use palpate::segment::HoldMode;
use palpate::test_problems::Rng;

const RATE_HZ: f64 = 200.0;

/// A standard linear solid of stiffness 1 N/mm at once and half of it in equilibrium, time constant 1 s, behind a spring in N/mm.
///
/// Displacement in mm of the body, z − F/k, with F of u = z − F/k in steps of a fiftieth of a sample. The force has 0.2 % noise, by which the
/// displacement is found as in a file.
fn record(steps: &[Step], spring: f64, seed: u64) -> (Record, Vec<(f64, f64)>) {
    let (machine, truth) = path(steps);
    let mut numbers = Rng::new(seed);
    let (mut force, mut kept) = (0.0f64, 0.0f64);
    let step = 1.0 / (50.0 * RATE_HZ);
    let count = (truth.last().unwrap().1 * RATE_HZ + 1e-6) as usize + 1;
    let (mut time, mut jaw, mut load) = (vec![], vec![], vec![]);
    for sample in 0..count {
        let t = sample as f64 / RATE_HZ;
        for part in 0..50 {
            let z = machine(t - step * f64::from(49 - part));
            let body = z - force / spring;
            // F = u/2 + q with dq/dt = du/dt/2 − q: the part that relaxes is (u − kept)/2, and dkept/dt = u − kept.
            kept += step * (body - kept);
            force = (z - 0.5 * kept) / (1.0 + 1.0 / spring);
        }
        let measured = force + 2e-3 * numbers.normal();
        time.push(t);
        load.push(measured);
        jaw.push(1e-3 * (machine(t) - measured / spring));
    }
    let holds = truth.iter().map(|(from, until, _)| (*from, *until)).collect();
    (Record::new(time, Some(jaw), load).unwrap(), holds)
}

#[test]
fn a_dwell_behind_a_cantilever_began_two_time_constants_late() {
    let dwell: &[Step] = &[(1.0, 2.0, 5.0), (0.0, 2.0, 0.0)];
    let ladder: &[Step] = &[(1.0, 2.0, 6.0), (2.0, 2.0, 6.0), (1.4, 2.0, 6.0), (0.2, 2.0, 1.0)];
    for (steps, spring) in [(dwell, 10.0), (dwell, 4.0), (dwell, 1.0), (ladder, 5.0)] {
        for seed in 0..3 {
            let (record, truth) = record(steps, spring, seed);
            let found = phases(&record).unwrap();
            let held = truth.iter().filter(|(from, until)| until - from > 0.5);
            assert_eq!(found.holds().count(), held.clone().count(), "{spring} N/mm: {found:?}");
            for (hold, (from, until)) in found.holds().zip(held) {
                let off = [record.time()[hold.start] - from, record.time()[hold.end - 1] - until];
                assert!(off.iter().all(|off| off.abs() <= 2.5 / RATE_HZ), "{spring} N/mm: {hold:?} off by {off:?} s");
                assert_ne!(hold.mode, Some(HoldMode::ForceHeld));
            }
        }
    }
}

#[test]
fn a_jaw_that_drifts_while_the_force_relaxes_is_behind_no_spring() {
    // The jaw goes on by a twentieth of its way at an even pace: that is the drift of a machine, and the hold is found by the jaw.
    let (machine, truth) = path(&[(1.0, 2.0, 5.0)]);
    let (from, until, _) = truth[0];
    let mut numbers = Rng::new(1);
    let time: Vec<f64> = (0..1100).map(|i| f64::from(i) / RATE_HZ).collect();
    let jaw = |t: f64| 1e-3 * (machine(t) + 0.01 * (t - from).max(0.0));
    let force = |t: f64| if t < from { 2.0 * t } else { 0.5 + 0.5 * (from - t).exp() };
    let displacement = time.iter().map(|t| jaw(*t) + 1e-6 * numbers.normal()).collect();
    let load = time.iter().map(|t| force(*t)).collect();
    let record = Record::new(time, Some(displacement), load).unwrap();
    let found = phases(&record).unwrap();
    let hold = found.holds().next().unwrap();
    assert!((record.time()[hold.start] - from).abs() < 0.02 && (record.time()[hold.end - 1] - until).abs() < 0.02);
}
