//! `palpate.several-calibrations/1`: one calibration of several records.

use palpate::calibrate::{BatchParameter, Between, CalibratedSpecimen, Spread};
use palpate::fit::{Estimate, ParameterRole};

use super::software::Software;
use crate::page::Finding;
use crate::result::{CalibratedBatch, Input, ParameterDocument, formula_of_material, parameters_of_material, si_unit};

documents! {
    /// The standard deviation of a parameter between specimens, as that of its natural logarithm: 0.1 is 10 %, to first order.
    SpreadDocument(spread: Spread) {
        /// The standard deviation.
        deviation: f64 = spread.deviation,
        /// Lower end of its interval.
        low: f64 = spread.interval.0,
        /// Upper end.
        high: f64 = spread.interval.1,
        /// Whether the interval excludes 0.
        is_distinguishable: bool = spread.is_distinguishable(),
    }

    /// A parameter of the batch.
    BatchParameterDocument(parameter: &BatchParameter) with {
        let (between, estimate, role) = of_between(&parameter.between);
    } {
        /// Name with its unit.
        name: String = parameter.name.clone(),
        /// `shared`: one value for all records; `own`: each record has its own, and the value is their geometric mean; `given` by the law.
        between: String = between.to_owned(),
        /// The value with its uncertainty.
        #[serde(flatten)]
        parameter: ParameterDocument =
            ParameterDocument::new(Some(&estimate), si_unit(parameter.unit).to_owned(), role),
        /// The spread between specimens of an own parameter.
        spread: Option<SpreadDocument> = match parameter.between {
            Between::Own { spread, .. } => Some(SpreadDocument::new(spread)),
            _ => None,
        },
        /// Of a shared parameter the probability that records of one value, each calibrated alone, differ as much as these (Cochran's test).
        one_value_p: Option<f64> = match parameter.between {
            Between::Shared { one_value_p, .. } => one_value_p,
            _ => None,
        },
    }

    /// A parameter of one record, or of another specimen.
    SpecimenParameterDocument(named: (String, ParameterDocument)) {
        /// Name with its unit.
        name: String = named.0,
        /// Its value with its uncertainty.
        #[serde(flatten)]
        parameter: ParameterDocument = named.1,
    }

    /// A record of the batch.
    SpecimenDocument(input: &Input, specimen: &CalibratedSpecimen) {
        /// The record.
        input: Input = input.clone(),
        /// Root mean square residual over the fitted samples, N.
        rmse_n: f64 = specimen.rmse,
        /// The same as a share of the largest force.
        relative: f64 = specimen.relative,
        /// Root mean square residual of the record calibrated alone, N.
        rmse_alone_n: f64 = specimen.rmse_alone,
        /// Its parameters, the shared ones among them.
        parameters: Vec<SpecimenParameterDocument> =
            parameters_of_material(&specimen.material, true).into_iter().map(SpecimenParameterDocument::new).collect(),
        /// Its findings.
        findings: Vec<Finding> = specimen.findings.iter().map(Finding::from).collect(),
    }

    /// The material of another specimen of the batch, or of the one body where all parameters are shared.
    NewSpecimenDocument(material: &palpate::calibrate::Material) with {
        let uncertainty = material.uncertainty();
    } {
        /// The law with its values put in.
        formula: Option<String> = formula_of_material(material),
        /// Its parameters: intervals contain the spread between specimens.
        parameters: Vec<SpecimenParameterDocument> =
            parameters_of_material(material, true).into_iter().map(SpecimenParameterDocument::new).collect(),
        /// Covariance of the logarithms of the parameters.
        log_covariance: Option<Vec<Vec<f64>>> = uncertainty.map(|uncertainty| uncertainty.covariance.clone()),
        /// Its degrees of freedom.
        freedom: Option<f64> = uncertainty.map(|uncertainty| uncertainty.freedom),
    }

    /// One calibration of several records.
    SeveralCalibrationsDocument(batch: &CalibratedBatch) {
        /// Always `palpate.several-calibrations/1`.
        schema: String = "palpate.several-calibrations/1".to_owned(),
        /// The answer in sentences.
        answer: Vec<String> = batch.answer(),
        /// The software that wrote it.
        software: Software = Software::this(),
        /// The law.
        law: String = batch.found.candidate.to_string(),
        /// The shared parameters as they were requested: `none`, `all`, or names.
        shared: String = batch.found.sharing.to_string(),
        /// Coverage of the intervals.
        confidence: f64 = batch.found.confidence,
        /// Number of estimated parameters: the shared ones, and the own ones of every record.
        free_parameters: usize = batch.found.free_parameters,
        /// The parameters of the batch.
        parameters: Vec<BatchParameterDocument> =
            batch.found.parameters.iter().map(BatchParameterDocument::new).collect(),
        /// The records.
        specimens: Vec<SpecimenDocument> = batch
            .inputs
            .iter()
            .zip(&batch.found.specimens)
            .map(|(input, specimen)| SpecimenDocument::new(input, specimen))
            .collect(),
        /// Another specimen; `null` for own parameters of two records.
        new_specimen: Option<NewSpecimenDocument> = batch.found.specimen.as_ref().map(NewSpecimenDocument::new),
        /// Remarks, in sentences.
        remarks: Vec<String> = batch.remarks(),
    }
}

/// What a parameter is between records, its estimate, and its role.
pub(crate) fn of_between(between: &Between) -> (&'static str, Estimate, ParameterRole) {
    match *between {
        Between::Shared { estimate, .. } => ("shared", estimate, ParameterRole::Estimated),
        Between::Own { mean, .. } => ("own", mean, ParameterRole::Estimated),
        Between::Given { value } => ("given", Estimate::fixed(value), ParameterRole::Given),
    }
}
