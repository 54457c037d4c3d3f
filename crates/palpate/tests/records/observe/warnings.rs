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

/// A squeeze of 8 mm at 20 mm/s, read at a rate (1/s) for `hold` s.
fn quick(rate: f64, hold: f64) -> Vec<(f64, f64, f64)> {
    let (model, mut contact) = (model(), ContactState::default());
    let step = 1.0 / rate;
    (1..=((0.4 + hold) * rate) as usize)
        .map(|i| {
            let displacement = |time: f64| 8e-3 * (time / 0.4).min(1.0);
            let from = f64::from(i as u32 - 1) * step;
            let mut force = 0.0;
            for part in 1..=20 {
                force = contact.step(&model, step / 20.0, displacement(from + step * f64::from(part) / 20.0)).unwrap();
            }
            (from + step, displacement(from + step), force)
        })
        .collect()
}

/// Holds without a displacement were "unloading" after 0.2 s, since a filter lags behind the first moments of a relaxation: 4 of 20 were warned of
/// before the slip at 6 s, of exact forces none.
#[test]
fn a_quick_relaxation_of_a_force_alone_is_no_unloading() {
    for (rate, noise) in [(100.0, 0.02), (100.0, 0.002), (1000.0, 0.02), (20.0, 0.02)] {
        let course = quick(rate, 9.0);
        let slip = course[(6.4 * rate) as usize - 1].2;
        let mut warned = 0;
        for seed in 0..20 {
            let ticks = course.iter().map(|tick| (tick.0, None, tick.2));
            let observed = warnings(ticks, slipping_at(slip), (0.0, noise), seed);
            let before = observed.iter().filter(|observed| (4.9..5.9).contains(&observed.time));
            warned += u32::from(before.clone().any(|observed| observed.slip != Slip::None));
        }
        println!("{rate} Hz, {noise} N: warned in time of {warned}");
        assert!(warned >= 18, "{rate} {noise}: {warned}");
    }
}

/// In its first moments a hold that never slips was about to, in 16 of 20 at 1 kHz.
#[test]
fn a_hold_that_never_slips_is_not_about_to_in_its_first_moments() {
    let body = model().specimen;
    let place = body.contact_displacement(8e-3);
    let slip = 0.9 * body.force(body.equilibrium_strain(place), place);
    for (rate, noise) in [(1000.0, 0.02), (100.0, 0.02), (100.0, 0.1)] {
        let course = quick(rate, 8.0);
        let warned = (0..20).filter(|seed| {
            let ticks = course.iter().map(|tick| (tick.0, Some(tick.1), tick.2));
            let observed = warnings(ticks, slipping_at(slip), (2e-6, noise), *seed);
            observed.iter().any(|observed| observed.time > 0.4 && observed.slip != Slip::None)
        });
        let warned = warned.count();
        println!("{rate} Hz, {noise} N: {warned}");
        assert!(warned <= 3, "{rate} {noise}: {warned}");
    }
}

/// Under 50 µm of noise the beginning of a hold was that of the last part of its ramp: 122 of 150 equilibria were within their intervals.
#[test]
fn a_noisy_displacement_does_not_put_the_ramp_into_the_hold() {
    let body = model().specimen;
    let place = body.contact_displacement(8e-3);
    let equilibrium = body.force(body.equilibrium_strain(place), place);
    let course = quick(100.0, 5.0);
    let seeds = crate::repeats::repeats(60, 300);
    let inside = (0..seeds).filter(|seed| {
        let ticks = course.iter().map(|tick| (tick.0, Some(tick.1), tick.2));
        let observed = warnings(ticks, slipping_at(1.0), (5e-5, 0.02), *seed);
        let found = observed.last().unwrap().equilibrium_force;
        found.is_some_and(|found| (found.value - equilibrium).abs() < 1.96 * error(found))
    });
    let inside = inside.count() as u64;
    println!("inside {inside} of {seeds}");
    assert!(inside >= least_inside(seeds), "{inside} of {seeds}");
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

/// What falls out of a jaw that stands is lost: no phase of a contact is left to warn in. The second reading without a force tells.
#[test]
fn what_is_lost_from_a_jaw_that_stands_has_slipped() {
    let ticks = slow().into_iter().map(|(time, jaw, force)| (time, Some(jaw), if time > 5.0 { 0.0 } else { force }));
    let observed = warnings(ticks, slipping_at(1.5), (2e-6, 0.01), 3);
    assert!(observed.iter().all(|observed| (observed.time > 5.015) == (observed.slip == Slip::Slipping)));
}

/// One reading of nothing was "slipping" and the end of the hold.
#[test]
fn one_reading_without_a_force_is_no_slip_and_ends_no_hold() {
    for sees_jaw in [true, false] {
        for strange in [0.0, 50.0] {
            let ticks = slow().into_iter().enumerate().map(|(index, (time, jaw, force))| {
                (time, sees_jaw.then_some(jaw), if index == 500 { strange } else { force })
            });
            let observed = warnings(ticks, slipping_at(1.0), (2e-6, 0.01), 4);
            assert!(observed.iter().all(|observed| observed.slip == Slip::None), "{sees_jaw} {strange}");
            let began = observed.iter().filter(|observed| observed.began).count();
            assert_eq!(began, 1, "{sees_jaw} {strange}");
        }
    }
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
