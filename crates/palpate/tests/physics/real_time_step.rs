//! The contact one step at a time: exact holds, second order, any time step, events, save and restore.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactModel, ContactState, ForceHistory, Motion, Sampling, Separation, StepError, simulate};

fn ball(exponent: f64, rate_coefficient: f64, layers: f64, separation: Separation) -> ContactModel {
    ContactModel {
        specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap(),
        law: LatencyLaw::new(exponent, rate_coefficient).unwrap(),
        layers: Layers::new(layers).unwrap(),
        separation,
    }
}

/// Largest difference between forces stepped at `dt` along a motion and those simulated.
fn error(model: &ContactModel, motion: &Motion, steps: usize) -> f64 {
    let times: Vec<f64> = (0..=steps).map(|i| motion.end() * i as f64 / steps as f64).collect();
    let exact = simulate(motion, model, &Sampling::Times(times.clone())).unwrap();
    let mut contact = ContactState::default();
    let mut worst: f64 = 0.0;
    for i in 1..=steps {
        let force = contact.step(model, times[i] - times[i - 1], motion.displacement_at(times[i])).unwrap();
        worst = worst.max((force - exact.force[i]).abs());
    }
    worst
}

#[test]
fn of_second_order_in_ramps() {
    let motion = Motion::new(vec![0.0, 1.0, 2.0, 3.0], vec![0.0, 0.02, 0.005, 0.015]).unwrap();
    for (exponent, rate, layers) in [(1.0, 2.0, 8.0), (2.0, 50.0, 8.5), (5.0, 2e4, 8.0), (3.0, 2e4, 64.0)] {
        let model = ball(exponent, rate, layers, Separation::Bonded);
        let (coarse, fine) = (error(&model, &motion, 3000), error(&model, &motion, 6000));
        let order = (coarse / fine).log2();
        println!("n = {exponent}: {coarse:.1e} N at 1 ms, order {order:.2}");
        assert!((1.8..2.3).contains(&order), "n = {exponent}: {order}");
        assert!(coarse < 2e-3 * 18.0, "{coarse}");
    }
}

#[test]
fn of_second_order_under_a_changing_force() {
    // 2 N at once, then to 9 N and back to 4 N; first touch itself has a root that no step of one width follows.
    let (times, forces) = (vec![0.0, 1.0, 2.0, 3.0], vec![2.0, 9.0, 9.0, 4.0]);
    let history = ForceHistory::new(times, forces).unwrap();
    for (exponent, rate, layers) in [(1.0, 2.0, 8.0), (2.0, 50.0, 8.5), (5.0, 2e4, 8.0)] {
        let model = ball(exponent, rate, layers, Separation::Unilateral);
        let error = |steps: u32| {
            let times: Vec<f64> = (0..=steps).map(|i| 3.0 * f64::from(i) / f64::from(steps)).collect();
            let exact = simulate(&history, &model, &Sampling::Times(times.clone())).unwrap();
            let mut contact = ContactState::default();
            contact.step_force(&model, 0.0, 2.0).unwrap();
            let mut worst: f64 = 0.0;
            for i in 1..times.len() {
                let found = contact.step_force(&model, times[i] - times[i - 1], history.force_at(times[i])).unwrap();
                worst = worst.max((found - exact.displacement[i]).abs());
            }
            worst
        };
        let (coarse, fine) = (error(600), error(1200));
        let order = (coarse / fine).log2();
        println!("n = {exponent}: {coarse:.1e} m at 5 ms, order {order:.2}");
        assert!((1.8..2.3).contains(&order), "n = {exponent}: {order}");
    }
}

#[test]
fn a_hold_is_exact_in_steps_of_any_length() {
    let model = ball(5.0, 2e4, 8.0, Separation::Unilateral);
    let start = {
        let mut contact = ContactState::default();
        contact.step(&model, 0.5, 0.01).unwrap();
        contact
    };
    let mut at_once = start;
    let expected = at_once.step(&model, 100.0, 0.01).unwrap();
    let mut in_steps = start;
    for i in 0..1000 {
        let force = in_steps.step(&model, if i % 2 == 0 { 0.05 } else { 0.15 }, 0.01).unwrap();
        assert!(force >= expected - 1e-12);
    }
    assert!((in_steps.force(&model) - expected).abs() < 1e-11);
}

#[test]
fn no_time_step_is_too_long_or_too_short() {
    for exponent in [0.5, 1.0, 5.0] {
        let model = ball(exponent, 2e4, 512.0, Separation::Unilateral);
        let mut contact = ContactState::default();
        for i in 0..2000u32 {
            let dt = [0.0, 1e-9, 1e-3, 1.0, 1e9][(i % 5) as usize];
            let displacement = 0.03 * f64::from(i % 17) / 17.0;
            let force = contact.step(&model, dt, displacement).unwrap();
            assert!(force.is_finite() && force >= 0.0, "{force}");
            assert!(contact.surface(&model) >= -1e-12 && contact.surface(&model) <= 0.035);
        }
    }
    // The contact layer takes a jump at once: E ε A with all of the travel in one layer.
    let model = ball(5.0, 2e4, 8.0, Separation::Unilateral);
    let force = ContactState::default().step(&model, 0.0, 0.01).unwrap();
    assert!((force - model.specimen.force(0.005 * 8.0 / 0.035, 0.005)).abs() < 1e-12);
}

#[test]
fn contacts_are_lost_and_met_again() {
    let model = ball(5.0, 2e4, 8.0, Separation::Unilateral);
    let motion = Motion::new(vec![0.0, 1.0, 2.0, 4.0, 5.0], vec![0.0, 0.02, 0.0, 0.0, 0.02]).unwrap();
    let (coarse, fine) = (error(&model, &motion, 500), error(&model, &motion, 5000));
    assert!(coarse < 0.05 && fine < 0.02 * coarse, "{coarse} {fine}");
    let mut contact = ContactState::default();
    contact.step(&model, 1.0, 0.02).unwrap();
    assert_eq!(contact.step(&model, 1e-3, -0.01).unwrap(), 0.0);
    let dent = contact.surface(&model);
    assert!(!contact.is_touching(&model) && dent > 0.0);
    contact.step(&model, 1e3, -0.01).unwrap();
    assert!(contact.surface(&model) < dent);
}

#[test]
fn creep_step_by_step() {
    let model = ball(5.0, 2e4, 8.0, Separation::Unilateral);
    let history = ForceHistory::new(vec![0.0, 1.0, 11.0], vec![0.0, 10.0, 10.0]).unwrap();
    let run = |steps: u32| {
        let mut contact = ContactState::default();
        let mut displacement = 0.0;
        for i in 1..=11 * steps {
            let time = f64::from(i) / f64::from(steps);
            displacement = contact.step_force(&model, 1.0 / f64::from(steps), history.force_at(time)).unwrap();
        }
        displacement
    };
    let exact = simulate(&history, &model, &Sampling::Times(vec![11.0])).unwrap().displacement[0];
    let (coarse, fine) = ((run(100) - exact).abs(), (run(200) - exact).abs());
    println!("{coarse:.1e} m at 10 ms, order {:.2}", (coarse / fine).log2());
    assert!(coarse < 1e-7 && fine < 0.4 * coarse, "{coarse:e} {fine:e}");
    // Both ways of stepping share one state.
    let mut contact = ContactState::default();
    let displacement = contact.step_force(&model, 0.5, 10.0).unwrap();
    let force = contact.step(&model, 0.0, displacement).unwrap();
    assert!((force - 10.0).abs() < 1e-11);
    assert!(contact.step(&model, 5.0, displacement).unwrap() < 10.0);
}

#[test]
fn bad_steps_leave_the_state_as_it_was() {
    let model = ball(5.0, 2e4, 8.0, Separation::Unilateral);
    let mut contact = ContactState::default();
    contact.step(&model, 0.5, 0.01).unwrap();
    let before = contact;
    for (dt, displacement) in [(-1.0, 0.01), (f64::NAN, 0.01), (f64::INFINITY, 0.01), (1.0, f64::NAN)] {
        assert!(matches!(contact.step(&model, dt, displacement), Err(StepError::Number { .. })));
    }
    assert!(matches!(contact.step(&model, 1.0, 0.08), Err(StepError::Displacement(_))));
    assert!(matches!(contact.step_force(&model, 1.0, 1e6), Err(StepError::Force { .. })));
    assert!(matches!(contact.step_force(&model, 1.0, -1.0), Err(StepError::Force { .. })));
    assert_eq!(contact, before);
}

#[test]
fn a_saved_state_goes_on_to_the_last_bit() {
    let model = ball(7.3, 5e4, 8.5, Separation::Unilateral);
    let mut contact = ContactState::default();
    for i in 0..100 {
        contact.step(&model, 1e-3, 1e-4 * f64::from(i)).unwrap();
    }
    let mut restored = ContactState::from_bytes(contact.to_bytes()).unwrap();
    for i in 0..1000 {
        let displacement = 0.01 * (1.0 + (0.01 * f64::from(i)).sin());
        let (a, b) = (contact.step(&model, 1e-3, displacement), restored.step(&model, 1e-3, displacement));
        assert_eq!(a.unwrap().to_bits(), b.unwrap().to_bits());
    }
    let mut bytes = contact.to_bytes();
    bytes[8..16].copy_from_slice(&f64::NAN.to_le_bytes());
    assert!(matches!(ContactState::from_bytes(bytes), Err(StepError::Number { .. })));
    // Bytes of another version, or of nothing.
    bytes = contact.to_bytes();
    bytes[7] = b'2';
    for bytes in [bytes, [0; ContactState::BYTES]] {
        let error = ContactState::from_bytes(bytes).unwrap_err();
        assert_eq!(error.to_string(), "expected the 24 bytes of a contact state of format 1");
    }
}
