//! The numbers that the paper states.

use crate::contact::{Layers, Shape, Sides, Specimen};
use crate::latency::LatencyLaw;
use crate::simulate::{ContactModel, Motion, ProtocolStep, Separation, protocol};

use super::PaperError;

/// Steps of the tests.
pub const STEPS: usize = 5;

/// The numbers that the paper states, in SI units, compression positive. [`Default`] has them as printed; a changed one shows which
/// verdicts depend on it.
///
/// ```
/// use palpate::paper::Published;
/// let paper = Published::default();
/// // Table I, step 1: a strain of −0.1661 at 5 mm; half of the travel over the radius is 0.0714.
/// assert_eq!(paper.equilibria[0], 0.1661);
/// assert!((paper.uniform_strains()?[0] - 2.5 / 35.0).abs() < 1e-15);
/// # Ok::<(), palpate::paper::PaperError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// Radius of the ball, m (section III-A).
    pub radius: f64,
    /// Young's modulus, Pa (section III-C).
    pub modulus: f64,
    /// Displacements that are held, m, ascending (section III-B).
    pub levels: [f64; STEPS],
    /// Speed of the fixture, m/s (section III-B).
    pub speed: f64,
    /// Duration of a hold, s (section III-B).
    pub hold: f64,
    /// n (equation 10).
    pub exponent: f64,
    /// m (figure 7).
    pub layers: f64,
    /// |ε_e| of Table I.
    pub equilibria: [f64; STEPS],
    /// v of Table I where it is legible, 1/s.
    pub coefficients: [Option<f64>; STEPS],
    /// v of the simulation, 1/s. The paper states none for figure 8; this is the one of step 3 of Table I, the middle of the steps.
    pub simulated_coefficient: f64,
    /// Accuracy of the load cell, N (section III-A).
    pub force_accuracy: f64,
    /// Accuracy of the displacement, m (section III-A).
    pub displacement_accuracy: f64,
    /// Largest force of inertia of the fixture, N (section III-A).
    pub inertia_force: f64,
    /// Share of the typical force below which it is stated to stay (section III-A).
    pub inertia_share: f64,
    /// Start of the last unloading of test (a), s (section IV-B).
    pub last_unloading: f64,
}

impl Published {
    /// Half of the last printed digit of a strain of Table I.
    pub const STRAIN_ROUNDING: f64 = 5e-5;
    /// Half of the last printed digit of v in Table I, 1/s.
    pub const COEFFICIENT_ROUNDING: f64 = 500.0;

    /// The ball between the two jaws.
    ///
    /// # Errors
    /// [`PaperError::Specimen`] for a radius or modulus that is not above 0.
    pub fn specimen(&self) -> Result<Specimen, PaperError> {
        Ok(Specimen::new(Shape::Ball { radius: self.radius }, self.modulus, Sides::Two)?)
    }

    /// The model of section IV.
    ///
    /// # Errors
    /// [`PaperError`] for numbers that make no body, law or layers.
    pub fn model(&self, separation: Separation) -> Result<ContactModel, PaperError> {
        Ok(ContactModel {
            specimen: self.specimen()?,
            law: LatencyLaw::new(self.exponent, self.simulated_coefficient)?,
            layers: Layers::new(self.layers)?,
            separation,
        })
    }

    /// Test (a): the levels one after the other, each held, then back to first touch.
    ///
    /// # Errors
    /// [`PaperError::Motion`] for levels, a speed or a hold that make no motion.
    pub fn test_a(&self) -> Result<Motion, PaperError> {
        self.motion(self.levels.iter())
    }

    /// Test (b): the highest level first, then down through all of them.
    ///
    /// # Errors
    /// As for [`test_a`](Self::test_a).
    pub fn test_b(&self) -> Result<Motion, PaperError> {
        self.motion(self.levels.iter().rev())
    }

    fn motion<'a>(&self, levels: impl Iterator<Item = &'a f64>) -> Result<Motion, PaperError> {
        let step = |to: &f64| ProtocolStep {
            to: *to,
            rate: self.speed,
            hold: self.hold,
        };
        Ok(protocol(&levels.chain([&0.0]).map(step).collect::<Vec<_>>())?)
    }

    /// Contact displacements of the levels, m.
    ///
    /// # Errors
    /// As for [`specimen`](Self::specimen).
    pub fn contact_displacements(&self) -> Result<[f64; STEPS], PaperError> {
        let specimen = self.specimen()?;
        Ok(self.levels.map(|level| specimen.contact_displacement(level)))
    }

    /// Equilibrium strains of the simulation at the levels, u₁/r (section IV-A, step 2).
    ///
    /// # Errors
    /// As for [`specimen`](Self::specimen).
    pub fn uniform_strains(&self) -> Result<[f64; STEPS], PaperError> {
        Ok(self.contact_displacements()?.map(|u| u / self.radius))
    }

    /// The strain that the accuracy of the load cell amounts to at a contact displacement (m), by equation (8).
    pub(super) fn accuracy_in_strain(&self, specimen: &Specimen, u: f64) -> f64 {
        self.force_accuracy / specimen.force(1.0, u)
    }

    /// The times of a test at which its holds begin, s, with the level of each.
    pub(super) fn holds(&self, descending: bool) -> Vec<(f64, usize)> {
        let (mut time, mut place) = (0.0, 0.0);
        let order = |step: usize| if descending { STEPS - 1 - step } else { step };
        (0..STEPS)
            .map(|step| {
                let level = order(step);
                time += (self.levels[level] - place).abs() / self.speed;
                place = self.levels[level];
                let start = time;
                time += self.hold;
                (start, level)
            })
            .collect()
    }
}

impl Default for Published {
    fn default() -> Self {
        Self {
            radius: 0.035,
            modulus: 28e3,
            levels: [5e-3, 10e-3, 15e-3, 20e-3, 25e-3],
            speed: 0.5 / 60.0,
            hold: 10.0,
            exponent: 5.0,
            layers: 8.0,
            equilibria: [0.1661, 0.2193, 0.2623, 0.3031, 0.3144],
            coefficients: [None, Some(2.6e4), Some(2.0e4), None, None],
            simulated_coefficient: 2.0e4,
            force_accuracy: 0.2,
            displacement_accuracy: 1e-6,
            inertia_force: 0.35,
            inertia_share: 0.01,
            last_unloading: 53.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_problems::{paper_ball, paper_test_a, paper_test_b};

    #[test]
    fn the_numbers_are_those_of_the_known_problem() {
        let paper = Published::default();
        assert_eq!(paper.model(Separation::Bonded).unwrap(), paper_ball(Separation::Bonded));
        assert_eq!((paper.test_a().unwrap(), paper.test_b().unwrap()), (paper_test_a(), paper_test_b()));
        let starts: Vec<f64> = paper.holds(true).iter().map(|(start, _)| *start).collect();
        let expected = [3.0, 13.6, 24.2, 34.8, 45.4];
        assert!(starts.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{starts:?}");
    }

    #[test]
    fn numbers_of_no_body_are_refused() {
        let bad = |change: fn(&mut Published)| {
            let mut paper = Published::default();
            change(&mut paper);
            paper.model(Separation::Bonded).is_err() || paper.test_a().is_err()
        };
        assert!(
            bad(|paper| paper.radius = -1.0) && bad(|paper| paper.exponent = 0.0) && bad(|paper| paper.layers = 0.5)
        );
        assert!(bad(|paper| paper.speed = 0.0) && bad(|paper| paper.levels[2] = f64::NAN));
    }
}
