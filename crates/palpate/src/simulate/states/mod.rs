//! Many contacts, one step at a time, in place: side by side in vectors where they stay in contact, one by one where a jaw leaves its body or
//! meets it, and on all cores where there are thousands.
//!
//! | file | what |
//! |---|---|
//! | `models.rs` | bodies and laws of the contacts; a step of states that lie in memory of the caller |
//! | `parameters.rs` | parameters with a value for each contact |
//! | `part.rs` | what a step imposes, its memory, and how it is spread over cores |
//! | `lanes.rs` | columns of contacts, as many numbers at a time as go side by side |
//! | `latency.rs`, `block.rs`, `alone.rs` | contacts of the latency law, eight of them in vectors, and one |
//! | `linear.rs`, `linear_block.rs` | contacts of linear laws, and eight of them in vectors |
//! | `quantity.rs` | what contacts show |

mod alone;
mod block;
mod lanes;
mod latency;
mod linear;
mod linear_block;
mod models;
mod parameters;
mod part;
mod quantity;
mod row;
#[cfg(test)]
mod tests;

use super::{ContactModel, ContactState};
pub use models::ContactModels;
pub use parameters::{ContactModelsError, ContactParameter, ValueProblem};
pub use part::{ContactsStep, Imposed, OneStepError, Refusal};
pub use quantity::ContactQuantity;

/// The states of contacts that are moved together, such as those of many grippers, or of one with many values of its parameters.
///
/// A step is that of [`ContactState::step`] for every contact: to the last bit for n = 5, to 1e-13 of the excess strain for other exponents,
/// whose powers are those of vector code. [`ContactModels`] steps states in memory of the caller.
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
    models: ContactModels,
    /// A row for each number of a state, a column for each contact.
    states: Vec<f64>,
    failed: Vec<bool>,
}

impl ContactStates {
    /// Contacts of one model, untouched.
    #[must_use]
    pub fn alike(model: ContactModel, count: usize) -> Self {
        Self::new(ContactModels::alike(model), count)
    }

    /// Contacts of one model each, untouched.
    #[must_use]
    pub fn of_each(models: Vec<ContactModel>) -> Self {
        let count = models.len();
        Self::new(ContactModels::of_each(models), count)
    }

    /// Contacts of these models, untouched.
    ///
    /// # Panics
    /// If the models are those of another number of contacts.
    #[must_use]
    pub fn new(models: ContactModels, count: usize) -> Self {
        assert!(models.count().is_none_or(|models| models == count), "one model, or one a contact");
        Self {
            states: vec![0.0; models.rows() * count],
            failed: vec![false; count],
            models,
        }
    }

    /// Number of contacts.
    #[must_use]
    pub fn count(&self) -> usize {
        self.failed.len()
    }

    /// Bodies and laws of the contacts.
    #[must_use]
    pub fn models(&self) -> &ContactModels {
        &self.models
    }

    /// The numbers of all states: a row for each number, a column for each contact; see [`ContactModels::rows`].
    #[must_use]
    pub fn states(&self) -> &[f64] {
        &self.states
    }

    /// The same, to be changed in place.
    #[must_use]
    pub fn states_mut(&mut self) -> &mut [f64] {
        &mut self.states
    }

    /// Which contacts kept their state in the last step with [`Refusal::Masked`].
    #[must_use]
    pub fn failed(&self) -> &[bool] {
        &self.failed
    }

    /// The state of a contact of the latency law.
    #[must_use]
    pub fn state(&self, index: usize) -> ContactState {
        ContactState {
            jaw: self.states[index],
            behind: self.states[self.count() + index],
        }
    }

    /// Steps all contacts in place and without allocation; returns how many failed. See [`ContactModels::step`].
    ///
    /// # Errors
    /// As for [`ContactModels::step`].
    ///
    /// # Panics
    /// As for [`ContactModels::step`].
    pub fn advance(&mut self, step: &ContactsStep<'_>, results: &mut [f64]) -> Result<usize, OneStepError> {
        self.models.step(&mut self.states, step, results, &mut self.failed)
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
        self.stepped(Imposed::Displacement, dt, displacement)
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
        self.stepped(Imposed::Force, dt, force)
    }

    fn stepped(&mut self, imposed: Imposed, dt: &[f64], to: &[f64]) -> Result<Vec<f64>, OneStepError> {
        let mut results = vec![0.0; self.count()];
        let step = ContactsStep {
            imposed,
            dt,
            to,
            substeps: 1,
            refusal: Refusal::All,
        };
        self.advance(&step, &mut results)?;
        Ok(results)
    }

    /// Makes contacts untouched: those that `mask` marks, or all without it.
    ///
    /// # Panics
    /// If the mask has another length.
    pub fn reset(&mut self, mask: Option<&[bool]>) {
        self.models.reset(&mut self.states, self.failed.len(), mask);
    }
}
