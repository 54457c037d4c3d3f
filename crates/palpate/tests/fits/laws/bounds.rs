//! Bounds of numbered terms: the best fit inside of them, under the numbers that they were given.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::fit::{Fit, LawOptions, Samples, Termination, fit_law};
use palpate::laws::Law;
use palpate::test_problems::Rng;

type Bounds = [(&'static str, (f64, f64))];

fn samples() -> (Vec<f64>, Vec<f64>) {
    let mut random = Rng::new(6);
    let times: Vec<f64> = (0..300).map(|i| 40.0 * f64::from(i) / 299.0).collect();
    let values = times.iter().map(|t| 1.0 + (-t / 2.0).exp() + 0.3 * (-t / 25.0).exp() + 0.005 * random.normal());
    let values = values.collect();
    (times, values)
}

fn fitted(law: Law, fixed: &[(&str, f64)], bounds: &Bounds) -> Fit {
    let (times, values) = samples();
    let options = LawOptions {
        fixed: fixed.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
        bounds: bounds.iter().map(|(name, ends)| ((*name).to_owned(), *ends)).collect(),
        ..LawOptions::default()
    };
    fit_law(&Samples::new(&times, &values), law, &options).unwrap()
}

/// Terms were put in the order of their times whatever bounds they had: `amplitude_1` between 0 and 0.5 was 0.98, and the fit was good.
#[test]
fn numbered_terms_keep_the_bounds_that_they_were_given() {
    let law = Law::Prony { terms: 2 };
    let cases: [&Bounds; 7] = [
        &[("amplitude_1", (0.0, 0.5))],
        &[("time_constant_1_s", (10.0, 40.0))],
        &[("time_constant_2_s", (0.5, 4.0))],
        &[("time_constant_2_s", (15.0, 18.0))],
        &[("time_constant_1_s", (3.0, 4.0))],
        &[("amplitude_2", (0.1, 0.2)), ("time_constant_1_s", (1.0, 3.0))],
        &[("time_constant_1_s", (0.5, 1.0)), ("time_constant_2_s", (1.5, 1.8))],
    ];
    for bounds in cases {
        let fit = fitted(law, &[], bounds);
        for (name, (low, high)) in bounds {
            let value = fit.estimate(name).unwrap().value;
            assert!(low * (1.0 - 1e-9) <= value && value <= high * (1.0 + 1e-9), "{bounds:?}: {name} = {value}");
        }
        // No pair of times inside the bounds leaves less.
        let of =
            |name: &str| bounds.iter().find(|(bounded, _)| *bounded == name).map_or((0.2, 100.0), |(_, ends)| *ends);
        let times = |(low, high): (f64, f64)| (0..12).map(move |i| low * (high / low).powf(f64::from(i) / 11.0));
        for first in times(of("time_constant_1_s")) {
            for second in times(of("time_constant_2_s")).filter(|second| (second / first).ln().abs() > 0.01) {
                let held = [("time_constant_1_s", first), ("time_constant_2_s", second)];
                let amplitudes: Vec<_> =
                    bounds.iter().filter(|(name, _)| name.starts_with("amplitude")).copied().collect();
                let other = fitted(law, &held, &amplitudes);
                assert!(fit.residual_square <= other.residual_square * (1.0 + 1e-9), "{bounds:?}: {held:?}");
            }
        }
    }
    let slow_first = fitted(law, &[], cases[0]);
    assert_eq!(slow_first.termination, Termination::Converged);
    assert!((slow_first.estimate("amplitude_1").unwrap().value - 0.3).abs() < 0.05);
    assert_eq!(fitted(law, &[], cases[3]).termination, Termination::RateAtBound);
    // Bounds narrower than the standard error leave the term determined.
    let free = fitted(law, &[], &[]).estimate("time_constant_2_s").unwrap().value;
    let narrow = fitted(law, &[], &[("time_constant_2_s", (free * (1.0 - 1e-3), free * (1.0 + 1e-3)))]);
    assert_eq!(narrow.termination, Termination::Converged);
    // Bounds that do not tell terms apart leave them in the order of their times.
    let alike = fitted(law, &[], &[("time_constant_1_s", (0.1, 100.0)), ("time_constant_2_s", (0.1, 100.0))]);
    assert!((alike.residual_square / fitted(law, &[], &[]).residual_square - 1.0).abs() < 1e-9);
}
