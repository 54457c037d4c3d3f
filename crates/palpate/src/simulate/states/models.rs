//! Bodies and laws of many contacts.

use std::ops::Range;

use smallvec::SmallVec;

use super::latency::LatencyModels;
use super::linear::LinearModels;
use super::parameters::{ContactModelsError, ContactParameter, Parameters};
use super::part::{ContactsStep, Imposed, OneStepError, Part, Refusal, is_spread, spread};
use crate::contact::RateDependence;
use crate::parallel::Threads;
use crate::simulate::{Contact, ContactModel};
use crate::vector::LANES;

/// Bodies and laws of contacts that are moved together: one for all contacts, or one each.
///
/// The states are in memory of the caller, row by row: `states[row * count + index]`. Zeros are untouched contacts. Those of the latency law
/// have two rows, one contact's share of the displacement of the jaw (m), and the displacement of the node behind the contact layer (m);
/// those of a linear law have the former and an excess for every term of its relaxation function, strains or newtons by its
/// [`Memory`](crate::simulate::Memory).
///
/// ```
/// use palpate::simulate::{ContactModels, ContactParameter, ContactsStep, Imposed, Refusal, Separation};
/// use palpate::test_problems::paper_ball;
///
/// let models = ContactModels::alike(paper_ball(Separation::Unilateral));
/// let models = models.with(ContactParameter::Modulus, &[28e3, 14e3, 28e3])?;
/// let (mut states, mut forces, mut failed) = (vec![0.0; 2 * 3], [0.0; 3], [false; 3]);
/// let step = ContactsStep {
///     imposed: Imposed::Displacement,
///     dt: &[0.6],
///     to: &[5e-3, 5e-3, f64::NAN],
///     substeps: 600,
///     refusal: Refusal::Masked,
/// };
/// assert_eq!(models.step(&mut states, &step, &mut forces, &mut failed)?, 1);
/// assert_eq!(failed, [false, false, true]);
/// // 3.035 025 N at the end of the paper's ramp; second order in dt
/// assert!((forces[0] - 3.035_025).abs() < 1e-3 && (forces[1] - 0.5 * forces[0]).abs() < 1e-12 && forces[2] == 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ContactModels {
    pub(super) law: Law,
    /// Whether a displacement that passes the checks may still fail.
    is_extreme: bool,
}

/// Numbers of states that are copied sooner than they are checked.
const FEW: usize = 32;

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Law {
    Latency(LatencyModels),
    Linear(LinearModels),
}

impl ContactModels {
    /// One model for any number of contacts.
    #[must_use]
    pub fn alike(model: ContactModel) -> Self {
        Self::of_each(vec![model])
    }

    /// One model each.
    #[must_use]
    pub fn of_each(models: Vec<ContactModel>) -> Self {
        Self::of_law(Law::Latency(LatencyModels::new(models)))
    }

    /// Contacts under any law that can be stepped: one for all, or one each.
    ///
    /// # Errors
    /// [`ContactModelsError`] for no contact, for latency and linear laws side by side, and for a rate coefficient that varies.
    pub fn new(contacts: Vec<Contact>) -> Result<Self, ContactModelsError> {
        let (mut latency, mut linear) = (Vec::new(), Vec::new());
        for (index, contact) in contacts.into_iter().enumerate() {
            match contact {
                Contact::Latency {
                    model,
                    rate: RateDependence::Constant,
                } => latency.push(model),
                Contact::Latency { .. } => return Err(ContactModelsError::RateDependence { index }),
                Contact::Linear(contact) => linear.push(contact),
            }
            if !latency.is_empty() && !linear.is_empty() {
                return Err(ContactModelsError::Mixed { index });
            }
        }
        match (latency.is_empty(), linear.is_empty()) {
            (true, true) => Err(ContactModelsError::Empty),
            (false, _) => Ok(Self::of_each(latency)),
            (true, false) => Ok(Self::of_law(Law::Linear(LinearModels::new(linear)))),
        }
    }

    fn of_law(law: Law) -> Self {
        let is_extreme = match &law {
            Law::Latency(models) => (0..models.models()).any(|index| models.is_extreme(index)),
            Law::Linear(models) => (0..models.models()).any(|index| models.is_extreme(index)),
        };
        Self { law, is_extreme }
    }

    /// With a value of a parameter for every contact, in the place of that of the one model.
    ///
    /// # Errors
    /// [`ContactModelsError`] for a parameter that body or law do not have, values that are none of it, another number of values than those of
    /// another parameter, and contacts of a model each.
    pub fn with(mut self, parameter: ContactParameter, values: &[f64]) -> Result<Self, ContactModelsError> {
        let (name, found) = (parameter.name(), values.len());
        if found == 0 {
            return Err(ContactModelsError::Empty);
        }
        if let Some(expected) = self.parameters_of().count().filter(|expected| *expected != found) {
            return Err(ContactModelsError::Count { name, expected, found });
        }
        self.replace(&[(parameter, values)], &vec![true; found])?;
        Ok(self)
    }

    /// Puts values of parameters in the place of those of the contacts that `mask` marks: one value for all contacts, or one each, of which those of
    /// the others are left aside. All are replaced, or none.
    ///
    /// # Errors
    /// As for [`with`](Self::with).
    pub fn replace(&mut self, values: &[(ContactParameter, &[f64])], mask: &[bool]) -> Result<(), ContactModelsError> {
        let (models, count) = (self.models(), mask.len());
        for (parameter, values) in values {
            let (name, found) = (parameter.name(), values.len());
            if models != 1 {
                return Err(ContactModelsError::SeveralModels { name, models });
            }
            if self.value(*parameter).is_none() {
                return Err(ContactModelsError::NoSuchParameter { name });
            }
            if found != 1 && found != count || self.count().is_some_and(|expected| expected != count) {
                let expected = self.count().unwrap_or(count);
                return Err(ContactModelsError::Count { name, expected, found });
            }
        }
        for index in (0..count).filter(|index| mask[*index]) {
            let new = |parameter| {
                let column = values.iter().find(|(found, _)| *found == parameter);
                column.map(|(_, values)| values[index.min(values.len() - 1)])
            };
            let value = |parameter| new(parameter).or_else(|| self.parameters_of().value(parameter, index));
            let fault = match &self.law {
                Law::Latency(models) => models.fault(&value),
                Law::Linear(models) => models.fault(&value),
            };
            if let Some(problem) = fault {
                // The one that is given last may be wrong beside the others.
                let name = values.iter().map(|(parameter, _)| parameter.name()).next_back().unwrap_or_default();
                return Err(ContactModelsError::Value { name, index, problem });
            }
        }
        match &mut self.law {
            Law::Latency(models) => models.replace(values, mask),
            Law::Linear(models) => models.replace(values, mask),
        }
        self.is_extreme |= (0..count).filter(|index| mask[*index]).any(|index| match &self.law {
            Law::Latency(models) => models.is_extreme(index),
            Law::Linear(models) => models.is_extreme(index),
        });
        Ok(())
    }

    /// Number of models.
    fn models(&self) -> usize {
        match &self.law {
            Law::Latency(models) => models.models(),
            Law::Linear(models) => models.models(),
        }
    }

    /// The value of a parameter of the one model, if it has that.
    fn value(&self, parameter: ContactParameter) -> Option<f64> {
        match &self.law {
            Law::Latency(models) => models.value(parameter),
            Law::Linear(models) => models.value(parameter),
        }
    }

    fn parameters_of(&self) -> &Parameters {
        match &self.law {
            Law::Latency(models) => models.parameters(),
            Law::Linear(models) => models.parameters(),
        }
    }

    /// The parameters that each contact has a value of, with the values.
    pub fn parameters(&self) -> impl Iterator<Item = (ContactParameter, &[f64])> {
        self.parameters_of().columns()
    }

    /// Number of contacts, where each has a model or a value of its own.
    #[must_use]
    pub fn count(&self) -> Option<usize> {
        let models = self.models();
        self.parameters_of().count().or((models != 1).then_some(models))
    }

    /// Numbers of a state.
    #[must_use]
    pub fn rows(&self) -> usize {
        match &self.law {
            Law::Latency(_) => 2,
            Law::Linear(models) => 1 + models.terms(),
        }
    }

    /// Whether a step of so many contacts may be spread over cores.
    #[must_use]
    pub fn is_spread(count: usize, imposed: Imposed) -> bool {
        is_spread(count, imposed == Imposed::Force)
    }

    /// Steps all contacts in place, on all cores where there are thousands, to the same bits on any number of them; returns how many failed.
    ///
    /// `results` gets forces (N) of imposed displacements, and displacements of the jaws (m) of imposed forces. With [`Refusal::Masked`]
    /// a contact that cannot take the step, or whose state is not finite, keeps its state, `failed` marks it, and its result is the force,
    /// or the displacement, before the step (0 where its state has none). Substeps go to the target along a straight line.
    ///
    /// # Errors
    /// [`OneStepError`] for the first contact that cannot take the step, with [`Refusal::All`]; all states and results are as before.
    ///
    /// # Panics
    /// If the lengths do not agree: as many `results` and `failed` as contacts, [`rows`](Self::rows) times as many `states`, and one time step
    /// and target or as many as contacts.
    pub fn step(
        &self,
        states: &mut [f64],
        step: &ContactsStep<'_>,
        results: &mut [f64],
        failed: &mut [bool],
    ) -> Result<usize, OneStepError> {
        self.step_by(Threads::default(), step, (states, results, failed))
    }

    /// As [`step`](Self::step) on the calling thread and those of a pool.
    ///
    /// `are_awake` says whether they have worked within the last ten microseconds: then some thousands of contacts are worth one of them, else some
    /// ten thousands.
    ///
    /// # Errors
    /// As for [`step`](Self::step).
    ///
    /// # Panics
    /// As for [`step`](Self::step).
    #[cfg(feature = "rayon")]
    pub fn step_on(
        &self,
        pool: &rayon::ThreadPool,
        are_awake: bool,
        states: &mut [f64],
        step: &ContactsStep<'_>,
        results: &mut [f64],
        failed: &mut [bool],
    ) -> Result<usize, OneStepError> {
        let threads = Threads {
            pool: Some(pool),
            are_awake,
        };
        self.step_by(threads, step, (states, results, failed))
    }

    fn step_by(
        &self,
        threads: Threads<'_>,
        step: &ContactsStep<'_>,
        (states, results, failed): (&mut [f64], &mut [f64], &mut [bool]),
    ) -> Result<usize, OneStepError> {
        let keep = |numbers: &[f64]| SmallVec::<[f64; FEW]>::from_slice(numbers);
        let mut kept = None;
        if step.refusal == Refusal::All {
            failed.fill(false);
            if states.len() <= FEW || step.imposed == Imposed::Force || self.is_extreme {
                // Sooner than a check, or what cannot be known beforehand.
                kept = Some((keep(states), keep(results)));
            } else {
                self.check(threads, step, (states, results, failed))?;
            }
        }
        let stepped = self.step_range_by(threads, 0..results.len(), step, (states, results, failed));
        if let (Err(_), Some((old_states, old_results))) = (&stepped, kept) {
            states.copy_from_slice(&old_states);
            results.copy_from_slice(&old_results);
        }
        stepped
    }

    /// Steps the contacts of a range alone, as [`step`](Self::step) does all of them: of millions it takes a while.
    ///
    /// # Errors
    /// [`OneStepError`] with [`Refusal::All`] for the first contact of the range that cannot take the step; others may have taken it.
    ///
    /// # Panics
    /// As for [`step`](Self::step), and for a range beyond the contacts or one that does not begin at a multiple of 8.
    pub fn step_range(
        &self,
        range: Range<usize>,
        states: &mut [f64],
        step: &ContactsStep<'_>,
        results: &mut [f64],
        failed: &mut [bool],
    ) -> Result<usize, OneStepError> {
        self.step_range_by(Threads::default(), range, step, (states, results, failed))
    }

    fn step_range_by(
        &self,
        threads: Threads<'_>,
        range: Range<usize>,
        step: &ContactsStep<'_>,
        (states, results, failed): (&mut [f64], &mut [f64], &mut [bool]),
    ) -> Result<usize, OneStepError> {
        self.assert_lengths(states, step, (results.len(), failed.len()));
        assert!(range.start.is_multiple_of(LANES), "a range begins at a multiple of {LANES}");
        let part = Part::of(range, states, results, failed);
        spread(threads, part, step.imposed == Imposed::Force, &|part| match &self.law {
            Law::Latency(models) => models.step(part, step),
            Law::Linear(models) => models.step(part, step),
        })
    }

    /// Checks that all contacts can take a step of their displacements.
    fn check(
        &self,
        threads: Threads<'_>,
        step: &ContactsStep<'_>,
        (states, results, failed): (&mut [f64], &mut [f64], &mut [bool]),
    ) -> Result<(), OneStepError> {
        self.assert_lengths(states, step, (results.len(), failed.len()));
        let part = Part::of(0..results.len(), states, results, failed);
        let check = |part: Part<'_>| match &self.law {
            Law::Latency(models) => models.check(&part, step).map(|()| 0),
            Law::Linear(models) => models.check(&part, step).map(|()| 0),
        };
        spread(threads, part, false, &check).map(|_| ())
    }

    fn assert_lengths(&self, states: &[f64], step: &ContactsStep<'_>, (count, failed): (usize, usize)) {
        assert!(self.count().is_none_or(|models| models == count), "one model, or one a contact");
        assert!(states.len() == self.rows() * count && failed == count, "a state, a result and a mark a contact");
        let fits = |values: &[f64]| values.len() == 1 || values.len() == count;
        assert!(fits(step.dt) && fits(step.to), "one number, or one a contact");
    }
}
