//! Contacts lost and met again where rounding could decide.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactEventKind, ContactModel, Motion, Sampling, Separation, simulate};

/// A jaw that left, waits and drifts back by less than a rounding error: the surface comes, meets it, and stays.
#[test]
fn a_jaw_that_hardly_moves_is_met_once() {
    for n in [1.0, 2.0, 3.0, 5.0] {
        for drift in [0.0, 1e-18, 1e-15, 1e-12, 1e-9] {
            let model = ContactModel {
                specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap(),
                law: LatencyLaw::new(n, 0.5 / 0.1f64.powf(n - 1.0)).unwrap(),
                layers: Layers::new(8.0).unwrap(),
                separation: Separation::Unilateral,
            };
            let displacements = vec![0.0, 0.015, 0.015, 0.01, 0.01 - 20.0 * drift, 0.01 - 60.0 * drift];
            let motion = Motion::new(vec![0.0, 1.8, 20.0, 20.6, 40.6, 80.6], displacements).unwrap();
            let result = simulate(&motion, &model, &Sampling::Rate(10.0)).unwrap();
            let kinds: Vec<_> = result.events.iter().map(|event| event.kind).collect();
            assert_eq!(kinds, [ContactEventKind::Lost, ContactEventKind::Regained], "n = {n}, drift {drift}");
            let largest = result.force.iter().copied().fold(0.0, f64::max);
            assert!(result.force.iter().all(|force| *force > -1e-14 * largest), "n = {n}, drift {drift}");
        }
    }
}

/// A jaw that goes back a little slower than the surface comes, so that it is met, gains, and then leaves for good.
#[test]
fn a_contact_met_at_nearly_the_speed_of_the_jaw_is_lost_after_it_has_risen() {
    let law = LatencyLaw::new(1.0, 0.5).unwrap();
    let specimen = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap();
    let model = ContactModel {
        specimen,
        law,
        layers: Layers::new(8.0).unwrap(),
        separation: Separation::Unilateral,
    };
    let run = |speed: f64| {
        let times = vec![0.0, 1.8, 20.0, 20.1, 20.1 + 0.009 / speed];
        let motion = Motion::new(times, vec![0.0, 0.015, 0.015, 0.009, 0.0]).unwrap();
        let result = simulate(&motion, &model, &Sampling::Rate(20.0)).unwrap();
        let kinds: Vec<_> = result.events.iter().map(|event| event.kind).collect();
        let largest = result.force.iter().copied().fold(0.0, f64::max);
        assert!(result.force.iter().all(|force| *force > -1e-14 * largest), "{speed} m/s");
        let met = [ContactEventKind::Lost, ContactEventKind::Regained, ContactEventKind::Lost];
        assert!(kinds == met || kinds == met[..1], "{speed} m/s: {:?}", result.events);
        kinds.len() > 1
    };
    // Free of stress the surface at u goes back at u v/m; each contact has half the speed of the jaw.
    let surface_at_4_mm = 2.0 * 0.004 * 0.5 / 8.0;
    let (mut met, mut escapes) = (0.5 * surface_at_4_mm, 0.8 * surface_at_4_mm);
    assert!(run(met) && !run(escapes));
    // Down to speeds at which it is met and lost at the same moment.
    for _ in 0..60 {
        let speed = 0.5 * (met + escapes);
        *if run(speed) { &mut met } else { &mut escapes } = speed;
    }
    assert!(escapes - met < 1e-15);
}
