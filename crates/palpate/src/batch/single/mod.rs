//! Forces of a batch in single precision.
//!
//! | file | what |
//! |---|---|
//! | `mod.rs` | forces of all contacts; which of them go to double precision |
//! | `layer.rs` | contact layers: units in which single precision does, closed form in holds |
//! | `ramp.rs` | ramps by quadrature and Newton's method |

mod layer;
mod ramp;

use fearless_simd::dispatch;

use super::body::Bodies;
use super::contacts::{Batch, BatchError};
use super::parallel::for_each_part;
use super::stops::Stops;
use crate::simulate::simulate_force;
use crate::vector::level;
use layer::ContactLayers;
use ramp::LANES;

impl Batch {
    /// Contact force (N) of every contact at the end of its motion, in single precision: within 10⁻⁵ of the largest force of a contact.
    ///
    /// The equations are those of [`final_forces`](Self::final_forces), ẋ = g − v sgn(x)|x|ⁿ and F = E (x + u₁/depth) A(u₁). A hold is the
    /// closed form (4), (5), z exp(−ln(1 + (n − 1) λt)/(n − 1)); the time that a ramp takes from one place to another is an integral, and
    /// the place at a time is found by Newton's method. Strains are in units of the largest u₁/depth, and what has been summed up (times,
    /// displacements and the excess itself) stays in double precision.
    ///
    /// **Accuracy**, measured against double precision at the knots and nine times between any two, in units of the largest force of a
    /// contact: 3.4·10⁻⁷ at most over n = 0.5, 1, 1.5, 2, 3, 5, 7.3, six decades of v, m = 2, 8, 8.5, 64, 512, balls, pads and strips, ramps from
    /// a millisecond to a day and holds from a millisecond to thirty days. 10⁻⁵ is what is promised, and was kept in 90,000 random contacts
    /// with n from 0.5 to 8 and m up to 630.
    ///
    /// What single precision cannot do is done in double precision, at its speed: exponents below 0.5 and above 8, laws so
    /// slow or so fast that powers of them leave the range of single precision (κt beyond 10³⁰, κ = v (u₁/depth)ⁿ⁻¹), ramps that begin
    /// at an excess of 10⁶ times their steady one, and the contacts that are simulated one by one. Strains of layers are in double
    /// precision only: with m layers they are m differences of nodes, and 512 layers would leave five digits of seven.
    ///
    /// Results are the same bits on any number of threads and on every instruction set.
    ///
    /// # Errors
    /// [`BatchError::Contact`] if the numbers of a contact leave the range of doubles, or its force (N) that of single precision, 3·10³⁸.
    ///
    /// ```
    /// use palpate::batch::Batch;
    /// use palpate::simulate::{ProtocolStep, Separation, protocol};
    /// use palpate::test_problems::paper_ball;
    ///
    /// // The paper's ball, squeezed by 5 mm at 500 mm/min and held for 10 s.
    /// let motion = protocol(&[ProtocolStep { to: 5e-3, rate: 0.5 / 60.0, hold: 10.0 }])?;
    /// let forces = Batch::shared(&vec![paper_ball(Separation::Unilateral); 100], &motion)?.final_forces_single()?;
    /// // 1.5561334317 N after relaxation, 3.0350250075 N at most
    /// assert!((f64::from(forces[0]) - 1.556_133_431_7).abs() < 1e-5 * 3.035);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn final_forces_single(&self) -> Result<Vec<f32>, BatchError> {
        self.forces_single(None)
    }

    /// Contact force (N) of every contact at rising `times` (s), which lie inside its motion, in single precision: those of contact i are
    /// the i-th row of `times.len()` numbers.
    ///
    /// Accuracy and limits are those of [`final_forces_single`](Self::final_forces_single), however many samples and knots: every stretch
    /// between two of them adds what it adds to a few 10⁻⁷, and sums are in double precision.
    ///
    /// # Errors
    /// As for [`forces_at`](Self::forces_at), and as for [`final_forces_single`](Self::final_forces_single).
    ///
    /// ```
    /// use palpate::batch::Batch;
    /// use palpate::simulate::Separation;
    /// use palpate::test_problems::{paper_ball, paper_test_a};
    ///
    /// let batch = Batch::shared(&vec![paper_ball(Separation::Bonded); 20], &paper_test_a())?;
    /// let forces = batch.forces_at_single(&[0.6, 43.0])?;
    /// // 30.9911170463 N at the end of the fifth ramp, which is the largest of all
    /// assert!((f64::from(forces[2 * 19 + 1]) - 30.991_117_046_3).abs() < 1e-5 * 31.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn forces_at_single(&self, times: &[f64]) -> Result<Vec<f32>, BatchError> {
        self.check_times(times)?;
        self.forces_single(Some(times))
    }

    fn forces_single(&self, times: Option<&[f64]>) -> Result<Vec<f32>, BatchError> {
        let row = times.map_or(1, <[f64]>::len);
        let mut forces = vec![0.0; self.len() * row];
        for_each_part(&mut forces, LANES * row, |index, part| {
            dispatch!(level(), _simd => self.single_of(index * LANES, times, part));
        });
        let alone = self.simulated_alone(|model, motion| match times {
            Some(times) => simulate_force(motion, model, times),
            None => simulate_force(motion, model, &[motion.end()]),
        })?;
        for (index, found) in alone {
            replace(&mut forces, row, index, &found);
        }
        let doubtful: Vec<usize> = (0..self.len())
            .filter(|index| forces[index * row..][..row].iter().any(|force| force.is_nan()))
            .collect();
        let found = self.forces_in_double(&doubtful, times);
        for (place, &index) in doubtful.iter().enumerate() {
            replace(&mut forces, row, index, &found[place * row..][..row]);
        }
        self.checked(forces, row, times)
    }

    /// The forces of one group, contact by contact; NaN where single precision does not do.
    #[inline(always)]
    fn single_of(&self, first: usize, times: Option<&[f64]>, part: &mut [f32]) {
        let mut stops = Stops::<LANES>::new(self, self.group(first));
        let (depth, layers) = (stops.column(&self.depth), stops.column(&self.layers));
        let bodies = Bodies::new(self, &stops);
        let farthest = stops.farthest();
        let mut largest = [0.0; LANES];
        for lane in 0..LANES {
            largest[lane] = farthest[lane] / depth[lane];
        }
        let (exponent, rate_coefficient) = (stops.column(&self.exponent), stops.column(&self.rate_coefficient));
        let mut contact = ContactLayers::new(&exponent, &rate_coefficient, &largest);
        let samples = times.map_or(1, <[f64]>::len);
        for sample in 0..samples {
            let targets = times.map_or_else(|| stops.ends(), |times| [times[sample]; LANES]);
            while let Some(leg) = stops.next(&targets) {
                let mut drive = [0.0; LANES];
                for lane in 0..LANES {
                    drive[lane] = leg.speed[lane] * (layers[lane] - 1.0) / depth[lane];
                }
                contact.advance(&drive, &leg.elapsed);
            }
            let forces = bodies.forces(&contact.strains(), &stops.displacement());
            for (row, force) in part.chunks_exact_mut(samples).zip(forces) {
                row[sample] = force as f32;
            }
        }
    }
}

/// Puts what was found in double precision in the place of the row of a contact.
fn replace(forces: &mut [f32], row: usize, index: usize, found: &[f64]) {
    for (force, found) in forces[index * row..][..row].iter_mut().zip(found) {
        *force = *found as f32;
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
        for exponents in
            [[1.0; 16], [2.0; 16], [3.0; 16], [5.0; 16], std::array::from_fn(|lane| 0.6 + 0.45 * lane as f64)]
        {
            let models = exponents.map(|n| ContactModel {
                law: LatencyLaw::new(n, 300.0).unwrap(),
                ..paper_ball(Separation::Bonded)
            });
            let batch = Batch::shared(&models, &paper_test_a()).unwrap();
            let forces = on_every_level(|| {
                // On this thread, which is the one that pretends.
                let mut forces = vec![0.0; 32];
                dispatch!(level(), _simd => batch.single_of(0, Some(&[43.2, 66.0]), &mut forces));
                forces.into_iter().map(f64::from).collect()
            });
            assert!(forces.iter().all(|force| force.is_finite()));
        }
    }
}
