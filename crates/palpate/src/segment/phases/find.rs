//! The phases of a record, from both of its columns or from its force alone.

use super::fit_start::place_fits;
use super::{from_both, from_force};
use crate::record::Record;
use crate::segment::error::SegmentError;
use crate::segment::options::SegmentOptions;
use crate::segment::segmentation::Segmentation;

/// Fewest samples in which phases can be seen.
const NEEDED: usize = 8;

/// Finds the phases of a record: from its displacement and its force, or from its force alone where the displacement is missing.
///
/// Every hold says what is held in it ([`HoldMode`](crate::segment::HoldMode)). Where the machine holds the force, the hold lasts as long as the force
/// stays, however far the jaw creeps.
///
/// # Errors
/// [`SegmentError`] when nothing moves, or when no standstill after a ramp is long enough to be a hold.
pub fn find_phases(record: &Record, options: &SegmentOptions) -> Result<Segmentation, SegmentError> {
    if record.len() < NEEDED {
        return Err(SegmentError::TooShort {
            needed: NEEDED,
            found: record.len(),
        });
    }
    let mut segmentation = match record.displacement() {
        Some(displacement) => from_both::phases(record, displacement, options)?,
        None => from_force::phases(record.time(), record.force(), options)?,
    };
    place_fits(record, options, &mut segmentation.segments);
    Ok(segmentation)
}
