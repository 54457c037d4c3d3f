//! From a candidate and its data to the numbers with the least squared residual.
//!
//! A coarse grid over the law's numbers on few samples, the stiffness being linear there; then damped steps (Levenberg 1944, Marquardt
//! 1963) from the best few, and from the best of these on all samples. Derivatives are differences of simulations, which are good to
//! 10⁻¹².

use super::prepared::{Prepared, Searched};
use super::problem::{Found, Problem};
use super::starts::{refusal, starts};
use super::{CalibrateError, CalibrationData};
use crate::optimise::Termination;
use crate::simulate::Motion;
use crate::watch::{Cancelled, Stages};

/// Samples of the coarse search, and of the refinements before the last.
const FEW: usize = 400;

/// Starts that are refined.
const REFINED: usize = 8;

/// Valleys whose bottom is sought on the motion as measured.
const VALLEYS: usize = 2;

/// Steps of a refinement on few samples.
const MOST_STEPS: usize = 60;

/// Steps of the last one.
const MOST_LAST_STEPS: usize = 300;

/// Shares of the whole work that the grid, the coarse descents, those on the motion as measured, and the last one are.
const SHARES: [f64; 4] = [0.15, 0.25, 0.2, 0.38];

/// The best numbers of a candidate for the fitted part of its data.
pub(super) fn search(
    prepared: &Prepared,
    data: &CalibrationData,
    stages: &mut Stages<'_>,
) -> Result<Found, CalibrateError> {
    let (times, forces) = (&data.times()[..data.fitted()], &data.forces()[..data.fitted()]);
    let few = few(times, data.motion());
    let (few_times, few_forces): (Vec<f64>, Vec<f64>) = few.iter().map(|i| (times[*i], forces[*i])).unzip();
    let problem = |motion, times, forces| Problem {
        prepared,
        motion,
        times,
        forces,
        held: None,
    };
    // What the jaw does in less than a hundredth of the whole way moves no valley.
    let simple = data.motion().simplified(0.005 * prepared.scales.deepest);
    let coarse = problem(&simple, &few_times, &few_forces);
    let mut simulations = 0;
    stages.enter(SHARES[0]);
    let starts = starts(prepared, &coarse, &mut simulations, stages)?;
    if starts.is_empty() {
        return Err(refusal(prepared, &coarse));
    }
    // Valleys are told apart on the simple motion; every knot of a measured one takes its own share of a simulation.
    let mut descended = |problem: &Problem<'_>, starts: &[Vec<f64>], share: f64, stages: &mut Stages<'_>| {
        let mut found: Vec<Found> = Vec::new();
        for start in starts {
            stages.enter(share / starts.len() as f64);
            found.extend(problem.descend(start, MOST_STEPS, stages)?);
        }
        simulations += found.iter().map(|found| found.simulations).sum::<u64>();
        found.sort_by(|a, b| a.square.total_cmp(&b.square));
        Ok::<_, Cancelled>(found)
    };
    let starts: Vec<Vec<f64>> = starts.into_iter().take(REFINED).collect();
    let valleys = descended(&coarse, &starts, SHARES[1], stages)?;
    let valleys: Vec<Vec<f64>> = valleys.into_iter().take(VALLEYS).map(|found| found.theta).collect();
    let found = descended(&problem(data.motion(), &few_times, &few_forces), &valleys, SHARES[2], stages)?;
    let nearest = found.first().ok_or(CalibrateError::NoStiffness)?;
    stages.enter(SHARES[3]);
    let whole = problem(data.motion(), times, forces);
    let best = whole.descend(&nearest.theta, MOST_LAST_STEPS, stages)?;
    let mut best = best.ok_or(CalibrateError::NoStiffness)?;
    best.simulations += simulations;
    let at_bound = |(value, searched): (&f64, &Searched)| {
        let near = 1e-9 * (searched.high - searched.low);
        *value <= searched.low + near || *value >= searched.high - near
    };
    if best.termination == Termination::Converged
        && let Some(bound) = best.theta.iter().zip(&prepared.searched).position(at_bound)
    {
        best.termination = match prepared.searched[bound].name.as_str() {
            "exponent" => Termination::ExponentAtBound,
            name if name.contains("rate") => Termination::RateAtBound,
            name if name.starts_with("rise") => Termination::Converged,
            _ => Termination::AmplitudeAtBound,
        };
    }
    Ok(best)
}

/// Which samples stand for all: as many in every stretch between two knots as in any other where there are enough, and more the nearer to
/// its start, where things change.
fn few(times: &[f64], motion: &Motion) -> Vec<usize> {
    if times.len() <= FEW {
        return (0..times.len()).collect();
    }
    let simple = motion.simplified(0.01 * motion.displacements().iter().copied().fold(0.0, f64::max));
    let knots = simple.times();
    let each = (FEW / (knots.len() - 1)).max(3);
    let mut chosen = Vec::with_capacity(FEW + knots.len());
    for pair in knots.windows(2) {
        let (from, until) = (times.partition_point(|t| *t < pair[0]), times.partition_point(|t| *t < pair[1]));
        let count = until - from;
        for k in 0..each.min(count) {
            // Evenly in the square root of the time since the knot.
            let share = (k as f64 + 0.5) / each.min(count) as f64;
            chosen.push(from + ((count as f64) * share * share) as usize);
        }
    }
    chosen.sort_unstable();
    chosen.dedup();
    chosen.retain(|i| *i < times.len());
    chosen
}
