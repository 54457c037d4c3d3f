//! How often 95 % intervals contain the truth where instrument and body are wrong within their stated uncertainty; prints a table in Markdown.
//!
//! The paper's ball through the paper's test (a), 20 Hz, with 0.05 N of noise. Of every record the zero and the gain of the force, the zero and
//! the gain of the displacement, first touch, the radius and the given modulus are off their stated values by random amounts. Run it with
//! `cargo run --release -p palpate --example budget_study [records]`.

use std::collections::BTreeMap;

use palpate::analysis::{AnalysisOptions, Geometry, analyze};
use palpate::budget::{Distribution, InputQuantity};
use palpate::calibrate::{CalibrationData, Candidate, EquilibriumLaw, calibrate};
use palpate::contact::{Layers, Shape, ShapeDimension, Sides, Specimen};
use palpate::instrument::{Instrument, InstrumentInput, InstrumentQuantity};
use palpate::latency::LatencyLaw;
use palpate::record::Record;
use palpate::simulate::{ContactModel, Motion, ProtocolStep, Sampling, Separation, protocol, simulate_force};
use palpate::test_problems::{PAPER_RATE, Rng, paper_test_a};
use palpate::watch::Unwatched;

const RADIUS: f64 = 0.035;
const MODULUS: f64 = 28e3;

/// Limits that are stated, in SI; all distributions are rectangular.
const STATED: [(InstrumentQuantity, f64); 7] = [
    (InstrumentQuantity::Force, 0.05),
    (InstrumentQuantity::ForceGain, 0.01),
    (InstrumentQuantity::Displacement, 20e-6),
    (InstrumentQuantity::DisplacementGain, 0.005),
    (InstrumentQuantity::Touch, 0.2e-3),
    (
        InstrumentQuantity::Body {
            dimension: ShapeDimension::Radius,
        },
        0.5e-3,
    ),
    (InstrumentQuantity::Modulus, 800.0),
];

/// Covered and all, for every result.
type Counts = BTreeMap<String, (u32, u32)>;

fn main() {
    let records: u64 = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(200);
    println!("| result | with the budget | scatter alone |\n|---|--:|--:|");
    let halves = std::thread::scope(|scope| {
        let halves = [0..records / 2, records / 2..records];
        let work = halves.map(|seeds| {
            scope.spawn(move || {
                let mut counts = [Counts::new(), Counts::new()];
                for seed in seeds {
                    counted(seed, &mut counts);
                }
                counts
            })
        });
        work.map(|half| half.join().expect("a half"))
    });
    let [[with, without], [more_with, more_without]] = &halves;
    for (name, counted) in with {
        let share = |(covered, all): (u32, u32), (more, others): (u32, u32)| {
            100.0 * f64::from(covered + more) / f64::from(all + others)
        };
        println!(
            "| {name} | {:.1} % | {:.1} % |",
            share(*counted, more_with[name]),
            share(without[name], more_without[name])
        );
    }
}

fn counted(seed: u64, counts: &mut [Counts; 2]) {
    let mut random = Rng::new(seed + 1);
    let off: Vec<f64> = STATED.iter().map(|(_, limit)| limit * (2.0 * random.uniform() - 1.0)).collect();
    let ball = |radius: f64| Shape::Ball { radius };
    let (radius, modulus) = (RADIUS + off[5], MODULUS);
    let truth = ContactModel {
        specimen: Specimen::new(ball(radius), modulus, Sides::Two).expect("a ball"),
        law: LatencyLaw::new(5.0, 2e4).expect("a law"),
        layers: Layers::of_thickness(RADIUS / 8.0, radius).expect("layers"),
        separation: Separation::Unilateral,
    };
    let motion = paper_test_a();
    let time: Vec<f64> = (0..=(motion.end() * 20.0) as u32).map(|i| f64::from(i) / 20.0).collect();
    let force = simulate_force(&motion, &truth, &time).expect("a simulation");
    let read = |force: &f64| (force - off[0]) / (1.0 + off[1]) + 0.05 * random.normal();
    let force: Vec<f64> = force.iter().map(read).collect();
    let place = |t: &f64| (motion.displacement_at(*t) - off[2] - off[4]) / (1.0 + off[3]) + 1e-6 * random.normal();
    let displacement: Vec<f64> = time.iter().map(place).collect();
    let record = Record::new(time, Some(displacement), force).expect("a record");
    let input = |(quantity, limit): &(InstrumentQuantity, f64)| InstrumentInput {
        quantity: *quantity,
        uncertainty: InputQuantity::limits(quantity.title(), quantity.unit(), 0.0, *limit, Distribution::Rectangular)
            .expect("limits"),
    };
    let instrument = Instrument {
        inputs: STATED.iter().map(input).collect(),
    };
    let options = |modulus: Option<f64>, instrument: &Instrument| AnalysisOptions {
        geometry: Some(Geometry {
            shape: ball(RADIUS),
            sides: Sides::Two,
            modulus,
            equilibrium: palpate::contact::Equilibrium::default(),
        }),
        instrument: instrument.clone(),
        exponents: vec![5.0],
        free_exponent: false,
        compare: None,
        separation: Separation::Unilateral,
        ..AnalysisOptions::default()
    };
    for (instrument, counts) in [instrument, Instrument::default()].iter().zip(counts) {
        let mut count = |name: &str, interval: Option<(f64, f64)>, truth: f64| {
            let found = counts.entry(name.to_owned()).or_default();
            found.0 += u32::from(interval.is_some_and(|(low, high)| low <= truth && truth <= high));
            found.1 += 1;
        };
        for (given, title) in [(Some(modulus + off[6]), "modulus given"), (None, "modulus estimated")] {
            let options = options(given, instrument);
            let found = analyze(&record, &options).expect("an analysis");
            for (hold, level) in found.holds.iter().zip([5e-3, 10e-3, 15e-3]) {
                let Some(fit) = hold.fit_with(5.0) else { continue };
                let strain = truth.specimen.equilibrium_strain(truth.specimen.contact_displacement(level));
                count(
                    &format!("{title}: equilibrium strain at {} mm", 1e3 * level),
                    fit.equilibrium().interval,
                    strain,
                );
                count(&format!("{title}: v at {} mm", 1e3 * level), fit.rate_coefficient().interval, 2e4);
            }
            if let Some(found) = found.modulus {
                let error = 1.96 * found.estimate.standard_error.unwrap_or(0.0);
                let value = found.estimate.value;
                count("modulus by the equilibrium forces", Some((value - error, value + error)), modulus);
            }
        }
        let data = CalibrationData::of_record(&record, &options(None, instrument)).expect("data");
        let candidate = Candidate::new("latency".parse().expect("a law"), EquilibriumLaw::UniformStrain);
        let found = calibrate(&data, candidate, 0.95, &mut Unwatched).expect("a calibration");
        for (name, truth) in [
            ("modulus_pa", modulus),
            ("exponent", 5.0),
            ("rate_coefficient_per_s", 2e4),
            ("layer_thickness_m", RADIUS / 8.0),
        ] {
            let estimate = found.material.estimate(name).expect("a parameter");
            count(&format!("calibrated: {name}"), estimate.interval, truth);
        }
        // A squeeze that the test did not have.
        let steps = [ProtocolStep {
            to: 12e-3,
            rate: 0.5 * PAPER_RATE,
            hold: 30.0,
        }];
        let other: Motion = protocol(&steps).expect("a motion");
        let at = [2.88, 5.0, 30.0];
        let true_force = simulate_force(&other, &truth, &at).expect("a simulation");
        let predicted = found.material.predict(&other, &Sampling::Times(at.to_vec()), 0.95).expect("a prediction");
        for (index, (time, force)) in at.iter().zip(true_force).enumerate() {
            count(&format!("predicted force at {time} s"), predicted.force_interval(index), force);
        }
    }
}
