//! The motion of the jaw that a record shows.

use crate::contact::Specimen;
use crate::record::{Record, rounding_step};
use crate::segment::{ContactPoint, HoldMode, Segmentation};
use crate::simulate::{MeasuredMotion, MotionError, Resolution, Separation};
use crate::statistics::{dot, median, noise_in_time, range};

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
    let wide = (0.5 * segmentation.settings.tolerance).max(WITHIN * noise);
    let narrow = WITHIN * noise_of_smooth(displacement).max(step / 12f64.sqrt());
    let tolerance = if narrow < wide && force_follows(record, segmentation) { narrow } else { wide };
    let is_bonded = separation == Separation::Bonded;
    let mut displacement = displacement.to_vec();
    if is_bonded && contact.tare.displacement != 0.0 {
        // What is glued to the jaw as it touches is not pulled before.
        let touched = contact.sample.unwrap_or(0).min(displacement.len());
        displacement[..touched].iter_mut().for_each(|place| *place = place.max(0.0));
    }
    let straight = Resolution {
        step,
        ..Resolution::straight(tolerance)
    };
    let is_force_held = segmentation.holds().any(|hold| hold.mode == Some(HoldMode::ForceHeld));
    let resolution = if is_force_held { creeping(record, straight) } else { straight };
    let found = MeasuredMotion::resolved(record.time().to_vec(), displacement, resolution);
    // A bonded ball has no area before first touch; noise there is no pull.
    let is_bonded_ball = is_bonded && specimen.contact_area(0.0) == 0.0;
    Some(if is_bonded_ball { found.map(|found| found.at_least(0.0)) } else { found })
}

/// The resolution for a jaw that a controller of the force drives along curves: a course of it counts from a small part of the noise of the
/// force on, which stays where the jaw creeps, and not from a share of its way.
fn creeping(record: &Record, straight: Resolution) -> Resolution {
    /// Share of the noise of the force that a course may change it by.
    const UNSEEN: f64 = 0.05;
    /// Share of the step within which rounded places of a jaw that creeps stay.
    const ROUNDED: f64 = 0.5;
    let compliance = record.displacement().map_or(0.0, range) / range(record.force());
    let unseen = UNSEEN * noise_in_time(record.time(), record.force()) * compliance;
    Resolution {
        course: straight.course.min(unseen.max(ROUNDED * straight.step)),
        ..straight
    }
}

/// Standard deviation of the noise in a motion that is smooth over five samples, by its fourth differences: less of a tremor remains in them than in
/// the second ones of [`noise_in_time`].
fn noise_of_smooth(values: &[f64]) -> f64 {
    let fourth = |v: &[f64]| (v[0] - 4.0 * (v[1] + v[3]) + 6.0 * v[2] + v[4]).abs();
    let mut fourth: Vec<f64> = values.windows(5).map(fourth).collect();
    // 70 = 1 + 16 + 36 + 16 + 1
    if fourth.is_empty() { 0.0 } else { 1.482_6 * median(&mut fourth) / 70f64.sqrt() }
}

/// Whether the force goes with what the jaw does in its holds: the tremor of a hand is a motion, which the body feels, and no noise.
///
/// What each sample lies off the mean of those one lag before and behind is correlated between both columns, over the holds of a displacement, at the
/// lag at which that is largest; relaxation is nearly straight over three samples. Of columns whose noise has nothing in common the correlation has
/// a standard deviation of about one over the root of the spans of one lag.
fn force_follows(record: &Record, segmentation: &Segmentation) -> bool {
    const LAGS: [usize; 8] = [1, 2, 4, 8, 16, 32, 64, 128];
    /// Correlation at least.
    const CLOSE: f64 = 0.5;
    /// Its standard deviations at least.
    const SURE: f64 = 5.0;
    let Some(displacement) = record.displacement() else {
        return false;
    };
    let holds: Vec<_> = segmentation.holds().filter(|hold| hold.mode != Some(HoldMode::ForceHeld)).collect();
    let at_lag = |lag: usize| {
        let (mut moved, mut felt) = (Vec::new(), Vec::new());
        for hold in &holds {
            for middle in (hold.fit_start + lag)..hold.end.saturating_sub(lag) {
                let off = |values: &[f64]| values[middle] - 0.5 * (values[middle - lag] + values[middle + lag]);
                moved.push(off(displacement));
                felt.push(off(record.force()));
            }
        }
        let spans = moved.len() as f64 / lag as f64;
        let correlation = dot(&moved, &felt) / (dot(&moved, &moved) * dot(&felt, &felt)).sqrt();
        correlation > CLOSE.max(SURE / spans.sqrt())
    };
    LAGS.into_iter().any(at_lag)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

    use super::*;
    use crate::analysis::AnalysisOptions;
    use crate::analysis::prepare::corrected;
    use crate::random::Rng;
    use crate::segment::GivenHold;

    /// 20 s held by a hand that trembles by `amplitude` (m) at 8 Hz, read at 500 Hz with noise; the body, of 500 N/m, feels it or not.
    fn held_by_hand(amplitude: f64, is_felt: bool, seed: u64) -> Record {
        let mut random = Rng::new(seed);
        let time: Vec<f64> = (0..11_000).map(|i| 2e-3 * f64::from(i)).collect();
        let tremor = |t: f64| amplitude * (50.0 * t).sin() * (1.0 + 0.3 * (1.9 * t).sin());
        let way = |t: f64| 2e-3 * ((t - 1.0).clamp(0.0, 0.5) / 0.5);
        let place: Vec<f64> = time.iter().map(|t| way(*t) + tremor(*t) + 2e-6 * random.normal()).collect();
        let felt = |t: f64| 500.0 * (way(t) + if is_felt && t > 1.2 { tremor(t) } else { 0.0 });
        let relaxes = |t: f64| 1.0 + 0.5 * (-(t - 1.5).max(0.0) / 5.0).exp();
        let force = time.iter().map(|t| felt(*t) * relaxes(*t) + 2e-3 * random.normal()).collect();
        Record::new(time, Some(place), force).unwrap()
    }

    fn follows(record: &Record) -> bool {
        let options = AnalysisOptions {
            given_holds: vec![GivenHold {
                from: 1.5,
                to: 21.9,
                mode: None,
            }],
            ..AnalysisOptions::default()
        };
        let corrected = corrected(record, &options).unwrap();
        force_follows(&corrected.record, &corrected.segmentation.unwrap())
    }

    /// The tremor of a hand, wider than what the phases take for standing still, was flattened: a record that follows its law had 1.5 to 5 % of its
    /// peak as residuals, and n and v were missed in a third of 16.
    #[test]
    fn a_tremor_that_the_body_feels_is_a_motion_and_noise_is_none() {
        for seed in 0..4 {
            assert!(follows(&held_by_hand(5e-5, true, seed)), "{seed}");
            assert!(!follows(&held_by_hand(5e-5, false, seed)) && !follows(&held_by_hand(0.0, true, seed)), "{seed}");
        }
    }
}
