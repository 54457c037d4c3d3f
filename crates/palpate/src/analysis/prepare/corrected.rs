//! The requested corrections, in order.

use super::baseline::BaselineError;
use super::lag::{ColumnLag, column_lag};
use super::ramps_alone::{is_without_hold, ramps_alone};
use super::skew::skew_watched;
use crate::analysis::{AnalysisError, AnalysisOptions, ClockSkew, Finding};
use crate::contact::{Shape, Specimen, SpecimenError};
use crate::record::{Correction, Record, SignalReport, SkewChoice};
use crate::segment::{
    ContactChoice, ContactPoint, SegmentError, Segmentation, find_contact_of, free_samples, phases_watched,
};
use crate::simulate::Separation;
use crate::watch::{Progress, Unwatched, Watch};

/// A corrected record with its phases, ready for first touch.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Corrected {
    /// The record; it knows what was done to it.
    pub record: Record,
    /// An error here is reported by those who need phases: a record of creep has none from its displacement.
    pub segmentation: Result<Segmentation, SegmentError>,
    /// Estimated skew of the clocks of the uncorrected record.
    pub skew: Option<ClockSkew>,
    /// Lag of the columns where one clock stamps both.
    pub lag: Option<ColumnLag>,
    /// Whether a correction of the skew was requested.
    pub skew_requested: bool,
    /// The errors of the baseline that was subtracted.
    baseline: Option<BaselineError>,
}

impl Corrected {
    /// The record with corrected clocks and the properties of its columns, if the clocks differ or a column lags.
    #[must_use]
    pub fn aligned(&self, record: &Record) -> Option<(Record, SignalReport)> {
        let aligned = match (self.skew.filter(ClockSkew::is_observed), self.lag) {
            (Some(skew), _) => record.without_skew(skew.skew, Some(skew.standard_error)),
            (None, Some(lag)) => record.without_skew(lag.lag, None),
            (None, None) => return None,
        };
        let aligned = aligned.ok()?;
        let signals = aligned.signals();
        Some((aligned, signals))
    }

    /// [`Finding::ClocksSkewed`] if two clocks differ and no correction was requested, [`Finding::ClocksOpen`] if it was requested and is
    /// not determined, or there is one clock.
    ///
    /// They differ if the skew exceeds its error and a sample interval, since the signal between two samples is unknown. The skew
    /// is not determined if its error exceeds the sample interval, or too few edges appear in both columns.
    #[must_use]
    pub fn skew_finding(&self) -> Option<Finding> {
        if self.record.clocks() == 1 {
            return self.skew_requested.then_some(Finding::ClocksOpen {
                skew: None,
                one_clock: true,
            });
        }
        let skew = self.skew.map(|skew| (skew, skew.interval.max(self.record.sample_interval())));
        let removed = |done: &Correction| matches!(done, Correction::SkewRemoved { .. });
        match skew {
            Some((skew, interval)) if skew.is_resolved(interval) && !self.record.corrections().iter().any(removed) => {
                Some(Finding::ClocksSkewed {
                    skew: skew.skew,
                    standard_error: skew.standard_error,
                })
            }
            Some((skew, interval)) if skew.is_observed() || 3.0 * skew.standard_error < 2.0 * interval => None,
            _ => self.skew_requested.then(|| Finding::ClocksOpen {
                skew: self.skew.map(|skew| (skew.skew, skew.standard_error)),
                one_clock: false,
            }),
        }
    }
}

/// Repairs single-row dropouts and makes the requested corrections, as [`analyze`](crate::analysis::analyze) does: skew, filter of
/// the force, sample times, baseline, compliance, in this order, since each needs those before it.
///
/// Edges are sought where they were measured; a baseline is the force where nothing touches; and a table of compliance
/// counts forces from zero.
///
/// # Errors
/// [`AnalysisError`] for a correction that cannot be made, and where a baseline is to be found but the phases are not.
pub fn corrected(record: &Record, options: &AnalysisOptions) -> Result<Corrected, AnalysisError> {
    corrected_watched(record, options, &mut Unwatched)
}

/// [`corrected`] with a watch.
///
/// # Errors
/// As [`corrected`], and [`AnalysisError::Cancelled`].
pub fn corrected_watched(
    record: &Record,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<Corrected, AnalysisError> {
    watch.report(Progress::open("correcting the record", 0))?;
    let record = record.repaired();
    let requested = &options.corrections;
    let phases = |record: &Record, watch: &mut dyn Watch| {
        watch.report(Progress::open("correcting the record", 0))?;
        SegmentError::unless_cancelled(phases_watched(record, &options.segment, &options.given_holds, watch))
    };
    let segmentation = phases(&record, watch)?;
    let skew = match &segmentation {
        // What one clock stamps cannot differ in time: a bend of the force is then one of the body.
        Ok(segmentation) if record.clocks() > 1 => skew_watched(&record, segmentation, watch)?,
        _ => None,
    };
    let mut next = record;
    let before = next.corrections().len();
    match (requested.skew, skew.filter(ClockSkew::is_observed)) {
        (SkewChoice::Given(given), _) => next = next.without_skew(given, None)?,
        (SkewChoice::Auto, Some(observed)) => next = next.without_skew(observed.skew, Some(observed.standard_error))?,
        (SkewChoice::Auto, None) | (SkewChoice::Report, _) => {}
    }
    if let Some(time_constant) = requested.force_filter {
        next = next.without_filter(time_constant)?;
    }
    if let Some(rate) = requested.resample {
        next = next.resampled(rate)?;
    }
    let mut baseline_error = None;
    if let Some(baseline) = requested.baseline {
        let free = match requested.baseline_window {
            Some((from, until)) => {
                let index = |at: f64| next.time().partition_point(|time| *time < at);
                std::iter::once(index(from)..index(until)).collect()
            }
            None => free_samples(&next, &phases(&next, watch)??),
        };
        next = next.without_baseline(baseline, &free)?;
        baseline_error = BaselineError::of(&next, baseline, &free);
    }
    if let Some(compliance) = &requested.compliance {
        next = next.without_compliance(compliance)?;
    }
    touch_within(&next, options.touch)?;
    let segmentation = if next.corrections().len() == before { segmentation } else { phases(&next, watch)? };
    let lag = match &segmentation {
        Ok(segmentation) if next.clocks() == 1 => column_lag(&next, segmentation),
        _ => None,
    };
    Ok(Corrected {
        lag,
        record: next,
        segmentation,
        skew,
        skew_requested: requested.skew == SkewChoice::Auto,
        baseline: baseline_error,
    })
}

/// Refuses a first touch that the jaw does not reach.
fn touch_within(record: &Record, touch: ContactChoice) -> Result<(), AnalysisError> {
    let (ContactChoice::Displacement(requested), Some(displacement)) = (touch, record.displacement()) else {
        return Ok(());
    };
    let farthest = displacement.iter().copied().fold(f64::MIN, f64::max);
    if requested < farthest { Ok(()) } else { Err(AnalysisError::TouchBeyond { requested, farthest }) }
}

/// A record whose displacement and force begin at first touch, with its phases.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Prepared {
    /// The record; it knows what was done to it.
    pub record: Record,
    /// Its phases.
    pub segmentation: Segmentation,
    /// First touch, and what was subtracted.
    pub contact: ContactPoint,
}

/// Makes the requested corrections, detects the phases and sets the record to zero at first touch, as
/// [`analyze`](crate::analysis::analyze) does.
///
/// # Errors
/// [`AnalysisError`] for a correction that cannot be made, a record without holds, and a body that the jaw would go through.
pub fn prepared(record: &Record, options: &AnalysisOptions) -> Result<Prepared, AnalysisError> {
    corrected(record, options)?.prepared(options, options.touch)
}

impl Corrected {
    /// The same, with its ramps where it has no hold; then also why not.
    pub(in crate::analysis) fn or_ramps_alone(self, options: &AnalysisOptions) -> (Self, Option<SegmentError>) {
        match self.segmentation {
            Err(error) if is_without_hold(&error) => {
                let segmentation = Ok(ramps_alone(&self.record, &error, options));
                (Self { segmentation, ..self }, Some(error))
            }
            _ => (self, None),
        }
    }

    /// The same set to zero at first touch, which `touch` says how to find.
    pub(crate) fn prepared(&self, options: &AnalysisOptions, touch: ContactChoice) -> Result<Prepared, AnalysisError> {
        let segmentation = self.segmentation.clone()?;
        // First touch is one of geometry, and so is the limit below; any modulus will do.
        let body = options.geometry.as_ref().map(|geometry| geometry.specimen(1.0)).transpose()?;
        let contact = find_contact_of(&self.record, &segmentation, body.as_ref(), touch);
        let contact = match self.baseline {
            Some(baseline) => baseline.added_to(contact, &self.record),
            None => contact,
        };
        let record = self.record.tared(contact.tare);
        beyond_body(&record, body.as_ref(), options)?;
        Ok(Prepared {
            record,
            segmentation,
            contact,
        })
    }
}

/// An error if the jaw goes as far as the body is deep: a unit, a radius or a number of sides is wrong.
///
/// A ball and a body between plates have that limit; a strip in grips can be stretched beyond its own length.
fn beyond_body(record: &Record, body: Option<&Specimen>, options: &AnalysisOptions) -> Result<(), AnalysisError> {
    let (Some(body), Some(displacement)) = (body, record.displacement()) else {
        return Ok(());
    };
    // A travel that was a strain or an angle may be one of shear, which has no end.
    let is_travel = !record.corrections().iter().any(|done| matches!(done, Correction::ReadAs { .. }));
    let is_stretched = options.separation == Separation::Bonded && !(options.squeezed && is_travel);
    if is_stretched && matches!(body.shape(), Shape::Prism { .. }) {
        return Ok(());
    }
    let share = body.contact_displacement(1.0);
    for (index, travel) in displacement.iter().enumerate() {
        if let Err(SpecimenError::TooDeep { limit, limit_name, .. }) =
            body.check_contact_displacement(travel * share, false)
        {
            return Err(AnalysisError::BeyondBody {
                sample: index + 1,
                time: record.time()[index],
                found: *travel,
                limit: limit / share,
                limit_name,
            });
        }
    }
    Ok(())
}
