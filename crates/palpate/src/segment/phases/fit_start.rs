//! From where in a hold the laws are fitted.

use crate::record::Record;
use crate::segment::{After, HoldMode, HoldStart, Phase, Segment, SegmentOptions, ramps_before};
use crate::statistics::noise;

/// Sets from where laws are fitted to each hold.
pub(super) fn place_fits(record: &Record, options: &SegmentOptions, segments: &mut [Segment]) {
    // A hold of constant force is fitted from where the displacement peaks.
    let exchanged = record.exchanged().and_then(Result::ok);
    for index in 0..segments.len() {
        let answers = exchanged.as_ref().filter(|_| segments[index].mode == Some(HoldMode::ForceHeld));
        segments[index].fit_start = options.hold_start.sample(answers.unwrap_or(record), segments, index);
    }
}

impl HoldStart {
    /// The sample from which to fit segment `index`.
    fn sample(self, record: &Record, segments: &[Segment], index: usize) -> usize {
        let segment = &segments[index];
        if segment.phase != Phase::Hold {
            return segment.start;
        }
        match self {
            Self::Settled => segment.start,
            Self::Peak => peak(record, segments, index),
            Self::AfterPeak(delay) => {
                let from = record.time()[peak(record, segments, index)] + delay;
                let sample = record.time().partition_point(|time| *time < from);
                sample.clamp(segment.start, segment.end - 1)
            }
        }
    }
}

/// The extreme of the force about the start of a hold, or the start of the hold where there is none.
///
/// It is sought in the first twentieth of the hold (its first 12 samples at least); if the force still runs at the end of
/// that stretch it is no peak but a trend. A jaw that overshoots, or that stops a moment before it counts as standing
/// still, leaves the peak before the hold: it counts if it stands out from all that follows by more than noise.
fn peak(record: &Record, segments: &[Segment], index: usize) -> usize {
    let segment = &segments[index];
    let force = record.force();
    let times = &record.time()[..segment.end];
    let twentieth = times[segment.start] + 0.05 * (times[segment.end - 1] - times[segment.start]);
    let until = times.partition_point(|time| *time <= twentieth).max(segment.start + 12).min(segment.end);
    let sign = if segment.after == Some(After::Unloading) { -1.0 } else { 1.0 };
    let height = |index: &usize| sign * force[*index];
    let highest = |from: usize, until: usize| (from..until).max_by(|a, b| height(a).total_cmp(&height(b)));
    let inside = match highest(segment.start, until) {
        Some(index) if index + 1 < until => index,
        _ => segment.start,
    };
    let from = settling(record, segments, index);
    match highest(from, segment.start) {
        // The first of the stretch is no peak: the force came down to it already.
        Some(early) if early > from && height(&early) > height(&inside) + 3.0 * noise(&force[from..until]) => early,
        _ => inside,
    }
}

/// From where before a hold its peak may lie: 12 samples, or as long as the jaw has been within a fiftieth of its ramp.
fn settling(record: &Record, segments: &[Segment], index: usize) -> usize {
    const FEWEST: usize = 12;
    let start = segments[index].start;
    let ramp = ramps_before(segments, index).last().map_or(start, |segment| segment.start);
    let near = record.displacement().map_or(start, |displacement| {
        let level = displacement[start];
        let band = 0.02 * (level - displacement[ramp.saturating_sub(1)]).abs();
        (ramp..start).rev().take_while(|i| (displacement[*i] - level).abs() <= band).last().unwrap_or(start)
    });
    near.min(start.saturating_sub(FEWEST)).max(ramp)
}
