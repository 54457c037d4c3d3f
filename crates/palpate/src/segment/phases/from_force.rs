//! Phases from the force alone, where no displacement was recorded.

use super::ramps::fill_gaps;
use crate::segment::force_alone::{Stretch, stretches};
use crate::segment::{
    After, Held, Level, Phase, Segment, SegmentError, SegmentOptions, SegmentSettings, Segmentation, levels,
};
use crate::statistics::bounds;
use crate::watch::Watch;

/// Share of its range by which a force must turn back to have turned.
const TURN: f64 = 0.004;
/// Share of its range by which a force may still relax in a hold.
const WANDER: f64 = 0.02;

/// Standard deviations of noise within which a force that does nothing stays.
const NOISE: f64 = 14.0;

pub(super) fn phases(
    time: &[f64],
    force: &[f64],
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<Segmentation, SegmentError> {
    let (low, high) = bounds(force);
    let range = high - low;
    // Where a force does not move at all, and what a hold needs, is known as for any column.
    let held = Held::new(("force", "N"), force, WANDER * range, false);
    let still = levels(time, &held, options, watch)?;
    let settings = SegmentSettings {
        from_displacement: false,
        tolerance: (6.0 * still.settings.noise).max(TURN * range),
        ..still.settings
    };
    if range < NOISE * still.settings.noise || toggles(force) {
        return Err(SegmentError::NoHoldInForce);
    }
    let (mut found, noise) = stretches(time, force, watch)?;
    begin_at_extremes(force, &mut found, settings.tolerance.max(2.0 * noise));
    let long = |start: usize, end: usize| options.minimum_hold.is_none_or(|least| time[end - 1] - time[start] >= least);
    let holds: Vec<_> = found.iter().filter(|stretch| stretch.holds && long(stretch.start, stretch.end)).collect();
    let levels: Vec<Level> = holds.iter().map(|hold| Level::of(force, hold.start, hold.end)).collect();
    let mut segments = fill_gaps(force, &levels, settings.tolerance);
    for pair in found.windows(2).filter(|pair| pair[1].holds) {
        let same = |segment: &&mut Segment| segment.phase == Phase::Hold && segment.start == pair[1].start;
        let Some(segment) = segments.iter_mut().find(same) else {
            continue;
        };
        segment.doubtful = pair[1].doubtful;
        // A ramp shows in the first force of the hold, if in no sample before it.
        let rise = force[segment.start] - force[pair[0].start.saturating_sub(1)];
        if !pair[0].holds && rise.abs() > settings.tolerance {
            segment.after = Some(if rise > 0.0 { After::Loading } else { After::Unloading });
        }
    }
    // A contact that is open shows no force and no hold; one at the end of a test counts only beside true holds.
    let floor = low + 0.02 * range + 3.0 * settings.noise;
    let loaded = |segment: &Segment| segment.phase == Phase::Hold && force[segment.end - 1] > floor;
    if !segments.iter().any(loaded) {
        return Err(SegmentError::NoHoldInForce);
    }
    Ok(Segmentation {
        segments,
        ruptures: Vec::new(),
        ripple: None,
        labels: None,
        settings,
    })
}

/// Most values between which a force toggles of which rounding has left nothing but a level and its neighbours; the share of the samples that they
/// have; and fewest changes that show it.
const LEVELS: (usize, f64, usize) = (4, 0.98, 20);

/// Whether a force does little but toggle between a few values of its rounding.
fn toggles(force: &[f64]) -> bool {
    let mut values = force.to_vec();
    values.sort_unstable_by(f64::total_cmp);
    let mut counts: Vec<usize> = values.chunk_by(|a, b| a == b).map(<[f64]>::len).collect();
    counts.sort_unstable_by(|a, b| b.cmp(a));
    let (most, share, fewest) = LEVELS;
    let changes = force.windows(2).filter(|pair| pair[0] != pair[1]).count();
    counts.iter().take(most).sum::<usize>() as f64 >= share * force.len() as f64 && changes >= fewest
}

/// Begins every hold where its force begins to relax: at the extreme of the ramp before it, if what follows goes on as in the hold.
fn begin_at_extremes(force: &[f64], stretches: &mut [Stretch], turn: f64) {
    for index in 1..stretches.len() {
        let (before, hold) = (stretches[index - 1], stretches[index]);
        if before.holds || !hold.holds {
            continue;
        }
        let falls = (force[hold.start] - force[hold.end - 1]).signum();
        let extreme = (before.start..=hold.start).max_by(|a, b| (falls * force[*a]).total_cmp(&(falls * force[*b])));
        if let Some(extreme) = extreme
            && extreme > before.start
            && falls * (force[extreme] - force[hold.start]) > turn
        {
            stretches[index].start = extreme;
            stretches[index - 1].end = extreme;
        }
    }
}
