//! A material under a protocol: its force, with intervals.

use std::io::{self, Write};
use std::path::Path;

use palpate::calibrate::Prediction;
use palpate::simulate::{Sampling, SimulateError};
use palpate::watch::Watch;
use palpate_files::description::{MaterialFile, Protocol};
use palpate_report::figure::Figure;
use palpate_report::result::sentence_of_misfit;
use palpate_report::study::{prediction_figure, prediction_table, write_prediction};
use palpate_report::table::CsvLocale;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::message_log::{is_log, write_prediction as write_prediction_log};
use crate::options::checked_confidence;
use crate::output::{Stage, unwritten, unwritten_log};
use crate::{JobError, Outcome};

/// Predict the response of a calibrated body to a protocol, with intervals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Predict {
    /// Times at which to predict the force; the whole series if empty.
    #[cfg_attr(feature = "clap", arg(
        long = "at", value_name = "TIME", value_parser = crate::typed::time, allow_hyphen_values = true,
        help = "Time at which to predict the force; may be repeated",
    ))]
    pub at_s: Vec<f64>,
    /// Coverage of the intervals, between 0 and 1.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "SHARE", default_value_t = Predict::default().confidence,
        value_parser = crate::typed::coverage, allow_hyphen_values = true,
    ))]
    pub confidence: f64,
    /// Language of the readers of CSV: it decides decimal sign and separator.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "LANGUAGE", value_parser = crate::typed::one_of(crate::typed::CSV_LOCALES), default_value = "en",
    ))]
    pub csv_locale: CsvLocale,
}

impl Default for Predict {
    fn default() -> Self {
        Self {
            at_s: Vec::new(),
            confidence: 0.95,
            csv_locale: CsvLocale::default(),
        }
    }
}

/// What a calibrated body does.
#[derive(Debug, Clone, PartialEq)]
pub struct Predicted {
    /// At the times that are wanted.
    pub prediction: Prediction,
    /// The whole course.
    course: Option<Prediction>,
    /// Single times are wanted, which make no curve.
    single: bool,
    caption: String,
    csv_locale: CsvLocale,
}

impl Predict {
    /// Predicts what the body of a material file, under the name of that file, does under a protocol. The course between single times is
    /// computed only for a figure.
    ///
    /// # Errors
    /// [`JobError`] where the protocol cannot be followed, or the watch ends it.
    pub fn run(
        &self,
        (file, name): (&MaterialFile, &str),
        (protocol, place): (&Protocol, &str),
        with_figure: bool,
        watch: &mut dyn Watch,
    ) -> Result<Outcome<Predicted>, JobError> {
        let (material, confidence) = (&file.material, checked_confidence(self.confidence)?);
        let mut at = self.at_s.clone();
        at.sort_by(f64::total_cmp);
        at.dedup();
        let mut predict = |sampling: &Sampling| {
            material.predict_watched(protocol.drive(), sampling, confidence, watch).map_err(|error| {
                let beyond = matches!(error, SimulateError::SampleTime { .. });
                let hint = beyond.then(|| "give times within the protocol, or extend its last hold".to_owned());
                let refused = JobError::simulation(error).of(place);
                JobError { hint, ..refused }
            })
        };
        // Single times make no curve.
        let single = !at.is_empty();
        let prediction = predict(&if single { Sampling::Times(at) } else { protocol.sampling.clone() })?;
        let course = (with_figure && single).then(|| predict(&protocol.sampling)).transpose()?;
        let open = "the calibration left a parameter open: the intervals are not known";
        let open = material.uncertainty().is_none().then(|| open.to_owned());
        let beyond = prediction.extrapolations.iter().map(|beyond| format!("beyond the test: {beyond}"));
        let law = material.candidate().to_string();
        let misfit =
            file.origin.misfit.map(|misfit| sentence_of_misfit(&misfit, &law).trim_end_matches('.').to_owned());
        let notes = misfit.into_iter().chain(open).chain(beyond).collect();
        let caption = format!("Response of {name}, predicted by its calibrated law.");
        let caption = protocol.title.as_deref().map_or(caption.clone(), |title| format!("{title}. {caption}"));
        let predicted = Predicted {
            prediction,
            course,
            single,
            caption,
            csv_locale: self.csv_locale,
        };
        Ok(Outcome::of(predicted).noted(notes))
    }
}

impl Predicted {
    /// The forces, a row each.
    #[must_use]
    pub fn text(&self) -> String {
        prediction_table(&self.prediction).to_plain_text()
    }

    /// Writes the series as CSV.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_series(&self, out: &mut dyn Write) -> io::Result<()> {
        write_prediction(out, &self.prediction, self.csv_locale)
    }

    /// Stages the series as the file at `path`: a log of ROS 2 if it ends in `.mcap`, otherwise CSV.
    ///
    /// # Errors
    /// [`JobError`] where a time has no stamp, a log would have one, or the operating system takes no file there.
    pub fn stage(&self, path: &Path, stage: &mut Stage) -> Result<(), JobError> {
        if !is_log(path) {
            let mut bytes = Vec::new();
            self.write_series(&mut bytes).map_err(|error| unwritten(path, &error))?;
            return stage.bytes(path, &bytes);
        }
        if self.prediction.trajectory.time.len() < 2 {
            // No record has one row, so that no reader of ours would take it.
            let message = "a log needs 2 times or more, found 1";
            return Err(JobError::option(message, "add another ⟨at⟩, or write CSV").of(path.display()));
        }
        stage.file(path, |into| {
            let written = write_prediction_log(into, &self.prediction, self.single);
            written.map_err(|error| unwritten_log(path, &error))
        })
    }

    /// The course with its intervals.
    #[must_use]
    pub fn figure(&self) -> Figure {
        prediction_figure(self.course.as_ref().unwrap_or(&self.prediction), "prediction", &self.caption)
    }
}
