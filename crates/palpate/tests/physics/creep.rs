//! The contact under a force: golden numbers, recovery, limits.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::contact::{Curve, Layers, RateDependence, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{
    ContactEventKind, ContactModel, ContactRef, ForceHistory, LinearContact, LinearLaw, Memory, Motion, ProgramStep,
    ProtocolStep as ProtocolMotion, Sampling, Separation, SimulateError, Trajectory, protocol, simulate, step_ends,
    strain_wave,
};

fn ball(exponent: f64, rate_coefficient: f64, layers: f64) -> ContactModel {
    ContactModel {
        specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap(),
        law: LatencyLaw::new(exponent, rate_coefficient).unwrap(),
        layers: Layers::new(layers).unwrap(),
        separation: Separation::Unilateral,
    }
}

fn history(knots: &[(f64, f64)]) -> ForceHistory {
    let (times, forces) = knots.iter().copied().unzip();
    ForceHistory::new(times, forces).unwrap()
}

fn under(knots: &[(f64, f64)], model: &ContactModel, times: &[f64]) -> Trajectory {
    simulate(&history(knots), model, &Sampling::Times(times.to_vec())).unwrap()
}

#[test]
fn creep_of_the_papers_ball() {
    let squeeze = [(0.0, 0.0), (1.0, 10.0), (1e9, 10.0)];
    let result = under(&squeeze, &ball(5.0, 2e4, 8.0), &[1.0, 5.0, 11.0, 61.0, 1e9]);
    let golden = [5.882_987_117_3e-3, 6.975_093_541_1e-3, 7.165_640_154_1e-3, 7.453_005_345_3e-3];
    for (found, expected) in result.contact_displacement.iter().zip(golden) {
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
    // E (u/r) A(u) = 10 N
    let excess = result.excess_strain[4];
    assert!((result.contact_displacement[4] - 8.011_710_421_1e-3).abs() < 0.035 * excess, "{excess}");
    assert!(excess > 0.0 && excess < 2e-3);
}

#[test]
fn of_no_force_a_dent_recovers_as_a_free_surface_does() {
    let model = ball(5.0, 2e4, 8.0);
    let result =
        under(&[(0.0, 0.0), (1.0, 10.0), (61.0, 10.0), (61.0, 0.0), (1061.0, 0.0)], &model, &[61.0, 161.0, 1061.0]);
    let dent = result.contact_displacement[0];
    assert!(dent > 5e-3 && result.force[0] == 0.0 && result.strain[0].abs() < 1e-15);
    let recovery = LatencyLaw::new(5.0, 2e4 / 8.0).unwrap();
    for (elapsed, found) in [(100.0, result.contact_displacement[1]), (1000.0, result.contact_displacement[2])] {
        let expected = 0.035 * recovery.excess_after(dent / 0.035, elapsed);
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
}

/// The force that a motion brings forth, imposed, brings back the motion.
#[test]
fn force_and_displacement_are_two_ways_to_say_the_same() {
    let prism = Shape::Prism {
        area: 1e-3,
        length: 0.07,
    };
    for shape in [Shape::Ball { radius: 0.035 }, prism] {
        for (exponent, rate) in [(1.0, 2.0), (2.0, 50.0), (5.0, 2e4)] {
            let model = ContactModel {
                specimen: Specimen::new(shape.clone(), 28e3, Sides::Two).unwrap(),
                ..ball(exponent, rate, 8.5)
            };
            // Fine enough that straight pieces of force stand for the bent one.
            let motion = Motion::new(vec![0.0, 2.0, 6.0], vec![0.0, 0.02, 0.02]).unwrap();
            let times: Vec<f64> = (0..=12_000).map(|i| 5e-4 * f64::from(i)).collect();
            let moved = simulate(&motion, &model, &Sampling::Times(times.clone())).unwrap();
            let force = ForceHistory::new(times.clone(), moved.force.clone()).unwrap();
            let pressed = simulate(&force, &model, &Sampling::Times(times)).unwrap();
            let far = (1..12_001).map(|i| (pressed.displacement[i] - moved.displacement[i]).abs()).fold(0.0, f64::max);
            assert!(far < 2e-7, "{shape:?} n = {exponent}: {far:e} m");
        }
    }
}

#[test]
fn rates_are_the_slopes_of_what_they_belong_to() {
    let model = ball(3.0, 500.0, 8.0);
    let knots = [(0.0, 0.0), (1.0, 8.0), (4.0, 8.0), (6.0, 2.0), (9.0, 2.0)];
    let h = 1e-5;
    for t in [0.3, 0.9, 1.5, 3.0, 4.5, 5.9, 7.0] {
        let result = under(&knots, &model, &[t - h, t, t + h]);
        let slope = (result.strain[2] - result.strain[0]) / (2.0 * h);
        assert!((result.strain_rate[1] / slope - 1.0).abs() < 1e-5, "t = {t}: {} {slope}", result.strain_rate[1]);
    }
}

#[test]
fn one_layer_is_elastic_under_a_force() {
    let result = under(&[(0.0, 5.0), (10.0, 5.0)], &ball(5.0, 2e4, 1.0), &[0.0, 10.0]);
    assert_eq!(result.contact_displacement[0], result.contact_displacement[1]);
    let u = result.contact_displacement[0];
    assert!((ball(5.0, 2e4, 1.0).specimen.force(u / 0.035, u) - 5.0).abs() < 1e-12);
}

#[test]
fn stiff_and_lazy_laws_creep_to_the_same_place() {
    // E (u/r) A(u) = 10 N whatever the law, once it is over.
    for (exponent, rate) in [(0.5, 5.0), (1.0, 1e-2), (1.0, 1e9), (1.5, 1e3), (3.0, 1e12)] {
        let result = under(&[(0.0, 10.0), (1e6, 10.0)], &ball(exponent, rate, 8.0), &[0.0, 1e6]);
        assert!((result.contact_displacement[1] - 8.011_710_421_1e-3).abs() < 1e-8, "n = {exponent}");
        assert!(result.work.steps < 400, "n = {exponent}, v = {rate}: {:?}", result.work);
    }
}

#[test]
fn the_contact_layer_of_the_wave_carries_the_force() {
    let model = ball(5.0, 2e4, 8.0);
    let squeeze = history(&[(0.0, 0.0), (1.0, 10.0), (11.0, 10.0), (11.0, 4.0), (20.0, 4.0)]);
    let times = Sampling::Times((1..=40).map(|i| 0.5 * f64::from(i)).collect());
    let wave = strain_wave(&squeeze, &model, &times).unwrap();
    let result = simulate(&squeeze, &model, &times).unwrap();
    for i in 0..40 {
        assert!((wave.strain[0][i] - result.strain[i]).abs() < 1e-9, "{i}");
        assert!((wave.displacement[0][i] - result.contact_displacement[i]).abs() < 1e-12, "{i}");
    }
}

#[test]
fn forces_that_no_indentation_carries_are_refused() {
    let model = ball(5.0, 2e4, 8.0);
    let all = Sampling::Rate(10.0);
    let run = |knots: &[(f64, f64)], model: &ContactModel| simulate(&history(knots), model, &all);
    // All of it pressed flat carries E π r² = 107.8 N in the long run, eight times that at once.
    let Err(SimulateError::Force { time, force }) = run(&[(0.0, 0.0), (100.0, 200.0)], &model) else {
        panic!("200 N carried");
    };
    assert!(time > 50.0 && time < 100.0 && (force - 2.0 * time).abs() < 1e-9, "{time} {force}");
    assert!(matches!(run(&[(0.0, 1e3), (1.0, 1e3)], &model), Err(SimulateError::Force { time: 0.0, .. })));
    let pulled = run(&[(0.0, 0.0), (1.0, -1.0)], &model);
    assert!(matches!(pulled, Err(SimulateError::Tension { bonded: false, .. })));
    let bonded = ContactModel {
        separation: Separation::Bonded,
        ..model
    };
    assert!(matches!(run(&[(0.0, 0.0), (1.0, -1.0)], &bonded), Err(SimulateError::Tension { bonded: true, .. })));
}

#[test]
fn a_force_held_beyond_what_the_body_carries_for_long_breaks_off_when_it_gives_way() {
    // 150 N are carried at once, but not by what is left when the layers behind have followed.
    let result = simulate(&history(&[(0.0, 150.0), (1e6, 150.0)]), &ball(5.0, 2e4, 8.0), &Sampling::Rate(1e-4));
    let Err(SimulateError::Force { time, force }) = result else {
        panic!("{result:?}");
    };
    assert!(time > 0.0 && time < 1e6 && force == 150.0, "{time}");
}

/// "Squeeze to 10 N at 50 mm/min, hold position 30 s, hold force 30 s, release."
#[test]
fn a_mixed_program_switches_when_targets_are_met() {
    let model = ball(5.0, 2e4, 8.0);
    let rate = 0.05 / 60.0;
    let program = [
        ProgramStep::MoveToForce { force: 10.0, rate },
        ProgramStep::HoldPosition { duration: 30.0 },
        ProgramStep::HoldForce { duration: 30.0 },
        ProgramStep::Press { to: 2.0, rate: 1.0 },
        ProgramStep::MoveToForce { force: 6.0, rate },
        ProgramStep::MoveToForce { force: 1.0, rate },
        ProgramStep::Move { to: 0.0, rate },
    ];
    let result = simulate(&program, &model, &Sampling::Rate(1.0)).unwrap();
    let ends = step_ends(&program, &model).unwrap();
    for (end, expected) in ends.iter().zip([10.0, f64::NAN, f64::NAN, 2.0, 6.0, 1.0, 0.0]) {
        assert!(expected.is_nan() || (end.force - expected).abs() < 1e-11, "{end:?} {expected}");
    }
    assert_eq!(ends[1].displacement, ends[0].displacement);
    assert!((ends[2].force - ends[1].force).abs() < 1e-12 && ends[2].displacement > ends[1].displacement);
    assert!(result.events.len() == 1 && result.events[0].kind == ContactEventKind::Lost);

    // Position steps alone are a motion: the first two, done so.
    let to = ends[0].displacement;
    let motion = protocol(&[ProtocolMotion { to, rate, hold: 30.0 }]).unwrap();
    let moved = simulate(&motion, &model, &Sampling::Times(vec![ends[0].time, ends[0].time + 30.0])).unwrap();
    assert!((moved.force[0] - 10.0).abs() < 1e-10 && (moved.force[1] - ends[1].force).abs() < 1e-10);

    // Samples at the rate, and at the ends of steps; the last of them is the end of the program.
    assert_eq!(*result.time.last().unwrap(), ends[6].time);
    for end in &ends {
        let at = result.time.iter().position(|time| *time == end.time).unwrap();
        assert!((result.displacement[at] - end.displacement).abs() < 1e-15);
    }
    let wave = strain_wave(&program, &model, &Sampling::Times(result.time.clone())).unwrap();
    for i in 0..result.len() {
        assert!(
            (wave.strain[0][i] - result.strain[i]).abs() < 1e-8,
            "{i}: {} {}",
            wave.strain[0][i],
            result.strain[i]
        );
    }
}

#[test]
fn programs_that_cannot_be_run_say_which_step() {
    let model = ball(5.0, 2e4, 8.0);
    let run = |program: &[ProgramStep]| simulate(program, &model, &Sampling::Rate(1.0)).map(|_| ());
    assert_eq!(run(&[]), Err(SimulateError::EmptyProgram));
    let squeeze = |force| ProgramStep::MoveToForce { force, rate: 0.01 };
    let Err(SimulateError::Unreachable { step: 1, most, .. }) = run(&[squeeze(1e4)]) else {
        panic!("10 kN reached");
    };
    assert!(most > 100.0 && most < 1e3, "{most}");
    let zero = ProgramStep::Press { to: 1.0, rate: 0.0 };
    assert!(matches!(run(&[squeeze(1.0), zero]), Err(SimulateError::StepNumber { step: 2, .. })));
    let never = ProgramStep::HoldForce { duration: f64::NAN };
    assert!(matches!(run(&[never]), Err(SimulateError::StepNumber { step: 1, .. })));
    let off = [squeeze(5.0), ProgramStep::Move { to: -0.01, rate: 0.1 }, ProgramStep::Press { to: 1.0, rate: 1.0 }];
    assert!(matches!(run(&off), Err(SimulateError::NoContact { step: 3, .. })));
    // Moving to a force meets the surface again.
    assert!(run(&[off[0], off[1], squeeze(1.0)]).is_ok());
    assert!(matches!(run(&[squeeze(-1.0)]), Err(SimulateError::Tension { .. })));
    let deep = ProgramStep::Move { to: 0.08, rate: 0.1 };
    assert!(matches!(run(&[deep]), Err(SimulateError::Displacement { .. })));
}

/// Let go until no force is left and watch: to rounding, that force came back as one that nothing carries.
#[test]
fn a_force_let_down_to_nothing_can_be_kept() {
    for separation in [Separation::Unilateral, Separation::Bonded] {
        let model = ContactModel {
            separation,
            ..ball(5.0, 2e4, 8.0)
        };
        for i in 1..60 {
            let force = 0.37 * f64::from(i);
            let rate = 1e-3;
            let program = [
                ProgramStep::MoveToForce { force, rate },
                ProgramStep::HoldPosition { duration: 2.0 },
                ProgramStep::MoveToForce { force: 0.0, rate },
                ProgramStep::HoldForce { duration: 4.0 },
                ProgramStep::Press { to: force, rate: 3.0 },
                ProgramStep::HoldForce { duration: 1.0 },
                ProgramStep::MoveToForce { force, rate },
                ProgramStep::Press { to: force, rate: 3.0 },
                ProgramStep::Press { to: 0.0, rate: 3.0 },
                ProgramStep::HoldForce { duration: 4.0 },
            ];
            let ends = step_ends(&program, &model).unwrap_or_else(|error| panic!("{force} N: {error}"));
            let forces: Vec<f64> = ends.iter().map(|end| end.force).collect();
            assert!(
                forces[0] == force && forces[2..4] == [0.0; 2] && forces[4..8] == [force; 4] && forces[8..] == [0.0; 2]
            );
            assert!(ends[3].displacement < ends[2].displacement);
            // Where the force is already, nothing happens.
            assert_eq!((ends[6].time, ends[7].time), (ends[5].time, ends[5].time));
            let series = simulate(&program, &model, &Sampling::Rate(20.0)).unwrap();
            assert!(series.force.iter().all(|force| force.is_finite()) && series.events.is_empty());
        }
    }
}

#[test]
fn a_program_that_takes_no_time_is_none() {
    let model = ball(5.0, 2e4, 8.0);
    let program = [ProgramStep::MoveToForce { force: 0.0, rate: 1e-3 }, ProgramStep::Press { to: 0.0, rate: 1.0 }];
    assert_eq!(simulate(&program, &model, &Sampling::Rate(1.0)), Err(SimulateError::EmptyProgram));
}

#[test]
fn a_law_too_fast_for_a_slow_change_says_so_in_time() {
    let slow = history(&[(0.0, 0.0), (1000.0, 10.0), (2000.0, 10.0)]);
    let result = simulate(&slow, &ball(1.0, 1e8, 8.0), &Sampling::Rate(1.0));
    assert!(matches!(result, Err(SimulateError::TooStiff { .. })), "{result:?}");
}

#[test]
fn a_motion_of_a_million_knots_is_followed() {
    let model = palpate::test_problems::paper_ball(Separation::Unilateral);
    let times: Vec<f64> = (0..1_000_000).map(|i| 1e-3 * f64::from(i)).collect();
    // A tremble of 0.2 mm on a squeeze of 10 mm: a kink at every millisecond.
    let displacement = |t: &f64| 0.01 * (t / 500.0).min(1.0) + 1e-4 * (40.0 * t).sin() * (t / 500.0).min(1.0);
    let displacements: Vec<f64> = times.iter().map(displacement).collect();
    let motion = Motion::new(times, displacements).unwrap();
    let force = palpate::simulate::simulate_force(&motion, &model, &[250.0, 500.0, motion.end()]).unwrap();
    assert!(force.iter().all(|force| force.is_finite() && *force > 0.0) && force[2] < force[1], "{force:?}");
}

/// from + (to − from)/duration · t is not `to` at the end, but for rounding: below 0 N by it, nothing would carry the force.
#[test]
fn a_force_let_down_to_nothing_ends_at_nothing() {
    let area = Curve::new(&[(0.0, 0.3e-4), (4e-3, 0.4e-4)]).unwrap();
    let profile = Specimen::new(Shape::Profile { depth: 8e-3, area }, 4e4, Sides::One).unwrap();
    for separation in [Separation::Bonded, Separation::Unilateral] {
        let latency = ContactModel {
            specimen: profile.clone(),
            law: LatencyLaw::new(2.0, 10.0).unwrap(),
            layers: Layers::new(5.0).unwrap(),
            separation,
        };
        let linear = LinearContact {
            specimen: profile.clone(),
            law: LinearLaw::standard(4.0, 1.0).unwrap(),
            memory: Memory::Strain,
            separation,
        };
        for i in 1..300 {
            let (force, rate) = (1e-3 * f64::from(i), 0.1 + 0.017 * f64::from(i % 29));
            let program = [
                ProgramStep::HoldPosition {
                    duration: 0.37 * f64::from(i % 7) + 0.1,
                },
                ProgramStep::Press { to: force, rate },
                ProgramStep::Press { to: 0.0, rate },
                ProgramStep::HoldForce { duration: 1.0 },
            ];
            for ends in [step_ends(&program, &latency), step_ends(&program, &linear)] {
                let ends = ends.unwrap_or_else(|error| panic!("{force} N at {rate} N/s: {error}"));
                assert!(ends[1].force == force && ends[2].force == 0.0 && ends[3].displacement > 0.0);
            }
        }
    }
}

/// A move to a force was divided over all that the jaw may travel: with v that depends on the strain it ended 1.6 % of the peak away.
#[test]
fn a_move_to_a_force_ends_where_the_same_motion_has_that_force() {
    let block = ContactModel {
        specimen: Specimen::new(
            Shape::Prism {
                area: 4e-4,
                length: 0.06,
            },
            1e5,
            Sides::One,
        )
        .unwrap(),
        law: LatencyLaw::new(5.0, 2e4).unwrap(),
        layers: Layers::new(8.0).unwrap(),
        separation: Separation::Bonded,
    };
    for factor in [0.3, 0.6, 0.95] {
        let contact = ContactRef::Latency(&block, RateDependence::Strain { factor });
        let head = [ProgramStep::Move { to: 0.015, rate: 0.008 }, ProgramStep::HoldPosition { duration: 5.0 }];
        let ends = step_ends(&head, contact).unwrap();
        for share in [0.2, 0.8, 1.3] {
            let force = share * ends[1].force;
            let moved = [&head[..], &[ProgramStep::MoveToForce { force, rate: 0.008 }]].concat();
            let to = step_ends(&moved, contact).unwrap()[2].displacement;
            let steps = (1..=40).map(|part| ProgramStep::Move {
                to: 0.015 + (to - 0.015) * f64::from(part) / 40.0,
                rate: 0.008,
            });
            let stepped: Vec<ProgramStep> = head.iter().copied().chain(steps).collect();
            let off = (step_ends(&stepped, contact).unwrap().last().unwrap().force - force) / ends[0].force;
            assert!(off.abs() < 1e-4, "{factor} {share}: {off}");
        }
    }
}
