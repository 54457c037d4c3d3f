//! The latency law with an equilibrium strain and a rate coefficient that vary from step to step, as Table I has them.

use crate::contact::{Element, Ramps, SimulationWork, Specimen};
use crate::latency::LatencyLaw;
use crate::simulate::{Motion, Separation};

use super::published::STEPS;
use super::{PaperError, Published};

/// An equilibrium strain and a rate coefficient for every displacement that is held.
///
/// Between two levels the equilibrium strain is linear in the displacement, from 0 at first touch; there, v is that of the upper level.
/// The contact layer takes travel of the jaw as in section IV, ε̇ = u̇₁ m/r − v xⁿ, hence ẋ = u̇₁ (m/r − dε_e/du₁) − v xⁿ, and the force is
/// that of equation (11). With ε_e = u₁/r and one v it is the simulation of the paper.
///
/// ```
/// use palpate::paper::{Published, SteppedLaw};
/// let paper = Published::default();
/// let times = [0.6, 10.6]; // s
/// let uniform = SteppedLaw::uniform(&paper)?.forces(&paper, &paper.test_a()?, &times)?;
/// assert!((uniform[1] - 1.556_133_431_7).abs() < 1e-8); // N: the paper's simulation
/// let table = SteppedLaw::table_1(&paper).forces(&paper, &paper.test_a()?, &times)?;
/// assert!(table[1] > 1.8 * uniform[1]);
/// # Ok::<(), palpate::paper::PaperError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SteppedLaw {
    /// ε_e at the levels, compression positive.
    pub equilibria: [f64; STEPS],
    /// v at the levels, 1/s.
    pub coefficients: [f64; STEPS],
}

impl SteppedLaw {
    /// The simulation of section IV: ε_e = u₁/r and one v.
    ///
    /// # Errors
    /// [`PaperError::Specimen`] for a body that is none.
    pub fn uniform(paper: &Published) -> Result<Self, PaperError> {
        Ok(Self {
            equilibria: paper.uniform_strains()?,
            coefficients: [paper.simulated_coefficient; STEPS],
        })
    }

    /// Table I: its strains, and v where it is legible; elsewhere ln v follows the least-squares line over ε_e through the legible ones.
    #[must_use]
    pub fn table_1(paper: &Published) -> Self {
        let legible = || paper.equilibria.iter().zip(paper.coefficients).filter_map(|(e, v)| Some((*e, v?.ln())));
        let count = legible().count().max(1) as f64;
        let (mx, my) = legible().fold((0.0, 0.0), |(x, y), p| (x + p.0 / count, y + p.1 / count));
        let xx: f64 = legible().map(|p| (p.0 - mx).powi(2)).sum();
        let xy: f64 = legible().map(|p| (p.0 - mx) * (p.1 - my)).sum();
        let slope = if xx > 0.0 { xy / xx } else { 0.0 };
        let line = |strain: f64| (my + slope * (strain - mx)).exp();
        Self {
            equilibria: paper.equilibria,
            coefficients: std::array::from_fn(|step| {
                paper.coefficients[step].unwrap_or_else(|| line(paper.equilibria[step]))
            }),
        }
    }

    /// The same with every equilibrium strain but that of the highest level times a factor: a body softened by its largest squeeze.
    #[must_use]
    pub(super) fn softened(mut self, factor: f64) -> Self {
        self.equilibria[..STEPS - 1].iter_mut().for_each(|strain| *strain *= factor);
        self
    }

    /// Contact forces (N) at rising `times` (s) inside a motion that stays between first touch and the highest level; bonded.
    ///
    /// # Errors
    /// [`PaperError`] for numbers that make no body or law.
    pub fn forces(&self, paper: &Published, motion: &Motion, times: &[f64]) -> Result<Vec<f64>, PaperError> {
        let model = paper.model(Separation::Bonded)?;
        let specimen = &model.specimen;
        let (mut excess, mut work) = (0.0, SimulationWork::default());
        let mut forces = Vec::with_capacity(times.len());
        for piece in self.pieces(paper, specimen, motion) {
            let law = LatencyLaw::new(paper.exponent, self.coefficients[piece.level])?;
            let drive = piece.speed * (paper.layers / paper.radius - piece.slope);
            let duration = piece.end - piece.start;
            let element = Element::solve(law, excess, drive, duration, &mut Ramps::default(), &mut work);
            let inside = times[forces.len()..].iter().take_while(|time| **time <= piece.end);
            let found: Vec<f64> = inside
                .map(|time| {
                    let elapsed = (time - piece.start).max(0.0);
                    let u = piece.from + piece.speed * elapsed;
                    let equilibrium = piece.equilibrium + piece.slope * (u - piece.from);
                    specimen.force(equilibrium + element.excess_at(elapsed), u)
                })
                .collect();
            forces.extend(found);
            excess = element.excess_at(duration);
        }
        Ok(forces)
    }

    /// The motion of one contact cut at the levels.
    fn pieces(&self, paper: &Published, specimen: &Specimen, motion: &Motion) -> Vec<Piece> {
        let u: Vec<f64> = paper.levels.iter().map(|level| specimen.contact_displacement(*level)).collect();
        // First touch, then the levels: contact displacement and equilibrium strain.
        let knots: Vec<(f64, f64)> = [(0.0, 0.0)].into_iter().chain(u.into_iter().zip(self.equilibria)).collect();
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9 * paper.radius;
        let mut pieces = Vec::new();
        let times = motion.times().windows(2).zip(motion.displacements().windows(2));
        for (time, jaw) in times {
            let (from, to) = (specimen.contact_displacement(jaw[0]), specimen.contact_displacement(jaw[1]));
            if near(from, to) {
                let level = knots[1..].iter().position(|knot| near(knot.0, from)).unwrap_or(0);
                let equilibrium = if near(from, 0.0) { 0.0 } else { self.equilibria[level] };
                pieces.push(Piece {
                    start: time[0],
                    end: time[1],
                    from,
                    speed: 0.0,
                    equilibrium,
                    slope: 0.0,
                    level,
                });
                continue;
            }
            let speed = (to - from) / (time[1] - time[0]);
            let mut between: Vec<usize> = (1..knots.len())
                .filter(|k| from.max(to) > knots[k - 1].0 + 1e-12 && from.min(to) < knots[*k].0 - 1e-12)
                .collect();
            if speed < 0.0 {
                between.reverse();
            }
            let (mut start, mut place) = (time[0], from);
            for (index, k) in between.iter().enumerate() {
                let ((low, e_low), (high, e_high)) = (knots[k - 1], knots[*k]);
                let slope = (e_high - e_low) / (high - low);
                let last = index + 1 == between.len();
                let next = if last {
                    to
                } else if speed > 0.0 {
                    high
                } else {
                    low
                };
                let end = if last { time[1] } else { start + (next - place) / speed };
                pieces.push(Piece {
                    start,
                    end,
                    from: place,
                    speed,
                    equilibrium: e_low + slope * (place - low),
                    slope,
                    level: k - 1,
                });
                (start, place) = (end, next);
            }
        }
        pieces
    }
}

/// A straight piece of the motion of one contact between two levels, or a hold at one.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start: f64,
    end: f64,
    /// Contact displacement at its start, m.
    from: f64,
    /// Speed of the contact, m/s.
    speed: f64,
    /// Equilibrium strain at its start.
    equilibrium: f64,
    /// dε_e/du₁, 1/m.
    slope: f64,
    /// Index of the level whose v holds.
    level: usize,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::simulate_force;

    #[test]
    fn one_law_for_all_steps_is_the_simulation_of_the_paper() {
        let paper = Published::default();
        let law = SteppedLaw::uniform(&paper).unwrap();
        let model = paper.model(Separation::Bonded).unwrap();
        for motion in [paper.test_a().unwrap(), paper.test_b().unwrap()] {
            let times: Vec<f64> = (0..=6600).map(|i| 0.01 * f64::from(i)).filter(|t| *t <= motion.end()).collect();
            let found = law.forces(&paper, &motion, &times).unwrap();
            let expected = simulate_force(&motion, &model, &times).unwrap();
            assert_eq!(found.len(), times.len());
            for ((time, a), b) in times.iter().zip(&found).zip(&expected) {
                assert!((a - b).abs() < 1e-8, "{time} s: {a} N, not {b} N");
            }
        }
    }

    #[test]
    fn illegible_coefficients_follow_the_legible_ones() {
        let paper = Published::default();
        let found = SteppedLaw::table_1(&paper).coefficients;
        assert_eq!((found[1], found[2]), (2.6e4, 2.0e4));
        // ln v falls by ln 1.3 from a strain of 0.2193 to 0.2623.
        let slope = (2.0f64 / 2.6).ln() / (0.2623 - 0.2193);
        assert!((found[0] / (2.6e4 * (slope * (0.1661 - 0.2193)).exp()) - 1.0).abs() < 1e-12);
        assert!(found.windows(2).all(|pair| pair[1] < pair[0]));
        let none = Published {
            coefficients: [None, None, Some(2e4), None, None],
            ..paper
        };
        assert!(SteppedLaw::table_1(&none).coefficients.iter().all(|v| (v / 2e4 - 1.0).abs() < 1e-12));
    }
}
