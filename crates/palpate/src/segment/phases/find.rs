//! The phases of a record: those that are given, those that its file labels, or those that a search finds.

use super::fit_start::start_behind;
use super::given::{GivenHold, searched_alone, with_given};
use super::labelled::labelled;
use super::whole::stated;
use crate::record::Record;
use crate::segment::{HoldStart, SegmentError, SegmentOptions, Segmentation};
use crate::watch::{Unwatched, Watch};

/// Fewest samples in which phases can be observed.
const NEEDED: usize = 8;

/// Finds the phases of a record: from its displacement and its force, or from its force alone where the displacement is missing.
///
/// Where the file labels its phases ([`Record::labels`]) these are the phases, and [`Segmentation::labels`] says where a search disagrees.
/// Every hold says what is held in it ([`HoldMode`](crate::segment::HoldMode)). Where the machine holds the force, the hold lasts as long as the force
/// stays, however far the jaw creeps. A record in which only the force relaxes, or only the jaw creeps, is one hold from its first sample on.
///
/// # Errors
/// [`SegmentError`] when nothing moves, or when no standstill after a ramp is long enough to be a hold.
pub fn find_phases(record: &Record, options: &SegmentOptions) -> Result<Segmentation, SegmentError> {
    phases_watched(record, options, &[], &mut Unwatched)
}

fn found(record: &Record, options: &SegmentOptions, watch: &mut dyn Watch) -> Result<Segmentation, SegmentError> {
    if record.len() < NEEDED {
        return Err(SegmentError::TooShort {
            needed: NEEDED,
            found: record.len(),
        });
    }
    // What a record is made of says more than the name of a step.
    if !record.labels().is_empty() && stated(record).is_none() {
        return labelled(record, options, watch);
    }
    searched_alone(record, options, watch)
}

/// Phases with these holds and no others; what lies between them is loading and unloading as found.
///
/// ```
/// use palpate::record::Record;
/// use palpate::segment::{GivenHold, Phase, SegmentOptions, phases_with};
/// let time: Vec<f64> = (0..100).map(|i| 0.1 * f64::from(i)).collect();
/// let jaw = time.iter().map(|t| 1e-3 * t.min(4.0)).collect();
/// let force = time.iter().map(|t| if *t < 4.0 { *t } else { 3.0 + (4.0 - t).exp() }).collect();
/// let record = Record::new(time, Some(jaw), force)?;
/// let given = GivenHold { from: 4.5, to: 9.0, mode: None };
/// let found = phases_with(&record, &SegmentOptions::default(), &[given])?;
/// let phases: Vec<Phase> = found.segments.iter().map(|segment| segment.phase).collect();
/// assert_eq!(phases, [Phase::Loading, Phase::Hold, Phase::Loading]);
/// assert_eq!((found.segments[1].start, found.segments[1].end), (45, 91));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SegmentError`] for a hold outside the record, one of fewer than three samples, and two that overlap. Without any given hold
/// as for [`find_phases`].
pub fn phases_with(
    record: &Record,
    options: &SegmentOptions,
    given: &[GivenHold],
) -> Result<Segmentation, SegmentError> {
    phases_watched(record, options, given, &mut Unwatched)
}

/// [`phases_with`] with a watch.
///
/// # Errors
/// As [`phases_with`], and [`SegmentError::Cancelled`].
pub fn phases_watched(
    record: &Record,
    options: &SegmentOptions,
    given: &[GivenHold],
    watch: &mut dyn Watch,
) -> Result<Segmentation, SegmentError> {
    let (record, strays) = record.without_strays();
    let mut found = if given.is_empty() {
        found(&record, options, watch)?
    } else {
        with_given(&record, options, given, watch)?
    };
    if options.hold_start != HoldStart::Settled {
        start_behind(&strays, &mut found.segments);
    }
    Ok(found)
}
