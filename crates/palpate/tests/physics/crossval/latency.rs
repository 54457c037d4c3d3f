//! The closed form of the law and its derivatives against 50-digit numbers (`latency_closed_form.json`).

use crate::common::reference;
use palpate::latency::{decay, decay_columns, decay_many};
use serde::Deserialize;
use serde::de::IgnoredAny;

#[derive(Deserialize)]
struct Case {
    n: f64,
    lambda: f64,
    t: f64,
    phi: f64,
    dphi_dlnlambda: f64,
    dphi_dn: f64,
    tol_phi: f64,
    tol_dlnlambda: f64,
    tol_dn: f64,
}

/// The functions for many times are held to the tolerances of those for one, but may give 0 below this size.
const BATCH_UNDERFLOW: f64 = 1e-300;

fn cases() -> Vec<Case> {
    let (_, cases) = reference::<IgnoredAny, Case>("latency_closed_form");
    assert!(cases.len() > 400);
    cases
}

/// Collects the largest error in units of its tolerance, and every case that is beyond.
#[derive(Default)]
struct Score {
    worst: f64,
    beyond: Vec<String>,
}

impl Score {
    fn add(&mut self, name: &str, case: &Case, found: f64, expected: f64, tolerance: f64) {
        let error = (found - expected).abs();
        self.worst = self.worst.max(error / tolerance);
        if error.is_nan() || error > tolerance {
            let Case { n, lambda, t, .. } = case;
            self.beyond.push(format!("{name}: n = {n}, λ = {lambda}, t = {t}: {found:e} for {expected:e}"));
        }
    }

    fn finish(self, what: &str) {
        println!("{what}: worst error {:.3} of the tolerance", self.worst);
        assert!(self.beyond.is_empty(), "{what}\n{}", self.beyond.join("\n"));
    }
}

#[test]
fn one_value_at_a_time() {
    let mut value = Score::default();
    for case in &cases() {
        value.add("φ", case, decay(case.lambda * case.t, case.n), case.phi, case.tol_phi);
    }
    value.finish("φ");
}

#[test]
fn many_values_at_once() {
    // Blocks of vector lanes and what remains take different paths: once alone, once in a row of 19 times.
    const COPIES: usize = 19;
    let tolerance = |one: f64| one + BATCH_UNDERFLOW;
    let (mut value, mut by_rate, mut by_exponent) = (Score::default(), Score::default(), Score::default());
    for case in &cases() {
        for copies in [1, COPIES] {
            let times = vec![case.t; copies];
            let [mut phi, mut again, mut third] = [vec![0.0; copies], vec![0.0; copies], vec![0.0; copies]];
            let [mut by_log_rate, mut by_log_rate_again, mut by_n] =
                [vec![0.0; copies], vec![0.0; copies], vec![0.0; copies]];
            decay_many(&times, case.lambda, case.n, &mut phi);
            decay_columns(&times, case.lambda, case.n, [&mut again, &mut by_log_rate_again]);
            decay_columns(&times, case.lambda, case.n, [&mut third, &mut by_log_rate, &mut by_n]);
            assert_eq!((&phi, &phi, &by_log_rate), (&again, &third, &by_log_rate_again));
            for i in 0..copies {
                value.add("φ", case, phi[i], case.phi, tolerance(case.tol_phi));
                by_rate.add("∂φ/∂ln λ", case, by_log_rate[i], case.dphi_dlnlambda, tolerance(case.tol_dlnlambda));
                by_exponent.add("∂φ/∂n", case, by_n[i], case.dphi_dn, tolerance(case.tol_dn));
            }
        }
    }
    value.finish("φ, many");
    by_rate.finish("∂φ/∂ln λ, many");
    by_exponent.finish("∂φ/∂n, many");
}
