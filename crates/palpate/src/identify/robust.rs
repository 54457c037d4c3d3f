//! Outliers made to count less: M-estimates by reweighting.

use super::law_fit::Fitted;
use super::samples::Scaled;
use super::search::search;
use super::separable::{Ending, Work, polished, refine};
use super::{FitError, LawOptions, Loss};
use crate::statistics::median;

/// Huber's bound, in noise deviations: 95 % efficiency on normal noise.
const HUBER: f64 = 1.345;

/// Tukey's bound, in noise deviations: 95 % efficiency on normal noise.
const TUKEY: f64 = 4.685;

/// A median absolute deviation of normal noise is this much of its standard deviation.
const MEDIAN_SHARE: f64 = 0.674_489_750_196_081_7;

/// Rounds of reweighting after which it ends short.
const ROUNDS: usize = 200;

impl Fitted {
    /// Reweights residuals until weights, scale and numbers agree: first by Huber, then, if asked for, by Tukey.
    ///
    /// The scale is the median absolute residual over 0.6745, found anew in every round. After the first rounds the whole range of the
    /// nonlinear numbers is searched again, since outliers may have led the first search into the wrong valley.
    pub(super) fn resist(&mut self, options: &LawOptions, work: &mut Work) -> Result<(), FitError> {
        let base = self.scaled.clone();
        self.reweigh(&base, Loss::Huber, options, work)?;
        if options.loss == Loss::Tukey {
            self.reweigh(&base, Loss::Tukey, options, work)?;
        }
        Ok(())
    }

    fn reweigh(&mut self, base: &Scaled, loss: Loss, options: &LawOptions, work: &mut Work) -> Result<(), FitError> {
        let ones = vec![1.0; base.times.len()];
        let roots = base.roots.as_ref().unwrap_or(&ones);
        let mut before: Option<Vec<f64>> = None;
        for round in 0..ROUNDS {
            // Residuals in units of each sample's own deviation.
            let residuals = self.residuals_of(base);
            let mut sizes: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
            let scale = median(&mut sizes) / MEDIAN_SHARE;
            if scale <= f64::MIN_POSITIVE {
                break;
            }
            let factors: Vec<f64> = residuals.iter().map(|r| weight(loss, r / scale).sqrt()).collect();
            let mut scaled = base.clone();
            for (value, factor) in scaled.values.iter_mut().zip(&factors) {
                *value *= factor;
            }
            scaled.roots = Some(roots.iter().zip(&factors).map(|(root, factor)| root * factor).collect());
            self.scaled = scaled;
            if round == 2 {
                self.solution =
                    search(&self.model, &self.scaled, options.most_iterations, work).ok_or(FitError::NoDecay)?;
            } else {
                let shapes = self.model.at(&self.scaled.times);
                let target = self.scaled.target();
                let refined =
                    refine(&shapes, target, &self.solution.nonlinear, Ending::tight(options.most_iterations), work);
                self.solution = polished(&shapes, target, refined, work);
            }
            let now: Vec<f64> = self.solution.linear.iter().chain(&self.solution.nonlinear).copied().collect();
            let settled =
                |before: &Vec<f64>| before.iter().zip(&now).all(|(a, b)| (a - b).abs() <= 1e-12 * (1.0 + b.abs()));
            if round > 2 && before.as_ref().is_some_and(settled) {
                break;
            }
            before = Some(now);
        }
        Ok(())
    }

    /// Residuals of the present solution, in units of each sample's own deviation.
    fn residuals_of(&self, base: &Scaled) -> Vec<f64> {
        let curve = self.model_values();
        let root = |i: usize| base.roots.as_ref().map_or(1.0, |roots| roots[i]);
        base.values.iter().enumerate().map(|(i, value)| value - curve[i] * root(i)).collect()
    }

    /// The fitted curve in the units of the fit.
    fn model_values(&self) -> Vec<f64> {
        let times = &self.scaled.times;
        let constants = usize::from(self.model.constant);
        let start = if self.model.constant { self.solution.linear[0] } else { 0.0 };
        let mut values = vec![start; times.len()];
        let numbers = self.model.complete(&self.solution.nonlinear);
        let mut column = vec![0.0; times.len()];
        for shape in 0..self.model.form.shapes.len() {
            self.model.shape_value(shape, times, &numbers[self.model.numbers_of(shape)], &mut column);
            let amplitude = self.solution.linear[constants + shape];
            for (value, entry) in values.iter_mut().zip(&column) {
                *value += amplitude * entry;
            }
        }
        values
    }
}

/// ψ(u)/u: what a residual of u noise deviations counts.
fn weight(loss: Loss, u: f64) -> f64 {
    match loss {
        Loss::Squares => 1.0,
        Loss::Huber => (HUBER / u.abs()).min(1.0),
        Loss::Tukey => {
            let left = 1.0 - (u / TUKEY).powi(2);
            if left > 0.0 { left * left } else { 0.0 }
        }
    }
}
