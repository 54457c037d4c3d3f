//! Fits against optima found by grid, many starts and 40 digits (`hold_fits.json`, `rate_fits.json`) and against
//! NIST's certified problems (`nist.json`).

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use crate::common::reference;
use palpate::fit::{ExponentChoice, FitError, FitOptions, LatencyFit, Termination, fit_hold, fit_rates};
use serde::Deserialize;

#[derive(Deserialize)]
struct Tolerance {
    parameters_in_standard_errors: f64,
    standard_errors_relative: f64,
    rss_relative: f64,
}

/// The range in which the reference search looked for n.
const EXPONENTS: (f64, f64) = (0.1, 30.0);

fn options() -> FitOptions {
    FitOptions {
        exponent_range: EXPONENTS,
        ..FitOptions::default()
    }
}

fn choice(fixed_n: Option<f64>) -> ExponentChoice {
    fixed_n.map_or(ExponentChoice::Free, ExponentChoice::Fixed)
}

/// The parameters of a fit in the order of a reference file, and its covariance.
struct Found {
    parameters: Vec<f64>,
    standard_errors: Vec<f64>,
    covariance: Vec<Vec<f64>>,
    rss: f64,
}

struct Expected<'a> {
    name: &'a str,
    parameters: Vec<f64>,
    standard_errors: &'a [f64],
    covariance: &'a [Vec<f64>],
    rss: f64,
}

/// Compares; returns the largest distances of parameters (in standard errors), standard errors, covariance and RSS (relative).
fn compare(found: &Found, expected: &Expected<'_>, tolerance: &Tolerance) -> [f64; 4] {
    let (name, count) = (expected.name, expected.parameters.len());
    assert_eq!((found.parameters.len(), found.standard_errors.len(), found.covariance.len()), (count, count, count));
    let mut worst = [0.0f64; 4];
    for i in 0..count {
        let error = expected.standard_errors[i];
        worst[0] = worst[0].max((found.parameters[i] - expected.parameters[i]).abs() / error);
        worst[1] = worst[1].max((found.standard_errors[i] / error - 1.0).abs());
        for j in 0..count {
            let unit = error * expected.standard_errors[j];
            worst[2] = worst[2].max((found.covariance[i][j] - expected.covariance[i][j]).abs() / unit);
        }
    }
    worst[3] = (found.rss / expected.rss - 1.0).abs();
    println!(
        "{name}: parameters {:.1e} se, se {:.1e}, covariance {:.1e}, rss {:.1e}",
        worst[0], worst[1], worst[2], worst[3]
    );
    let limits = [
        tolerance.parameters_in_standard_errors,
        tolerance.standard_errors_relative,
        2.0 * tolerance.standard_errors_relative,
        tolerance.rss_relative,
    ];
    for (value, limit) in worst.iter().zip(limits) {
        assert!(value <= &limit, "{name}: {worst:?}");
    }
    worst
}

#[derive(Deserialize)]
struct HoldCase {
    name: String,
    well_defined: bool,
    fixed_n: Option<f64>,
    t: Vec<f64>,
    y: Vec<f64>,
    #[serde(flatten)]
    answer: Option<HoldAnswer>,
}

#[derive(Deserialize)]
struct HoldAnswer {
    y_e: f64,
    delta: f64,
    ln_lambda: f64,
    n: f64,
    standard_errors: Vec<f64>,
    covariance: Vec<Vec<f64>>,
    rss: f64,
}

fn hold_numbers(fit: &LatencyFit) -> Found {
    let mut parameters = vec![fit.equilibrium().value, fit.amplitude().value, fit.relative_rate().value.ln()];
    let relative_rate_error = fit.relative_rate().white_standard_error.unwrap() / fit.relative_rate().value;
    let mut standard_errors = vec![
        fit.equilibrium().white_standard_error.unwrap(),
        fit.amplitude().white_standard_error.unwrap(),
        relative_rate_error,
    ];
    if fit.choice() == ExponentChoice::Free {
        parameters.push(fit.exponent().value);
        standard_errors.push(fit.exponent().white_standard_error.unwrap());
    }
    Found {
        parameters,
        standard_errors,
        covariance: fit.white_covariance.clone().unwrap(),
        rss: fit.residual_square,
    }
}

#[test]
fn holds_in_the_time_domain() {
    let (tolerance, cases) = reference::<Tolerance, HoldCase>("hold_fits");
    let well_defined: Vec<_> = cases.iter().filter(|case| case.well_defined).collect();
    assert_eq!(well_defined.len(), 16);
    for case in well_defined {
        let answer = case.answer.as_ref().unwrap();
        let fit = fit_hold(&case.t, &case.y, choice(case.fixed_n), &options()).unwrap();
        assert_eq!(fit.termination, Termination::Converged, "{}", case.name);
        let mut parameters = vec![answer.y_e, answer.delta, answer.ln_lambda];
        parameters.extend(case.fixed_n.is_none().then_some(answer.n));
        let expected = Expected {
            name: &case.name,
            parameters,
            standard_errors: &answer.standard_errors,
            covariance: &answer.covariance,
            rss: answer.rss,
        };
        compare(&hold_numbers(&fit), &expected, &tolerance);
        // v = λ/|Δ|ⁿ⁻¹, and its error from the covariance of ln λ, Δ and n.
        let (n, delta, c) = (answer.n, answer.delta, &answer.covariance);
        let v = (answer.ln_lambda - (n - 1.0) * delta.abs().ln()).exp();
        let gradient = [0.0, -(n - 1.0) / delta, 1.0, -delta.abs().ln()];
        let pairs = (0..c.len()).flat_map(|i| (0..c.len()).map(move |j| (i, j)));
        let error = v * pairs.map(|(i, j)| gradient[i] * c[i][j] * gradient[j]).sum::<f64>().sqrt();
        assert!((fit.rate_coefficient().value - v).abs() <= 1e-4 * error, "{}: v", case.name);
        let found = fit.rate_coefficient().white_standard_error.unwrap();
        assert!((found / error - 1.0).abs() <= 2e-4, "{}: error of v {found} {error}", case.name);
    }
}

/// Says that a parameter is not determined: no error, no interval.
fn assert_open(name: &str, fit: &LatencyFit) {
    assert!(fit.white_covariance.is_none(), "{name}");
    for estimate in [fit.exponent(), fit.equilibrium(), fit.amplitude(), fit.relative_rate(), fit.rate_coefficient()] {
        assert!(estimate.white_standard_error.is_none() && estimate.interval.is_none(), "{name}: {estimate:?}");
    }
}

#[test]
fn holds_without_an_answer_say_so() {
    let (_, cases) = reference::<Tolerance, HoldCase>("hold_fits");
    let open: Vec<_> = cases.iter().filter(|case| !case.well_defined).collect();
    assert_eq!(open.len(), 2);
    for case in open {
        let free = fit_hold(&case.t, &case.y, ExponentChoice::Free, &options());
        let fixed = fit_hold(&case.t, &case.y, ExponentChoice::Fixed(5.0), &options());
        match case.name.as_str() {
            "constant" => {
                for fit in [free, fixed] {
                    assert!(matches!(fit, Err(FitError::Constant { samples: 50, .. })), "{fit:?}");
                }
            }
            "straight line" => {
                for fit in [free.unwrap(), fixed.unwrap()] {
                    println!("straight line: {:?}", fit.termination);
                    assert!(!fit.termination.is_good(), "{fit:?}");
                    assert_open(&case.name, &fit);
                }
            }
            other => panic!("unknown case {other}"),
        }
    }
}

#[derive(Deserialize)]
struct RateCase {
    name: String,
    fixed_n: Option<f64>,
    strain: Vec<f64>,
    rate: Vec<f64>,
    equilibrium_strain: f64,
    ln_rate_coefficient: f64,
    exponent: f64,
    standard_errors: Vec<f64>,
    covariance: Vec<Vec<f64>>,
    rss: f64,
}

#[test]
fn holds_in_the_plane_of_strain_and_rate() {
    let (tolerance, cases) = reference::<Tolerance, RateCase>("rate_fits");
    for case in &cases {
        let fit = fit_rates(&case.strain, &case.rate, choice(case.fixed_n), &options()).unwrap();
        assert_eq!(fit.termination, Termination::Converged, "{}", case.name);
        let v = fit.rate_coefficient();
        let mut found = Found {
            parameters: vec![fit.equilibrium().value, v.value.ln()],
            standard_errors: vec![
                fit.equilibrium().white_standard_error.unwrap(),
                v.white_standard_error.unwrap() / v.value,
            ],
            covariance: fit.white_covariance.clone().unwrap(),
            rss: fit.residual_square,
        };
        let mut parameters = vec![case.equilibrium_strain, case.ln_rate_coefficient];
        if case.fixed_n.is_none() {
            found.parameters.push(fit.exponent().value);
            found.standard_errors.push(fit.exponent().white_standard_error.unwrap());
            parameters.push(case.exponent);
        }
        let expected = Expected {
            name: &case.name,
            parameters,
            standard_errors: &case.standard_errors,
            covariance: &case.covariance,
            rss: case.rss,
        };
        compare(&found, &expected, &tolerance);
    }
}

#[derive(Deserialize)]
struct NistTolerance {
    parameters_relative: f64,
    sd_relative: f64,
    rss_relative: f64,
}

#[derive(Deserialize)]
struct NistCase {
    name: String,
    x: Vec<f64>,
    y: Vec<f64>,
    fixed_n: Option<f64>,
    unconstrained: Option<Unconstrained>,
}

#[derive(Deserialize)]
struct Unconstrained {
    y_e: f64,
    delta: f64,
    ln_lambda: f64,
    rss: f64,
    standard_errors: [f64; 3],
}

#[test]
fn nist_problems() {
    let (tolerance, cases) = reference::<NistTolerance, NistCase>("nist");
    let mut compared = 0;
    for case in &cases {
        let (Some(n), Some(expected)) = (case.fixed_n, &case.unconstrained) else {
            continue;
        };
        let fit = fit_hold(&case.x, &case.y, ExponentChoice::Fixed(n), &options()).unwrap();
        assert_eq!(fit.termination, Termination::Converged, "{}", case.name);
        // NIST counts from x = 0, the fit from the first sample, at which λ has fallen to λ φ(λ x₀)ⁿ⁻¹ and Δ to Δ φ(λ x₀).
        let (start, later) = (case.x[0], fit.relative_rate().value);
        let stretch = 1.0 / (1.0 - (n - 1.0) * later * start);
        let lambda = later * stretch;
        let phi = palpate::latency::decay(lambda * start, n);
        let delta = fit.amplitude().value / phi;
        // ∂(y_e, Δ, ln λ)/∂(the same at the first sample); ∂ln φ/∂ln λ = −λ x₀ φⁿ⁻¹ = −λ' x₀.
        let jacobian = [[1.0, 0.0, 0.0], [0.0, 1.0 / phi, delta * later * start * stretch], [0.0, 0.0, stretch]];
        let covariance = fit.white_covariance.as_ref().unwrap();
        let parameters = [fit.equilibrium().value, delta, lambda.ln()];
        let wanted = [expected.y_e, expected.delta, expected.ln_lambda];
        let (mut value, mut deviation) = (0.0f64, 0.0f64);
        for i in 0..3 {
            let row = &jacobian[i];
            let pairs = (0..3).flat_map(|a| (0..3).map(move |b| (a, b)));
            let variance: f64 = pairs.map(|(a, b)| row[a] * covariance[a][b] * row[b]).sum();
            value = value.max((parameters[i] / wanted[i] - 1.0).abs());
            deviation = deviation.max((variance.sqrt() / expected.standard_errors[i] - 1.0).abs());
        }
        let rss = (fit.residual_square / expected.rss - 1.0).abs();
        println!("{}: parameters {value:.1e}, standard_deviations {deviation:.1e}, rss {rss:.1e}", case.name);
        assert!(value <= tolerance.parameters_relative, "{}: parameters off by {value:e}", case.name);
        assert!(deviation <= tolerance.sd_relative, "{}: standard_deviations off by {deviation:e}", case.name);
        assert!(rss <= tolerance.rss_relative, "{}: rss off by {rss:e}", case.name);
        compared += 1;
    }
    assert_eq!(compared, 5);
}
