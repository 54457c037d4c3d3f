//! Options that several jobs have.

use crate::JobError;

/// A coverage of intervals, between 0 and 1.
pub(crate) fn checked_confidence(confidence: f64) -> Result<f64, JobError> {
    if confidence > 0.0 && confidence < 1.0 {
        return Ok(confidence);
    }
    Err(JobError::option(format!("⟨confidence⟩ is a share between 0 and 1, found {confidence}"), ""))
}
