//! The paper, claim by claim.
//!
//! The numbers that the paper states come in; out go its tests simulated and analysed, laboratories that repeat them, and a verdict on every
//! equation, figure, table and statement.
//!
//! | file | what |
//! |---|---|
//! | `published.rs` | the numbers that the paper states |
//! | `error.rs` | why a study could not be made |
//! | `equations.rs` | the equations as the paper prints them |
//! | `stepped.rs` | the law with parameters that vary from step to step, as Table I has them |
//! | `study.rs` | one test simulated, and analysed as if measured |
//! | `explanations.rs` | why the strains of Table I are not those of the simulation |
//! | `sensitivity.rs` | how force and relaxation depend on the parameters |
//! | `laboratory/` | many laboratories with the paper's instrument |
//! | `claim.rs` | a statement, its comparisons and its verdict |
//! | `claims/` | every equation, figure, table and statement of the paper |

mod claim;
mod claims;
mod equations;
mod error;
mod explanations;
mod laboratory;
mod published;
mod sensitivity;
mod stepped;
mod study;

pub use claim::{Claim, Comparison, Evidence, Place, Relation, Value, Verdict};
pub use claims::record_claims;
pub use error::PaperError;
pub use explanations::{Explained, Explanation, LastUnloading, StepForces, explanations, last_unloadings, step_forces};
pub use laboratory::{
    Ball, Conclusion, HIGHEST_RATE, Laboratories, LaboratoryOptions, MOST_SEEDS, Method, ORDERS, Readings, Share,
    laboratories,
};
pub use published::{Published, STEPS};
pub use sensitivity::{Sensitivities, Sensitivity, SensitivityParameter, sensitivities};
pub use stepped::SteppedLaw;
pub use study::ReproducedTest;

use crate::simulate::{ContactModel, Separation};
use crate::watch::{Progress, Watch};

/// The paper's study.
#[derive(Debug, Clone)]
pub struct Reproduction {
    /// The numbers that it is made of.
    pub published: Published,
    /// Laboratories and their sampling rate.
    pub options: LaboratoryOptions,
    /// The model of section IV.
    pub model: ContactModel,
    /// Test (a): loading in five steps.
    pub test_a: ReproducedTest,
    /// Test (b): one loading, unloading in steps.
    pub test_b: ReproducedTest,
    /// The steps of test (a), by uniform strain and by Table I.
    pub step_forces: Vec<StepForces>,
    /// Why the strains of Table I are not those of the simulation.
    pub explanations: Vec<Explained>,
    /// The last unloading of test (a) by the number of layers.
    pub last_unloadings: Vec<LastUnloading>,
    /// How force and relaxation depend on the parameters.
    pub sensitivities: Sensitivities,
    /// What laboratories conclude.
    pub laboratories: Vec<Laboratories>,
    /// Every equation, figure, table and statement, what is not reproduced first.
    pub claims: Vec<Claim>,
}

impl Reproduction {
    /// Number of claims with this verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.claims.iter().filter(|claim| claim.verdict() == verdict).count()
    }
}

/// Simulates and analyses both tests of the paper, lets laboratories repeat them, and judges every claim.
///
/// ```
/// use palpate::paper::{LaboratoryOptions, Place, Published, Verdict, reproduce};
/// use palpate::watch::Unwatched;
/// let few = LaboratoryOptions { seeds: 4, sample_rate: 20.0, ..LaboratoryOptions::default() };
/// let study = reproduce(&Published::default(), &few, &mut Unwatched)?;
/// // Table I has a strain of −0.1661 at 5 mm, the simulation −0.0714.
/// let first = &study.claims[0];
/// assert_eq!((first.place, first.verdict()), (Place::Section("Abstract"), Verdict::NotReproduced));
/// assert!((first.comparisons[0].ours.value + 2.5 / 35.0).abs() < 1e-12);
/// assert_eq!(first.comparisons[0].paper.value, -0.1661);
/// # Ok::<(), palpate::paper::PaperError>(())
/// ```
///
/// # Errors
/// [`PaperError`] for numbers that make no body, law or motion, options out of range, and a watch that ends it.
pub fn reproduce(
    published: &Published,
    options: &LaboratoryOptions,
    watch: &mut dyn Watch,
) -> Result<Reproduction, PaperError> {
    watch.report(Progress::open("simulating and analysing the paper's tests", 0))?;
    let model = published.model(Separation::Bonded)?;
    let mut study = Reproduction {
        test_a: ReproducedTest::new(&published.test_a()?, &model, watch)?,
        test_b: ReproducedTest::new(&published.test_b()?, &model, watch)?,
        model,
        step_forces: step_forces(published)?,
        explanations: explanations(published)?,
        last_unloadings: last_unloadings(published)?,
        sensitivities: sensitivities(published)?,
        laboratories: laboratories(published, options, watch)?,
        published: published.clone(),
        options: *options,
        claims: Vec::new(),
    };
    study.claims = claims::claims(&study);
    Ok(study)
}

#[cfg(test)]
mod tests;
