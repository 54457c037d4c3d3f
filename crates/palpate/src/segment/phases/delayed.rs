//! A force that an amplifier or a filter delays: it still rises after the jaw has stopped.

use std::ops::Range;

use super::turning::extremes;
use crate::record::Record;
use crate::segment::{After, HoldMode, Segment, ramps_before};
use crate::statistics::{median, noise, quantum, range, slope};

/// How far the force rises beyond what the jaw still travels, in standard deviations of its noise, and as a share of the ramp.
const RISES: f64 = 6.0;
const MATTERS: f64 = 0.005;
/// Fewest sample intervals from the stop of the jaw to the extreme of the force.
const INTERVALS: usize = 3;
/// Share of the ramp whose rates at its end are those at the stop.
const LAST: f64 = 0.2;
/// What may be left of the delay where a fit begins: a share of a standard deviation of the noise, and of the change over the hold.
const NOISE_LEFT: f64 = 0.5;
const CHANGE_LEFT: f64 = 1e-3;
/// Times from the stop to the extreme within which a force that swings turns again.
const SWINGS: usize = 8;
/// Share of what the force would rise at the rate of the ramp that a filter leaves at most; e^−x falls behind a line by half at x = 1.6.
const AT_ONCE: f64 = 0.7;
/// Rate after the stop, over that of the ramp, that a filter does not reach.
const LEAP: f64 = 1.5;
/// Share of a hold that a delay takes at most.
const MOST: f64 = 0.25;

/// A force that follows the jaw through a filter of first order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ForceDelay {
    /// Time at which the jaw stops, s.
    pub(crate) stop_s: f64,
    /// Time constant of the filter, s.
    pub(crate) time_constant_s: f64,
    /// Time from the stop of the jaw to the extreme of the force, s.
    pub(crate) rise_s: f64,
    /// First sample at which nothing of the transient is left in the force, or the last that a hold can spare.
    pub(crate) settled: usize,
}

/// The delay of the force in a hold of constant displacement; `None` where its force does not rise after the jaw has stopped.
///
/// A body relaxes from the moment at which the jaw stops. Behind a filter of first order with time constant τ the rate at the end of the ramp, s, goes
/// on, and with the body relaxing at rate r the force is F(t) + rτ − τ(s + r) exp(−t/τ): its extreme is at τ ln(1 + s/r).
pub(crate) fn force_delay(record: &Record, segments: &[Segment], index: usize) -> Option<ForceDelay> {
    let hold = &segments[index];
    let (time, force, jaw) = (record.time(), record.force(), record.displacement()?);
    let ramp = ramps_before(segments, index).next().filter(|_| hold.mode == Some(HoldMode::DisplacementHeld))?;
    let sign = if hold.after == Some(After::Unloading) { -1.0 } else { 1.0 };
    let stop = stop(jaw, ramp, hold);
    let held = &force[stop..hold.end];
    let (scatter, step) = (noise(held), quantum(held));
    let turn = (RISES * scatter).max(1.5 * step);
    let signed: Vec<f64> = held.iter().map(|value| sign * value).collect();
    let turns = extremes(&signed, turn);
    let &at = turns.get(1).filter(|at| **at >= INTERVALS && stop + 3 * **at + 2 < hold.end)?;
    // A force that turns once more swings: a machine, and no filter of first order.
    if turns.get(2).is_some_and(|next| *next < SWINGS * at) {
        return None;
    }
    let last = last(time, ramp);
    let travels = slope(&jaw[last.clone()], &force[last.clone()]);
    // A jaw that overshoots or drifts on presses by itself.
    let farthest = jaw[stop..=stop + at].iter().map(|place| sign * (place - jaw[stop])).fold(0.0, f64::max);
    // A line through one place of the jaw has no slope.
    let still = if travels.is_finite() { travels * farthest } else { 0.0 };
    let way = (force[ramp.end - 1] - force[ramp.start]).abs();
    if signed[at] - signed[0] < still.max(0.0) + turn.max(MATTERS * way) {
        return None;
    }
    let rises = sign * slope(&time[last.clone()], &force[last]);
    let rise_s = time[stop + at] - time[stop];
    // Behind a filter the force goes on no faster than in the ramp; rows that stray leap.
    let leaps = |i: &usize| signed[i + 1] - signed[*i] > LEAP * rises * (time[stop + i + 1] - time[stop + i]) + turn;
    if (0..at).any(|i| leaps(&i)) {
        return None;
    }
    let behind = stop + 2 * at..stop + 3 * at + 1;
    let relaxes = -sign * slope(&time[behind.clone()], &force[behind]);
    if !(rises > 0.0 && relaxes > 0.0) {
        return None;
    }
    // Behind a clock that is late the force goes on at the rate of the ramp and turns at once.
    if signed[at] - signed[0] > AT_ONCE * rises * rise_s {
        return None;
    }
    // The stop and the extreme lie between samples.
    let time_constant_s = (rise_s + record.sample_interval()) / (1.0 + rises / relaxes).ln();
    let change = range(&held[at..]);
    let left = (NOISE_LEFT * scatter.max(step)).max(CHANGE_LEFT * change);
    let fades_s = time_constant_s * (time_constant_s * (rises + relaxes) / left).ln();
    let spare_s = MOST * (time[hold.end - 1] - time[stop]);
    let from_s = time[stop] + fades_s.max(rise_s).min(spare_s.max(rise_s));
    let settled = time.partition_point(|t| *t < from_s).clamp(hold.start, hold.end - 1);
    Some(ForceDelay {
        stop_s: time[stop],
        time_constant_s,
        rise_s,
        settled,
    })
}

/// The sample at which the jaw has stopped: the first within its noise of the level that it holds.
fn stop(jaw: &[f64], ramp: &Segment, hold: &Segment) -> usize {
    let held = &jaw[hold.start..hold.end];
    let level = median(&mut held.to_vec());
    let way = (level - jaw[ramp.start]).abs();
    let near = (3.0 * noise(held)).max(1e-3 * way);
    (ramp.start..hold.start).find(|i| (jaw[*i] - level).abs() <= near).unwrap_or(hold.start)
}

/// The samples of a ramp whose rates are those at its end.
fn last(time: &[f64], ramp: &Segment) -> Range<usize> {
    let from = time[ramp.end - 1] - LAST * (time[ramp.end - 1] - time[ramp.start]);
    let first = time.partition_point(|t| *t < from).min(ramp.end.saturating_sub(3)).max(ramp.start);
    first..ramp.end
}
