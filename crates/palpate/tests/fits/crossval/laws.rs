//! Every law against optima found by many starts and 40 digits (`law_fits.json`), NIST's certified problems of the shapes of
//! these laws (`nist_laws.json`) and robust fits iterated to their fixed point (`robust_fits.json`).

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use std::collections::BTreeMap;

use crate::common::reference;
use palpate::fit::{ConstantChoice, Fit, LawOptions, Loss, Samples, Termination, fit_law};
use palpate::forecast::criteria;
use palpate::laws::{ExponentChoice, Law, Response};
use serde::Deserialize;

/// The law that a reference file names, with the parameter of its terms and the exponent it holds.
fn law(name: &str, parameters: &[String], fixed: &BTreeMap<String, f64>) -> Law {
    let terms = parameters.iter().filter(|name| name.starts_with("ln_rate")).count();
    match name {
        "latency" => Law::Latency {
            exponent: fixed.get("exponent").map_or(ExponentChoice::Free, |n| ExponentChoice::Fixed(*n)),
        },
        "prony" => Law::Prony { terms },
        "fung" => Law::Fung { terms },
        other => other.replace('_', "-").parse().unwrap(),
    }
}

fn options(kind: &str, fixed: &BTreeMap<String, f64>) -> LawOptions {
    let constant = fixed.get("constant").or_else(|| fixed.get("instantaneous"));
    LawOptions {
        response: if kind == "creep" { Response::Creep } else { Response::Relaxation },
        constant: constant.map_or(ConstantChoice::AsLaw, |value| ConstantChoice::Fixed(*value)),
        ..LawOptions::default()
    }
}

/// Parameters of a fit as the reference writes them, with their covariance.
struct Found {
    values: Vec<f64>,
    covariance: Vec<Vec<f64>>,
}

/// The searched parameters of a fit turned into those of the reference: the same but for fast and slow rates, flow per s
/// and power per s^α.
fn found(fit: &Fit, parameters: &[String]) -> Found {
    let inner = &fit.values;
    let count = inner.len();
    assert_eq!(count, parameters.len(), "{parameters:?} {:?}", fit.searched);
    let mut values = inner.clone();
    let mut jacobian: Vec<Vec<f64>> =
        (0..count).map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    match (fit.law, fit.response) {
        (Law::FungContinuous, _) => {
            (values[2], values[3]) = (inner[2] + inner[3], inner[2]);
            (jacobian[2], jacobian[3]) = (vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 0.0]);
        }
        (Law::Burgers, Response::Creep) => {
            values[2] /= fit.duration;
            jacobian[2][2] /= fit.duration;
        }
        (Law::Power, Response::Creep) => {
            let factor = fit.duration.powf(-inner[2]);
            values[1] *= factor;
            jacobian[1] = vec![0.0, factor, -inner[1] * factor * fit.duration.ln()];
        }
        _ => {}
    }
    let covariance = fit.white_covariance.as_ref().unwrap();
    let entry = |i: usize, j: usize| {
        let terms = (0..count).flat_map(|k| (0..count).map(move |l| (k, l)));
        terms.map(|(k, l)| jacobian[i][k] * covariance[k][l] * jacobian[j][l]).sum()
    };
    let covariance = (0..count).map(|i| (0..count).map(|j| entry(i, j)).collect()).collect();
    Found { values, covariance }
}

#[derive(Deserialize)]
struct LawTolerance {
    values_in_standard_errors: f64,
    standard_errors_relative: f64,
    chi_square_relative: f64,
    criteria_absolute: f64,
}

#[derive(Deserialize)]
struct LawCase {
    name: String,
    law: String,
    kind: String,
    fixed: BTreeMap<String, f64>,
    t: Vec<f64>,
    y: Vec<f64>,
    sigma: Option<Vec<f64>>,
    parameters: Vec<String>,
    values: Vec<f64>,
    standard_errors: Vec<f64>,
    covariance: Vec<Vec<f64>>,
    chi_square: f64,
    aic: f64,
    aicc: f64,
    bic: f64,
    derived: BTreeMap<String, [f64; 2]>,
}

fn shown(parameters: &[f64]) -> String {
    parameters.iter().map(|parameter| format!("{parameter:.1e} ")).collect()
}

#[test]
fn every_law_reaches_the_optima_of_the_reference() {
    let (tolerance, cases): (LawTolerance, Vec<LawCase>) = reference("law_fits");
    assert!(cases.len() >= 47);
    let mut worst = [0.0f64; 5];
    for case in &cases {
        let samples = Samples::new(&case.t, &case.y);
        let samples = case.sigma.as_ref().map_or(samples, |sigma| samples.with_standard_deviations(sigma));
        let law = law(&case.law, &case.parameters, &case.fixed);
        let fit = fit_law(&samples, law, &options(&case.kind, &case.fixed)).unwrap();
        assert_eq!(fit.termination, Termination::Converged, "{}", case.name);
        let found = found(&fit, &case.parameters);
        let mut far = [0.0f64; 5];
        for i in 0..found.values.len() {
            let error = case.standard_errors[i];
            far[0] = far[0].max((found.values[i] - case.values[i]).abs() / error);
            far[1] = far[1].max((found.covariance[i][i].sqrt() / error - 1.0).abs());
            for j in 0..found.values.len() {
                let unit = error * case.standard_errors[j];
                far[2] = far[2].max((found.covariance[i][j] - case.covariance[i][j]).abs() / unit);
            }
        }
        far[3] = (fit.residual_square / case.chi_square - 1.0).abs();
        for (name, [value, error]) in &case.derived {
            let estimate = fit.estimate(name).unwrap_or_else(|| panic!("{}: {name}", case.name));
            far[4] = far[4].max((estimate.value - value).abs() / error);
            far[4] = far[4].max((estimate.white_standard_error.unwrap() / error - 1.0).abs());
        }
        println!("{}: {}", case.name, shown(&far));
        // lmfit's, on the same residuals.
        let own = criteria(fit.residual_square, fit.samples as f64, fit.free_parameters() as f64);
        for (own, reference) in [(own.aic, case.aic), (own.aicc, case.aicc), (own.bic, case.bic)] {
            assert!((own - reference).abs() <= tolerance.criteria_absolute, "{}: {own} {reference}", case.name);
        }
        let limits = [
            tolerance.values_in_standard_errors,
            tolerance.standard_errors_relative,
            2.0 * tolerance.standard_errors_relative,
            tolerance.chi_square_relative,
            tolerance.standard_errors_relative,
        ];
        for (place, limit) in limits.into_iter().enumerate() {
            assert!(far[place] <= limit, "{}: {far:?}", case.name);
            worst[place] = worst[place].max(far[place]);
        }
    }
    println!("worst: values, errors, covariance, chi-square, derived: {}", shown(&worst));
}

#[derive(Deserialize)]
struct Unused {}

#[derive(Deserialize)]
struct NistCase {
    name: String,
    x: Vec<f64>,
    y: Vec<f64>,
    rss: f64,
    laws: Vec<NistLaw>,
}

#[derive(Deserialize)]
struct NistLaw {
    law: String,
    kind: String,
    fixed: BTreeMap<String, f64>,
    parameters: Vec<String>,
    values: Vec<f64>,
    standard_errors: Vec<f64>,
}

/// Digits in which two numbers agree.
fn digits(found: f64, expected: f64) -> f64 {
    let share = ((found - expected) / expected).abs();
    // No parameter has no digit.
    if share.is_nan() { 0.0 } else { -share.log10().clamp(-16.0, 0.0) }
}

/// Lanczos1 leaves a sum of squares of 1.4308e-25, its data rounded to doubles one of 1.4296e-25: three digits of the errors.
fn least_digits(name: &str) -> [f64; 2] {
    if name == "Lanczos1" { [11.0, 3.0] } else { [8.0, 6.0] }
}

#[test]
fn ten_problems_of_nist_are_solved_without_starting_values() {
    let (_, cases): (Unused, Vec<NistCase>) = reference("nist_laws");
    assert_eq!(cases.len(), 10);
    for case in &cases {
        // NIST's laws start at x = 0, these at the first sample: a sample without weight puts the start where it belongs.
        let (mut times, mut values) = (case.x.clone(), case.y.clone());
        let mut standard_deviations = vec![1.0; times.len()];
        if times[0] > 0.0 {
            times.insert(0, 0.0);
            values.insert(0, 0.0);
            standard_deviations.insert(0, f64::INFINITY);
        }
        let samples = Samples::new(&times, &values).with_standard_deviations(&standard_deviations);
        for expected in &case.laws {
            let law = law(&expected.law, &expected.parameters, &expected.fixed);
            let fit = fit_law(&samples, law, &options(&expected.kind, &expected.fixed)).unwrap();
            assert_eq!(fit.termination, Termination::Converged, "{} {law}", case.name);
            let found = found(&fit, &expected.parameters);
            let [mut values, mut errors] = [16.0f64; 2];
            for i in 0..found.values.len() {
                // The logarithm of a rate near 1 has digits after the point only.
                let shift =
                    if expected.parameters[i].starts_with("ln_") { 1.0f64.copysign(expected.values[i]) } else { 0.0 };
                values = values.min(digits(found.values[i] + shift, expected.values[i] + shift));
                errors = errors.min(digits(found.covariance[i][i].sqrt(), expected.standard_errors[i]));
            }
            let rss = digits(fit.residual_square, case.rss);
            println!("{} {law}: {values:.1} digits, errors {errors:.1}, rss {rss:.1}", case.name);
            let least = least_digits(&case.name);
            assert!(values >= least[0] && errors >= least[1], "{} {law}: {values} {errors}", case.name);
        }
    }
}

#[derive(Deserialize)]
struct RobustTolerance {
    values_relative: f64,
}

#[derive(Deserialize)]
struct RobustCase {
    name: String,
    law: String,
    kind: String,
    fixed: BTreeMap<String, f64>,
    t: Vec<f64>,
    y: Vec<f64>,
    parameters: Vec<String>,
    huber: RobustValues,
    tukey: RobustValues,
}

#[derive(Deserialize)]
struct RobustValues {
    values: Vec<f64>,
}

#[test]
fn robust_fits_reach_the_fixed_points_of_the_reference() {
    let (tolerance, cases): (RobustTolerance, Vec<RobustCase>) = reference("robust_fits");
    assert!(cases.len() >= 4);
    for case in &cases {
        let law = law(&case.law, &case.parameters, &case.fixed);
        for (loss, expected) in [(Loss::Huber, &case.huber), (Loss::Tukey, &case.tukey)] {
            let options = LawOptions {
                loss,
                ..options(&case.kind, &case.fixed)
            };
            let fit = fit_law(&Samples::new(&case.t, &case.y), law, &options).unwrap();
            assert_eq!(fit.termination, Termination::Converged, "{} {loss:?}", case.name);
            let mut worst = 0.0f64;
            for (value, expected) in fit.values.iter().zip(&expected.values) {
                worst = worst.max((value - expected).abs() / expected.abs().max(1e-3));
            }
            println!("{} {loss:?}: {worst:.1e}", case.name);
            assert!(worst <= tolerance.values_relative, "{} {loss:?}: {worst:e}", case.name);
        }
    }
}
