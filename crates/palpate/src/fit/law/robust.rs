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

use crate::fit::{FitError, Fitted, LawOptions, Loss, Model, Scaled, search};
use crate::optimise::{Effort, Ending, Solution, Target, Termination, polished, refine, standing};
use crate::statistics::{dot, mean, quantile};
use crate::vector::{all_finite, multiply};

/// Huber's bound, in noise standard deviations: 95 % efficiency on normal noise.
const HUBER: f64 = 1.345;

/// Tukey's bound, in noise standard deviations: 95 % efficiency on normal noise.
const TUKEY: f64 = 4.685;

/// A median absolute deviation of normal noise is this much of its standard deviation, in the four digits of the literature.
const MEDIAN_SHARE: f64 = 0.6745;

/// Noise standard deviations beyond which the distance of a sample no longer matters.
const FAR: f64 = 10.0;

/// The least scale, over the range of the signal.
const FINEST: f64 = 1e-12;

/// Rounds of reweighting after which it ends short.
const ROUNDS: usize = 200;

impl Fitted {
    /// Reweights residuals until weights, scale and parameters agree: first by Huber, then, if requested, by Tukey.
    ///
    /// The scale is found anew in every round. After the first rounds the whole range of the nonlinear parameters is searched again,
    /// since outliers may have led the first search into the wrong valley. In the end the solution stands among all samples at
    /// their own weights; what they determine is judged by them as the loss counts them.
    ///
    /// The scale is at least the step of values that were rounded: where most of them lie on one level, the median residual says nothing of their noise,
    /// and a sample one step beside it is no outlier. With step/√12, the deviation of rounding, 95 % intervals of the constant hold it in 64 % of holds.
    ///
    /// Where some samples are far from most, the first search is among the `near` ones too. The others may be outliers or a fast transient: of both fits
    /// that from which fewer samples stray is taken.
    pub(crate) fn resisting(
        model: &Model,
        base: Scaled,
        near: Option<&Scaled>,
        options: &LawOptions,
        effort: &mut Effort<'_>,
    ) -> Result<Self, FitError> {
        let least = base.step.max(FINEST);
        let mut best: Option<(Self, f64)> = None;
        for start in near.into_iter().chain([&base]) {
            let Some(solution) = search(model, start, options.most_iterations, effort)? else {
                continue;
            };
            let mut fitted = Self {
                model: model.clone(),
                scaled: base.clone(),
                solution,
                counted: None,
            };
            let scale = match fitted.reweigh_all(&base, least, options, effort) {
                Err(FitError::NoDecay) => continue,
                found => found?,
            };
            let is_better = best.as_ref().is_none_or(|(other, of_other)| {
                let both = scale.min(*of_other);
                strays(&base, &fitted.curve_among(&base), both) < strays(&base, &other.curve_among(&base), both)
            });
            if is_better {
                best = Some((fitted, scale));
            }
        }
        let (mut fitted, scale) = best.ok_or(FitError::NoDecay)?;
        fitted.stand(base, scale, options.loss);
        Ok(fitted)
    }

    /// The solution among all samples at their own weights, with this scale.
    fn stand(&mut self, base: Scaled, scale: f64, loss: Loss) {
        let curve = self.curve_among(&base);
        let residuals: Vec<f64> = base.values.iter().zip(&curve).map(|(value, curve)| value - curve).collect();
        let counted: Vec<f64> = residuals.iter().map(|r| r * weight(loss, r / scale)).collect();
        let values: Vec<f64> = curve.iter().zip(&counted).map(|(curve, r)| curve + r).collect();
        let target = Target::new(&values, base.roots.as_deref());
        let found = &self.solution;
        let shapes = self.model.at(&base.times);
        let mut solution = standing(&shapes, target, &found.nonlinear, &found.linear, found.termination);
        solution.residual_square = dot(&residuals, &residuals);
        solution.residuals = residuals;
        solution.variance = variance(loss, scale, &solution);
        self.counted = Some(counted);
        self.solution = solution;
        self.scaled = base;
    }

    /// By Huber, then, if requested, by Tukey; returns the scale.
    fn reweigh_all(
        &mut self,
        base: &Scaled,
        least: f64,
        options: &LawOptions,
        effort: &mut Effort<'_>,
    ) -> Result<f64, FitError> {
        let scale = self.reweigh(base, least, Loss::Huber, options, effort)?;
        match options.loss {
            Loss::Tukey => self.reweigh(base, least, Loss::Tukey, options, effort),
            Loss::Squares | Loss::Huber => Ok(scale),
        }
    }

    /// Reweights until nothing moves; returns the scale.
    fn reweigh(
        &mut self,
        base: &Scaled,
        least: f64,
        loss: Loss,
        options: &LawOptions,
        effort: &mut Effort<'_>,
    ) -> Result<f64, FitError> {
        let mut before: Option<Vec<f64>> = None;
        for round in 0..ROUNDS {
            let curve = self.curve_among(base);
            let scale = scale_of(base, &curve).max(least);
            self.scaled = reweighted(base, &curve, loss, scale);
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
        Ok(scale_of(base, &self.curve_among(base)).max(least))
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
        solution.variance * freedom as f64 / solution.residual_square.max(f64::MIN_POSITIVE)
    }

    /// The curve of the present solution, in units of each sample's own deviation.
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

/// The scale of residuals about a curve.
fn scale_of(base: &Scaled, curve: &[f64]) -> f64 {
    let residuals = base.values.iter().zip(curve).map(|(value, curve)| (value - curve).abs());
    middle(residuals.collect()) / MEDIAN_SHARE
}

/// How many samples stray from a curve, those by a few scales in part: Tukey's ρ.
fn strays(base: &Scaled, curve: &[f64], scale: f64) -> f64 {
    let part = |(value, curve): (&f64, &f64)| {
        let left = 1.0 - ((value - curve) / (TUKEY * scale)).powi(2);
        1.0 - left.max(0.0).powi(3)
    };
    base.values.iter().zip(curve).map(part).sum()
}

/// The samples with the weights that the loss gives their residuals about a curve. Those beyond [`FAR`] are brought there, where they pull as
/// much: their squares would hide those of all others.
fn reweighted(base: &Scaled, curve: &[f64], loss: Loss, scale: f64) -> Scaled {
    let mut scaled = base.clone();
    let mut roots = base.roots.clone().unwrap_or_else(|| vec![1.0; base.times.len()]);
    for ((value, root), curve) in scaled.values.iter_mut().zip(&mut roots).zip(curve) {
        let u = (*value - curve) / scale;
        if u.abs() > FAR {
            *value = curve + FAR.copysign(u) * scale;
        }
        let factor = weight(loss, u.clamp(-FAR, FAR)).sqrt();
        *value *= factor;
        *root *= factor;
    }
    scaled.roots = Some(roots);
    scaled
}

/// Values with those far from most of them brought nearer; `None` if there are none. One sentinel would be the range of the signal.
pub(super) fn without_far(values: &[f64]) -> Option<Vec<f64>> {
    /// Distances between quantiles from the outer of them beyond which a value is far.
    const DISTANCE: f64 = 30.0;
    /// Quantiles, the further ones for signals that have relaxed early.
    const SHARES: [f64; 3] = [0.25, 0.1, 0.05];
    if !all_finite(values) {
        return None;
    }
    let mut sorted = values.to_vec();
    let ends = SHARES.map(|share| [share, 1.0 - share].map(|share| quantile(&mut sorted, share)));
    let [low, high] = ends.into_iter().find(|[low, high]| low < high)?;
    let (low, high) = (low - DISTANCE * (high - low), high + DISTANCE * (high - low));
    let is_far = |value: &f64| *value < low || *value > high;
    values.iter().any(is_far).then(|| values.iter().map(|value| value.clamp(low, high)).collect())
}

/// The samples of a fit of so many parameters without those that were brought nearer; `None` if there are none, or too few others.
pub(super) fn near(nearer: &Scaled, measured: &Scaled, parameters: usize) -> Option<Scaled> {
    /// Samples for each parameter, of fewer a fit is nearly exact whichever are left out.
    const ENOUGH: usize = 3;
    let is_near: Vec<bool> = nearer.values.iter().zip(&measured.values).map(|(a, b)| a == b).collect();
    let count = is_near.iter().filter(|near| **near).count();
    if count == is_near.len() || count < ENOUGH * parameters {
        return None;
    }
    let mut near = nearer.clone();
    let mut roots = near.roots.take().unwrap_or_else(|| vec![1.0; is_near.len()]);
    for ((value, root), _) in near.values.iter_mut().zip(&mut roots).zip(is_near).filter(|(_, near)| !near) {
        (*value, *root) = (0.0, 0.0);
    }
    near.roots = Some(roots);
    Some(near)
}

/// The median, the mean of the middle two of an even number.
fn middle(mut sizes: Vec<f64>) -> f64 {
    sizes.sort_by(f64::total_cmp);
    let count = sizes.len();
    0.5 * (sizes[(count - 1) / 2] + sizes[count / 2])
}

/// What stands for s² in the covariance s² (JᵀJ)⁻¹ of an M-estimate.
fn variance(loss: Loss, scale: f64, solution: &Solution) -> f64 {
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
