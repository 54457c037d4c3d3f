//! Many contacts of linear laws: side by side in vectors where they stay in contact, one by one elsewhere.

use std::borrow::Cow;
use std::mem;

use smallvec::SmallVec;

use super::alone::{check_result, check_state, finite, kept};
use super::block::{Marks, between, is_extreme, is_step};
use super::lanes::{Column, Lanes, lanes, store};
use super::linear_block::{Fadings, LinearBlock, Moving};
use super::parameters::{ContactParameter, Parameters, Value, ValueProblem, of_specimen, own_contact, renew};
use super::part::{ContactsStep, Imposed, OneStepError, Part, Refusal};
use crate::simulate::linear::{LinearStepper, Memories};
use crate::simulate::step::check_step;
use crate::simulate::{LinearContact, StepError};
use crate::vector::{LANES, accelerated};

/// Contacts of linear laws.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LinearModels {
    /// One for all contacts, or one each.
    steppers: Vec<LinearStepper>,
    /// Their numbers, with those parameters: one block for all contacts, or one for as many as go side by side.
    blocks: Vec<LinearBlock>,
    /// Terms of the law that has most.
    terms: usize,
    parameters: Parameters,
}

impl LinearModels {
    /// Of one contact for all, or of one each.
    pub(super) fn new(contacts: Vec<LinearContact>) -> Self {
        let terms = contacts.iter().map(|contact| contact.law.terms().len()).max().unwrap_or(0);
        let steppers: Vec<_> = contacts.into_iter().map(LinearStepper::new).collect();
        Self {
            blocks: steppers.chunks(LANES).map(|some| LinearBlock::new(some, terms)).collect(),
            steppers,
            terms,
            parameters: Parameters::default(),
        }
    }

    /// Number of models.
    pub(super) fn models(&self) -> usize {
        self.steppers.len()
    }

    /// Numbers of a state beside the position of the jaw.
    pub(super) fn terms(&self) -> usize {
        self.terms
    }

    pub(super) fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The value of a parameter of the one contact.
    pub(super) fn value(&self, parameter: ContactParameter) -> Option<f64> {
        of_specimen(parameter, &self.steppers[0].contact().specimen)
    }

    /// Why a contact with values of its own is none.
    pub(super) fn fault(&self, value: Value<'_>) -> Option<ValueProblem> {
        own_contact(self.steppers[0].contact(), value).err()
    }

    /// Puts values of parameters in the place of those of the contacts that `mask` marks; see [`Parameters::replace`].
    pub(super) fn replace(&mut self, values: &[(ContactParameter, &[f64])], mask: &[bool]) {
        for (parameter, values) in values {
            let base = self.value(*parameter).unwrap_or_default();
            self.parameters.replace(*parameter, base, values, mask);
        }
        let mut blocks = mem::take(&mut self.blocks);
        renew(&mut blocks, mask, |some| {
            let steppers: Vec<_> = some.map(|index| self.stepper(index).into_owned()).collect();
            LinearBlock::new(&steppers, self.terms)
        });
        self.blocks = blocks;
    }

    /// Whether forces of a contact may overflow although positions are near the body: parameters of no body that there is.
    pub(super) fn is_extreme(&self, index: usize) -> bool {
        is_extreme(&self.stepper(index).contact().specimen)
    }

    /// The contact of an index.
    pub(super) fn stepper(&self, index: usize) -> Cow<'_, LinearStepper> {
        let base = if self.steppers.len() == 1 { &self.steppers[0] } else { &self.steppers[index] };
        if self.parameters.is_empty() {
            return Cow::Borrowed(base);
        }
        // Checked when the values came.
        let own = own_contact(base.contact(), &|parameter| self.parameters.value(parameter, index));
        own.map_or(Cow::Borrowed(base), |contact| Cow::Owned(base.with(contact)))
    }

    #[inline(always)]
    fn block(&self, from: usize) -> &LinearBlock {
        if self.blocks.len() == 1 { &self.blocks[0] } else { &self.blocks[from / LANES] }
    }

    /// Why the first contact cannot take a step of its displacement, if one cannot.
    pub(super) fn check(&self, part: &Part<'_>, step: &ContactsStep<'_>) -> Result<(), OneStepError> {
        for at in 0..part.results.len() {
            let index = part.from + at;
            let (contact, (jaw, memory)) = (self.stepper(index), state(&part.rows, at));
            let fit = check_move(&contact, (jaw, &memory), step.of(index), step.parts());
            fit.map_err(|error| OneStepError { index, error })?;
        }
        Ok(())
    }

    /// Steps the contacts of a part; returns how many failed.
    pub(super) fn step(&self, mut part: Part<'_>, step: &ContactsStep<'_>) -> Result<usize, OneStepError> {
        part.failed.fill(false);
        match step.imposed {
            Imposed::Displacement => accelerated(
                #[inline(always)]
                || self.step_displacement(&mut part, step),
            ),
            Imposed::Force => {
                let count = part.results.len();
                (0..count).try_fold(0, |failures, at| Ok(failures + self.alone(&mut part, at, step)?))
            }
        }
    }

    #[inline(always)]
    fn step_displacement(&self, part: &mut Part<'_>, step: &ContactsStep<'_>) -> Result<usize, OneStepError> {
        let (count, mut failures) = (part.results.len(), 0);
        let (dt, to) = (Column::new(step.dt), Column::new(step.to));
        let (mut fadings, mut memory) = (Fadings::new(), SmallVec::<[Lanes; 8]>::new());
        let is_shared = self.steppers.len() == 1 && dt.shared().is_some();
        for at in (0..count).step_by(LANES) {
            let from = part.from + at;
            let (shared, to) = (self.block(from), to.lanes(from));
            let dt = dt.lanes(from);
            if fadings.is_empty() || !is_shared {
                shared.fadings(&dt.map(|dt| dt / f64::from(step.parts())), &mut fadings);
            }
            memory.clear();
            memory.extend(part.rows[1..].iter().map(|row| lanes(row, at)));
            let jaw = lanes(part.rows[0], at);
            let mut moving = Moving {
                bodies: &shared.bodies,
                is_of_force: &shared.is_of_force,
                jaw,
                force: [0.0; LANES],
                wrong: dt.map(|dt| !is_step(dt)),
            };
            for part in 1..=step.parts() {
                let mut next = [0.0; LANES];
                for lane in 0..LANES {
                    next[lane] = between(jaw[lane], to[lane] * shared.bodies.share[lane], (part, step.parts()));
                }
                moving.press(&mut memory, &fadings, &next);
            }
            let Moving { jaw, force, wrong, .. } = moving;
            if wrong.contains(&true) {
                failures += self.some_alone(part, at, step, (&jaw, &memory, &force, &wrong))?;
                continue;
            }
            store(part.rows[0], at, &jaw);
            part.rows[1..].iter_mut().zip(&memory).for_each(|(row, x)| store(row, at, x));
            store(part.results, at, &force);
        }
        Ok(failures)
    }

    /// Takes over those of a block that stay in contact, and steps the others one by one.
    #[inline(never)]
    fn some_alone(
        &self,
        part: &mut Part<'_>,
        at: usize,
        step: &ContactsStep<'_>,
        (jaw, memory, force, wrong): (&Lanes, &[Lanes], &Lanes, &Marks),
    ) -> Result<usize, OneStepError> {
        let mut failures = 0;
        for lane in 0..LANES.min(part.results.len() - at) {
            if wrong[lane] {
                failures += self.alone(part, at + lane, step)?;
                continue;
            }
            part.rows[0][at + lane] = jaw[lane];
            part.rows[1..].iter_mut().zip(memory).for_each(|(row, x)| row[at + lane] = x[lane]);
            part.results[at + lane] = force[lane];
        }
        Ok(failures)
    }

    /// Steps one contact of a part; returns how many failed.
    fn alone(&self, part: &mut Part<'_>, at: usize, step: &ContactsStep<'_>) -> Result<usize, OneStepError> {
        let index = part.from + at;
        let (contact, (jaw, mut memory)) = (self.stepper(index), state(&part.rows, at));
        let stepped = match step.imposed {
            Imposed::Displacement => moved_alone(&contact, (jaw, &mut memory), step.of(index), step.parts()),
            Imposed::Force => forced_alone(&contact, (jaw, &mut memory), step.of(index), step.parts()),
        };
        match stepped {
            Ok((to, result)) => {
                part.rows[0][at] = to;
                part.rows[1..].iter_mut().zip(&memory).for_each(|(row, x)| row[at] = *x);
                part.results[at] = result;
                Ok(0)
            }
            Err(error) if step.refusal == Refusal::All => Err(OneStepError { index, error }),
            Err(_) => {
                let (_, memory) = state(&part.rows, at);
                part.failed[at] = true;
                let LinearContact {
                    specimen, separation, ..
                } = contact.contact();
                part.results[at] = match step.imposed {
                    Imposed::Displacement => {
                        kept((specimen, *separation), jaw, contact.force(jaw, own(&contact, &memory)))
                    }
                    Imposed::Force => finite(jaw / specimen.contact_displacement(1.0)),
                };
                Ok(1)
            }
        }
    }
}

/// The position of the jaw and the memories of a contact.
pub(super) fn state(rows: &[&mut [f64]], at: usize) -> (f64, Memories) {
    (rows[0][at], rows[1..].iter().map(|row| row[at]).collect())
}

/// The memories of a contact's own terms; others may have more.
pub(super) fn own<'a>(contact: &LinearStepper, memory: &'a [f64]) -> &'a [f64] {
    &memory[..contact.contact().law.terms().len()]
}

/// Checks that a contact can be moved to a displacement (m).
fn check_move(
    contact: &LinearStepper,
    (jaw, memory): (f64, &[f64]),
    (dt, to): (f64, f64),
    parts: u32,
) -> Result<(), StepError> {
    check_step(dt, "displacement must be a finite number", to)?;
    let of = contact.contact();
    let u = of.specimen.contact_displacement(to);
    check_state(&[jaw, u], of.specimen.depth())?;
    check_state(memory, MOST)?;
    for place in [between(jaw, u, (1, parts)), u] {
        of.specimen.check_contact_displacement(place, of.is_bonded())?;
    }
    Ok(())
}

/// A millionth of the largest number of a memory: strains, or newtons.
const MOST: f64 = 1e94;

/// A contact after a step of its displacement (m) in equal parts: its contact displacement (m) and its force (N).
fn moved_alone(
    contact: &LinearStepper,
    (jaw, memory): (f64, &mut Memories),
    (dt, to): (f64, f64),
    parts: u32,
) -> Result<(f64, f64), StepError> {
    check_move(contact, (jaw, memory), (dt, to), parts)?;
    let terms = own(contact, memory).len();
    let (target, mut from, mut force) = (contact.contact().specimen.contact_displacement(to), jaw, 0.0);
    for part in 1..=parts {
        let next = between(jaw, target, (part, parts));
        force = contact.step(from, &mut memory[..terms], dt / f64::from(parts), next)?;
        from = next;
    }
    check_result(&[force])?;
    check_result(memory)?;
    Ok((target, force))
}

/// A contact after a step of its force (N) in equal parts: its contact displacement and the displacement of its jaw (m).
fn forced_alone(
    contact: &LinearStepper,
    (jaw, memory): (f64, &mut Memories),
    (dt, to): (f64, f64),
    parts: u32,
) -> Result<(f64, f64), StepError> {
    check_step(dt, "force must be a finite number", to)?;
    let specimen = &contact.contact().specimen;
    check_state(&[jaw], specimen.depth())?;
    check_state(memory, MOST)?;
    let terms = own(contact, memory).len();
    let (before, mut u) = (contact.force(jaw, &memory[..terms]), jaw);
    for part in 1..=parts {
        let force = between(before, to, (part, parts));
        u = contact.step_force(u, &mut memory[..terms], dt / f64::from(parts), force)?;
    }
    check_result(&[u])?;
    check_result(memory)?;
    Ok((u, u / specimen.contact_displacement(1.0)))
}
