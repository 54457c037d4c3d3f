//! The contacts in columns.

use std::ops::Range;

use fearless_simd::{Simd, dispatch};

use super::body::Bodies;
use super::cascade::{self, Cascade, Stack};
use super::layer::{self, ContactLayers, Laws};
use super::parallel::{for_each, for_each_part};
use super::stops::Stops;
use crate::contact::{Equilibrium, Shape};
use crate::latency::lanes::Power;
use crate::simulate::{
    ContactModel, Motion, Sampling, Separation, SimulateError, check_displacements, simulate_force, strain_wave,
};
use crate::vector::level;

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

    /// Contact force (N) of every contact at the end of its motion.
    ///
    /// # Errors
    /// [`BatchError::Contact`] if the numbers of a contact leave the range of doubles.
    pub fn final_forces(&self) -> Result<Vec<f64>, BatchError> {
        let mut forces = vec![0.0; self.len()];
        self.fill_forces(None, &mut forces);
        self.one_by_one(&mut forces, 1, |model, motion| simulate_force(motion, model, &[motion.end()]))?;
        self.checked(forces, 1, None)
    }

    /// Contact force (N) of every contact at rising `times` (s), which lie inside its motion: those of contact i are the i-th row of
    /// `times.len()` numbers.
    ///
    /// Every sample ends a step: where a few suffice, ask for a few.
    ///
    /// # Errors
    /// [`BatchError::Contact`] for times that do not rise or lie outside a motion, and if numbers leave the range of doubles.
    pub fn forces_at(&self, times: &[f64]) -> Result<Vec<f64>, BatchError> {
        self.check_times(times)?;
        let mut forces = vec![0.0; self.len() * times.len()];
        self.fill_forces(Some(times), &mut forces);
        self.one_by_one(&mut forces, times.len(), |model, motion| simulate_force(motion, model, times))?;
        self.checked(forces, times.len(), Some(times))
    }

    /// Strain of every layer of every contact at rising `times` (s), which lie inside its motion.
    ///
    /// `tolerance` is the error allowed in a step of a node, in units of what the surface travels at most, from 10⁻¹³ to 0.01.
    /// The strain of a layer is m differences of nodes: 10⁻⁹ gives it to 10⁻⁷ or better.
    ///
    /// # Errors
    /// As for [`forces_at`](Self::forces_at); [`BatchError::Tolerance`]; [`SimulateError::FractionalLayers`] for a contact whose number
    /// of layers is not whole.
    ///
    /// ```
    /// use palpate::batch::Batch;
    /// use palpate::simulate::Separation;
    /// use palpate::test_problems::{paper_ball, paper_test_a};
    ///
    /// let batch = Batch::shared(&vec![paper_ball(Separation::Bonded); 20], &paper_test_a())?;
    /// let strains = batch.strains_at(&[0.6, 43.0], 1e-10)?;
    /// // excess 0.133032493898 on top of 12.5 mm/35 mm in the contact layer
    /// assert!((strains.of(7, 1)[0] - (0.133_032_493_898 + 12.5 / 35.0)).abs() < 1e-8);
    /// assert_eq!(strains.of(7, 1).len(), 8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn strains_at(&self, times: &[f64], tolerance: f64) -> Result<LayerStrains, BatchError> {
        if !(1e-13..=0.01).contains(&tolerance) {
            return Err(BatchError::Tolerance { found: tolerance });
        }
        self.check_times(times)?;
        if let Some(index) = self.layers.iter().position(|m| m.fract() != 0.0 || *m >= 1e6) {
            let found = self.layers[index];
            let source = SimulateError::FractionalLayers { found };
            return Err(BatchError::Contact { index, source });
        }
        let stride = self.layers.iter().fold(0.0, |most: f64, m| most.max(*m)) as usize;
        let row = times.len() * stride;
        let mut strains = vec![0.0; self.len() * row];
        for_each_part(&mut strains, cascade::GROUP * row, |index, part| {
            dispatch!(level(), simd => self.strains_of(simd, index * cascade::GROUP, times, (tolerance, stride), part));
        });
        self.one_by_one(&mut strains, row, |model, motion| {
            let wave = strain_wave(motion, model, &Sampling::Times(times.to_vec()))?;
            let at = |sample: usize, layer: usize| wave.strain.get(layer).map_or(0.0, |strain| strain[sample]);
            Ok((0..row).map(|i| at(i / stride, i % stride)).collect())
        })?;
        let strains = self.checked(strains, row, None)?;
        Ok(LayerStrains {
            strains,
            layers: self.layers.iter().map(|m| *m as usize).collect(),
            samples: times.len(),
            stride,
        })
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

    /// What `simulated` says of the contacts that are simulated alone, with their indices.
    pub(super) fn simulated_alone(
        &self,
        simulated: impl Fn(&ContactModel, &Motion) -> Result<Vec<f64>, SimulateError> + Sync + Send,
    ) -> Result<Vec<(usize, Vec<f64>)>, BatchError> {
        let alone = for_each(self.alone.len(), |i| simulated(&self.alone[i].1, &self.alone[i].2));
        let named = alone.into_iter().zip(&self.alone).map(|(row, (index, ..))| match row {
            Ok(row) => Ok((*index, row)),
            Err(source) => Err(BatchError::Contact { index: *index, source }),
        });
        named.collect()
    }

    /// Fills the rows of the contacts that are simulated alone with what `simulated` says.
    fn one_by_one(
        &self,
        rows: &mut [f64],
        len: usize,
        simulated: impl Fn(&ContactModel, &Motion) -> Result<Vec<f64>, SimulateError> + Sync + Send,
    ) -> Result<(), BatchError> {
        for (index, row) in self.simulated_alone(simulated)? {
            rows[index * len..][..len].copy_from_slice(&row);
        }
        Ok(())
    }

    /// Rows of `len` finite numbers, or which contact has another.
    pub(super) fn checked<T: Copy + Into<f64>>(
        &self,
        rows: Vec<T>,
        len: usize,
        times: Option<&[f64]>,
    ) -> Result<Vec<T>, BatchError> {
        match rows.iter().position(|number| !(*number).into().is_finite()) {
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

    /// The contacts of the group that begins at `first`; past the last contact it is repeated.
    pub(super) fn group<const L: usize>(&self, first: usize) -> [usize; L] {
        std::array::from_fn(|lane| (first + lane).min(self.len() - 1))
    }

    /// Forces of some contacts in double precision, row by row.
    pub(super) fn forces_in_double(&self, contacts: &[usize], times: Option<&[f64]>) -> Vec<f64> {
        const L: usize = layer::GROUP;
        let row = times.map_or(1, <[f64]>::len);
        let mut forces = vec![0.0; contacts.len() * row];
        for_each_part(&mut forces, L * row, |index, part| {
            let group = std::array::from_fn(|lane| contacts[(index * L + lane).min(contacts.len() - 1)]);
            dispatch!(level(), simd => self.forces_of(simd, group, times, part));
        });
        forces
    }

    fn fill_forces(&self, times: Option<&[f64]>, forces: &mut [f64]) {
        let row = times.map_or(1, <[f64]>::len);
        for_each_part(forces, layer::GROUP * row, |index, part| {
            dispatch!(level(), simd => self.forces_of(simd, self.group(index * layer::GROUP), times, part));
        });
    }

    /// The forces of one group, contact by contact.
    #[inline(always)]
    fn forces_of<S: Simd>(&self, simd: S, group: [usize; layer::GROUP], times: Option<&[f64]>, part: &mut [f64]) {
        const L: usize = layer::GROUP;
        let mut stops = Stops::<L>::new(self, group);
        let exponent = stops.column(&self.exponent);
        let laws = Laws {
            power: Power::of(&exponent),
            exponent,
            rate_coefficient: stops.column(&self.rate_coefficient),
        };
        let (depth, layers) = (stops.column(&self.depth), stops.column(&self.layers));
        let bodies = Bodies::new(self, &stops);
        let mut contact = ContactLayers::new();
        let samples = times.map_or(1, <[f64]>::len);
        for sample in 0..samples {
            let targets = times.map_or_else(|| stops.ends(), |times| [times[sample]; L]);
            while let Some(leg) = stops.next(&targets) {
                let mut drive = [0.0; L];
                for lane in 0..L {
                    drive[lane] = leg.speed[lane] * (layers[lane] - 1.0) / depth[lane];
                }
                contact.advance(simd, &laws, &drive, &leg.elapsed);
            }
            let forces = bodies.forces(&contact.excess, &stops.displacement());
            for (row, force) in part.chunks_exact_mut(samples).zip(forces) {
                row[sample] = force;
            }
        }
    }

    /// The strains of one group, contact by contact and sample by sample.
    #[inline(always)]
    fn strains_of<S: Simd>(
        &self,
        simd: S,
        first: usize,
        times: &[f64],
        (tolerance, stride): (f64, usize),
        part: &mut [f64],
    ) {
        const L: usize = cascade::GROUP;
        let mut stops = Stops::<L>::new(self, self.group(first));
        let (depth, layers) = (stops.column(&self.depth), stops.column(&self.layers));
        let (begin, end) = (stops.time, stops.ends());
        let stack = Stack::new(
            stops.column(&self.exponent),
            stops.column(&self.rate_coefficient),
            layers,
            std::array::from_fn(|lane| end[lane] - begin[lane]),
        );
        let reach = stops.farthest();
        let allowed = std::array::from_fn(|lane| tolerance * (reach[lane] / depth[lane]).max(f64::MIN_POSITIVE));
        let start = stops.displacement();
        let mut cascade = Cascade::new(&stack, allowed, std::array::from_fn(|lane| start[lane] / depth[lane]));
        let mut width = [0.0; L];
        for (sample, &time) in times.iter().enumerate() {
            while let Some(leg) = stops.next(&[time; L]) {
                let (mut surface, mut speed) = ([0.0; L], [0.0; L]);
                for lane in 0..L {
                    surface[lane] = leg.from[lane] / depth[lane];
                    speed[lane] = leg.speed[lane] / depth[lane];
                    if leg.is_new[lane] {
                        width[lane] = leg.piece[lane] / 64.0;
                    }
                }
                cascade.advance(simd, &stack, (&surface, &speed), &leg.elapsed, width);
                width = cascade.width();
            }
            let u = stops.displacement();
            for (lane, row) in part.chunks_exact_mut(times.len() * stride).enumerate() {
                let row = &mut row[sample * stride..][..layers[lane] as usize];
                let mut outer = u[lane] / depth[lane];
                for (layer, strain) in row.iter_mut().enumerate() {
                    let inner = if layer + 1 < layers[lane] as usize { cascade.nodes()[layer * L + lane] } else { 0.0 };
                    *strain = layers[lane] * (outer - inner);
                    outer = inner;
                }
            }
        }
    }
}

/// Strain of every layer of every contact of a batch.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerStrains {
    /// Contact by contact, sample by sample, `stride` layers each.
    strains: Vec<f64>,
    layers: Vec<usize>,
    samples: usize,
    stride: usize,
}

impl LayerStrains {
    /// Strains of the layers of a contact at a sample, the contact layer first.
    ///
    /// # Panics
    /// If there is no such contact or sample.
    #[must_use]
    pub fn of(&self, contact: usize, sample: usize) -> &[f64] {
        assert!(sample < self.samples, "sample {sample} of {}", self.samples);
        &self.strains[(contact * self.samples + sample) * self.stride..][..self.layers[contact]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::latency::LatencyLaw;
    use crate::test_problems::{paper_ball, paper_test_a};
    use crate::vector::tests::on_every_level;

    #[test]
    fn the_same_bits_on_every_instruction_set() {
        for exponents in [[1.0; 32], [2.0; 32], [5.0; 32], std::array::from_fn(|lane| 0.7 + 0.2 * lane as f64)] {
            let models = exponents.map(|n| ContactModel {
                law: LatencyLaw::new(n, 300.0).unwrap(),
                ..paper_ball(Separation::Bonded)
            });
            let batch = Batch::shared(&models, &paper_test_a()).unwrap();
            on_every_level(|| {
                // On this thread, which is the one that pretends.
                let mut forces = vec![0.0; 32];
                dispatch!(level(), simd => batch.forces_of(simd, batch.group(0), None, &mut forces));
                let mut strains = vec![0.0; 8 * 8];
                dispatch!(level(), simd => batch.strains_of(simd, 0, &[43.0], (1e-8, 8), &mut strains));
                forces.extend(strains);
                forces
            });
        }
    }
}
