//! What laws have predicted of holds: each was fitted to first parts of a hold and held against what followed.

use super::change;
use super::member::{Course, ForecastMember, members};
use crate::fit::{Condensed, FitError, LawOptions, Samples, until};
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
pub(super) const LONGER: f64 = 1.5;

/// Most other holds: the nearest in the order of the record.
const MOST: usize = 24;

/// What was predicted from the first part of a hold, and came otherwise.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    /// Time since the first sample up to which was fitted, s.
    pub(super) cut: f64,
    pub(super) importance: f64,
    /// Times of the nodes since the first sample, s.
    pub(super) times: Vec<f64>,
    values: Vec<f64>,
    /// Change until the cut.
    change: f64,
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

    /// Number of samples up to a time since the first, s.
    fn until(&self, elapsed: f64) -> usize {
        until(self.samples.times, elapsed)
    }

    /// The samples up to a time since the first, s.
    pub(super) fn first_part(&self, elapsed: f64) -> Samples<'a> {
        let until = self.until(elapsed);
        Samples {
            times: &self.samples.times[..until],
            values: &self.samples.values[..until],
            standard_deviations: self.samples.standard_deviations.map(|all| &all[..until]),
        }
    }

    /// What the members fitted up to a time, s, predict of the next; `None` where there is too little of either.
    fn trial(
        &self,
        cut: f64,
        importance: f64,
        next: &mut dyn FnMut() -> Result<(), Cancelled>,
    ) -> Result<Option<Trial>, Cancelled> {
        let (times, values) = (self.samples.times, self.samples.values);
        let (first, until) = (self.until(cut), self.until(HORIZON * cut));
        if first < FEWEST.0 || until < first + FEWEST.1 {
            return Ok(None);
        }
        let fitted = self.first_part(cut);
        let change = change(fitted.values).abs();
        if change <= 0.0 {
            return Ok(None);
        }
        let elapsed: Vec<f64> = times[first..until].iter().map(|t| t - times[0]).collect();
        let rest = Condensed::finer(&elapsed, &values[first..until]);
        let total: f64 = rest.roots.iter().map(|root| root * root).sum();
        let nodes = rest.times.iter().zip(&rest.roots);
        let trial = Trial {
            cut,
            importance,
            nodes: nodes.map(|(t, root)| (root * root / total, (t / cut).ln() + AT_ONCE)).collect(),
            values: rest.values.iter().zip(&rest.roots).map(|(value, root)| value / root).collect(),
            times: rest.times,
            change,
            errors: Vec::new(),
            products: Vec::new(),
        };
        let predicted = self.members.iter().map(|member| {
            next()?;
            let course = Course::of(*member, &fitted, &self.options).ok();
            Ok(course.map(|course| course.at(&trial.times, &self.options)))
        });
        let predicted: Vec<_> = predicted.collect::<Result<_, Cancelled>>()?;
        Ok(Some(trial.with(predicted)))
    }

    /// Other holds that tell something of this one, the nearest first: of the same members, with a signal that goes the same way.
    pub(super) fn alike<'b>(&self, others: &[&'b TriedHold<'b>]) -> Vec<&'b TriedHold<'b>> {
        let duration = self.duration();
        // A longer hold may turn around later.
        let direction = |hold: &TriedHold<'_>| change(&hold.samples.values[..hold.until(duration)]).signum();
        let is_alike = |other: &&&TriedHold<'_>| {
            let same = other.members == self.members && direction(other) == direction(self);
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
    /// The trial with further members, by what they predict at its nodes. One that cannot be fitted to so little is as far off as all that
    /// has changed.
    pub(super) fn with(&self, predicted: impl IntoIterator<Item = Option<Vec<f64>>>) -> Self {
        let off = |predicted: Vec<f64>| -> Vec<f64> {
            predicted
                .iter()
                .zip(&self.values)
                .map(|(predicted, found)| (predicted - found) / self.change)
                .collect()
        };
        let usable = |errors: &Vec<f64>| errors.iter().all(|error| error.is_finite());
        let errors = predicted.into_iter().map(|predicted| predicted.map(off).filter(usable));
        let errors = errors.map(|errors| errors.unwrap_or_else(|| vec![1.0; self.times.len()]));
        let errors: Vec<Vec<f64>> = self.errors.iter().cloned().chain(errors).collect();
        let mut products = Vec::with_capacity(errors.len() * errors.len());
        for one in &errors {
            products.extend(errors.iter().map(|other| -> f64 {
                let nodes = one.iter().zip(other).zip(&self.nodes);
                nodes.map(|((one, other), (weight, _))| weight * one * other).sum()
            }));
        }
        Self {
            errors,
            products,
            ..self.clone()
        }
    }

    /// Mean product of the errors of two members.
    pub(super) fn product(&self, one: usize, other: usize) -> f64 {
        self.products[one * self.errors.len() + other]
    }
}
