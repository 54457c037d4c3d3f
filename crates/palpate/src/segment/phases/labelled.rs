//! The phases that a file labels.

use super::fit_start::rests_from;
use super::given::{GivenHold, searched_alone, with_given};
use super::whole::begins_in_hold;
use crate::record::{LabelledSegment, Record};
use crate::segment::{LabelCheck, Phase, SegmentError, SegmentOptions, Segmentation, ramps_before};
use crate::statistics::range;
use crate::watch::Watch;

/// The phases that the file labels, and where a search disagrees with them.
pub(super) fn labelled(
    record: &Record,
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<Segmentation, SegmentError> {
    let labels = record.labels();
    let holds = labels.iter().filter(|label| label.holds);
    let given: Vec<GivenHold> = holds
        .map(|label| GivenHold {
            from: begins(record, label),
            to: label.to,
            mode: None,
        })
        .collect();
    let none = || SegmentError::NoneLabelled {
        names: labels.iter().map(|label| label.name.clone()).collect(),
    };
    if given.is_empty() {
        return Err(none());
    }
    let mut segmentation = with_given(record, options, &given, watch)?;
    let force = range(record.force());
    // A pause before anything is touched holds nothing.
    let answers = labels.first().is_some_and(LabelledSegment::names_answer);
    for index in 0..segmentation.segments.len() {
        let nothing_before = ramps_before(&segmentation.segments, index).next().is_none();
        let segment = &mut segmentation.segments[index];
        let is_first = segment.phase == Phase::Hold && segment.start == 0 && nothing_before;
        if is_first && !answers && !begins_in_hold(record, segment.end, force) {
            (segment.phase, segment.mode, segment.fit_start_rule) = (Phase::Rest, None, None);
        }
    }
    if segmentation.holds().next().is_none() {
        return Err(none());
    }
    let found = SegmentError::unless_cancelled(searched_alone(record, options, watch))?;
    let found: Vec<(usize, usize)> =
        found.iter().flat_map(Segmentation::holds).map(|hold| (hold.start, hold.end)).collect();
    let holds: Vec<(usize, usize)> = segmentation.holds().map(|hold| (hold.start, hold.end)).collect();
    let check = compared(&holds, &found);
    segmentation.labels = (check.missed + check.extra > 0).then_some(check);
    Ok(segmentation)
}

/// When a labelled hold begins, s. The label of a step of relaxation begins with the command, the hold where the machine has come
/// to rest.
fn begins(record: &Record, label: &LabelledSegment) -> f64 {
    let time = record.time();
    if label.from > time[0] || !label.names_relaxation() {
        return label.from;
    }
    let end = time.partition_point(|t| *t <= label.to);
    rests_from(record, end).map_or(label.from, |sample| time[sample])
}

/// Labelled holds against those of a search. Each is one of the other where they share half of themselves or more.
fn compared(labelled: &[(usize, usize)], found: &[(usize, usize)]) -> LabelCheck {
    LabelCheck {
        labelled: labelled.len(),
        missed: labelled.iter().filter(|hold| partner(**hold, found).is_none()).count(),
        extra: extra(labelled, found),
    }
}

/// How many holds of a search no label names: those outside of the labelled ones, and all but one of those inside each.
fn extra(labelled: &[(usize, usize)], found: &[(usize, usize)]) -> usize {
    let mut taken = vec![false; labelled.len()];
    let is_extra = |hold: &&(usize, usize)| match partner(**hold, labelled) {
        Some(of) => std::mem::replace(&mut taken[of], true),
        None => true,
    };
    found.iter().filter(is_extra).count()
}

/// Which of some stretches shares half of this one or more.
fn partner(stretch: (usize, usize), others: &[(usize, usize)]) -> Option<usize> {
    let shared = |other: &(usize, usize)| stretch.1.min(other.1).saturating_sub(stretch.0.max(other.0));
    others.iter().position(|other| 2 * shared(other) >= stretch.1 - stretch.0)
}
