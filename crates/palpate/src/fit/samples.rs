//! The samples of a hold, checked and brought to units in which every hold looks alike.

use super::error::FitError;
use super::levels::step_between_levels;
use crate::optimise::Target;
use crate::vector::{all_finite, extremes, multiply, rises, shifted};

/// A hold to be fitted: times in s, values in their unit, and how far each may be off.
///
/// Times rise strictly; the first is the zero of the law. Standard deviations weigh samples by their inverse square; only
/// their ratios matter for the estimates, an infinite one leaves its sample out.
///
/// ```
/// use palpate::fit::{Samples, fit_law, LawOptions};
/// use palpate::laws::Law;
/// let times: Vec<f64> = (0..50).map(f64::from).collect();
/// let values: Vec<f64> = times.iter().map(|t| 2.0 + 3.0 * (-t / 8.0).exp()).collect();
/// let fit = fit_law(&Samples::new(&times, &values), Law::StandardLinearSolid, &LawOptions::default())?;
/// assert!((fit.value("time_constant_s").unwrap() - 8.0).abs() < 1e-9);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Samples<'a> {
    /// Times, s.
    pub times: &'a [f64],
    /// Values.
    pub values: &'a [f64],
    /// Their standard deviations, if they differ.
    pub standard_deviations: Option<&'a [f64]>,
}

impl<'a> Samples<'a> {
    /// Samples of equal weight.
    #[must_use]
    pub fn new(times: &'a [f64], values: &'a [f64]) -> Self {
        Self {
            times,
            values,
            standard_deviations: None,
        }
    }

    /// The same with a standard deviation for each.
    #[must_use]
    pub fn with_standard_deviations(self, standard_deviations: &'a [f64]) -> Self {
        Self {
            standard_deviations: Some(standard_deviations),
            ..self
        }
    }

    /// Whether a law with so many parameters can be fitted to these samples at all.
    pub(crate) fn check(&self, parameters: usize) -> Result<(), FitError> {
        FitError::check_lengths(self.times.len(), self.values.len())?;
        FitError::check_lengths(self.times.len(), self.standard_deviations.map_or(self.times.len(), <[f64]>::len))?;
        let standard_deviations = self.standard_deviations.unwrap_or(&[]);
        if let Some(index) = standard_deviations.iter().position(|deviation| deviation.is_nan() || *deviation <= 0.0) {
            return Err(FitError::StandardDeviation {
                index,
                found: standard_deviations[index],
            });
        }
        let found = match self.standard_deviations {
            Some(standard_deviations) => standard_deviations.iter().filter(|deviation| deviation.is_finite()).count(),
            None => self.times.len(),
        };
        FitError::check_samples(parameters, found)?;
        if all_finite(self.times) && all_finite(self.values) && rises(self.times) {
            return Ok(());
        }
        check_finite([("time", self.times), ("value", self.values)])?;
        let rising = self.times.windows(2).take_while(|pair| pair[0] < pair[1]).count();
        Err(FitError::TimeNotRising { index: rising + 1 })
    }

    /// Square roots of the weights over their root mean square, `None` if all are alike; and that root mean square of 1/σ.
    pub(crate) fn roots(&self) -> (Option<Vec<f64>>, f64) {
        self.standard_deviations.map_or((None, 1.0), |standard_deviations| {
            let (roots, precision) = roots_of(standard_deviations);
            let differ = standard_deviations.iter().any(|deviation| *deviation != standard_deviations[0]);
            (Some(roots).filter(|_| differ), precision)
        })
    }

    /// These without the samples that may be off by anything, which say nothing; `None` if there is no such sample.
    fn certain(&self) -> Option<[Vec<f64>; 3]> {
        let standard_deviations =
            self.standard_deviations.filter(|standard_deviations| !all_finite(standard_deviations))?;
        let counts = |i: &usize| standard_deviations[*i].is_finite();
        let kept = |column: &[f64]| (0..column.len()).filter(counts).map(|i| column[i]).collect();
        Some([self.times, self.values, standard_deviations].map(kept))
    }
}

/// A hold in units of its own duration and range.
#[derive(Debug, Clone)]
pub(crate) struct Scaled {
    pub(crate) times: Vec<f64>,
    /// (y − center)/range, times `roots`.
    pub(crate) values: Vec<f64>,
    /// Square roots of the weights, one at the root mean square; `None` if all are alike.
    pub(crate) roots: Option<Vec<f64>>,
    /// Root mean square of 1/σ: what the roots were divided by; 1 without standard deviations.
    pub(crate) precision: f64,
    /// Time of the first sample, s.
    pub(crate) start: f64,
    pub(crate) duration: f64,
    pub(crate) center: f64,
    pub(crate) range: f64,
    /// The step of values that were rounded to few levels, over the range; 0 where there is none.
    pub(crate) step: f64,
}

impl Scaled {
    /// Scales checked samples; `constant` is the constant of the law if it is given.
    pub(crate) fn new(samples: &Samples<'_>, constant: Option<f64>) -> Result<Self, FitError> {
        // Of a sample that says nothing only its time counts, if it is the first or the last.
        let start = samples.times[0];
        let duration = samples.times[samples.times.len() - 1] - start;
        let certain = samples.certain();
        let samples = certain.as_ref().map_or(*samples, |[times, values, standard_deviations]| {
            Samples::new(times, values).with_standard_deviations(standard_deviations)
        });
        let (times, values) = (samples.times, samples.values);
        let (low, high) = extremes(values);
        FitError::check_change(low, high, values.len())?;
        let center = constant.unwrap_or(low + 0.5 * (high - low));
        let range = if constant.is_some() { (high - center).abs().max((low - center).abs()) } else { high - low };
        let first = times.iter().map(|t| (t - start) / duration).find(|t| *t > 0.0).unwrap_or(1.0);
        let invertible = |span: f64| span.is_finite() && (1.0 / span).is_finite();
        if !(invertible(range) && invertible(duration) && first > f64::MIN_POSITIVE * 1e6) {
            return Err(FitError::OutOfRange);
        }
        let per_duration = 1.0 / duration;
        let (roots, precision) = samples.roots();
        let mut scaled = Self {
            times: shifted(times, start, per_duration),
            values: Vec::new(),
            roots,
            precision,
            start,
            duration,
            center,
            range,
            step: step_between_levels(values) / range,
        };
        scaled.values = scaled.in_units(values);
        Ok(scaled)
    }

    /// Other values of the same samples, in the units of these.
    pub(crate) fn of(&self, samples: &Samples<'_>) -> Self {
        let certain = samples.certain();
        let values = certain.as_ref().map_or(samples.values, |[_, values, _]| values);
        Self {
            values: self.in_units(values),
            step: step_between_levels(values) / self.range,
            ..self.clone()
        }
    }

    fn in_units(&self, values: &[f64]) -> Vec<f64> {
        let mut scaled = shifted(values, self.center, 1.0 / self.range);
        if let Some(roots) = &self.roots {
            multiply(&mut scaled, roots);
        }
        scaled
    }

    pub(crate) fn target(&self) -> Target<'_> {
        Target::new(&self.values, self.roots.as_deref())
    }

    /// ln λ, in the units of the fit, from the slowest to the fastest rate that such a hold can show: 10⁻³ per duration to
    /// 10³ per first sample step.
    pub(crate) fn log_rates(&self) -> (f64, f64) {
        let first = self.times.iter().copied().find(|t| *t > 0.0).unwrap_or(1.0);
        (1e-3f64.ln(), (1e3 / first).ln())
    }
}

/// Refuses the first sample of which a parameter is none.
pub(crate) fn check_finite(columns: [(&'static str, &[f64]); 2]) -> Result<(), FitError> {
    let first = |(what, column): (&'static str, &[f64])| {
        let index = column.iter().position(|value| !value.is_finite())?;
        let found = column[index];
        Some((index, FitError::NotFinite { index, what, found }))
    };
    let found = columns.into_iter().filter_map(first).min_by_key(|(index, _)| *index);
    found.map_or(Ok(()), |(_, error)| Err(error))
}

/// A time that is a share of another is off by less than this of itself, whatever the unit of time and the first sample.
const ROUNDING: f64 = 1e-6;

/// Number of times up to one since the first; one at that very time is among them, however it is rounded.
pub(crate) fn until(times: &[f64], elapsed: f64) -> usize {
    times.partition_point(|t| t - times[0] <= elapsed * (1.0 + ROUNDING))
}

/// Number of times before one since the first; one at that very time is not among them, however it is rounded.
pub(crate) fn before(times: &[f64], elapsed: f64) -> usize {
    times.partition_point(|t| t - times[0] < elapsed * (1.0 - ROUNDING))
}

/// 1/σ over its root mean square, and that, with care for σ near the limits of double precision.
fn roots_of(standard_deviations: &[f64]) -> (Vec<f64>, f64) {
    let least = standard_deviations.iter().copied().fold(f64::INFINITY, f64::min);
    let mut roots: Vec<f64> = standard_deviations.iter().map(|deviation| least / deviation).collect();
    let mean_square = roots.iter().map(|root| root * root).sum::<f64>() / roots.len() as f64;
    let size = mean_square.sqrt();
    roots.iter_mut().for_each(|root| *root /= size);
    (roots, size / least)
}
