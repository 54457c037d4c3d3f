//! Many contacts, one step at a time: side by side in vectors where they stay in contact (`block.rs`), one by one where a jaw leaves its body or
//! meets it.

mod block;

use super::{ContactModel, ContactState, StepError};
use crate::vector::{LANES, accelerated};
use block::{Block, Moved, lanes};

/// The states of contacts that are moved together, such as those of many grippers, or of one under many guesses.
///
/// A step is that of [`ContactState::step`] for every contact: to the last bit for n = 5, to 1e-13 of the excess strain for other exponents,
/// whose powers are those of vector code.
///
/// ```
/// use palpate::simulate::{ContactState, ContactStates, Separation};
/// use palpate::test_problems::paper_ball;
///
/// let model = paper_ball(Separation::Unilateral);
/// let mut contacts = ContactStates::alike(model.clone(), 20);
/// let mut alone = ContactState::default();
/// let mut forces = Vec::new();
/// for tick in 1..=100 {
///     let to = 5e-5 * f64::from(tick);
///     forces = contacts.step(&[1e-3], &[to])?;
///     assert_eq!(forces, [alone.step(&model, 1e-3, to)?; 20]);
/// }
/// assert!((forces[0] - 3.8858).abs() < 1e-3); // N
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ContactStates {
    /// One for all contacts, or one each.
    models: Vec<ContactModel>,
    /// Their numbers: one block for all contacts, or one for as many as go side by side.
    blocks: Vec<Block>,
    /// Displacements of the jaws and of the nodes behind the contact layers, m.
    jaw: Vec<f64>,
    behind: Vec<f64>,
}

/// A step that one of several contacts cannot take; all of them are as before.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("contact {index}: {error}")]
pub struct OneStepError {
    /// Which contact, from 0.
    pub index: usize,
    /// Why it cannot.
    pub error: StepError,
}

impl ContactStates {
    /// Contacts of one model, untouched.
    #[must_use]
    pub fn alike(model: ContactModel, count: usize) -> Self {
        Self::of_states(vec![model], &vec![ContactState::default(); count])
    }

    /// Contacts of one model each, untouched.
    #[must_use]
    pub fn of_each(models: Vec<ContactModel>) -> Self {
        let states = vec![ContactState::default(); models.len()];
        Self::of_states(models, &states)
    }

    /// Contacts in these states, of one model or of one each.
    ///
    /// # Panics
    /// If there is neither one model nor one for each state.
    #[must_use]
    pub fn of_states(models: Vec<ContactModel>, states: &[ContactState]) -> Self {
        assert!(models.len() == 1 || models.len() == states.len(), "one model, or one a contact");
        Self {
            blocks: models.chunks(LANES).map(Block::new).collect(),
            models,
            jaw: states.iter().map(|state| state.jaw).collect(),
            behind: states.iter().map(|state| state.behind).collect(),
        }
    }

    /// Number of contacts.
    #[must_use]
    pub fn count(&self) -> usize {
        self.jaw.len()
    }

    /// The state of a contact.
    #[must_use]
    pub fn state(&self, index: usize) -> ContactState {
        ContactState {
            jaw: self.jaw[index],
            behind: self.behind[index],
        }
    }

    /// The model of a contact.
    #[must_use]
    pub fn model(&self, index: usize) -> &ContactModel {
        if self.models.len() == 1 { &self.models[0] } else { &self.models[index] }
    }

    /// Moves every jaw to its displacement (m) within a time step (s) and returns the forces (N); one time step and one displacement may stand
    /// for all. All contacts are stepped, or none.
    ///
    /// # Errors
    /// [`OneStepError`] for the first contact that cannot take its step.
    ///
    /// # Panics
    /// If there are neither one nor as many numbers as contacts.
    pub fn step(&mut self, dt: &[f64], displacement: &[f64]) -> Result<Vec<f64>, OneStepError> {
        let mut next = NextStates::default();
        self.step_until(self.count(), dt, displacement, &mut next)?;
        Ok(self.take(next))
    }

    /// Continues a [`step`](Self::step) from the contacts that `next` has already to contact `until`, which is the last or a multiple of 8: of
    /// millions it takes a while. [`take`](Self::take) ends it.
    ///
    /// # Errors
    /// As for [`step`](Self::step).
    ///
    /// # Panics
    /// As for [`step`](Self::step).
    pub fn step_until(
        &self,
        until: usize,
        dt: &[f64],
        displacement: &[f64],
        next: &mut NextStates,
    ) -> Result<(), OneStepError> {
        let count = self.checked(dt, displacement);
        let until = until.min(count);
        next.reserve(count + LANES);
        let stepped = accelerated(
            #[inline(always)]
            || self.extend(until, dt, displacement, next),
        );
        next.truncate(count);
        stepped
    }

    #[inline(always)]
    fn extend(&self, until: usize, dt: &[f64], to: &[f64], next: &mut NextStates) -> Result<(), OneStepError> {
        for from in (next.results.len()..until).step_by(LANES) {
            let block = if self.models.len() == 1 { &self.blocks[0] } else { &self.blocks[from / LANES] };
            let (dt, to) = (lanes(dt, from), lanes(to, from));
            let mut moved = block.moved((&lanes(&self.jaw, from), &lanes(&self.behind, from)), &dt, &to);
            if moved.stays.contains(&false) {
                self.alone(from, &dt, &to, &mut moved)?;
            }
            next.jaw.extend_from_slice(&moved.jaw);
            next.behind.extend_from_slice(&moved.behind);
            next.results.extend_from_slice(&moved.force);
        }
        Ok(())
    }

    /// Steps those of a block that do not stay in contact one by one.
    fn alone(&self, from: usize, dt: &[f64; LANES], to: &[f64; LANES], moved: &mut Moved) -> Result<(), OneStepError> {
        let stays = moved.stays;
        for lane in (0..LANES.min(self.count() - from)).filter(|lane| !stays[*lane]) {
            let index = from + lane;
            let mut state = self.state(index);
            let force = state.step(self.model(index), dt[lane], to[lane]);
            moved.force[lane] = force.map_err(|error| OneStepError { index, error })?;
            (moved.jaw[lane], moved.behind[lane]) = (state.jaw, state.behind);
        }
        Ok(())
    }

    /// Applies a force (N) to every contact within a time step (s) and returns the displacements of the jaws (m), as [`step`](Self::step) does
    /// the other way round.
    ///
    /// # Errors
    /// As for [`step`](Self::step).
    ///
    /// # Panics
    /// As for [`step`](Self::step).
    pub fn step_force(&mut self, dt: &[f64], force: &[f64]) -> Result<Vec<f64>, OneStepError> {
        let mut next = NextStates::default();
        self.step_force_until(self.count(), dt, force, &mut next)?;
        Ok(self.take(next))
    }

    /// Continues a [`step_force`](Self::step_force) to contact `until`, as [`step_until`](Self::step_until) a step.
    ///
    /// # Errors
    /// As for [`step`](Self::step).
    ///
    /// # Panics
    /// As for [`step`](Self::step).
    pub fn step_force_until(
        &self,
        until: usize,
        dt: &[f64],
        force: &[f64],
        next: &mut NextStates,
    ) -> Result<(), OneStepError> {
        let count = self.checked(dt, force);
        next.reserve(count);
        for index in next.results.len()..until.min(count) {
            let (dt, force) = (dt[index.min(dt.len() - 1)], force[index.min(force.len() - 1)]);
            let mut state = self.state(index);
            let stepped = state.step_force(self.model(index), dt, force);
            next.results.push(stepped.map_err(|error| OneStepError { index, error })?);
            next.jaw.push(state.jaw);
            next.behind.push(state.behind);
        }
        Ok(())
    }

    /// Takes a step that was computed, and returns what came of it: forces (N), or displacements (m).
    ///
    /// # Panics
    /// If it was not computed for all contacts.
    pub fn take(&mut self, next: NextStates) -> Vec<f64> {
        assert_eq!(next.results.len(), self.count(), "a step of all contacts");
        (self.jaw, self.behind) = (next.jaw, next.behind);
        next.results
    }

    /// How many contacts there are, if there are as many numbers.
    fn checked(&self, dt: &[f64], to: &[f64]) -> usize {
        let count = self.count();
        assert!([dt, to].iter().all(|all| all.len() == 1 || all.len() == count), "one number, or one a contact");
        count
    }
}

/// A step that was computed, and not taken yet.
#[derive(Debug, Clone, Default)]
pub struct NextStates {
    jaw: Vec<f64>,
    behind: Vec<f64>,
    results: Vec<f64>,
}

impl NextStates {
    /// For how many contacts it was computed.
    #[must_use]
    pub fn count(&self) -> usize {
        self.results.len()
    }

    fn reserve(&mut self, count: usize) {
        for all in [&mut self.jaw, &mut self.behind, &mut self.results] {
            all.reserve_exact(count.saturating_sub(all.len()));
        }
    }

    fn truncate(&mut self, count: usize) {
        for all in [&mut self.jaw, &mut self.behind, &mut self.results] {
            all.truncate(count);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Equilibrium, Layers, Shape, Sides, Specimen};
    use crate::latency::LatencyLaw;
    use crate::simulate::Separation;
    use crate::test_problems::Rng;

    /// Bodies of every kind, bonded and not, with exponents that have roots of their own and others.
    fn models(exponents: &[f64], count: usize) -> Vec<ContactModel> {
        let model = |index: usize| {
            let size = 0.03 + 1e-4 * index as f64;
            let shape = match index % 4 {
                0 => Shape::Ball { radius: size },
                1 => Shape::Pad {
                    radius: size,
                    thickness: 0.8 * size,
                },
                2 => Shape::Prism {
                    area: size * size,
                    length: size,
                },
                _ => Shape::Ball { radius: 0.9 * size },
            };
            let sides = if index.is_multiple_of(3) { Sides::One } else { Sides::Two };
            let specimen = Specimen::new(shape, 2e4 + 1e3 * index as f64, sides).unwrap();
            let specimen = match index % 4 {
                3 => specimen.with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.45 }).unwrap(),
                _ => specimen,
            };
            ContactModel {
                specimen,
                law: LatencyLaw::new(
                    exponents[index % exponents.len()],
                    1.5 * 10f64.powf(exponents[index % exponents.len()] - 1.0),
                )
                .unwrap(),
                layers: Layers::new(8.0).unwrap(),
                separation: if index.is_multiple_of(5) { Separation::Bonded } else { Separation::Unilateral },
            }
        };
        (0..count).map(model).collect()
    }

    #[test]
    fn contacts_side_by_side_are_contacts_alone() {
        for exponents in [&[5.0][..], &[1.0], &[2.0], &[3.0], &[0.6, 1.0, 2.7, 5.0, 11.3]] {
            let models = models(exponents, 43);
            let (mut together, mut alone) = (ContactStates::of_each(models.clone()), vec![ContactState::default(); 43]);
            let (mut random, mut places) = (Rng::new(3), vec![0.002; 43]);
            let mut left = 0;
            for _ in 0..400 {
                let dt = if random.uniform() < 0.1 { 0.0 } else { 0.01 * random.uniform() };
                for (place, model) in places.iter_mut().zip(&models) {
                    // A bonded ball cannot be pulled, any other body can be left.
                    let least = if model.separation == Separation::Bonded { 0.0 } else { -0.001 };
                    *place = (*place + 1e-3 * (random.uniform() - 0.5)).clamp(least, 0.008);
                }
                let forces = together.step(&[dt], &places).unwrap();
                for (index, (state, model)) in alone.iter_mut().zip(&models).enumerate() {
                    let force = state.step(model, dt, places[index]).unwrap();
                    left += usize::from(!state.is_touching(model));
                    let found = together.state(index);
                    let scale = model.specimen.depth();
                    let off = (found.behind - state.behind).abs() / scale;
                    assert!(off < 1e-13 && found.jaw == state.jaw, "{exponents:?} {index}: {off:e}");
                    assert!((forces[index] - force).abs() <= 1e-11 * force.abs().max(1e-2), "{exponents:?} {index}");
                    if exponents == [5.0] {
                        assert_eq!((found, forces[index]), (*state, force), "{index}");
                    }
                }
            }
            assert!(left > 100, "{exponents:?}: {left} steps without contact");
        }
    }

    #[test]
    fn all_contacts_are_stepped_or_none() {
        let mut contacts = ContactStates::of_each(models(&[5.0], 11));
        let before = contacts.clone();
        let mut to = [1e-3; 11];
        to[9] = 1.0;
        let error = contacts.step(&[1e-3], &to).unwrap_err();
        assert!(error.index == 9 && matches!(error.error, StepError::Displacement(_)), "{error}");
        for dt in [-1.0, f64::NAN, f64::INFINITY] {
            let error = contacts.step(&[dt], &[1e-3]).unwrap_err();
            assert!(error.index == 0 && matches!(error.error, StepError::Number { .. }), "{error}");
        }
        assert_eq!(contacts, before);
    }

    #[test]
    fn a_step_in_parts_is_a_step() {
        let mut contacts = ContactStates::alike(models(&[5.0], 1).swap_remove(0), 21);
        let mut whole = contacts.clone();
        let mut next = NextStates::default();
        for until in [8, 16, 24] {
            contacts.step_until(until, &[1e-3], &[2e-3], &mut next).unwrap();
            assert_eq!(next.count(), until.min(21));
        }
        assert_eq!(contacts.take(next), whole.step(&[1e-3], &[2e-3]).unwrap());
        let mut next = NextStates::default();
        for until in [5, 21] {
            contacts.step_force_until(until, &[1e-3], &[0.2], &mut next).unwrap();
        }
        assert_eq!(contacts.take(next), whole.step_force(&[1e-3], &[0.2]).unwrap());
        assert_eq!(contacts, whole);
    }
}
