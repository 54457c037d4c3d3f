//! The balls that laboratories measure.

use crate::simulate::{LinearContact, LinearLaw, LinearTerm, Memory, Motion, Separation, simulate_force};

use super::super::{PaperError, Published, SteppedLaw};
use super::Conclusion;

/// By how much the softened ball's equilibrium strains are lower after the largest squeeze.
const SOFTENING: f64 = 0.8;

/// The ball that a laboratory measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ball {
    /// The simulation of section IV: n = 5, one v, ε_e = u₁/r.
    OneLaw,
    /// Table I: ε_e and v vary from step to step ([`SteppedLaw::table_1`]).
    TableOne,
    /// Table I, but in test (b) ε_e below the largest squeeze is a fifth lower: it is not the same after loading and after unloading.
    Softened,
    /// Linear viscoelasticity with relaxation times of 0.1, 1, 10 and 100 s, for which the law was not made; its excess strain is that of
    /// the law at the peak and after 10 s.
    Linear,
}

impl Ball {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::OneLaw, Self::TableOne, Self::Softened, Self::Linear];

    /// As people read it.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::OneLaw => "one law: n = 5, one v, εₑ = u₁/r",
            Self::TableOne => "Table I: n = 5, εₑ and v by step",
            Self::Softened => "Table I, εₑ a fifth lower in test (b)",
            Self::Linear => "linear, relaxation times 0.1 to 100 s",
        }
    }

    /// Whether the conclusion is true of it; `None` where it has no such property.
    #[must_use]
    pub fn truth(self, conclusion: Conclusion) -> Option<bool> {
        match (self, conclusion) {
            (Self::Linear, Conclusion::FallingCoefficient) => None,
            (Self::Linear, Conclusion::OrderFive) => Some(false),
            (_, Conclusion::OrderFive) => Some(true),
            (Self::OneLaw, Conclusion::FallingCoefficient) => Some(false),
            (_, Conclusion::FallingCoefficient) => Some(true),
            (Self::Softened, Conclusion::EqualEquilibria) => Some(false),
            (_, Conclusion::EqualEquilibria) => Some(true),
        }
    }

    /// Contact forces (N) in one of the tests, without errors of measurement.
    pub(super) fn forces(
        self,
        paper: &Published,
        motion: &Motion,
        descending: bool,
        times: &[f64],
    ) -> Result<Vec<f64>, PaperError> {
        match self {
            Self::OneLaw => SteppedLaw::uniform(paper)?.forces(paper, motion, times),
            Self::TableOne => SteppedLaw::table_1(paper).forces(paper, motion, times),
            Self::Softened => {
                let law = SteppedLaw::table_1(paper);
                if descending { law.softened(SOFTENING) } else { law }.forces(paper, motion, times)
            }
            Self::Linear => {
                let terms = [(1.0, 10.0), (1.0, 1.0), (0.6, 0.1), (0.25, 0.01)];
                let contact = LinearContact {
                    specimen: paper.specimen()?,
                    law: LinearLaw::new(&terms.map(|(overshoot, rate)| LinearTerm { overshoot, rate }))?,
                    memory: Memory::Strain,
                    separation: Separation::Bonded,
                };
                Ok(simulate_force(motion, &contact, times)?)
            }
        }
    }
}
