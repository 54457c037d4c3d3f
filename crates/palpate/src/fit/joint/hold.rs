//! One hold among several: how the shared parameters come to it, and what it says about them.

use crate::fit::{Model, Scaled};
use crate::laws::ShapeParameterKind;
use crate::optimise::{Cholesky, Effort, Shapes, Target};
use crate::vector::{dot, form_residuals, multiply, normal_equations};
use crate::watch::Cancelled;

/// A hold in its own units, with what ties it to the others.
pub(crate) struct Hold {
    pub(crate) model: Model,
    pub(crate) scaled: Scaled,
    /// Weight of the hold's residuals, in units of its own range, among those of all holds.
    pub(crate) weight: f64,
    /// ln of the hold's duration over the shared unit of time.
    pub(crate) log_duration: f64,
    /// ln of the hold's range over the shared unit of the signal.
    pub(crate) log_range: f64,
    /// Whether the rate follows from the amplitude, λ = v |Δ|ⁿ⁻¹, and n if it is held.
    pub(crate) coupling: Option<Option<f64>>,
}

/// Steps of [`Part::settle`] after which the outer search takes over.
const STEPS: usize = 30;

impl Hold {
    /// ln |Δ| in the shared unit.
    fn log_amplitude(&self, own: &[f64]) -> f64 {
        own[own.len() - 1].abs().ln() + self.log_range
    }

    /// The nonlinear parameters of the hold, in its units.
    pub(crate) fn theta(&self, shared: &[f64], own: &[f64]) -> Vec<f64> {
        let shift = |(parameter, value): (&crate::fit::problem::model::ModelParameter, &f64)| match parameter.kind {
            ShapeParameterKind::Pure { .. } => *value,
            _ => value + self.log_duration,
        };
        let mut theta: Vec<f64> = self.model.free().zip(shared).map(shift).collect();
        if let Some(held) = self.coupling {
            theta[0] += (held.unwrap_or_else(|| shared[1]) - 1.0) * self.log_amplitude(own);
        }
        theta
    }

    /// The shared parameters at which this hold has these.
    pub(crate) fn shared(&self, theta: &[f64], own: &[f64]) -> Vec<f64> {
        // θ is the shared parameters plus what the duration adds, and what the amplitude adds at the exponent found.
        let mut at = vec![0.0; theta.len()];
        if self.coupling == Some(None) {
            at[1] = theta[1];
        }
        let offset = self.theta(&at, own);
        let mut shared: Vec<f64> = theta.iter().zip(&offset).map(|(theta, offset)| theta - offset).collect();
        if self.coupling == Some(None) {
            shared[1] = theta[1];
        }
        shared
    }

    /// Derivatives of own, then nonlinear parameters by own, then shared ones, row by row.
    pub(crate) fn sensitivity(&self, shared: &[f64], own: &[f64]) -> Vec<Vec<f64>> {
        let size = own.len() + shared.len();
        let mut rows: Vec<Vec<f64>> =
            (0..size).map(|i| (0..size).map(|j| if i == j { 1.0 } else { 0.0 }).collect()).collect();
        if let Some(held) = self.coupling {
            let rate = &mut rows[own.len()];
            rate[own.len() - 1] = (held.unwrap_or_else(|| shared[1]) - 1.0) / own[own.len() - 1];
            if held.is_none() {
                rate[own.len() + 1] = self.log_amplitude(own);
            }
        }
        rows
    }
}

/// The samples of a hold that a search looks at: all, or the nodes that stand for them.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) hold: &'a Hold,
    pub(crate) times: &'a [f64],
    pub(crate) target: Target<'a>,
}

impl<'a> View<'a> {
    /// All samples of a hold.
    pub(crate) fn all(hold: &'a Hold) -> Self {
        Self {
            hold,
            times: &hold.scaled.times,
            target: hold.scaled.target(),
        }
    }
}

/// A hold at one point: its own parameters and the normal equations there.
#[derive(Clone)]
pub(crate) struct Part {
    pub(crate) own: Vec<f64>,
    pub(crate) residuals: Vec<f64>,
    /// Derivatives of the signal by own, then shared parameters.
    jacobian: Vec<Vec<f64>>,
    /// JᵀJ, row-major, own parameters first.
    pub(crate) normal: Vec<f64>,
    /// Jᵀr.
    pub(crate) gradient: Vec<f64>,
    /// Squared residuals, in units of the hold's range.
    pub(crate) square: f64,
}

impl Part {
    pub(crate) fn new(view: View<'_>, own: &[f64], shared: usize) -> Self {
        let (size, samples) = (own.len() + shared, view.times.len());
        Self {
            own: own.to_vec(),
            residuals: vec![0.0; samples],
            jacobian: vec![vec![0.0; samples]; size],
            normal: vec![0.0; size * size],
            gradient: vec![0.0; size],
            square: f64::INFINITY,
        }
    }

    /// Residuals and normal equations at these shared and own parameters.
    fn evaluate(
        &mut self,
        view: View<'_>,
        shared: &[f64],
        own: &[f64],
        effort: &mut Effort<'_>,
    ) -> Result<(), Cancelled> {
        let (hold, l) = (view.hold, own.len());
        self.own.copy_from_slice(own);
        let theta = hold.theta(shared, own);
        let shapes = hold.model.at(view.times);
        let (columns, derivatives) = self.jacobian.split_at_mut(l);
        shapes.fill(&theta, columns, derivatives);
        if let Some(roots) = view.target.roots {
            for column in columns.iter_mut().chain(derivatives.iter_mut()) {
                multiply(column, roots);
            }
        }
        self.square = form_residuals(view.target.values, columns, own, &mut self.residuals);
        for (p, derivative) in derivatives.iter_mut().enumerate() {
            let amplitude = own[shapes.column_of(p)];
            derivative.iter_mut().for_each(|entry| *entry *= amplitude);
        }
        if hold.coupling.is_some() {
            // What the rate does through the amplitude and through the exponent.
            let through = &hold.sensitivity(shared, own)[l];
            let (by_rate, others) = derivatives.split_at_mut(1);
            for (column, share) in
                columns[l - 1..].iter_mut().chain(others).zip([through[l - 1]].iter().chain(&through[l + 1..]))
            {
                column.iter_mut().zip(&by_rate[0]).for_each(|(entry, rate)| *entry += share * rate);
            }
        }
        normal_equations(&self.jacobian, &self.residuals, &mut self.normal, &mut self.gradient);
        if !self.square.is_finite() {
            self.square = f64::INFINITY;
        }
        effort.evaluated()
    }

    /// The factored normal equations of the own parameters.
    pub(crate) fn own_block(&self) -> Option<Cholesky> {
        let (l, size) = (self.own.len(), self.gradient.len());
        let block: Vec<f64> = (0..l * l).map(|i| self.normal[i / l * size + i % l]).collect();
        Cholesky::new(&block, l)
    }

    /// The best own parameters at given shared ones, from those at hand: one step where the law is linear in them.
    pub(crate) fn settle(
        &mut self,
        view: View<'_>,
        shared: &[f64],
        own: &[f64],
        effort: &mut Effort<'_>,
    ) -> Result<(), Cancelled> {
        self.evaluate(view, shared, own, effort)?;
        let floor = dot(view.target.values, view.target.values) * 1e-31;
        let mut trial = self.clone();
        for _ in 0..STEPS {
            let Some(factor) = self.own_block() else {
                self.square = f64::INFINITY;
                return Ok(());
            };
            let mut step = self.gradient[..self.own.len()].to_vec();
            factor.solve(&mut step);
            let promise = dot(&step, &self.gradient[..step.len()]);
            if promise.is_nan() || promise <= 1e-24 * self.square + floor {
                return Ok(());
            }
            let mut share = 1.0;
            loop {
                let next = moved(view.hold, &self.own, &step, share);
                trial.evaluate(view, shared, &next, effort)?;
                if trial.square < self.square {
                    std::mem::swap(self, &mut trial);
                    break;
                }
                // A step that promises next to nothing and brings nothing is rounding.
                if share < 0.05 || promise < 1e-12 * self.square {
                    return Ok(());
                }
                share *= 0.3;
            }
        }
        Ok(())
    }
}

/// Own parameters after a share of a step; an amplitude that sets the rate keeps its sign and its order of magnitude.
pub(crate) fn moved(hold: &Hold, own: &[f64], step: &[f64], share: f64) -> Vec<f64> {
    let mut next: Vec<f64> = own.iter().zip(step).map(|(value, change)| value + share * change).collect();
    if hold.coupling.is_some() {
        let last = own.len() - 1;
        let ends = [0.4 * own[last], 2.5 * own[last]];
        next[last] = next[last].clamp(ends[0].min(ends[1]), ends[0].max(ends[1]));
    }
    next
}
