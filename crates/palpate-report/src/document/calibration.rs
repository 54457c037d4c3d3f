//! `palpate.calibration/1`: laws calibrated on a whole record.

use palpate::calibrate::{CalibrateError, Calibration, MaterialNumber, MaterialUnit, NumberProfile};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::comparison::NumberDocument;
use super::software::Software;
use crate::result::{CalibratedRecord, Input, word};

/// A number of a calibrated law, in the unit at the end of its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CalibratedNumberDocument {
    /// Name with its unit, such as `modulus_pa`, `exponent`, `rate_coefficient_per_s`, `layer_thickness_m`.
    pub name: String,
    /// Its value; no standard error where the record leaves it open, or where it was given.
    #[serde(flatten)]
    pub estimate: NumberDocument,
    /// Profile interval; left out where none was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile: Option<ProfileDocument>,
}

/// A profile interval; an end that the record leaves open is `null`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ProfileDocument {
    /// Lower end.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
}

/// How well what was not fitted is foretold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ForetoldDocument {
    /// Root mean square error, N.
    pub rmse_n: f64,
    /// The same as a share of the largest force.
    pub relative: f64,
    /// Samples foretold.
    pub samples: usize,
}

/// One law on the record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CalibratedLawDocument {
    /// Name of the law.
    pub law: String,
    /// Numbers that were searched.
    pub parameters: Option<usize>,
    /// Root mean square residual over the fitted samples, N.
    pub rmse_n: Option<f64>,
    /// The same as a share of the largest force.
    pub relative: Option<f64>,
    /// BIC less the lowest of the laws.
    pub delta_bic: Option<f64>,
    /// What was not fitted; `null` where all was.
    pub foretold: Option<ForetoldDocument>,
    /// Its numbers.
    pub numbers: Vec<CalibratedNumberDocument>,
    /// Covariance of the logarithms of the numbers; `null` where the record leaves one open.
    pub log_covariance: Option<Vec<Vec<f64>>>,
    /// Why the search ended; `null` where none began.
    pub termination: Option<String>,
    /// Why there is no calibration.
    pub error: Option<String>,
}

/// Laws calibrated on a whole record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CalibrationDocument {
    /// Always `palpate.calibration/1`.
    pub schema: String,
    /// The software that wrote it.
    pub software: Software,
    /// The record.
    pub input: Input,
    /// Samples that were fitted.
    pub fitted: usize,
    /// Coverage of the intervals.
    pub confidence: f64,
    /// The laws; the first is the one that was asked for.
    pub laws: Vec<CalibratedLawDocument>,
    /// What that means, in sentences.
    pub remarks: Vec<String>,
}

impl CalibrationDocument {
    /// The document of a calibrated record.
    #[must_use]
    pub fn new(record: &CalibratedRecord, confidence: f64) -> Self {
        let least = record.made().map(|made| made.criteria.bic).fold(f64::INFINITY, f64::min);
        let law = |(index, (candidate, made)): (usize, &(_, Result<Calibration, CalibrateError>))| {
            let candidate: &palpate::calibrate::Candidate = candidate;
            let profiles = if index == 0 { &record.profiles[..] } else { &[] };
            let good = made.as_ref().ok();
            CalibratedLawDocument {
                law: candidate.to_string(),
                parameters: good.map(|made| made.free_numbers),
                rmse_n: good.map(|made| made.rmse),
                relative: good.map(|made| made.relative),
                delta_bic: good.map(|made| made.criteria.bic - least).filter(|delta| delta.is_finite()),
                foretold: good.and_then(|made| made.foretold).map(|foretold| ForetoldDocument {
                    rmse_n: foretold.rmse,
                    relative: foretold.relative,
                    samples: foretold.samples,
                }),
                numbers: good.map_or_else(Vec::new, |made| numbers(made, profiles)),
                log_covariance: good
                    .and_then(|made| made.material.uncertainty.as_ref())
                    .map(|uncertainty| uncertainty.covariance.clone()),
                termination: good.map(|made| word(made.termination)),
                error: made.as_ref().err().map(ToString::to_string),
            }
        };
        Self {
            schema: "palpate.calibration/1".to_owned(),
            software: Software::this(),
            input: record.input.clone(),
            fitted: record.data.fitted(),
            confidence,
            laws: record.rows.iter().enumerate().map(law).collect(),
            remarks: record.remarks(),
        }
    }
}

fn numbers(made: &Calibration, profiles: &[NumberProfile]) -> Vec<CalibratedNumberDocument> {
    let profile = |name: &str| profiles.iter().find(|profile| profile.name == name);
    let with = |known: &MaterialNumber| CalibratedNumberDocument {
        profile: profile(&known.name).map(|found| ProfileDocument {
            low: found.interval.low,
            high: found.interval.high,
        }),
        ..number(known)
    };
    made.material.numbers.iter().map(with).collect()
}

fn number(number: &MaterialNumber) -> CalibratedNumberDocument {
    let suffix = match number.unit {
        MaterialUnit::One => "",
        MaterialUnit::Second => "_s",
        MaterialUnit::PerSecond => "_per_s",
        MaterialUnit::Metre => "_m",
        MaterialUnit::Newton => "_n",
        MaterialUnit::Pascal => "_pa",
    };
    CalibratedNumberDocument {
        name: format!("{}{suffix}", number.name),
        estimate: NumberDocument::from(&number.estimate),
        profile: None,
    }
}
