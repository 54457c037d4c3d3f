//! Outliers made to count less: M-estimates by reweighting.
//!
//! With u = r/(σ · scale) the parameters solve Σ ψ(u) ∂f/∂p = 0 together with scale = median |r/σ|/0.6745. Their covariance is the
//! asymptotic one of M-estimates (Huber, Robust Statistics, 1981, section 7.6), with the outliers' own weights left out of JᵀJ:
//!
//! ```text
//! K² · scale² · Σ ψ(u)²/(N − p) / (mean ψ′(u))² · (JᵀJ)⁻¹,    K = 1 + (p/N) var ψ′ / (mean ψ′)²
//! ```
//!
//! Where residuals correlate, it is the products E ψ(uᵢ) ψ(uⱼ) that take the place of the squares: the noise is sought in scale · ψ(u). Residuals
//! themselves would have the correlation of their outliers, which is none.
//!
//! With scale · ψ(u) in place of the residuals the samples have the same estimate by least squares, and their residual square rises about it as the loss
//! does over mean ψ′: profiles and draws of such samples are those of the M-estimate, if s² is that of the loss.

use crate::fit::{FitError, Fitted, LawOptions, Loss, Scaled, search};
use crate::optimise::{Effort, Ending, Solution, Termination, polished, refine, standing};
use crate::statistics::{dot, mean};
use crate::vector::multiply;

/// Huber's bound, in noise standard deviations: 95 % efficiency on normal noise.
const HUBER: f64 = 1.345;

/// Tukey's bound, in noise standard deviations: 95 % efficiency on normal noise.
const TUKEY: f64 = 4.685;

/// A median absolute deviation of normal noise is this much of its standard deviation, in the four digits of the literature.
const MEDIAN_SHARE: f64 = 0.6745;

/// Rounds of reweighting after which it ends short.
const ROUNDS: usize = 200;

impl Fitted {
    /// Reweights residuals until weights, scale and parameters agree: first by Huber, then, if requested, by Tukey.
    ///
    /// The scale is found anew in every round. After the first rounds the whole range of the nonlinear parameters is searched again,
    /// since outliers may have led the first search into the wrong valley. In the end the solution stands among all samples at
    /// their own weights.
    pub(crate) fn resist(&mut self, options: &LawOptions, effort: &mut Effort<'_>) -> Result<(), FitError> {
        let base = self.scaled.clone();
        let mut scale = self.reweigh(&base, Loss::Huber, options, effort)?;
        if options.loss == Loss::Tukey {
            scale = self.reweigh(&base, Loss::Tukey, options, effort)?;
        }
        self.scaled = base;
        let found = &self.solution;
        let shapes = self.model.at(&self.scaled.times);
        let mut solution = standing(&shapes, self.scaled.target(), &found.nonlinear, &found.linear, found.termination);
        solution.variance = variance(options.loss, scale, &solution);
        let counts = |r: &f64| r * weight(options.loss, r / scale);
        self.counted = (scale > 0.0).then(|| solution.residuals.iter().map(counts).collect());
        self.solution = solution;
        Ok(())
    }

    /// Reweights until nothing moves; returns the scale.
    fn reweigh(
        &mut self,
        base: &Scaled,
        loss: Loss,
        options: &LawOptions,
        effort: &mut Effort<'_>,
    ) -> Result<f64, FitError> {
        let mut before: Option<Vec<f64>> = None;
        for round in 0..ROUNDS {
            let residuals = self.residuals_of(base);
            let scale = middle(&residuals) / MEDIAN_SHARE;
            if scale <= f64::MIN_POSITIVE {
                return Ok(0.0);
            }
            self.scaled = reweighted(base, residuals.iter().map(|r| weight(loss, r / scale).sqrt()));
            if round == 2 {
                self.solution =
                    search(&self.model, &self.scaled, options.most_iterations, effort)?.ok_or(FitError::NoDecay)?;
            } else {
                let shapes = self.model.at(&self.scaled.times);
                let target = self.scaled.target();
                let refined =
                    refine(&shapes, target, &self.solution.nonlinear, Ending::tight(options.most_iterations), effort)?;
                self.solution = polished(&shapes, target, refined, effort)?;
            }
            let now: Vec<f64> = self.solution.linear.iter().chain(&self.solution.nonlinear).copied().collect();
            let settled =
                |before: &Vec<f64>| before.iter().zip(&now).all(|(a, b)| (a - b).abs() <= 1e-12 * (1.0 + b.abs()));
            if round > 2 && before.as_ref().is_some_and(settled) {
                return Ok(scale);
            }
            before = Some(now);
        }
        if self.solution.termination == Termination::Converged {
            self.solution.termination = Termination::IterationLimit;
        }
        Ok(middle(&self.residuals_of(base)) / MEDIAN_SHARE)
    }

    /// Samples and residuals from now on as the loss counts them. Returns s² of the loss over that of least squares to these: 1 where all count.
    pub(crate) fn take_as_counted(&mut self) -> f64 {
        let Some(counted) = self.counted.take() else {
            return 1.0;
        };
        self.scaled.values = self.curve_among(&self.scaled).iter().zip(&counted).map(|(y, r)| y + r).collect();
        let solution = &mut self.solution;
        let freedom = counted.len() - solution.linear.len() - solution.nonlinear.len();
        solution.residual_square = dot(&counted, &counted);
        solution.residuals = counted;
        solution.variance * freedom as f64 / solution.residual_square
    }

    /// Residuals of the present solution, in units of each sample's own deviation.
    fn residuals_of(&self, base: &Scaled) -> Vec<f64> {
        base.values.iter().zip(self.curve_among(base)).map(|(value, curve)| value - curve).collect()
    }

    /// The fitted curve in the same units.
    fn curve_among(&self, base: &Scaled) -> Vec<f64> {
        let mut curve = self.model_values();
        if let Some(roots) = &base.roots {
            multiply(&mut curve, roots);
        }
        curve
    }

    /// The fitted curve in the units of the fit.
    fn model_values(&self) -> Vec<f64> {
        let times = &self.scaled.times;
        let constants = usize::from(self.model.constant);
        let start = if self.model.constant { self.solution.linear[0] } else { 0.0 };
        let mut values = vec![start; times.len()];
        let parameters = self.model.complete(&self.solution.nonlinear);
        let mut column = vec![0.0; times.len()];
        for shape in 0..self.model.form.shapes.len() {
            self.model.shape_value(shape, times, &parameters[self.model.parameters_of(shape)], &mut column);
            let amplitude = self.solution.linear[constants + shape];
            for (value, entry) in values.iter_mut().zip(&column) {
                *value += amplitude * entry;
            }
        }
        values
    }
}

/// The samples with the square roots of their weights times `factors`.
fn reweighted(base: &Scaled, factors: impl Iterator<Item = f64>) -> Scaled {
    let mut scaled = base.clone();
    let mut roots = base.roots.clone().unwrap_or_else(|| vec![1.0; base.times.len()]);
    for ((value, root), factor) in scaled.values.iter_mut().zip(&mut roots).zip(factors) {
        *value *= factor;
        *root *= factor;
    }
    scaled.roots = Some(roots);
    scaled
}

/// Median size, the mean of the middle two of an even number.
fn middle(residuals: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let count = sizes.len();
    0.5 * (sizes[(count - 1) / 2] + sizes[count / 2])
}

/// What stands for s² in the covariance s² (JᵀJ)⁻¹ of an M-estimate.
fn variance(loss: Loss, scale: f64, solution: &Solution) -> f64 {
    if scale == 0.0 {
        return 0.0;
    }
    let (count, free) = (solution.residuals.len() as f64, (solution.linear.len() + solution.nonlinear.len()) as f64);
    let units: Vec<f64> = solution.residuals.iter().map(|r| r / scale).collect();
    let influence: f64 = units.iter().map(|u| (u * weight(loss, *u)).powi(2)).sum();
    let slopes: Vec<f64> = units.iter().map(|u| slope(loss, *u)).collect();
    let steepness = mean(&slopes);
    let spread = slopes.iter().map(|slope| (slope - steepness).powi(2)).sum::<f64>() / count;
    let correction = 1.0 + free / count * spread / (steepness * steepness);
    (correction * scale / steepness).powi(2) * influence / (count - free)
}

/// ψ(u)/u: what a residual of u noise standard deviations counts.
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

/// ψ′(u).
fn slope(loss: Loss, u: f64) -> f64 {
    match loss {
        Loss::Squares => 1.0,
        Loss::Huber => f64::from(u8::from(u.abs() <= HUBER)),
        Loss::Tukey => {
            let share = (u / TUKEY).powi(2);
            if share < 1.0 { (1.0 - share) * (1.0 - 5.0 * share) } else { 0.0 }
        }
    }
}
