//! Where the search begins: a grid over the numbers of the law, the stiffness following from each point of it.

use super::prepared::Prepared;
use super::problem::{Problem, dot, sum_of_squares};
use super::{CalibrateError, EquilibriumLaw};
use crate::laws::{ExponentChoice, Law};
use crate::simulate::simulate_force;
use crate::watch::{Cancelled, Stages};

/// Exponents that are tried where n is to be found.
const EXPONENTS: [f64; 6] = [1.0, 1.6, 2.5, 4.0, 6.0, 10.0];

/// Starting points, the best first.
pub(super) fn starts(
    prepared: &Prepared,
    problem: &Problem<'_>,
    simulations: &mut u64,
    stages: &mut Stages<'_>,
) -> Result<Vec<Vec<f64>>, Cancelled> {
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    let grid = laws(prepared);
    let count = grid.len() as f64;
    for (index, law) in grid.into_iter().enumerate() {
        stages.reach(index as f64 / count)?;
        *simulations += 1;
        if let Some((square, modulus)) = scaled(prepared, problem, &law) {
            let mut theta = match prepared.candidate.equilibrium {
                EquilibriumLaw::Table => prepared.table_like(modulus),
                EquilibriumLaw::EvenStrain | EquilibriumLaw::Hertz { .. } => vec![modulus.ln()],
            };
            theta.extend(law);
            found.push((square, theta));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Neighbours on the grid end in the same valley.
    let mut apart: Vec<Vec<f64>> = Vec::new();
    let skip = prepared.stiffnesses();
    for (_, theta) in found {
        let near = |other: &Vec<f64>| {
            let steps = theta[skip..].iter().zip(&other[skip..]).map(|(a, b)| (a - b).abs());
            steps.fold(0.0, f64::max) < 1.7
        };
        if !apart.iter().any(near) {
            apart.push(theta);
        }
    }
    Ok(apart)
}

/// Why no point of the grid is one to start from: what keeps the first from being simulated, or a force that does not rise.
pub(super) fn refusal(prepared: &Prepared, problem: &Problem<'_>) -> CalibrateError {
    let unit = match prepared.candidate.equilibrium {
        EquilibriumLaw::Table => prepared.table_like(1.0),
        EquilibriumLaw::EvenStrain | EquilibriumLaw::Hertz { .. } => vec![0.0],
    };
    let first = laws(prepared).into_iter().next().unwrap_or_default();
    let theta: Vec<f64> = unit.into_iter().chain(first).collect();
    let simulated = prepared.contact(&theta).map(|contact| simulate_force(problem.motion, &contact, problem.times));
    match simulated {
        Some(Err(error)) => error.into(),
        _ => CalibrateError::NoStiffness,
    }
}

/// The best modulus with these numbers of the law, and the squared residual it leaves.
fn scaled(prepared: &Prepared, problem: &Problem<'_>, law: &[f64]) -> Option<(f64, f64)> {
    let unit = match prepared.candidate.equilibrium {
        EquilibriumLaw::Table => prepared.table_like(1.0),
        EquilibriumLaw::EvenStrain | EquilibriumLaw::Hertz { .. } => vec![0.0],
    };
    let theta: Vec<f64> = unit.iter().chain(law).copied().collect();
    let forces = problem.forces_with(&theta)?;
    let modulus = dot(&forces, problem.forces) / sum_of_squares(&forces);
    let residuals = problem.forces.iter().zip(&forces).map(|(measured, force)| (measured - modulus * force).powi(2));
    let square: f64 = residuals.sum();
    (modulus > 0.0 && square.is_finite()).then_some((square, modulus))
}

/// The grid, in the searched numbers of the law.
fn laws(prepared: &Prepared) -> Vec<Vec<f64>> {
    let scales = prepared.scales;
    // From what is over within a ramp to what a record hardly sees.
    let rates = |count: usize| spread((0.3 / scales.duration).ln(), (30.0 / scales.ramp).ln(), count);
    match prepared.candidate.law {
        Law::Latency { exponent } => {
            let free: Vec<Vec<f64>> = match exponent {
                ExponentChoice::Free => EXPONENTS.iter().map(|n| vec![n.ln()]).collect(),
                ExponentChoice::Fixed(_) => vec![Vec::new()],
            };
            // At the excess of a sudden squeeze a law of high order is faster by far than over the rest of a hold.
            let n = match exponent {
                ExponentChoice::Free => EXPONENTS[EXPONENTS.len() - 1],
                ExponentChoice::Fixed(n) => n,
            };
            let fastest = (30.0 / scales.ramp).ln() + n.clamp(1.0, 10.0).ln();
            let mut grid = Vec::new();
            for exponent in free {
                for rate in spread((0.3 / scales.duration).ln(), fastest, 14) {
                    for overshoot in spread(0.1f64.ln(), 60f64.ln(), 10) {
                        // A rate coefficient that depends on nothing is where one that does begins.
                        let factor = prepared.candidate.rate.factor_name().map(|_| 0.0);
                        let law = exponent.iter().copied().chain([rate, overshoot]).chain(factor);
                        grid.push(law.collect());
                    }
                }
            }
            grid
        }
        Law::Prony { terms } | Law::Fung { terms } if terms > 1 => {
            let mut grid = Vec::new();
            for chosen in combinations(&rates(7), terms) {
                for overshoot in spread(0.03f64.ln(), 3f64.ln(), 4) {
                    grid.push(chosen.iter().flat_map(|rate| [overshoot, *rate]).collect());
                }
            }
            grid
        }
        _ => {
            let mut grid = Vec::new();
            for rate in rates(14) {
                for overshoot in spread(0.03f64.ln(), 10f64.ln(), 8) {
                    grid.push(vec![overshoot, rate]);
                }
            }
            grid
        }
    }
}

/// Evenly spaced numbers from low to high.
fn spread(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| low + (high - low) * i as f64 / (count - 1) as f64).collect()
}

/// All choices of `count` of the numbers.
fn combinations(numbers: &[f64], count: usize) -> Vec<Vec<f64>> {
    if count == 0 {
        return vec![Vec::new()];
    }
    let from = |index: usize| {
        let rest = combinations(&numbers[index + 1..], count - 1);
        rest.into_iter().map(move |mut rest| {
            rest.insert(0, numbers[index]);
            rest
        })
    };
    (0..numbers.len()).flat_map(from).collect()
}
