//! Residuals of a candidate, and damped steps to where they are least.

use super::prepared::Prepared;
use super::{CalibrationData, RateLaw};
use crate::optimise::{Cholesky, Termination, distance};
use crate::parallel::for_each;
use crate::simulate::{Motion, simulate_force};
use crate::watch::{Cancelled, Stages};

/// Residuals of a candidate on some samples.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    pub(super) prepared: &'a Prepared,
    pub(super) motion: &'a Motion,
    pub(super) times: &'a [f64],
    pub(super) forces: &'a [f64],
    /// A parameter that is held, which one of the searched follows.
    pub(super) held: Option<Held>,
    /// How closely optima are sought.
    pub(super) precision: Precision,
}

/// How closely optima are sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Precision {
    /// As closely as tells valleys apart: differences on one side.
    Coarse,
    /// To rounding.
    Full,
}

/// Damped steps on their way to an optimum.
#[derive(Debug, Clone)]
pub(super) struct Descent {
    pub(super) found: Found,
    damping: f64,
    /// Relative fall of the squared residual in the last step.
    pub(super) gain: f64,
    /// Whether no further step is worth its while.
    pub(super) is_over: bool,
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

impl<'a> Problem<'a> {
    /// The fitted part of a record.
    pub(super) fn of(prepared: &'a Prepared, data: &'a CalibrationData) -> Self {
        Self {
            prepared,
            motion: data.motion(),
            times: &data.times()[..data.fitted()],
            forces: &data.forces()[..data.fitted()],
            held: None,
            precision: Precision::Full,
        }
    }

    /// Forces with these parameters; `None` where they cannot be simulated.
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

    /// Derivatives of the simulated forces by every parameter, column by column, at parameters that leave these residuals; `None` where one
    /// cannot be simulated.
    pub(super) fn jacobian(&self, theta: &[f64], residuals: &[f64]) -> Option<Vec<Vec<f64>>> {
        let simulated: Vec<f64> = self.forces.iter().zip(residuals).map(|(force, residual)| force - residual).collect();
        let columns = for_each(theta.len(), |index| self.slope(theta, &simulated, index));
        columns.into_iter().collect()
    }

    /// Simulations of a Jacobian.
    fn simulations(&self, size: usize) -> u64 {
        let sides = if self.precision == Precision::Full { 2 } else { 1 };
        sides * (size as u64 - u64::from(self.held.is_none()))
    }

    /// Step of the differences, of a logarithm: a part of what moves the forces, and far more than their error. Closed forms are good to 10⁻¹²; a rate
    /// that depends on the strain is integrated, and its errors over a short step would pass for information.
    fn difference(&self) -> f64 {
        match self.prepared.candidate.rate {
            RateLaw::ByStrain => 3e-3,
            RateLaw::Constant | RateLaw::ByDirection => 1e-5,
        }
    }

    /// Derivatives of the simulated forces by one parameter.
    fn slope(&self, theta: &[f64], simulated: &[f64], index: usize) -> Option<Vec<f64>> {
        // The first is the logarithm of a stiffness that multiplies all forces.
        if index == 0 && self.held.is_none() {
            return Some(simulated.to_vec());
        }
        if self.follows(index) {
            return Some(vec![0.0; self.times.len()]);
        }
        let bounds = &self.prepared.searched[index];
        let by = self.difference();
        let moved = |by: f64| {
            let mut beside = theta.to_vec();
            beside[index] = (theta[index] + by).clamp(bounds.low, bounds.high);
            Some((beside[index], self.forces_with(&beside)?))
        };
        if self.precision == Precision::Coarse {
            let step = if theta[index] + by > bounds.high { -by } else { by };
            let (there, forces) = moved(step)?;
            let per_step = 1.0 / (there - theta[index]);
            return Some(forces.iter().zip(simulated).map(|(there, here)| (there - here) * per_step).collect());
        }
        let ((low, below), (high, above)) = (moved(-by)?, moved(by)?);
        let per_step = 1.0 / (high - low);
        Some(above.iter().zip(&below).map(|(a, b)| (a - b) * per_step).collect())
    }

    /// Whether a searched parameter follows one that is held.
    fn follows(&self, searched: usize) -> bool {
        self.held.is_some_and(|held| held.searched == searched)
    }

    /// Damped steps from `start` to the nearest optimum inside the bounds; `None` where the forces on the way cannot be simulated.
    pub(super) fn descend(
        &self,
        start: &[f64],
        most: usize,
        stages: &mut Stages<'_>,
    ) -> Result<Option<Found>, Cancelled> {
        let mut descent = self.descent(start);
        for step in 0..most {
            stages.reach(step as f64 / most as f64)?;
            descent = match descent {
                Some(descent) if !descent.is_over => self.step(descent),
                ended => return Ok(ended.map(|ended| ended.found)),
            };
        }
        Ok(descent.map(|descent| descent.found))
    }

    /// The beginning of damped steps from `start`, inside the bounds; `None` where it cannot be simulated.
    pub(super) fn descent(&self, start: &[f64]) -> Option<Descent> {
        let searched = &self.prepared.searched;
        let theta: Vec<f64> = start.iter().zip(searched).map(|(value, s)| value.clamp(s.low, s.high)).collect();
        let residuals = self.residuals(&theta)?;
        Some(Descent {
            found: Found {
                square: sum_of_squares(&residuals),
                theta,
                residuals,
                termination: Termination::IterationLimit,
                simulations: 1,
            },
            damping: 1e-3,
            gain: f64::INFINITY,
            is_over: false,
        })
    }

    /// One step down, or the end; `None` where a derivative cannot be simulated.
    pub(super) fn step(&self, mut descent: Descent) -> Option<Descent> {
        let searched = &self.prepared.searched;
        let (enough, near) = match self.precision {
            Precision::Coarse => (1e-8, 1e-4),
            Precision::Full => (GAIN, 1e-4),
        };
        let Descent {
            found,
            damping,
            gain: last,
            is_over,
        } = &mut descent;
        let Found {
            theta,
            residuals,
            square,
            termination,
            simulations,
        } = found;
        let mut end = |reason: Termination| {
            *termination = reason;
            *is_over = true;
        };
        let jacobian = self.jacobian(theta, residuals)?;
        *simulations += self.simulations(theta.len());
        let gradient: Vec<f64> = jacobian.iter().map(|column| dot(column, residuals)).collect();
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
                // A floor for a parameter that the data do not feel at all.
                *diagonal = diagonal.max(1e-14 * *square) * (1.0 + *damping);
            }
            let mut step: Vec<f64> = free.iter().map(|i| gradient[*i]).collect();
            match Cholesky::new(&damped, size) {
                Some(factor) => factor.solve(&mut step),
                None => {
                    *damping = (*damping * 10.0).max(1e-6);
                    if *damping > 1e12 {
                        end(Termination::Singular);
                        return Some(descent);
                    }
                    continue;
                }
            }
            let mut next = theta.clone();
            for (i, by) in free.iter().zip(&step) {
                // The model is trusted over a factor of e², no further.
                next[*i] = (theta[*i] + by.clamp(-2.0, 2.0)).clamp(searched[*i].low, searched[*i].high);
            }
            let moved = distance(&next, theta);
            if moved < 1e-12 || *damping > 1e12 {
                end(Termination::Converged);
                return Some(descent);
            }
            let trial = self.residuals(&next);
            *simulations += 1;
            let trial_square = trial.as_deref().map_or(f64::INFINITY, sum_of_squares);
            if trial_square < *square
                && let Some(trial) = trial
            {
                let gain = *square - trial_square;
                *last = gain / *square;
                let taken: Vec<f64> = free.iter().map(|i| next[*i] - theta[*i]).collect();
                let predicted: f64 = taken
                    .iter()
                    .zip(normal.chunks(size))
                    .zip(&free)
                    .map(|((by, row), i)| by * (2.0 * gradient[*i] - dot(row, &taken)))
                    .sum();
                (*theta, *residuals) = (next, trial);
                *square = trial_square;
                // Where the residual is large the bottom is steeper than the model says: undamped steps would go from one side to the other.
                *damping = match gain / predicted {
                    share if share > 0.75 => (*damping * 0.1).max(1e-12),
                    share if share > 0.25 => *damping,
                    _ => (*damping * 8.0).max(1e-6),
                };
                if gain <= enough * *square && moved < near {
                    end(Termination::Converged);
                }
                return Some(descent);
            }
            // At a flat bottom rounding decides.
            if moved < 1e-6 && *damping < 1.0 && trial_square <= *square * (1.0 + 1e-10) {
                end(Termination::Converged);
                return Some(descent);
            }
            *damping = (*damping * 8.0).max(1e-6);
        }
    }
}

/// What least squares answer to a change of the residuals: parameters move by (JᵀJ)⁻¹ Jᵀ δr, with J by columns.
pub(super) struct Response<'a> {
    columns: &'a [Vec<f64>],
    factor: Cholesky,
}

impl<'a> Response<'a> {
    /// `None` where JᵀJ is singular.
    pub(super) fn new(columns: &'a [Vec<f64>]) -> Option<Self> {
        let size = columns.len();
        let normal: Vec<f64> = (0..size * size).map(|at| dot(&columns[at / size], &columns[at % size])).collect();
        Some(Self {
            columns,
            factor: Cholesky::new(&normal, size)?,
        })
    }

    /// The move of the parameters.
    pub(super) fn to(&self, change: &[f64]) -> Vec<f64> {
        let mut moved: Vec<f64> = self.columns.iter().map(|column| dot(column, change)).collect();
        self.factor.solve(&mut moved);
        moved
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

/// A parameter that is held while the others are sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Held {
    /// Place of the searched parameter that follows.
    pub(super) searched: usize,
    /// Place among the parameters of the material.
    pub(super) parameter: usize,
    /// Natural logarithm of the value it is held at.
    pub(super) log: f64,
}

impl Held {
    /// The searched parameters with the one that follows put in; `None` where none does.
    pub(super) fn completed(&self, prepared: &Prepared, theta: &[f64]) -> Option<Vec<f64>> {
        const STEP: f64 = 1e-6;
        let mut theta = theta.to_vec();
        let off = |theta: &[f64]| prepared.values(theta)[self.parameter].ln() - self.log;
        for _ in 0..50 {
            let now = off(&theta);
            if now.abs() < 1e-12 {
                return Some(theta);
            }
            let at = theta[self.searched];
            theta[self.searched] = at + STEP;
            let slope = (off(&theta) - now) / STEP;
            // Straight for all but the layer thickness, of which the logarithm bends once.
            theta[self.searched] = at - (now / slope).clamp(-3.0, 3.0);
            if !theta[self.searched].is_finite() {
                return None;
            }
        }
        (off(&theta).abs() < 1e-9).then_some(theta)
    }
}
