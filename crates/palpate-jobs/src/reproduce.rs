//! The paper claim by claim: its study, or its conclusions on a record of one's own.

use palpate::analysis::Analysis;
use palpate::paper::{Claim, LaboratoryOptions, PaperError, Published, Reproduction, record_claims, reproduce};
use palpate::watch::Watch;
use palpate_report::document::{ReproducedRecordDocument, ReproductionDocument};
use palpate_report::result::Input;
use palpate_report::study::{Bundle, FileOptions, claims_text, record_reproduction_bundle, reproduction_text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::input::Measurement;
use crate::{Analyze, ErrorKind, JobError, Outcome, Results};

/// Orders that the paper's conclusions are about; those of a description are tried besides.
const ORDERS: [f64; 4] = [1.0, 3.0, 5.0, 7.0];

/// Judge every claim of the paper: simulate and analyse its tests, and let laboratories repeat them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Reproduce {
    /// Laboratories for each ball, one seed each.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "COUNT", default_value_t = Reproduce::default().seeds, conflicts_with = "record",
    ))]
    pub seeds: usize,
    /// Sampling rate of the laboratories, Hz.
    #[cfg_attr(feature = "clap", arg(
        long = "sample-rate", value_name = "HZ", default_value_t = Reproduce::default().sample_rate_hz,
        conflicts_with = "record", allow_hyphen_values = true,
    ))]
    pub sample_rate_hz: f64,
    /// Error of a single reading of their force where 0.2 N is that of the zero, N: the paper gives no number for its high repeatability.
    #[cfg_attr(feature = "clap", arg(
        long = "repeatability", value_name = "FORCE", value_parser = crate::typed::force,
        default_value = "0.02 N", conflicts_with = "record", allow_hyphen_values = true,
        help = "Error of a single reading of their force where 0.2 N is that of the zero",
    ))]
    pub repeatability_n: f64,
}

impl Default for Reproduce {
    fn default() -> Self {
        let usual = LaboratoryOptions::default();
        Self {
            seeds: usual.seeds,
            sample_rate_hz: usual.sample_rate,
            repeatability_n: usual.repeatability,
        }
    }
}

impl Reproduce {
    /// The paper's study.
    ///
    /// # Errors
    /// [`JobError`] for options out of range, and where the watch ends it.
    pub fn run(self, watch: &mut dyn Watch) -> Result<Outcome<Reproduction>, JobError> {
        let options = LaboratoryOptions {
            seeds: self.seeds,
            sample_rate: self.sample_rate_hz,
            repeatability: self.repeatability_n,
        };
        let study = reproduce(&Published::default(), &options, watch).map_err(|error| match error {
            PaperError::Cancelled(cancelled) => cancelled.into(),
            PaperError::Seeds { .. }
            | PaperError::SampleRate { .. }
            | PaperError::SampleRateTooHigh { .. }
            | PaperError::Repeatability { .. } => JobError::option(error, ""),
            error => JobError::new(ErrorKind::Model, error, None),
        })?;
        Ok(Outcome::of(study))
    }

    /// The paper's conclusions on a record.
    ///
    /// # Errors
    /// [`JobError`] where the record has nothing to analyse, or the watch ends it.
    pub fn of_record(mut measured: Measurement, watch: &mut dyn Watch) -> Result<Outcome<ReproducedRecord>, JobError> {
        measured.options.exponents.extend(ORDERS);
        let job = Analyze {
            compare: false,
            ..Analyze::default()
        };
        let analyzed = job.run(measured, None, watch)?.result;
        Ok(Outcome::of(ReproducedRecord {
            claims: record_claims(&analyzed.analysis),
            analysis: analyzed.analysis,
            input: analyzed.input,
        }))
    }
}

impl Results for Reproduction {
    type Document = ReproductionDocument;

    fn document(&self) -> ReproductionDocument {
        ReproductionDocument::new(self)
    }

    fn text(&self) -> String {
        reproduction_text(self)
    }
}

/// A record with the paper's conclusions on it.
#[derive(Debug, Clone)]
pub struct ReproducedRecord {
    /// Its analysis.
    pub analysis: Analysis,
    /// The conclusions: what is not reproduced first.
    pub claims: Vec<Claim>,
    /// Where the record comes from.
    pub input: Input,
}

impl ReproducedRecord {
    /// Report, document, tables and figures by their names.
    ///
    /// # Errors
    /// [`JobError`] where a figure or document cannot be made, or the watch ends it.
    pub fn bundle(&self, options: &FileOptions, watch: &mut dyn Watch) -> Result<Bundle, JobError> {
        Ok(record_reproduction_bundle(&self.analysis, &self.claims, &self.input, options, watch)?)
    }
}

impl Results for ReproducedRecord {
    type Document = ReproducedRecordDocument;

    fn document(&self) -> ReproducedRecordDocument {
        ReproducedRecordDocument::new(&self.analysis, &self.claims, &self.input)
    }

    fn text(&self) -> String {
        format!("{}\n\n{}", self.input.title, claims_text(&self.claims))
    }
}
