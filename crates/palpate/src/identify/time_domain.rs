//! The closed form of the law fitted to a signal over time: y(t) = y_e + Δ φ(t; λ, n).

use super::coarse::Condensed;
use super::estimates::{Domain, Estimate, ExponentChoice, LatencyFit, Scale, Uncertainty, variance_of};
use super::separable::{Refined, Shapes, Solution, Termination, Work, polished, refine};
use super::{FitError, FitOptions};
use crate::latency::{decay_with_gradient_many, decay_with_log_rate_many};

/// Exponents of the coarse search when n is free, as far as they lie in the asked range.
const EXPONENT_GRID: [f64; 13] = [0.3, 0.6, 1.0, 1.4, 2.0, 2.7, 3.6, 5.0, 7.0, 10.0, 14.0, 20.0, 28.0];

/// Fits the latency law to a hold: equations (4) and (5), no starting values.
///
/// `times` in s rise from the start of the hold (their first value is its zero); `values` are strain, force or
/// stress, one a time. With [`ExponentChoice::Free`] the exponent is sought in `options.exponent_range`.
///
/// For given (λ, n) the model is linear in (y_e, Δ). Variable projection leaves ln λ, or (ln λ, n): a coarse grid
/// finds the valleys, a damped Gauss–Newton search their bottoms, and the lowest one is returned. The search is made in
/// units of the hold's own duration and range, so no choice of units changes the answer.
///
/// λ is sought from 10⁻³ per duration of the hold to 10³ per first sample step; an optimum at either end is reported as
/// [`Termination::RateAtBound`], with no errors, because the data then leave the law open.
///
/// ```
/// use palpate::identify::{ExponentChoice, FitOptions, fit_hold};
/// // 0.2 + 0.1 (1 + 4 · 0.5 t)^(-1/4): n = 5, λ = 0.5 per second
/// let times: Vec<f64> = (0..200).map(|i| 0.1 * f64::from(i)).collect();
/// let values: Vec<f64> = times.iter().map(|t| 0.2 + 0.1 * (1.0 + 2.0 * t).powf(-0.25)).collect();
/// let fit = fit_hold(&times, &values, ExponentChoice::Free, &FitOptions::default())?;
/// assert!((fit.exponent.value - 5.0).abs() < 1e-6);
/// assert!((fit.equilibrium.value - 0.2).abs() < 1e-8);
/// // v = λ/Δ⁴
/// assert!((fit.rate_coefficient.value / 5000.0 - 1.0).abs() < 1e-4);
/// # Ok::<(), palpate::identify::FitError>(())
/// ```
///
/// # Errors
/// [`FitError`] for unequal lengths, fewer samples than numbers plus one, values that are not finite, times that do not
/// rise, an exponent that is no number above zero, or values that are all the same.
pub fn fit_hold(
    times: &[f64],
    values: &[f64],
    choice: ExponentChoice,
    options: &FitOptions,
) -> Result<LatencyFit, FitError> {
    options.check()?;
    check(times, values, choice)?;
    let scaled = Scaled::new(times, values)?;
    let shapes = HoldShapes::new(&scaled, choice, options);
    let mut work = Work::default();
    let starts = shapes.starts(&scaled, &mut work);
    let mut best: Option<Refined> = None;
    for start in starts {
        let refined = refine(&shapes, &scaled.values, &start, options.most_iterations, &mut work);
        if best.as_ref().is_none_or(|best| refined.square() < best.square()) {
            best = Some(refined);
        }
    }
    let solution = polished(&shapes, &scaled.values, best.ok_or(FitError::NoDecay)?, &mut work);
    Ok(scaled.fit(&solution, choice, options, work))
}

fn check(times: &[f64], values: &[f64], choice: ExponentChoice) -> Result<(), FitError> {
    if times.len() != values.len() {
        return Err(FitError::Lengths {
            abscissas: times.len(),
            values: values.len(),
        });
    }
    let parameters = match choice {
        ExponentChoice::Fixed(n) if !(n.is_finite() && n > 0.0) => return Err(FitError::Exponent { found: n }),
        ExponentChoice::Fixed(_) => 3,
        ExponentChoice::Free => 4,
    };
    if times.len() < parameters + 2 {
        return Err(FitError::TooFewSamples {
            parameters,
            needed: parameters + 2,
            found: times.len(),
        });
    }
    if let Some(index) = times.iter().zip(values).position(|(t, y)| !(t.is_finite() && y.is_finite())) {
        return Err(FitError::NotFinite { index });
    }
    match times.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(before) => Err(FitError::TimeNotRising { index: before + 1 }),
        None => Ok(()),
    }
}

/// A hold in units of its own duration and range.
struct Scaled {
    times: Vec<f64>,
    values: Vec<f64>,
    duration: f64,
    center: f64,
    range: f64,
}

impl Scaled {
    fn new(times: &[f64], values: &[f64]) -> Result<Self, FitError> {
        let start = times[0];
        let duration = times[times.len() - 1] - start;
        let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(*y), high.max(*y)));
        let range = high - low;
        if range == 0.0 {
            return Err(FitError::Constant {
                value: low,
                samples: values.len(),
            });
        }
        let first = (times[1] - start) / duration;
        let invertible = |span: f64| span.is_finite() && (1.0 / span).is_finite();
        if !(invertible(range) && invertible(duration) && first > f64::MIN_POSITIVE * 1e6) {
            return Err(FitError::OutOfRange);
        }
        let center = low + 0.5 * range;
        let (per_duration, per_range) = (1.0 / duration, 1.0 / range);
        Ok(Self {
            times: times.iter().map(|t| (t - start) * per_duration).collect(),
            values: values.iter().map(|y| (y - center) * per_range).collect(),
            duration,
            center,
            range,
        })
    }

    /// Brings a solution back to the units of the caller.
    fn fit(&self, solution: &Solution, choice: ExponentChoice, options: &FitOptions, work: Work) -> LatencyFit {
        let (level, drop) = (solution.linear[0], solution.linear[1]);
        let rate = solution.nonlinear[0].exp() / self.duration;
        let n = match choice {
            ExponentChoice::Fixed(n) => n,
            ExponentChoice::Free => solution.nonlinear[1],
        };
        let size = 2 + solution.nonlinear.len();
        let uncertainty = Uncertainty::new(solution, options.confidence);
        let known = solution.termination == Termination::Converged;
        let inverse = solution.inverse_normal.as_deref().filter(|_| known);
        let estimate = |value: f64, weights: &[f64], scale: Scale, unit: f64| match inverse {
            Some(inverse) => uncertainty.estimate(value, variance_of(&weights[..size], inverse) * unit * unit, scale),
            None => Estimate::fixed(value),
        };
        let amplitude = drop * self.range;
        // ln v = ln λ − (n − 1) ln |Δ|
        let log_amplitude = amplitude.abs().ln();
        let weights = [0.0, -(n - 1.0) / drop, 1.0, -log_amplitude];
        let coefficient = (rate.ln() - (n - 1.0) * log_amplitude).exp();
        let variance = uncertainty.variance;
        let unit = [self.range, self.range, 1.0, 1.0];
        let covariance = inverse.map(|inverse| {
            let entry = |i: usize, j: usize| inverse[i * size + j] * variance * unit[i] * unit[j];
            (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect()
        });
        let covariance = covariance.filter(|rows: &Vec<Vec<f64>>| rows.iter().flatten().all(|entry| entry.is_finite()));
        let residual_square = solution.residual_square * self.range * self.range;
        LatencyFit {
            domain: Domain::Time,
            choice,
            exponent: match choice {
                ExponentChoice::Fixed(n) => Estimate::fixed(n),
                ExponentChoice::Free => estimate(n, &[0.0, 0.0, 0.0, 1.0 / n], Scale::Log, 1.0),
            },
            equilibrium: estimate(self.center + level * self.range, &[1.0, 0.0, 0.0, 0.0], Scale::Linear, self.range),
            amplitude: estimate(amplitude, &[0.0, 1.0, 0.0, 0.0], Scale::Linear, self.range),
            relative_rate: estimate(rate, &[0.0, 0.0, 1.0, 0.0], Scale::Log, 1.0),
            rate_coefficient: estimate(coefficient, &weights, Scale::Log, 1.0),
            covariance,
            residual_square,
            rmse: (residual_square / self.values.len() as f64).sqrt(),
            residual_correlation: uncertainty.correlation,
            samples: self.values.len(),
            termination: solution.termination,
            work,
        }
    }
}

/// Columns 1 and φ; nonlinear numbers ln λ and, if free, n.
struct HoldShapes<'a> {
    times: &'a [f64],
    choice: ExponentChoice,
    log_rates: (f64, f64),
    exponents: (f64, f64),
}

impl<'a> HoldShapes<'a> {
    fn new(scaled: &'a Scaled, choice: ExponentChoice, options: &FitOptions) -> Self {
        let first_step = scaled.times[1];
        Self {
            times: &scaled.times,
            choice,
            log_rates: (1e-3f64.ln(), (1e3 / first_step).ln()),
            exponents: options.exponent_range,
        }
    }

    /// Points from which to refine: the bottoms that the coarse grid shows.
    fn starts(&self, scaled: &Scaled, work: &mut Work) -> Vec<Vec<f64>> {
        let condensed = Condensed::new(&scaled.times, &scaled.values);
        match self.choice {
            ExponentChoice::Fixed(n) => {
                let starts = condensed.starts(self.log_rates, &[n], 3, work);
                starts.into_iter().map(|(rate, _)| vec![rate]).collect()
            }
            ExponentChoice::Free => {
                let (low, high) = self.exponents;
                let inside = EXPONENT_GRID.into_iter().filter(|n| low < *n && *n < high);
                let grid: Vec<f64> = [low].into_iter().chain(inside).chain([high]).collect();
                let starts = condensed.starts(self.log_rates, &grid, 4, work);
                starts.into_iter().map(|(rate, n)| vec![rate, n]).collect()
            }
        }
    }
}

impl Shapes for HoldShapes<'_> {
    fn columns(&self) -> usize {
        2
    }

    fn column_of(&self, _: usize) -> usize {
        1
    }

    fn bounds(&self, index: usize) -> (f64, f64) {
        [self.log_rates, self.exponents][index]
    }

    fn at_bound(&self, index: usize) -> Termination {
        [Termination::RateAtBound, Termination::ExponentAtBound][index]
    }

    fn fill(&self, theta: &[f64], columns: &mut [Vec<f64>], derivatives: &mut [Vec<f64>]) {
        let rate = theta[0].exp();
        columns[0].fill(1.0);
        match (self.choice, derivatives) {
            (ExponentChoice::Fixed(n), [by_rate]) => {
                decay_with_log_rate_many(self.times, rate, n, &mut columns[1], by_rate);
            }
            (_, [by_rate, by_exponent]) => {
                decay_with_gradient_many(self.times, rate, theta[1], &mut columns[1], by_rate, by_exponent);
            }
            _ => unreachable!("one or two nonlinear numbers"),
        }
    }
}
