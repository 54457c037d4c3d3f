//! The conditions of a test, and what a report of stress relaxation states of a hold.

use palpate::analysis::{Conditions, HoldReport, StatedRelaxation};
use palpate::fit::Estimate;

documents! {
    /// Conditions of the test as its description states them; `null` is not stated.
    ConditionsDocument(stated: &Conditions) {
        /// Temperature, K.
        temperature_k: Option<f64> = stated.temperature,
        /// Relative humidity, 0 to 1.
        relative_humidity: Option<f64> = stated.relative_humidity,
        /// Medium around the specimen.
        medium: Option<String> = stated.medium.clone(),
        /// Conditioning before the test.
        conditioning: Option<String> = stated.conditioning.clone(),
        /// Form of the specimen and how it was made.
        specimen_form: Option<String> = stated.specimen_form.clone(),
        /// What lies between specimen and plates.
        lubricant: Option<String> = stated.lubricant.clone(),
        /// Time from the start of the fit at which F₀ is taken, s; the times of R(t) count from there.
        initial_force_after_s: f64 = stated.initial_force_after,
    }

    /// What a report of a stress-relaxation test states of a hold.
    HoldReportDocument(report: &HoldReport) {
        /// Duration of the loading ramp before the hold, s.
        applied_in_s: Option<f64> = report.applied_in,
        /// Largest less smallest displacement over the hold, m.
        constraint_variation_m: Option<f64> = report.constraint_variation,
        /// The same over the displacement of the hold.
        relative_constraint_variation: Option<f64> = report.relative_constraint_variation,
        /// Initial force F₀, N; `null` unless the displacement is held after loading and the force exceeds its noise.
        initial_force_n: Option<f64> = report.initial_force.map(|force| force.value),
        /// Its standard error, N.
        initial_force_standard_error_n: Option<f64> = report.initial_force.and_then(|force| force.standard_error),
        /// R(t) at the stated times that were measured.
        relaxation: Vec<StatedRelaxationDocument> =
            report.relaxation.iter().map(StatedRelaxationDocument::new).collect(),
        /// Stated times beyond the hold, or with fewer than five samples about them, s.
        not_measured_s: Vec<f64> = report.not_measured.clone(),
    }

    /// R(t) = (F₀ − F(t))/F₀ at a time.
    StatedRelaxationDocument(stated: &StatedRelaxation) with {
        let Estimate { value, standard_error, interval, .. } = stated.relaxation;
    } {
        /// Time since that of F₀, s.
        time_s: f64 = stated.time,
        /// F(t), N.
        force_n: f64 = stated.force.value,
        /// Its standard error, N.
        force_standard_error_n: Option<f64> = stated.force.standard_error,
        /// R(t).
        relaxation: f64 = value,
        /// Its standard error.
        relaxation_standard_error: Option<f64> = standard_error,
        /// Its confidence interval.
        relaxation_interval: Option<[f64; 2]> = interval.map(Into::into),
    }
}
