//! From a candidate and its data to the parameters with the least squared residual.
//!
//! A coarse grid over the law's parameters on few samples, the stiffness being linear there; then damped steps (Levenberg 1944, Marquardt
//! 1963) from the best few, and from the best of these on all samples. Derivatives are differences of simulations, which are good to
//! 10⁻¹².

use super::prepared::{Prepared, Searched};
use super::problem::{Descent, Found, Precision, Problem, dot, sum_of_squares};
use super::{CalibrateError, CalibrationData};
use crate::fit::{combinations, distinct};
use crate::laws::{ExponentChoice, Law};
use crate::optimise::{Termination, distance};
use crate::parallel::for_each;
use crate::simulate::{Motion, simulate_force};
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

/// The best parameters of a candidate for the fitted part of its data.
pub(super) fn search(
    prepared: &Prepared,
    data: &CalibrationData,
    stages: &mut Stages<'_>,
) -> Result<Found, CalibrateError> {
    let whole = Problem::of(prepared, data);
    let problem = |motion, times, forces| Problem {
        motion,
        times,
        forces,
        precision: Precision::Coarse,
        ..whole
    };
    let few = few(whole.times, whole.motion);
    let (few_times, few_forces): (Vec<f64>, Vec<f64>) = few.iter().map(|i| (whole.times[*i], whole.forces[*i])).unzip();
    // What the jaw does in less than a hundredth of the whole way moves no valley.
    let simple = data.motion().simplified(0.005 * prepared.scales.deepest);
    let coarse = problem(&simple, &few_times, &few_forces);
    let mut simulations = 0;
    stages.enter(SHARES[0]);
    let starts = starts(prepared, &coarse, &mut simulations, stages)?;
    if starts.is_empty() {
        return Err(refusal(prepared, &coarse));
    }
    // Valleys are distinguished on the simple motion; every knot of a measured one takes its own share of a simulation.
    let starts: Vec<Vec<f64>> = starts.into_iter().take(REFINED).collect();
    stages.enter(SHARES[1]);
    let found = valleys(&coarse, &starts, &mut simulations, stages)?;
    let deepest: Vec<Vec<f64>> = found.into_iter().take(VALLEYS).map(|found| found.theta).collect();
    stages.enter(SHARES[2]);
    let measured = problem(data.motion(), &few_times, &few_forces);
    let found = valleys(&measured, &deepest, &mut simulations, stages)?;
    let nearest = found.first().ok_or(CalibrateError::NoStiffness)?;
    stages.enter(SHARES[3]);
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

/// The bottoms of the valleys that `starts` lie in, the deepest first. All go down step by step, and of those whose forces have become alike
/// one goes on.
fn valleys(
    problem: &Problem<'_>,
    starts: &[Vec<f64>],
    simulations: &mut u64,
    stages: &mut Stages<'_>,
) -> Result<Vec<Found>, Cancelled> {
    let alike = |a: &Descent, b: &Descent| {
        let apart = a.found.residuals.iter().zip(&b.found.residuals).map(|(a, b)| (a - b).powi(2));
        apart.sum::<f64>() <= ALIKE * a.found.square
    };
    let taken = |descents: &[Descent]| descents.iter().map(|descent| descent.found.simulations).sum::<u64>();
    let mut descents: Vec<Descent> =
        for_each(starts.len(), |index| problem.descent(&starts[index])).into_iter().flatten().collect();
    for step in 0..MOST_STEPS {
        stages.reach(step as f64 / MOST_STEPS as f64)?;
        if descents.iter().all(|descent| descent.is_over) {
            break;
        }
        let left = (MOST_STEPS - step) as f64;
        let next = |index: usize| {
            let descent = &descents[index];
            if descent.is_over { Some(descent.clone()) } else { problem.step(descent.clone()) }
        };
        let mut stepped: Vec<Descent> = for_each(descents.len(), next).into_iter().flatten().collect();
        stepped.sort_by(|a, b| a.found.square.total_cmp(&b.found.square));
        let all = taken(&stepped);
        descents = distinct(stepped, usize::MAX, alike);
        *simulations += all - taken(&descents);
        // At its present pace it will not come as deep as another already is.
        let deepest = descents.first().map_or(0.0, |first| first.found.square);
        for descent in &mut descents {
            descent.is_over |= descent.found.square * (-descent.gain * left).exp() > deepest;
        }
    }
    *simulations += taken(&descents);
    Ok(descents.into_iter().map(|descent| descent.found).collect())
}

/// Squared difference of the forces of two descents, as a share of the squared residual, below which they are in one valley.
const ALIKE: f64 = 1e-2;

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

/// Points of the grid between two looks at the watch.
const AT_ONCE: usize = 32;

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
    for (part, laws) in grid.chunks(AT_ONCE).enumerate() {
        stages.reach((part * AT_ONCE) as f64 / count)?;
        *simulations += laws.len() as u64;
        let scaled = for_each(laws.len(), |index| scaled(prepared, problem, &laws[index]));
        for (law, scaled) in laws.iter().zip(scaled) {
            if let Some((square, modulus)) = scaled {
                let mut theta = prepared.stiffnesses_like(modulus);
                theta.extend(law);
                found.push((square, theta));
            }
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

/// The best modulus with these parameters of the law, and the squared residual it leaves.
fn scaled(prepared: &Prepared, problem: &Problem<'_>, law: &[f64]) -> Option<(f64, f64)> {
    let theta = [prepared.stiffnesses_like(1.0).as_slice(), law].concat();
    let forces = problem.forces_with(&theta)?;
    let modulus = dot(&forces, problem.forces) / sum_of_squares(&forces);
    let residuals = problem.forces.iter().zip(&forces).map(|(measured, force)| (measured - modulus * force).powi(2));
    let square: f64 = residuals.sum();
    (modulus > 0.0 && square.is_finite()).then_some((square, modulus))
}

/// The grid, in the searched parameters of the law.
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

/// Evenly spaced parameters from low to high.
fn spread(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| low + (high - low) * i as f64 / (count - 1) as f64).collect()
}
