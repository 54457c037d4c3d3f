//! What a hold will show next: laws that are combined by what each has predicted of the hold so far.
//!
//! Every member k is fitted to the first 25, 35, 50, 65 and 80 % of the hold and predicts what follows, up to three times that duration.
//! With e_k its error as a share of the change until then, weights w ≥ 0 with Σ w = 1 make
//!
//! ```text
//! Σ_cuts π ⟨(Σ_k w_k e_k)²⟩ + ρ min_k ⟨e_k²⟩ |w − 1/m|²
//! ```
//!
//! least ("stacking", Wolpert 1992, Breiman 1996), where later cuts count more (π). The forecast is Σ w f with the members f fitted to
//! the whole hold. What the weights of the other cuts would have been off by at each cut is its error; it grows with ln(t/T), and the variance
//! Σ w (f − Σ w f)² between the members is added to its square.

mod member;
mod weights;

pub use member::ForecastMember;
use member::{Course, members};
use weights::stacked;

use crate::fit::{Condensed, FitError, LawOptions, Samples};
use crate::laws::Law;
use crate::statistics::{mean, noise_in_time, normal_factor};
use crate::watch::{Cancelled, Progress, Watch};

/// Shares of the hold that members are fitted to, and how much what they predict counts.
const CUTS: [(f64, f64); 5] = [(0.25, 0.3), (0.35, 0.5), (0.5, 1.0), (0.65, 1.5), (0.8, 2.0)];

/// How many times the duration of a first part is predicted from it.
const HORIZON: f64 = 3.0;

/// Fewest samples in a first part, and behind it.
const FEWEST: (usize, usize) = (8, 3);

/// Cuts that a forecast has to be tried at.
const LEAST_CUTS: usize = 3;

/// Errors grow with ln(t/T) + this.
const AT_ONCE: f64 = 0.1;

/// The forecast of a hold.
///
/// ```
/// use palpate::fit::{LawOptions, Samples};
/// use palpate::forecast::HoldForecast;
/// use palpate::laws::Law;
/// use palpate::test_problems::noisy_hold;
/// use palpate::watch::Unwatched;
/// let (times, values) = noisy_hold(600, 6.0, 1e-3);
/// // What the first half says of the end.
/// let first = Samples::new(&times[..300], &values[..300]);
/// let laws = ["latency", "prony:2", "spectrum", "power"].map(|name| name.parse::<Law>().unwrap());
/// let forecast = HoldForecast::of(&first, &laws, &LawOptions::default(), &mut Unwatched)?.unwrap();
/// let end = forecast.at(times[599] - times[0], 0.95);
/// assert!((end.value - values[599]).abs() < 5e-3 && end.low < values[599] && values[599] < end.high);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HoldForecast {
    /// Duration of the hold so far, s.
    pub duration: f64,
    /// What is combined, with its weight; those of no weight are left out.
    pub members: Vec<(ForecastMember, f64)>,
    /// Root mean square of what the combination would have been off by at the cuts, over the change until then and ln(t/T) + 0.1.
    pub error: f64,
    /// Cuts that it was tried at.
    pub cuts: usize,
    /// Change of the signal so far, in its unit.
    pub change: f64,
    /// 1 where the signal has risen, −1 where it has fallen.
    pub direction: f64,
    /// Standard deviation of the noise of a sample.
    pub noise: f64,
    courses: Vec<Course>,
    options: LawOptions,
}

/// What will be measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forecasted {
    /// The forecast, in the unit of the signal.
    pub value: f64,
    /// Lower end of the band for a sample.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// What was predicted from the first part of the hold, and came otherwise.
struct Trial {
    importance: f64,
    /// Weights of the nodes, which sum to 1, and ln(t/c) + 0.1 there.
    nodes: Vec<(f64, f64)>,
    /// Errors of the members at the nodes as shares of the change until the cut.
    errors: Vec<Vec<f64>>,
}

impl HoldForecast {
    /// The forecast of a hold from laws; `None` where the hold is too short for three first parts that predict anything.
    ///
    /// # Errors
    /// [`FitError`] for samples that no law can be fitted to, and [`FitError::Cancelled`].
    pub fn of(
        samples: &Samples<'_>,
        laws: &[Law],
        options: &LawOptions,
        watch: &mut dyn Watch,
    ) -> Result<Option<Self>, FitError> {
        samples.check(1)?;
        let mut members = members(laws);
        let mut done = 0;
        let all = members.len() * (1 + CUTS.len());
        let mut next = || {
            done += 1;
            watch.report(Progress::counted("forecasting", done - 1, all))
        };
        let mut courses = Vec::with_capacity(members.len());
        for index in (0..members.len()).rev() {
            next()?;
            match Course::of(members[index], samples, options) {
                Ok(course) => courses.push(course),
                Err(_) => drop(members.remove(index)),
            }
        }
        courses.reverse();
        let mut trials = Vec::with_capacity(CUTS.len());
        for (share, importance) in CUTS {
            trials.extend(trial(samples, &members, options, (share, importance), &mut next)?);
        }
        if trials.len() < LEAST_CUTS {
            return Ok(None);
        }
        let count = members.len();
        let weights = weighted(&trials, count, None);
        let (mut square, mut importance) = (0.0, 0.0);
        for (left_out, trial) in trials.iter().enumerate() {
            let others = weighted(&trials, count, Some(left_out));
            let off = |node: usize| others.iter().zip(&trial.errors).map(|(w, errors)| w * errors[node]).sum::<f64>();
            let squares = trial.nodes.iter().enumerate().map(|(node, (w, growth))| w * (off(node) / growth).powi(2));
            square += trial.importance * squares.sum::<f64>();
            importance += trial.importance;
        }
        let (times, values) = (samples.times, samples.values);
        let kept: Vec<usize> = (0..count).filter(|i| weights[*i] > 0.0).collect();
        let forecast = Self {
            duration: times[times.len() - 1] - times[0],
            members: kept.iter().map(|i| (members[*i], weights[*i])).collect(),
            error: (square / importance).sqrt(),
            cuts: trials.len(),
            change: change(values).abs(),
            direction: change(values).signum(),
            noise: noise_in_time(times, values),
            courses: kept.iter().map(|i| courses[*i].clone()).collect(),
            options: options.clone(),
        };
        Ok(Some(forecast).filter(|forecast| forecast.error.is_finite()))
    }

    /// The forecast a time after the first sample, s, with the band that covers a sample with this confidence.
    #[must_use]
    pub fn at(&self, elapsed: f64, confidence: f64) -> Forecasted {
        self.at_times(&[elapsed], confidence)[0]
    }

    /// The same at many times.
    #[must_use]
    pub fn at_times(&self, elapsed: &[f64], confidence: f64) -> Vec<Forecasted> {
        let courses: Vec<Vec<f64>> = self.courses.iter().map(|course| course.at(elapsed, &self.options)).collect();
        let factor = normal_factor(confidence);
        let forecasted = |(index, elapsed): (usize, &f64)| {
            let members = || self.members.iter().zip(&courses).map(|((_, weight), course)| (weight, course[index]));
            let value: f64 = members().map(|(weight, found)| weight * found).sum();
            let spread: f64 = members().map(|(weight, found)| weight * (found - value).powi(2)).sum();
            let beyond = elapsed / self.duration;
            let grown = if beyond > 1.0 { (beyond.ln() + AT_ONCE) * self.error * self.change } else { 0.0 };
            // Variances between the members and of what they have missed so far (law of total variance).
            let variance = grown * grown + spread + self.noise * self.noise;
            let half = factor * variance.sqrt();
            Forecasted {
                value,
                low: value - half,
                high: value + half,
            }
        };
        elapsed.iter().enumerate().map(forecasted).collect()
    }
}

/// Change of a signal: its first sample to the mean of its last five.
fn change(values: &[f64]) -> f64 {
    mean(&values[values.len().saturating_sub(5)..]) - values[0]
}

/// Weights from all trials but one.
fn weighted(trials: &[Trial], count: usize, left_out: Option<usize>) -> Vec<f64> {
    let mut products = vec![0.0; count * count];
    for (_, trial) in trials.iter().enumerate().filter(|(index, _)| Some(*index) != left_out) {
        for i in 0..count {
            for j in 0..=i {
                let errors = trial.errors[i].iter().zip(&trial.errors[j]).zip(&trial.nodes);
                let product: f64 = errors.map(|((one, other), (weight, _))| weight * one * other).sum();
                products[i * count + j] += trial.importance * product;
            }
        }
    }
    for i in 0..count {
        for j in 0..i {
            products[j * count + i] = products[i * count + j];
        }
    }
    stacked(&products, count)
}

/// What the members fitted to a share of the hold predict of the next; `None` where there is too little of either.
fn trial(
    samples: &Samples<'_>,
    members: &[ForecastMember],
    options: &LawOptions,
    (share, importance): (f64, f64),
    next: &mut impl FnMut() -> Result<(), Cancelled>,
) -> Result<Option<Trial>, Cancelled> {
    let (times, values) = (samples.times, samples.values);
    let start = times[0];
    let cut = share * (times[times.len() - 1] - start);
    let first = times.partition_point(|t| t - start <= cut);
    let until = times.partition_point(|t| t - start <= HORIZON * cut);
    if first < FEWEST.0 || until < first + FEWEST.1 {
        return Ok(None);
    }
    let fitted = Samples {
        times: &times[..first],
        values: &values[..first],
        standard_deviations: samples.standard_deviations.map(|standard_deviations| &standard_deviations[..first]),
    };
    let change = change(fitted.values).abs();
    if change <= 0.0 {
        return Ok(None);
    }
    let elapsed: Vec<f64> = times[first..until].iter().map(|t| t - start).collect();
    let rest = Condensed::finer(&elapsed, &values[first..until]);
    let total: f64 = rest.roots.iter().map(|root| root * root).sum();
    let nodes = rest.times.iter().zip(&rest.roots).map(|(t, root)| (root * root / total, (t / cut).ln() + AT_ONCE));
    let errors = members.iter().map(|member| {
        next()?;
        let off = |predicted: Vec<f64>| -> Vec<f64> {
            let found = rest.values.iter().zip(&rest.roots).map(|(value, root)| value / root);
            predicted.iter().zip(found).map(|(predicted, found)| (predicted - found) / change).collect()
        };
        let course = Course::of(*member, &fitted, options).map(|course| off(course.at(&rest.times, options)));
        // One that cannot be fitted to so little is as far off as all that has changed.
        let usable = course.ok().filter(|errors| errors.iter().all(|error| error.is_finite()));
        Ok(usable.unwrap_or_else(|| vec![1.0; rest.times.len()]))
    });
    Ok(Some(Trial {
        importance,
        nodes: nodes.collect(),
        errors: errors.collect::<Result<_, Cancelled>>()?,
    }))
}
