//! Phases from the force alone, where no displacement was recorded.
//!
//! In a ramp the force runs; in a hold it slows down until it hardly moves. Where it hardly moves is the core of a hold;
//! going back from there, the last turning point of the force is where the ramp ended and relaxation began. A hold that
//! goes on in the direction of its ramp has no such point and begins at its core. Where no force stands still, relaxations
//! that are slow all along are sought behind the turning points.

use super::after_peaks::relaxations;
use super::ramps::fill_gaps;
use super::turning::turns;
use crate::segment::{
    Held, Level, Phase, Segment, SegmentError, SegmentOptions, SegmentSettings, Segmentation, hear, levels,
};
use crate::statistics::median;
use crate::watch::Watch;

/// Speed of the core of a hold as a share of the speed of the ramps.
const STILL_BELOW: f64 = 0.35;
/// Share of its range by which a force must turn back to have turned.
const TURN: f64 = 0.004;
/// Share of its range by which a force may still relax in the core of a hold.
const WANDER: f64 = 0.02;
/// Least turn of a force, as a share of its range, about a relaxation that is slow all along: what relaxes less comes to stand.
const SLOW: f64 = 0.1;

pub(super) fn phases(
    time: &[f64],
    force: &[f64],
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<Segmentation, SegmentError> {
    let (low, high) = force.iter().fold((f64::MAX, f64::MIN), |(low, high), f| (low.min(*f), high.max(*f)));
    let range = high - low;
    let held = Held::new(("force", "N"), force, WANDER * range, false);
    let searched = SegmentOptions {
        still_below: Some(options.still_below.unwrap_or(STILL_BELOW)),
        ..*options
    };
    let found = levels(time, &held, &searched, watch)?;
    let settings = SegmentSettings {
        from_displacement: false,
        tolerance: (6.0 * found.settings.noise).max(TURN * range),
        ..found.settings
    };
    let (turn, noise, still) = (settings.tolerance, settings.noise, settings.still_speed);
    let (mut levels, mut before): (Vec<Level>, usize) = (Vec::new(), 0);
    for core in &found.levels {
        hear(watch)?;
        if options.minimum_hold.is_none() && core.start > 0 && turns(time, force, *core, turn, 0.2) {
            continue;
        }
        let start = if core.start == 0 {
            0
        } else {
            beginning(time, force, before, (core.start, still), turn, (low, high))
        };
        let end = ending(force, (core.start, core.end), 3.0 * noise);
        levels.push(Level { start, end, ..*core });
        before = end;
    }
    if levels.iter().all(|level| level.start == 0 || force[level.end - 1] <= low + 0.02 * range) {
        hear(watch)?;
        let mut slow = relaxations(time, force, (2.0 * turn).max(SLOW * range), found.settings.minimum_samples);
        slow.retain(|slow| options.minimum_hold.is_none_or(|least| time[slow.end - 1] - time[slow.start] >= least));
        levels.retain(|level| slow.iter().all(|slow| level.end <= slow.start || slow.end <= level.start));
        levels.extend(slow);
        levels.sort_by_key(|level| level.start);
    }
    hear(watch)?;
    let segments = fill_gaps(force, &levels, turn);
    // A contact that is open shows no force and no hold; one at the end of a test counts only beside true holds.
    let floor = low + 0.02 * (high - low) + 3.0 * noise;
    let holds = |segment: &Segment| segment.phase == Phase::Hold && force[segment.end - 1] > floor;
    if !segments.iter().any(holds) {
        return Err(found.none());
    }
    Ok(Segmentation {
        segments,
        ruptures: Vec::new(),
        ripple: None,
        labels: None,
        settings,
    })
}

/// Where the hold begins whose core begins at `core`: the last turning point of the force since `from`, if what follows
/// it is relaxation and not a ramp.
///
/// Relaxation is fast first and slow later: most of its change is done half way. The end of a ramp to the lowest force
/// of the record (a contact that opens) bends the same way, so there the change must be further on. A slow relaxation
/// bends less, but runs into the core without a kink, which no ramp does.
fn beginning(
    time: &[f64],
    force: &[f64],
    from: usize,
    (core, still): (usize, f64),
    turn: f64,
    (low, high): (f64, f64),
) -> usize {
    let Some(start) = last_turn(force, from, core, turn) else {
        return core;
    };
    let half = time.partition_point(|t| *t < 0.5 * (time[start] + time[core]));
    let done = (force[half] - force[start]) / (force[core] - force[start]);
    let opens = force[core] - low < 0.08 * (high - low);
    let (a, b) = (core.saturating_sub(5).max(start), core.saturating_sub(2).max(start));
    let smooth = a < b && (force[b] - force[a]).abs() <= 2.0 * still * (time[b] - time[a]);
    let bends = if opens { done > 0.8 } else { done > 0.6 || (smooth && done > 0.5) };
    if bends { start } else { core }
}

/// The end of a hold: samples beyond its core that stay at the level of its last quarter belong to it.
fn ending(force: &[f64], core: (usize, usize), stray: f64) -> usize {
    let level = median(&mut force[core.1 - ((core.1 - core.0) / 4).max(1)..core.1].to_vec());
    let most = (core.1 + 4).min(force.len());
    let off = (core.1..most).find(|i| (force[*i] - level).abs() > stray);
    off.unwrap_or(most)
}

/// The last sample of from..until at which the force turns by more than `turn`.
fn last_turn(force: &[f64], from: usize, until: usize, turn: f64) -> Option<usize> {
    let settled = force[until];
    let mut highest = until;
    let mut lowest = until;
    for i in (from..until).rev() {
        if force[i] > force[highest] {
            highest = i;
        }
        if force[i] < force[lowest] {
            lowest = i;
        }
        // Going back in time: first away from the settled force, then back towards and past it.
        if force[highest] - settled > turn && force[highest] - force[i] > turn {
            return Some(highest);
        }
        if settled - force[lowest] > turn && force[i] - force[lowest] > turn {
            return Some(lowest);
        }
    }
    None
}
