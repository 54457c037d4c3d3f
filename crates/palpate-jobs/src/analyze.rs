//! A record to phases, laws, tables and a report.

use palpate::analysis::{Analysis, analyze_watched};
use palpate::fit::IntervalMethod;
use palpate::segment::{ContactChoice, HoldStart};
use palpate::watch::{Progress, Watch};
use palpate_report::document::AnalysisDocument;
use palpate_report::result::Input;
use palpate_report::study::{Bundle, FileOptions, analysis_bundle, analysis_text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::depends::Dependencies;
use crate::input::Measurement;
use crate::options::checked_confidence;
use crate::{ErrorKind, JobError, Outcome, Results};

/// Analyse a record: phases, strains, laws. Options that are not given follow its description.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Analyze {
    /// Fit only this time from the start of each hold and report the held-out error after it.
    #[cfg_attr(feature = "clap", arg(
        long = "fit-until", value_name = "TIME", value_parser = crate::typed::time, allow_hyphen_values = true,
        help = "Fit only this time from the start of each hold and report the held-out error after it",
    ))]
    pub fit_until_s: Option<f64>,
    /// Fixed exponents to fit, besides a free one.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "N,…", value_delimiter = ',', value_parser = crate::typed::exponent,
    ))]
    pub exponents: Option<Vec<f64>>,
    /// Whether to fit a free exponent.
    #[cfg_attr(feature = "clap", arg(skip))]
    pub free_exponent: Option<bool>,
    /// Coverage of the intervals, between 0 and 1.
    #[cfg_attr(feature = "clap", arg(skip))]
    pub confidence: Option<f64>,
    /// Method of the intervals: "automatic", "curvature", "profile", or "bootstrap" with its options.
    #[schemars(with = "serde_json::Value")]
    #[cfg_attr(feature = "clap", arg(
        long, value_parser = crate::typed::one_of(crate::typed::INTERVALS),
        help = "Method of the intervals; automatic if not given",
    ))]
    pub intervals: Option<IntervalMethod>,
    /// Start of the fit in a hold: "peak", "settled", or a time in seconds after the peak.
    #[schemars(with = "serde_json::Value")]
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "WHERE", value_parser = palpate_files::description::parse_hold_start,
        help = "Start of the fit in a hold: peak, settled, or \"peak + 0.5 s\"",
    ))]
    pub hold_start: Option<HoldStart>,
    /// First touch: "auto", "as_recorded", a displacement in m, or a rule.
    #[schemars(with = "serde_json::Value")]
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "WHERE", value_parser = palpate_files::description::parse_touch,
        help = "First touch: auto, \"as recorded\", or a displacement",
    ))]
    pub touch: Option<ContactChoice>,
    /// Largest deviation of the displacement within a hold.
    #[cfg_attr(feature = "clap", arg(
        long = "tolerance", value_name = "LENGTH", value_parser = crate::typed::length, allow_hyphen_values = true,
    ))]
    pub tolerance_m: Option<f64>,
    /// Shortest hold.
    #[cfg_attr(feature = "clap", arg(
        long = "minimum-hold", value_name = "TIME", value_parser = crate::typed::time, allow_hyphen_values = true,
    ))]
    pub minimum_hold_s: Option<f64>,
    /// Whether to compare laws, which takes most of the time.
    #[cfg_attr(feature = "clap", arg(skip = true))]
    pub compare: bool,
}

impl Default for Analyze {
    fn default() -> Self {
        Self {
            fit_until_s: None,
            exponents: None,
            free_exponent: None,
            confidence: None,
            intervals: None,
            hold_start: None,
            touch: None,
            tolerance_m: None,
            minimum_hold_s: None,
            compare: true,
        }
    }
}

/// An analysed record.
#[derive(Debug, Clone, PartialEq)]
pub struct Analyzed {
    /// Phases, laws and findings.
    pub analysis: Analysis,
    /// Where the record comes from.
    pub input: Input,
}

impl Analyze {
    /// Puts these options over those of the description.
    fn over(&self, measured: &mut Measurement) -> Result<(), JobError> {
        let options = &mut measured.options;
        // A command line refuses them as they are typed; JSON and Python give them by these names.
        for (name, number) in [("tolerance_m", self.tolerance_m), ("minimum_hold_s", self.minimum_hold_s)] {
            if let Some(found) = number.filter(|number| !(number.is_finite() && *number > 0.0)) {
                return Err(JobError::option(format!("{name}: expected a number above 0, found {found}"), ""));
            }
        }
        options.fit_until = self.fit_until_s.or(options.fit_until);
        if let Some(exponents) = &self.exponents {
            if exponents.is_empty() || exponents.iter().any(|n| !(n.is_finite() && *n > 0.0)) {
                let message = format!("⟨exponents⟩ are numbers above 0, found {exponents:?}");
                return Err(JobError::option(message, ""));
            }
            options.exponents.clone_from(exponents);
        }
        options.exponents.sort_by(f64::total_cmp);
        options.exponents.dedup();
        if let Some(confidence) = self.confidence {
            options.fit.confidence = checked_confidence(confidence)?;
        }
        if let Some(intervals) = self.intervals {
            options.fit.intervals = intervals;
            options.compare.iter_mut().for_each(|compare| compare.fit.intervals = intervals);
        }
        options.free_exponent = self.free_exponent.unwrap_or(options.free_exponent);
        options.segment.hold_start = self.hold_start.unwrap_or(options.segment.hold_start);
        options.segment.tolerance = self.tolerance_m.or(options.segment.tolerance);
        options.segment.minimum_hold = self.minimum_hold_s.or(options.segment.minimum_hold);
        options.touch = self.touch.unwrap_or(options.touch);
        if !self.compare {
            options.compare = None;
        }
        Ok(())
    }

    /// Analyses a record, off which the force of the same motion without a body is taken if `air` is given.
    ///
    /// # Errors
    /// [`JobError`] where the record has nothing to analyse, or the watch ends it.
    pub fn run(
        &self,
        mut measured: Measurement,
        air: Option<&Measurement>,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<Analyzed>, JobError> {
        self.over(&mut measured)?;
        let Measurement {
            mut record,
            mut input,
            options,
            turned,
            ..
        } = measured;
        if let Some(air) = air {
            record = record
                .without_air_run(&air.record)
                .map_err(|error| JobError::new(ErrorKind::Record, &error, error.hint().to_owned()).of(&input.path))?;
            input.air_run_sha256 = Some(air.input.sha256.clone());
        }
        input.depends_on_sha256 = Some(Dependencies::new("analyze", &options).record(&input).sha256()?);
        watch.report(Progress::open(&format!("fitting {}", input.called()), 0))?;
        let analysis =
            analyze_watched(&record, &options, watch).map_err(|error| JobError::analysis(&error, &input.called()))?;
        let notes = analysis.findings.iter().filter_map(|found| Measurement::sign_note(&turned, found)).collect();
        Ok(Outcome::of(Analyzed { analysis, input }).noted(notes))
    }
}

impl Analyzed {
    /// Report, document, tables and figures by their names.
    ///
    /// # Errors
    /// [`JobError`] where a figure or document cannot be made, or the watch ends it.
    pub fn bundle(&self, options: &FileOptions, watch: &mut dyn Watch) -> Result<Bundle, JobError> {
        Ok(analysis_bundle(&self.analysis, self.input.clone(), options, watch)?)
    }
}

impl Analyzed {
    /// Its text with a row for each of many holds.
    #[must_use]
    pub fn brief_text(&self) -> String {
        let (text, is_brief) = analysis_text(&self.analysis, &self.input, false);
        let rest = "--details prints the formula, the held-out errors and every fit of each hold.\n";
        if is_brief { text + rest } else { text }
    }
}

impl Results for Analyzed {
    type Document = AnalysisDocument;

    fn document(&self) -> AnalysisDocument {
        AnalysisDocument::new(&self.analysis, self.input.clone())
    }

    fn text(&self) -> String {
        analysis_text(&self.analysis, &self.input, true).0
    }
}
