//! What many contacts show, and checks of their states.

use super::linear::own;
use super::models::{ContactModels, Law};
use super::part::OneStepError;
use crate::contact::Specimen;
use crate::simulate::linear::Memories;
use crate::simulate::{ContactState, Separation, StepError};
use crate::vector::LANES;

/// What contacts show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ContactQuantity {
    /// Contact force, N; 0 while the jaw is off, and not a number where it is beyond the body.
    Force,
    /// Tangent stiffness dF/dd against the displacement of the jaw, N/m; not a number where that is beyond the body.
    Stiffness,
    /// Displacement of the surface of the body at one contact, m.
    Surface,
    /// 1 where the jaw touches the body, 0 elsewhere.
    Touching,
}

impl ContactModels {
    /// What contacts show: as many as there is room for, from contact `from` on, of `count` states.
    ///
    /// # Panics
    /// If the lengths do not agree, or if `from` is no multiple of 8.
    pub fn show(&self, (states, count): (&[f64], usize), quantity: ContactQuantity, from: usize, out: &mut [f64]) {
        assert!(states.len() == self.rows() * count && from + out.len() <= count, "a state a number");
        assert!(from.is_multiple_of(LANES), "a range begins at a multiple of {LANES}");
        if let (Law::Latency(models), ContactQuantity::Force | ContactQuantity::Stiffness) = (&self.law, quantity) {
            /// Numbers that the other quantity is computed into.
            const PART: usize = 256;
            let mut other = [0.0; PART];
            for (index, out) in out.chunks_mut(PART).enumerate() {
                let (from, other) = (from + index * PART, &mut other[..out.len()]);
                let state = (&states[from..from + out.len()], &states[count + from..][..out.len()]);
                let both = if quantity == ContactQuantity::Force { (out, other) } else { (other, out) };
                models.force_and_stiffness(from, state, both);
            }
            return;
        }
        for (index, out) in out.iter_mut().enumerate() {
            let index = from + index;
            let is_of_body = matches!(quantity, ContactQuantity::Force | ContactQuantity::Stiffness);
            *out = match is_of_body && self.check_depth(index, states[index]).is_err() {
                true => f64::NAN,
                false => self.shown(states, count, index, quantity),
            };
        }
    }

    fn shown(&self, states: &[f64], count: usize, index: usize, quantity: ContactQuantity) -> f64 {
        match &self.law {
            Law::Latency(models) => {
                let (model, state) = (
                    models.model(index),
                    ContactState {
                        jaw: states[index],
                        behind: states[count + index],
                    },
                );
                match quantity {
                    ContactQuantity::Force => state.force(&model),
                    ContactQuantity::Stiffness => state.stiffness(&model),
                    ContactQuantity::Surface => state.surface(&model),
                    ContactQuantity::Touching => f64::from(u8::from(state.is_touching(&model))),
                }
            }
            Law::Linear(models) => {
                let contact = models.stepper(index);
                let memory: Memories = states[count + index..].iter().step_by(count).copied().collect();
                let (u, memory) = (states[index], own(&contact, &memory));
                match quantity {
                    ContactQuantity::Force => contact.force(u, memory),
                    ContactQuantity::Stiffness => contact.stiffness(u, memory),
                    ContactQuantity::Surface => contact.surface(u, memory),
                    ContactQuantity::Touching => f64::from(u8::from(contact.is_touching(u, memory))),
                }
            }
        }
    }

    /// Checks that states are those of contacts: finite numbers, with finite forces, and jaws that are not beyond their bodies.
    ///
    /// # Errors
    /// [`OneStepError`] for the first one that is none.
    ///
    /// # Panics
    /// If the length is not that of as many states.
    pub fn check_states(&self, states: &[f64], count: usize) -> Result<(), OneStepError> {
        assert_eq!(states.len(), self.rows() * count, "a state a contact");
        for index in 0..count {
            let numbers = states[index..].iter().step_by(count).take(self.rows());
            let force = self.shown(states, count, index, ContactQuantity::Force);
            if let Some(&found) = numbers.chain([&force]).find(|number| !number.is_finite()) {
                let error = StepError::Number {
                    expected: "the numbers of a state and its force must be finite",
                    found,
                };
                return Err(OneStepError { index, error });
            }
            self.check_depth(index, states[index]).map_err(|error| OneStepError { index, error })?;
        }
        Ok(())
    }

    /// Checks that a contact displacement (m) is one that the body of a contact has.
    fn check_depth(&self, index: usize, u: f64) -> Result<(), StepError> {
        let check = |specimen: &Specimen, separation: Separation| {
            specimen.check_contact_displacement(u, separation == Separation::Bonded).map_err(StepError::from)
        };
        match &self.law {
            Law::Latency(models) => {
                let model = models.model(index);
                check(&model.specimen, model.separation)
            }
            Law::Linear(models) => {
                let stepper = models.stepper(index);
                check(&stepper.contact().specimen, stepper.contact().separation)
            }
        }
    }

    /// Makes contacts untouched: those that `mask` marks, or all without it.
    ///
    /// # Panics
    /// If the lengths do not agree.
    pub fn reset(&self, states: &mut [f64], count: usize, mask: Option<&[bool]>) {
        assert_eq!(states.len(), self.rows() * count, "a state a contact");
        let Some(mask) = mask else { return states.fill(0.0) };
        assert_eq!(mask.len(), count, "a mark a contact");
        for row in states.chunks_exact_mut(count.max(1)) {
            row.iter_mut().zip(mask).filter(|(_, marked)| **marked).for_each(|(number, _)| *number = 0.0);
        }
    }
}
