//! Terms that a fit lists and the data do not have.

use serde::{Deserialize, Serialize};

use super::model::Model;
use crate::optimise::Solution;

/// A redundant term of a series of exponentials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RedundantTerm {
    /// Two terms, counted from 1, whose times the data cannot tell apart: ln τ differs by less than the standard error of the
    /// difference. Their amplitudes are free to grow without bounds against each other.
    Merged {
        /// The faster one.
        a: usize,
        /// The slower one.
        b: usize,
    },
    /// A term, counted from 1, whose amplitude is smaller than its standard error.
    Vanishing {
        /// Which.
        term: usize,
    },
}

/// Difference of ln τ below which terms are merged where there are no standard errors.
const ALIKE: f64 = 0.05;

/// The redundant terms among the exponentials of a solution, in the order of its terms.
pub(crate) fn redundant_terms(model: &Model, solution: &Solution) -> Vec<RedundantTerm> {
    if !model.is_series() {
        return Vec::new();
    }
    let (moving, _) = model.moving();
    let size = solution.linear.len() + solution.nonlinear.len();
    let variance =
        |i: usize, j: usize| solution.inverse_normal.as_ref().map(|inverse| inverse[i * size + j] * solution.variance);
    let mut all = Vec::new();
    for b in 0..moving.len() {
        for a in 0..b {
            let (i, j) = (solution.linear.len() + a, solution.linear.len() + b);
            let spread = || Some((variance(i, i)? + variance(j, j)? - 2.0 * variance(i, j)?).max(0.0).sqrt());
            let apart = (solution.nonlinear[a] - solution.nonlinear[b]).abs();
            if apart < spread().unwrap_or(ALIKE) {
                all.push(RedundantTerm::Merged { a: a + 1, b: b + 1 });
            }
        }
    }
    for (term, &shape) in moving.iter().enumerate() {
        let place = usize::from(model.constant) + shape;
        let amplitude = solution.linear[place].abs();
        if variance(place, place).is_some_and(|variance| amplitude <= variance.sqrt()) || amplitude == 0.0 {
            all.push(RedundantTerm::Vanishing { term: term + 1 });
        }
    }
    all
}
