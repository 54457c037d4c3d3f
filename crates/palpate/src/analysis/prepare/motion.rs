//! The motion of the jaw that a record shows.

use crate::contact::Specimen;
use crate::record::Record;
use crate::segment::Segmentation;
use crate::simulate::{MeasuredMotion, MotionError, Separation};
use crate::statistics::noise_in_time;

/// The measured motion with its noise taken out, for a record that is zero at first touch; `None` without a displacement.
///
/// # Errors
/// [`MotionError`] as of [`MeasuredMotion::of`].
pub(crate) fn measured_motion(
    record: &Record,
    segmentation: &Segmentation,
    specimen: &Specimen,
    separation: Separation,
) -> Option<Result<MeasuredMotion, MotionError>> {
    /// Standard deviations of the noise that a straight line allows for.
    const WITHIN: f64 = 4.0;
    let displacement = record.displacement()?;
    let tolerance = (0.5 * segmentation.settings.tolerance).max(WITHIN * noise_in_time(record.time(), displacement));
    let found = MeasuredMotion::of(record.time().to_vec(), displacement.to_vec(), tolerance);
    // A bonded ball has no area before first touch; noise there is no pull.
    let is_bonded_ball = separation == Separation::Bonded && specimen.contact_area(0.0) == 0.0;
    Some(if is_bonded_ball { found.map(|found| found.at_least(0.0)) } else { found })
}
