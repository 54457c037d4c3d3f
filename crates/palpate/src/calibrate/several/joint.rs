//! The parameters with the least weighted squares of all residuals, by damped steps (Levenberg 1944, Marquardt 1963).

use super::sharing::Layout;
use super::{BatchRecord, SeveralError};
use crate::calibrate::Calibration;
use crate::calibrate::prepared::{Prepared, Searched};
use crate::calibrate::problem::{Problem, dot, sum_of_squares};
use crate::optimise::{Cholesky, distance};
use crate::watch::{Cancelled, Stages};

/// Steps of the search.
const MOST_STEPS: usize = 200;

/// Relative fall of the sum of squares below which a step counts as none.
const GAIN: f64 = 1e-10;

/// A record among the others.
pub(super) struct Member<'a> {
    pub(super) name: &'a str,
    pub(super) problem: Problem<'a>,
    /// Standard deviation σ of its residuals (N) when it is calibrated alone: residuals count by 1/σ².
    pub(super) deviation: f64,
}

impl<'a> Member<'a> {
    pub(super) fn new(record: &'a BatchRecord, prepared: &'a Prepared, alone: &Calibration) -> Self {
        let material = &alone.material;
        Self {
            name: &record.name,
            problem: Problem::of(prepared, &record.data),
            // A record without noise has the residuals of rounding.
            deviation: material.noise().max(1e-9 * material.range().largest_force).max(f64::MIN_POSITIVE),
        }
    }
}

/// All records with the parameters they share: Σ_r |residuals of r|²/σ_r² is least.
pub(super) struct Joint<'a> {
    pub(super) layout: Layout,
    pub(super) members: Vec<Member<'a>>,
    /// Parameters of a material; those that are not estimated keep these values.
    pub(super) given: Vec<f64>,
}

/// A record at a point of the search.
#[derive(Debug, Clone)]
pub(super) struct State {
    /// Its searched parameters.
    pub(super) theta: Vec<f64>,
    /// Measured less simulated force, N.
    pub(super) residuals: Vec<f64>,
}

/// Where the search ended.
pub(super) struct Optimum {
    /// Logarithms of the parameters, by [`Layout`].
    pub(super) logs: Vec<f64>,
    pub(super) states: Vec<State>,
    pub(super) linear: Linear,
}

/// All records near a point.
pub(super) struct Linear {
    /// Derivatives of the forces of each record by the logarithms of its parameters, in the order of [`Layout::parameters`].
    pub(super) jacobians: Vec<Vec<Vec<f64>>>,
    /// Σ_r J_rᵀJ_r/σ_r², row by row.
    pub(super) normal: Vec<f64>,
    /// Σ_r J_rᵀ(residuals of r)/σ_r².
    gradient: Vec<f64>,
}

impl Optimum {
    /// The rows and columns of N of the own parameters of a record, row by row.
    pub(super) fn own_block(&self, layout: &Layout, record: usize) -> Vec<f64> {
        let (places, size) = (layout.own_places(record), layout.size());
        places.clone().flat_map(|i| self.linear.normal[i * size..][places.clone()].to_vec()).collect()
    }
}

impl Joint<'_> {
    /// The parameters of the material of a record.
    pub(super) fn values(&self, logs: &[f64], record: usize) -> Vec<f64> {
        let mut values = self.given.clone();
        for (parameter, place) in self.layout.parameters().into_iter().zip(self.layout.places(record)) {
            values[parameter] = logs[place].exp();
        }
        values
    }

    /// Residuals of all records; `None` where one cannot be simulated, or parameters leave the range that is searched.
    fn states(&self, logs: &[f64]) -> Option<Vec<State>> {
        let state = |(record, member): (usize, &Member<'_>)| {
            let theta = member.problem.prepared.searched_of(&self.values(logs, record))?;
            let within = |(value, bounds): (&f64, &Searched)| *value >= bounds.low && *value <= bounds.high;
            let is_within = theta.iter().zip(&member.problem.prepared.searched).all(within);
            let residuals = member.problem.residuals(&theta).filter(|_| is_within)?;
            Some(State { theta, residuals })
        };
        self.members.iter().enumerate().map(state).collect()
    }

    fn square(&self, states: &[State]) -> f64 {
        let weighted = |(member, state): (&Member<'_>, &State)| {
            sum_of_squares(&state.residuals) / (member.deviation * member.deviation)
        };
        self.members.iter().zip(states).map(weighted).sum()
    }

    /// Derivatives of the forces of a record by the logarithms of its parameters.
    fn jacobian(&self, record: usize, state: &State, logs: &[f64]) -> Option<Vec<Vec<f64>>> {
        let problem = &self.members[record].problem;
        let searched = problem.jacobian(&state.theta, &state.residuals)?;
        let column = |parameter: usize| {
            let by = slopes(problem.prepared, &self.values(logs, record), parameter)?;
            let mut column = vec![0.0; state.residuals.len()];
            for (derivatives, by) in searched.iter().zip(by).filter(|(_, by)| *by != 0.0) {
                column.iter_mut().zip(derivatives).for_each(|(entry, derivative)| *entry += by * derivative);
            }
            Some(column)
        };
        self.layout.parameters().into_iter().map(column).collect()
    }

    /// All records near a point; `None` where a derivative cannot be simulated.
    fn linearised(&self, logs: &[f64], states: &[State], stages: &mut Stages<'_>) -> Result<Option<Linear>, Cancelled> {
        let size = self.layout.size();
        let (mut normal, mut gradient) = (vec![0.0; size * size], vec![0.0; size]);
        let mut jacobians = Vec::with_capacity(states.len());
        for (record, state) in states.iter().enumerate() {
            stages.hear()?;
            let Some(jacobian) = self.jacobian(record, state, logs) else {
                return Ok(None);
            };
            let weight = self.members[record].deviation.powi(-2);
            let places = self.layout.places(record);
            for (column, i) in jacobian.iter().zip(&places) {
                gradient[*i] += weight * dot(column, &state.residuals);
                for (other, j) in jacobian.iter().zip(&places) {
                    normal[i * size + j] += weight * dot(column, other);
                }
            }
            jacobians.push(jacobian);
        }
        Ok(Some(Linear {
            jacobians,
            normal,
            gradient,
        }))
    }

    /// Damped steps from `start` to the nearest optimum.
    ///
    /// # Errors
    /// [`SeveralError::NoOptimum`] where there is none to be reached, with no record named.
    pub(super) fn descend(&self, start: &[f64], stages: &mut Stages<'_>) -> Result<Optimum, SeveralError> {
        let size = start.len();
        let none = || SeveralError::NoOptimum { open: Vec::new() };
        let mut logs = start.to_vec();
        let mut states = self.states(&logs).ok_or_else(none)?;
        let mut square = self.square(&states);
        let mut damping = 1e-3;
        let mut is_optimal = false;
        for step in 0..MOST_STEPS {
            stages.reach(step as f64 / MOST_STEPS as f64)?;
            let linear = self.linearised(&logs, &states, stages)?.ok_or_else(none)?;
            if is_optimal {
                return Ok(Optimum { logs, states, linear });
            }
            loop {
                stages.hear()?;
                let mut damped = linear.normal.clone();
                for i in 0..size {
                    let diagonal = &mut damped[i * (size + 1)];
                    *diagonal = diagonal.max(1e-14 * square) * (1.0 + damping);
                }
                let moves = Cholesky::new(&damped, size).map(|factor| {
                    let mut moves = linear.gradient.clone();
                    factor.solve(&mut moves);
                    moves
                });
                let next: Option<Vec<f64>> =
                    moves.map(|moves| logs.iter().zip(moves).map(|(log, by)| log + by.clamp(-2.0, 2.0)).collect());
                let trial = next.as_ref().and_then(|next| self.states(next));
                let trial_square = trial.as_ref().map_or(f64::INFINITY, |states| self.square(states));
                let moved = next.as_ref().map_or(f64::INFINITY, |next| distance(next, &logs));
                if let (Some(next), Some(trial)) = (next, trial)
                    && trial_square < square
                {
                    is_optimal = square - trial_square <= GAIN * square && moved < 1e-4;
                    (logs, states, square) = (next, trial, trial_square);
                    damping = (0.1 * damping).max(1e-12);
                    break;
                }
                // At a flat bottom rounding decides.
                if moved < 1e-12 || (moved < 1e-6 && trial_square <= square * (1.0 + GAIN)) {
                    is_optimal = true;
                    break;
                }
                damping = (8.0 * damping).max(1e-6);
                if damping > 1e12 {
                    return Err(none());
                }
            }
        }
        Err(none())
    }
}

/// Derivatives of the searched parameters by the logarithm of one parameter of the material.
fn slopes(prepared: &Prepared, values: &[f64], parameter: usize) -> Option<Vec<f64>> {
    /// All but the layer thickness are straight.
    const STEP: f64 = 1e-5;
    let beside = |by: f64| {
        let mut values = values.to_vec();
        values[parameter] *= by.exp();
        prepared.searched_of(&values)
    };
    let (low, high) = (beside(-STEP)?, beside(STEP)?);
    Some(low.iter().zip(&high).map(|(low, high)| (high - low) / (2.0 * STEP)).collect())
}
