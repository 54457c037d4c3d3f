//! Laws that are limits of each other: fits of both agree. And what no unit of force or time may change.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::fit::{ConstantChoice, Fit, LawOptions, ParameterUnit, Samples, Termination, fit_law};
use palpate::laws::{Law, Response};
use palpate::test_problems::Rng;

/// A wide relaxation with two times and some noise: no law is exact on it.
fn hold(noise: f64) -> (Vec<f64>, Vec<f64>) {
    let mut random = Rng::new(3);
    let times: Vec<f64> = (0..300).map(|i| 30.0 * (f64::from(i) / 299.0).powi(2)).collect();
    let value = |t: &f64| 2.0 + 0.7 * (-t / 0.8).exp() + 0.6 * (-t / 9.0).exp() + noise * random.normal();
    let values = times.iter().map(value).collect();
    (times, values)
}

fn fit_to(times: &[f64], values: &[f64], law: &str, options: &LawOptions) -> Fit {
    fit_law(&Samples::new(times, values), law.parse().unwrap(), options).unwrap()
}

fn fit(law: &str, options: &LawOptions) -> Fit {
    let (times, values) = hold(2e-3);
    fit_to(&times, &values, law, options)
}

fn fixed(name: &str, value: f64) -> LawOptions {
    LawOptions {
        fixed: vec![(name.to_owned(), value)],
        ..LawOptions::default()
    }
}

fn creep() -> LawOptions {
    LawOptions {
        response: Response::Creep,
        ..LawOptions::default()
    }
}

/// Both leave the same residual and draw the same curve.
fn same(a: &Fit, b: &Fit, within: f64) {
    assert!(
        (a.residual_square / b.residual_square - 1.0).abs() < within,
        "{} {}",
        a.residual_square,
        b.residual_square
    );
    for i in 0..60 {
        let t = 0.5 * f64::from(i);
        assert!((a.predict(t) / b.predict(t) - 1.0).abs() < within, "{t}: {} {}", a.predict(t), b.predict(t));
    }
}

#[test]
fn several_laws_have_one_exponential_as_a_limit() {
    let plain = LawOptions::default();
    let solid = fit("standard-linear-solid", &plain);
    assert_eq!(solid.termination, Termination::Converged);
    same(&fit("prony:1", &plain), &solid, 1e-12);
    same(&fit("fung:1", &plain), &solid, 1e-12);
    same(&fit("latency:1", &plain), &solid, 1e-10);
    same(&fit("latency:1.0000001", &plain), &solid, 1e-5);
    same(&fit("latency", &fixed("exponent", 1.0)), &solid, 1e-10);
    same(&fit("stretched", &fixed("stretching", 1.0)), &solid, 1e-10);
    same(&fit("fractional-zener", &fixed("order", 1.0)), &solid, 1e-10);
    let nearly = fit("fractional-zener", &fixed("order", 1.0 - 1e-7));
    same(&nearly, &solid, 1e-5);
    // ln ϱ = 0.05 is a spectrum 5 % wide.
    same(&fit("fung-continuous", &fixed("log_ratio", 1e-4)), &solid, 1e-6);
    let time = solid.value("time_constant_s").unwrap();
    for (law, name) in [("latency:1", "relative_rate_per_s"), ("fung:1", "nu_1_per_s")] {
        assert!((fit(law, &plain).value(name).unwrap() * time - 1.0).abs() < 1e-9, "{law}");
    }
}

#[test]
fn n_of_two_is_pelegs_law() {
    let peleg = fit("latency:2", &LawOptions::default());
    let [start, drop, rate] = ["start", "amplitude", "relative_rate_per_s"].map(|name| peleg.value(name).unwrap());
    // y₀ − y = t/(k₁ + k₂t) with Δ = 1/k₂ and λ = k₂/k₁.
    let (k_2, k_1) = (1.0 / drop, 1.0 / (drop * rate));
    for t in [0.0, 0.3, 2.0, 25.0] {
        assert!((peleg.predict(t) - (start - t / (k_1 + k_2 * t))).abs() < 1e-12 * start);
    }
}

#[test]
fn a_power_is_latency_without_equilibrium() {
    let power = fit("power", &LawOptions::default());
    let none = LawOptions {
        constant: ConstantChoice::Fixed(0.0),
        bounds: vec![("exponent".to_owned(), (0.2, 300.0))],
        ..LawOptions::default()
    };
    let latency = fit("latency", &none);
    same(&power, &latency, 1e-8);
    let (alpha, n) = (power.value("exponent").unwrap(), latency.value("exponent").unwrap());
    assert!((1.0 + 1.0 / alpha - n).abs() < 1e-5 * n, "{alpha} {n}");
    let rate = alpha / power.value("time_constant_s").unwrap();
    assert!((latency.value("relative_rate_per_s").unwrap() / rate - 1.0).abs() < 1e-6);
}

#[test]
fn a_large_exponent_is_nearly_a_logarithm() {
    let logarithm = fit("logarithmic", &LawOptions::default());
    let wide = |n: &str| {
        fit(&format!("latency:{n}"), &LawOptions::default()).residual_square / logarithm.residual_square - 1.0
    };
    let [near, nearer, nearest] = ["30", "300", "30000"].map(wide).map(f64::abs);
    assert!(near < 0.3 && nearer < 0.2 * near && nearest < 2e-2 * nearer, "{near:e} {nearer:e} {nearest:e}");
}

#[test]
fn fung_is_prony_in_other_parameters() {
    for terms in [1, 2] {
        let prony = fit(&format!("prony:{terms}"), &LawOptions::default());
        let fung = fit(&format!("fung:{terms}"), &LawOptions::default());
        same(&prony, &fung, 1e-12);
        let names: Vec<String> =
            (1..=terms).flat_map(|i| [format!("amplitude_{i}"), format!("time_constant_{i}_s")]).collect();
        let start = prony.value("start").unwrap();
        assert!((fung.value("elastic_response").unwrap() / start - 1.0).abs() < 1e-12);
        if terms == 2 {
            for (i, pair) in names.chunks(2).enumerate() {
                let [amplitude, time] = [0, 1].map(|k| prony.value(&pair[k]).unwrap());
                assert!((fung.value(&format!("c_{}", i + 1)).unwrap() * start / amplitude - 1.0).abs() < 1e-9);
                assert!((fung.value(&format!("nu_{}_per_s", i + 1)).unwrap() * time - 1.0).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn burgers_without_flow_is_the_standard_linear_solid_in_creep() {
    let times: Vec<f64> = (0..200).map(|i| 0.1 * f64::from(i)).collect();
    let values: Vec<f64> = times.iter().map(|t| 1.0 + 0.5 * (1.0 - (-t / 3.0).exp())).collect();
    let burgers = fit_to(&times, &values, "burgers", &creep());
    let solid = fit_to(&times, &values, "standard-linear-solid", &creep());
    assert!(burgers.value("flow_rate_per_s").unwrap().abs() < 1e-9);
    assert!((burgers.value("time_constant_s").unwrap() / solid.value("time_constant_s").unwrap() - 1.0).abs() < 1e-7);
    let held = LawOptions {
        bounds: vec![("flow".to_owned(), (-1e-300, 1e-300))],
        ..creep()
    };
    let held = fit_to(&times, &values, "burgers", &held);
    assert!((held.value("time_constant_s").unwrap() / solid.value("time_constant_s").unwrap() - 1.0).abs() < 1e-7);
}

/// Every law in the responses it has a form for.
fn all_laws() -> impl Iterator<Item = (Law, Response)> {
    let names = Law::NAMES
        .into_iter()
        .filter(|name| *name != "spectrum")
        .map(|name| name.replace('N', "5").replace('K', "2"));
    let laws = names.map(|name| name.parse::<Law>().unwrap());
    laws.flat_map(|law| [(law, Response::Relaxation), (law, Response::Creep)])
        .filter(|(law, response)| law.describes(*response))
}

/// Relative change of a fit in other units, beyond that of the units.
fn change(fit: &Fit, plain: &Fit, y_unit: f64, t_unit: f64) -> f64 {
    let unit = |unit: ParameterUnit| match unit {
        ParameterUnit::Signal => Some(y_unit),
        ParameterUnit::Second => Some(t_unit),
        ParameterUnit::PerSecond => Some(1.0 / t_unit),
        ParameterUnit::SignalPerSecond => Some(y_unit / t_unit),
        ParameterUnit::One => Some(1.0),
        // Their units have powers that are found from the data.
        ParameterUnit::RateCoefficient | ParameterUnit::SignalPerPower => None,
    };
    let mut worst = (fit.residual_square / plain.residual_square / y_unit / y_unit - 1.0).abs();
    for (a, b) in fit.parameters.iter().zip(&plain.parameters) {
        if let Some(unit) = unit(a.unit) {
            let size = b.estimate.white_standard_error.unwrap_or(0.0).max(b.estimate.value.abs());
            if size > 0.0 {
                worst = worst.max((a.estimate.value / unit - b.estimate.value).abs() / size);
            }
            if let (Some(a), Some(b)) = (a.estimate.white_standard_error, b.estimate.white_standard_error) {
                worst = worst.max(0.1 * (a / b / unit - 1.0).abs());
            }
        }
    }
    worst
}

#[test]
fn no_unit_changes_the_fit_of_any_law() {
    let mut worst = 0.0f64;
    for (law, response) in all_laws() {
        let options = LawOptions {
            response,
            ..LawOptions::default()
        };
        let (times, relaxing) = hold(2e-3);
        let creeping = relaxing.iter().zip(&times).map(|(y, t)| 4.0 - y + 0.03 * t).collect();
        let values: Vec<f64> = if response == Response::Creep { creeping } else { relaxing };
        let plain = fit_law(&Samples::new(&times, &values), law, &options).unwrap();
        for (y_unit, t_unit) in [(1e12, 1.0), (1e-12, 1.0), (1.0, 1e9), (1.0, 1e-9), (1e12, 1e-9)] {
            let other_times: Vec<f64> = times.iter().map(|t| t * t_unit).collect();
            let other_values: Vec<f64> = values.iter().map(|y| y * y_unit).collect();
            let fit = fit_law(&Samples::new(&other_times, &other_values), law, &options).unwrap();
            assert_eq!(fit.termination, plain.termination, "{law} {response:?} {y_unit:e} {t_unit:e}");
            let change = change(&fit, &plain, y_unit, t_unit);
            assert!(change < 1e-9, "{law} {response:?} {y_unit:e} {t_unit:e}: {change:e}");
            worst = worst.max(change);
        }
    }
    println!("largest relative change {worst:.1e}");
}

#[test]
fn a_clock_that_counts_from_1970_changes_nothing() {
    // Times on a grid of 2⁻²⁰ s are exact on both clocks.
    let start = 1_700_000_000.0;
    let (times, values) = hold(2e-3);
    let times: Vec<f64> = times.iter().map(|t| (t * 1_048_576.0).round() / 1_048_576.0).collect();
    let times: Vec<f64> = times.iter().map(|t| (t + start) - start).collect();
    let late: Vec<f64> = times.iter().map(|t| t + start).collect();
    for (law, response) in all_laws() {
        let options = LawOptions {
            response,
            ..LawOptions::default()
        };
        let rising = late.windows(2).all(|pair| pair[0] < pair[1]);
        assert!(rising);
        let plain = fit_law(&Samples::new(&times, &values), law, &options).unwrap();
        let shifted = fit_law(&Samples::new(&late, &values), law, &options).unwrap();
        assert_eq!(plain.values, shifted.values, "{law} {response:?}");
    }
}
