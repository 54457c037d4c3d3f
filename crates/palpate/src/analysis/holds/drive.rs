//! What a machine holds, where it goes on in the hold, and how much of the answer that makes.

use crate::analysis::finding::Finding;
use crate::record::Record;
use crate::segment::{HoldMode, OBSERVED, Segment, ramps_before};
use crate::statistics::{mean, median, noise};

/// Share of the answer that the drive makes, from which on it is stated: of a creep, whose laws have a time more for it; and of a relaxation.
const MATTERS: [f64; 2] = [0.01, 0.02];

/// How far what is held, by its `mode`, goes over the fitted part of segment `index`, in samples up to `end`; `None` where it stays, or where
/// the body's answer hardly shows it.
///
/// Half of the samples, a quarter and so on to a few at the start are held against the last tenth, so that a quick controller shows as well
/// as a slow one. What a body answers is taken to be in proportion to what it is driven by, from before the ramp on.
pub(super) fn drive_changes(
    record: &Record,
    (segments, index): (&[Segment], usize),
    mode: HoldMode,
    end: usize,
) -> Option<Finding> {
    /// Fewest samples at either end.
    const FEWEST: usize = 3;
    let segment = &segments[index];
    let (displacement, force) = (record.displacement()?, record.force());
    let ([drive, answer], least) = match mode {
        HoldMode::DisplacementHeld => ([displacement, force], MATTERS[1]),
        HoldMode::ForceHeld | HoldMode::Neither => ([force, displacement], MATTERS[0]),
    };
    let start = segment.fit_start;
    let (held, answered) = (drive.get(start..end)?, answer.get(start..end)?);
    let count = held.len();
    if count < 4 * FEWEST {
        return None;
    }
    let tail = |values: &[f64]| mean(&values[count - (count / 10).max(FEWEST)..]);
    let to = tail(held);
    let error = |some: usize| noise(held) * (1.0 / some as f64 + 10.0 / count as f64).sqrt();
    let heads = std::iter::successors(Some(count / 2), |some| Some(some / 2)).take_while(|some| *some >= FEWEST);
    let from = heads
        .map(|some| (mean(&held[..some]), some))
        .filter(|(from, some)| (from - to).abs() > OBSERVED * error(*some))
        .map(|(from, _)| from)
        .max_by(|one, other| (one - to).abs().total_cmp(&(other - to).abs()))?;
    let change = (tail(answered) - mean(&answered[..FEWEST])).abs();
    let [driven, came] = [held, answered].map(|values| median(&mut values.to_vec()));
    let share = match ramps_before(segments, index).last() {
        Some(ramp) => {
            let before = ramp.start.saturating_sub(1);
            let compliance = (came - answer[before]) / (driven - drive[before]);
            (compliance * (to - from) / change).abs()
        }
        // Where the answer began is not known: it went at least as far before as in the hold.
        None => ((to - from) / driven).abs(),
    };
    (share > least && share.is_finite()).then_some(Finding::DriveChanges { mode, from, to, share })
}
