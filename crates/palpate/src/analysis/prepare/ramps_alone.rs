//! A record without a hold: its ramps, from one turning point to the next.

use crate::analysis::AnalysisOptions;
use crate::record::Record;
use crate::segment::{self, Phase, Segment, SegmentError, SegmentSettings, Segmentation};
use crate::statistics::{noise_in_time, range};

/// A turn smaller than this many standard deviations of the noise is none.
const OBSERVED: f64 = 5.0;
/// A turn smaller than this share of the range is none.
const SHARE: f64 = 0.005;

/// Whether a search that ended so read the whole record: it has no hold, but may have ramps.
pub(super) fn is_without_hold(error: &SegmentError) -> bool {
    !matches!(
        error,
        SegmentError::Cancelled(_)
            | SegmentError::TooShort { .. }
            | SegmentError::GivenOutside { .. }
            | SegmentError::GivenShort { .. }
            | SegmentError::GivenOverlap { .. }
    )
}

/// The ramps of a record in which a search ended in `error`; rest throughout where nothing moves.
pub(super) fn ramps_alone(record: &Record, error: &SegmentError, options: &AnalysisOptions) -> Segmentation {
    let (time, values) = (record.time(), record.displacement().unwrap_or_else(|| record.force()));
    let noise = noise_in_time(time, values);
    let turn = (OBSERVED * noise).max(SHARE * range(values));
    let mut segments = segment::ramps_alone(values, turn);
    if matches!(error, SegmentError::NoMotion { .. }) {
        segments.iter_mut().for_each(|segment| segment.phase = Phase::Rest);
    }
    let speed = |segment: &Segment| {
        let (first, last) = (segment.start.saturating_sub(1), segment.end - 1);
        (values[last] - values[first]).abs() / (time[last] - time[first])
    };
    let ramp_speed = segments.iter().map(speed).filter(|speed| speed.is_finite()).fold(0.0, f64::max);
    let (minimum_hold, minimum_samples) = match error {
        SegmentError::NoHold {
            minimum_hold,
            minimum_samples,
            ..
        } => (*minimum_hold, *minimum_samples),
        _ => (options.segment.minimum_hold.unwrap_or(0.0), 0),
    };
    Segmentation {
        segments,
        ruptures: if let SegmentError::Ruptured(rupture) = error { vec![*rupture] } else { Vec::new() },
        ripple: None,
        labels: None,
        settings: SegmentSettings {
            from_displacement: record.displacement().is_some(),
            noise,
            tolerance: 0.5 * turn,
            ramp_speed,
            still_speed: 0.0,
            slope_window: 1,
            minimum_hold,
            minimum_samples,
        },
    }
}
