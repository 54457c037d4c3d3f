//! Several records to one calibration: shared and own parameters, and the material of another specimen.

use palpate::analysis::AnalysisOptions;
use palpate::calibrate::{
    BatchRecord, Between, CalibrationData, Candidate, RateLaw, SeveralError, Sharing, calibrate_several,
};
use palpate::laws::Law;
use palpate::watch::Watch;
use palpate_files::description::{MaterialFile, MaterialOrigin};
use palpate_report::document::{SeveralCalibrationsDocument, Software};
use palpate_report::figure::Figure;
use palpate_report::result::{CalibratedBatch, Input};
use palpate_report::study::{batch_figure, batch_text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::calibrate::{Calibrate, Equilibrium, equilibrium_law, kind_of};
use crate::depends::Dependencies;
use crate::input::Measurement;
use crate::options::checked_confidence;
use crate::{ErrorKind, JobError, Outcome, Results};

/// Calibrate several records of one body or of one batch together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CalibrateSeveral {
    /// Law of the material.
    #[schemars(with = "String")]
    pub law: Law,
    /// Parameters with one value for all records: none, all, or their names with commas between.
    #[schemars(with = "String")]
    pub shared: Sharing,
    /// Law of the equilibrium force, uniform-strain or hertz; if not given, that of the description of the first record.
    pub equilibrium: Option<Equilibrium>,
    /// Poisson's ratio for Hertz's law; if not given, that of the description of the first record, or 0.5.
    pub poisson_ratio: Option<f64>,
    /// Dependence of the rate coefficient v of the latency law, with one more parameter.
    #[schemars(with = "String", extend("enum" = ["constant", "by_strain", "by_direction"]))]
    pub rate: RateLaw,
    /// Coverage of the intervals, between 0 and 1; if not given, that of the description of the first record, or 0.95.
    pub confidence: Option<f64>,
}

impl Default for CalibrateSeveral {
    fn default() -> Self {
        let Calibrate {
            law,
            equilibrium,
            poisson_ratio,
            rate,
            confidence,
            ..
        } = Calibrate::default();
        Self {
            law,
            shared: Sharing::None,
            equilibrium,
            poisson_ratio,
            rate,
            confidence,
        }
    }
}

/// Several records calibrated together.
#[derive(Debug)]
pub struct CalibratedSeveral {
    /// The records and what was found.
    pub batch: CalibratedBatch,
}

impl CalibrateSeveral {
    /// Calibrates the law on all records.
    ///
    /// # Errors
    /// [`JobError`] where the law cannot be calibrated on them, or the watch ends it.
    pub fn run(
        &self,
        measured: Vec<Measurement>,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<CalibratedSeveral>, JobError> {
        let first = measured.first().map_or_else(AnalysisOptions::default, |first| first.options.clone());
        let candidate = Candidate {
            law: self.law,
            equilibrium: equilibrium_law(self.equilibrium, self.poisson_ratio, &first)?,
            rate: self.rate,
        };
        let of_first = first.fit.confidence;
        let confidence = checked_confidence(self.confidence.unwrap_or(of_first))?;
        let (mut inputs, mut records): (Vec<Input>, Vec<BatchRecord>) = (Vec::new(), Vec::new());
        let mut notes = Vec::new();
        for Measurement {
            record,
            mut input,
            options,
            turned,
            ..
        } in measured
        {
            input.depends_on_sha256 =
                Some(Dependencies::new("calibrate-several", &(self, &options)).record(&input).sha256()?);
            let name = name(&input, &records);
            let data = CalibrationData::of_record(&record, &options).map_err(|error| {
                uncalibrated(&SeveralError::Record {
                    record: name.clone(),
                    error,
                })
            })?;
            notes.extend(data.findings().iter().filter_map(|found| Measurement::sign_note(&turned, found)));
            inputs.push(input);
            records.push(BatchRecord { name, data });
        }
        let found = calibrate_several(&records, candidate, &self.shared, confidence, watch)
            .map_err(|error| uncalibrated(&error))?;
        let data = records.into_iter().map(|record| record.data).collect();
        Ok(Outcome::of(CalibratedSeveral {
            batch: CalibratedBatch { inputs, data, found },
        })
        .noted(notes))
    }
}

/// What to call a record: its file and part, with a number where another has that name.
fn name(input: &Input, others: &[BatchRecord]) -> String {
    let called = input.called();
    let is_taken = |name: &str| others.iter().any(|other| other.name == name);
    if !is_taken(&called) {
        return called;
    }
    let numbered = (2..).map(|number| format!("{called} ({number})"));
    numbered.into_iter().find(|name| !is_taken(name)).unwrap_or(called)
}

impl CalibratedSeveral {
    /// The material of another specimen, or of the one body, with its provenance; none for own parameters of two records.
    #[must_use]
    pub fn material(&self) -> Option<MaterialFile> {
        let CalibratedBatch { inputs, data, found } = &self.batch;
        let has_own = found.parameters.iter().any(|parameter| matches!(parameter.between, Between::Own { .. }));
        let joined = |of: &dyn Fn(&Input) -> String| inputs.iter().map(of).collect::<Vec<_>>().join(", ");
        let mut tests: Vec<&str> = inputs.iter().filter_map(|input| input.test.as_deref()).collect();
        tests.dedup();
        Some(MaterialFile {
            material: found.specimen.clone()?,
            origin: MaterialOrigin {
                record: joined(&Input::called),
                sha256: joined(&|input| input.sha256.clone()),
                specimens: has_own.then_some(inputs.len()),
                test: (!tests.is_empty()).then(|| tests.join(", ")),
                palpate: Software::this().release(),
                samples: data.iter().map(CalibrationData::fitted).sum(),
                misfit: self.batch.misfit(),
            },
        })
    }

    /// The material of each record.
    #[must_use]
    pub fn materials(&self) -> Vec<MaterialFile> {
        let CalibratedBatch { inputs, data, found } = &self.batch;
        let of = |((input, data), specimen): ((&Input, &CalibrationData), &palpate::calibrate::CalibratedSpecimen)| {
            MaterialFile {
                material: specimen.material.clone(),
                origin: MaterialOrigin {
                    record: input.called(),
                    sha256: input.sha256.clone(),
                    specimens: None,
                    test: input.test.clone(),
                    palpate: Software::this().release(),
                    samples: data.fitted(),
                    misfit: CalibratedBatch::misfit_of(specimen),
                },
            }
        };
        inputs.iter().zip(data).zip(&found.specimens).map(of).collect()
    }

    /// The records with the law, a panel each.
    #[must_use]
    pub fn figure(&self) -> Option<Figure> {
        batch_figure(&self.batch, "calibration")
    }
}

impl Results for CalibratedSeveral {
    type Document = SeveralCalibrationsDocument;

    fn document(&self) -> SeveralCalibrationsDocument {
        SeveralCalibrationsDocument::new(&self.batch)
    }

    fn text(&self) -> String {
        batch_text(&self.batch)
    }
}

/// Why there is no calibration.
fn uncalibrated(error: &SeveralError) -> JobError {
    let kind = match error {
        SeveralError::Cancelled(cancelled) => return (*cancelled).into(),
        SeveralError::Record { error, .. } => kind_of(error),
        SeveralError::TooFew { .. } | SeveralError::UnknownParameter { .. } | SeveralError::Table => ErrorKind::Option,
        SeveralError::Repeated { .. } => ErrorKind::Record,
        SeveralError::Material(_) => ErrorKind::Model,
        _ => ErrorKind::Fit,
    };
    JobError::new(kind, error, error.hint())
}
