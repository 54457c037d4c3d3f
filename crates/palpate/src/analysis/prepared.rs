//! A record ready to be fitted: corrected, cut, and zero at first touch.

use super::corrected::{Corrected, corrected};
use super::pipeline::beyond_body;
use super::{AnalysisError, AnalysisOptions};
use crate::record::Record;
use crate::segment::{ContactPoint, Segmentation, find_contact_of};

/// A record whose displacement and force begin at first touch, with its phases.
#[derive(Debug, Clone, PartialEq)]
pub struct Prepared {
    /// The record; it knows what was done to it.
    pub record: Record,
    /// Its phases.
    pub segmentation: Segmentation,
    /// First touch, and what was subtracted.
    pub contact: ContactPoint,
}

/// Makes the corrections that are asked for, cuts the record and sets it to zero at first touch, as [`analyze`](super::analyze) does.
///
/// # Errors
/// [`AnalysisError`] for a correction that cannot be made, a record without holds, and a body that the jaw would go through.
pub fn prepared(record: &Record, options: &AnalysisOptions) -> Result<Prepared, AnalysisError> {
    let Corrected {
        record, segmentation, ..
    } = corrected(record, options)?;
    let segmentation = segmentation?;
    let body = options.geometry.as_ref().map(|geometry| (&geometry.shape, geometry.sides));
    let contact = find_contact_of(&record, &segmentation, body, options.touch);
    let record = record.tared(contact.tare);
    beyond_body(&record, options)?;
    Ok(Prepared {
        record,
        segmentation,
        contact,
    })
}
