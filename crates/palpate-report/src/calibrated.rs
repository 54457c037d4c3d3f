//! What a calibration of a record is shown with.

use palpate::calibrate::{CalibrateError, Calibration, CalibrationData, Candidate, NumberProfile};

use crate::document::Input;

/// Candidates calibrated on one record; the first is the one that is asked for, the others are its rivals.
#[derive(Debug)]
pub struct CalibratedRecord {
    /// The record.
    pub input: Input,
    /// What was fitted.
    pub data: CalibrationData,
    /// Each candidate with what was found, or why nothing was.
    pub rows: Vec<(Candidate, Result<Calibration, CalibrateError>)>,
    /// Profile intervals of what is asked for; none if they were not.
    pub profiles: Vec<NumberProfile>,
}

impl CalibratedRecord {
    /// The calibrations that were made, in the order of their candidates.
    pub fn made(&self) -> impl Iterator<Item = &Calibration> {
        self.rows.iter().filter_map(|(_, made)| made.as_ref().ok())
    }

    /// What was asked for, if it could be made.
    #[must_use]
    pub fn chosen(&self) -> Option<&Calibration> {
        self.rows.first().and_then(|(_, made)| made.as_ref().ok())
    }

    /// The error by which candidates are ranked: of what was foretold, else by the information criterion; less is better.
    #[must_use]
    pub fn score(&self, calibration: &Calibration) -> f64 {
        calibration.foretold.map_or(calibration.criteria.bic, |foretold| foretold.rmse)
    }

    /// What the table says in a sentence.
    #[must_use]
    pub fn sentence(&self) -> Option<String> {
        let chosen = self.chosen().filter(|_| self.made().count() > 1)?;
        // A law that found no optimum is none to recommend.
        let sound = |made: &&Calibration| made.termination.is_good() || std::ptr::eq(*made, chosen);
        let best = self.made().filter(sound).min_by(|a, b| self.score(a).total_cmp(&self.score(b)))?;
        let (law, other) = (chosen.material.candidate, best.material.candidate);
        let by = if chosen.foretold.is_some() {
            "foretells the rest of the record best"
        } else {
            "has the lowest BIC"
        };
        Some(if law == other {
            format!("Of the laws tried, {law} {by}.")
        } else {
            let cost = match (chosen.foretold, best.foretold) {
                (Some(mine), Some(least)) => format!("{:.2} times its error", mine.rmse / least.rmse),
                _ => format!("{:.0} more", self.score(chosen) - self.score(best)),
            };
            format!("Of the laws tried, {other} {by}; {law} has {cost}.")
        })
    }
}
