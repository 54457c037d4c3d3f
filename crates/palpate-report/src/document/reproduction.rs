//! `palpate.reproduction/2`: the paper claim by claim; `palpate.reproduced-record/1`: its conclusions on a record.

use palpate::analysis::{Analysis, HoldAnalysis, Signal};
use palpate::fit::LatencyFit;
use palpate::paper::{
    Claim, Comparison, Conclusion, Explained, Laboratories, ORDERS, ReproducedTest, Reproduction, Sensitivity, Share,
    StepForces,
};
use palpate::segment::After;

use super::software::Software;
use crate::result::Input;
use crate::word::word;

/// The exponent of the paper's tables.
const ORDER: f64 = 5.0;

/// Rows of Table I or II.
fn rows<'a>(holds: impl Iterator<Item = &'a HoldAnalysis>, after: After) -> Vec<StepDocument> {
    let holds = holds.filter(|hold| hold.after == Some(after) && hold.signal == Signal::Strain);
    holds.filter_map(|hold| Some(StepDocument::new(hold, hold.fit_with(ORDER)?))).collect()
}

fn table(test: &ReproducedTest, after: After) -> Vec<StepDocument> {
    rows(test.loaded(), after)
}

documents! {
    /// The whole study.
    #[schemars(title = "palpate.reproduction/2")]
    ReproductionDocument(study: &Reproduction) {
        /// `palpate.reproduction/2`.
        schema: String = "palpate.reproduction/2".to_owned(),
        /// Radius of the ball, m.
        radius_m: f64 = study.published.radius,
        /// Modulus, Pa.
        modulus_pa: f64 = study.published.modulus,
        /// n.
        exponent: f64 = study.published.exponent,
        /// v of the simulation, 1/s.
        rate_coefficient_per_s: f64 = study.published.simulated_coefficient,
        /// m.
        layers: f64 = study.published.layers,
        /// Speed of the jaw, m/s.
        rate_m_per_s: f64 = study.published.speed,
        /// Every equation, figure, table and statement: what is not reproduced first.
        claims: Vec<ClaimDocument> = study.claims.iter().map(ClaimDocument::new).collect(),
        /// Table I, fitted to the simulated test (a); compression negative.
        table_1: Vec<StepDocument> = table(&study.test_a, After::Loading),
        /// Table II, fitted to the simulated test (b); compression negative.
        table_2: Vec<StepDocument> = table(&study.test_b, After::Unloading),
        /// The steps of test (a) by uniform strain and by Table I.
        steps: Vec<StepForcesDocument> = study.step_forces.iter().map(StepForcesDocument::new).collect(),
        /// What would explain the strains of Table I.
        explanations: Vec<ExplanationDocument> = study.explanations.iter().map(ExplanationDocument::new).collect(),
        /// Laboratories for each ball.
        seeds: usize = study.options.seeds,
        /// Their sampling rate, Hz.
        sample_rate_hz: f64 = study.options.sample_rate,
        /// Error of a single reading of their force where the accuracy is that of the zero, N.
        repeatability_n: f64 = study.options.repeatability,
        /// What they conclude.
        laboratories: Vec<LaboratoriesDocument> = study.laboratories.iter().map(LaboratoriesDocument::new).collect(),
        /// Logarithmic derivatives of force and relaxed fraction.
        sensitivities: Vec<SensitivityDocument> = study.sensitivities.all.iter().map(SensitivityDocument::new).collect(),
        /// The software that wrote this.
        software: Software = Software::this(),
    }

    /// The paper's conclusions on a record.
    #[schemars(title = "palpate.reproduced-record/1")]
    ReproducedRecordDocument(analysis: &Analysis, claims: &[Claim], input: &Input) {
        /// `palpate.reproduced-record/1`.
        schema: String = "palpate.reproduced-record/1".to_owned(),
        /// Where the record comes from.
        input: Input = input.clone(),
        /// The paper's conclusions: what is not reproduced first.
        claims: Vec<ClaimDocument> = claims.iter().map(ClaimDocument::new).collect(),
        /// The lowest listed exponent that is not distinguishable from the best fit to all holds.
        common_exponent: Option<f64> = analysis.across.common_exponent,
        /// Table I: n = 5 fitted to the holds after loading; compression negative.
        table_1: Vec<StepDocument> = rows(analysis.holds.iter(), After::Loading),
        /// Table II: n = 5 fitted to the holds after unloading; compression negative.
        table_2: Vec<StepDocument> = rows(analysis.holds.iter(), After::Unloading),
        /// Root mean square difference of the simulated force, N.
        simulation_rmse_n: Option<f64> = analysis.overlay.as_ref().map(|overlay| overlay.rmse),
        /// The software that wrote this.
        software: Software = Software::this(),
    }

    /// A statement of the paper with what became of it.
    ClaimDocument(claim: &Claim) {
        /// Where it stands in the paper, such as `Eq. (4)`.
        place: String = claim.place.to_string(),
        /// What is stated.
        statement: String = claim.statement.clone(),
        /// `reproduced`, `not_reproduced` or `cannot_be_checked`.
        verdict: String = word(claim.verdict()),
        /// The comparisons; none where nothing can be compared.
        comparisons: Vec<ComparedDocument> = claim.comparisons.iter().map(ComparedDocument::new).collect(),
        /// Why it cannot be checked, or what the comparison does not show.
        remark: String = claim.remark.clone(),
    }

    /// A number of ours against the paper's.
    ComparedDocument(comparison: &Comparison) {
        /// What is compared.
        quantity: String = comparison.quantity.clone(),
        /// Unit of all numbers here; empty for a dimensionless one.
        unit: String = comparison.unit.clone(),
        /// The paper's number, or the limit that its statement sets.
        paper: f64 = comparison.paper.value,
        /// The range that it stands for: rounding or accuracy.
        paper_interval: Option<[f64; 2]> = comparison.paper.interval.map(Into::into),
        /// Our number.
        ours: f64 = comparison.ours.value,
        /// Its interval: accuracy, or 95 %.
        ours_interval: Option<[f64; 2]> = comparison.ours.interval.map(Into::into),
        /// `equal`, `at_most` or `at_least`.
        relation: String = word(comparison.relation),
        /// Tolerance.
        tolerance: f64 = comparison.tolerance,
        /// Why this tolerance.
        reason: String = comparison.reason.clone(),
        /// Whether it holds.
        holds: bool = comparison.holds(),
    }

    /// A row of Table I or II.
    StepDocument(hold: &HoldAnalysis, fit: &LatencyFit) {
        /// Number of the hold.
        hold: usize = hold.number,
        /// Displacement, m.
        displacement_m: Option<f64> = hold.displacement,
        /// ε_e, compression negative.
        equilibrium_strain: f64 = -fit.equilibrium().value,
        /// Its standard error.
        equilibrium_strain_standard_error: Option<f64> = fit.equilibrium().standard_error,
        /// v, 1/s.
        rate_coefficient_per_s: f64 = fit.rate_coefficient().value,
        /// Its standard error, 1/s.
        rate_coefficient_standard_error_per_s: Option<f64> = fit.rate_coefficient().standard_error,
    }

    /// A step of test (a) by uniform strain and by Table I; compression negative.
    StepForcesDocument(step: &StepForces) {
        /// Displacement, m.
        displacement_m: f64 = step.displacement,
        /// ε_e of the simulation.
        uniform_equilibrium_strain: f64 = -step.uniform_strain,
        /// ε_e of Table I.
        table_equilibrium_strain: f64 = -step.table_strain,
        /// v used with Table I, 1/s.
        rate_coefficient_per_s: f64 = step.coefficient,
        /// Whether it is legible in the paper.
        is_legible: bool = step.is_legible,
        /// Force at the start of the hold, uniform strain, N.
        uniform_peak_force_n: f64 = step.peak[0],
        /// The same by Table I, N.
        table_peak_force_n: f64 = step.peak[1],
        /// Force at the end of the hold, uniform strain, N.
        uniform_end_force_n: f64 = step.end[0],
        /// The same by Table I, N.
        table_end_force_n: f64 = step.end[1],
        /// Modulus with which uniform strain has the equilibrium force of Table I, Pa.
        modulus_needed_pa: f64 = step.modulus_needed,
    }

    /// An explanation of the strains of Table I.
    ExplanationDocument(explained: &Explained) {
        /// What is changed.
        explanation: String = explained.explanation.words().to_owned(),
        /// ε_e at the five steps, compression negative.
        equilibrium_strains: Vec<f64> = explained.strains.iter().map(|strain| -strain).collect(),
        /// Root mean square difference from Table I.
        rms_difference: f64 = explained.rms,
        /// The fitted modulus, Pa.
        fitted_modulus_pa: Option<f64> = explained.modulus,
        /// The fitted travel of the jaw before what was taken for first touch, m.
        fitted_travel_m: Option<f64> = explained.travel,
    }

    /// What the laboratories with one ball conclude by one way of fitting.
    LaboratoriesDocument(labs: &Laboratories) {
        /// The ball.
        ball: String = labs.ball.words().to_owned(),
        /// What the accuracy of the instrument means: `independent` errors of readings, or `repeatable`, one error a test.
        readings: String = word(labs.readings),
        /// `rates` (strain rate against strain) or `time` (closed form against time).
        method: String = word(labs.method),
        /// n = 5 is the lowest order that fits best.
        order_five: ShareDocument = ShareDocument::of(labs, Conclusion::OrderFive),
        /// v falls from step to step.
        falling_coefficient: ShareDocument = ShareDocument::of(labs, Conclusion::FallingCoefficient),
        /// ε_e agrees between loading and unloading.
        equal_equilibria: ShareDocument = ShareDocument::of(labs, Conclusion::EqualEquilibria),
        /// Orders that are tried.
        orders: Vec<f64> = ORDERS.to_vec(),
        /// How many laboratories choose each of them.
        chosen: Vec<usize> = labs.orders.to_vec(),
        /// Median of v at each step of test (a) with n = 5, 1/s.
        rate_coefficients_per_s: Vec<Option<f64>> = labs.coefficients.to_vec(),
    }

    /// A number of laboratories among all.
    ShareDocument(share: Share, truth: Option<bool>) {
        /// Whether the conclusion is true of the ball; `null` where it has no such property.
        is_true: Option<bool> = truth,
        /// Those that conclude so.
        drawn: usize = share.drawn,
        /// All.
        of: usize = share.of,
        /// 95 % interval of the probability (Wilson).
        interval: [f64; 2] = share.interval().into(),
    }

    /// Logarithmic derivatives with respect to a parameter.
    SensitivityDocument(sensitivity: &Sensitivity) {
        /// The parameter.
        parameter: String = sensitivity.parameter.key().to_owned(),
        /// d ln F/d ln p at the start of each hold of test (a).
        peak: Vec<f64> = sensitivity.peak.to_vec(),
        /// d ln F/d ln p at the end of each hold.
        end: Vec<f64> = sensitivity.end.to_vec(),
        /// d ln R/d ln p of the relaxed fraction R of each hold.
        relaxed: Vec<f64> = sensitivity.relaxed.to_vec(),
    }
}

impl ShareDocument {
    fn of(labs: &Laboratories, conclusion: Conclusion) -> Self {
        Self::new(labs.share(conclusion), labs.ball.truth(conclusion))
    }
}
