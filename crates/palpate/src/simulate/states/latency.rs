//! Many contacts of the latency law: side by side in vectors where they stay in contact (`block.rs`), one by one where a jaw leaves its body or
//! meets it.

use std::borrow::Cow;

use super::alone::{check_move, finite, forced_alone, is_extreme, moved_alone};
use super::block::{Block, Lanes, Moved, all_right, between, lanes, misdated, store};
use super::parameters::{ContactParameter, Parameters, Value, ValueProblem, of_model, own_model};
use super::part::{Column, ContactsStep, Imposed, OneStepError, Part, Refusal};
use crate::latency::lanes::each;
use crate::simulate::{ContactModel, ContactState};
use crate::vector::{LANES, accelerated_by_four};

/// Contacts of the latency law.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LatencyModels {
    /// One for all contacts, or one each.
    models: Vec<ContactModel>,
    /// Their numbers: one block for all contacts, or one for as many as go side by side.
    blocks: Vec<Block>,
    /// Parameters that each contact has a value of.
    parameters: Parameters,
}

impl LatencyModels {
    /// Of one model for all contacts, or of one each.
    pub(super) fn new(models: Vec<ContactModel>) -> Self {
        Self {
            blocks: models.chunks(LANES).map(Block::new).collect(),
            models,
            parameters: Parameters::default(),
        }
    }

    /// Number of models.
    pub(super) fn models(&self) -> usize {
        self.models.len()
    }

    pub(super) fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The value of a parameter of the one model.
    pub(super) fn value(&self, parameter: ContactParameter) -> Option<f64> {
        of_model(parameter, &self.models[0])
    }

    /// Why a contact with values of its own is none.
    pub(super) fn fault(&self, value: Value<'_>) -> Option<ValueProblem> {
        own_model(&self.models[0], value).err()
    }

    pub(super) fn parameters_mut(&mut self) -> &mut Parameters {
        &mut self.parameters
    }

    /// The model of a contact.
    pub(super) fn model(&self, index: usize) -> Cow<'_, ContactModel> {
        let base = if self.models.len() == 1 { &self.models[0] } else { &self.models[index] };
        if self.parameters.is_empty() {
            return Cow::Borrowed(base);
        }
        // Checked when the values came.
        own_model(base, &|parameter| self.parameters.value(parameter, index)).map_or(Cow::Borrowed(base), Cow::Owned)
    }

    /// The numbers of the models of contacts from `from` on, without parameters of each.
    #[inline(always)]
    fn shared_block(&self, from: usize) -> &Block {
        if self.models.len() == 1 { &self.blocks[0] } else { &self.blocks[from / LANES] }
    }

    /// The numbers of the contacts from `from` on.
    #[inline(always)]
    fn block(&self, from: usize) -> Cow<'_, Block> {
        match self.parameters.is_empty() {
            true => Cow::Borrowed(self.shared_block(from)),
            false => Cow::Owned(self.shared_block(from).with(&self.parameters, from)),
        }
    }

    /// Whether forces of a contact may overflow although positions are near the body: parameters of no body that there is.
    pub(super) fn is_extreme(&self, index: usize) -> bool {
        let model = self.model(index);
        is_extreme(&model.specimen) || model.layers.count() > 1e50
    }

    /// Why the first contact cannot take a step of its displacement, if one cannot.
    pub(super) fn check(&self, part: &Part<'_>, step: &ContactsStep<'_>) -> Result<(), OneStepError> {
        accelerated_by_four(
            #[inline(always)]
            || self.checked(part, step),
        )
    }

    #[inline(always)]
    fn checked(&self, part: &Part<'_>, step: &ContactsStep<'_>) -> Result<(), OneStepError> {
        let [jaw, behind] = &part.rows[..] else { return Ok(()) };
        let (dt, to) = (Column::new(step.dt), Column::new(step.to));
        for at in (0..part.results.len()).step_by(LANES) {
            let from = part.from + at;
            let (block, dt, to) = (self.block(from), dt.lanes(from), to.lanes(from));
            let (jaw, behind) = (lanes(jaw, at), lanes(behind, at));
            let bodies = &block.bodies;
            let u = each(
                #[inline(always)]
                |lane| to[lane] * bodies.share[lane],
            );
            let first = each(
                #[inline(always)]
                |lane| between(jaw[lane], u[lane], (1, step.parts())),
            );
            let wrong = each(
                #[inline(always)]
                |lane| {
                    let wrong = bodies.farther(lane, behind[lane], bodies.farther(lane, jaw[lane], 0.0));
                    misdated(dt[lane], bodies.misfit(lane, u[lane], bodies.misfit(lane, first[lane], wrong)))
                },
            );
            if all_right(&wrong) {
                continue;
            }
            for lane in (0..LANES.min(part.results.len() - at)).filter(|lane| wrong[*lane] > 0.0) {
                let state = ContactState {
                    jaw: jaw[lane],
                    behind: behind[lane],
                };
                let index = from + lane;
                let fit = check_move(&self.model(index), state, (dt[lane], to[lane]), step.parts());
                fit.map_err(|error| OneStepError { index, error })?;
            }
        }
        Ok(())
    }

    /// Steps the contacts of a part; returns how many failed.
    pub(super) fn step(&self, part: Part<'_>, step: &ContactsStep<'_>) -> Result<usize, OneStepError> {
        match step.imposed {
            Imposed::Displacement => accelerated_by_four(
                #[inline(always)]
                || self.step_displacement(part, step),
            ),
            Imposed::Force => self.step_force(part, step),
        }
    }

    #[inline(always)]
    fn step_displacement(&self, part: Part<'_>, step: &ContactsStep<'_>) -> Result<usize, OneStepError> {
        let (count, mut rows, mut failures) = (part.results.len(), part.rows, 0);
        let [jaw, behind] = &mut rows[..] else { return Ok(0) };
        let (dt, to) = (Column::new(step.dt), Column::new(step.to));
        part.failed.fill(false);
        for at in (0..count).step_by(LANES) {
            let from = part.from + at;
            let (dt, to) = (dt.lanes(from), to.lanes(from));
            let (old_jaw, old_behind) = (lanes(jaw, at), lanes(behind, at));
            let own;
            let block = match self.parameters.is_empty() {
                true => self.shared_block(from),
                false => {
                    own = self.shared_block(from).with(&self.parameters, from);
                    &own
                }
            };
            let mut moved = block.moved((&old_jaw, &old_behind), &dt, &to, step.parts());
            if !all_right(&moved.wrong) {
                let failed = &mut part.failed[at..count.min(at + LANES)];
                failures += self.alone(from, (&old_jaw, &old_behind), step, &mut moved, failed)?;
            }
            store(jaw, at, &moved.jaw);
            store(behind, at, &moved.behind);
            store(part.results, at, &moved.force);
        }
        Ok(failures)
    }

    /// Steps those of a block that do not stay in contact one by one.
    #[inline(never)]
    fn alone(
        &self,
        from: usize,
        (jaw, behind): (&Lanes, &Lanes),
        step: &ContactsStep<'_>,
        moved: &mut Moved,
        failed: &mut [bool],
    ) -> Result<usize, OneStepError> {
        let (wrong, mut failures) = (moved.wrong, 0);
        for (lane, failed) in failed.iter_mut().enumerate().filter(|(lane, _)| wrong[*lane] > 0.0) {
            let (index, before) = (
                from + lane,
                ContactState {
                    jaw: jaw[lane],
                    behind: behind[lane],
                },
            );
            let model = self.model(index);
            let (state, force) = match moved_alone(&model, before, step.of(index), step.parts()) {
                Ok(after) => after,
                Err(error) if step.refusal == Refusal::All => return Err(OneStepError { index, error }),
                Err(_) => {
                    (failures, *failed) = (failures + 1, true);
                    (before, finite(before.force(&model)))
                }
            };
            (moved.jaw[lane], moved.behind[lane], moved.force[lane]) = (state.jaw, state.behind, force);
        }
        Ok(failures)
    }

    fn step_force(&self, part: Part<'_>, step: &ContactsStep<'_>) -> Result<usize, OneStepError> {
        let (count, mut rows, mut failures) = (part.results.len(), part.rows, 0);
        let [jaw, behind] = &mut rows[..] else { return Ok(0) };
        part.failed.fill(false);
        for at in 0..count {
            let index = part.from + at;
            let (model, before) = (
                self.model(index),
                ContactState {
                    jaw: jaw[at],
                    behind: behind[at],
                },
            );
            let (state, place) = match forced_alone(&model, before, step.of(index), step.parts()) {
                Ok(after) => after,
                Err(error) if step.refusal == Refusal::All => return Err(OneStepError { index, error }),
                Err(_) => {
                    (failures, part.failed[at]) = (failures + 1, true);
                    (before, finite(before.jaw / model.specimen.contact_displacement(1.0)))
                }
            };
            (jaw[at], behind[at], part.results[at]) = (state.jaw, state.behind, place);
        }
        Ok(failures)
    }

    /// Forces (N) and stiffnesses (N/m) of the states of contacts from `from` on.
    pub(super) fn force_and_stiffness(
        &self,
        from: usize,
        state: (&[f64], &[f64]),
        (forces, slopes): (&mut [f64], &mut [f64]),
    ) {
        accelerated_by_four(
            #[inline(always)]
            || {
                for at in (0..forces.len()).step_by(LANES) {
                    let (jaw, behind) = (lanes(state.0, at), lanes(state.1, at));
                    let block = self.block(from + at);
                    let (mut force, mut slope) = block.force_and_stiffness(&jaw, &behind);
                    for lane in (0..LANES.min(forces.len() - at)).filter(|lane| block.bodies.limit[*lane] < 0.0) {
                        let (state, model) = (
                            ContactState {
                                jaw: jaw[lane],
                                behind: behind[lane],
                            },
                            self.model(from + at + lane),
                        );
                        (force[lane], slope[lane]) = (state.force(&model), state.stiffness(&model));
                    }
                    store(forces, at, &force);
                    store(slopes, at, &slope);
                }
            },
        );
    }
}
