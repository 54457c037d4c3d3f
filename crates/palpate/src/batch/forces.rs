//! Forces of all contacts.

use fearless_simd::{Simd, dispatch};

use super::body::Bodies;
use super::contacts::{Batch, BatchError};
use super::layer::{self, ContactLayers, Laws};
use super::parallel::for_each_part;
use super::stops::Stops;
use crate::latency::lanes::Power;
use crate::simulate::simulate_force;
use crate::vector::level;

impl Batch {
    /// Contact force (N) of every contact at the end of its motion.
    ///
    /// # Errors
    /// [`BatchError::Contact`] if the numbers of a contact leave the range of doubles.
    pub fn final_forces(&self) -> Result<Vec<f64>, BatchError> {
        self.forces(None)
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
        self.forces(Some(times))
    }

    fn forces(&self, times: Option<&[f64]>) -> Result<Vec<f64>, BatchError> {
        let row = times.map_or(1, <[f64]>::len);
        let mut forces = vec![0.0; self.len() * row];
        for_each_part(&mut forces, layer::GROUP * row, |index, part| {
            dispatch!(level(), simd => self.forces_of(simd, index * layer::GROUP, times, part));
        });
        self.one_by_one(&mut forces, row, |model, motion| {
            simulate_force(motion, model, times.unwrap_or(&[motion.end()]))
        })?;
        self.checked(forces, row, times)
    }

    /// The forces of one group, contact by contact.
    #[inline(always)]
    fn forces_of<S: Simd>(&self, simd: S, first: usize, times: Option<&[f64]>, part: &mut [f64]) {
        const L: usize = layer::GROUP;
        let mut stops = Stops::<L>::new(self, first);
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::latency::LatencyLaw;
    use crate::simulate::{ContactModel, Separation};
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
                dispatch!(level(), simd => batch.forces_of(simd, 0, None, &mut forces));
                let mut strains = vec![0.0; 8 * 8];
                dispatch!(level(), simd => batch.strains_of(simd, 0, &[43.0], (1e-8, 8), &mut strains));
                forces.extend(strains);
                forces
            });
        }
    }
}
