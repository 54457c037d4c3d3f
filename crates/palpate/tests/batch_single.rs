//! Batches in single precision against double precision: within 10⁻⁵ of the largest force of a contact.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::batch::{Batch, BatchError};
use palpate::contact::{Curve, Equilibrium, Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactModel, Motion, Separation, SimulateError, simulate_force};
use palpate::test_problems::{Noise, paper_ball, paper_test_a};
use proptest::prelude::*;

/// What is promised, of the largest force of a contact.
const PROMISED: f64 = 1e-5;

const EXPONENTS: [f64; 7] = [0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 7.3];
const LAYERS: [f64; 5] = [2.0, 8.0, 64.0, 512.0, 8.5];

fn shapes() -> [Shape; 3] {
    [
        Shape::Ball { radius: 0.035 },
        Shape::Pad {
            radius: 0.03,
            thickness: 0.01,
        },
        Shape::Prism {
            area: 2e-4,
            length: 0.03,
        },
    ]
}

fn model(shape: &Shape, n: f64, v: f64, layers: f64) -> ContactModel {
    ContactModel {
        specimen: Specimen::new(shape.clone(), 3e4, Sides::One).unwrap(),
        law: LatencyLaw::new(n, v).unwrap(),
        layers: Layers::new(layers).unwrap(),
        separation: Separation::Bonded,
    }
}

/// Pieces of motion as (seconds, part of a third of the depth at its end).
fn motion(model: &ContactModel, pieces: &[(f64, f64)]) -> Motion {
    let depth = model.specimen.depth() / 3.0 / model.specimen.contact_displacement(1.0);
    let (mut times, mut displacements) = (vec![0.0], vec![0.0]);
    for (seconds, part) in pieces {
        times.push(times[times.len() - 1] + seconds);
        displacements.push(depth * part);
    }
    Motion::new(times, displacements).unwrap()
}

/// Largest difference between both precisions at the knots of the motions and nine times between any two, in units of the largest force of
/// its contact: its size, and which contact. Motions must share their times.
fn worst(models: &[ContactModel], motions: &[Motion]) -> (f64, usize) {
    let knots = motions[0].times();
    let between =
        |pair: &[f64]| (0..10).map(|i| pair[0] + (pair[1] - pair[0]) * f64::from(i) / 10.0).collect::<Vec<_>>();
    let mut times: Vec<f64> = knots.windows(2).flat_map(between).collect();
    times.push(knots[knots.len() - 1]);
    let batch = Batch::new(models, motions).unwrap();
    let double = batch.forces_at(&times).unwrap();
    let (single, ends) = (batch.forces_at_single(&times).unwrap(), batch.final_forces_single().unwrap());
    let mut worst = (0.0, 0);
    for (index, expected) in double.chunks(times.len()).enumerate() {
        let largest = expected.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        let found = single[index * times.len()..].iter().copied().zip(expected);
        for (found, expected) in found.chain([(ends[index], &expected[times.len() - 1])]) {
            let far = (f64::from(found) - expected).abs() / largest;
            worst = if far > worst.0 { (far, index) } else { worst };
        }
    }
    worst
}

/// Every exponent, six decades of rate coefficients, every number of layers and shape, through motions of a millisecond to thirty days.
#[test]
fn single_precision_keeps_what_it_promises() {
    const DAY: f64 = 86_400.0;
    let courses: [&[(f64, f64)]; 7] = [
        &[(0.6, 0.4), (10.0, 0.4)],
        &[(1e-3, 1.0), (1e-3, 1.0), (1.0, 1.0)],
        &[(0.5, 0.5), (30.0 * DAY, 0.5), (0.2, 1.0), (1.0, 0.3)],
        &[(0.5, 0.3), (5.0, 0.3), (0.5, 0.6), (5.0, 0.6), (1.0, 0.1), (100.0, 0.1), (0.01, 1.0)],
        &[(100.0, 0.7), (1.0, 0.2), (1.0, 0.8), (1e3, 0.85), (1e-3, 0.5), (0.1, 0.5)],
        &[(0.05, 1.0), (3600.0, 0.99), (0.5, 1.0)],
        &[(DAY, 1.0), (1e-3, 0.5), (DAY, 0.5)],
    ];
    let mut most = 0.0;
    for (course, pieces) in courses.iter().enumerate() {
        let mut models = Vec::new();
        for n in EXPONENTS {
            for decade in 0..7 {
                for layers in LAYERS {
                    for shape in shapes() {
                        // Around 1 in units of a strain of 0.1 and a second, v = 10ⁿ⁻¹.
                        let v = 10f64.powf(n - 4.0 + f64::from(decade));
                        models.push(model(&shape, n, v, layers));
                    }
                }
            }
        }
        let motions: Vec<Motion> = models.iter().map(|model| motion(model, pieces)).collect();
        let (far, index) = worst(&models, &motions);
        println!("course {course}: {far:.1e} {:?} {:?}", models[index].law, models[index].layers);
        most = f64::max(most, far);
    }
    assert!(most < PROMISED, "{most:e}");
}

fn any_contact() -> impl Strategy<Value = (ContactModel, Vec<(f64, f64)>)> {
    let whole = prop::sample::select(vec![1.0, 2.0, 3.0, 5.0]);
    let n = prop_oneof![whole, 0.5..8.0f64];
    let piece = (-3.0..6.5f64, prop_oneof![Just(None), (0.0..1.0f64).prop_map(Some)]);
    let law = (n, -4.0..4.0f64, 0.0..2.8f64, 0..3usize, -3.0..0.0f64);
    (law, prop::collection::vec(piece, 1..8)).prop_map(|((n, decades, layers, shape, size), pieces)| {
        let model = model(&shapes()[shape], n, 10f64.powf(n - 1.0 + decades), 10f64.powf(layers));
        let mut place = 0.0;
        let piece = |(seconds, to): (f64, Option<f64>)| {
            place = to.map_or(place, |to| to * 10f64.powf(size));
            (10f64.powf(seconds), place)
        };
        (model, pieces.into_iter().map(piece).collect())
    })
}

proptest! {
    #[test]
    fn any_contact_keeps_what_is_promised((model, pieces) in any_contact()) {
        let motion = motion(&model, &pieces);
        prop_assume!(motion.displacements().iter().any(|d| *d > 0.0));
        let (far, _) = worst(std::slice::from_ref(&model), std::slice::from_ref(&motion));
        if far > 2e-6 { println!("RANDOM {far:.1e} {:?} {:?} {:?}", model.law, model.layers, motion); }
        prop_assert!(far < PROMISED, "{far:e}");
    }
}

/// Twenty thousand knots and samples: what is summed up is summed up in double precision.
#[test]
fn many_knots_and_samples_lose_nothing() {
    let mut noise = Noise::new(5);
    let wave = |i: usize| 0.5 - 0.5 * (0.002 * i as f64).cos() + 1e-3 * noise.normal().abs();
    let displacements: Vec<f64> = (0..20_000).map(wave).map(|part| 0.01 * part).collect();
    let times: Vec<f64> = (0..20_000).map(|i| 1e-3 * f64::from(i)).collect();
    let motion = Motion::new(times.clone(), displacements).unwrap();
    for n in EXPONENTS {
        let model = model(&shapes()[0], n, 10f64.powf(n - 1.0), 8.0);
        let batch = Batch::shared(std::slice::from_ref(&model), &motion).unwrap();
        let (double, single) = (batch.forces_at(&times).unwrap(), batch.forces_at_single(&times).unwrap());
        let largest = double.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        let far = double.iter().zip(&single).map(|(double, single)| (double - f64::from(*single)).abs());
        let far = far.fold(0.0, f64::max) / largest;
        println!("n = {n}: {far:.1e}");
        assert!(far < PROMISED, "{n}: {far:e}");
    }
}
