//! Several holds at once: against 40-digit optima (`joint_fits.json`), recovery, and what cannot be fitted.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use crate::common::reference;
use palpate::fit::{
    ExponentChoice, FitError, HoldWeights, JointComparison, JointFit, JointOptions, Samples, Termination, TrendVerdict,
    compare_joint, fit_joint,
};
use palpate::latency::decay;
use palpate::laws::{Law, Response};
use palpate::simulate::{Sampling, Separation, simulate};
use palpate::strain::contact_strain;
use palpate::test_problems::{Rng, paper_ball, paper_test_a};
use serde::Deserialize;

#[derive(Deserialize)]
struct Tolerance {
    values_in_standard_errors: f64,
    standard_errors_relative: f64,
    rss_relative: f64,
}

#[derive(Deserialize)]
struct Hold {
    t: Vec<f64>,
    y: Vec<f64>,
}

#[derive(Deserialize)]
struct Case {
    name: String,
    law: String,
    holds: Vec<Hold>,
    parameters: Vec<String>,
    values: Vec<f64>,
    standard_errors: Vec<f64>,
    covariance: Vec<Vec<f64>>,
    rss: f64,
}

impl Case {
    fn samples(&self) -> Vec<Samples<'_>> {
        self.holds.iter().map(|hold| Samples::new(&hold.t, &hold.y)).collect()
    }

    fn law(&self) -> Law {
        match self.law.as_str() {
            "latency" => LATENCY,
            "standard_linear_solid" => Law::StandardLinearSolid,
            _ => Law::Prony { terms: 2 },
        }
    }

    /// Place of a parameter of the reference file in a fit.
    fn place(&self, name: &str, fit: &JointFit) -> usize {
        let ours = match name.strip_prefix("ln_rate") {
            Some("_coefficient") => "ln rate_coefficient_per_s".to_owned(),
            Some(term) => format!("-ln time_constant{term}_s"),
            None => name.replace("constant", "equilibrium"),
        };
        fit.parameters
            .iter()
            .position(|parameter| *parameter == ours)
            .unwrap_or_else(|| panic!("{ours}: {:?}", fit.parameters))
    }
}

const LATENCY: Law = Law::Latency {
    exponent: ExponentChoice::Free,
};

const QUINTIC: Law = Law::Latency {
    exponent: ExponentChoice::Fixed(5.0),
};

fn cases() -> (Tolerance, Vec<Case>) {
    reference("joint_fits")
}

#[test]
fn agrees_with_optima_of_forty_digits() {
    let (tolerance, cases) = cases();
    assert_eq!(cases.len(), 4);
    for case in &cases {
        let fit = fit_joint(&case.samples(), case.law(), &JointOptions::default()).unwrap();
        assert_eq!(fit.termination, Termination::Converged, "{}", case.name);
        let covariance = fit.white_covariance.as_ref().unwrap();
        let places: Vec<usize> = case.parameters.iter().map(|name| case.place(name, &fit)).collect();
        let mut worst = [0.0f64; 3];
        for (i, &a) in places.iter().enumerate() {
            let error = case.standard_errors[i];
            worst[0] = worst[0].max((fit.values[a] - case.values[i]).abs() / error);
            worst[1] = worst[1].max((covariance[a][a].sqrt() / error - 1.0).abs());
            for (j, &b) in places.iter().enumerate() {
                let unit = error * case.standard_errors[j];
                worst[2] = worst[2].max((covariance[a][b] - case.covariance[i][j]).abs() / unit);
            }
        }
        let rss = (fit.residual_square / case.rss - 1.0).abs();
        println!(
            "{}: values {:.1e} se, errors {:.1e}, covariance {:.1e}, rss {rss:.1e}, {:?}",
            case.name, worst[0], worst[1], worst[2], fit.work
        );
        assert!(worst[0] <= 1e-2 * tolerance.values_in_standard_errors, "{}: {worst:?}", case.name);
        assert!(worst[1] <= tolerance.standard_errors_relative, "{}: {worst:?}", case.name);
        assert!(worst[2] <= tolerance.standard_errors_relative, "{}: {worst:?}", case.name);
        assert!(rss <= tolerance.rss_relative, "{}: {rss:e}", case.name);
        for hold in &fit.holds {
            for parameter in &fit.shared {
                let own = &hold.parameter(parameter.name).unwrap().estimate;
                let error = parameter.estimate.white_standard_error.unwrap();
                assert!(
                    (own.value - parameter.estimate.value).abs() < 1e-9 * error,
                    "{}: {}",
                    case.name,
                    parameter.name
                );
                let own = own.white_standard_error.unwrap();
                assert!((own / error - 1.0).abs() < 1e-6, "{}: {}", case.name, parameter.name);
            }
        }
    }
}

#[test]
fn no_choice_of_units_changes_the_answer() {
    let (_, cases) = cases();
    for case in &cases {
        let plain = fit_joint(&case.samples(), case.law(), &JointOptions::default()).unwrap();
        for (signal, time) in [(1e12, 1e-9), (1e-12, 1e9)] {
            let scaled: Vec<(Vec<f64>, Vec<f64>)> = case
                .holds
                .iter()
                .map(|hold| (hold.t.iter().map(|t| t * time).collect(), hold.y.iter().map(|y| y * signal).collect()))
                .collect();
            let samples: Vec<Samples<'_>> = scaled.iter().map(|(t, y)| Samples::new(t, y)).collect();
            let fit = fit_joint(&samples, case.law(), &JointOptions::default()).unwrap();
            assert_eq!(fit.termination, Termination::Converged, "{}", case.name);
            for (one, other) in plain.holds.iter().zip(&fit.holds) {
                for name in ["equilibrium", "start"] {
                    let (a, b) = (one.estimate(name).unwrap(), other.estimate(name).unwrap());
                    let error = a.standard_error.unwrap();
                    assert!((a.value - b.value / signal).abs() < 1e-5 * error, "{} {name}: {a:?} {b:?}", case.name);
                    assert!((b.standard_error.unwrap() / signal / error - 1.0).abs() < 1e-5, "{} {name}", case.name);
                }
            }
            let last = |fit: &JointFit| fit.shared.last().unwrap().estimate;
            let (a, b) = (last(&plain), last(&fit));
            let unit = if case.law() == LATENCY { 1.0 } else { time };
            let off = (b.value / unit - a.value).abs() / a.standard_error.unwrap();
            println!("{}: {off:.1e} standard errors", case.name);
            assert!(off < 1e-6, "{}: {off:e}", case.name);
        }
    }
}

#[test]
fn holds_that_cannot_be_fitted_are_named() {
    let options = JointOptions::default();
    let times: Vec<f64> = (0..40).map(f64::from).collect();
    let values: Vec<f64> = times.iter().map(|t| 1.0 + (-t / 7.0).exp()).collect();
    let good = Samples::new(&times, &values);
    let sls = Law::StandardLinearSolid;
    assert_eq!(fit_joint(&[], sls, &options), Err(FitError::TooFewHolds { found: 0 }));
    assert_eq!(fit_joint(&[good], sls, &options), Err(FitError::TooFewHolds { found: 1 }));
    let short = Samples::new(&times[..3], &values[..3]);
    let error = fit_joint(&[good, short], sls, &options).unwrap_err();
    assert!(matches!(error, FitError::Hold { hold: 2, .. }), "{error}");
    assert!(error.to_string().starts_with("hold 2: a fit of 3 parameters needs 5 samples"), "{error}");
    let flat = vec![1.0; 40];
    let error = fit_joint(&[Samples::new(&times, &flat), good], sls, &options).unwrap_err();
    assert!(matches!(error, FitError::Hold { hold: 1, .. }), "{error}");
    let standard_deviations = vec![1.0; 40];
    let error = fit_joint(&[good.with_standard_deviations(&standard_deviations), good], sls, &options).unwrap_err();
    assert_eq!(error, FitError::StandardDeviationsOfSome { hold: 2 });
    let creep = JointOptions {
        response: Response::Creep,
        ..options
    };
    // A straight line has nothing beside its slope, and that is the hold's own.
    let nothing = FitError::NothingShared { law: Law::Maxwell };
    assert_eq!(fit_joint(&[good, good], Law::Maxwell, &creep), Err(nothing));
}

#[test]
fn deviations_and_noisy_holds_count_less() {
    let (_, cases) = cases();
    let case = &cases[2];
    // All standard deviations alike change nothing, however large.
    let standard_deviations: Vec<Vec<f64>> = case.holds.iter().map(|hold| vec![7e5; hold.t.len()]).collect();
    let same: Vec<Samples<'_>> = case
        .samples()
        .into_iter()
        .zip(&standard_deviations)
        .map(|(s, d)| s.with_standard_deviations(d))
        .collect();
    let plain = fit_joint(&case.samples(), case.law(), &JointOptions::default()).unwrap();
    let weighed = fit_joint(&same, case.law(), &JointOptions::default()).unwrap();
    let error = plain.shared[0].estimate.white_standard_error.unwrap();
    assert!((plain.shared[0].estimate.value - weighed.shared[0].estimate.value).abs() < 1e-6 * error);
    assert!((weighed.residual_square / plain.residual_square - 1.0).abs() < 1e-9);
    // A hold that is left out by its standard_deviations leaves the parameter to the others.
    let few: Vec<Vec<f64>> = case
        .holds
        .iter()
        .enumerate()
        .map(|(i, h)| vec![if i == 0 { 1e6 } else { 1.0 }; h.t.len()])
        .collect();
    let without: Vec<Samples<'_>> =
        case.samples().into_iter().zip(&few).map(|(s, d)| s.with_standard_deviations(d)).collect();
    let without = fit_joint(&without, case.law(), &JointOptions::default()).unwrap();
    let others = fit_joint(&case.samples()[1..], case.law(), &JointOptions::default()).unwrap();
    assert!((without.shared[0].estimate.value - others.shared[0].estimate.value).abs() < 1e-4 * error);
    // One hold with ten times the noise: weights by variance beat equal ones.
    let options = JointOptions {
        weights: HoldWeights::SeparateVariance,
        ..JointOptions::default()
    };
    let mut noisy = case.samples();
    let loud: Vec<f64> =
        case.holds[0].y.iter().enumerate().map(|(i, y)| y + 0.5 * (1.3 * (i * i) as f64).sin()).collect();
    noisy[0] = Samples::new(&case.holds[0].t, &loud);
    let equal = fit_joint(&noisy, case.law(), &JointOptions::default()).unwrap();
    let by_variance = fit_joint(&noisy, case.law(), &options).unwrap();
    let error = |fit: &JointFit| fit.shared[0].estimate.white_standard_error.unwrap();
    assert!(error(&by_variance) < 0.3 * error(&equal), "{} {}", error(&by_variance), error(&equal));
}

/// Holds of 10 s at 100 Hz with a drop of 0.13 and noise of 3·10⁻⁴, at five equilibrium strains; ln v = ln 2·10⁴ + slope (ε_e − 0.3).
fn body(slope: f64, seed: u64) -> (Vec<f64>, Vec<Vec<f64>>) {
    let times: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
    let mut noise = Rng::new(seed);
    let mut hold = |strain: f64| {
        let drop = 0.1 + 0.2 * strain;
        let rate = 2e4 * (slope * (strain - 0.3)).exp() * drop.powi(4);
        times.iter().map(|t| strain + drop * decay(rate * t, 5.0) + 3e-4 * noise.normal()).collect()
    };
    let values = [0.1, 0.2, 0.3, 0.4, 0.5].map(&mut hold).to_vec();
    (times, values)
}

fn judged(law: Law, slope: f64, seed: u64) -> (JointFit, JointComparison) {
    let (times, values) = body(slope, seed);
    let holds: Vec<Samples<'_>> = values.iter().map(|values| Samples::new(&times, values)).collect();
    let joint = fit_joint(&holds, law, &JointOptions::default()).unwrap();
    let comparison = compare_joint(&holds, &joint, None).unwrap();
    (joint, comparison)
}

#[test]
fn the_verdict_is_that_of_the_body() {
    for law in [LATENCY, QUINTIC] {
        let (joint, constant) = judged(law, 0.0, 11);
        println!("{law}: {:?} {:?}", joint.shared, constant);
        let v = joint.shared("rate_coefficient_per_s").unwrap().estimate;
        assert!((v.value.ln() - 2e4f64.ln()).abs() < 3.0 * v.standard_error.unwrap() / v.value);
        assert_eq!(constant.verdict, TrendVerdict::Constant, "{law}");
        assert!(constant.delta_bic < -10.0 && constant.p.unwrap() > 0.05, "{law}: {constant:?}");
        let (_, falling) = judged(law, -5.0, 12);
        let trend = falling.trend.as_ref().unwrap();
        assert_eq!(falling.verdict, TrendVerdict::FallsWithStrain, "{law}: {trend:?}");
        assert!((trend.slope + 5.0).abs() < 0.1, "{law}: {trend:?}");
        assert!(falling.delta_bic > 10.0 && falling.p.unwrap() < 1e-6, "{law}: {falling:?}");
        assert_eq!(judged(law, 5.0, 13).1.verdict, TrendVerdict::RisesWithStrain, "{law}");
    }
}

#[test]
fn intervals_of_the_trend_cover_and_equal_bodies_are_reported_apart_by_chance_only() {
    let runs = 200;
    let (mut covered, mut rejected) = (0, 0);
    for seed in 0..runs {
        let (_, comparison) = judged(QUINTIC, -2.0, 100 + seed);
        let interval = comparison.trend.unwrap().interval;
        covered += usize::from(interval.0 <= -2.0 && -2.0 <= interval.1);
        rejected += usize::from(judged(QUINTIC, 0.0, 1000 + seed).1.p.unwrap() < 0.05);
    }
    println!("covered {covered} of {runs}, rejected {rejected}");
    // Binomial, 200 runs at 95 %: 181 or more, and at 5 % 19 or fewer, each in all but 1 % of cases.
    assert!(covered >= 181, "{covered}");
    assert!(rejected <= 19, "{rejected}");
}

/// Strains in the five holds of the paper's test (a) after loading, 500 samples each, from simulated force.
fn paper_holds(noise: f64) -> Vec<(Vec<f64>, Vec<f64>)> {
    let (model, motion) = (paper_ball(Separation::Bonded), paper_test_a());
    let mut random = Rng::new(7);
    let mut hold = |knot: usize| {
        let (start, end) = (motion.times()[knot], motion.times()[knot + 1]);
        let times: Vec<f64> = (0..500).map(|i| start + (end - start) * f64::from(i) / 499.0).collect();
        let result = simulate(&motion, &model, &Sampling::Times(times)).unwrap();
        let strain = |k: usize| contact_strain(result.force[k], result.displacement[k], &model.specimen).unwrap();
        let strains = (0..result.len()).map(|k| strain(k) + noise * random.normal()).collect();
        (result.time.iter().map(|time| time - start).collect(), strains)
    };
    [1, 3, 5, 7, 9].map(&mut hold).to_vec()
}

#[test]
fn the_simulated_paper_gives_back_its_law() {
    for (noise, share) in [(0.0, 1e-5), (2e-4, 0.1)] {
        let recorded = paper_holds(noise);
        let holds: Vec<Samples<'_>> = recorded.iter().map(|(times, values)| Samples::new(times, values)).collect();
        let fit = fit_joint(&holds, LATENCY, &JointOptions::default()).unwrap();
        let (v, n) = (fit.shared[0].estimate, fit.shared[1].estimate);
        println!("noise {noise}: v = {v:?}, n = {n:?}");
        assert!((v.value / 2e4 - 1.0).abs() < share && (n.value - 5.0).abs() < share, "{noise}: {v:?} {n:?}");
        if noise > 0.0 {
            assert!((v.value - 2e4).abs() < 3.0 * v.standard_error.unwrap(), "{v:?}");
            assert!((n.value - 5.0).abs() < 3.0 * n.standard_error.unwrap(), "{n:?}");
            let comparison = compare_joint(&holds, &fit, None).unwrap();
            assert_eq!(comparison.verdict, TrendVerdict::Constant, "{comparison:?}");
            assert!(compare_joint(&holds[1..], &fit, None).is_err());
        }
    }
}
