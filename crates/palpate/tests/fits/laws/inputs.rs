//! Inputs that are no holds: every law refuses them with a reason or says why it has no answer, and never panics.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

#[path = "../../any_hold/mod.rs"]
mod any_hold;

use any_hold::{LAWS, fit_any, is_valid};
use palpate::fit::{ExponentChoice, FitError, FitOptions, LawOptions, Loss, Samples, Termination, fit_law, fit_rates};
use palpate::laws::{Law, Response};
use palpate::test_problems::Rng;
use proptest::prelude::*;

fn forms() -> impl Iterator<Item = (Law, LawOptions)> {
    let laws = LAWS.into_iter().map(|name| name.parse::<Law>().unwrap());
    let both = laws.flat_map(|law| [(law, Response::Relaxation), (law, Response::Creep)]);
    both.filter(|(law, response)| law.describes(*response)).map(|(law, response)| {
        let options = LawOptions {
            response,
            ..LawOptions::default()
        };
        (law, options)
    })
}

/// Fits every law; each must refuse as `expected` says.
fn all_refuse(samples: &Samples<'_>, expected: impl Fn(&FitError) -> bool) {
    for (law, options) in forms() {
        let error = fit_law(samples, law, &options).unwrap_err();
        assert!(expected(&error), "{law} {:?}: {error:?}", options.response);
    }
}

fn clean(times: &[f64]) -> Vec<f64> {
    times.iter().map(|t| 1.0 + (-0.5 * t).exp()).collect()
}

fn times(count: u32) -> Vec<f64> {
    (0..count).map(|i| 0.2 * f64::from(i)).collect()
}

#[test]
fn columns_that_are_no_hold_are_refused() {
    let times = times(60);
    let values = clean(&times);
    all_refuse(&Samples::new(&times, &[2.0; 60]), |error| matches!(error, FitError::Constant { .. }));
    all_refuse(&Samples::new(&times[..2], &values[..2]), |error| matches!(error, FitError::TooFewSamples { .. }));
    all_refuse(&Samples::new(&[], &[]), |error| matches!(error, FitError::TooFewSamples { .. }));
    all_refuse(&Samples::new(&times[..59], &values), |error| matches!(error, FitError::Lengths { .. }));
    all_refuse(&Samples::new(&[1.0; 60], &values), |error| *error == FitError::TimeNotRising { index: 1 });
    for (place, time) in [(7, times[6]), (30, 0.0)] {
        let mut wrong = times.clone();
        wrong[place] = time;
        all_refuse(&Samples::new(&wrong, &values), |error| *error == FitError::TimeNotRising { index: place });
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut wrong = values.clone();
        wrong[13] = bad;
        let named = |error: &FitError, name: &str| matches!(error, FitError::NotFinite { index: 13, what, .. } if *what == name);
        all_refuse(&Samples::new(&times, &wrong), |error| named(error, "value"));
        let mut wrong = times.clone();
        wrong[13] = bad;
        all_refuse(&Samples::new(&wrong, &values), |error| named(error, "time"));
    }
}

#[test]
fn deviations_that_are_none_are_refused_and_infinite_ones_leave_samples_out() {
    let times = times(60);
    let values = clean(&times);
    for bad in [0.0, -1.0, f64::NAN] {
        let mut standard_deviations = [0.1; 60];
        standard_deviations[5] = bad;
        let samples = Samples::new(&times, &values).with_standard_deviations(&standard_deviations);
        all_refuse(&samples, |error| matches!(error, FitError::StandardDeviation { index: 5, .. }));
    }
    let (mut spoilt, mut standard_deviations) = (values.clone(), [0.1; 60]);
    (spoilt[20], standard_deviations[20]) = (1e6, f64::INFINITY);
    for (law, options) in forms() {
        let with =
            fit_law(&Samples::new(&times, &spoilt).with_standard_deviations(&standard_deviations), law, &options)
                .unwrap();
        assert_eq!(with.samples, 59);
        let rest = |column: &[f64]| [&column[..20], &column[21..]].concat();
        let without = fit_law(&Samples::new(&rest(&times), &rest(&values)), law, &options).unwrap();
        let close = (with.rmse - without.rmse).abs() <= 1e-6 * without.rmse + 1e-12;
        assert!(close, "{law} {:?}: {} {}", options.response, with.rmse, without.rmse);
    }
}

#[test]
fn signals_without_a_law_end_with_a_reason() {
    let times = times(80);
    let mut random = Rng::new(9);
    let ramp: Vec<f64> = times.iter().map(|t| 3.0 - 0.1 * t).collect();
    let step: Vec<f64> = times.iter().map(|t| if *t < 5.0 { 1.0 } else { 0.0 }).collect();
    let spike: Vec<f64> = times.iter().map(|t| if *t == 0.0 { 1.0 } else { 0.0 }).collect();
    let noise: Vec<f64> = times.iter().map(|_| random.normal()).collect();
    let faint: Vec<f64> = times.iter().map(|t| 1.0 + 1e-3 * (-0.5 * t).exp() + random.normal()).collect();
    for (name, values) in [("ramp", &ramp), ("step", &step), ("spike", &spike), ("noise", &noise), ("faint", &faint)] {
        for (law, options) in forms() {
            let fit = fit_law(&Samples::new(&times, values), law, &options).unwrap();
            assert!(fit.termination != Termination::Converged || is_valid(&fit), "{name}, {law}: {fit:?}");
            let curve = times.iter().map(|t| fit.predict(*t));
            let left: f64 = curve.zip(values).map(|(f, y)| (y - f).powi(2)).sum();
            // Amplitudes of merged terms cancel to their last digits.
            let largest = fit.curve.terms.iter().map(|term| term.amplitude.abs()).fold(0.0, f64::max);
            let floor = 80.0 * (1e-15 * largest).powi(2) + 1e-20;
            let digits = if fit.termination == Termination::Converged { 1e-6 } else { 1e-3 };
            assert!((left - fit.residual_square).abs() <= digits * left + floor, "{name}, {law}: {left} {fit:?}");
        }
    }
    // A straight line has no time of its own in a law that bends.
    for law in ["latency:5", "sls", "logarithmic", "diffusion"] {
        let fit = fit_law(&Samples::new(&times, &ramp), law.parse().unwrap(), &LawOptions::default()).unwrap();
        assert!(fit.termination != Termination::Converged && fit.white_covariance.is_none(), "{law} {fit:?}");
    }
}

/// Parameters of all sizes, and those that are none.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -10.0..10.0f64,
        1 => any::<f64>(),
        1 => prop_oneof![Just(0.0), Just(1.7e9), Just(f64::NAN), Just(f64::INFINITY), Just(1e-300), Just(1e300)],
    ]
}

/// Columns that mostly have rising times, so that fits are reached.
fn columns() -> impl Strategy<Value = [Vec<f64>; 3]> {
    let rising = prop::collection::vec(1e-3..3.0f64, 0..40).prop_map(|steps| {
        let mut time = 0.0;
        steps
            .into_iter()
            .map(|step| {
                time += step;
                time
            })
            .collect::<Vec<f64>>()
    });
    let times = prop_oneof![5 => rising, 1 => prop::collection::vec(number(), 0..40)];
    (
        times,
        prop::collection::vec(number(), 40),
        prop::collection::vec(prop_oneof![6 => 0.1..10.0f64, 1 => number()], 40),
        any::<bool>(),
        1e-12..1e12f64,
    )
        .prop_map(|(times, mut values, mut standard_deviations, smooth, unit)| {
            if smooth {
                values = times.iter().map(|t| unit * (1.0 + (-t).exp())).collect();
            }
            values.resize(times.len(), 1.0);
            standard_deviations.resize(times.len(), 1.0);
            [times, values, standard_deviations]
        })
}

/// Values whose squares run out of doubles left a search with bounds that are no numbers, and it panicked.
#[test]
fn values_whose_squares_overflow_make_no_fit_panic() {
    let times = [0.001, 1.09, 2.7, 4.1, 6.6, 7.5, 9.7, 9.701, 12.4, 12.9, 14.9];
    let values = [1.9e167, 0.0, -7.7e103, 0.0, -5.0, 0.0, -5.6, 8.5, 0.0, -6.7, 6.7];
    for law in LAWS {
        for loss in [Loss::Squares, Loss::Huber, Loss::Tukey] {
            let options = LawOptions {
                loss,
                ..LawOptions::default()
            };
            if let Ok(fit) = fit_law(&Samples::new(&times, &values), law.parse().unwrap(), &options) {
                assert!(fit.termination != Termination::Converged || is_valid(&fit), "{fit:?}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_columns_make_the_fit_of_a_law_panic([times, values, standard_deviations] in columns(), weighted in any::<bool>(), robust in 0..4u8, law in 0..LAWS.len(), creep in any::<bool>()) {
        let law: Law = LAWS[law].parse().unwrap();
        let options = LawOptions {
            response: if creep { Response::Creep } else { Response::Relaxation },
            loss: match robust { 0 => Loss::Huber, 1 => Loss::Tukey, _ => Loss::Squares },
            one_sign: robust == 2,
            ..LawOptions::default()
        };
        let samples = Samples::new(&times, &values);
        let samples = if weighted { samples.with_standard_deviations(&standard_deviations) } else { samples };
        if let Ok(fit) = fit_law(&samples, law, &options) {
            prop_assert!(fit.termination != Termination::Converged || is_valid(&fit), "{fit:?}");
        }
    }

    #[test]
    fn no_bytes_make_the_fit_of_a_law_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        fit_any(&bytes);
    }
}

/// One rate near the largest number there is made a fit that ended well, with an infinite residual.
#[test]
fn rates_whose_squares_are_no_numbers_are_refused() {
    let strains: Vec<f64> = (0..40).map(|i| 0.2 + 0.05 * (-0.1 * f64::from(i)).exp()).collect();
    let mut rates: Vec<f64> = strains.iter().map(|strain| -(strain - 0.2)).collect();
    rates[7] = 1.7e308;
    let found = fit_rates(&strains, &rates, ExponentChoice::Free, &FitOptions::default());
    assert!(found.as_ref().map_or(true, |fit| fit.rmse.is_finite()), "{found:?}");
}
