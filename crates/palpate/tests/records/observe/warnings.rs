//! When slip is warned of, and when not.

use super::material::material;
use super::*;

/// Warnings of a contact at 100 Hz with noise of `noise` (m and N), and the last observation.
fn warnings(
    course: impl Iterator<Item = (f64, Option<f64>, f64)>,
    options: ObserverOptions,
    noise: (f64, f64),
    seed: u64,
) -> Vec<Observation> {
    let (mut observer, mut random) = (Observer::new(options).unwrap(), Rng::new(seed));
    course
        .map(|(time, displacement, force)| {
            let displacement = displacement.map(|displacement| displacement + noise.0 * random.normal());
            observer.feed(time, displacement, force + noise.1 * random.normal()).unwrap()
        })
        .collect()
}

/// The squeeze at 100 Hz.
fn slow() -> Vec<(f64, f64, f64)> {
    squeeze(30.0).into_iter().skip(4).step_by(5).collect()
}

/// With a material the force had the noise of the last displacement: a warning of slip came and went ten times, and came early.
#[test]
fn a_warning_of_slip_stays_with_a_material_under_noise_of_the_displacement() {
    let course = slow();
    let slip = force_after(15.0);
    let mut changes = 0;
    for seed in 0..20 {
        let options = ObserverOptions {
            material: Some(material(1.0)),
            ..slipping_at(slip)
        };
        let ticks = course.iter().map(|tick| (tick.0, Some(tick.1), tick.2));
        let observed = warnings(ticks, options, (2e-6, 0.01), seed);
        let late: Vec<&Observation> = observed.iter().filter(|observed| observed.time > 2.0).collect();
        changes += late.windows(2).filter(|pair| pair[0].slip != pair[1].slip).count();
        let slips = late.iter().find(|observed| observed.slip == Slip::Slipping).unwrap();
        assert!((slips.time - STOP - 15.0).abs() < 2.0, "{seed}: {}", slips.time);
        assert_eq!(late.last().unwrap().slip, Slip::Slipping);
    }
    // One from none to soon, and one from soon to slipping.
    assert!(changes <= 2 * 20 + 4, "{changes}");
}

/// A hold without a displacement was lost before its force had relaxed to that of slip, and no warning came in 18 of 20 logs.
#[test]
fn a_force_alone_that_relaxes_to_that_of_slip_is_warned_of() {
    let course = slow();
    let slip = force_after(15.0);
    for noise in [0.002, 0.01] {
        for seed in 0..20 {
            let ticks = course.iter().map(|tick| (tick.0, None, tick.2));
            let observed = warnings(ticks, slipping_at(slip), (0.0, noise), seed);
            let slips = |observed: &&Observation| observed.slip == Slip::Slipping;
            let first = observed.iter().find(slips).unwrap_or_else(|| panic!("{noise} {seed}: no warning")).time;
            assert!((first - STOP - 15.0).abs() < 4.0, "{noise} {seed}: {first}");
            assert_eq!(observed.last().unwrap().slip, Slip::Slipping, "{noise} {seed}");
        }
    }
}

/// Noise of an open gripper, and a drift of its zero, were warned of as slip.
#[test]
fn an_idle_gripper_holds_nothing_that_slips() {
    for drift in [0.0, 0.01] {
        for seed in 0..50 {
            for sees_jaw in [true, false] {
                let ticks =
                    (1..1000).map(|i| 0.01 * f64::from(i)).map(|time| (time, sees_jaw.then_some(0.0), drift * time));
                let observed = warnings(ticks, slipping_at(1.5), (2e-6, 0.01), seed);
                let warned = observed.iter().find(|observed| observed.slip != Slip::None);
                assert!(warned.is_none(), "{drift} {seed} {sees_jaw}: {warned:?}");
            }
        }
    }
}

/// A grip that never reached the force of slip slips from the beginning, one that the jaw lets go is open.
#[test]
fn a_weak_grip_slips_and_an_open_jaw_does_not() {
    let way = |time: f64| if time < 5.0 { time.min(STOP) / STOP } else { (1.0 - (time - 5.0) / STOP).max(0.0) };
    let (model, mut contact) = (model(), ContactState::default());
    let ticks: Vec<_> = (1..1000)
        .map(|i| 0.01 * f64::from(i))
        .map(|time| (time, Some(5e-3 * way(time)), contact.step(&model, 0.01, 5e-3 * way(time)).unwrap()))
        .collect();
    for seed in 0..20 {
        let observed = warnings(ticks.iter().copied(), slipping_at(10.0), (2e-6, 0.01), seed);
        let at = |time: f64| observed[(100.0 * time) as usize].slip;
        assert_eq!(
            [0.3, 1.0, 4.5, 7.0, 9.9].map(at),
            [Slip::None, Slip::Slipping, Slip::Slipping, Slip::None, Slip::None]
        );
    }
}

/// What falls out of a jaw that stands is lost: no phase of a contact is left to warn in.
#[test]
fn what_is_lost_from_a_jaw_that_stands_has_slipped() {
    let ticks = slow().into_iter().map(|(time, jaw, force)| (time, Some(jaw), if time > 5.0 { 0.0 } else { force }));
    let observed = warnings(ticks, slipping_at(1.5), (2e-6, 0.01), 3);
    assert!(observed.iter().all(|observed| (observed.time > 5.005) == (observed.slip == Slip::Slipping)));
}

/// The force at the tick that detected a hold stood beside the time at which it had begun.
#[test]
fn the_force_of_a_hold_is_that_of_its_beginning() {
    let course = slow();
    let truth = course.iter().map(|tick| tick.2).fold(0.0, f64::max);
    for sees_jaw in [true, false] {
        for seed in 0..20 {
            let ticks = course.iter().map(|tick| (tick.0, sees_jaw.then_some(tick.1), tick.2));
            let observed = warnings(ticks, ObserverOptions::default(), (2e-6, 0.01), seed);
            let held = observed.iter().find(|observed| observed.began).unwrap().held_force.unwrap();
            assert!((held - truth).abs() < 0.05 * truth, "{sees_jaw} {seed}: {held} {truth}");
        }
    }
}
