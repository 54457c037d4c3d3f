//! The parameter of exponentials found from the data, and the redundant_terms of series that are too long.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::fit::{LawOptions, RedundantTerm, Samples, Termination, fit_law};
use palpate::forecast::{CompareOptions, compare_laws};
use palpate::laws::Law;
use palpate::test_problems::Rng;

use crate::repeats::repeats;

fn hold(amplitudes: &[f64], noise: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut random = Rng::new(seed);
    let times: Vec<f64> = (0..500).map(|i| 100.0 * (f64::from(i) / 499.0).powi(2)).collect();
    let taus = [0.5, 5.0, 50.0];
    let value = |t: &f64| {
        let terms: f64 = amplitudes.iter().zip(taus).map(|(amplitude, tau)| amplitude * (-t / tau).exp()).sum();
        2.0 + terms + noise * random.normal()
    };
    let values = times.iter().map(value).collect();
    (times, values)
}

/// Terms of the series that a comparison of series of 1 to `most` terms chooses.
fn chosen(times: &[f64], values: &[f64], most: usize) -> Option<usize> {
    let options = CompareOptions {
        laws: (1..=most).map(|terms| Law::Prony { terms }).collect(),
        ..CompareOptions::default()
    };
    match compare_laws(&Samples::new(times, values), &options).unwrap().verdict?.law {
        Law::Prony { terms } => Some(terms),
        _ => None,
    }
}

#[test]
fn as_many_terms_are_chosen_as_there_are() {
    for amplitudes in [&[1.0][..], &[1.0, -0.7], &[1.0, 0.8], &[1.0, 0.8, 0.6]] {
        let (mut right, seeds) = (0, repeats(2, 8));
        for seed in 0..seeds {
            let (times, values) = hold(amplitudes, 1e-3, seed);
            right += u64::from(chosen(&times, &values, 4) == Some(amplitudes.len()));
        }
        assert_eq!(right, seeds, "{amplitudes:?}");
    }
}

#[test]
fn an_exact_series_is_not_made_longer() {
    let (times, values) = hold(&[1.0, 0.8], 0.0, 0);
    assert_eq!(chosen(&times, &values, 3), Some(2));
}

#[test]
fn a_term_too_many_is_redundant_or_no_answer() {
    let mut merged = 0;
    for seed in 0..40 {
        let (times, values) = hold(&[1.0], 1e-3, seed);
        let fit = fit_law(&Samples::new(&times, &values), Law::Prony { terms: 2 }, &LawOptions::default()).unwrap();
        let amplitudes: Vec<f64> = fit.curve.terms.iter().map(|term| term.amplitude.abs()).collect();
        // Whatever is called good and free of redundant_terms has amplitudes of the size of the signal.
        let sound = fit.termination == Termination::Converged && fit.redundant_terms.is_empty();
        assert!(!sound || amplitudes.iter().all(|amplitude| *amplitude < 10.0), "{fit:?}");
        assert!(fit.termination != Termination::TermsMerged || fit.white_covariance.is_none());
        merged +=
            usize::from(fit.redundant_terms.iter().any(|term| matches!(term, RedundantTerm::Merged { a: 1, b: 2 })));
    }
    println!("{merged} of 40 merged");
    assert!(merged > 0);
}
