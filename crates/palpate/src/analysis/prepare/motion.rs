//! The motion of the jaw that a record shows.

use crate::contact::Specimen;
use crate::record::{Record, rounding_step};
use crate::segment::{ContactPoint, Segmentation};
use crate::simulate::{MeasuredMotion, MotionError, Separation};
use crate::statistics::noise_in_time;

/// The measured motion with its noise taken out, for a record that is zero at first touch, `contact`; `None` without a displacement.
///
/// # Errors
/// [`MotionError`] as of [`MeasuredMotion::of`].
pub(crate) fn measured_motion(
    record: &Record,
    segmentation: &Segmentation,
    contact: &ContactPoint,
    specimen: &Specimen,
    separation: Separation,
) -> Option<Result<MeasuredMotion, MotionError>> {
    /// Standard deviations of the noise that a straight line allows for.
    const WITHIN: f64 = 4.0;
    let displacement = record.displacement()?;
    let step = rounding_step(displacement).unwrap_or(0.0);
    // Noise that neighbours do not show: a coarse converter repeats its readings.
    let noise = noise_in_time(record.time(), displacement).max(step / 12f64.sqrt());
    let tolerance = (0.5 * segmentation.settings.tolerance).max(WITHIN * noise);
    let is_bonded = separation == Separation::Bonded;
    let mut displacement = displacement.to_vec();
    if is_bonded && contact.tare.displacement != 0.0 {
        // What is glued to the jaw as it touches is not pulled before.
        let touched = contact.sample.unwrap_or(0).min(displacement.len());
        displacement[..touched].iter_mut().for_each(|place| *place = place.max(0.0));
    }
    let found = MeasuredMotion::of_rounded(record.time().to_vec(), displacement, tolerance, step);
    // A bonded ball has no area before first touch; noise there is no pull.
    let is_bonded_ball = is_bonded && specimen.contact_area(0.0) == 0.0;
    Some(if is_bonded_ball { found.map(|found| found.at_least(0.0)) } else { found })
}
