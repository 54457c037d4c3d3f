//! One law fitted to several holds.

use super::arrow::{Point, refine};
use super::hold::{Hold, View};
use super::report::Joint;
use super::result::law_options;
use super::starts::{Start, finalists};
use crate::fit::{FitError, Fitted, HoldWeights, JointFit, JointOptions, LawOptions, Samples};
use crate::laws::{ExponentChoice, Law, ShapeParameterKind};
use crate::optimise::{Effort, Ending, Shapes, Termination};
use crate::statistics::mean;
use crate::watch::{Cancelled, Progress, Unwatched, Watch};

/// Fits one law to several holds: the parameters of the material shared, constant and amplitudes for each hold.
///
/// Laws other than latency share their times and dimensionless parameters. The latency law shares v and n: the rate of a hold follows
/// from its own drop, λ = v |Δ|ⁿ⁻¹, so that holds of different drops tell n by their rates too. v is a parameter of the material
/// if the signal is strain; else its unit is signal^(1−n)/s.
///
/// No starting values: the search starts from each hold's own fit, from their mean, and from a coarse grid over all holds
/// (for the latency law a list of exponents, every hold fitted alone at each), in units of the holds' durations and ranges.
///
/// ```
/// use palpate::fit::{JointOptions, Samples, fit_joint};
/// use palpate::laws::Law;
/// // Two holds that relax with 4 s.
/// let times: Vec<f64> = (0..60).map(|i| 0.25 * f64::from(i)).collect();
/// let hold = |end: f64, drop: f64| times.iter().map(|t| end + drop * (-t / 4.0).exp()).collect::<Vec<f64>>();
/// let (first, second) = (hold(1.0, 0.5), hold(2.0, 0.7));
/// let holds = [Samples::new(&times, &first), Samples::new(&times, &second)];
/// let fit = fit_joint(&holds, Law::StandardLinearSolid, &JointOptions::default())?;
/// assert!((fit.shared("time_constant_s").unwrap().estimate.value - 4.0).abs() < 1e-8);
/// assert!((fit.holds[1].value("amplitude").unwrap() - 0.7).abs() < 1e-8);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// [`FitError::TooFewHolds`], [`FitError::NothingShared`] (a spectrum has its times given), [`FitError::StandardDeviationsOfSome`], and
/// [`FitError::Hold`] with the number of the hold that cannot be fitted and why.
pub fn fit_joint(holds: &[Samples<'_>], law: Law, options: &JointOptions) -> Result<JointFit, FitError> {
    fit_joint_watched(holds, law, options, &mut Unwatched)
}

/// [`fit_joint`] with a watch.
///
/// # Errors
/// As [`fit_joint`], and [`FitError::Cancelled`].
pub fn fit_joint_watched(
    holds: &[Samples<'_>],
    law: Law,
    options: &JointOptions,
    watch: &mut dyn Watch,
) -> Result<JointFit, FitError> {
    options.fit.check(ExponentChoice::Free)?;
    if holds.len() < 2 {
        return Err(FitError::TooFewHolds { found: holds.len() });
    }
    if let Some(without) = holds.iter().position(|hold| hold.standard_deviations.is_none())
        && holds.iter().any(|hold| hold.standard_deviations.is_some())
    {
        return Err(FitError::StandardDeviationsOfSome { hold: without + 1 });
    }
    Effort::watched(watch, |effort| found(holds, law, options, effort))
}

fn found(
    holds: &[Samples<'_>],
    law: Law,
    options: &JointOptions,
    effort: &mut Effort<'_>,
) -> Result<JointFit, FitError> {
    let law_options = law_options(law, options);
    let mut alone = Vec::new();
    for (index, samples) in holds.iter().enumerate() {
        effort.reach(Progress::counted("fitting holds together", index, holds.len() + 1))?;
        let fitted = separate(samples, law, &law_options, effort);
        alone.push(fitted.map_err(|source| match source {
            FitError::NothingShared { .. } | FitError::NoForm { .. } | FitError::Cancelled(_) => source,
            _ => FitError::Hold {
                hold: index + 1,
                source: Box::new(source),
            },
        })?);
    }
    let report = |fitted: &Fitted| fitted.report(law, &law_options, &effort.aside());
    let separate = alone.iter().map(report).collect::<Result<_, _>>()?;
    let joint = joined(holds, alone, law, options);
    let (point, termination) = joint.solve(options.fit.most_iterations, effort)?;
    Ok(joint.report(&point, termination, separate, effort.work))
}

/// A hold fitted alone.
fn separate(
    samples: &Samples<'_>,
    law: Law,
    options: &LawOptions,
    effort: &mut Effort<'_>,
) -> Result<Fitted, FitError> {
    let fitted = Fitted::new(samples, law, options, effort)?;
    if fitted.model.free().len() == 0 {
        return Err(FitError::NothingShared { law });
    }
    Ok(fitted)
}

/// Holds fitted alone, brought together: shared units, weights and bounds.
fn joined(samples: &[Samples<'_>], alone: Vec<Fitted>, law: Law, options: &JointOptions) -> Joint {
    let logs = |of: fn(&Fitted) -> f64| mean(&alone.iter().map(|fitted| of(fitted).ln()).collect::<Vec<f64>>());
    let (log_time, log_signal) = (logs(|fitted| fitted.scaled.duration), logs(|fitted| fitted.scaled.range));
    let log_weights = log_weights(samples, &alone, options.weights);
    let coupling = match law {
        Law::Latency { exponent } => Some(exponent.given()),
        _ => None,
    };
    let mut holds = Vec::new();
    let mut solutions = Vec::new();
    for (fitted, log_weight) in alone.into_iter().zip(log_weights) {
        let log_range = fitted.scaled.range.ln() - log_signal;
        holds.push(Hold {
            weight: (log_weight + log_range).exp(),
            log_duration: fitted.scaled.duration.ln() - log_time,
            log_range,
            coupling,
            model: fitted.model,
            scaled: fitted.scaled,
        });
        solutions.push(fitted.solution);
    }
    let bounds = bounds(&holds);
    Joint {
        law,
        options: *options,
        holds,
        solutions,
        bounds,
        log_time,
        log_signal,
    }
}

/// ln of the root of every hold's weight; the mean of the weights over all samples is one.
fn log_weights(samples: &[Samples<'_>], alone: &[Fitted], weights: HoldWeights) -> Vec<f64> {
    // No hold counts as more exact than this share of its range.
    const FLOOR: f64 = 1e-9;
    let own = |(hold, fitted): (&Samples<'_>, &Fitted)| match (weights, hold.standard_deviations) {
        (HoldWeights::SeparateVariance, _) => {
            let parameters = fitted.solution.linear.len() + fitted.solution.nonlinear.len();
            let variance = fitted.solution.residual_square / (fitted.scaled.times.len() - parameters) as f64;
            -(variance.sqrt().max(FLOOR)).ln() - fitted.scaled.range.ln()
        }
        // The root mean square of 1/σ, which the hold's own weights were divided by.
        (HoldWeights::Equal, Some(standard_deviations)) => {
            let least = standard_deviations.iter().copied().fold(f64::INFINITY, f64::min);
            let squares: Vec<f64> = standard_deviations.iter().map(|deviation| (least / deviation).powi(2)).collect();
            0.5 * mean(&squares).ln() - least.ln()
        }
        (HoldWeights::Equal, None) => 0.0,
    };
    let logs: Vec<f64> = samples.iter().zip(alone).map(own).collect();
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let counts: Vec<f64> = samples.iter().map(|hold| hold.times.len() as f64).collect();
    let square: f64 = logs.iter().zip(&counts).map(|(log, count)| count * (2.0 * (log - most)).exp()).sum();
    let middle = most + 0.5 * (square / counts.iter().sum::<f64>()).ln();
    logs.into_iter().map(|log| log - middle).collect()
}

/// Bounds of the shared parameters: as wide as any hold allows.
fn bounds(holds: &[Hold]) -> Vec<(f64, f64)> {
    /// What a drop may do to the rate of a coupled law, in ln.
    const ROOM: f64 = 40.0;
    let parameter = |p: usize| {
        let of = |hold: &Hold| hold.model.free().nth(p).map(|parameter| (parameter.kind, parameter.bounds));
        let each = holds.iter().filter_map(|hold| Some((of(hold)?, hold.log_duration)));
        let room = if holds[0].coupling.is_some() { ROOM } else { 0.0 };
        each.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), ((kind, bounds), log_duration)| {
            let (shift, room) =
                if matches!(kind, ShapeParameterKind::Pure { .. }) { (0.0, 0.0) } else { (log_duration, room) };
            (low.min(bounds.0 - shift - room), high.max(bounds.1 - shift + room))
        })
    };
    (0..holds[0].model.free().len()).map(parameter).collect()
}

impl Joint {
    /// The best point, with every hold's own parameters.
    fn solve(&self, most_iterations: usize, effort: &mut Effort<'_>) -> Result<(Point, Termination), Cancelled> {
        let start = |(hold, solution): (&Hold, &crate::optimise::Solution)| {
            Start::new(
                hold.shared(&solution.nonlinear, &solution.linear),
                self.solutions.iter().map(|solution| solution.linear.clone()).collect(),
            )
        };
        let separate: Vec<Start> = self.holds.iter().zip(&self.solutions).map(start).collect();
        let views: Vec<View<'_>> = self.holds.iter().map(View::all).collect();
        let ending = Ending::new(1e-22, most_iterations);
        let first = separate[0].clone();
        let mut starts = finalists(&self.holds, &self.bounds, separate, most_iterations, effort)?.into_iter();
        let settle = |start: Start, effort: &mut Effort<'_>| {
            let start = self.arranged(start);
            let point = Point::new(&views, &start.shared, &start.own, effort)?;
            refine(&views, &self.bounds, point, ending, effort)
        };
        let (mut point, mut termination) = settle(starts.next().unwrap_or(first), effort)?;
        for start in starts {
            effort.reach(Progress::counted("fitting holds together", self.holds.len(), self.holds.len() + 1))?;
            let found = settle(start, effort)?;
            if found.0.square < point.square {
                (point, termination) = found;
            }
        }
        let termination = self.ended(&point, termination);
        Ok((point, termination))
    }

    /// Exponentials in the order of their times, fastest first.
    fn arranged(&self, mut start: Start) -> Start {
        if self.holds[0].model.moving().0.len() > 1 {
            // The own parameters follow: the law is linear in them.
            start.shared.sort_by(|a, b| b.total_cmp(a));
        }
        start
    }

    /// Why it ended, if a parameter lies at the edge of what holds can show.
    fn ended(&self, point: &Point, termination: Termination) -> Termination {
        if termination != Termination::Converged {
            return termination;
        }
        let edge = |value: f64, (low, high): (f64, f64)| {
            let near = 1e-9 * (high - low);
            value <= low + near || value >= high - near
        };
        let shapes = self.holds[0].model.at(&self.holds[0].scaled.times);
        for (p, value) in point.shared.iter().enumerate() {
            // A coupled rate is bounded by what it is in each hold.
            let rates =
                || self.holds.iter().zip(&point.parts).map(|(hold, part)| hold.theta(&point.shared, &part.own)[0]);
            let outside = match self.holds[0].coupling {
                Some(_) if p == 0 => rates().zip(&self.holds).any(|(rate, hold)| edge(rate, hold.scaled.log_rates())),
                _ => edge(*value, self.bounds[p]),
            };
            if outside {
                return shapes.at_bound(p);
            }
        }
        termination
    }
}
