//! A contact watched tick by tick: what is found, when, and how often intervals contain the truth.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

mod controlled;
mod material;
mod warnings;

use material::material;
use palpate::fit::Estimate;
use palpate::grip::TimeToSlip;
use palpate::observe::{ContactPhase, Held, Observation, ObserveError, Observer, ObserverOptions, Slip, SlipForecast};
use palpate::simulate::{ContactModel, ContactState, Separation};
use palpate::test_problems::{Rng, paper_ball};

use crate::repeats::repeats;

const RATE: f64 = 500.0;

const NEVER: SlipForecast = SlipForecast::Known {
    best: TimeToSlip::Never,
    low: TimeToSlip::Never,
    high: TimeToSlip::Never,
};

/// Standard error of what an observer says.
fn error(estimate: Estimate) -> f64 {
    estimate.standard_error.unwrap()
}
/// The least of `count` intervals of 95 % that must hold the truth: 2.2 standard deviations below the number expected.
fn least_inside(count: u64) -> u64 {
    let count = count as f64;
    (0.95 * count - 2.2 * (0.95 * 0.05 * count).sqrt()).floor() as u64
}

/// When the jaw stops, s: 5 mm at 500 mm/min.
const STOP: f64 = 0.6;

fn model() -> ContactModel {
    paper_ball(Separation::Unilateral)
}

/// Times, displacements and forces without noise: a squeeze and a hold of `hold` s.
fn squeeze(hold: f64) -> Vec<(f64, f64, f64)> {
    let (model, mut contact, mut last) = (model(), ContactState::default(), 0.0);
    (1..=((STOP + hold) * RATE) as usize)
        .map(|i| {
            let time = i as f64 / RATE;
            let displacement = 5e-3 * (time / STOP).min(1.0);
            let force = contact.step(&model, time - last, displacement).unwrap();
            last = time;
            (time, displacement, force)
        })
        .collect()
}

/// What is observed of it with 0.05 N and 1 µm of noise.
fn watched(course: &[(f64, f64, f64)], seed: u64, options: &ObserverOptions) -> Vec<Observation> {
    let (mut observer, mut noise) = (Observer::new(options.clone()).unwrap(), Rng::new(seed));
    let see = |(time, displacement, force): &(f64, f64, f64)| {
        let displacement = displacement + 1e-6 * noise.normal();
        observer.feed(*time, Some(displacement), force + 0.05 * noise.normal()).unwrap()
    };
    course.iter().map(see).collect()
}

/// The same with noise of the force that correlates as AR(1).
fn watched_with_drift(course: &[(f64, f64, f64)], rho: f64, seed: u64, options: &ObserverOptions) -> Observation {
    let (mut observer, mut random) = (Observer::new(options.clone()).unwrap(), Rng::new(seed));
    let mut noise = random.normal();
    let mut last = None;
    for (time, displacement, force) in course {
        noise = rho * noise + (1.0 - rho * rho).sqrt() * random.normal();
        let displacement = displacement + 1e-6 * random.normal();
        last = Some(observer.feed(*time, Some(displacement), force + 0.05 * noise).unwrap());
    }
    last.unwrap()
}

fn slipping_at(slip_force: f64) -> ObserverOptions {
    ObserverOptions {
        slip_force: Some(slip_force),
        ..ObserverOptions::default()
    }
}

/// Force of the hold `after` s.
fn force_after(after: f64) -> f64 {
    squeeze(after).last().unwrap().2
}

#[test]
fn a_hold_is_reported_within_a_few_ticks_and_once() {
    let course = squeeze(20.0);
    for seed in 0..100 {
        let observed = watched(&course, seed, &ObserverOptions::default());
        let began: Vec<&Observation> = observed.iter().filter(|observed| observed.began).collect();
        assert_eq!(began.len(), 1, "{seed}: {began:?}");
        assert!(began[0].time > STOP && began[0].time - STOP < 10.5 / RATE, "{seed}: {}", began[0].time);
        assert!((began[0].held_since.unwrap() - STOP).abs() < 2.5 / RATE, "{seed}: {began:?}");
        assert_eq!(began[0].held, Some(Held::Displacement));
        assert!(
            observed
                .iter()
                .all(|observed| (observed.time >= began[0].time) == (observed.phase == ContactPhase::Holding)),
            "{seed}"
        );
    }
}

#[test]
fn the_equilibrium_and_its_deviation_are_honest() {
    let course = squeeze(60.0);
    // 28 kPa, ball of 35 mm between two plates at 5 mm, relaxed.
    let truth = {
        let mut contact = ContactState::default();
        contact.step(&model(), 1.0, 5e-3).unwrap();
        contact.step(&model(), 1e15, 5e-3).unwrap()
    };
    let (mut inside, mut reported) = (0, 0);
    for seed in 0..200 {
        let observed = watched(&course, seed, &ObserverOptions::default());
        for after in [2.0, 10.0, 60.0] {
            let observed = &observed[((STOP + after) * RATE) as usize - 1];
            if let Some(found) = observed.equilibrium_force {
                reported += 1;
                inside += i32::from((found.value - truth).abs() < 1.96 * error(found));
                assert!(after < 60.0 || error(found) < 0.05 * truth, "{seed}: {found:?}");
            }
        }
    }
    let share = f64::from(inside) / f64::from(reported);
    println!("equilibrium inside in {share} of {reported}");
    assert!(reported > 300 && (0.9..0.995).contains(&share), "{share} of {reported}");
}

#[test]
fn intervals_of_the_time_to_slip_contain_the_truth_as_often_as_they_say() {
    for slip_after in [3.0, 30.0] {
        let course = squeeze(slip_after);
        let options = slipping_at(force_after(slip_after));
        for after in [0.1, 0.3, 1.0, 2.5, 10.0, 25.0] {
            if after >= slip_after {
                continue;
            }
            let (mut inside, mut open, seeds) = (0, 0, repeats(60, 300));
            for seed in 0..seeds {
                let until = ((STOP + after) * RATE) as usize;
                let observed = watched(&course[..until], 1000 + seed, &options);
                let truth = STOP + slip_after - observed.last().unwrap().time;
                match observed.last().unwrap().time_to_slip.unwrap() {
                    SlipForecast::Known {
                        low: TimeToSlip::After(low),
                        high,
                        ..
                    } => {
                        open += u64::from(high == TimeToSlip::Never);
                        inside += u64::from(low <= truth * 1.001 && high.covers(truth / 1.001));
                    }
                    SlipForecast::Unknown => inside += 1,
                    SlipForecast::Known { .. } => {}
                }
            }
            println!(
                "slip {slip_after} s after the stop, observed at {after} s: inside {inside} of {seeds}, open {open}"
            );
            assert!(inside >= least_inside(seeds), "{slip_after} {after}: {inside} of {seeds}");
        }
    }
}

#[test]
fn the_warning_comes_before_slip() {
    for slip_after in [0.3, 3.0, 30.0] {
        let course = squeeze(slip_after);
        let options = slipping_at(force_after(slip_after));
        let (mut early, mut all) = (0.0, 0.0);
        for seed in 0..100 {
            let observed = watched(&course, seed, &options);
            let holding = || observed.iter().filter(|observed| observed.phase == ContactPhase::Holding);
            let first = holding().find(|observed| observed.slip != Slip::None).unwrap().time;
            // The lower end of an interval of 95 % comes after the truth in every fortieth.
            let due = STOP + slip_after - 0.8 * options.warn_before;
            assert!(first < STOP + slip_after, "{slip_after} {seed}: {first}");
            for observed in holding() {
                all += 1.0;
                early += f64::from(u8::from(observed.time < due - 2.0 && observed.slip != Slip::None));
                assert!(
                    observed.time < due || observed.slip != Slip::None || observed.time < STOP + 0.1,
                    "{slip_after} {seed}: {observed:?}"
                );
            }
        }
        if slip_after > 20.0 {
            assert!(early < 0.05 * all);
        }
        println!("slip after {slip_after} s: warned much too early in {:.4} of ticks", early / all);
    }
}

#[test]
fn an_equilibrium_above_slip_is_never_and_below_is_not() {
    let course = squeeze(60.0);
    let last = |slip: f64| *watched(&course, 3, &slipping_at(slip)).last().unwrap();
    let relaxed = last(0.1).equilibrium_force.unwrap().value;
    assert_eq!(last(0.5 * relaxed).time_to_slip, Some(NEVER));
    assert!(matches!(
        last(1.05 * relaxed).time_to_slip,
        Some(SlipForecast::Known {
            low: TimeToSlip::After(_),
            ..
        })
    ));
    assert_eq!(last(0.5 * relaxed).slip, Slip::None);
    assert_eq!(last(2.0).slip, Slip::Slipping);
}

#[test]
fn a_force_that_is_held_creeps_and_never_slips() {
    let (model, mut contact, mut noise) = (model(), ContactState::default(), Rng::new(5));
    let mut observer = Observer::new(slipping_at(1.0)).unwrap();
    let (mut began, mut last, mut displacement, mut before) = (0, None, 0.0, 0.0);
    for i in 1..=8000 {
        let time = f64::from(i) / RATE;
        let force = (4.0 * time).min(3.0);
        before = if i == 7500 { displacement } else { before };
        displacement = contact.step_force(&model, 1.0 / RATE, force).unwrap();
        let observed = observer
            .feed(time, Some(displacement + 1e-6 * noise.normal()), force + 0.01 * noise.normal())
            .unwrap();
        began += i32::from(observed.began);
        last = Some(observed);
    }
    let observed = last.unwrap();
    assert_eq!((observed.phase, observed.held, began), (ContactPhase::Holding, Some(Held::Force), 1));
    assert_eq!((observed.time_to_slip, observed.slip), (Some(NEVER), Slip::None));
    let (creep, truth) = (observed.creep_rate.unwrap(), (displacement - before) * RATE / 500.0);
    // the line goes through the later half, over which the creep slows down
    assert!((creep.value / truth - 1.0).abs() < 0.6 && error(creep) < 0.1 * truth, "{creep:?} {truth}");
}

#[test]
fn unloading_and_a_second_squeeze_are_reported_apart() {
    let way = |time: f64| match time {
        t if t < 0.6 => t / 0.12,
        t if t < 5.0 => 5.0,
        t if t < 5.6 => 5.0 - (t - 5.0) / 0.12,
        t if t < 7.0 => 0.0,
        t if t < 7.6 => (t - 7.0) / 0.12,
        _ => 5.0,
    };
    let (model, mut contact, mut noise) = (model(), ContactState::default(), Rng::new(1));
    let mut observer = Observer::new(ObserverOptions::default()).unwrap();
    let mut observed = Vec::new();
    for i in 1..=6000 {
        let time = f64::from(i) / RATE;
        let force = contact.step(&model, 1.0 / RATE, 1e-3 * way(time)).unwrap();
        let displacement = 1e-3 * way(time) + 1e-6 * noise.normal();
        observed.push(observer.feed(time, Some(displacement), force + 0.05 * noise.normal()).unwrap());
    }
    let at = |time: f64| observed[(time * RATE) as usize].phase;
    assert_eq!(
        [0.3, 2.0, 5.04, 6.5, 7.55, 11.0].map(at),
        [
            ContactPhase::Loading,
            ContactPhase::Holding,
            ContactPhase::Unloading,
            ContactPhase::Free,
            ContactPhase::Loading,
            ContactPhase::Holding
        ]
    );
    assert_eq!(observed.iter().filter(|observed| observed.began).count(), 2);
}

#[test]
fn a_force_without_displacement_is_enough_for_a_squeeze_and_a_hold() {
    for seed in 0..50 {
        let mut noise = Rng::new(seed);
        let mut observer = Observer::new(slipping_at(1.0)).unwrap();
        let mut last = None;
        let mut began = Vec::new();
        for (time, _, force) in squeeze(20.0) {
            let observed = observer.feed(time, None, force + 0.02 * noise.normal()).unwrap();
            began.extend(observed.began.then_some(time));
            last = Some(observed);
        }
        assert_eq!(began.len(), 1, "{seed}: {began:?}");
        assert!(began[0] - STOP < 0.15, "{seed}: {began:?}");
        assert!(last.unwrap().equilibrium_force.is_some());
    }
}

#[test]
fn bad_ticks_are_refused_and_change_nothing() {
    let course = squeeze(2.0);
    let mut observer = Observer::new(slipping_at(1.0)).unwrap();
    for (time, displacement, force) in &course {
        observer.feed(*time, Some(*displacement), *force).unwrap();
    }
    let before = format!("{observer:?}");
    for (time, displacement, force) in [
        (f64::NAN, Some(5e-3), 2.0),
        (9.0, Some(f64::INFINITY), 2.0),
        (9.0, Some(5e-3), f64::NAN),
        (2.6, Some(5e-3), 2.0),
        (1.0, Some(5e-3), 2.0),
    ] {
        let refused = observer.feed(time, displacement, force).unwrap_err();
        assert!(!refused.to_string().is_empty() && !refused.hint().is_empty());
    }
    assert_eq!(before, format!("{observer:?}"));
    for options in [
        ObserverOptions {
            exponent: 0.5,
            ..ObserverOptions::default()
        },
        slipping_at(0.0),
        slipping_at(f64::NAN),
        ObserverOptions {
            exponent_standard_error: f64::NAN,
            ..ObserverOptions::default()
        },
        ObserverOptions {
            warn_before: -1.0,
            ..ObserverOptions::default()
        },
        ObserverOptions {
            confidence: 1.0,
            ..ObserverOptions::default()
        },
        ObserverOptions {
            noise: Some((0.0, 0.0)),
            ..ObserverOptions::default()
        },
    ] {
        assert!(matches!(Observer::new(options), Err(ObserveError::Option { .. })));
    }
}

#[test]
fn a_gap_in_a_hold_is_bridged() {
    let course = squeeze(60.0);
    let (mut observer, mut noise) = (Observer::new(slipping_at(1.0)).unwrap(), Rng::new(2));
    let (mut began, mut last) = (0, None);
    for (time, displacement, force) in course.iter().filter(|(time, ..)| !(5.0..45.0).contains(time)) {
        let observed = observer.feed(*time, Some(*displacement), force + 0.05 * noise.normal()).unwrap();
        began += i32::from(observed.began);
        last = Some(observed);
    }
    let observed = last.unwrap();
    assert_eq!((began, observed.phase), (1, ContactPhase::Holding));
    assert!((observed.force - course.last().unwrap().2).abs() < 0.02);
}

#[test]
fn a_million_ticks_and_strange_ones_stay_finite() {
    let mut observer = Observer::new(slipping_at(1.0)).unwrap();
    let mut noise = Rng::new(9);
    let finite = |observed: &Observation| {
        let pair = |pair: Option<Estimate>| pair.is_none_or(|pair| pair.value.is_finite() && error(pair).is_finite());
        let slip = match observed.time_to_slip {
            Some(SlipForecast::Known { best, low, high }) => {
                [best, low, high].iter().filter_map(|time| time.seconds()).all(f64::is_finite)
            }
            _ => true,
        };
        observed.force.is_finite()
            && slip
            && pair(observed.equilibrium_force)
            && pair(observed.excess_force)
            && pair(observed.creep_rate)
    };
    for i in 1..=1_000_000 {
        let time = 1e-3 * f64::from(i);
        let x = 1.0 + 1.5 / (1.0 + 20.0 * time).powf(0.25);
        let observed =
            observer.feed(time, Some(5e-3 * (time / 0.6).min(1.0)), x * (time / 0.6).min(1.0) + 0.05 * noise.normal());
        assert!(finite(&observed.unwrap()));
        if i == 1_000_000 {
            // n = 5 and λ = 5/s from the start of the record: at 0.6 s, where the hold begins, still a hold of the law.
            let found = observed.unwrap().equilibrium_force.unwrap();
            assert!((found.value - 1.0).abs() < 4.0 * error(found) && error(found) < 1e-3, "{found:?}");
        }
    }
    // A few kilobytes, none of them on the heap without a material.
    assert!(size_of::<Observer>() < 20_000);
    // Constant, stepped, huge and tiny signals.
    let courses: [fn(f64) -> (f64, f64); 6] = [
        |_| (0.0, 0.0),
        |_| (1.0, 1.0),
        |t| (t.floor(), t.floor()),
        |t| (1e300 * t, 1e300),
        |t| (1e-300 * t, -1e-300 * t),
        |t| ((t * 7.0).sin(), (t * 3.0).cos()),
    ];
    for course in courses {
        let mut observer = Observer::new(slipping_at(1.0)).unwrap();
        for i in 1..=3000 {
            let (displacement, force) = course(0.01 * f64::from(i));
            assert!(finite(&observer.feed(0.01 * f64::from(i), Some(displacement), force).unwrap()));
        }
    }
}

#[test]
fn an_observer_goes_on_elsewhere_to_the_last_bit() {
    let course = squeeze(10.0);
    let informed = ObserverOptions {
        material: Some(material(1.03)),
        ..slipping_at(1.7)
    };
    for options in [slipping_at(1.7), informed] {
        for cut in [0, 7, 290, 330, 2000] {
            let (mut here, mut noise) = (Observer::new(options.clone()).unwrap(), Rng::new(1));
            let noisy: Vec<(f64, f64)> =
                course.iter().map(|tick| (tick.1 + 1e-6 * noise.normal(), tick.2 + 0.05 * noise.normal())).collect();
            for index in 0..cut {
                here.feed(course[index].0, Some(noisy[index].0), noisy[index].1).unwrap();
            }
            let bytes = here.to_bytes();
            let mut there = Observer::from_bytes(options.clone(), &bytes).unwrap();
            assert_eq!(there.to_bytes(), bytes);
            for index in cut..course.len() {
                let feed = |one: &mut Observer| one.feed(course[index].0, Some(noisy[index].0), noisy[index].1);
                assert_eq!(feed(&mut here), feed(&mut there), "{cut} {index}");
            }
            assert_ne!(here.to_bytes(), bytes);
            for broken in [&bytes[1..], &bytes[..bytes.len() - 1], &[bytes.as_slice(), &[0]].concat()] {
                assert_eq!(Observer::from_bytes(options.clone(), broken).unwrap_err(), ObserveError::Bytes);
            }
        }
    }
}

/// The last tick of a hold reported of the place where the jaw was by then.
#[test]
fn a_hold_is_reported_of_where_it_was_held_to_its_last_tick() {
    let model = model();
    let (mut contact, mut noise) = (ContactState::default(), Rng::new(6));
    let options = ObserverOptions {
        material: Some(material(1.0)),
        ..ObserverOptions::default()
    };
    let mut observer = Observer::new(options).unwrap();
    let mut held: Option<Observation> = None;
    for tick in 1..=200 {
        // At 20 Hz, 5 mm until 5 s, then on: a tick goes 0.4 mm.
        let time = 0.05 * f64::from(tick);
        let place = if time <= 5.0 { (8.3e-3 * time).min(5e-3) } else { 5e-3 + 8.3e-3 * (time - 5.0) };
        let force = contact.step(&model, 0.05, place.min(20e-3)).unwrap();
        let observed =
            observer.feed(time, Some(place.min(20e-3) + 1e-6 * noise.normal()), force + 0.01 * noise.normal());
        let observed = observed.unwrap();
        if time > 1.5 && time < 5.5 && observed.phase == ContactPhase::Holding {
            if let Some(before) = held {
                let equilibrium = |observed: &Observation| observed.equilibrium_force.unwrap().value;
                assert!((equilibrium(&observed) / equilibrium(&before) - 1.0).abs() < 0.01, "{time}: {observed:?}");
                assert!((observed.force / before.force - 1.0).abs() < 0.03, "{time}: {observed:?} {before:?}");
            }
            held = Some(observed);
        }
    }
    assert!(held.unwrap().time > 4.9);
}

/// At its edge a warning came and went with the noise.
#[test]
fn a_warning_does_not_flutter() {
    let course = squeeze(30.0);
    let mut changes = 0;
    for seed in 0..20 {
        let observed = watched(&course, seed, &slipping_at(1.7));
        let held = observed.iter().filter(|observed| observed.phase == ContactPhase::Holding && observed.time > 1.0);
        let slips: Vec<Slip> = held.map(|observed| observed.slip).collect();
        changes += slips.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert_eq!(slips.last(), Some(&Slip::Slipping));
    }
    // One from none to soon, and one from soon to slipping.
    assert!(changes <= 2 * 20 + 4, "{changes}");
}

/// The fitted force of a law that the readings do not follow fell to that of slip 40 s before they did.
#[test]
fn readings_that_follow_another_law_say_when_slip_is() {
    let force = |held: f64| 4.0 + 6.0 / (1.0 + held).sqrt();
    // n = 3; 4.6 N after 99 s.
    let course: Vec<(f64, f64, f64)> = (1..6000)
        .map(|i| {
            let time = 0.02 * f64::from(i);
            (time, 5e-3 * time.min(1.0), if time < 1.0 { 10.0 * time } else { force(time - 1.0) })
        })
        .collect();
    let (mut observer, mut noise) = (Observer::new(slipping_at(4.6)).unwrap(), Rng::new(5));
    for (time, displacement, force) in &course {
        let found = observer.feed(*time, Some(*displacement), force + 0.01 * noise.normal()).unwrap();
        if *time > 3.0 {
            assert!((found.force - force).abs() < 0.06, "{time} s: {} N, {force} N", found.force);
        }
        assert!(found.slip != Slip::Slipping || *time > 95.0, "{time} s: {found:?}");
        let says_now = matches!(found.time_to_slip, Some(SlipForecast::Known { best: TimeToSlip::After(best), .. }) if best == 0.0);
        assert!(!says_now || found.force <= 4.65, "{time} s: {found:?}");
    }
}

/// The first reading of a ramp after a rest is off the place where the jaw stood, and already carries a force.
#[test]
fn the_first_reading_of_a_ramp_begins_no_hold() {
    let mut observer = Observer::new(slipping_at(5.0)).unwrap();
    let mut noise = Rng::new(8);
    for i in 1..=40 {
        let time = 0.1 * f64::from(i);
        let jaw = 5e-3 * (time - 2.0).clamp(0.0, 1.0);
        let found = observer.feed(time, Some(jaw), 2e3 * jaw + 5e-3 * noise.normal()).unwrap();
        assert!(time > 3.0 || found.phase != ContactPhase::Holding, "{time} s: {found:?}");
    }
}

/// A force of 1e305 N was observed as an infinite one that makes a grip slip.
#[test]
fn a_number_that_no_sensor_shows_is_no_reading() {
    let mut observer = Observer::new(slipping_at(1.0)).unwrap();
    for (displacement, force) in [(1e-3, 1e305), (1e305, 1.0), (1e-3, f64::INFINITY)] {
        let refused = observer.feed(1.0, Some(displacement), force);
        assert!(matches!(refused, Err(ObserveError::NotFinite { .. })), "{refused:?}");
    }
}
