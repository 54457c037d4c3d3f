//! What may be required of a fit does what it says: bounds, fixed parameters, constants, signs, samples.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::fit::{ConstantChoice, Fit, FitError, LawOptions, Parameter, SampleChoice, Samples, Termination, fit_law};
use palpate::laws::{Law, Response};
use palpate::test_problems::Rng;

/// 2 + 3 exp(−t/4) + noise over 40 s.
fn hold(noise: f64) -> (Vec<f64>, Vec<f64>) {
    let mut random = Rng::new(3);
    let times: Vec<f64> = (0..400).map(|i| 0.1 * f64::from(i)).collect();
    let values = times.iter().map(|t| 2.0 + 3.0 * (-t / 4.0).exp() + noise * random.normal()).collect();
    (times, values)
}

fn fit(law: &str, options: &LawOptions, noise: f64) -> Result<Fit, FitError> {
    let (times, values) = hold(noise);
    fit_law(&Samples::new(&times, &values), law.parse().unwrap(), options)
}

fn bounded(name: &str, low: f64, high: f64) -> LawOptions {
    LawOptions {
        bounds: vec![(name.to_owned(), (low, high))],
        ..LawOptions::default()
    }
}

#[test]
fn a_bound_that_binds_is_kept_and_stated() {
    let free = fit("sls", &LawOptions::default(), 1e-3).unwrap();
    let within = fit("sls", &bounded("time_constant_s", 1.0, 10.0), 1e-3).unwrap();
    assert!((within.value("time_constant_s").unwrap() / free.value("time_constant_s").unwrap() - 1.0).abs() < 1e-9);
    let at = fit("sls", &bounded("time_constant_s", 5.0, 10.0), 1e-3).unwrap();
    assert!((at.value("time_constant_s").unwrap() - 5.0).abs() < 1e-6);
    assert_eq!(at.termination, Termination::RateAtBound);
    assert!(at.white_covariance.is_none());
    let level = fit("sls", &bounded("equilibrium", 2.5, 9.0), 1e-3).unwrap();
    assert!((level.value("equilibrium").unwrap() - 2.5).abs() < 1e-9);
    assert_eq!(level.termination, Termination::AmplitudeAtBound);
    // As if the equilibrium were known exactly, a band of the curve held none of 62 true curves.
    let has_error =
        |parameter: &Parameter| parameter.estimate.interval.is_some() || parameter.estimate.standard_error.is_some();
    assert!(level.uncertainty.is_none() && !level.parameters.iter().any(has_error), "{level:?}");
    assert!(level.residual_square > free.residual_square);
}

#[test]
fn a_known_equilibrium_is_held_by_its_name_or_as_the_constant() {
    let named = LawOptions {
        fixed: vec![("equilibrium".to_owned(), 1.5)],
        ..LawOptions::default()
    };
    let constant = LawOptions {
        constant: ConstantChoice::Fixed(1.5),
        ..LawOptions::default()
    };
    for law in ["sls", "latency", "latency:3", "prony:2", "maxwell", "stretched"] {
        let (named, constant) = (fit(law, &named, 1e-3).unwrap(), fit(law, &constant, 1e-3).unwrap());
        assert_eq!((&named.parameters, named.rmse), (&constant.parameters, constant.rmse), "{law}");
        let equilibrium = named.estimate("equilibrium").unwrap();
        assert_eq!((equilibrium.value, equilibrium.standard_error), (1.5, None));
        assert!(!named.searched.contains(&"equilibrium".to_owned()));
    }
}

#[test]
fn what_cannot_be_held_is_refused_and_never_passed_over() {
    let held = |name: &str, value: f64| LawOptions {
        fixed: vec![(name.to_owned(), value)],
        ..LawOptions::default()
    };
    for (law, name) in [("sls", "amplitude"), ("prony:2", "amplitude_1"), ("latency", "amplitude")] {
        let error = fit(law, &held(name, 3.0), 1e-3).unwrap_err();
        assert!(
            matches!(&error, FitError::HeldAmplitude { name: found, held } if found == name && held.contains("equilibrium"))
        );
        assert_eq!(held(name, 3.0).suit(law.parse().unwrap()), Err(error));
    }
    for value in [f64::NAN, f64::INFINITY] {
        for name in ["equilibrium", "time_constant_s"] {
            let error = fit("sls", &held(name, value), 1e-3).unwrap_err();
            assert!(matches!(error, FitError::FixedParameter { .. }), "{error}");
        }
    }
    assert!(fit("sls", &held("equilibrium", -1.0), 1e-3).is_ok());
}

#[test]
fn what_is_held_outside_of_its_bounds_is_refused() {
    for (law, name, value) in
        [("sls", "time_constant_s", 4.0), ("sls", "equilibrium", 2.0), ("latency", "exponent", 3.0)]
    {
        let held = |low: f64, high: f64| LawOptions {
            fixed: vec![(name.to_owned(), value)],
            ..bounded(name, low, high)
        };
        for (low, high) in [(value + 0.5, f64::INFINITY), (f64::NEG_INFINITY, value - 0.5), (0.1, 0.2)] {
            let error = fit(law, &held(low, high), 1e-3).unwrap_err();
            assert_eq!(held(low, high).suit(law.parse().unwrap()), Err(error.clone()));
            assert_eq!(
                error.to_string(),
                format!("{name} cannot be fixed at {value}, outside of its bounds, {low} to {high}; give one of both")
            );
        }
        for (low, high) in [(value, value + 1.0), (value - 1.0, value), (f64::NEG_INFINITY, f64::INFINITY)] {
            let found = fit(law, &held(low, high), 1e-3).unwrap().value(name).unwrap();
            assert!((found / value - 1.0).abs() < 1e-12, "{law} {low} {high}: {found}");
        }
    }
    let constant = LawOptions {
        constant: ConstantChoice::Fixed(2.0),
        ..bounded("equilibrium", 3.0, 4.0)
    };
    assert!(matches!(fit("sls", &constant, 1e-3), Err(FitError::FixedOutsideBounds { found: 2.0, .. })));
}

#[test]
fn an_end_of_a_bound_may_be_left_open() {
    let free = fit("latency", &LawOptions::default(), 1e-3).unwrap();
    for (low, high) in [(f64::NEG_INFINITY, f64::INFINITY), (0.5, f64::INFINITY), (f64::NEG_INFINITY, 20.0)] {
        let within = fit("latency", &bounded("exponent", low, high), 1e-3).unwrap();
        assert!((within.value("exponent").unwrap() / free.value("exponent").unwrap() - 1.0).abs() < 1e-6);
    }
    let beyond = fit("latency", &bounded("exponent", 2.0, f64::INFINITY), 1e-3).unwrap();
    assert!((beyond.value("exponent").unwrap() - 2.0).abs() < 1e-9);
}

#[test]
fn there_is_no_signal_at_a_time_that_is_none() {
    let fit = fit("latency", &LawOptions::default(), 1e-3).unwrap();
    let values = fit.predict_many(&[f64::NAN, -1.0, 0.0]);
    assert!(values[0].is_nan() && values[1] == values[2]);
    let interval = fit.predict_interval(f64::NAN);
    assert!(interval.value.is_nan() && interval.interval.is_none());
}

#[test]
fn a_number_may_be_held() {
    let held = LawOptions {
        fixed: vec![("time_constant_s".to_owned(), 4.0)],
        ..LawOptions::default()
    };
    let fit_held = fit("sls", &held, 1e-3).unwrap();
    assert_eq!(fit_held.free_parameters(), 2);
    assert!((fit_held.value("time_constant_s").unwrap() - 4.0).abs() < 1e-12);
    assert!((fit_held.value("amplitude").unwrap() - 3.0).abs() < 1e-3);
    let stretching = LawOptions {
        fixed: vec![("stretching".to_owned(), 1.0)],
        ..LawOptions::default()
    };
    let (kww, sls) = (fit("stretched", &stretching, 1e-3).unwrap(), fit("sls", &LawOptions::default(), 1e-3).unwrap());
    assert!((kww.value("time_constant_s").unwrap() / sls.value("time_constant_s").unwrap() - 1.0).abs() < 1e-8);
    let constant = LawOptions {
        constant: ConstantChoice::Fixed(2.0),
        ..LawOptions::default()
    };
    let given = fit("sls", &constant, 0.0).unwrap();
    assert_eq!(given.value("equilibrium"), Some(2.0));
    assert!((given.value("time_constant_s").unwrap() - 4.0).abs() < 1e-9);
    let without = LawOptions {
        constant: ConstantChoice::Fixed(0.0),
        ..LawOptions::default()
    };
    let (maxwell, sls) = (fit("maxwell", &LawOptions::default(), 1e-3).unwrap(), fit("sls", &without, 1e-3).unwrap());
    assert!((maxwell.residual_square / sls.residual_square - 1.0).abs() < 1e-12);
}

#[test]
fn amplitudes_of_one_sign_make_no_redundant_terms() {
    let (times, values) = hold(3e-3);
    for sign in [1.0, -1.0] {
        let signal: Vec<f64> = values.iter().map(|y| sign * y).collect();
        let options = LawOptions {
            one_sign: true,
            ..LawOptions::default()
        };
        let fit = fit_law(&Samples::new(&times, &signal), Law::Prony { terms: 3 }, &options).unwrap();
        let amplitudes: Vec<f64> = (1..=3).map(|i| fit.value(&format!("amplitude_{i}")).unwrap()).collect();
        assert!(amplitudes.iter().all(|amplitude| sign * amplitude >= 0.0), "{amplitudes:?}");
    }
}

#[test]
fn log_spaced_samples_are_few_and_give_the_same_law() {
    let (times, values) = hold(1e-4);
    let options = LawOptions {
        samples: SampleChoice::LogSpaced(60),
        ..LawOptions::default()
    };
    let fit = fit_law(&Samples::new(&times, &values), Law::StandardLinearSolid, &options).unwrap();
    assert!((30..=61).contains(&fit.samples), "{}", fit.samples);
    assert!((fit.value("time_constant_s").unwrap() / 4.0 - 1.0).abs() < 1e-3);
}

#[test]
fn deviations_weigh_by_their_inverse_square() {
    let (times, mut values) = hold(0.0);
    // One sample in four is off, and known to be.
    let standard_deviations: Vec<f64> = (0..values.len()).map(|i| if i % 4 == 0 { 1e3 } else { 1e-3 }).collect();
    values.iter_mut().step_by(4).for_each(|y| *y += 1.0);
    let samples = Samples::new(&times, &values).with_standard_deviations(&standard_deviations);
    let fit = fit_law(&samples, Law::StandardLinearSolid, &LawOptions::default()).unwrap();
    assert!((fit.value("time_constant_s").unwrap() - 4.0).abs() < 1e-6);
    let left_out: Vec<f64> = standard_deviations.iter().map(|d| if *d > 1.0 { f64::INFINITY } else { 1.0 }).collect();
    let samples = Samples::new(&times, &values).with_standard_deviations(&left_out);
    let fit = fit_law(&samples, Law::StandardLinearSolid, &LawOptions::default()).unwrap();
    assert!((fit.value("time_constant_s").unwrap() - 4.0).abs() < 1e-9);
}

#[test]
fn creep_and_relaxation_are_one_fit_in_other_words() {
    let (times, values) = hold(1e-3);
    let creep = LawOptions {
        response: Response::Creep,
        ..LawOptions::default()
    };
    let samples = Samples::new(&times, &values);
    for law in ["latency", "latency:3", "sls", "prony:2", "stretched", "fractional-zener", "diffusion"] {
        let law: Law = law.parse().unwrap();
        let relaxing = fit_law(&samples, law, &LawOptions::default()).unwrap();
        let creeping = fit_law(&samples, law, &creep).unwrap();
        let scale = relaxing.residual_square;
        assert!((creeping.residual_square / scale - 1.0).abs() < 1e-9, "{law}");
        for t in [0.0, 3.0, 50.0] {
            assert!((relaxing.predict(t) - creeping.predict(t)).abs() < 1e-6, "{law} at {t} s");
        }
    }
}

#[test]
fn what_no_fit_can_follow_is_refused() {
    let unknown = fit("sls", &bounded("tau", 1.0, 2.0), 1e-3).unwrap_err();
    assert_eq!(
        unknown.to_string(),
        "the law has no parameter \"tau\"; it has equilibrium, amplitude, time_constant_s"
    );
    assert!(matches!(fit("sls", &bounded("time_constant_s", 2.0, 1.0), 1e-3), Err(FitError::Bounds { .. })));
    let held = LawOptions {
        fixed: vec![("time_constant_s".to_owned(), -1.0)],
        ..LawOptions::default()
    };
    assert!(matches!(fit("sls", &held, 1e-3), Err(FitError::FixedParameter { .. })));
    let form = fit("kelvin-voigt", &LawOptions::default(), 1e-3).unwrap_err();
    assert_eq!(form.to_string(), "the law kelvin-voigt does not describe relaxation");
    assert!("prony:9".parse::<Law>().is_err() && "latency:-1".parse::<Law>().is_err());
}

#[test]
fn a_series_with_one_time_held_does_not_lose_its_order() {
    let (times, values) = hold(1e-3);
    for held in ["time_constant_1_s", "time_constant_2_s", "time_constant_3_s"] {
        let options = LawOptions {
            fixed: vec![(held.to_owned(), 4.0)],
            ..LawOptions::default()
        };
        let fit = fit_law(&Samples::new(&times, &values), Law::Prony { terms: 3 }, &options).unwrap();
        assert_eq!(fit.free_parameters(), 6);
        assert!((fit.value(held).unwrap() - 4.0).abs() < 1e-12);
        let square: f64 = times.iter().zip(&values).map(|(t, y)| (y - fit.predict(*t)).powi(2)).sum();
        assert!((square / fit.residual_square - 1.0).abs() < 1e-9, "{held}: {square} {}", fit.residual_square);
    }
}
