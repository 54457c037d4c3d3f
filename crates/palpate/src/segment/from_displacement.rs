//! Phases from the column that the machine holds: the displacement of the jaw, or the force.
//!
//! 1. Single rows that stray are passed over.
//! 2. The column is cut into straight pieces, as fine as its noise allows.
//! 3. Pieces that go by far less than those beside them are standstills.
//! 4. The edges of a standstill are where the lines through ramp and level meet.

use super::edges::sharpened;
use super::pieces::{Piece, Roughness, pieces};
use super::ramps::{Level, fill_gaps};
use super::standstill::{Refused, Standstill, Stillness, standstills};
use super::{Phase, SegmentError, SegmentOptions, SegmentSettings, Segmentation};
use crate::statistics::{median, noise_in_time, quantum};

/// Drift of a standstill as a share of the way at the speed of the slower ramp beside it.
const STILL_BELOW: f64 = 0.12;
/// Fewest samples of a hold.
const MINIMUM_SAMPLES: usize = 8;
/// A standstill that drifts by more than this share of the range is a slow ramp.
const DRIFT: f64 = 0.05;
/// How far the column would have gone on in a hold, in standard deviations of the noise, on its faster and slower side.
const GOES_ON: [f64; 2] = [6.0, 3.5];
/// The same in units of the tolerance.
const GOES_ON_TOLERANCES: [f64; 2] = [3.0, 1.5];

pub(super) fn phases(
    time: &[f64],
    displacement: &[f64],
    options: &SegmentOptions,
) -> Result<Segmentation, SegmentError> {
    let noise = noise_in_time(time, displacement);
    let values = without_spikes(displacement, noise);
    let (low, high) = bounds(&values);
    let range = high - low;
    if range == 0.0 || range < 8.0 * noise {
        return Err(SegmentError::NoMotion {
            column: "displacement",
            range,
            noise,
            unit: "m",
        });
    }
    // Without noise a machine still wanders by a little.
    let floor = options.tolerance.unwrap_or(0.002 * range);
    let step = rounding(displacement);
    let tolerance = (2.5 * noise).max(floor).max(1.5 * step);
    let stray = (0.25 * floor).max(0.35 * step);
    let pieces = pieces(time, &values, Roughness { noise, stray });
    let stillness = Stillness {
        noise,
        band: tolerance,
        share: options.still_below.unwrap_or(STILL_BELOW),
        drift: DRIFT * range,
        goes_on: [0, 1].map(|side| (GOES_ON[side] * noise).max(GOES_ON_TOLERANCES[side] * floor)),
        samples: if options.minimum_hold.is_some() { 3 } else { MINIMUM_SAMPLES },
        duration: options.minimum_hold,
    };
    let (mut found, refused) = standstills(time, &values, &pieces, &stillness);
    sharpened(time, &values, &pieces, (3.0 * noise).max(0.5 * floor), &mut found);
    let ramp_speed = ramp_speed(time, &pieces, &found);
    let settings = SegmentSettings {
        from_displacement: true,
        noise,
        tolerance,
        ramp_speed,
        still_speed: stillness.share * ramp_speed,
        slope_window: 1,
        minimum_hold: options.minimum_hold.unwrap_or(stillness.goes_on[0] / ramp_speed),
        minimum_samples: stillness.samples,
    };
    let levels: Vec<Level> = found.iter().map(|found| level(&values, *found)).collect();
    let segments = fill_gaps(&values, &levels, 2.0 * tolerance);
    if !segments.iter().any(|segment| segment.phase == Phase::Hold) {
        let Refused { duration, samples } = refused;
        return Err(SegmentError::NoHold {
            longest: duration,
            samples,
            minimum_hold: settings.minimum_hold,
            minimum_samples: settings.minimum_samples,
        });
    }
    Ok(Segmentation { segments, settings })
}

fn level(values: &[f64], found: Standstill) -> Level {
    let Standstill { start, end } = found;
    Level {
        start,
        end,
        value: median(&mut values[start..end].to_vec()),
    }
}

/// Speed of the ramps: half of the way outside standstills is travelled faster than this.
fn ramp_speed(time: &[f64], pieces: &[Piece], found: &[Standstill]) -> f64 {
    let still = |piece: &Piece| {
        let middle = piece.start.midpoint(piece.end);
        let next = found.partition_point(|hold| hold.end <= middle);
        found.get(next).is_some_and(|hold| hold.start <= middle)
    };
    let mut parts: Vec<(f64, f64)> = Vec::new();
    let mut last: Option<(f64, f64)> = None;
    for piece in pieces {
        let times = [time[piece.start], time[piece.end - 1]];
        let ends = times.map(|t| piece.line.at(t));
        if let Some((t, v)) = last {
            parts.push(((ends[0] - v).abs() / (times[0] - t), (ends[0] - v).abs()));
        }
        if !still(piece) && times[1] > times[0] {
            parts.push((piece.line.slope().abs(), (ends[1] - ends[0]).abs()));
        }
        last = Some((times[1], ends[1]));
    }
    parts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = parts.iter().map(|(_, way)| way).sum();
    let mut sum = 0.0;
    for (speed, way) in parts {
        sum += way;
        if sum >= 0.5 * total {
            return speed;
        }
    }
    0.0
}

/// Step of a column that was rounded. Repaired rows are means of two others and lie half a step off; few of them do not
/// make the step half as wide.
fn rounding(values: &[f64]) -> f64 {
    let step = quantum(values);
    if step == 0.0 {
        return 0.0;
    }
    let steps = || values.windows(2).map(|pair| ((pair[1] - pair[0]) / step).round() as i64).filter(|steps| *steps != 0);
    let odd = steps().filter(|steps| steps % 2 != 0).count();
    if 20 * odd < steps().count() { 2.0 * step } else { step }
}

/// The column without spikes of one row: a sample far off both neighbours, which agree, becomes their mean.
pub(super) fn without_spikes(values: &[f64], noise: f64) -> Vec<f64> {
    let mut clean = values.to_vec();
    for i in 1..values.len().saturating_sub(1) {
        let (a, b, c) = (clean[i - 1], values[i], values[i + 1]);
        let stray = (b - a).abs().min((b - c).abs());
        if (b - a) * (b - c) > 0.0 && stray > 6.0 * noise && (c - a).abs() < 0.5 * stray {
            clean[i] = 0.5 * (a + c);
        }
    }
    clean
}

fn bounds(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)))
}
