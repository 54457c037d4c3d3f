//! The contacts in columns.

use std::ops::Range;

use super::parallel::for_each;
use crate::contact::{Equilibrium, Shape};
use crate::simulate::{ContactModel, Motion, Separation, SimulateError, check_displacements};

/// Why a batch could not be made or simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BatchError {
    /// As many motions as contacts are needed.
    #[error("a batch needs a motion for every contact, found {models} contacts and {motions} motions")]
    Lengths {
        /// Number of contacts.
        models: usize,
        /// Number of motions.
        motions: usize,
    },
    /// A contact that cannot be simulated.
    #[error("contact {index}: {source}")]
    Contact {
        /// Its index, from 0.
        index: usize,
        /// What is wrong with it.
        source: SimulateError,
    },
    /// A tolerance that nothing can be followed to.
    #[error("the tolerance must be from 1e-13 to 0.01 of the depth, found {found}")]
    Tolerance {
        /// What was given.
        found: f64,
    },
}

/// Independent contacts, each with its own body, law, layers and motion, simulated together.
///
/// The contact layer obeys ẋ = g − v sgn(x)|x|ⁿ with g = u̇₁ (m − 1)/depth, and the force is F = E (x + u₁/depth) A(u₁), equation (11).
/// Holds are the closed form (4), (5); ramps are integrated lane by lane with steps of their own. Forces agree with
/// [`simulate`](crate::simulate::simulate()) to 10⁻⁹ of the largest of a contact, and are the same bits on any number of threads.
///
/// A jaw that cannot pull ([`Separation::Unilateral`]) and goes back may lose the contact: such contacts are simulated one by one, by
/// `simulate` itself.
///
/// ```
/// use palpate::batch::Batch;
/// use palpate::latency::LatencyLaw;
/// use palpate::simulate::{ProtocolStep, Separation, protocol};
/// use palpate::test_problems::paper_ball;
///
/// // The paper's ball and a thousand that are like it, squeezed by 5 mm at 500 mm/min and held for 10 s.
/// let mut models = vec![paper_ball(Separation::Unilateral); 1001];
/// for (i, model) in models.iter_mut().enumerate().skip(1) {
///     model.law = LatencyLaw::new(3.0 + 0.004 * i as f64, 2e4)?;
/// }
/// let motion = protocol(&[ProtocolStep { to: 5e-3, rate: 0.5 / 60.0, hold: 10.0 }])?;
/// let forces = Batch::shared(&models, &motion)?.final_forces()?;
/// assert!((forces[0] - 1.556_133_431_7).abs() < 1e-9); // N, the paper's first step after 10 s of relaxation
/// assert_eq!(forces.len(), 1001);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Batch {
    pub(super) modulus: Vec<f64>,
    pub(super) depth: Vec<f64>,
    /// A = section + π u (round − u) for u > 0: a body of constant section, or a round one of twice this radius (m², m).
    pub(super) section: Vec<f64>,
    pub(super) round: Vec<f64>,
    /// 1 for a round body, 0 for one of constant section.
    pub(super) is_round: Vec<f64>,
    pub(super) exponent: Vec<f64>,
    pub(super) rate_coefficient: Vec<f64>,
    pub(super) layers: Vec<f64>,
    /// One contact's share of the jaw's travel.
    pub(super) share: Vec<f64>,
    /// Knots of every contact, as indices into the two columns after it.
    course: Vec<(usize, usize)>,
    pub(super) times: Vec<f64>,
    pub(super) displacements: Vec<f64>,
    /// Contacts that may be lost, with their index.
    pub(super) alone: Vec<(usize, ContactModel, Motion)>,
}

impl Batch {
    /// Contacts with a motion each.
    ///
    /// # Errors
    /// [`BatchError::Lengths`] unless there are as many motions as models; [`BatchError::Contact`] for a motion that goes where its
    /// specimen cannot.
    pub fn new(models: &[ContactModel], motions: &[Motion]) -> Result<Self, BatchError> {
        if models.len() != motions.len() {
            return Err(BatchError::Lengths {
                models: models.len(),
                motions: motions.len(),
            });
        }
        let mut batch = Self::of(models);
        for (motion, (index, model)) in motions.iter().zip(models.iter().enumerate()) {
            let knots = batch.add_knots(motion);
            batch.add_course(index, model, motion, knots)?;
        }
        Ok(batch)
    }

    /// Contacts that all go through the same motion.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn shared(models: &[ContactModel], motion: &Motion) -> Result<Self, BatchError> {
        let mut batch = Self::of(models);
        let knots = batch.add_knots(motion);
        for (index, model) in models.iter().enumerate() {
            batch.add_course(index, model, motion, knots)?;
        }
        Ok(batch)
    }

    /// Columns without motions.
    fn of(models: &[ContactModel]) -> Self {
        let column = |of: &dyn Fn(&ContactModel) -> f64| models.iter().map(of).collect::<Vec<_>>();
        let shape = |model: &ContactModel| match model.specimen.shape() {
            Shape::Ball { radius } | Shape::Pad { radius, .. } => (0.0, 2.0 * *radius),
            Shape::Prism { area, .. } => (*area, 0.0),
            // Simulated alone.
            Shape::Profile { .. } => (1.0, 0.0),
        };
        Self {
            modulus: column(&|model| model.specimen.modulus()),
            depth: column(&|model| model.specimen.depth()),
            section: column(&|model| shape(model).0),
            round: column(&|model| shape(model).1),
            is_round: column(&|model| f64::from(shape(model).1 > 0.0)),
            exponent: column(&|model| model.law.exponent()),
            rate_coefficient: column(&|model| model.law.rate_coefficient()),
            layers: column(&|model| model.layers.count()),
            share: column(&|model| model.specimen.contact_displacement(1.0)),
            course: Vec::with_capacity(models.len()),
            times: Vec::new(),
            displacements: Vec::new(),
            alone: Vec::new(),
        }
    }

    fn add_knots(&mut self, motion: &Motion) -> (usize, usize) {
        let from = self.times.len();
        self.times.extend(motion.times());
        self.displacements.extend(motion.displacements());
        (from, self.times.len())
    }

    fn add_course(
        &mut self,
        index: usize,
        model: &ContactModel,
        motion: &Motion,
        knots: (usize, usize),
    ) -> Result<(), BatchError> {
        check_displacements(motion, &model.specimen, model.separation)
            .map_err(|source| BatchError::Contact { index, source })?;
        let bonded = model.separation == Separation::Bonded;
        // Only a jaw that goes back can lose the contact. A stiffness from a table or with a root is no column.
        self.course.push(knots);
        let may_leave = !bonded && !motion.displacements().is_sorted();
        let is_plain = *model.specimen.equilibrium() == Equilibrium::EvenStrain
            && !matches!(model.specimen.shape(), Shape::Profile { .. });
        if may_leave || !is_plain {
            self.alone.push((index, model.clone(), motion.clone()));
        }
        Ok(())
    }

    /// Number of contacts.
    #[must_use]
    pub fn len(&self) -> usize {
        self.modulus.len()
    }

    /// Whether there is no contact.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.modulus.is_empty()
    }

    pub(super) fn knots(&self, contact: usize) -> Range<usize> {
        let (from, until) = self.course[contact];
        from..until
    }

    /// Checks that times rise and lie inside every motion.
    pub(super) fn check_times(&self, times: &[f64]) -> Result<(), BatchError> {
        let rises = |index: usize| index == 0 || times[index - 1] <= times[index];
        let disorder = (0..times.len()).find(|index| !rises(*index));
        for index in 0..self.len() {
            let knots = &self.times[self.knots(index)];
            let (from, until) = (knots[0], knots[knots.len() - 1]);
            let outside = || times.iter().position(|time| !(from..=until).contains(time));
            if let Some(place) = disorder.or_else(outside) {
                let source = SimulateError::SampleTime {
                    from,
                    until,
                    found: times[place],
                    index: place,
                };
                return Err(BatchError::Contact { index, source });
            }
        }
        Ok(())
    }

    /// Fills the rows of the contacts that are simulated alone with what `simulated` says.
    pub(super) fn one_by_one(
        &self,
        rows: &mut [f64],
        len: usize,
        simulated: impl Fn(&ContactModel, &Motion) -> Result<Vec<f64>, SimulateError> + Sync + Send,
    ) -> Result<(), BatchError> {
        let alone = for_each(self.alone.len(), |i| simulated(&self.alone[i].1, &self.alone[i].2));
        for (row, &(index, ..)) in alone.into_iter().zip(&self.alone) {
            let row = row.map_err(|source| BatchError::Contact { index, source })?;
            rows[index * len..][..len].copy_from_slice(&row);
        }
        Ok(())
    }

    /// Rows of `len` finite numbers, or which contact has another.
    pub(super) fn checked(&self, rows: Vec<f64>, len: usize, times: Option<&[f64]>) -> Result<Vec<f64>, BatchError> {
        match rows.iter().position(|number| !number.is_finite()) {
            None => Ok(rows),
            Some(place) => {
                let index = place / len;
                let end = self.times[self.knots(index).end - 1];
                let time = times.map_or(end, |times| times[place % len]);
                let source = SimulateError::OutOfRange { time };
                Err(BatchError::Contact { index, source })
            }
        }
    }
}
