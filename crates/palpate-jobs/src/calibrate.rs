//! A whole record to one set of parameters: a material.

use palpate::analysis::AnalysisOptions;
use palpate::calibrate::{CalibrateError, CalibrationData, Candidate, EquilibriumLaw, RateLaw, calibrate, profile};
use palpate::laws::Law;
use palpate::watch::Watch;
use palpate_files::description::{MaterialFile, MaterialOrigin};
use palpate_report::document::{CalibrationDocument, Software};
use palpate_report::figure::Figure;
use palpate_report::result::CalibratedRecord;
use palpate_report::study::{calibration_figure, calibration_text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::depends::Dependencies;
use crate::input::Measurement;
use crate::options::checked_confidence;
use crate::{ErrorKind, JobError, Outcome, Results};

/// Calibrate a body on a whole record, ramps and holds: one set of parameters for prediction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Calibrate {
    /// Law of the material.
    #[schemars(with = "String")]
    pub law: Law,
    /// Alternative laws to fit to the same record.
    #[schemars(with = "Vec<String>")]
    pub alternatives: Vec<Law>,
    /// Law of the equilibrium force; if not given, that of the description.
    pub equilibrium: Option<Equilibrium>,
    /// Poisson's ratio for Hertz's law; if not given, that of the description, or 0.5.
    pub poisson_ratio: Option<f64>,
    /// Dependence of the rate coefficient v of the latency law, with one more parameter.
    #[schemars(with = "String", extend("enum" = ["constant", "by_strain", "by_direction"]))]
    pub rate: RateLaw,
    /// Fit up to this time of the record and report the held-out error after it.
    pub fit_until_s: Option<f64>,
    /// Add profile intervals.
    pub profile: bool,
    /// Coverage of the intervals, between 0 and 1; if not given, that of the description, or 0.95.
    pub confidence: Option<f64>,
}

/// Law of the equilibrium force, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Equilibrium {
    /// Modulus × displacement/depth × contact area.
    UniformStrain,
    /// Hertz's law, for balls, pads and the tips of indenters.
    Hertz,
    /// A monotone table with one row per held displacement.
    Table,
}

/// The latency law with its exponent estimated.
const LATENCY: Law = Law::Latency {
    exponent: palpate::laws::ExponentChoice::Free,
};

impl Default for Calibrate {
    fn default() -> Self {
        Self {
            law: LATENCY,
            // It is none to itself.
            alternatives: vec![
                LATENCY,
                Law::StandardLinearSolid,
                Law::Prony { terms: 2 },
                Law::Prony { terms: 3 },
                Law::Fung { terms: 2 },
            ],
            equilibrium: None,
            poisson_ratio: None,
            rate: RateLaw::Constant,
            fit_until_s: None,
            profile: false,
            confidence: None,
        }
    }
}

/// The law of the equilibrium force: the requested one, or that of the description.
pub(crate) fn equilibrium_law(
    requested: Option<Equilibrium>,
    poisson_ratio: Option<f64>,
    options: &AnalysisOptions,
) -> Result<EquilibriumLaw, JobError> {
    let described = options.geometry.as_ref().map(|geometry| EquilibriumLaw::from(&geometry.equilibrium));
    let (usual, ratio) = match described.unwrap_or_default() {
        EquilibriumLaw::UniformStrain => (Equilibrium::UniformStrain, 0.5),
        EquilibriumLaw::Hertz { poisson_ratio } => (Equilibrium::Hertz, poisson_ratio),
        EquilibriumLaw::Table => (Equilibrium::Table, 0.5),
    };
    match (requested.unwrap_or(usual), poisson_ratio) {
        (Equilibrium::Hertz, given) => Ok(EquilibriumLaw::Hertz {
            poisson_ratio: given.unwrap_or(ratio),
        }),
        (_, Some(_)) => Err(JobError::option(
            "⟨poisson_ratio⟩ is for Hertz's law, which is not requested",
            "add ⟨equilibrium=hertz⟩, or leave ⟨poisson_ratio⟩ out",
        )),
        (Equilibrium::UniformStrain, None) => Ok(EquilibriumLaw::UniformStrain),
        (Equilibrium::Table, None) => Ok(EquilibriumLaw::Table),
    }
}

/// A calibrated record.
#[derive(Debug)]
pub struct Calibrated {
    /// The laws on the record.
    pub record: CalibratedRecord,
    /// Coverage of the intervals.
    pub confidence: f64,
}

impl Calibrate {
    /// What is fitted: first what is requested, then its alternatives.
    fn candidates(&self, options: &AnalysisOptions) -> Result<Vec<Candidate>, JobError> {
        let chosen = Candidate {
            law: self.law,
            equilibrium: equilibrium_law(self.equilibrium, self.poisson_ratio, options)?,
            rate: self.rate,
        };
        Ok(if self.alternatives.is_empty() {
            vec![chosen]
        } else {
            chosen.with_alternatives(&self.alternatives)
        })
    }

    /// Calibrates the laws on a record.
    ///
    /// # Errors
    /// [`JobError`] where the requested law cannot be calibrated, or the watch ends it.
    pub fn run(&self, measured: Measurement, watch: &mut dyn Watch) -> Result<Outcome<Calibrated>, JobError> {
        let candidates = self.candidates(&measured.options)?;
        let Measurement {
            record: measured,
            mut input,
            options,
            turned,
            ..
        } = measured;
        input.depends_on_sha256 = Some(Dependencies::new("calibrate", &(self, &options)).record(&input).sha256()?);
        let confidence = checked_confidence(self.confidence.unwrap_or(options.fit.confidence))?;
        let refused = |error: CalibrateError| uncalibrated(&error, &input.path);
        let mut data = CalibrationData::of_record(&measured, &options).map_err(refused)?;
        if let Some(until) = self.fit_until_s {
            data = data.fitted_until(until).map_err(refused)?;
        }
        let mut rows = Vec::new();
        for candidate in candidates {
            match calibrate(&data, candidate, confidence, watch) {
                Err(CalibrateError::Cancelled(cancelled)) => return Err(cancelled.into()),
                // Without the law that was requested its alternatives are of no use.
                Err(error) if rows.is_empty() => return Err(refused(error)),
                made => rows.push((candidate, made)),
            }
        }
        let profiles = match rows.first() {
            Some((_, Ok(made))) if self.profile => profile(&data, made, watch).map_err(refused)?,
            _ => Vec::new(),
        };
        let (used, samples) = (data.times().len(), data.samples());
        let few = (samples > used).then(|| format!("the fit uses {used} of {samples} samples, evenly spaced"));
        let record = CalibratedRecord {
            input,
            data,
            rows,
            profiles,
        };
        let signs = record.data.findings().iter().filter_map(|found| Measurement::sign_note(&turned, found));
        let notes = signs.chain(few).collect();
        Ok(Outcome::of(Calibrated { record, confidence }).noted(notes))
    }
}

impl Calibrated {
    /// The material of the requested law, with its provenance.
    #[must_use]
    pub fn material(&self) -> Option<MaterialFile> {
        let (record, chosen) = (&self.record, self.record.chosen()?);
        Some(MaterialFile {
            material: chosen.material.clone(),
            origin: MaterialOrigin {
                record: record.input.called(),
                sha256: record.input.sha256.clone(),
                specimens: None,
                test: record.input.test.clone(),
                palpate: Software::this().release(),
                samples: record.data.fitted(),
                misfit: record.misfit(),
            },
        })
    }

    /// The record with the laws.
    #[must_use]
    pub fn figure(&self) -> Figure {
        calibration_figure(&self.record, "calibration")
    }
}

impl Results for Calibrated {
    type Document = CalibrationDocument;

    fn document(&self) -> CalibrationDocument {
        CalibrationDocument::new(&self.record, self.confidence)
    }

    fn text(&self) -> String {
        calibration_text(&self.record)
    }
}

/// Why there is no calibration: because of what was requested, of the record, of the body or of the samples.
fn uncalibrated(error: &CalibrateError, place: &str) -> JobError {
    JobError::new(kind_of(error), error, error.hint()).of(place)
}

/// What kind of failure it is.
pub(crate) fn kind_of(error: &CalibrateError) -> ErrorKind {
    match error {
        CalibrateError::Cancelled(_) => ErrorKind::Cancelled,
        CalibrateError::NoGeometry
        | CalibrateError::NotALaw { .. }
        | CalibrateError::RateOf { .. }
        | CalibrateError::Exponent { .. }
        | CalibrateError::Split { .. } => ErrorKind::Option,
        CalibrateError::TooFewSamples { .. } | CalibrateError::NoStiffness => ErrorKind::Fit,
        CalibrateError::Specimen(_)
        | CalibrateError::Equilibrium(_)
        | CalibrateError::Motion(_)
        | CalibrateError::Simulate(_) => ErrorKind::Model,
        _ => ErrorKind::Record,
    }
}
