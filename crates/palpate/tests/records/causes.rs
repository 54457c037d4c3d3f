//! Errors of the instrument over several records: what they have in common, and what each has of its own.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use palpate::budget::{Cause, InputQuantity};
use palpate::calibrate::{BatchRecord, calibrate};
use palpate::instrument::{Instrument, InstrumentInput, InstrumentQuantity};
use palpate::simulate::Sampling;
use palpate::test_problems::Rng;
use palpate::watch::Unwatched;

use crate::several::{own, record, shared, specimen, squeezes, together};

/// A standard uncertainty of the gain of the load cell.
fn gain(share: f64, cause: Cause) -> InputQuantity {
    let quantity = InstrumentQuantity::ForceGain;
    InputQuantity::standard(quantity.title(), quantity.unit(), 0.0, share).unwrap().with_cause(cause)
}

/// A record of a body of this modulus (Pa) by a load cell whose gain is known like this.
fn stated(name: &str, modulus: f64, input: InputQuantity, random: &mut Rng) -> BatchRecord {
    let made = record(name, &specimen(0.035, modulus, 0.004), 3.0, 0.03, random);
    let inputs = vec![InstrumentInput {
        quantity: InstrumentQuantity::ForceGain,
        uncertainty: input,
    }];
    BatchRecord {
        data: made.data.with_instrument(Instrument { inputs }),
        ..made
    }
}

/// Of 24 batches of one body with 3 % of error in each record alone, 24 had a spread between specimens.
#[test]
fn one_body_has_no_spread_where_each_record_has_its_own_error() {
    let mut random = Rng::new(11);
    let mut found = [0; 2];
    for _ in 0..24 {
        let gains = [(); 4].map(|()| 0.03 * random.normal());
        for (count, cause) in found.iter_mut().zip([Cause::EachRecord, Cause::AsStated]) {
            // Less force by as much is a softer body.
            let one = |(i, off): (usize, &f64)| {
                stated(&i.to_string(), 28e3 * (1.0 + off), gain(0.03, cause.clone()), &mut random)
            };
            let records: Vec<BatchRecord> = gains.iter().enumerate().map(one).collect();
            let batch = together(&records, "latency:5", "rate_coefficient").unwrap();
            *count += u32::from(own(&batch, "modulus_pa").1.is_distinguishable());
        }
    }
    // 2.5 % of 24, and what an error of all records alike hides: nothing.
    assert!(found[0] <= 3 && found[1] == 24, "{found:?}");
}

/// Bodies of 28.0 and 29.4 kPa had one modulus with p = 0.8 where one load cell is known to 5 %.
#[test]
fn a_common_error_hides_no_difference() {
    let mut random = Rng::new(12);
    let mut p = |moduli: [f64; 4], cause: Cause| {
        let one =
            |(i, modulus): (usize, &f64)| stated(&i.to_string(), *modulus, gain(0.05, cause.clone()), &mut random);
        let records: Vec<BatchRecord> = moduli.iter().enumerate().map(one).collect();
        shared(&together(&records, "latency:5", "all").unwrap(), "modulus_pa").1.unwrap()
    };
    let (two, one) = ([28e3, 28e3, 29.4e3, 29.4e3], [28e3; 4]);
    assert!(p(two, Cause::AsStated) < 1e-9);
    assert!(p(two, Cause::EachRecord) > 0.05);
    assert!(p(one, Cause::AsStated) > 0.01);
}

/// Statements of 2 % and 2.01 % of one load cell had 0.71 of its error in the mean of four records.
#[test]
fn a_named_cause_is_one_whatever_its_size() {
    let mut random = Rng::new(13);
    let mut error = |causes: [Cause; 4]| {
        let one = |(i, cause): (usize, &Cause)| {
            stated(&i.to_string(), 28e3, gain(0.02 + 1e-4 * (i % 2) as f64, cause.clone()), &mut random)
        };
        let records: Vec<BatchRecord> = causes.iter().enumerate().map(one).collect();
        let found = together(&records, "latency:5", "all").unwrap();
        let estimate = shared(&found, "modulus_pa").0;
        assert_eq!(found.specimen.unwrap().estimate("modulus_pa").unwrap().standard_error, estimate.standard_error);
        estimate.standard_error.unwrap() / estimate.value
    };
    let named = |name: &str| Cause::Named(name.to_owned());
    let one = error([(); 4].map(|()| named("cell")));
    assert!((one - 0.02).abs() < 3e-4, "{one}");
    let four = error(["1", "2", "3", "4"].map(named));
    assert!((four - 0.01).abs() < 3e-4, "{four}");
    // As stated: two of each.
    let two = error([(); 4].map(|()| Cause::AsStated));
    assert!((two - 0.02 * 0.5_f64.sqrt()).abs() < 3e-4, "{two}");
}

/// An interval had 1.96 standard errors where the budget beside it has 3.18.
#[test]
fn degrees_of_freedom_of_an_input_are_in_intervals() {
    let mut random = Rng::new(14);
    let mut factors = |freedom: f64| {
        let input = gain(0.02, Cause::AsStated).with_freedom(freedom).unwrap();
        let record = stated("one", 28e3, input, &mut random);
        let candidate = palpate::calibrate::Candidate::new(
            "latency:5".parse().unwrap(),
            palpate::calibrate::EquilibriumLaw::UniformStrain,
        );
        let material = calibrate(&record.data, candidate, 0.95, &mut Unwatched).unwrap().material;
        let estimate = material.estimate("modulus_pa").unwrap();
        let budget = material.budget("modulus_pa").unwrap();
        let half = (estimate.interval.unwrap().1 / estimate.value).ln() * estimate.value;
        assert!((half / budget.expanded(0.95) - 1.0).abs() < 1e-3, "{half} {}", budget.expanded(0.95));
        let predicted = material.predict(&squeezes(), &Sampling::Times(vec![12.0]), 0.95).unwrap();
        let (below, above) = predicted.force_half_widths.unwrap()[0];
        [
            half / estimate.standard_error.unwrap(),
            0.5 * (below + above) / predicted.force_standard_error.unwrap()[0],
        ]
    };
    for (freedom, expected) in [(3.0, 3.182), (f64::INFINITY, 1.960)] {
        let found = factors(freedom);
        assert!(found.iter().all(|factor| (factor / expected - 1.0).abs() < 0.02), "{freedom}: {found:?}");
    }
}
