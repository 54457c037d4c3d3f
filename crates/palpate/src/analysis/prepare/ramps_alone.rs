//! A record without a hold: its ramps, from one turning point to the next.

use crate::analysis::AnalysisOptions;
use crate::record::Record;
use crate::segment::{Phase, Segment, SegmentError, SegmentSettings, Segmentation};
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
    let moves = !matches!(error, SegmentError::NoMotion { .. });
    let bounds = [vec![0], turns(values, turn).into_iter().map(|at| at + 1).collect(), vec![values.len()]].concat();
    let segments: Vec<Segment> = bounds
        .windows(2)
        .map(|pair| {
            let (start, end) = (pair[0], pair[1]);
            let rises = values[end - 1] >= values[start.saturating_sub(1)];
            Segment {
                phase: match (moves, rises) {
                    (false, _) => Phase::Rest,
                    (true, true) => Phase::Loading,
                    (true, false) => Phase::Unloading,
                },
                start,
                end,
                after: None,
                mode: None,
                fit_start: start,
                fit_start_rule: None,
            }
        })
        .collect();
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

/// The samples at which values turn by more than `least`.
fn turns(values: &[f64], least: f64) -> Vec<usize> {
    let (mut turns, mut extreme, mut rising) = (Vec::new(), 0, None);
    for (index, value) in values.iter().enumerate() {
        let change = value - values[extreme];
        match rising {
            None if change.abs() > least => (rising, extreme) = (Some(change > 0.0), index),
            Some(up) if (change > 0.0) == up => extreme = index,
            Some(up) if change.abs() > least => {
                turns.push(extreme);
                (rising, extreme) = (Some(!up), index);
            }
            _ => {}
        }
    }
    turns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_turns_nothing() {
        let there_and_back = [0.0, 1.0, 2.0, 1.9, 3.0, 2.0, 1.0, 1.1, 0.0, 1.0];
        assert_eq!(turns(&there_and_back, 0.5), [4, 8]);
        assert_eq!(turns(&there_and_back, 0.05), [2, 3, 4, 6, 7, 8]);
        assert!(turns(&[1.0; 5], 0.0).is_empty());
    }
}
