//! Contacts in the terms of other simulators: their errors against `simulate`, and what cannot be exported.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::contact::{Layers, RateDependence, Shape, Sides, Specimen};
use palpate::export::{
    CardError, Conditions, ExportError, HOLD_TIMES, HoldCurve, HuntCrossley, Loading, SoftConstraint, SpringDamper,
};
use palpate::latency::LatencyLaw;
use palpate::simulate::{
    Contact, ContactModel, LinearContact, LinearLaw, LinearTerm, Memory, Motion, Sampling, Separation, simulate,
};
use palpate::test_problems::paper_ball;

/// A force (N) of indentation (m) and speed (m/s).
type Force<'a> = &'a dyn Fn(f64, f64) -> f64;

fn conditions(depth: f64, speed: f64) -> Conditions {
    Conditions::new(depth, (0.5 * speed, speed), 60.0).unwrap()
}

fn ball() -> Contact {
    paper_ball(Separation::Unilateral).into()
}

fn model(exponent: f64, rate: f64) -> ContactModel {
    ContactModel {
        law: LatencyLaw::new(exponent, rate).unwrap(),
        ..paper_ball(Separation::Unilateral)
    }
}

fn block() -> Specimen {
    let shape = Shape::Prism {
        area: 1e-3,
        length: 0.04,
    };
    Specimen::new(shape, 1e5, Sides::One).unwrap()
}

/// Contacts of every kind that a material can be.
fn contacts() -> Vec<(&'static str, Contact)> {
    let terms = [(0.5, 3.0), (0.3, 0.2), (0.2, 0.01)].map(|(overshoot, rate)| LinearTerm { overshoot, rate });
    let linear = |memory| LinearContact {
        specimen: paper_ball(Separation::Unilateral).specimen,
        law: LinearLaw::new(&terms).unwrap(),
        memory,
        separation: Separation::Unilateral,
    };
    let latency = ContactModel {
        specimen: block(),
        layers: Layers::new(6.0).unwrap(),
        ..model(3.0, 500.0)
    };
    let rate = RateDependence::Strain { factor: 0.3 };
    vec![
        ("n = 5", ball()),
        ("n = 2", model(2.0, 20.0).into()),
        ("n = 1.05", model(1.05, 1.0).into()),
        ("n = 3, block", latency.into()),
        (
            "n = 5, v by strain",
            Contact::Latency {
                model: paper_ball(Separation::Unilateral),
                rate,
            },
        ),
        ("three terms, memory of strain", linear(Memory::Strain).into()),
        ("three terms, memory of force", linear(Memory::Force).into()),
    ]
}

/// The Prony series of a hold is compared with the simulation of that hold, at times of six decades.
#[test]
fn two_terms_a_decade_reproduce_the_simulated_hold() {
    let conditions = conditions(0.01, 0.008);
    let touched = 0.01 / 0.008;
    let after: Vec<f64> = (0..=60).map(|i| 60.0 * 10f64.powf(-f64::from(60 - i) / 10.0)).collect();
    for (name, contact) in contacts() {
        let curve = HoldCurve::of(&contact, conditions).unwrap();
        let series = curve.series(60.0, 2.0).unwrap();
        let motion = Motion::new(vec![0.0, touched, touched + 60.0], vec![0.0, 0.01, 0.01]).unwrap();
        let times: Vec<f64> = after.iter().map(|time| touched + time).collect();
        let course = simulate(&motion, &contact, &Sampling::Times(times)).unwrap();
        let error = |(time, force): (&f64, &f64)| (series.value(*time) - force / curve.peak).abs();
        let worst = after.iter().zip(&course.force).map(error).fold(0.0, f64::max);
        println!("{name}: {} terms, worst error {worst:.2e} of the peak", series.terms().len());
        assert!(worst < 2e-3, "{name}: {worst:e}");
        assert!((series.value(0.0) - 1.0).abs() < 1e-6 && series.equilibrium() > 0.0, "{name}");
        if matches!(contact, Contact::Linear(_)) {
            assert!(worst < 1e-6 && series.terms().len() == 3, "{name}: {worst:e}");
        }
    }
}

/// λ = v |x₀|ⁿ⁻¹ belongs to the depth and the speed of the loading: the series of one hold is wrong for another.
#[test]
fn a_series_is_of_one_hold_only() {
    let [slow, fast] = [1e-4, 1e-2].map(|speed| HoldCurve::of(&ball(), conditions(0.01, speed)).unwrap());
    let ((_, slow_rate), (_, fast_rate)) = (slow.latency().unwrap(), fast.latency().unwrap());
    // At the steady state x = (g/v)^(1/n), so that λ goes like the speed to the power 1 − 1/n.
    assert!((fast_rate / slow_rate / 100f64.powf(0.8) - 1.0).abs() < 0.02, "{}", fast_rate / slow_rate);
    let [slow, fast] = [slow, fast].map(|curve| curve.series(60.0, 2.0).unwrap().value(1.0));
    assert!(slow - fast > 0.03, "{slow} and {fast} of the peak after 1 s");
}

/// Largest error of a force in loading as a share of the peak force, found by many more depths and other speeds than those of a fit.
fn largest_error(contact: &Contact, conditions: Conditions, force: Force<'_>, peak: f64) -> f64 {
    let share = contact.specimen().contact_displacement(1.0);
    let mut largest = 0.0_f64;
    for index in 0..=24 {
        let speed = conditions.slowest * (conditions.fastest / conditions.slowest).powf(f64::from(index) / 24.0);
        let duration = conditions.depth / speed;
        let motion = Motion::new(vec![0.0, duration], vec![0.0, conditions.depth]).unwrap();
        let times = (100..=6000).map(|step| duration * (f64::from(step) / 6000.0)).collect();
        let course = simulate(&motion, contact, &Sampling::Times(times)).unwrap();
        for (u, expected) in course.contact_displacement.iter().zip(&course.force) {
            largest = largest.max(((force(*u, share * speed) - expected) / peak).abs());
        }
    }
    largest
}

/// A peak of the error between the depths that were fitted was larger than the error stated.
#[test]
fn stated_errors_are_those_of_the_forces() {
    let conditions = conditions(0.015, 0.008336);
    for (name, contact) in contacts() {
        let loading = Loading::of(&contact, conditions).unwrap();
        let radius = matches!(contact.specimen().shape(), Shape::Ball { .. }).then_some(0.035);
        let soft = SoftConstraint::fit(&loading, 0.15).unwrap();
        let drake = HuntCrossley::fit(&loading, radius).unwrap();
        let spring = SpringDamper::fit(&loading).unwrap();
        let forces: [(&str, Force<'_>, CardError); 3] = [
            ("soft constraint", &|u, speed| soft.force(u, speed), soft.error),
            ("Hunt and Crossley", &|u, speed| drake.force(u, speed), drake.error),
            ("spring", &|u, speed| spring.force(u, speed), spring.error),
        ];
        for (kind, force, stated) in forces {
            let largest = largest_error(&contact, conditions, force, loading.peak);
            println!(
                "{name}, {kind}: {:.2} % in loading, {} % in the hold",
                100.0 * stated.loading,
                stated.hold.map(|error| format!("{:+.1}", 100.0 * error)).join(" ")
            );
            assert!(
                (largest - stated.loading).abs() < 1e-4 && stated.loading_rms <= stated.loading,
                "{largest}, {stated:?}"
            );
            // Samples begin at a sixtieth of the depth: a damper has a force before, the material next to none.
            let touch = force(f64::MIN_POSITIVE, loading.samples[0].speed) / loading.peak;
            assert!(
                (stated.touch - touch).abs() < 1e-12 && (touch < 1e-9 || kind != "Hunt and Crossley"),
                "{kind}: {touch}"
            );
            for ((time, held), error) in HOLD_TIMES.iter().zip(loading.held).zip(stated.hold) {
                let found = (force(loading.indentation, 0.0) - held) / loading.peak;
                assert!((found - error).abs() < 1e-12, "{name}, {kind}, {time} s");
            }
        }
        // The force of a ball begins softly, as that of a point contact that begins later.
        if name == "n = 2" {
            assert!(drake.gap > 0.0 && drake.error.loading < 0.02, "{drake:?}");
        }
        // A ball of the paper's law has the linear and the quadratic part that Drake's two contacts have.
        if name == "n = 5" {
            assert!(drake.error.loading < 0.01 && soft.error.loading < 0.02, "{drake:?} {soft:?}");
            assert!(drake.error.loading < spring.error.loading && soft.error.loading < spring.error.loading);
        }
    }
}

/// A spring and a damper are found again in the forces that they have.
#[test]
fn a_contact_is_found_again_in_its_own_forces() {
    let mut loading = Loading::of(&ball(), conditions(0.015, 0.008)).unwrap();
    loading
        .samples
        .iter_mut()
        .for_each(|sample| sample.force = 1500.0 * sample.indentation + 200.0 * sample.speed);
    let spring = SpringDamper::fit(&loading).unwrap();
    assert!(
        (spring.stiffness / 1500.0 - 1.0).abs() < 1e-6 && (spring.damping / 200.0 - 1.0).abs() < 1e-5,
        "{spring:?}"
    );
    assert!(spring.error.loading < 1e-8);
    let both = HuntCrossley::fit(&Loading::of(&ball(), conditions(0.015, 0.008)).unwrap(), Some(0.035)).unwrap();
    loading
        .samples
        .iter_mut()
        .for_each(|sample| sample.force = both.force(sample.indentation, sample.speed));
    let again = HuntCrossley::fit(&loading, Some(0.035)).unwrap();
    let elastic = |fit: &HuntCrossley| fit.point.unwrap().elastic;
    assert!(again.error.loading < 1e-8 && (elastic(&again) / elastic(&both) - 1.0).abs() < 1e-5, "{again:?}");
}

#[test]
fn what_describes_no_loading_is_refused() {
    let refused = [
        Conditions::new(0.0, (1e-3, 1e-3), 60.0),
        Conditions::new(0.01, (0.0, 1e-3), 60.0),
        Conditions::new(0.01, (2e-3, 1e-3), 60.0),
        Conditions::new(0.01, (1e-3, f64::INFINITY), 60.0),
        Conditions::new(0.01, (1e-3, 1e-3), f64::NAN),
    ];
    for refused in refused {
        assert!(matches!(refused, Err(ExportError::Condition { .. })), "{refused:?}");
    }
    let deep = Loading::of(&ball(), conditions(0.08, 0.01));
    assert!(matches!(deep, Err(ExportError::Simulate(_))), "{deep:?}");
    let loading = Loading::of(&ball(), conditions(0.01, 0.01)).unwrap();
    assert!(matches!(SoftConstraint::fit(&loading, 0.0), Err(ExportError::Condition { name: "mass", .. })));
    let below = HoldCurve::of(&model(0.7, 0.1).into(), conditions(0.01, 0.01)).unwrap();
    assert_eq!(below.series(60.0, 2.0), Err(ExportError::NoMixture { exponent: 0.7 }));
    // One layer has no excess: an elastic body.
    let elastic = ContactModel {
        layers: Layers::new(1.0).unwrap(),
        ..paper_ball(Separation::Unilateral)
    };
    let elastic = HoldCurve::of(&elastic.into(), conditions(0.01, 0.01)).unwrap();
    assert_eq!(elastic.series(60.0, 2.0), Err(ExportError::NoRelaxation));
}
