//! Many contacts of the latency law: side by side in vectors where they stay in contact (`block.rs`), one by one where a jaw leaves its body or
//! meets it.

use std::borrow::Cow;
use std::mem;

use fearless_simd::{Simd, dispatch};

use super::alone::{check_move, finite, forced_alone, kept, moved_alone};
use super::block::{Block, Bodies, MOST_LAYERS, Moved, is_extreme};
use super::lanes::{Column, Lanes, lanes, store};
use super::parameters::{ContactParameter, Parameters, Value, ValueProblem, of_model, own_model, renew};
use super::part::{ContactsStep, Imposed, OneStepError, Part, Refusal};
use super::row::is_root;
use crate::latency::lanes::{Power, by_power};
use crate::simulate::{ContactModel, ContactState, Separation};
use crate::vector::{LANES, accelerated, level};

/// Blocks from which on several of them are under way at a time.
const LONG: usize = 4;

/// Contacts of the latency law.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LatencyModels {
    /// One for all contacts, or one each.
    models: Vec<ContactModel>,
    /// Their numbers, with those parameters: one block for all contacts, or one for as many as go side by side.
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

    /// Puts values of parameters in the place of those of the contacts that `mask` marks; see [`Parameters::replace`].
    pub(super) fn replace(&mut self, values: &[(ContactParameter, &[f64])], mask: &[bool]) {
        for (parameter, values) in values {
            let base = self.value(*parameter).unwrap_or_default();
            self.parameters.replace(*parameter, base, values, mask);
        }
        let mut blocks = mem::take(&mut self.blocks);
        renew(&mut blocks, mask, |some| {
            Block::new(&some.map(|index| self.model(index).into_owned()).collect::<Vec<_>>())
        });
        self.blocks = blocks;
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

    /// The numbers of the contacts from `from` on.
    #[inline(always)]
    fn block(&self, from: usize) -> &Block {
        if self.blocks.len() == 1 { &self.blocks[0] } else { &self.blocks[from / LANES] }
    }

    /// Whether forces of a contact may overflow although positions are near the body: parameters of no body that there is.
    pub(super) fn is_extreme(&self, index: usize) -> bool {
        let model = self.model(index);
        is_extreme(&model.specimen) || model.layers.count() > MOST_LAYERS
    }

    /// Why the first contact cannot take a step of its displacement, if one cannot.
    pub(super) fn check(&self, part: &Part<'_>, step: &ContactsStep<'_>) -> Result<(), OneStepError> {
        accelerated(
            #[inline(always)]
            || self.checked(part, step),
        )
    }

    #[inline(always)]
    fn checked(&self, part: &Part<'_>, step: &ContactsStep<'_>) -> Result<(), OneStepError> {
        let [jaw, behind] = &part.rows[..] else { return Ok(()) };
        let (dt, to) = (Column::new(step.dt), Column::new(step.to));
        let (count, mut at) = (part.results.len(), 0);
        while at < count {
            at += LANES * self.taken_in_row((&jaw[at..], &behind[at..]), part.from + at, step);
            let own = at..count.min(at + LANES);
            let (from, state) = (part.from + at, |at| (lanes(jaw, at), lanes(behind, at)));
            at += LANES;
            if own.is_empty()
                || self.block(from).bodies.take(state(own.start), (dt.lanes(from), to.lanes(from)), step.parts())
            {
                continue;
            }
            for place in own {
                let state = ContactState {
                    jaw: jaw[place],
                    behind: behind[place],
                };
                let index = part.from + place;
                let fit = check_move(&self.model(index), state, step.of(index), step.parts());
                fit.map_err(|error| OneStepError { index, error })?;
            }
        }
        Ok(())
    }

    /// How many complete blocks of a row take a step that begins with the contact `from`.
    #[inline(always)]
    fn taken_in_row(&self, (jaw, behind): (&[f64], &[f64]), from: usize, step: &ContactsStep<'_>) -> usize {
        let columns = (Column::new(step.dt).from(from), Column::new(step.to).from(from));
        let rows = (jaw.as_chunks().0, behind.as_chunks().0);
        let blocks = if self.blocks.len() == 1 { &self.blocks[..] } else { &self.blocks[from / LANES..] };
        // One part is a loop of its own, and so is one block.
        match (step.parts(), blocks) {
            (1, [block]) => Bodies::taken_in_row(
                #[inline(always)]
                |_| &block.bodies,
                rows,
                columns,
                1,
            ),
            (parts, [block]) => Bodies::taken_in_row(
                #[inline(always)]
                |_| &block.bodies,
                rows,
                columns,
                parts,
            ),
            (parts, blocks) => Bodies::taken_in_row(
                #[inline(always)]
                |index: usize| &blocks[index].bodies,
                rows,
                columns,
                parts,
            ),
        }
    }

    /// Steps the contacts of a part; returns how many failed.
    pub(super) fn step(&self, part: Part<'_>, step: &ContactsStep<'_>) -> Result<usize, OneStepError> {
        match step.imposed {
            Imposed::Displacement => dispatch!(level(), simd => self.step_displacement(simd, part, step)),
            Imposed::Force => self.step_force(part, step),
        }
    }

    #[inline(always)]
    fn step_displacement<S: Simd>(
        &self,
        simd: S,
        mut part: Part<'_>,
        step: &ContactsStep<'_>,
    ) -> Result<usize, OneStepError> {
        clear(part.failed);
        let (count, mut at, mut failures) = (part.results.len(), 0, 0);
        while at < count {
            if at + LANES <= count {
                at += LANES * self.step_in_row(simd, &mut part, at, step);
            }
            if at < count {
                failures += self.step_block(&mut part, at, step)?;
                at += LANES;
            }
        }
        Ok(failures)
    }

    /// Steps complete blocks from contact `at` on until one has contacts that leave or meet their bodies, or another power; returns how many.
    #[inline(always)]
    fn step_in_row<S: Simd>(&self, simd: S, part: &mut Part<'_>, at: usize, step: &ContactsStep<'_>) -> usize {
        let [jaw, behind] = &mut part.rows[..] else { return 0 };
        let from = part.from + at;
        let rows = (jaw[at..].as_chunks_mut().0, behind[at..].as_chunks_mut().0, part.results[at..].as_chunks_mut().0);
        let columns = (Column::new(step.dt).from(from), Column::new(step.to).from(from));
        let (dt, to) = (columns.0.rows(), columns.1.rows());
        let blocks = if self.blocks.len() == 1 { &self.blocks[..] } else { &self.blocks[from / LANES..] };
        let is_one = blocks.len() == 1;
        let steps = (0..).map(
            #[inline(always)]
            |index| (dt.block(index), to.block(index)),
        );
        // Roots of one part are a loop of their own, which begins slowly, and so is one block with one time step.
        let is_long = rows.0.len() >= LONG;
        by_power!(blocks[0].power, power => match (step.parts(), is_long && is_root(power), columns.0.shared(), columns.1.each()) {
            (1, true, Some(dt), Some(to)) if is_one => {
                Block::pressed_in_row(simd, #[inline(always)] |_| &blocks[0], power, rows, #[inline(always)] |index: usize| (dt, to[index]))
            }
            (1, true, ..) if !is_one => {
                Block::pressed_in_row(simd, #[inline(always)] |index: usize| &blocks[index], power, rows, #[inline(always)] |index: usize| (dt.block(index), to.block(index)))
            }
            (parts, ..) => {
                let block = |index: usize| &blocks[if is_one { 0 } else { index }];
                Block::moved_in_row(block, power, rows, steps, parts)
            }
        })
    }

    /// Steps a block of which some contacts leave or meet their bodies, or that is not complete.
    #[inline(always)]
    fn step_block(&self, part: &mut Part<'_>, at: usize, step: &ContactsStep<'_>) -> Result<usize, OneStepError> {
        let [jaw, behind] = &mut part.rows[..] else {
            return Ok(0);
        };
        let (from, end) = (part.from + at, part.failed.len().min(at + LANES));
        let (dt, to) = (Column::new(step.dt).lanes(from), Column::new(step.to).lanes(from));
        let (block, before) = (self.block(from), (lanes(jaw, at), lanes(behind, at)));
        let mut moved = by_power!(block.power, power => block.moved_or_freed(power, before, (dt, to), step.parts()));
        let failures = match moved.is_right {
            true => 0,
            false => self.alone(from, before, step, &mut moved, &mut part.failed[at..end])?,
        };
        store(jaw, at, &moved.jaw);
        store(behind, at, &moved.behind);
        store(part.results, at, &moved.force);
        Ok(failures)
    }

    /// Steps those of a block that do not stay in contact one by one.
    #[inline(never)]
    fn alone(
        &self,
        from: usize,
        (jaw, behind): (Lanes, Lanes),
        step: &ContactsStep<'_>,
        moved: &mut Moved,
        failed: &mut [bool],
    ) -> Result<usize, OneStepError> {
        let mut failures = 0;
        for (lane, failed) in failed.iter_mut().enumerate().filter(|(lane, _)| moved.wrong[*lane]) {
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
                    (before, kept((&model.specimen, model.separation), before.jaw, before.force(&model)))
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

    /// Forces (N) and stiffnesses (N/m) of the states of contacts from `from` on; not numbers where the jaw is beyond its body.
    pub(super) fn force_and_stiffness(
        &self,
        from: usize,
        state: (&[f64], &[f64]),
        (forces, slopes): (&mut [f64], &mut [f64]),
    ) {
        accelerated(
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
                    for lane in (0..LANES.min(forces.len() - at)).filter(|lane| !block.bodies.fits(*lane, jaw[*lane])) {
                        let model = self.model(from + at + lane);
                        let bonded = model.separation == Separation::Bonded;
                        if model.specimen.check_contact_displacement(jaw[lane], bonded).is_err() {
                            (force[lane], slope[lane]) = (f64::NAN, f64::NAN);
                        }
                    }
                    store(forces, at, &force);
                    store(slopes, at, &slope);
                }
            },
        );
    }
}

/// Clears marks: whole pages at once take several times as long.
#[inline(always)]
fn clear(failed: &mut [bool]) {
    failed.chunks_mut(512).for_each(|some| some.fill(false));
}
