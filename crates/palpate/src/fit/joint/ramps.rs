//! The latency law fitted to several holds that follow different ways to the same displacement.
//!
//! During the loading γ(t), from 0 to 1, the excess signal obeys the law with the loading as its drive (section IV of the
//! paper, step 3):
//!
//! ẋ = Δ γ̇(t) − v sgn(x) |x|ⁿ,  x = 0 at rest,
//!
//! and in the hold its closed form (4), (5). Δ is the excess that a true step would leave. One hold does not tell Δ from what
//! the loading took off it; several that were reached at different rates do.
//!
//! With x = Δ ξ and κ = v |Δ|ⁿ⁻¹, the relative rate just after a step, ξ̇ = γ̇ − κ sgn(ξ) |ξ|ⁿ: hold h is
//! y_h(t) = e_h + Δ ξ_h φ(κ |ξ_h|ⁿ⁻¹ t; n), linear in all but ln κ and n.

use serde::{Deserialize, Serialize};

use crate::contact::{Element, Ramps, SimulationWork as Effort};
use crate::fit::{Assessed, Estimate, FitError, FitOptions, NoiseChoice, Samples, Scale, distinct};
use crate::latency::{LatencyLaw, decay_many, decay_with_gradient_many};
use crate::laws::{ExponentChoice, Loading};
use crate::optimise::{Ending, Shapes, Solution, Target, Termination, Work, polished, refine, square_at};

/// A hold and the way to it.
#[derive(Debug, Clone)]
pub struct RampHold<'a> {
    /// From rest to the start of the hold.
    pub loading: &'a Loading,
    /// The hold; its first sample is the end of the loading.
    pub samples: Samples<'a>,
}

/// Whether all holds end at one equilibrium.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EquilibriumChoice {
    /// Each has its own: samples, zeros and positions differ.
    #[default]
    Each,
    /// They have one.
    Shared,
}

/// What a joint fit says of one hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RampHoldNumbers {
    /// y_e, what the signal tends to.
    pub equilibrium: Estimate,
    /// Δ ξ, the excess at the start of the hold.
    pub amplitude: Estimate,
    /// y_e + Δ, the signal just after a true step.
    pub step_start: Estimate,
}

/// The latency law of several holds at one displacement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RampFit {
    /// n.
    pub exponent: Estimate,
    /// Δ, the excess that a true step would leave, in the unit of the signal.
    pub step_amplitude: Estimate,
    /// κ = v |Δ|ⁿ⁻¹ in 1/s, the relative rate just after a true step.
    pub step_rate: Estimate,
    /// v in (unit of the signal)^(1 − n)/s.
    pub rate_coefficient: Estimate,
    /// The holds, in the order given.
    pub holds: Vec<RampHoldNumbers>,
    /// Covariance of the equilibria (or the one), Δ, ln κ, n; `None` where the data leave a number open.
    pub covariance: Option<Vec<Vec<f64>>>,
    /// Sum of squared residuals, weighted if samples have deviations.
    pub residual_square: f64,
    /// Root mean square residual.
    pub rmse: f64,
    /// Samples fitted.
    pub samples: usize,
    /// Why it ended.
    pub termination: Termination,
    /// What it cost.
    pub work: Work,
}

impl RampFit {
    /// The excess at the end of a loading, in the unit of the signal.
    #[must_use]
    pub fn amplitude_after(&self, loading: &Loading) -> f64 {
        let share = excess_share(&loading.thinned(PIECES), self.step_rate.value.ln(), self.exponent.value);
        self.step_amplitude.value * share
    }

    /// The excess `elapsed` s into the hold that follows a loading: what the signal is above its equilibrium.
    #[must_use]
    pub fn excess_after(&self, loading: &Loading, elapsed: f64) -> f64 {
        let amplitude = self.amplitude_after(loading);
        match LatencyLaw::new(self.exponent.value, self.rate_coefficient.value) {
            Ok(law) => law.excess_after(amplitude, elapsed),
            Err(_) => f64::NAN,
        }
    }
}

/// Fits the latency law to holds at one displacement that was reached in different times.
///
/// No starting values: the two numbers that are not linear, ln κ and n, are searched on a grid and refined by variable
/// projection. Loadings must differ in their rates for Δ to be found; two of the same say no more than one, and end as
/// [`Termination::Singular`] or with errors to match.
///
/// ```
/// use palpate::fit::{EquilibriumChoice, ExponentChoice, FitOptions, RampHold, Samples, fit_ramps};
/// use palpate::laws::Loading;
/// // n = 2, κ = 1/s, Δ = 2: a ramp of T s ends at ξ = tanh(√(κT))/√(κT), and the hold is 1 + Δ ξ/(1 + κξt).
/// let times: Vec<f64> = (0..100).map(|i| 0.2 * f64::from(i)).collect();
/// let hold = |ramp: f64| -> Vec<f64> {
///     let start = ramp.sqrt().tanh() / ramp.sqrt();
///     times.iter().map(|t| 1.0 + 2.0 * start / (1.0 + start * t)).collect()
/// };
/// let (slow, fast) = (Loading::ramp(4.0)?, Loading::ramp(0.5)?);
/// let (after_slow, after_fast) = (hold(4.0), hold(0.5));
/// let holds = [
///     RampHold { loading: &slow, samples: Samples::new(&times, &after_slow) },
///     RampHold { loading: &fast, samples: Samples::new(&times, &after_fast) },
/// ];
/// let fit = fit_ramps(&holds, ExponentChoice::Free, EquilibriumChoice::Shared, &FitOptions::default())?;
/// assert!((fit.step_amplitude.value - 2.0).abs() < 1e-7);
/// assert!((fit.exponent.value - 2.0).abs() < 1e-7);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`FitError`] for no holds, samples that no law can be fitted to, and an exponent that is no number above zero.
pub fn fit_ramps(
    holds: &[RampHold<'_>],
    choice: ExponentChoice,
    equilibria: EquilibriumChoice,
    options: &FitOptions,
) -> Result<RampFit, FitError> {
    options.check(choice)?;
    let problem = RampProblem::new(holds, choice, equilibria, options)?;
    let mut work = Work::default();
    let ending = Ending::tight(options.most_iterations);
    let starts = problem.starts(&mut work);
    let refined = starts.into_iter().map(|start| refine(&problem, problem.target(), &start, ending, &mut work));
    let best = refined.min_by(|a, b| a.point.square.total_cmp(&b.point.square)).ok_or(FitError::NoDecay)?;
    let solution = polished(&problem, problem.target(), best, &mut work);
    Ok(problem.report(&solution, options, work))
}

/// The excess at the end of a loading as a share of what a step leaves: ξ̇ = γ̇ − κ sgn(ξ) |ξ|ⁿ from 0.
fn excess_share(loading: &Loading, log_rate: f64, exponent: f64) -> f64 {
    let Ok(law) = LatencyLaw::new(exponent, log_rate.exp()) else {
        return f64::NAN;
    };
    let mut effort = Effort::default();
    loading.pieces().fold(0.0, |excess, piece| {
        let duration = piece.from - piece.to;
        let ramps = &mut Ramps::default();
        Element::solve(law, excess, piece.change / duration, duration, ramps, &mut effort).excess_at(duration)
    })
}

/// One hold in the units of the fit.
struct Part {
    loading: Loading,
    times: Vec<f64>,
    /// Which equilibrium it has.
    equilibrium: usize,
}

/// Holds joined to one series, in units of the longest hold and of the widest range.
struct RampProblem {
    parts: Vec<Part>,
    values: Vec<f64>,
    roots: Option<Vec<f64>>,
    equilibria: usize,
    exponent: ExponentChoice,
    bounds: [(f64, f64); 2],
    duration: f64,
    center: f64,
    range: f64,
}

impl RampProblem {
    fn new(
        holds: &[RampHold<'_>],
        exponent: ExponentChoice,
        choice: EquilibriumChoice,
        options: &FitOptions,
    ) -> Result<Self, FitError> {
        let equilibria = if choice == EquilibriumChoice::Shared { 1 } else { holds.len() };
        let numbers = equilibria + if exponent == ExponentChoice::Free { 3 } else { 2 };
        let (mut low, mut high, mut duration, mut first, mut count) = (f64::MAX, f64::MIN, 0.0f64, f64::MAX, 0);
        for hold in holds {
            // An equilibrium of its own needs samples of its own.
            hold.samples.check(1)?;
            let times = hold.samples.times;
            duration = duration.max(times[times.len() - 1] - times[0]);
            first = first.min(times[1] - times[0]);
            count += times.len();
            (low, high) = hold.samples.values.iter().fold((low, high), |(low, high), y| (low.min(*y), high.max(*y)));
        }
        FitError::check_samples(numbers, count)?;
        FitError::check_change(low, high, count)?;
        let (center, range) = (low + 0.5 * (high - low), high - low);
        if !(range.is_finite() && (1.0 / range).is_finite() && duration.is_finite() && first / duration > 1e-300) {
            return Err(FitError::OutOfRange);
        }
        let parts = holds.iter().enumerate().map(|(i, hold)| Part {
            loading: hold.loading.thinned(PIECES).in_units_of(duration),
            times: hold.samples.times.iter().map(|t| (t - hold.samples.times[0]) / duration).collect(),
            equilibrium: i.min(equilibria - 1),
        });
        let roots = roots(holds, count);
        let bare = holds.iter().flat_map(|hold| hold.samples.values).map(|y| (y - center) / range);
        Ok(Self {
            parts: parts.collect(),
            values: match &roots {
                None => bare.collect(),
                Some(roots) => bare.zip(roots).map(|(y, root)| y * root).collect(),
            },
            roots,
            equilibria,
            exponent,
            // From a thousandth per hold to a thousand per first step, as for a single hold.
            bounds: [(1e-3f64.ln(), (1e3 * duration / first).ln()), options.exponent_range],
            duration,
            center,
            range,
        })
    }

    fn target(&self) -> Target<'_> {
        Target::new(&self.values, self.roots.as_deref())
    }

    /// ln κ and n of the free numbers.
    fn numbers(&self, theta: &[f64]) -> (f64, f64) {
        (theta[0], self.exponent.given().unwrap_or_else(|| theta[1]))
    }

    /// The best points of a grid of ln κ and n.
    fn starts(&self, work: &mut Work) -> Vec<Vec<f64>> {
        const EXPONENTS: [f64; 9] = [0.2, 0.5, 1.0, 2.0, 3.0, 5.0, 9.0, 16.0, 30.0];
        const PER_DECADE: f64 = 2.0;
        let (low, high) = self.bounds[0];
        let count = ((high - low) / std::f64::consts::LN_10 * PER_DECADE).ceil().max(1.0);
        let rates = (0..=count as usize).map(|i| low + (high - low) * i as f64 / count);
        let exponents: Vec<Option<f64>> = match self.exponent {
            ExponentChoice::Fixed(_) => vec![None],
            ExponentChoice::Free => EXPONENTS.map(|n| Some(n.clamp(self.bounds[1].0, self.bounds[1].1))).to_vec(),
        };
        let grid = rates.flat_map(|rate| exponents.iter().map(move |n| std::iter::once(rate).chain(*n).collect()));
        let mut found: Vec<(f64, Vec<f64>)> = grid
            .map(|theta: Vec<f64>| {
                work.grid_points += 1;
                (square_at(self, self.target(), &theta), theta)
            })
            .filter(|(square, _)| square.is_finite())
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let near = |a: &Vec<f64>, b: &Vec<f64>| !a.iter().zip(b).any(|(a, b)| (a - b).abs() > 2.0);
        distinct(found.into_iter().map(|(_, theta)| theta), VALLEYS, near)
    }

    fn report(&self, solution: &Solution, options: &FitOptions, work: Work) -> RampFit {
        let (equilibria, size) = (self.equilibria, solution.linear.len() + solution.nonlinear.len());
        let units: Vec<f64> = (0..size).map(|i| if i <= equilibria { self.range } else { 1.0 }).collect();
        let amplitudes = vec![solution.linear[equilibria]; solution.nonlinear.len()];
        let trust = (options.confidence, NoiseChoice::FromResiduals);
        let known = solution.termination == Termination::Converged;
        let assessed = Assessed::new(solution, &amplitudes, &units, self.range, trust, known);
        let estimate = |value: f64, entries: &[(usize, f64)], scale: Scale| {
            let mut gradient = vec![0.0; size];
            entries.iter().filter(|(i, _)| *i < size).for_each(|(i, entry)| gradient[*i] += entry);
            assessed.estimate(value, &gradient, scale)
        };
        let (log_inner, n) = self.numbers(&solution.nonlinear);
        let log_rate = log_inner - self.duration.ln();
        let amplitude = solution.linear[equilibria] * self.range;
        // Places of Δ, ln κ and, if it is free, n.
        let [at, rate, exponent] = [equilibria, equilibria + 1, equilibria + 2];
        let hold = |part: &Part| {
            let level = solution.linear[part.equilibrium] * self.range + self.center;
            let [share, by_rate, by_exponent] = shares(&part.loading, log_inner, n);
            let ways = [(at, share), (rate, amplitude * by_rate), (exponent, amplitude * by_exponent)];
            RampHoldNumbers {
                equilibrium: estimate(level, &[(part.equilibrium, 1.0)], Scale::Linear),
                amplitude: estimate(amplitude * share, &ways, Scale::Linear),
                step_start: estimate(level + amplitude, &[(part.equilibrium, 1.0), (at, 1.0)], Scale::Linear),
            }
        };
        let log_amplitude = amplitude.abs().ln();
        let coefficient = [(at, -(n - 1.0) / amplitude), (rate, 1.0), (exponent, -log_amplitude)];
        let residual_square = solution.residual_square * self.range * self.range;
        RampFit {
            exponent: match self.exponent {
                ExponentChoice::Fixed(n) => Estimate::fixed(n),
                ExponentChoice::Free => estimate(n, &[(exponent, 1.0 / n)], Scale::Log),
            },
            step_amplitude: estimate(amplitude, &[(at, 1.0)], Scale::Linear),
            step_rate: estimate(log_rate.exp(), &[(rate, 1.0)], Scale::Log),
            rate_coefficient: estimate((log_rate - (n - 1.0) * log_amplitude).exp(), &coefficient, Scale::Log),
            holds: self.parts.iter().map(hold).collect(),
            residual_square,
            rmse: (residual_square / self.values.len() as f64).sqrt(),
            samples: self.values.len(),
            termination: solution.termination,
            covariance: assessed.white,
            work,
        }
    }
}

/// Valleys that are refined.
const VALLEYS: usize = 4;

/// Pieces that a loading is thinned to: each is an integration, of some microseconds.
const PIECES: usize = 200;

/// Square roots of the weights of all samples, 1 at the root mean square; `None` if no hold has deviations.
fn roots(holds: &[RampHold<'_>], count: usize) -> Option<Vec<f64>> {
    if holds.iter().all(|hold| hold.samples.deviations.is_none()) {
        return None;
    }
    let one = |hold: &RampHold<'_>| match hold.samples.deviations {
        Some(deviations) => deviations.iter().map(|deviation| 1.0 / deviation).collect(),
        None => vec![1.0; hold.samples.times.len()],
    };
    let mut roots: Vec<f64> = holds.iter().flat_map(one).collect();
    let size = (roots.iter().map(|root| root * root).sum::<f64>() / count as f64).sqrt();
    roots.iter_mut().for_each(|root| *root /= size);
    Some(roots)
}

/// ξ and its derivatives by ln κ and n: central differences, exact to some 10⁻⁸, of an integration exact to 10⁻¹².
fn shares(loading: &Loading, log_rate: f64, exponent: f64) -> [f64; 3] {
    const STEP: f64 = 1e-4;
    let step = STEP * exponent.min(1.0);
    let difference = |above: f64, below: f64, step: f64| (above - below) / (2.0 * step);
    let at = |log_rate: f64, exponent: f64| excess_share(loading, log_rate, exponent);
    [
        at(log_rate, exponent),
        difference(at(log_rate + STEP, exponent), at(log_rate - STEP, exponent), STEP),
        difference(at(log_rate, exponent + step), at(log_rate, exponent - step), step),
    ]
}

impl Shapes for RampProblem {
    fn columns(&self) -> usize {
        self.equilibria + 1
    }

    fn column_of(&self, _: usize) -> usize {
        self.equilibria
    }

    fn bounds(&self, index: usize) -> (f64, f64) {
        self.bounds[index]
    }

    fn at_bound(&self, index: usize) -> Termination {
        if index == 0 { Termination::RateAtBound } else { Termination::ExponentAtBound }
    }

    /// Ones for each equilibrium, then ξ_h φ(κ |ξ_h|ⁿ⁻¹ t; n), hold after hold.
    fn fill(&self, theta: &[f64], columns: &mut [Vec<f64>], derivatives: &mut [Vec<f64>]) {
        let (log_rate, n) = self.numbers(theta);
        let (levels, decay) = columns.split_at_mut(self.equilibria);
        levels.iter_mut().for_each(|level| level.fill(0.0));
        let mut from = 0;
        for part in &self.parts {
            let range = from..from + part.times.len();
            from = range.end;
            levels[part.equilibrium][range.clone()].fill(1.0);
            let column = &mut decay[0][range.clone()];
            match derivatives {
                [] => part.value(log_rate, n, column),
                [by_rate, others @ ..] => {
                    let by_exponent = others.first_mut().map(|other| &mut other[range.clone()]);
                    part.gradient(log_rate, n, column, &mut by_rate[range], by_exponent);
                }
            }
        }
    }
}

impl Part {
    /// ξ φ(κ |ξ|ⁿ⁻¹ t; n).
    fn value(&self, log_rate: f64, n: f64, column: &mut [f64]) {
        let share = excess_share(&self.loading, log_rate, n);
        let rate = (log_rate + (n - 1.0) * log_size(share)).exp();
        decay_many(&self.times, rate, n, column);
        column.iter_mut().for_each(|phi| *phi *= share);
    }

    /// The same with its derivatives by ln κ and n.
    fn gradient(
        &self,
        log_rate: f64,
        n: f64,
        column: &mut [f64],
        by_log_rate: &mut [f64],
        by_exponent: Option<&mut [f64]>,
    ) {
        let [share, share_by_rate, share_by_exponent] = shares(&self.loading, log_rate, n);
        let mut phi_by_exponent = vec![0.0; column.len()];
        let rate = (log_rate + (n - 1.0) * log_size(share)).exp();
        decay_with_gradient_many(&self.times, rate, n, column, by_log_rate, &mut phi_by_exponent);
        // ξ stands before φ and, with power n − 1, in its rate.
        if let Some(by_exponent) = by_exponent {
            for (i, entry) in by_exponent.iter_mut().enumerate() {
                let (phi, phi_by_rate) = (column[i], by_log_rate[i]);
                let at_share = share * (phi_by_exponent[i] + log_size(share) * phi_by_rate);
                *entry = at_share + (phi + (n - 1.0) * phi_by_rate) * share_by_exponent;
            }
        }
        for (phi, by_rate) in column.iter_mut().zip(by_log_rate) {
            *by_rate = share * *by_rate + (*phi + (n - 1.0) * *by_rate) * share_by_rate;
            *phi *= share;
        }
    }
}

/// ln |ξ|; a loading may end without any excess.
fn log_size(share: f64) -> f64 {
    share.abs().max(f64::MIN_POSITIVE).ln()
}
