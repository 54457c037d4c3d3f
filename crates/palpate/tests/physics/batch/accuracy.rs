//! Batches against the simulation of one contact, against reference numbers, and against themselves on other threads.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use crate::common::reference;
use palpate::batch::{Batch, BatchError};
use palpate::contact::{Curve, Equilibrium, Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactModel, Motion, Sampling, Separation, SimulateError, simulate, simulate_force};
use palpate::test_problems::{Noise, paper_ball, paper_test_a};
use serde::Deserialize;

#[derive(Deserialize)]
struct Case {
    name: String,
    radius: f64,
    modulus: f64,
    exponent: f64,
    rate_coefficient: f64,
    layers: f64,
    sides: u32,
    knots: Vec<(f64, f64)>,
    times: Vec<f64>,
    #[serde(default)]
    force: Vec<f64>,
    #[serde(default)]
    displacement: Vec<Vec<f64>>,
}

impl Case {
    fn model(&self) -> ContactModel {
        let sides = if self.sides == 2 { Sides::Two } else { Sides::One };
        ContactModel {
            specimen: Specimen::new(Shape::Ball { radius: self.radius }, self.modulus, sides).unwrap(),
            law: LatencyLaw::new(self.exponent, self.rate_coefficient).unwrap(),
            layers: Layers::new(self.layers).unwrap(),
            separation: Separation::Bonded,
        }
    }

    fn motion(&self) -> Motion {
        let (times, displacements) = self.knots.iter().copied().unzip();
        Motion::new(times, displacements).unwrap()
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Twenty protocols, n from 0.5 to 7.3, 1 to 512 layers: mpmath, correctly rounded.
#[test]
fn forces_are_those_of_other_software() {
    let (_, cases) = reference::<serde_json::Value, Case>("contact_force");
    let models: Vec<_> = cases.iter().map(Case::model).collect();
    let motions: Vec<_> = cases.iter().map(Case::motion).collect();
    // All in one batch: lanes that differ in everything.
    let ends = Batch::new(&models, &motions).unwrap().final_forces().unwrap();
    for ((case, model), (motion, end)) in cases.iter().zip(&models).zip(motions.iter().zip(ends)) {
        let scale = largest(&case.force);
        let forces = Batch::shared(std::slice::from_ref(model), motion).unwrap().forces_at(&case.times).unwrap();
        let far = forces.iter().zip(&case.force).map(|(found, expected)| (found - expected).abs());
        let worst = far.fold(0.0, f64::max) / scale;
        println!("{:32} {worst:.1e}", case.name);
        assert!(worst < 1e-9, "{}: {worst:e}", case.name);
        let expected = simulate_force(motion, model, &[motion.end()]).unwrap()[0];
        assert!((end - expected).abs() < 1e-9 * scale, "{}: {end} {expected}", case.name);
    }
}

/// The strain of every layer: SciPy.
#[test]
fn strains_are_those_of_other_software() {
    let (_, cases) = reference::<serde_json::Value, Case>("cascade");
    for case in &cases {
        let (models, motion) = (vec![case.model(); 3], case.motion());
        let strains = Batch::shared(&models, &motion).unwrap().strains_at(&case.times, 1e-11).unwrap();
        let thickness = case.radius / case.layers;
        for (sample, nodes) in case.displacement.iter().enumerate() {
            let behind = nodes.iter().skip(1).chain(&[0.0]);
            for (layer, (outer, inner)) in nodes.iter().zip(behind).enumerate() {
                let far = (strains.of(2, sample)[layer] - (outer - inner) / thickness).abs();
                assert!(far < 1e-8, "{} layer {layer} at {} s: {far:e}", case.name, case.times[sample]);
            }
        }
    }
}

/// Contacts that differ in everything: exponents shared by none, round and flat, one side and two, bonded or not.
fn mixed(count: usize) -> (Vec<ContactModel>, Vec<Motion>) {
    let mut noise = Noise::new(3);
    let mut between = |low: f64, high: f64| low + (high - low) * (0.5 + noise.normal() / 8.0).clamp(0.0, 1.0);
    let contact = |index: usize| {
        let size = between(0.01, 0.05);
        let shape = match index % 3 {
            0 => Shape::Ball { radius: size },
            1 => Shape::Pad {
                radius: size,
                thickness: 0.6 * size,
            },
            _ => Shape::Prism {
                area: size * size,
                length: size,
            },
        };
        let sides = if index.is_multiple_of(2) { Sides::Two } else { Sides::One };
        let model = ContactModel {
            specimen: Specimen::new(shape, between(1e3, 1e5), sides).unwrap(),
            law: LatencyLaw::new(between(0.5, 7.0), 10f64.powf(between(-1.0, 5.0))).unwrap(),
            layers: Layers::new((1 + index % 12) as f64).unwrap(),
            separation: if index.is_multiple_of(5) { Separation::Unilateral } else { Separation::Bonded },
        };
        let depth = 0.1 * model.specimen.depth();
        let travel = [0.0, between(0.5, 1.0), between(0.5, 1.0), between(0.0, 1.0), between(0.0, 1.0)];
        let displacements: Vec<f64> = travel.iter().map(|part| part * depth).collect();
        let pauses = [between(0.1, 2.0), between(0.1, 2.0), between(0.01, 0.5), between(1.0, 1e4)];
        let mut times = vec![0.0];
        for pause in pauses {
            times.push(times[times.len() - 1] + pause);
        }
        (model, Motion::new(times, displacements).unwrap())
    };
    (0..count).map(contact).unzip()
}

#[test]
fn every_contact_is_simulated_as_if_it_were_alone() {
    let (models, motions) = mixed(333);
    let batch = Batch::new(&models, &motions).unwrap();
    let ends = batch.final_forces().unwrap();
    for (index, (model, motion)) in models.iter().zip(&motions).enumerate() {
        let alone = simulate(motion, model, &Sampling::Rate(20.0 / motion.end())).unwrap();
        let (scale, expected) = (largest(&alone.force), alone.force[alone.len() - 1]);
        assert!((ends[index] - expected).abs() < 1e-9 * scale, "{index}: {} {expected}", ends[index]);
    }
}

#[test]
fn samples_in_between_are_those_of_one_contact() {
    let model = ContactModel {
        law: LatencyLaw::new(3.7, 800.0).unwrap(),
        ..paper_ball(Separation::Bonded)
    };
    let times: Vec<f64> = (0..=660).map(|i| 0.1 * f64::from(i)).collect();
    let motion = paper_test_a();
    let expected = simulate_force(&motion, &model, &times).unwrap();
    let found = Batch::shared(&vec![model.clone(); 40], &motion).unwrap().forces_at(&times).unwrap();
    let scale = largest(&expected);
    for (place, found) in found.iter().enumerate() {
        let expected = expected[place % times.len()];
        assert!((found - expected).abs() < 1e-9 * scale, "{found} {expected}");
    }
}

#[test]
fn threads_change_no_bit() {
    let (models, motions) = mixed(333);
    let batch = Batch::new(&models, &motions).unwrap();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let forces = batch.final_forces().unwrap();
            let strains = batch.strains_at(&[0.1, 0.3], 1e-9).unwrap();
            let strains = (0..333).flat_map(|contact| strains.of(contact, 1).to_vec());
            forces.iter().copied().chain(strains).map(f64::to_bits).collect::<Vec<_>>()
        })
    };
    let one = run(1);
    assert!(one == run(2) && one == run(7));
}

/// A law so fast, and a hold so long, that fifth powers leave the range of doubles.
#[test]
fn long_holds_and_fast_laws_end_relaxed() {
    let models: Vec<ContactModel> = [(5.0, 1e300), (5.0, 1e-300), (1.0, 50.0), (0.5, 1e3), (40.0, 1.0), (2.0, 1e30)]
        .iter()
        .map(|&(n, v)| ContactModel {
            law: LatencyLaw::new(n, v).unwrap(),
            ..paper_ball(Separation::Bonded)
        })
        .collect();
    let motion = Motion::new(vec![0.0, 0.6, 1e9], vec![0.0, 0.005, 0.005]).unwrap();
    let forces = Batch::shared(&models, &motion).unwrap().final_forces().unwrap();
    for (model, found) in models.iter().zip(forces) {
        let expected = simulate_force(&motion, model, &[1e9]).unwrap()[0];
        assert!((found / expected - 1.0).abs() < 1e-9, "{:?}: {found} {expected}", model.law);
    }
}

#[test]
fn wrong_batches_say_which_contact() {
    let (model, motion) = (paper_ball(Separation::Bonded), paper_test_a());
    let two = Batch::new(&vec![model.clone(); 3], std::slice::from_ref(&motion));
    assert!(matches!(two, Err(BatchError::Lengths { models: 3, motions: 1 })));
    let deep = Motion::new(vec![0.0, 1.0], vec![0.0, 0.08]).unwrap();
    let error = Batch::new(&vec![model.clone(); 2], &[motion.clone(), deep]).unwrap_err();
    assert!(error.to_string().starts_with("contact 1: at t = 1 s the jaw is at 0.08 m"), "{error}");
    let batch = Batch::shared(&vec![model.clone(); 2], &motion).unwrap();
    let late = batch.forces_at(&[1.0, 67.0]).unwrap_err();
    let place = SimulateError::SampleTime {
        from: 0.0,
        until: 66.0,
        found: 67.0,
        index: 1,
    };
    assert_eq!(
        late,
        BatchError::Contact {
            index: 0,
            source: place
        }
    );
    assert!(batch.forces_at(&[2.0, 1.0]).is_err());
    assert!(matches!(batch.strains_at(&[1.0], 0.1), Err(BatchError::Tolerance { .. })));
    let halves = ContactModel {
        layers: Layers::new(7.5).unwrap(),
        ..model.clone()
    };
    let batch = Batch::shared(&[model, halves], &motion).unwrap();
    let error = batch.strains_at(&[1.0], 1e-8).unwrap_err();
    assert!(matches!(error, BatchError::Contact { index: 1, .. }), "{error}");
    assert!(Batch::shared(&[], &motion).unwrap().final_forces().unwrap().is_empty());
}

/// Bodies whose stiffness is no column of a batch are followed one by one: the same numbers, beside others.
#[test]
fn bodies_by_tables_and_hertz_stand_beside_balls() {
    let ball = Specimen::new(Shape::Ball { radius: 0.02 }, 5e4, Sides::Two).unwrap();
    let area = Curve::new(&[(0.0, 0.0), (0.002, 6e-5), (0.01, 2e-4)]).unwrap();
    let punch = Specimen::new(Shape::Profile { depth: 0.015, area }, 1e5, Sides::One).unwrap();
    let hertz = ball.clone().with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.5 }).unwrap();
    let model = |specimen: &Specimen| ContactModel {
        specimen: specimen.clone(),
        law: LatencyLaw::new(3.0, 50.0).unwrap(),
        layers: Layers::new(8.0).unwrap(),
        separation: Separation::Bonded,
    };
    let motion = Motion::new(vec![0.0, 2.0, 12.0, 13.0, 20.0], vec![0.0, 0.008, 0.008, 0.005, 0.005]).unwrap();
    let models: Vec<ContactModel> = [&ball, &punch, &hertz, &ball, &punch].into_iter().map(model).collect();
    let times = [0.5, 2.0, 12.5, 20.0];
    let batch = Batch::shared(&models, &motion).unwrap();
    let (forces, strains) = (batch.forces_at(&times).unwrap(), batch.strains_at(&times, 1e-12).unwrap());
    for (i, model) in models.iter().enumerate() {
        let expected = simulate(&motion, model, &Sampling::Times(times.to_vec())).unwrap();
        for k in 0..times.len() {
            assert!((forces[i * times.len() + k] - expected.force[k]).abs() < 1e-9 * largest(&expected.force));
            assert!((strains.of(i, k)[0] - expected.strain[k]).abs() < 1e-9);
        }
    }
}
