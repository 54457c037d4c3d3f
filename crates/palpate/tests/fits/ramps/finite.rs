//! Holds after a ramp: the law of the step found again, where a fit that takes the ramp for a step finds another.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::fit::{Fit, LawOptions, Samples, fit_law};
use palpate::laws::{BasisFunction, ExponentChoice, Law, LawCurve, Loading, LoadingError, Response, Term};
use palpate::test_problems::Rng;

fn relaxation(constant: f64, terms: Vec<Term>) -> LawCurve {
    LawCurve {
        response: Response::Relaxation,
        constant,
        terms,
    }
}

fn term(amplitude: f64, shape: BasisFunction, parameters: &[f64]) -> Term {
    Term {
        amplitude,
        shape,
        parameters: parameters.to_vec(),
    }
}

fn fit(times: &[f64], values: &[f64], law: Law, loading: Option<&Loading>) -> Fit {
    let options = LawOptions {
        loading: loading.cloned(),
        ..LawOptions::default()
    };
    fit_law(&Samples::new(times, values), law, &options).unwrap()
}

/// A loading as a machine makes it: it starts gently, overshoots, backs off and creeps up to its target.
fn irregular() -> Loading {
    Loading::new(&[3.0, 3.5, 4.5, 5.0, 5.25, 6.0], &[1e-3, 1.5e-3, 5e-3, 6.4e-3, 5.8e-3, 6e-3]).unwrap()
}

/// One exponential after a ramp of constant rate keeps (1 − e^(−T/τ))/(T/τ) of its amplitude, and its time.
#[test]
fn a_ramp_takes_a_known_factor_off_an_exponential() {
    for ratio in [1e-9, 1e-3, 0.3, 1.0, 7.0, 300.0] {
        let curve = relaxation(2.0, vec![term(3.0, BasisFunction::Exponential, &[(0.25f64).ln()])]);
        let elapsed = [0.0, 1.0, 10.0];
        let found = curve.after(&Loading::ramp(4.0 * ratio).unwrap(), &elapsed);
        for (t, y) in elapsed.iter().zip(found) {
            let expected = 2.0 + 3.0 * -(-ratio).exp_m1() / ratio * (-t / 4.0).exp();
            assert!((y - expected).abs() < 1e-14, "{ratio} {t}: {y} {expected}");
        }
    }
}

/// Laws, shapes with parameters, and what the fit calls them.
fn laws() -> Vec<(&'static str, LawCurve)> {
    let exponential = |amplitude: f64, time: f64| term(amplitude, BasisFunction::Exponential, &[-time.ln()]);
    vec![
        ("maxwell", relaxation(0.0, vec![exponential(4.0, 9.0)])),
        ("standard-linear-solid", relaxation(2.0, vec![exponential(4.0, 3.0)])),
        ("prony:2", relaxation(2.0, vec![exponential(4.0, 0.9), exponential(1.5, 14.0)])),
        ("fung:2", relaxation(2.0, vec![exponential(4.0, 0.9), exponential(1.5, 14.0)])),
        ("stretched", relaxation(2.0, vec![term(4.0, BasisFunction::Stretched, &[-(2.0f64).ln(), 0.5])])),
        ("power", relaxation(0.0, vec![term(4.0, BasisFunction::PowerDecay, &[0.0, 0.3])])),
        ("logarithmic", relaxation(9.0, vec![term(0.5, BasisFunction::Logarithm, &[0.5])])),
        (
            "fractional-zener",
            relaxation(2.0, vec![term(4.0, BasisFunction::MittagLeffler, &[-(2.0f64).ln(), 0.7])]),
        ),
        (
            "fung-continuous",
            relaxation(2.0, vec![term(4.0, BasisFunction::FungContinuous, &[-(9.0f64).ln(), 3.0])]),
        ),
        ("diffusion", relaxation(2.0, vec![term(4.0, BasisFunction::Diffusion, &[-(6.0f64).ln()])])),
    ]
}

/// Without noise every law comes back with the parameters of its step response, after a ramp and after an irregular loading.
#[test]
fn every_linear_law_is_found_through_its_loading() {
    let times: Vec<f64> = (0..400).map(|i| 0.1 * f64::from(i)).collect();
    for (name, curve) in laws() {
        for loading in [Loading::ramp(2.0).unwrap(), irregular()] {
            let values = curve.after(&loading, &times);
            let fit = fit(&times, &values, name.parse().unwrap(), Some(&loading));
            let found: Vec<f64> =
                fit.curve.terms.iter().flat_map(|term| [&[term.amplitude], &*term.parameters].concat()).collect();
            let truth: Vec<f64> =
                curve.terms.iter().flat_map(|term| [&[term.amplitude], &*term.parameters].concat()).collect();
            assert!((fit.curve.constant - curve.constant).abs() < 1e-6, "{name}: {fit:?}");
            for (found, truth) in found.iter().zip(&truth) {
                assert!((found - truth).abs() < 1e-6, "{name}: {found} {truth}");
            }
            assert!((fit.predict(0.35) - curve.after(&loading, &[0.35])[0]).abs() < 1e-8, "{name}");
        }
    }
}

/// With noise: the truth lies within its errors, and more than a tenth off where the ramp is ignored.
#[test]
fn amplitudes_are_wrong_only_where_the_ramp_is_ignored() {
    let times: Vec<f64> = (0..1000).map(|i| 0.05 * f64::from(i)).collect();
    for (name, curve) in laws()
        .into_iter()
        .filter(|(name, _)| ["standard-linear-solid", "stretched", "prony:2"].contains(name))
    {
        let mut noise = Rng::new(7);
        let values: Vec<f64> = curve.after(&irregular(), &times).iter().map(|y| y + 0.01 * noise.normal()).collect();
        let law: Law = name.parse().unwrap();
        let (known, ignored) = (fit(&times, &values, law, Some(&irregular())), fit(&times, &values, law, None));
        let amplitude = if curve.terms.len() > 1 { "amplitude_1" } else { "amplitude" };
        let truth = curve.terms[0].amplitude;
        let estimate = known.estimate(amplitude).unwrap();
        let off = (estimate.value - truth).abs() / estimate.white_standard_error.unwrap();
        assert!(off < 3.5, "{name}: {estimate:?}");
        let wrong = ignored.value(amplitude).unwrap();
        assert!((wrong / truth - 1.0).abs() > 0.1, "{name}: {wrong}");
        assert!(known.rmse <= ignored.rmse * 1.001 && known.loading.is_some() && ignored.loading.is_none());
    }
}

#[test]
fn a_ramp_of_no_time_is_a_step() {
    let times: Vec<f64> = (0..200).map(|i| 0.1 * f64::from(i)).collect();
    for (name, curve) in laws() {
        let step = curve.values(&times);
        let ramp = curve.after(&Loading::ramp(1e-12).unwrap(), &times);
        let error = step.iter().zip(&ramp).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 4e-6, "{name}: {error:e}");
    }
}

/// Neither the unit of time nor that of the signal, nor where the clock starts, changes what is found.
#[test]
fn units_do_not_matter() {
    let times: Vec<f64> = (0..300).map(|i| 0.1 * f64::from(i)).collect();
    let (name, curve) = &laws()[4];
    let values = curve.after(&irregular(), &times);
    let stamps: Vec<f64> = [3.0, 3.5, 4.5, 5.0, 5.25, 6.0].map(|t: f64| 60.0 * t - 1e3).to_vec();
    let loading = Loading::new(&stamps, &[-1.0, -1.5, -5.0, -6.4, -5.8, -6.0]).unwrap();
    let minutes: Vec<f64> = times.iter().map(|t| 60.0 * t).collect();
    let grams: Vec<f64> = values.iter().map(|y| 1e3 * y).collect();
    let fit = fit(&minutes, &grams, name.parse().unwrap(), Some(&loading));
    assert!((fit.value("amplitude").unwrap() / 4e3 - 1.0).abs() < 1e-6);
    assert!((fit.value("time_constant_s").unwrap() / 120.0 - 1.0).abs() < 1e-6);
}

/// The latency law needs to know where the hold starts, not how it got there: its fit is the same.
#[test]
fn the_latency_law_of_one_hold_needs_no_loading() {
    let times: Vec<f64> = (0..300).map(|i| 0.1 * f64::from(i)).collect();
    let values: Vec<f64> = times.iter().map(|t| 1.0 + 2.0 * (1.0 + 4.0 * t).powf(-0.25)).collect();
    let law = Law::Latency {
        exponent: ExponentChoice::Free,
    };
    let (with, without) = (fit(&times, &values, law, Some(&irregular())), fit(&times, &values, law, None));
    assert_eq!(with, without);
}

/// Creep: the compliance is averaged alike.
#[test]
fn creep_after_a_ramp_of_force() {
    let times: Vec<f64> = (0..300).map(|i| 0.1 * f64::from(i)).collect();
    let loading = Loading::ramp(1.5).unwrap();
    // Kelvin–Voigt: 1 − (1 − e^(−T/τ))/(T/τ) e^(−t/τ), τ = 4.
    let factor = -(-1.5f64 / 4.0).exp_m1() / (1.5 / 4.0);
    let values: Vec<f64> = times.iter().map(|t| 3.0 * (1.0 - factor * (-t / 4.0).exp())).collect();
    let options = LawOptions {
        response: Response::Creep,
        loading: Some(loading),
        ..LawOptions::default()
    };
    let fit = fit_law(&Samples::new(&times, &values), Law::KelvinVoigt, &options).unwrap();
    assert!((fit.value("amplitude").unwrap() - 3.0).abs() < 1e-9);
    assert!((fit.value("time_constant_s").unwrap() - 4.0).abs() < 1e-9);
}

#[test]
fn what_is_no_loading_is_refused() {
    type Error = LoadingError;
    let refused = |times: &[f64], values: &[f64]| Loading::new(times, values).unwrap_err();
    assert_eq!(refused(&[0.0, 1.0], &[0.0]), Error::Lengths { times: 2, values: 1 });
    assert_eq!(refused(&[0.0], &[0.0]), Error::TooFewSamples { found: 1 });
    assert_eq!(refused(&[0.0, 1.0, 1.0], &[0.0, 1.0, 2.0]), Error::TimeNotRising { index: 2 });
    assert_eq!(refused(&[0.0, 1.0], &[0.0, f64::NAN]), Error::NotFinite { index: 1 });
    assert_eq!(refused(&[0.0, 1.0, 2.0], &[3.0, 4.0, 3.0]), Error::Unchanged { value: 3.0 });
    assert_eq!(Loading::ramp(0.0).unwrap_err(), Error::Duration { found: 0.0 });
    assert!(Loading::ramp(f64::INFINITY).is_err());
    assert!(serde_json::from_str::<Loading>(r#"{"times": [0, 0], "values": [0, 1]}"#).is_err());
    let text = serde_json::to_string(&irregular()).unwrap();
    assert_eq!(serde_json::from_str::<Loading>(&text).unwrap(), irregular());
}
