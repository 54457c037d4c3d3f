//! What laws have predicted of holds: each was fitted to first parts of a hold and held against what followed.

use super::change;
use super::member::{Course, ForecastMember, members};
use crate::fit::{Condensed, FitError, LawOptions, Samples};
use crate::laws::Law;
use crate::watch::{Cancelled, Progress, Watch};

/// Shares of the hold that members are fitted to, and how much what they predict counts.
const CUTS: [(f64, f64); 5] = [(0.25, 0.3), (0.35, 0.5), (0.5, 1.0), (0.65, 1.5), (0.8, 2.0)];

/// How many times the duration of a first part is predicted from it.
const HORIZON: f64 = 3.0;

/// Fewest samples in a first part, and behind it.
const FEWEST: (usize, usize) = (8, 3);

/// Errors grow with ln(t/T) + this.
pub(super) const AT_ONCE: f64 = 0.1;

/// How many times as long as a hold another has to be, to tell what follows after the same time.
const LONGER: f64 = 1.5;

/// Most other holds: the nearest in the order of the record.
const MOST: usize = 24;

/// What was predicted from the first part of a hold, and came otherwise.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    pub(super) importance: f64,
    /// Weights of the nodes, which sum to 1, and ln(t/c) + 0.1 there.
    pub(super) nodes: Vec<(f64, f64)>,
    /// Errors of the members at the nodes as shares of the change until the cut.
    pub(super) errors: Vec<Vec<f64>>,
    /// Mean products of the errors of two members, row by row.
    products: Vec<f64>,
}

/// A hold with what laws fitted to its first parts have predicted of the rest.
#[derive(Debug, Clone)]
pub struct TriedHold<'a> {
    pub(super) samples: Samples<'a>,
    pub(super) options: LawOptions,
    pub(super) members: Vec<ForecastMember>,
    pub(super) trials: Vec<Trial>,
}

impl<'a> TriedHold<'a> {
    /// Fits laws to first parts of a hold, and holds them against the rest.
    ///
    /// # Errors
    /// [`FitError`] for samples that no law can be fitted to, and [`FitError::Cancelled`].
    pub fn of(
        samples: Samples<'a>,
        laws: &[Law],
        options: &LawOptions,
        watch: &mut dyn Watch,
    ) -> Result<Self, FitError> {
        samples.check(1)?;
        let duration = samples.times[samples.times.len() - 1] - samples.times[0];
        let mut tried = Self {
            samples,
            options: options.clone(),
            members: members(laws),
            trials: Vec::with_capacity(CUTS.len()),
        };
        for (number, (share, importance)) in CUTS.into_iter().enumerate() {
            let mut next = || watch.report(Progress::counted("forecasting", number, CUTS.len()));
            let found = tried.trial(share * duration, importance, &mut next)?;
            tried.trials.extend(found);
        }
        Ok(tried)
    }

    pub(super) fn duration(&self) -> f64 {
        let times = self.samples.times;
        times[times.len() - 1] - times[0]
    }

    /// What the members fitted up to a time, s, predict of the next; `None` where there is too little of either.
    fn trial(
        &self,
        cut: f64,
        importance: f64,
        next: &mut dyn FnMut() -> Result<(), Cancelled>,
    ) -> Result<Option<Trial>, Cancelled> {
        let Samples {
            times,
            values,
            standard_deviations,
        } = self.samples;
        let start = times[0];
        let first = times.partition_point(|t| t - start <= cut);
        let until = times.partition_point(|t| t - start <= HORIZON * cut);
        if first < FEWEST.0 || until < first + FEWEST.1 {
            return Ok(None);
        }
        let fitted = Samples {
            times: &times[..first],
            values: &values[..first],
            standard_deviations: standard_deviations.map(|standard_deviations| &standard_deviations[..first]),
        };
        let change = change(fitted.values).abs();
        if change <= 0.0 {
            return Ok(None);
        }
        let elapsed: Vec<f64> = times[first..until].iter().map(|t| t - start).collect();
        let rest = Condensed::finer(&elapsed, &values[first..until]);
        let total: f64 = rest.roots.iter().map(|root| root * root).sum();
        let nodes = rest.times.iter().zip(&rest.roots);
        let nodes = nodes.map(|(t, root)| (root * root / total, (t / cut).ln() + AT_ONCE)).collect();
        let errors = self.members.iter().map(|member| {
            next()?;
            let off = |predicted: Vec<f64>| -> Vec<f64> {
                let found = rest.values.iter().zip(&rest.roots).map(|(value, root)| value / root);
                predicted.iter().zip(found).map(|(predicted, found)| (predicted - found) / change).collect()
            };
            let course = Course::of(*member, &fitted, &self.options);
            let errors = course.map(|course| off(course.at(&rest.times, &self.options)));
            // One that cannot be fitted to so little is as far off as all that has changed.
            let usable = errors.ok().filter(|errors| errors.iter().all(|error| error.is_finite()));
            Ok(usable.unwrap_or_else(|| vec![1.0; rest.times.len()]))
        });
        Ok(Some(Trial::new(importance, nodes, errors.collect::<Result<_, Cancelled>>()?)))
    }

    /// Other holds that tell something of this one, the nearest first: of the same members, with a signal that goes the same way.
    pub(super) fn alike<'b>(&self, others: &[&'b TriedHold<'b>]) -> Vec<&'b TriedHold<'b>> {
        let direction = change(self.samples.values).signum();
        let is_alike = |other: &&&TriedHold<'_>| {
            let same = other.members == self.members && change(other.samples.values).signum() == direction;
            same && !other.trials.is_empty()
        };
        others.iter().filter(is_alike).take(MOST).copied().collect()
    }

    /// What was predicted of another hold, where it is longer, from a first part as long as this hold.
    pub(super) fn as_long(
        &self,
        other: &TriedHold<'_>,
        next: &mut dyn FnMut() -> Result<(), Cancelled>,
    ) -> Result<Option<Trial>, Cancelled> {
        match other.duration() >= LONGER * self.duration() {
            true => other.trial(self.duration(), 1.0, next),
            false => Ok(None),
        }
    }
}

impl Trial {
    fn new(importance: f64, nodes: Vec<(f64, f64)>, errors: Vec<Vec<f64>>) -> Self {
        let mut products = Vec::with_capacity(errors.len() * errors.len());
        for one in &errors {
            products.extend(errors.iter().map(|other| -> f64 {
                let nodes = one.iter().zip(other).zip(&nodes);
                nodes.map(|((one, other), (weight, _))| weight * one * other).sum()
            }));
        }
        Self {
            importance,
            nodes,
            errors,
            products,
        }
    }

    /// Mean product of the errors of two members.
    pub(super) fn product(&self, one: usize, other: usize) -> f64 {
        self.products[one * self.errors.len() + other]
    }
}
