//! A record that is one hold from its first sample to its last.

use crate::record::Record;
use crate::segment::{HoldMode, RelaxationType, SegmentError, classify_relaxation};
use crate::statistics::{mean, median, noise, range};

/// Share of itself by which a force may vary that is held throughout.
const STEADY: f64 = 0.05;
/// Share of a change that comes in the first half of a hold, where the other column says that it is one.
const FIRST_HALF: f64 = 0.6;
/// The same where no other column says so: a ball that is let go gives 0.65.
const FIRST_HALF_ALONE: f64 = 0.7;
/// Share of the largest force that is left at the end of a relaxation, at least.
const LEFT: f64 = 0.1;

/// What is held in a record that is one hold, where a search that ended in `error` missed it since nothing comes before: the jaw stands while the force
/// relaxes, the force stays while the jaw creeps, or a force without a displacement falls ever more slowly.
pub(super) fn whole(record: &Record, error: &SegmentError) -> Option<HoldMode> {
    let (time, force) = (record.time(), record.force());
    match (record.displacement(), error) {
        (Some(_), SegmentError::NoMotion { .. }) if slows(time, force, FIRST_HALF) => Some(HoldMode::DisplacementHeld),
        (Some(displacement), _) if is_steady(force) && slows(time, displacement, FIRST_HALF) => {
            Some(HoldMode::ForceHeld)
        }
        (None, SegmentError::NoHold { .. }) if falls_to_a_rest(time, force) => Some(HoldMode::DisplacementHeld),
        _ => None,
    }
}

/// Whether a force is pressed throughout, and stays.
fn is_steady(force: &[f64]) -> bool {
    let level = median(&mut force.to_vec()).abs();
    level > 0.0 && range(force) <= STEADY * level
}

/// Whether values go one way, ever more slowly, by more than their noise.
fn slows(time: &[f64], values: &[f64], first_half: f64) -> bool {
    let found = classify_relaxation(values);
    let part = (values.len() / 20).max(3);
    // Many log their creep at even steps of ln t.
    let middle = time.partition_point(|t| *t < 0.5 * (time[0] + time[time.len() - 1]));
    let middle = &values[middle.min(values.len() - part)..][..part];
    // A relaxation is fastest at first: more than a few samples would hide much of it.
    let (first, last) = (mean(&values[..3]), mean(&values[values.len() - part..]));
    let (whole, half) = (last - first, mean(middle) - first);
    let turns = range(values) > 1.2 * whole.abs() + 10.0 * noise(values);
    found.kind != RelaxationType::None && !turns && half / whole > first_half
}

/// Whether a force falls from its first samples on, ever more slowly, and not to nothing.
fn falls_to_a_rest(time: &[f64], force: &[f64]) -> bool {
    let largest = force.iter().fold(0.0, |most: f64, force| most.max(*force));
    let peak = force.iter().position(|force| *force >= largest).unwrap_or(0);
    let last = mean(&force[force.len() - force.len() / 20 - 1..]);
    let falls = classify_relaxation(force).kind == RelaxationType::TypeI;
    falls && peak <= force.len() / 20 && last > LEFT * largest && slows(time, force, FIRST_HALF_ALONE)
}
