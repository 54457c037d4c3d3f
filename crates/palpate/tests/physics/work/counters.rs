//! What a fit costs, counted: a slow-down shows here without a clock.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::fit::{LawOptions, Samples, Termination, fit_law};
use palpate::test_problems::noisy_hold;

/// Law, grid points, evaluations over condensed samples and over all samples: at most so many.
const GOLDEN: [(&str, u64, u64, u64); 12] = [
    ("latency:5", 22, 4, 2),
    ("latency", 411, 9, 2),
    ("standard-linear-solid", 22, 6, 2),
    ("maxwell", 22, 5, 2),
    ("prony:2", 253, 20, 3),
    ("prony:3", 1793, 42, 3),
    ("fung-continuous", 220, 18, 2),
    ("stretched", 264, 68, 3),
    ("power", 308, 101, 2),
    ("logarithmic", 22, 6, 2),
    ("fractional-zener", 220, 36, 2),
    ("diffusion", 22, 42, 2),
];

#[test]
fn a_usual_hold_costs_a_few_evaluations() {
    let (times, values) = noisy_hold(1000, 5.0, 1e-3);
    for (law, grid_points, condensed, evaluations) in GOLDEN {
        let fit = fit_law(&Samples::new(&times, &values), law.parse().unwrap(), &LawOptions::default()).unwrap();
        assert_eq!(fit.termination, Termination::Converged, "{law}");
        assert_eq!(fit.work.grid_points, grid_points, "{law}: {:?}", fit.work);
        // Rounding may cost a step more on another machine, and no more than that.
        assert!(fit.work.condensed <= condensed + 2 + condensed / 10, "{law}: {:?}", fit.work);
        assert!(fit.work.evaluations <= evaluations + 1, "{law}: {:?}", fit.work);
        assert!(fit.work.evaluations > 0 && fit.work.condensed > 0, "{law}: {:?}", fit.work);
    }
}
