//! What more layers do: the tables of docs/theory/contact-simulation.md.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::contact::{Layers, RateDependence, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{Contact, ContactModel, Motion, ProtocolStep, Sampling, Separation, protocol, simulate};

/// Excess strain at 0.6 s and forces (N) at 0.6 and 10.6 s of a ball that is squeezed by 5 mm at 500 mm/min and held for 10 s.
fn squeezed(radius: f64, layers: Layers) -> [f64; 3] {
    let model = ContactModel {
        specimen: Specimen::new(Shape::Ball { radius }, 28e3, Sides::Two).unwrap(),
        law: LatencyLaw::new(5.0, 2e4).unwrap(),
        layers,
        separation: Separation::Bonded,
    };
    let step = ProtocolStep {
        to: 5e-3,
        rate: 0.5 / 60.0,
        hold: 10.0,
    };
    let result = simulate(&protocol(&[step]).unwrap(), &model, &Sampling::Times(vec![0.6, 10.6])).unwrap();
    [result.excess_strain[0], result.force[0], result.force[1]]
}

fn is(found: [f64; 3], expected: [f64; 3]) {
    for (found, (expected, last_digit)) in found.iter().zip(expected.iter().zip([1e-4, 1e-3, 1e-3])) {
        assert!((found - expected).abs() <= 0.5001 * last_digit, "{found} {expected}");
    }
}

#[test]
fn more_layers_at_fixed_v_overshoot_without_bound_and_forget_it() {
    for (count, expected) in [
        (1.0, [0.0, 1.060, 1.060]),
        (2.0, [0.0682, 2.072, 1.550]),
        (4.0, [0.1121, 2.725, 1.556]),
        (8.0, [0.1330, 3.035, 1.556]),
        (16.0, [0.1549, 3.360, 1.556]),
        (64.0, [0.2064, 4.125, 1.557]),
    ] {
        is(squeezed(0.035, Layers::new(count).unwrap()), expected);
    }
}

#[test]
fn layers_of_one_thickness_do_not_feel_how_large_the_body_is() {
    for (radius, expected) in [
        (0.0175, [0.1290, 1.943, 1.260]),
        (0.035, [0.1330, 3.035, 1.556]),
        (0.07, [0.1349, 5.158, 2.090]),
        (0.14, [0.1358, 9.375, 3.128]),
    ] {
        is(squeezed(radius, Layers::of_thickness(4.375e-3, radius).unwrap()), expected);
    }
    // (m − 1)/depth tends to 1/ℓ.
    let far = squeezed(1e3 * 0.035, Layers::of_thickness(4.375e-3, 35.0).unwrap())[0];
    assert!((far - 0.1366).abs() < 1e-4, "{far}");
}

/// With a factor near 1 a ramp had a few sections, and its forces were off by 4·10⁻⁴ of the largest.
#[test]
fn a_rate_coefficient_that_hardly_changes_is_followed_as_exactly_as_one_that_does() {
    let times: Vec<f64> = (1..=180).map(|i| 0.01 * f64::from(i)).collect();
    for factor in [0.2, 0.9, 0.95, 0.985, 1.02] {
        let contact = Contact::Latency {
            model: ContactModel {
                specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap(),
                law: LatencyLaw::new(4.0, 5e3).unwrap(),
                layers: Layers::new(8.0).unwrap(),
                separation: Separation::Bonded,
            },
            rate: RateDependence::Strain { factor },
        };
        let forces = |pieces: u32| {
            let at = |i: u32| f64::from(i) / f64::from(pieces);
            let (knots, places) = (0..=pieces).map(|i| (1.8 * at(i), 15e-3 * at(i))).unzip();
            let motion = Motion::new(knots, places).unwrap();
            simulate(&motion, &contact, &Sampling::Times(times.clone())).unwrap().force
        };
        let (whole, cut) = (forces(1), forces(1000));
        let off = whole.iter().zip(&cut).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 4e-5 * cut[cut.len() - 1], "{factor}: {off}");
    }
}
