//! Batches in single precision against the simulation of one contact: within 10⁻⁵ of the largest force of a contact.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::batch::{Batch, BatchError};
use palpate::contact::{Curve, Equilibrium, Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactModel, Motion, Separation, SimulateError, simulate_force};
use palpate::test_problems::{Noise, paper_ball, paper_test_a};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

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

/// Largest differences from the simulation of one contact, at the knots of the motions and nine times between any two, in units of the largest force
/// of its contact: of single precision and which contact, and of double precision. Motions must share their times.
fn worst(models: &[ContactModel], motions: &[Motion]) -> (f64, usize, f64) {
    let knots = motions[0].times();
    let between =
        |pair: &[f64]| (0..10).map(|i| pair[0] + (pair[1] - pair[0]) * f64::from(i) / 10.0).collect::<Vec<_>>();
    let mut times: Vec<f64> = knots.windows(2).flat_map(between).collect();
    times.push(knots[knots.len() - 1]);
    let batch = Batch::new(models, motions).unwrap();
    let double = batch.forces_at(&times).unwrap();
    let (single, ends) = (batch.forces_at_single(&times).unwrap(), batch.final_forces_single().unwrap());
    let mut worst = (0.0, 0, 0.0);
    for (index, (model, motion)) in models.iter().zip(motions).enumerate() {
        let expected = simulate_force(motion, model, &times).unwrap();
        let row = index * times.len()..(index + 1) * times.len();
        let largest = expected.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        let samples = single[row.clone()].iter().copied().enumerate().chain([(times.len() - 1, ends[index])]);
        for (sample, found) in samples {
            let far = (f64::from(found) - expected[sample]).abs() / largest;
            (worst.0, worst.1) = if far > worst.0 { (far, index) } else { (worst.0, worst.1) };
        }
        for (found, expected) in double[row].iter().zip(&expected) {
            if (found - expected).abs() / largest > 1e-10 {
                println!(
                    "DBG {:e} {:?} {:?} knots {:?}",
                    (found - expected).abs() / largest,
                    model.law,
                    model.layers,
                    motion
                );
            }
            worst.2 = f64::max(worst.2, (found - expected).abs() / largest);
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
    let (mut most, mut most_double) = (0.0, 0.0);
    for pieces in courses {
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
        let (far, index, double) = worst(&models, &motions);
        println!("{far:.1e} ({double:.1e} in double precision) {:?}", models[index]);
        (most, most_double) = (f64::max(most, far), f64::max(most_double, double));
    }
    assert!(most < PROMISED, "{most:e}");
    assert!(most_double < 1e-9, "{most_double:e}");
}

/// The same cases every time; `PROPTEST_CASES` and another seed explore further.
fn cases(count: u32) -> ProptestConfig {
    ProptestConfig {
        cases: std::env::var("PROPTEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(count),
        rng_seed: RngSeed::Fixed(std::env::var("PROPTEST_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(1)),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn any_contact() -> impl Strategy<Value = (ContactModel, Vec<(f64, f64)>)> {
    let whole = prop::sample::select(vec![1.0, 2.0, 3.0, 5.0]);
    let n = prop_oneof![whole, 0.5..8.0f64];
    let piece = (-3.0..5.5f64, prop_oneof![Just(None), (0.0..1.0f64).prop_map(Some)]);
    let law = (n, -4.0..4.0f64, 0.0..2.8f64, 0..3usize, -3.0..0.0f64);
    (law, prop::collection::vec(piece, 1..8)).prop_map(|((n, decades, layers, shape, size), pieces)| {
        let model = model(&shapes()[shape], n, 10f64.powf(n - 1.0 + decades), 10f64.powf(layers));
        // The first piece goes somewhere, the others go or hold.
        let mut place = 10f64.powf(size);
        let piece = |(seconds, to): (f64, Option<f64>)| {
            place = to.map_or(place, |to| to * 10f64.powf(size));
            (10f64.powf(seconds), place)
        };
        (model, std::iter::once((1.0, None)).chain(pieces).map(piece).collect())
    })
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn any_contact_keeps_what_is_promised((model, pieces) in any_contact()) {
        let motion = motion(&model, &pieces);
        let (far, _, double) = worst(std::slice::from_ref(&model), std::slice::from_ref(&motion));
        prop_assert!(far < PROMISED, "{far:e}");
        prop_assert!(double < 1e-9, "{double:e}");
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
        let double = simulate_force(&motion, &model, &times).unwrap();
        let single = batch.forces_at_single(&times).unwrap();
        let largest = double.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        let far = double.iter().zip(&single).map(|(double, single)| (double - f64::from(*single)).abs());
        let far = far.fold(0.0, f64::max) / largest;
        println!("n = {n}: {far:.1e}");
        assert!(far < PROMISED, "{n}: {far:e}");
    }
}

/// What single precision cannot do is in double precision: the same numbers, rounded.
#[test]
fn the_rest_is_done_in_double_precision() {
    let ball = shapes()[0].clone();
    let area = Curve::new(&[(0.0, 0.0), (0.002, 6e-5), (0.015, 2e-4)]).unwrap();
    let mut models: Vec<ContactModel> =
        [(0.3, 1e3), (12.0, 1e9), (40.0, 1.0), (5.0, 1e300), (5.0, 1e-300), (2.0, 1e40)]
            .iter()
            .map(|&(n, v)| model(&ball, n, v, 8.0))
            .collect();
    let fits = model(&ball, 3.0, 50.0, 8.0);
    models.push(fits.clone());
    models.push(model(&Shape::Profile { depth: 0.035, area }, 3.0, 50.0, 8.0));
    let hertz = fits.specimen.clone().with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.5 }).unwrap();
    models.push(ContactModel {
        specimen: hertz,
        ..fits.clone()
    });
    models.push(ContactModel {
        separation: Separation::Unilateral,
        ..fits
    });
    let motion = Motion::new(vec![0.0, 0.6, 10.0, 10.2, 1e6], vec![0.0, 0.01, 0.01, 0.001, 0.001]).unwrap();
    let times = [0.3, 0.6, 5.0, 10.1, 1e6];
    let batch = Batch::shared(&models, &motion).unwrap();
    let (double, single) = (batch.forces_at(&times).unwrap(), batch.forces_at_single(&times).unwrap());
    for (index, model) in models.iter().enumerate() {
        let row = index * times.len()..(index + 1) * times.len();
        let rounded: Vec<f32> = double[row.clone()].iter().map(|force| *force as f32).collect();
        assert_eq!(rounded == single[row], index != 6, "{:?}", model.law);
    }
}

/// A body in which nothing relaxes, one that is never touched, and one whose drive is tiny beside what relaxes.
#[test]
fn limits_are_met() {
    let ball = shapes()[0].clone();
    let models = [model(&ball, 5.0, 1e4, 1.0), model(&ball, 1.0, 1e-9, 8.0), model(&ball, 3.0, 1e6, 8.0)];
    let squeezed = Motion::new(vec![0.0, 1.0, 2.0, 1e7], vec![0.0, 0.01, 0.01, 0.0101]).unwrap();
    let times = [0.0, 0.5, 1.0, 1.5, 2.0, 1e3, 1e7];
    let forces = Batch::shared(&models, &squeezed).unwrap().forces_at_single(&times).unwrap();
    for (index, model) in models.iter().enumerate() {
        let expected = simulate_force(&squeezed, model, &times).unwrap();
        let largest = expected.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        for (found, expected) in forces[index * times.len()..].iter().zip(expected) {
            assert!((f64::from(*found) - expected).abs() < PROMISED * largest, "{index}: {found} {expected}");
        }
    }
    let still = Motion::new(vec![0.0, 5.0], vec![0.0, 0.0]).unwrap();
    assert_eq!(Batch::shared(&models, &still).unwrap().final_forces_single().unwrap(), [0.0; 3]);
}

#[test]
fn threads_change_no_bit() {
    let contact =
        |index: usize| model(&shapes()[index % 3], 0.4 + 0.023 * index as f64, 300.0, 1.0 + (index % 40) as f64);
    let models: Vec<ContactModel> = (0..333).map(contact).collect();
    let pieces = [(0.5, 0.5), (3.0, 0.5), (0.1, 0.2), (0.1, 1.0), (1e4, 1.0)];
    let motions: Vec<Motion> = models.iter().map(|model| motion(model, &pieces)).collect();
    let batch = Batch::new(&models, &motions).unwrap();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (ends, forces) = (batch.final_forces_single().unwrap(), batch.forces_at_single(&[0.25, 3.55]).unwrap());
            ends.iter().chain(&forces).map(|force| force.to_bits()).collect::<Vec<_>>()
        })
    };
    let one = run(1);
    assert!(one == run(2) && one == run(7));
}

#[test]
fn wrong_times_and_numbers_out_of_range_are_refused() {
    let motion = paper_test_a();
    let batch = Batch::shared(&vec![paper_ball(Separation::Bonded); 2], &motion).unwrap();
    for times in [vec![1.0, 67.0], vec![2.0, 1.0], vec![f64::NAN]] {
        let expected = batch.forces_at(&times).unwrap_err();
        assert_eq!(format!("{:?}", batch.forces_at_single(&times).unwrap_err()), format!("{expected:?}"));
    }
    assert!(batch.forces_at_single(&[]).unwrap().is_empty());
    assert!(Batch::shared(&[], &motion).unwrap().final_forces_single().unwrap().is_empty());
    // A force that is a double and no single number.
    let mut hard = paper_ball(Separation::Bonded);
    hard.specimen = Specimen::new(Shape::Ball { radius: 0.035 }, 1e45, Sides::One).unwrap();
    let squeezed = Motion::new(vec![0.0, 1.0], vec![0.0, 0.005]).unwrap();
    let batch = Batch::shared(&[paper_ball(Separation::Bonded), hard], &squeezed).unwrap();
    assert!(batch.final_forces().is_ok());
    let source = SimulateError::OutOfRange { time: 1.0 };
    assert_eq!(batch.final_forces_single().unwrap_err(), BatchError::Contact { index: 1, source });
}
