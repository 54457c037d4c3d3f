//! From a candidate and its data to the numbers with the least squared residual.
//!
//! A coarse grid over the law's numbers on few samples, the stiffness being linear there; then damped steps (Levenberg 1944, Marquardt
//! 1963) from the best few, and from the best of these on all samples. Derivatives are differences of simulations, which are good to
//! 10⁻¹².

use super::candidate::Prepared;
use super::profile::Held;
use super::{CalibrateError, CalibrationData};
use crate::fit::{Cholesky, Termination};
use crate::simulate::{Motion, simulate_force};
use crate::watch::{Cancelled, Stages};

/// Residuals of a candidate on some samples.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    pub(super) prepared: &'a Prepared,
    pub(super) motion: &'a Motion,
    pub(super) times: &'a [f64],
    pub(super) forces: &'a [f64],
    /// A number that is held, which one of the searched follows.
    pub(super) held: Option<Held>,
}

/// A point of the search.
#[derive(Debug, Clone)]
pub(super) struct Found {
    pub(super) theta: Vec<f64>,
    pub(super) residuals: Vec<f64>,
    pub(super) square: f64,
    pub(super) termination: Termination,
    /// Simulations it took.
    pub(super) simulations: u64,
}

impl Problem<'_> {
    /// Forces with these numbers; `None` where they cannot be simulated.
    pub(super) fn forces_with(&self, theta: &[f64]) -> Option<Vec<f64>> {
        let contact = match self.held {
            Some(held) => self.prepared.contact(&held.completed(self.prepared, theta)?),
            None => self.prepared.contact(theta),
        };
        simulate_force(self.motion, &contact?, self.times).ok()
    }

    /// Measured less simulated.
    pub(super) fn residuals(&self, theta: &[f64]) -> Option<Vec<f64>> {
        let mut forces = self.forces_with(theta)?;
        forces
            .iter_mut()
            .zip(self.forces)
            .for_each(|(simulated, measured)| *simulated = measured - *simulated);
        Some(forces)
    }

    /// Derivatives of the simulated forces by every number, column by column, from differences on both sides.
    pub(super) fn jacobian(&self, theta: &[f64], stages: &mut Stages<'_>) -> Result<Option<Vec<Vec<f64>>>, Cancelled> {
        let mut columns = Vec::with_capacity(theta.len());
        for index in 0..theta.len() {
            stages.hear()?;
            match self.slope(theta, index) {
                Some(column) => columns.push(column),
                None => return Ok(None),
            }
        }
        Ok(Some(columns))
    }

    /// Derivatives of the simulated forces by one number.
    fn slope(&self, theta: &[f64], index: usize) -> Option<Vec<f64>> {
        /// Of the logarithm; the error of the difference is some 10⁻⁸ of the derivative.
        const STEP: f64 = 1e-4;
        if self.follows(index) {
            return Some(vec![0.0; self.times.len()]);
        }
        let bounds = &self.prepared.searched[index];
        let moved = |by: f64| {
            let mut beside = theta.to_vec();
            beside[index] = (theta[index] + by).clamp(bounds.low, bounds.high);
            Some((beside[index], self.forces_with(&beside)?))
        };
        let ((low, below), (high, above)) = (moved(-STEP)?, moved(STEP)?);
        let per_step = 1.0 / (high - low);
        Some(above.iter().zip(&below).map(|(a, b)| (a - b) * per_step).collect())
    }

    /// Whether a searched number follows one that is held.
    fn follows(&self, searched: usize) -> bool {
        self.held.is_some_and(|held| held.searched == searched)
    }

    /// Damped steps from `start` to the nearest optimum inside the bounds; `None` where even the start cannot be simulated.
    pub(super) fn descend(
        &self,
        start: &[f64],
        most: usize,
        stages: &mut Stages<'_>,
    ) -> Result<Option<Found>, Cancelled> {
        let searched = &self.prepared.searched;
        let mut theta: Vec<f64> = start.iter().zip(searched).map(|(value, s)| value.clamp(s.low, s.high)).collect();
        let Some(mut residuals) = self.residuals(&theta) else {
            return Ok(None);
        };
        let mut square = sum_of_squares(&residuals);
        let (mut damping, mut simulations) = (1e-3, 1);
        let mut termination = Termination::IterationLimit;
        'search: for step in 0..most {
            stages.reach(step as f64 / most as f64)?;
            let Some(jacobian) = self.jacobian(&theta, stages)? else {
                return Ok(None);
            };
            simulations += 2 * theta.len() as u64;
            let gradient: Vec<f64> = jacobian.iter().map(|column| dot(column, &residuals)).collect();
            let pinned = |i: usize| {
                self.follows(i)
                    || (theta[i] <= searched[i].low && gradient[i] < 0.0)
                    || (theta[i] >= searched[i].high && gradient[i] > 0.0)
            };
            let free: Vec<usize> = (0..theta.len()).filter(|i| !pinned(*i)).collect();
            let size = free.len();
            let mut normal = vec![0.0; size * size];
            for (a, i) in free.iter().enumerate() {
                for (b, j) in free.iter().enumerate().take(a + 1) {
                    normal[a * size + b] = dot(&jacobian[*i], &jacobian[*j]);
                    normal[b * size + a] = normal[a * size + b];
                }
            }
            loop {
                let mut damped = normal.clone();
                for a in 0..size {
                    let diagonal = &mut damped[a * (size + 1)];
                    // A floor for a number that the data do not feel at all.
                    *diagonal = diagonal.max(1e-14 * square) * (1.0 + damping);
                }
                let mut step: Vec<f64> = free.iter().map(|i| gradient[*i]).collect();
                match Cholesky::new(&damped, size) {
                    Some(factor) => factor.solve(&mut step),
                    None => {
                        damping = (damping * 10.0).max(1e-6);
                        if damping > 1e12 {
                            termination = Termination::Singular;
                            break 'search;
                        }
                        continue;
                    }
                }
                let mut next = theta.clone();
                for (i, by) in free.iter().zip(&step) {
                    // The model is trusted over a factor of e², no further.
                    next[*i] = (theta[*i] + by.clamp(-2.0, 2.0)).clamp(searched[*i].low, searched[*i].high);
                }
                let moved = next.iter().zip(&theta).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                if moved < 1e-12 || damping > 1e12 {
                    termination = Termination::Converged;
                    break 'search;
                }
                stages.hear()?;
                let trial = self.residuals(&next);
                simulations += 1;
                let trial_square = trial.as_deref().map_or(f64::INFINITY, sum_of_squares);
                if trial_square < square
                    && let Some(trial) = trial
                {
                    let gain = square - trial_square;
                    let taken: Vec<f64> = free.iter().map(|i| next[*i] - theta[*i]).collect();
                    let foretold: f64 = taken
                        .iter()
                        .zip(normal.chunks(size))
                        .zip(&free)
                        .map(|((by, row), i)| by * (2.0 * gradient[*i] - dot(row, &taken)))
                        .sum();
                    (theta, residuals) = (next, trial);
                    square = trial_square;
                    // Where much is left over the bottom is steeper than the model says: undamped steps would go from one side to the other.
                    damping = match gain / foretold {
                        share if share > 0.75 => (damping * 0.1).max(1e-12),
                        share if share > 0.25 => damping,
                        _ => (damping * 8.0).max(1e-6),
                    };
                    if gain <= GAIN * square && moved < 1e-4 {
                        termination = Termination::Converged;
                        break 'search;
                    }
                    break;
                }
                // At a flat bottom rounding decides.
                if moved < 1e-6 && damping < 1.0 && trial_square <= square * (1.0 + 1e-10) {
                    termination = Termination::Converged;
                    break 'search;
                }
                damping = (damping * 8.0).max(1e-6);
            }
        }
        Ok(Some(Found {
            theta,
            residuals,
            square,
            termination,
            simulations,
        }))
    }
}

/// Relative fall of the squared residual below which a step counts as none.
const GAIN: f64 = 1e-10;

pub(super) fn sum_of_squares(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

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
    let starts = super::starts::starts(prepared, &coarse, &mut simulations, stages)?;
    if starts.is_empty() {
        return Err(super::starts::refusal(prepared, &coarse));
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
    let at_bound = |(value, searched): (&f64, &super::candidate::Searched)| {
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
