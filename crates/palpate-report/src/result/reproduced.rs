//! The paper's study: both tests simulated, re-identified, and checked against what the paper reports.

use palpate::analysis::{Analysis, HoldAnalysis};
use palpate::simulate::{ContactModel, StrainWave, Trajectory};

use crate::page::Check;

/// One test of the paper, simulated and analysed.
#[derive(Debug, Clone)]
pub struct ReproducedTest {
    /// Bonded contact, as in the paper.
    pub bonded: Trajectory,
    /// The jaw can leave the ball.
    pub unilateral: Trajectory,
    /// All layers (bonded).
    pub wave: StrainWave,
    /// The bonded record analysed as if it had been measured.
    pub analysis: Analysis,
}

/// The whole study.
#[derive(Debug, Clone)]
pub struct Reproduction {
    /// The model.
    pub model: ContactModel,
    /// Test (a): loading in five steps.
    pub test_a: ReproducedTest,
    /// Test (b): one loading, unloading in steps.
    pub test_b: ReproducedTest,
    /// What the paper reports in words, checked.
    pub checks: Vec<Check>,
}

impl Reproduction {
    /// Whether every check passes.
    #[must_use]
    pub fn all_passed(&self) -> bool {
        self.checks.iter().all(|check| check.passed)
    }

    /// Largest relative error of a re-identified rate coefficient.
    #[must_use]
    pub fn largest_coefficient_error(&self) -> f64 {
        let v = self.model.law.rate_coefficient();
        let holds = self.test_a.analysis.holds.iter().chain(&self.test_b.analysis.holds);
        let fits = holds.filter_map(|hold| hold.fit_with(self.model.law.exponent()));
        fits.map(|fit| (fit.rate_coefficient().value / v - 1.0).abs()).fold(0.0, f64::max)
    }
}

impl ReproducedTest {
    /// Holds with a contact: the last one, at first touch, has none.
    pub fn loaded(&self) -> impl Iterator<Item = &HoldAnalysis> {
        self.analysis.holds.iter().filter(|hold| hold.displacement.is_some_and(|d| d > 1e-4))
    }
}
