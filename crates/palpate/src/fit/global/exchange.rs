//! A series of exponentials with terms replaced: two of them are taken away and sought again everywhere beside those that stay.
//!
//! Where the signal is far above the noise a grid of all rates at once sees only the valley of the strongest terms. With these kept where
//! they are, a grid of two shows what the others might be instead: one elsewhere, both, or both as one.

use super::grid::{Grid, distinct, rates};
use super::lattice::Lattice;
use super::merged::exact::local;
use super::merged::valley::Valley;
use super::plane::Plane;
use crate::fit::problem::condensed::Condensed;
use crate::fit::problem::model::Model;
use crate::optimise::{Work, distance};

/// Terms that are replaced at once.
const REPLACED: usize = 2;

/// Rounds of replacing.
const ROUNDS: usize = 4;

/// Valleys that terms are replaced in, each round.
const OPEN: usize = 2;

/// Replacements that are followed.
const FOLLOWED: usize = 4;

/// The valleys with those that replacing terms opens, deepest first.
pub(crate) fn exchanged(model: &Model, nodes: &Condensed, valleys: Vec<Valley>, work: &mut Work) -> Vec<Valley> {
    let mut all = valleys;
    let mut seen: Vec<Vec<f64>> = Vec::new();
    for _ in 0..ROUNDS {
        all.sort_by(|a, b| a.square.total_cmp(&b.square));
        let fresh = |valley: &&Valley| seen.iter().all(|other| distance(other, &rising(&valley.theta)) > SAME);
        let fresh = all.iter().filter(fresh).map(|valley| rising(&valley.theta));
        let next = distinct(fresh, OPEN, |other, theta| distance(other, theta) <= SAME);
        let lowest = all.first().map_or(f64::INFINITY, |valley| valley.square);
        for theta in next {
            all.extend(replaced(model, nodes, &theta, work));
            seen.push(theta);
        }
        if !all.iter().any(|valley| valley.square < lowest * (1.0 - ENOUGH)) {
            break;
        }
    }
    all.sort_by(|a, b| a.square.total_cmp(&b.square));
    all
}

/// Largest difference of ln λ between valleys that are the same.
const SAME: f64 = 1e-2;

/// Relative fall of the residual square that counts as none.
const ENOUGH: f64 = 1e-8;

/// Rates in rising order: the order of terms is of no account.
pub(crate) fn rising(theta: &[f64]) -> Vec<f64> {
    let mut rates = theta.to_vec();
    rates.sort_by(f64::total_cmp);
    rates
}

/// Valleys near `theta` with every two terms replaced.
fn replaced(model: &Model, nodes: &Condensed, theta: &[f64], work: &mut Work) -> Vec<Valley> {
    let shapes = model.at(&nodes.times);
    let mut aside = Work::default();
    let mut found = Vec::new();
    for first in 0..theta.len() {
        for second in first + 1..theta.len() {
            let kept: Vec<f64> = (0..theta.len()).filter(|i| *i != first && *i != second).map(|i| theta[i]).collect();
            for start in paired(model, nodes, &kept, work) {
                found.push(local(&shapes, nodes.target(), &start, ENOUGH, &mut aside));
            }
        }
    }
    work.condensed += aside.evaluations;
    found
}

/// The rates `kept` with two more, wherever a dense grid of these two shows a valley.
pub(crate) fn paired(model: &Model, nodes: &Condensed, kept: &[f64], work: &mut Work) -> Vec<Vec<f64>> {
    let lattice = Lattice {
        model,
        nodes,
        shape: 0,
        plane: Plane::new(model, kept.iter().map(|rate| nodes.column(model, 0, &[*rate])), nodes),
        grid: rates(model.numbers[0].bounds, None, Grid::Dense),
        terms: REPLACED,
    };
    lattice.valleys(FOLLOWED, work).into_iter().map(|others| [kept, &others].concat()).collect()
}
