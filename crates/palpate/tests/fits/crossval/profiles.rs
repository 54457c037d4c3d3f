//! Profile-likelihood intervals against roots of an independent profile (`profile_intervals.json`).

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use crate::common::reference;
use palpate::fit::{LawOptions, NoiseChoice, Samples, fit_law, profile_interval};
use palpate::laws::{ExponentChoice, Law};
use serde::Deserialize;

#[derive(Deserialize)]
struct Tolerance {
    ends_in_standard_errors: f64,
}

#[derive(Deserialize)]
struct Case {
    name: String,
    law: String,
    fixed: std::collections::BTreeMap<String, f64>,
    t: Vec<f64>,
    y: Vec<f64>,
    parameters: Vec<String>,
    standard_errors: Vec<f64>,
    probability: f64,
    lower: Vec<Option<f64>>,
    upper: Vec<Option<f64>>,
}

impl Case {
    fn law(&self) -> Law {
        match self.law.as_str() {
            "latency" => Law::Latency {
                exponent: self.fixed.get("exponent").map_or(ExponentChoice::Free, |n| ExponentChoice::Fixed(*n)),
            },
            "standard_linear_solid" => Law::StandardLinearSolid,
            "prony" => Law::Prony { terms: 2 },
            "stretched" => Law::Stretched,
            other => panic!("{other}"),
        }
    }

    /// What a parameter of the reference is called here, and whether its ends are those of ln(1/parameter), of ln, or its own.
    fn parameter(&self, parameter: &str, names: &[String]) -> (String, fn(f64) -> f64, bool) {
        if let Some(rest) = parameter.strip_prefix("ln_rate") {
            let time = format!("time_constant{rest}_s");
            if names.contains(&time) {
                return (time, |value| -value.ln(), true);
            }
            let rate = names.iter().find(|name| name.contains("rate") && !name.contains("coefficient"));
            return (rate.unwrap().clone(), f64::ln, false);
        }
        let name = if parameter == "constant" { "equilibrium" } else { parameter };
        let name = if names.iter().any(|known| known == name) { name.to_owned() } else { names[3].clone() };
        (name, |value| value, false)
    }
}

#[test]
fn ends_of_intervals() {
    let (tolerance, cases) = reference::<Tolerance, Case>("profile_intervals");
    let (mut compared, mut open, mut worst) = (0, 0, 0.0f64);
    for case in cases {
        let samples = Samples::new(&case.t, &case.y);
        // The reference takes residuals as white, which widens nothing.
        let options = LawOptions {
            confidence: case.probability,
            noise: NoiseChoice::White,
            ..LawOptions::default()
        };
        let fit = fit_law(&samples, case.law(), &options).unwrap();
        let names: Vec<String> = fit.parameters.iter().map(|parameter| parameter.name.to_string()).collect();
        for (k, parameter) in case.parameters.iter().enumerate() {
            let (name, transformed, reversed) = case.parameter(parameter, &names);
            let found = profile_interval(&samples, case.law(), &options, &name).unwrap();
            let ends = if reversed { [found.high, found.low] } else { [found.low, found.high] };
            for (end, expected) in ends.into_iter().zip([case.lower[k], case.upper[k]]) {
                let what = format!("{}: {name} {end:?} {expected:?}", case.name);
                assert_eq!(end.is_none(), expected.is_none(), "{what}");
                if let (Some(end), Some(expected)) = (end, expected) {
                    let distance = (transformed(end) - expected).abs() / case.standard_errors[k];
                    worst = worst.max(distance);
                    assert!(distance <= tolerance.ends_in_standard_errors, "{what}: {distance:.1e} standard errors");
                    compared += 1;
                } else {
                    open += 1;
                }
            }
        }
    }
    println!("{compared} ends, {open} open, worst {worst:.1e} standard errors");
    assert_eq!((compared, open), (58, 6));
}
