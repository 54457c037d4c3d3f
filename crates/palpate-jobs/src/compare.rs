//! Comparison of laws on records: the law to use and its certainty.

use palpate::analysis::{
    AnalysisOptions, CreepError, analyze_watched, corrected_watched, creep_holds, record_findings,
};
use palpate::fit::{IntervalMethod, Loss, SampleChoice};
use palpate::forecast::{CompareOptions, RampChoice};
use palpate::laws::{Law, Response};
use palpate::watch::{Progress, Watch};
use palpate_report::document::{ComparisonDocument, ComparisonSettingsDocument};
use palpate_report::result::{ComparedRecord, LeftOut};
use palpate_report::spelling::with_flags;
use palpate_report::study::{Bundle, FileOptions, comparison_bundle, comparison_markdown, comparison_text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::depends::Dependencies;
use crate::error::without;
use crate::input::{Measurement, NamedRecords, called};
use crate::{ErrorKind, JobError, Outcome, Results};

/// Compare laws: which one predicts a hold, with what certainty, and how much worse others predict.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Compare {
    /// Laws to compare; all applicable laws if not given.
    #[schemars(with = "Option<Vec<String>>")]
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "LAW,…", value_delimiter = ',', value_parser = crate::typed::law,
    ))]
    pub laws: Option<Vec<Law>>,
    /// Cut points, as shares of the hold: each law is fitted up to a cut and predicts the rest.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "SHARE,…", value_delimiter = ',', value_parser = crate::typed::share,
        allow_hyphen_values = true,
        help = "Cut points, as shares of the hold: each law is fitted up to a cut and predicts the rest",
    ))]
    pub cuts: Option<Vec<f64>>,
    /// Compare laws of creep: displacement in holds of constant force.
    #[cfg_attr(feature = "clap", arg(long))]
    pub creep: bool,
    /// Loss function of the residuals.
    #[schemars(with = "String", extend("enum" = ["squares", "huber", "tukey"]))]
    #[cfg_attr(feature = "clap", arg(
        long, value_parser = crate::typed::one_of(crate::typed::LOSSES), default_value = "squares",
        help = "Loss function of the residuals; huber and tukey are robust against outliers",
    ))]
    pub loss: Loss,
    /// Samples to fit: "all", or about this number spaced evenly in ln t.
    #[schemars(with = "serde_json::Value")]
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "all|log:N", default_value = "all", value_parser = crate::typed::samples,
        help = "Samples to fit: all, or log:400 for about 400 spaced evenly in ln t",
    ))]
    pub samples: SampleChoice,
    /// Method of the intervals: "automatic", "curvature", "profile", or "bootstrap" with its options.
    #[schemars(with = "serde_json::Value")]
    #[cfg_attr(feature = "clap", arg(
        long, value_parser = crate::typed::one_of(crate::typed::INTERVALS),
        help = "Method of the intervals; automatic if not given",
    ))]
    pub intervals: Option<IntervalMethod>,
    /// Loading history before a hold, as linear laws take it.
    #[schemars(with = "String", extend("enum" = ["step", "measured"]))]
    #[cfg_attr(feature = "clap", arg(
        long, value_parser = crate::typed::one_of(crate::typed::RAMPS), default_value = "step",
    ))]
    pub ramps: RampChoice,
    /// Compare only over this time from the start of each hold.
    #[cfg_attr(feature = "clap", arg(
        long = "fit-until", value_name = "TIME", value_parser = crate::typed::time, allow_hyphen_values = true,
    ))]
    pub fit_until_s: Option<f64>,
}

/// The first of some cut points that is no share of a hold.
#[must_use]
pub fn no_share(cuts: &[f64]) -> Option<f64> {
    cuts.iter().copied().find(|cut| !(*cut > 0.0 && *cut < 1.0))
}

/// Records with the laws compared on their holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// The records on which laws could be judged.
    pub records: Vec<ComparedRecord>,
    /// The others, with why.
    pub left_out: Vec<LeftOut>,
    options: Options,
}

/// What is required of every record.
#[derive(Debug, Clone, PartialEq)]
struct Options {
    analysis: AnalysisOptions,
    compared: CompareOptions,
}

impl Compare {
    /// These options over those of a description.
    fn over(&self, mut analysis: AnalysisOptions) -> Result<Options, JobError> {
        analysis.fit_until = self.fit_until_s.or(analysis.fit_until);
        let mut compared = CompareOptions::default();
        compared.fit.response = if self.creep { Response::Creep } else { Response::Relaxation };
        analysis.fit.intervals = self.intervals.unwrap_or(analysis.fit.intervals);
        compared.fit.intervals = analysis.fit.intervals;
        compared.fit.confidence = analysis.fit.confidence;
        compared.fit.samples = self.samples;
        compared.fit.loss = self.loss;
        compared.ramps = self.ramps;
        if let Some(laws) = &self.laws {
            compared.laws.clone_from(laws);
            compared.laws.dedup();
        }
        if let Some(law) = compared.laws.iter().find(|law| !law.describes(compared.fit.response)) {
            let (has, other) = if self.creep { ("creep", "without") } else { ("relaxation", "with") };
            return Err(JobError::option(
                format!("⟨laws⟩: {law} does not describe {has}"),
                &format!("omit it, or compare {other} ⟨creep⟩"),
            ));
        }
        if let Some(cuts) = &self.cuts {
            if let Some(cut) = no_share(cuts) {
                let message = format!("⟨cuts⟩ are shares of the hold between 0 and 1, found {cut}");
                return Err(JobError::option(message, "0.25,0.5 fits a quarter and a half of the hold"));
            }
            compared.cuts.clone_from(cuts);
            compared.cuts.sort_by(f64::total_cmp);
            compared.cuts.dedup();
        }
        analysis.compare = Some(compared.clone());
        Ok(Options { analysis, compared })
    }

    /// Compares laws on the records of named files; `alone` makes what is wrong with the only one an error.
    ///
    /// # Errors
    /// [`JobError`] where options make no comparison, or the watch ends it.
    pub fn run(
        &self,
        records: &NamedRecords,
        alone: bool,
        watch: &mut dyn Watch,
        mut reported: impl FnMut(&[String]),
    ) -> Result<Outcome<Compared>, JobError> {
        let mut found = Compared::none(self.over(records.described.options())?);
        records.each(
            None,
            watch,
            |_| (),
            |part, watch| {
                let measured = part.measurement.inspect(|measured| reported(&measured.notes));
                match measured.and_then(|measured| self.one(measured, &found.options, watch)) {
                    Err(error) if error.kind == ErrorKind::Cancelled || (alone && part.only) => return Err(error),
                    made => found.take(
                        called(part.path, part.name),
                        made.map_err(|error| {
                            (without(part.path, &error.to_string()), error.hint.map(|hint| with_flags(&hint)))
                        }),
                    ),
                }
                Ok(())
            },
        )?;
        Ok(found.outcome())
    }

    /// Compares laws on one record.
    ///
    /// # Errors
    /// As for [`run`](Self::run).
    pub fn run_on(&self, measured: Measurement, watch: &mut dyn Watch) -> Result<Outcome<Compared>, JobError> {
        let mut found = Compared::none(self.over(measured.options.clone())?);
        let (called, made) = (measured.input.called(), self.one(measured, &found.options, watch)?);
        found.take(called, Ok(made));
        Ok(found.outcome())
    }

    fn one(&self, measured: Measurement, options: &Options, watch: &mut dyn Watch) -> Result<ComparedRecord, JobError> {
        let Measurement { record, mut input, .. } = measured;
        let settings = (&options.analysis, &options.compared, self.creep);
        input.depends_on_sha256 = Some(Dependencies::new("compare", &settings).record(&input).sha256()?);
        watch.report(Progress::open(&format!("comparing laws on {}", input.path), 0))?;
        let (requested, path) = (&options.analysis, &input.path);
        if self.creep {
            let record = corrected_watched(&record, requested, watch)
                .map_err(|error| JobError::analysis(&error, path))?
                .record;
            let holds = creep_holds(
                &record,
                (&requested.segment, &requested.given_holds),
                &options.compared,
                requested.fit_until,
                watch,
            );
            let refused = |error: CreepError| match error {
                CreepError::Cancelled(cancelled) => cancelled.into(),
                error => JobError::new(ErrorKind::Record, &error, error.hint().to_owned()).of(path),
            };
            return Ok(ComparedRecord::of_creep(holds.map_err(refused)?, record_findings(&record), input));
        }
        let analysis = analyze_watched(&record, requested, watch).map_err(|error| JobError::analysis(&error, path))?;
        Ok(ComparedRecord::of_analysis(&analysis, input))
    }
}

impl Compared {
    fn none(options: Options) -> Self {
        Self {
            records: Vec::new(),
            left_out: Vec::new(),
            options,
        }
    }

    /// Takes what came of a record, or why nothing did with what would help.
    fn take(&mut self, path: String, made: Result<ComparedRecord, (String, Option<String>)>) {
        let none = "no law could be fitted to any hold";
        let (reason, hint) = match made {
            Ok(record) if record.has_verdict() => return self.records.push(record),
            Ok(_) => (none.to_owned(), None),
            Err(why) => why,
        };
        self.left_out.push(LeftOut { path, reason, hint });
    }

    fn outcome(self) -> Outcome<Self> {
        let compared = !self.records.is_empty();
        Outcome::of(self).answered(compared)
    }

    fn settings(&self) -> ComparisonSettingsDocument {
        let Options { analysis, compared } = &self.options;
        ComparisonSettingsDocument::new(compared, analysis.segment.hold_start, analysis.fit_until)
    }

    /// Report, document, tables and figures by their names.
    ///
    /// # Errors
    /// [`JobError`] where a figure or document cannot be made, or the watch ends it.
    pub fn bundle(&self, options: &FileOptions, watch: &mut dyn Watch) -> Result<Bundle, JobError> {
        Ok(comparison_bundle(&self.records, &self.left_out, self.settings(), options, watch)?)
    }

    /// One table of all records and holds.
    #[must_use]
    pub fn markdown(&self) -> String {
        comparison_markdown(&self.records, &self.left_out, &self.options.compared.laws())
    }
}

impl Results for Compared {
    type Document = ComparisonDocument;

    fn document(&self) -> ComparisonDocument {
        ComparisonDocument::new(&self.records, &self.left_out, self.settings())
    }

    fn text(&self) -> String {
        comparison_text(&self.records, &self.left_out)
    }
}
