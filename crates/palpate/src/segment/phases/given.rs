//! The phases of a record: all of them sought, or with holds whose limits someone gives.

use serde::{Deserialize, Serialize};

use super::fit_start::place_fits;
use super::ramps::fill_gaps;
use super::whole::{creeps_throughout, relaxes_throughout, stated, whole};
use super::{from_both, from_force};
use crate::record::Record;
use crate::segment::{
    Held, HoldMode, Level, Phase, SegmentError, SegmentOptions, SegmentSettings, Segmentation, hear, levels, mode,
};
use crate::statistics::{noise_in_time, range};
use crate::watch::{Cancelled, Watch};

/// The phases by the columns alone.
pub(super) fn searched_alone(
    record: &Record,
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<Segmentation, SegmentError> {
    let throughout = |mode: HoldMode, watch: &mut dyn Watch| {
        let (from, to) = (record.time()[0], record.time()[record.len() - 1]);
        let mode = Some(mode);
        with_given(record, options, &[GivenHold { from, to, mode }], watch)
    };
    if let Some(mode) = stated(record) {
        return throughout(mode, watch);
    }
    let found = match record.displacement() {
        Some(displacement) => from_both::phases(record, displacement, options, watch),
        None => from_force::phases(record.time(), record.force(), options, watch),
    };
    let mode = match &found {
        Err(SegmentError::Cancelled(cancelled)) => return Err((*cancelled).into()),
        found if creeps_throughout(record, found.as_ref().ok()) => Some(HoldMode::ForceHeld),
        Ok(segmentation) if relaxes_throughout(record, segmentation) => Some(HoldMode::DisplacementHeld),
        Ok(_) => None,
        Err(error) => whole(record, error),
    };
    if let Some(mode) = mode {
        return throughout(mode, watch);
    }
    let mut segmentation = found?;
    hear(watch)?;
    place_fits(record, options, &mut segmentation.segments);
    Ok(segmentation)
}

/// A hold with limits that are given and not sought.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GivenHold {
    /// Its first moment, s, as the record counts time.
    pub from: f64,
    /// Its last moment, s.
    pub to: f64,
    /// The held quantity; `None`: derived from the record.
    pub mode: Option<HoldMode>,
}

/// Fewest samples of a hold that is given.
const FEWEST: usize = 3;

/// Phases with these holds and no others; what lies between them is loading and unloading as found.
pub(super) fn with_given(
    record: &Record,
    options: &SegmentOptions,
    given: &[GivenHold],
    watch: &mut dyn Watch,
) -> Result<Segmentation, SegmentError> {
    let held = record.displacement().unwrap_or_else(|| record.force());
    let mut places = Vec::with_capacity(given.len());
    for (index, hold) in given.iter().enumerate() {
        places.push((samples(record, hold, index + 1)?, hold, index + 1));
    }
    places.sort_by_key(|((start, _), ..)| *start);
    for pair in places.windows(2) {
        if pair[0].0.1 > pair[1].0.0 {
            let (first, second) = (pair[0].2.min(pair[1].2), pair[0].2.max(pair[1].2));
            return Err(SegmentError::GivenOverlap { first, second });
        }
    }
    let (values, settings) = searched(record, held, options, watch)?;
    let given: Vec<Level> = places.iter().map(|((start, end), ..)| Level::of(&values, *start, *end)).collect();
    let mut segments = fill_gaps(&values, &given, 2.0 * settings.tolerance);
    for ((start, end), hold, _) in &places {
        hear(watch)?;
        let segment = segments.iter_mut().find(|segment| (segment.start, segment.end) == (*start, *end));
        if let Some(segment) = segment {
            segment.phase = Phase::Hold;
            segment.mode = Some(hold.mode.unwrap_or_else(|| mode(record, *start, *end)));
        }
    }
    place_fits(record, options, &mut segments);
    Ok(Segmentation {
        segments,
        ruptures: Vec::new(),
        ripple: None,
        labels: None,
        settings,
    })
}

/// The samples of a given hold.
fn samples(record: &Record, hold: &GivenHold, number: usize) -> Result<(usize, usize), SegmentError> {
    let time = record.time();
    let (begin, last) = (time[0], time[time.len() - 1]);
    let slack = 1e-9 * (last - begin);
    let GivenHold { from, to, .. } = *hold;
    if !(from >= begin - slack && to <= last + slack) {
        return Err(SegmentError::GivenOutside {
            number,
            from,
            to,
            begin,
            last,
        });
    }
    let start = time.partition_point(|t| *t < from - slack);
    let end = time.partition_point(|t| *t <= to + slack);
    if end < start + FEWEST {
        return Err(SegmentError::GivenShort {
            number,
            from,
            to,
            samples: end.saturating_sub(start),
            needed: FEWEST,
        });
    }
    Ok((start, end))
}

/// The column without spikes and the thresholds of a search, also where a search would find nothing.
fn searched(
    record: &Record,
    values: &[f64],
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<(Vec<f64>, SegmentSettings), Cancelled> {
    let wander = options.tolerance.unwrap_or(0.002 * range(values));
    let held = Held::new(("displacement", "m"), values, wander, false);
    let from_displacement = record.displacement().is_some();
    if let Ok(found) = SegmentError::unless_cancelled(levels(record.time(), &held, options, watch))? {
        let settings = SegmentSettings {
            from_displacement,
            ..found.settings
        };
        return Ok((found.values, settings));
    }
    let noise = noise_in_time(record.time(), values);
    let settings = SegmentSettings {
        from_displacement,
        noise,
        tolerance: (2.5 * noise).max(wander),
        ramp_speed: 0.0,
        still_speed: 0.0,
        slope_window: 1,
        minimum_hold: 0.0,
        minimum_samples: FEWEST,
    };
    Ok((values.to_vec(), settings))
}
