//! From a solution to the result: parameters with errors and intervals.

use super::quantity::Quantity;
use crate::fit::{
    Assessed, Domain, Fit, Fitted, IntervalMethod, LawOptions, Loss, NoiseCourse, NoiseFollows, Scaled, Trust,
    redundant_terms,
};
use crate::laws::Law;
use crate::optimise::{Effort, Shapes, Termination, Work};
use crate::watch::Cancelled;

impl Fitted {
    pub(crate) fn report(&self, law: Law, options: &LawOptions, effort: &Effort<'_>) -> Result<Fit, Cancelled> {
        let solution = &self.solution;
        let known = solution.termination == Termination::Converged;
        let (linear, scale) = (self.model.linear(), self.scaled.range);
        let searched = linear + solution.nonlinear.len();
        let units: Vec<f64> = (0..searched).map(|i| if i < linear { scale } else { 1.0 }).collect();
        let trust = Trust {
            confidence: options.confidence,
            noise: options.noise,
            known,
            may_vary: true,
            counted: self.counted.as_deref(),
            roots: self.scaled.roots.as_deref(),
            curve: None,
            times: Some((&self.scaled.times, self.scaled.duration)),
            step: self.scaled.step,
        };
        let assessed = Assessed::new(solution, &self.amplitudes(), &units, scale, &trust, effort)?;
        let loading = if matches!(law, Law::Latency { .. }) { None } else { options.loading.clone() };
        let mut fit = Fit {
            loading,
            ..self.report_with(law, assessed, effort.work)
        };
        if !fit.termination.is_good() && options.loss == Loss::Squares {
            fit.residual_square = self.left_by(&fit);
        }
        Ok(fit)
    }

    /// χ² of a curve as it is returned: where large amplitudes cancel, rounding of its own parameters adds to it.
    fn left_by(&self, fit: &Fit) -> f64 {
        let scaled = &self.scaled;
        let elapsed: Vec<f64> = scaled.times.iter().map(|t| t * scaled.duration).collect();
        let curve = fit.predict_many(&elapsed);
        let root = |i: usize| scaled.roots.as_ref().map_or(1.0, |roots| roots[i]);
        let left = |i: usize| scaled.values[i] - root(i) * (curve[i] - scaled.center) / scaled.range;
        let square: f64 = (0..curve.len()).map(|i| left(i).powi(2)).sum();
        (square.sqrt() * scaled.range * scaled.precision).powi(2)
    }

    /// The result with these errors.
    pub(crate) fn report_with(&self, law: Law, assessed: Assessed, work: Work) -> Fit {
        let (solution, values, scale) = (&self.solution, self.values(), self.scaled.range);
        let parameters = Quantity::reported(self.quantities(law, solution.at()), &assessed);
        let residual_square = (solution.residual_square.sqrt() * scale * self.scaled.precision).powi(2);
        let samples = self.scaled.times.len();
        let mean_square = match &self.scaled.roots {
            None => solution.residual_square,
            Some(roots) => solution.residuals.iter().zip(roots).map(|(r, root)| (r / root).powi(2)).sum(),
        } / samples as f64;
        Fit {
            law,
            response: self.model.form.response,
            curve: self.curve(),
            loading: None,
            domain: Domain::Time,
            parameters,
            searched: self.names(),
            values,
            white_covariance: assessed.white,
            residual_square,
            rmse: mean_square.sqrt() * scale,
            residual_correlation: assessed.correlation,
            uneven_noise: assessed.uneven,
            noise_course: assessed.course.map(|course| self.in_callers_units(course)),
            noise: assessed.noise,
            noise_p_value: assessed.noise_p_value,
            interval_method: IntervalMethod::Curvature,
            uncertainty: assessed.uncertainty,
            samples,
            start: self.scaled.start,
            duration: self.scaled.duration,
            termination: solution.termination,
            redundant_terms: redundant_terms(&self.model, solution),
            profile: None,
            work,
        }
    }

    fn in_callers_units(&self, course: NoiseCourse) -> NoiseCourse {
        let (low, high) = course.range;
        let Scaled {
            times,
            duration,
            center,
            range,
            ..
        } = &self.scaled;
        NoiseCourse {
            range: match course.follows {
                NoiseFollows::Signal => (low * range + center, high * range + center),
                // Its samples are evenly spaced.
                NoiseFollows::Time => (times[0] * duration, times[times.len() - 1] * duration),
            },
            ..course
        }
    }

    /// s² (JᵀJ)⁻¹ in the caller's units for noise of this variance in the units of the fit; `None` where it is not known.
    pub(crate) fn white_covariance(&self, variance: f64) -> Option<Vec<Vec<f64>>> {
        let known = self.solution.termination == Termination::Converged;
        let inverse = self.solution.inverse_normal.as_deref().filter(|_| known)?;
        let size = self.solution.linear.len() + self.solution.nonlinear.len();
        let unit = |i: usize| if i < self.model.linear() { self.scaled.range } else { 1.0 };
        let entry = |i: usize, j: usize| inverse[i * size + j] * variance * unit(i) * unit(j);
        let rows: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect();
        rows.iter().flatten().all(|entry| entry.is_finite()).then_some(rows)
    }

    /// The amplitude beside each free nonlinear parameter.
    fn amplitudes(&self) -> Vec<f64> {
        let shapes = self.model.at(&self.scaled.times);
        (0..self.solution.nonlinear.len()).map(|i| self.solution.linear[shapes.column_of(i)]).collect()
    }
}
