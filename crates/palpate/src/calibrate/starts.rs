//! Where the search begins: a grid over the numbers of the law, the stiffness following from each point of it.

use super::CalibrateError;
use super::prepared::Prepared;
use super::problem::{Problem, dot, sum_of_squares};
use crate::fit::{combinations, distinct};
use crate::laws::{ExponentChoice, Law};
use crate::optimise::distance;
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
            let mut theta = prepared.stiffnesses_like(modulus);
            theta.extend(law);
            found.push((square, theta));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Neighbours on the grid end in the same valley.
    let skip = prepared.stiffnesses();
    let near = |a: &Vec<f64>, b: &Vec<f64>| distance(&a[skip..], &b[skip..]) < 1.7;
    Ok(distinct(found.into_iter().map(|(_, theta)| theta), usize::MAX, near))
}

/// Why no point of the grid is one to start from: what keeps the first from being simulated, or a force that does not rise.
pub(super) fn refusal(prepared: &Prepared, problem: &Problem<'_>) -> CalibrateError {
    let first = laws(prepared).into_iter().next().unwrap_or_default();
    let theta = [prepared.stiffnesses_like(1.0), first].concat();
    let simulated = prepared.contact(&theta).map(|contact| simulate_force(problem.motion, &contact, problem.times));
    match simulated {
        Some(Err(error)) => error.into(),
        _ => CalibrateError::NoStiffness,
    }
}

/// The best modulus with these numbers of the law, and the squared residual it leaves.
fn scaled(prepared: &Prepared, problem: &Problem<'_>, law: &[f64]) -> Option<(f64, f64)> {
    let theta = [prepared.stiffnesses_like(1.0).as_slice(), law].concat();
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
            let free = EXPONENTS.iter().map(|n| vec![n.ln()]);
            let free: Vec<Vec<f64>> = if exponent == ExponentChoice::Free { free.collect() } else { vec![Vec::new()] };
            // At the excess of a sudden squeeze a law of high order is faster by far than over the rest of a hold.
            let n = exponent.given().unwrap_or(EXPONENTS[EXPONENTS.len() - 1]);
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
        _ => {
            let terms = prepared.candidate.terms().unwrap_or(1);
            let (rates, overshoots) = if terms > 1 {
                (rates(7), spread(0.03f64.ln(), 3f64.ln(), 4))
            } else {
                (rates(14), spread(0.03f64.ln(), 10f64.ln(), 8))
            };
            let mut grid = Vec::new();
            for chosen in combinations(rates.len(), terms) {
                for overshoot in &overshoots {
                    grid.push(chosen.iter().flat_map(|i| [*overshoot, rates[*i]]).collect());
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
