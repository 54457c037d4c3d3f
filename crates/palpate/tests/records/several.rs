//! Several records in one calibration: recovery, coverage, the material of another specimen, refusals.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use palpate::analysis::{AnalysisOptions, Geometry};
use palpate::calibrate::{
    BatchRecord, Between, CalibrationData, Candidate, EquilibriumLaw, MaterialParameter, SeveralCalibration,
    SeveralError, Spread, calibrate, calibrate_several,
};
use palpate::contact::{Layers, Shape, Specimen};
use palpate::fit::Estimate;
use palpate::record::Record;
use palpate::simulate::{ContactModel, Motion, ProtocolStep, Sampling, Separation, protocol, simulate_force};
use palpate::test_problems::{Rng, paper_ball};
use palpate::watch::{Cancelled, Progress, Unwatched};

/// A specimen of the paper's ball with another radius (m), modulus (Pa) and layer thickness (m).
pub(crate) fn specimen(radius: f64, modulus: f64, thickness: f64) -> ContactModel {
    let ball = paper_ball(Separation::Unilateral);
    let specimen = Specimen::new(Shape::Ball { radius }, modulus, ball.specimen.sides()).unwrap();
    let layers = Layers::of_thickness(thickness, specimen.depth()).unwrap();
    ContactModel {
        specimen,
        layers,
        ..ball
    }
}

pub(crate) fn squeezes() -> Motion {
    let step = |to: f64| ProtocolStep {
        to,
        rate: 0.5 / 60.0,
        hold: 15.0,
    };
    protocol(&[step(0.004), step(0.008), step(0.004)]).unwrap()
}

pub(crate) fn record(name: &str, model: &ContactModel, rate_hz: f64, noise: f64, random: &mut Rng) -> BatchRecord {
    let motion = squeezes();
    let times: Vec<f64> = (0..).map(|i| f64::from(i) / rate_hz).take_while(|t| *t <= motion.end()).collect();
    let forces = simulate_force(&motion, model, &times).unwrap();
    let forces = forces.iter().map(|force| force + noise * random.normal()).collect();
    let body = Geometry {
        shape: model.specimen.shape().clone(),
        sides: model.specimen.sides(),
        modulus: None,
        equilibrium: palpate::contact::Equilibrium::default(),
    };
    BatchRecord {
        name: name.to_owned(),
        data: CalibrationData::new(body, model.separation, motion, times, forces, &[]).unwrap(),
    }
}

pub(crate) fn together(records: &[BatchRecord], law: &str, shared: &str) -> Result<SeveralCalibration, SeveralError> {
    let candidate = Candidate::new(law.parse().unwrap(), EquilibriumLaw::UniformStrain);
    calibrate_several(records, candidate, &shared.parse().unwrap(), 0.95, &mut Unwatched)
}

pub(crate) fn shared(found: &SeveralCalibration, name: &str) -> (Estimate, Option<f64>) {
    match found.parameter(name) {
        Some(Between::Shared { estimate, one_value_p }) => (*estimate, *one_value_p),
        other => panic!("{name}: {other:?}"),
    }
}

pub(crate) fn own(found: &SeveralCalibration, name: &str) -> (Estimate, Spread) {
    match found.parameter(name) {
        Some(Between::Own { mean, spread }) => (*mean, *spread),
        other => panic!("{name}: {other:?}"),
    }
}

fn has(interval: Option<(f64, f64)>, value: f64) -> bool {
    interval.is_some_and(|(low, high)| low <= value && value <= high)
}

/// Two sizes of one material: what they share comes back, and what differs is each record's own.
#[test]
fn bodies_of_different_size_share_what_is_the_same() {
    let mut random = Rng::new(1);
    let bodies = [(0.035, 28e3), (0.025, 28e3), (0.03, 28e3)];
    let records: Vec<BatchRecord> = bodies
        .iter()
        .enumerate()
        .map(|(i, (radius, modulus))| {
            record(&format!("ball {i}"), &specimen(*radius, *modulus, radius / 8.0), 5.0, 0.0, &mut random)
        })
        .collect();
    let found = together(&records, "latency", "modulus,exponent,rate_coefficient").unwrap();
    for (name, truth) in [("modulus_pa", 28e3), ("exponent", 5.0), ("rate_coefficient_per_s", 2e4)] {
        let value = shared(&found, name).0.value;
        assert!((value / truth - 1.0).abs() < 1e-4, "{name}: {value}");
    }
    for ((radius, _), specimen) in bodies.iter().zip(&found.specimens) {
        let thickness = specimen.material.estimate("layer_thickness_m").unwrap().value;
        assert!((thickness / (radius / 8.0) - 1.0).abs() < 1e-4 && specimen.relative < 1e-7, "{thickness}");
    }
    assert_eq!(found.free_parameters, 6);
    // The standard deviation of the logarithms of 35, 25 and 30 mm.
    let (_, spread) = own(&found, "layer_thickness_m");
    let logs = bodies.map(|(radius, _)| f64::ln(radius));
    let mean = logs.iter().sum::<f64>() / 3.0;
    let truth = (logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / 2.0).sqrt();
    assert!((spread.deviation / truth - 1.0).abs() < 1e-3, "{spread:?} {truth}");
}

/// With nothing shared the records are calibrated alone: the same parameters with the same errors, from another search.
#[test]
fn with_nothing_shared_each_record_is_calibrated_alone() {
    let mut random = Rng::new(2);
    let model = specimen(0.035, 28e3, 0.004);
    let records = [record("a", &model, 5.0, 0.05, &mut random), record("b", &model, 5.0, 0.05, &mut random)];
    let found = together(&records, "latency", "none").unwrap();
    for (record, specimen) in records.iter().zip(&found.specimens) {
        let alone = calibrate(&record.data, found.candidate, 0.95, &mut Unwatched).unwrap();
        for (together, alone) in specimen.material.parameters().iter().zip(alone.material.parameters()) {
            let (a, b) = (together.estimate, alone.estimate);
            let errors = a.standard_error.unwrap() / b.standard_error.unwrap();
            // A standard error is a quantile of a mixture: those of a combination do not follow exactly from those of its parts.
            assert!(
                (a.value / b.value - 1.0).abs() < 1e-5 && (errors - 1.0).abs() < 2e-2,
                "{}: {a:?} {b:?}",
                together.name
            );
        }
    }
    assert!(found.specimen.is_none());
}

/// Two tests of one body say more than one: standard errors fall by √2, and the material is the body.
#[test]
fn one_body_tested_twice_is_known_better() {
    let mut random = Rng::new(3);
    let model = specimen(0.035, 28e3, 0.004);
    let records = [record("a", &model, 5.0, 0.05, &mut random), record("b", &model, 5.0, 0.05, &mut random)];
    let found = together(&records, "latency", "all").unwrap();
    let alone = calibrate(&records[0].data, found.candidate, 0.95, &mut Unwatched).unwrap();
    let (material, samples) = (found.specimen.as_ref().unwrap(), 2 * records[0].data.fitted());
    for (name, truth) in [("modulus_pa", 28e3), ("exponent", 5.0), ("layer_thickness_m", 0.004)] {
        let (both, one) = (material.estimate(name).unwrap(), alone.material.estimate(name).unwrap());
        let ratio = one.standard_error.unwrap() / both.standard_error.unwrap();
        assert!((1.2..1.7).contains(&ratio) && (both.value / truth - 1.0).abs() < 0.05, "{name}: {ratio} {both:?}");
    }
    assert_eq!(material.uncertainty().unwrap().freedom, (samples - 4) as f64);
    assert_eq!(found.specimens[0].material.values(), material.values());
}

/// A batch whose exponent differs contradicts one exponent; one with a common exponent does not.
#[test]
fn records_contradict_what_they_do_not_share() {
    let mut random = Rng::new(4);
    let mut batch = |thicknesses: [f64; 3]| -> Vec<BatchRecord> {
        let one = |(i, thickness): (usize, &f64)| {
            record(&format!("{i}"), &specimen(0.035, 28e3, *thickness), 5.0, 0.02, &mut random)
        };
        thicknesses.iter().enumerate().map(one).collect()
    };
    let (same, different) = (batch([0.004; 3]), batch([0.003, 0.004, 0.005]));
    let p = |records| shared(&together(records, "latency", "layer_thickness").unwrap(), "layer_thickness_m").1.unwrap();
    assert!(p(&same) > 0.01 && p(&different) < 1e-6);
}

/// A record of a few noisy readings in the holds alone leaves its parameters open. What it shares with the others closes them.
#[test]
fn a_record_that_is_open_alone_is_determined_by_the_others() {
    let (mut open, mut random) = (0, Rng::new(8));
    let model = specimen(0.035, 28e3, 0.0044);
    for _ in 0..4 {
        let records: Vec<BatchRecord> = [("a", 10.0, 0.05), ("b", 10.0, 0.05), ("sparse", 0.3, 0.2)]
            .into_iter()
            .map(|(name, rate_hz, noise)| record(name, &model, rate_hz, noise, &mut random))
            .collect();
        let found = together(&records, "latency", "exponent,rate_coefficient,layer_thickness").unwrap();
        let alone = calibrate(&records[2].data, found.candidate, 0.95, &mut Unwatched).unwrap();
        let is_open = |parameter: &MaterialParameter| parameter.estimate.standard_error.is_none();
        open += usize::from(alone.material.parameters().iter().any(is_open));
        let modulus = found.specimens[2].material.estimate("modulus_pa").unwrap();
        assert!((modulus.value - 28e3).abs() < 4.0 * modulus.standard_error.unwrap(), "{modulus:?}");
    }
    assert!(open > 0, "no record is open alone");
}

/// A short form of `validation/batches.sh`: of 40 batches of five specimens the intervals contain the truth 33 times at least, which 95 % does
/// in all but 1 of 1000.
#[test]
fn intervals_of_batches_contain_the_truth() {
    const BATCHES: usize = 40;
    let (tau, rate) = (0.15, 0.5 / 60.0);
    let mut random = Rng::new(5);
    let mut draw = |log: f64| log.exp() * (tau * random.normal()).exp();
    let squeeze = protocol(&[ProtocolStep {
        to: 0.006,
        rate,
        hold: 60.0,
    }])
    .unwrap();
    let times: Vec<f64> = [0.0, 10.0, 60.0].iter().map(|after| 0.006 / rate + after).collect();
    let mut covered = [0; 6];
    for batch in 0..BATCHES {
        let mut noise = Rng::new(1000 + batch as u64);
        let mut another = || specimen(0.035, draw(28e3f64.ln()), 0.004);
        let records: Vec<BatchRecord> =
            (0..5).map(|i| record(&format!("{i}"), &another(), 3.0, 0.05, &mut noise)).collect();
        let found = together(&records, "latency:5", "rate_coefficient,layer_thickness").unwrap();
        let (mean, spread) = own(&found, "modulus_pa");
        let sixth = simulate_force(&squeeze, &another(), &times).unwrap();
        let material = found.specimen.as_ref().unwrap();
        let predicted = material.predict(&squeeze, &Sampling::Times(times.clone()), 0.95).unwrap();
        let of_sixth = |i: usize| has(predicted.force_interval(i), sixth[i]);
        let is_covered = [
            has(shared(&found, "rate_coefficient_per_s").0.interval, 2e4),
            has(mean.interval, 28e3),
            has(Some(spread.interval), tau),
            of_sixth(0),
            of_sixth(1),
            of_sixth(2),
        ];
        covered.iter_mut().zip(is_covered).for_each(|(count, is)| *count += usize::from(is));
    }
    assert!(covered.iter().all(|count| *count >= 33), "{covered:?}");
}

#[test]
fn what_is_no_batch_is_refused() {
    let mut random = Rng::new(6);
    let model = specimen(0.035, 28e3, 0.004);
    let [a, b] = ["a.csv", "b.csv"].map(|name| record(name, &model, 5.0, 0.05, &mut random));
    let refused = |records: &[BatchRecord], law: &str, shared: &str| together(records, law, shared).unwrap_err();
    let one = refused(std::slice::from_ref(&a), "latency", "all");
    assert_eq!(one.to_string(), "a calibration of several records needs two or more, found 1");
    let twice = BatchRecord {
        name: "copy.csv".to_owned(),
        ..a.clone()
    };
    assert_eq!(
        refused(&[a.clone(), twice], "latency", "none").to_string(),
        "a.csv and copy.csv are the same record"
    );
    let unknown = refused(&[a.clone(), b.clone()], "prony:1", "exponent").to_string();
    assert_eq!(
        unknown,
        "expected shared parameters among modulus_pa, overshoot_1, time_constant_1_s, found \"exponent\""
    );
    let candidate = Candidate::new("latency".parse().unwrap(), EquilibriumLaw::Table);
    let table = calibrate_several(&[a.clone(), b.clone()], candidate, &Default::default(), 0.95, &mut Unwatched);
    assert!(matches!(table, Err(SeveralError::Table)));
    // A record in which the jaw moves the other way determines nothing.
    let negative: Vec<f64> = b.data.forces().iter().map(|force| -force).collect();
    let data = CalibrationData::new(
        b.data.geometry().clone(),
        Separation::Unilateral,
        squeezes(),
        b.data.times().to_vec(),
        negative,
        &[],
    )
    .unwrap();
    let pulled = BatchRecord { data, ..b.clone() };
    let error = refused(&[a.clone(), pulled], "latency", "none");
    assert!(error.to_string().starts_with("b.csv: the force does not rise"), "{error}");
    assert_eq!(error.hint(), "check the signs of force and displacement, or leave the record out");
    let mut ended = |_: Progress<'_>| Err(Cancelled);
    let candidate = Candidate::new("latency".parse().unwrap(), EquilibriumLaw::UniformStrain);
    let cancelled = calibrate_several(&[a, b], candidate, &Default::default(), 0.95, &mut ended);
    assert!(matches!(cancelled, Err(SeveralError::Cancelled(_))));
}

/// A ball squeezed as the others, of which the record has these forces (N).
fn recorded(name: &str, force: impl Fn(f64) -> f64) -> BatchRecord {
    let (motion, model) = (squeezes(), specimen(0.035, 28e3, 0.035 / 8.0));
    let times: Vec<f64> = (0..).map(|i| 0.1 * f64::from(i)).take_while(|t| *t <= motion.end()).collect();
    let forces = simulate_force(&motion, &model, &times).unwrap().into_iter().map(force).collect();
    let displacement = times.iter().map(|t| motion.displacement_at(*t)).collect();
    let options = AnalysisOptions {
        geometry: Some(Geometry {
            shape: model.specimen.shape().clone(),
            sides: model.specimen.sides(),
            modulus: None,
            equilibrium: palpate::contact::Equilibrium::default(),
        }),
        ..AnalysisOptions::default()
    };
    let record = Record::new(times, Some(displacement), forces).unwrap();
    BatchRecord {
        name: name.to_owned(),
        data: CalibrationData::of_record(&record, &options).unwrap(),
    }
}

/// A load cell that was not connected gave 1 N throughout, and the mean modulus of the batch half of what it is.
#[test]
fn a_broken_record_of_several_is_named() {
    let mut random = Rng::new(7);
    let mut records: Vec<BatchRecord> = ["a.csv", "b.csv", "c.csv"]
        .into_iter()
        .map(|name| record(name, &specimen(0.035, 28e3, 0.035 / 8.0), 10.0, 0.02, &mut random))
        .collect();
    let dead = records.iter().cloned().chain([recorded("dead.csv", |_| 1.0)]).collect::<Vec<_>>();
    let refused = together(&dead, "latency:5", "layer_thickness").unwrap_err();
    assert_eq!(refused.to_string(), "dead.csv: the force is 1.000 N throughout, while the jaw moves");
    assert!(refused.hint().ends_with("or leave the record out"), "{}", refused.hint());
    // One that follows no law stays, with a finding that the others do not have.
    let noise = std::cell::RefCell::new(Rng::new(9));
    records.push(recorded("stuck.csv", |force| force.min(2.0) + 0.02 * noise.borrow_mut().normal()));
    let found = together(&records, "latency:5", "layer_thickness").unwrap();
    let apart: Vec<&str> = found
        .specimens
        .iter()
        .filter(|specimen| specimen.findings.iter().any(|finding| finding.code() == "record_apart"))
        .map(|specimen| specimen.name.as_str())
        .collect();
    assert_eq!(apart, ["stuck.csv"], "{:?}", found.specimens.iter().map(|s| s.relative).collect::<Vec<_>>());
}
