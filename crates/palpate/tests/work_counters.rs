//! What a fit costs, counted: a slow-down shows here without a clock.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::identify::{LawOptions, Samples, Termination, fit_law};
use palpate::test_problems::noisy_hold;

/// Law, grid points, evaluations over condensed samples and over all samples: at most so many.
const GOLDEN: [(&str, u64, u64, u64); 12] = [
    ("latency:5", 22, 6, 3),
    ("latency", 411, 11, 4),
    ("standard-linear-solid", 22, 6, 3),
    ("maxwell", 22, 6, 3),
    ("prony:2", 253, 22, 4),
    ("prony:3", 1793, 44, 4),
    ("fung-continuous", 220, 22, 3),
    ("stretched", 264, 74, 3),
    ("power", 308, 50, 3),
    ("logarithmic", 22, 6, 4),
    ("fractional-zener", 220, 42, 3),
    ("diffusion", 22, 7, 3),
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
