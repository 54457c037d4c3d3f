//! A record ready to be fitted: corrected, cut, and zero at first touch.

use super::corrected::{Corrected, corrected};
use crate::analysis::error::AnalysisError;
use crate::analysis::options::AnalysisOptions;
use crate::contact::{Shape, Specimen, SpecimenError};
use crate::record::Record;
use crate::segment::{ContactPoint, Segmentation, find_contact_of};
use crate::simulate::Separation;

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

/// Makes the corrections that are asked for, cuts the record and sets it to zero at first touch, as [`analyze`](crate::analysis::analyze) does.
///
/// # Errors
/// [`AnalysisError`] for a correction that cannot be made, a record without holds, and a body that the jaw would go through.
pub fn prepared(record: &Record, options: &AnalysisOptions) -> Result<Prepared, AnalysisError> {
    corrected(record, options)?.prepared(options)
}

impl Corrected {
    /// The same set to zero at first touch.
    pub(in crate::analysis) fn prepared(&self, options: &AnalysisOptions) -> Result<Prepared, AnalysisError> {
        let segmentation = self.segmentation.clone()?;
        let body = options.geometry.as_ref().map(|geometry| (&geometry.shape, geometry.sides));
        let contact = find_contact_of(&self.record, &segmentation, body, options.touch);
        let record = self.record.tared(contact.tare);
        beyond_body(&record, options)?;
        Ok(Prepared {
            record,
            segmentation,
            contact,
        })
    }
}

/// An error if the jaw goes as far as the body is deep: a unit, a radius or a number of sides is wrong.
///
/// A ball and a body between plates have that limit; a strip in grips can be stretched beyond its own length.
fn beyond_body(record: &Record, options: &AnalysisOptions) -> Result<(), AnalysisError> {
    let (Some(geometry), Some(displacement)) = (&options.geometry, record.displacement()) else {
        return Ok(());
    };
    let is_strip = matches!(geometry.shape, Shape::Prism { .. }) && options.separation == Separation::Bonded;
    if is_strip {
        return Ok(());
    }
    // The limit is one of geometry; any modulus will do.
    let body = Specimen::new(geometry.shape.clone(), 1.0, geometry.sides)?;
    let share = body.contact_displacement(1.0);
    for (index, travel) in displacement.iter().enumerate() {
        if let Err(SpecimenError::TooDeep { limit, limit_name, .. }) =
            body.check_contact_displacement(travel * share, false)
        {
            return Err(AnalysisError::BeyondBody {
                sample: index + 1,
                time: record.time()[index],
                found: *travel,
                limit: limit / share,
                limit_name,
            });
        }
    }
    Ok(())
}
