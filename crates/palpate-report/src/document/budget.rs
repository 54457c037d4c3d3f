//! Uncertainty budgets inside other documents.

use palpate::budget::{Contribution, Evaluation};

use crate::result::{BudgetedResult, word};

documents! {
    /// What an input quantity contributes to the uncertainty of a result (JCGM 100).
    ContributionDocument(found: &Contribution, share: f64) {
        /// The input quantity.
        input: String = found.input.name.clone(),
        /// Its unit, `1` of a dimensionless quantity; empty of the scatter of the samples.
        unit: String = found.input.unit.clone(),
        /// `A` (by the statistics of observations) or `B` (by other means).
        #[serde(rename = "type")]
        evaluation: String = word(found.input.evaluation).to_uppercase(),
        /// `normal`, `rectangular`, `triangular` or `arcsine`.
        distribution: String = word(found.input.distribution),
        /// Its standard uncertainty, in its unit.
        standard_uncertainty: f64 = found.input.standard_uncertainty,
        /// Degrees of freedom; `null` where the uncertainty is known.
        freedom: Option<f64> = Some(found.input.freedom).filter(|freedom| freedom.is_finite()),
        /// Sensitivity coefficient, in units of the result per unit of the input.
        sensitivity: f64 = found.sensitivity(),
        /// Sensitivity times standard uncertainty, with its sign, in the unit of the result.
        contribution: f64 = found.effect,
        /// Its share in the sum of all squared contributions.
        share: f64 = share,
    }

    /// The uncertainty budget of a result (JCGM 100).
    BudgetDocument(result: &BudgetedResult, confidence: f64) with {
        let budget = &result.budget;
    } {
        /// Number of the hold, from 1; `null` of a result of the whole record.
        hold: Option<usize> = result.hold,
        /// The law whose parameter it is; `null` of the modulus that the equilibrium forces imply.
        law: Option<String> = result.law.clone(),
        /// Name of the result with its unit, such as `equilibrium` or `modulus_pa`.
        name: String = result.name.clone(),
        /// Its unit, `1` of a dimensionless result.
        unit: String = result.unit.clone(),
        /// The result.
        value: f64 = budget.value,
        /// The part of the standard uncertainty of Type A.
        type_a_standard_uncertainty: f64 = budget.of(Evaluation::A),
        /// The part of Type B.
        type_b_standard_uncertainty: f64 = budget.of(Evaluation::B),
        /// Combined standard uncertainty.
        combined_standard_uncertainty: f64 = budget.combined(),
        /// Effective degrees of freedom (Welch and Satterthwaite); `null` where all uncertainties are known.
        effective_freedom: Option<f64> = Some(budget.freedom()).filter(|freedom| freedom.is_finite()),
        /// Coverage factor.
        coverage_factor: f64 = budget.coverage_factor(confidence),
        /// Expanded uncertainty, of the coverage of the intervals.
        expanded_uncertainty: f64 = budget.expanded(confidence),
        /// What each input contributes, the scatter of the samples first.
        contributions: Vec<ContributionDocument> = budget
            .contributions
            .iter()
            .map(|found| ContributionDocument::new(found, budget.share(found)))
            .collect(),
    }
}
