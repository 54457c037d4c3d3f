//! Phases from the force alone, where no displacement was recorded.
//!
//! In a ramp the force runs; in a hold it slows down until it hardly moves. Where it hardly moves is the core of a hold;
//! going back from there, the last turning point of the force is where the ramp ended and relaxation began. A hold that
//! goes on in the direction of its ramp has no such point and begins at its core.

use super::ramps::{Level, fill_gaps};
use super::slope::{slopes, travel_median};
use super::turning::turns;
use super::{Phase, Segment, SegmentError, SegmentOptions, SegmentSettings, Segmentation};
use crate::statistics::{median, noise_in_time};

/// Speed of the core of a hold as a share of the speed of the ramps.
const STILL_BELOW: f64 = 0.08;
/// Fewest samples of a hold.
const MINIMUM_SAMPLES: usize = 12;
/// Shortest hold as a share of the median duration of what lies between cores.
const SHORTEST: f64 = 0.25;

pub(super) fn phases(time: &[f64], force: &[f64], options: &SegmentOptions) -> Result<Segmentation, SegmentError> {
    let (low, high) = force.iter().fold((f64::MAX, f64::MIN), |(low, high), f| (low.min(*f), high.max(*f)));
    let (range, noise) = (high - low, noise_in_time(time, force));
    if range == 0.0 || range < 12.0 * noise {
        return Err(SegmentError::NoMotion {
            column: "force",
            range,
            noise,
            unit: "N",
        });
    }
    let (window, ramp_speed, still) = thresholds(time, force, noise, options);
    let speeds = slopes(time, force, window);
    let turn = (6.0 * noise).max(0.004 * range);
    let cores = merged(cores(&speeds, still), time, force, 2.0 * still, 6.0 * noise, 0.03 * range);
    let mut gaps: Vec<f64> = cores.windows(2).map(|pair| time[pair[1].0] - time[pair[0].1 - 1]).collect();
    if let Some((start, _)) = cores.first() {
        gaps.push(time[*start] - time[0]);
    }
    gaps.retain(|gap| *gap > 0.0);
    let typical = if gaps.is_empty() { 0.0 } else { median(&mut gaps) };
    let minimum_hold = options.minimum_hold.unwrap_or(SHORTEST * typical);
    let minimum_samples = if options.minimum_hold.is_some() { 3 } else { MINIMUM_SAMPLES };
    let settings = SegmentSettings {
        from_displacement: false,
        noise,
        tolerance: turn,
        ramp_speed,
        still_speed: still,
        slope_window: window,
        minimum_hold,
        minimum_samples,
    };
    let (mut levels, mut before): (Vec<Level>, usize) = (Vec::new(), 0);
    let (mut longest, mut samples) = (0.0f64, 0);
    for (core_start, end) in cores {
        let duration = time[end - 1] - time[core_start];
        if core_start > 0 && duration > longest {
            (longest, samples) = (duration, end - core_start);
        }
        let value = median(&mut force[core_start..end].to_vec());
        let core = Level {
            start: core_start,
            end,
            value,
        };
        let tip = options.minimum_hold.is_none() && core_start > 0 && turns(time, force, core, turn, 0.2);
        if duration >= minimum_hold && end - core_start >= minimum_samples && !tip {
            let start = if core_start == 0 {
                0
            } else {
                beginning(time, force, before, (core_start, window, still), turn, (low, high))
            };
            let end = ending(force, (core_start, end), window, 3.0 * noise);
            levels.push(Level { start, end, value });
            before = end;
        }
    }
    let segments = fill_gaps(force, &levels, turn);
    // A contact that is open shows no force and no hold; one at the end of a test counts only beside true holds.
    let floor = low + 0.02 * (high - low) + 3.0 * noise;
    let holds = |segment: &Segment| segment.phase == Phase::Hold && force[segment.end - 1] > floor;
    if !segments.iter().any(holds) {
        return Err(SegmentError::NoHold {
            longest,
            samples,
            minimum_hold,
            minimum_samples,
        });
    }
    Ok(Segmentation { segments, settings })
}

fn thresholds(time: &[f64], force: &[f64], noise: f64, options: &SegmentOptions) -> (usize, f64, f64) {
    let share = options.still_below.unwrap_or(STILL_BELOW);
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let interval = median(&mut steps);
    let slope_noise = |window: usize| noise * (2.0 / window as f64).sqrt() / (window as f64 * interval);
    // A jaw that starts or stops makes the force ring; a window of a two-hundredth of the record sees the ramp instead.
    let wide = (force.len() / 200).max(1);
    let ramp = travel_median(time, &slopes(time, force, wide), 4.0 * slope_noise(wide));
    let mut window = 1;
    loop {
        let slope_noise = slope_noise(window);
        let still = (share * ramp).max(4.0 * slope_noise);
        // Wider windows until the noise alone never crosses the threshold.
        if 6.0 * slope_noise <= share * ramp || window * 16 > force.len() || ramp == 0.0 {
            return (window, ramp, still);
        }
        window *= 2;
    }
}

/// Runs of samples over which the force hardly moves.
fn cores(speeds: &[f64], still: f64) -> Vec<(usize, usize)> {
    let mut runs = Vec::new();
    let mut start = None;
    for gap in 0..=speeds.len() {
        match (speeds.get(gap).is_some_and(|speed| speed.abs() < still), start) {
            (true, None) => start = Some(gap),
            (false, Some(first)) => {
                runs.push((first, gap + 1));
                start = None;
            }
            _ => {}
        }
    }
    runs
}

/// Cores with nothing but noise or slow relaxation between them become one: on the way the force neither runs faster
/// than `speed` on the whole (give or take `noise`) nor leaves the straight line between them by more than `stray`.
fn merged(
    cores: Vec<(usize, usize)>,
    time: &[f64],
    force: &[f64],
    speed: f64,
    noise: f64,
    stray: f64,
) -> Vec<(usize, usize)> {
    let mut merged: Vec<(usize, usize)> = Vec::new();
    for core in cores {
        if let Some(last) = merged.last_mut() {
            let (a, b) = (last.1 - 1, core.0);
            let (rise, run) = (force[b] - force[a], time[b] - time[a]);
            let straight =
                (a..b).all(|i| (force[i] - force[a] - rise / run * (time[i] - time[a])).abs() <= stray + noise);
            if rise.abs() <= speed * run + noise && straight {
                last.1 = core.1;
                continue;
            }
        }
        merged.push(core);
    }
    merged
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
    (core, window, still): (usize, usize, f64),
    turn: f64,
    (low, high): (f64, f64),
) -> usize {
    let Some(start) = last_turn(force, from, core, turn) else {
        return core;
    };
    let half = time.partition_point(|t| *t < 0.5 * (time[start] + time[core]));
    let done = (force[half] - force[start]) / (force[core] - force[start]);
    let opens = force[core] - low < 0.08 * (high - low);
    // The window blurs a kink over its own width on either side.
    let (a, b) = (core.saturating_sub(2 * window + 3).max(start), core.saturating_sub(window + 1).max(start));
    let smooth = a < b && (force[b] - force[a]).abs() <= 2.0 * still * (time[b] - time[a]);
    let bends = if opens { done > 0.8 } else { done > 0.6 || (smooth && done > 0.5) };
    if bends { start } else { core }
}

/// The end of a hold: samples that the window blurred but that stay at the level of its last quarter belong to it.
fn ending(force: &[f64], core: (usize, usize), window: usize, stray: f64) -> usize {
    let level = median(&mut force[core.1 - ((core.1 - core.0) / 4).max(1)..core.1].to_vec());
    let most = (core.1 + 2 * window + 2).min(force.len());
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
