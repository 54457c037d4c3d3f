//! The modulus of a force curve: of its ramp, and of the force that its hold tends to.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::f64::consts::PI;

use palpate::analysis::{Analysis, AnalysisOptions, Finding, Geometry, analyze};
use palpate::contact::{Equilibrium, Shape, Sides};
use palpate::record::Record;
use palpate::segment::ContactChoice;
use palpate::simulate::{ProtocolStep, Separation, protocol, simulate_force};
use palpate::test_problems::{Rng, paper_ball};

const RADIUS: f64 = 0.035;

/// The paper's ball, squeezed from both sides by 4 mm in 0.5 s after a way through air (m), and held; with noise of the force (N).
fn squeezed(air: f64, rate_hz: f64, noise: f64, touch: ContactChoice) -> Analysis {
    let motion = protocol(&[ProtocolStep {
        to: 0.004,
        rate: 0.008,
        hold: 20.0,
    }])
    .unwrap();
    let before = air / 0.008;
    let times: Vec<f64> = (0..).map(|i| f64::from(i) / rate_hz).take_while(|t| *t <= before + motion.end()).collect();
    let inside: Vec<f64> = times.iter().map(|t| (t - before).max(0.0)).collect();
    let displacement = times.iter().map(|t| (0.008 * t).min(air + motion.displacement_at((t - before).max(0.0))));
    let (distinct, first) = (inside.iter().filter(|t| **t > 0.0).count(), inside.len());
    let start = first - distinct;
    let mut random = Rng::new(5);
    let pressed = simulate_force(&motion, &paper_ball(Separation::Unilateral), &inside[start..]).unwrap();
    let force = std::iter::repeat_n(0.0, start).chain(pressed).map(|force| force + noise * random.normal());
    let record = Record::new(times.clone(), Some(displacement.collect()), force.collect()).unwrap();
    let options = AnalysisOptions {
        geometry: Some(Geometry {
            shape: Shape::Ball { radius: RADIUS },
            sides: Sides::Two,
            modulus: None,
            equilibrium: Equilibrium::UniformStrain,
        }),
        touch,
        ..AnalysisOptions::default()
    };
    analyze(&record, &options).unwrap()
}

/// Equilibrium force of the ball at 1 Pa and a displacement of the jaw (m): A(u) u/r with A = π (2 r u − u²), u half of it.
fn unit(displacement: f64) -> f64 {
    let u = 0.5 * displacement.max(0.0);
    PI * (2.0 * RADIUS * u - u * u) * u / RADIUS
}

/// The ramp was cut one sample before the jaw arrives: of 11 samples that changed the modulus by 6 %.
#[test]
fn the_modulus_of_a_ramp_reaches_to_where_the_jaw_arrives() {
    let analysis = squeezed(0.0, 20.0, 0.0, ContactChoice::AsRecorded);
    let record = &analysis.record;
    let rows = record.time().iter().zip(record.displacement().unwrap()).zip(record.force());
    let ramp: Vec<(f64, f64)> = rows
        .filter(|((time, _), _)| **time < 0.5 + 1e-9)
        .map(|((_, d), force)| (unit(*d), *force))
        .collect();
    assert_eq!(ramp.len(), 11);
    let expected = ramp.iter().map(|(g, f)| g * f).sum::<f64>() / ramp.iter().map(|(g, _)| g * g).sum::<f64>();
    let found = analysis.loading_modulus.unwrap().value;
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
}

/// The error of first touch was part of the modulus of the ramp and not of that of the equilibrium force.
#[test]
fn the_equilibrium_modulus_is_as_uncertain_as_first_touch() {
    let analysis = squeezed(1e-3, 200.0, 0.02, ContactChoice::Auto);
    let (error, hold) = (analysis.contact.displacement_error.unwrap(), &analysis.holds[0]);
    let level = hold.displacement.unwrap();
    let by_touch = (unit(level + error) - unit(level - error)) / (2.0 * unit(level));
    // The zero of the force, too, was found in the air.
    let by_zero = |analysis: &Analysis| analysis.contact.force_error.unwrap() / analysis.holds[0].force_end;
    let (found, expected) = (hold.modulus_error.unwrap(), by_touch.hypot(by_zero(&analysis)));
    assert!((found / expected - 1.0).abs() < 0.05 && by_touch > 1e-4, "{found} {expected}");
    // A touch that is given is exact.
    let given = squeezed(1e-3, 200.0, 0.02, ContactChoice::Displacement(1e-3));
    assert!((given.holds[0].modulus_error.unwrap() / by_zero(&given) - 1.0).abs() < 1e-9);
}

/// A foam that relaxes by the logarithm of time: the closest of laws with an equilibrium gave its modulus an interval that contained it in 1 of 36,
/// and a modulus that was given was "wrong" in 5 of 40.
#[test]
fn a_body_without_an_equilibrium_in_sight_has_a_modulus_of_unknown_error() {
    let mut random = Rng::new(4);
    let time: Vec<f64> = (0..3000).map(|i| 0.2 * f64::from(i)).collect();
    let jaw: Vec<f64> = time.iter().map(|t| 3e-3 * (t - 1.0).clamp(0.0, 1.0)).collect();
    let falls = |t: f64| 6.0 * (1.8 - 0.05 * (1.0 + (t - 2.0).max(0.0) / 0.05).ln());
    let force: Vec<f64> =
        time.iter().zip(&jaw).map(|(t, jaw)| falls(*t) * jaw / 3e-3 + 3e-3 * random.normal()).collect();
    let record = Record::new(time, Some(jaw), force).unwrap();
    let found = |modulus: Option<f64>| {
        let options = AnalysisOptions {
            geometry: Some(Geometry {
                shape: Shape::Prism {
                    area: 1e-4,
                    length: 0.03,
                },
                sides: Sides::One,
                modulus,
                equilibrium: Equilibrium::UniformStrain,
            }),
            compare: None,
            ..AnalysisOptions::default()
        };
        analyze(&record, &options).unwrap().findings
    };
    let is_unknown = |finding: &Finding| {
        matches!(
            finding,
            Finding::ModulusEstimated {
                standard_error: None,
                without_equilibrium: true,
                ..
            }
        )
    };
    assert!(found(None).iter().any(is_unknown));
    assert!(found(Some(600e3)).iter().all(|finding| !matches!(finding, Finding::ModulusMismatch { .. })));
    assert!(found(Some(1.2e6)).iter().any(|finding| matches!(finding, Finding::ModulusMismatch { .. })));
}
