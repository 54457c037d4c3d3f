//! `palpate.calibration/1`: laws calibrated on a whole record.

use palpate::analysis::HoldoutError;
use palpate::calibrate::{CalibrateError, Calibration, Candidate, ParameterProfile};
use palpate::fit::Interval;

use super::budget::BudgetDocument;
use super::software::Software;
use crate::page::Finding;
use crate::result::{
    CalibratedRecord, Input, ParameterDocument, ParameterRow, budgets_of_material, formula_of_material,
    parameters_of_material, word,
};

documents! {
    /// A parameter of a calibrated law.
    CalibratedParameterDocument(named: (String, ParameterDocument), profiles: &[ParameterProfile]) with {
        let profile = profiles.iter().find(|profile| profile.name == named.0);
    } {
        /// Name with its unit, such as `modulus_pa`, `exponent`, `rate_coefficient_per_s`, `layer_thickness_m`.
        name: String = named.0,
        /// Its value with its uncertainty.
        #[serde(flatten)]
        parameter: ParameterDocument = named.1,
        /// Profile interval; omitted where none was requested.
        profile?: Option<ProfileDocument> = profile.map(|found| ProfileDocument::new(found.interval)),
    }

    /// A profile interval; an unbounded end is `null`.
    ProfileDocument(interval: Interval) {
        /// Lower end.
        low: Option<f64> = interval.low,
        /// Upper end.
        high: Option<f64> = interval.high,
    }

    /// Held-out error: error of the prediction beyond the fitted part.
    HoldoutDocument(holdout: HoldoutError) {
        /// Root mean square error, N.
        rmse_n: f64 = holdout.rmse,
        /// The same as a share of the largest force.
        relative: f64 = holdout.relative,
        /// Samples held out.
        samples: usize = holdout.samples,
    }

    /// One law on the record.
    CalibratedLawDocument(
        candidate: &Candidate,
        made: &Result<Calibration, CalibrateError>,
        delta_bic: Option<f64>,
        profiles: &[ParameterProfile]
    ) with {
        let good = made.as_ref().ok();
        let parameters =
            good.iter().flat_map(|made| parameters_of_material(&made.material, made.termination.is_good()));
        let uncertainty = good.and_then(|made| made.material.uncertainty());
        let budgets = good.map_or_else(Vec::new, |made| budgets_of_material(&made.material));
        let confidence = uncertainty.map_or(0.95, |uncertainty| uncertainty.confidence);
    } {
        /// Name of the law.
        law: String = candidate.to_string(),
        /// Number of estimated parameters.
        free_parameters: Option<usize> = good.map(|made| made.free_parameters),
        /// Root mean square residual over the fitted samples, N.
        rmse_n: Option<f64> = good.map(|made| made.rmse),
        /// The same as a share of the largest force.
        relative: Option<f64> = good.map(|made| made.relative),
        /// BIC less the lowest of the laws whose search ended at an optimum; `null` where it did not.
        delta_bic: Option<f64> = delta_bic,
        /// The held-out error; `null` where all samples were fitted.
        holdout: Option<HoldoutDocument> = good.and_then(|made| made.holdout).map(HoldoutDocument::new),
        /// The law with its values put in; `null` where there is none.
        formula: Option<String> = good.and_then(|made| formula_of_material(&made.material)),
        /// Its parameters.
        parameters: Vec<CalibratedParameterDocument> =
            parameters.map(|parameter| CalibratedParameterDocument::new(parameter, profiles)).collect(),
        /// Covariance of the logarithms of the parameters; `null` where the record does not determine one.
        log_covariance: Option<Vec<Vec<f64>>> = uncertainty.map(|uncertainty| uncertainty.covariance.clone()),
        /// Uncertainty budgets of the parameters; empty where the test description has no `[instrument]`.
        budgets: Vec<BudgetDocument> = budgets.iter().map(|result| BudgetDocument::new(result, confidence)).collect(),
        /// Why the search ended; `null` where none began.
        termination: Option<String> = good.map(|made| word(made.termination)),
        /// Why there is no calibration.
        error: Option<String> = made.as_ref().err().map(ToString::to_string),
    }

    /// Laws calibrated on a whole record.
    CalibrationDocument(record: &CalibratedRecord, confidence: f64) with {
        let law = |(index, (candidate, made)): (usize, &(Candidate, Result<Calibration, CalibrateError>))| {
            let profiles = if index == 0 { &record.profiles[..] } else { &[] };
            let delta_bic = made.as_ref().ok().and_then(|made| record.delta_bic(made));
            CalibratedLawDocument::new(candidate, made, delta_bic, profiles)
        };
    } {
        /// Always `palpate.calibration/1`.
        schema: String = "palpate.calibration/1".to_owned(),
        /// The answer in sentences; the parameters of the law are those of the first of `laws`.
        answer: Vec<String> = record.answer(),
        /// The software that wrote it.
        software: Software = Software::this(),
        /// The record.
        input: Input = record.input.clone(),
        /// Samples that were fitted.
        fitted: usize = record.data.fitted(),
        /// Coverage of the intervals.
        confidence: f64 = confidence,
        /// The laws; the first is the requested one.
        laws: Vec<CalibratedLawDocument> = record.rows.iter().enumerate().map(law).collect(),
        /// Findings on the record.
        findings: Vec<Finding> = record.data.findings().iter().map(Finding::from).collect(),
        /// Remarks, in sentences.
        remarks: Vec<String> = record.remarks(),
    }
}

impl CalibrationDocument {
    /// Every parameter of every law, a row each; the first law is the one calibrated.
    #[must_use]
    pub fn parameter_rows(&self) -> Vec<ParameterRow> {
        let of_law = |(index, law): (usize, &CalibratedLawDocument)| {
            let row = |parameter: &CalibratedParameterDocument| ParameterRow {
                record: self.input.path.clone(),
                part: self.input.part.clone(),
                hold: None,
                law: law.law.clone(),
                name: parameter.name.clone(),
                parameter: parameter.parameter.clone(),
                termination: law.termination.clone().unwrap_or_default(),
                domain: "time".to_owned(),
                is_recommended: index == 0,
            };
            law.parameters.iter().map(row).collect::<Vec<_>>()
        };
        self.laws.iter().enumerate().flat_map(of_law).collect()
    }
}
