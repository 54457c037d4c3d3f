//! A record that is one hold from its first sample to its last.

use super::turning::extremes;
use crate::record::{Correction, Record, SourceQuantity};
use crate::segment::{HoldMode, RelaxationType, SegmentError, Segmentation, classify_relaxation};
use crate::statistics::{mean, median, noise, range};

/// Share of itself by which a force may vary that is held throughout.
const STEADY: f64 = 0.05;
/// Share of a change that comes in the first half of a hold, where the other column says that it is one.
const FIRST_HALF: f64 = 0.6;
/// The same where no other column says so: a ball that is let go gives 0.65.
const FIRST_HALF_ALONE: f64 = 0.7;
/// Share of the largest force that is left at the end of a relaxation, at least.
const LEFT: f64 = 0.1;

/// What is held in a record whose quantities say that it is one hold: a relaxation modulus is a force at a strain that stays, a creep
/// compliance a displacement at a stress that stays, and so is a strain that goes one way under a
/// stress of one value, or of none given.
pub(super) fn stated(record: &Record) -> Option<HoldMode> {
    let gives = |wanted: SourceQuantity| {
        let is_wanted = |done: &Correction| matches!(done, Correction::ReadAs { quantity, .. } if *quantity == wanted);
        record.corrections().iter().any(is_wanted)
    };
    match record.displacement() {
        None if gives(SourceQuantity::Modulus) => Some(HoldMode::DisplacementHeld),
        Some(_) if gives(SourceQuantity::Compliance) => Some(HoldMode::ForceHeld),
        Some(displacement)
            if (gives(SourceQuantity::CreepStrain) || gives(SourceQuantity::Strain) && is_constant(record.force()))
                && goes_one_way(displacement) =>
        {
            Some(HoldMode::ForceHeld)
        }
        _ => None,
    }
}

/// Whether a force has one value throughout.
fn is_constant(force: &[f64]) -> bool {
    force[0] != 0.0 && range(force) == 0.0
}

/// Fewest samples that show whether a motion is straight.
const FEWEST_MOVING: usize = 8;

/// Whether a body creeps in the whole of a record under a force of exactly one value. A machine that moves in air goes straight up to where
/// it stands.
pub(super) fn creeps_throughout(record: &Record, found: Option<&Segmentation>) -> bool {
    let (time, displacement) = (record.time(), record.displacement().unwrap_or_default());
    let hold = found.and_then(|found| found.holds().next());
    let moving = hold.map_or(time.len(), |hold| hold.start).min(displacement.len());
    is_constant(record.force())
        && moving >= FEWEST_MOVING
        && goes_one_way(displacement)
        && bends(&time[..moving], &displacement[..moving])
}

/// Share of its way by which a creep is ahead of a straight line on the mean, at least: one that flows goes on all but straight.
const AHEAD: f64 = 0.02;

/// Whether values are ahead of the straight line from their first to their last.
fn bends(time: &[f64], values: &[f64]) -> bool {
    let last = values.len() - 1;
    let whole = values[last] - values[0];
    let ahead = |(t, value): (&f64, &f64)| (value - values[0]) / whole - (t - time[0]) / (time[last] - time[0]);
    let all: Vec<f64> = time.iter().zip(values).map(ahead).collect();
    mean(&all) > AHEAD + 3.0 * noise(values) / whole.abs()
}

/// Whether values go from their first to their last by more than their noise, and do not turn back.
fn goes_one_way(values: &[f64]) -> bool {
    let (last, noise) = (values.len() - 1, noise(values));
    let turn = (10.0 * noise).max(TURNS * range(values));
    (values[last] - values[0]).abs() > SHOWS * noise
        && !extremes(values, turn).iter().any(|at| (values.len() / 20 + 1..last).contains(at))
}

/// What is held in a record that is one hold, where a search that ended in `error` missed it since nothing comes before: the jaw stands while the force
/// relaxes, the force stays while the jaw creeps, or a force without a displacement falls ever more slowly.
pub(super) fn whole(record: &Record, error: &SegmentError) -> Option<HoldMode> {
    let (time, force) = (record.time(), record.force());
    match (record.displacement(), error) {
        (Some(_), SegmentError::NoMotion { .. }) if slows(time, force, FIRST_HALF) => Some(HoldMode::DisplacementHeld),
        (Some(displacement), _) if is_steady(force) && slows(time, displacement, FIRST_HALF) => {
            Some(HoldMode::ForceHeld)
        }
        (Some(_), SegmentError::NoHold { .. }) if shows_few_steps(record) && falls_to_a_rest(time, force) => {
            Some(HoldMode::DisplacementHeld)
        }
        (None, SegmentError::NoHoldInForce) if falls_to_a_rest(time, force) => Some(HoldMode::DisplacementHeld),
        _ => None,
    }
}

/// How many times faster a force may change while the jaw seems to move than just before and after, if it does not answer.
const ANSWERS: f64 = 2.0;
/// Share of a relaxation by which its force may turn back.
const TURNS: f64 = 0.05;
/// Share of the force's range that a record which begins with its hold still holds at the end of it, at least.
const BEGINS: f64 = 0.1;

/// Whether the force of a record is one relaxation from its first sample to its last, and does not answer to what the jaw seems to do:
/// that is noise of its encoder.
pub(super) fn relaxes_throughout(record: &Record, found: &Segmentation) -> bool {
    let force = record.force();
    let last = force.len() - 1;
    let change = |from: usize, until: usize| (force[until.min(last)] - force[from]).abs();
    let (mut while_moving, mut beside) = (0.0, 0.0);
    for ramp in found.segments.iter().filter(|segment| segment.is_ramp() && segment.start > 0) {
        let length = ramp.end - ramp.start;
        while_moving += change(ramp.start, ramp.end) / length as f64;
        let near =
            change(ramp.start.saturating_sub(length), ramp.start).max(change(ramp.end.min(last), ramp.end + length));
        beside += near.max(noise(force)) / length as f64;
    }
    let turn = (10.0 * noise(force)).max(TURNS * range(force));
    let trembles = shows_few_steps(record);
    // What goes on from its first sample to its last is driven, not noise.
    record.displacement().is_some_and(|displacement| trembles || !goes_one_way(displacement))
        && found.holds().next().is_some()
        && (trembles || while_moving <= ANSWERS * beside)
        && !extremes(force, turn).iter().any(|at| (force.len() / 20 + 1..last).contains(at))
        && falls_to_a_rest(record.time(), force)
}

/// Most values that the encoder of a crosshead shows that stands, and trembles between two of its steps.
const FEW_STEPS: usize = 6;

/// Whether the displacement takes no more than a few values.
fn shows_few_steps(record: &Record) -> bool {
    let mut values: Vec<f64> = record.displacement().unwrap_or_default().to_vec();
    values.sort_unstable_by(f64::total_cmp);
    values.dedup();
    values.len() <= FEW_STEPS
}

/// Whether the force of a record that stands still up to sample `end` relaxes there as in a hold whose ramp was not recorded.
pub(super) fn begins_in_hold(record: &Record, end: usize, force_range: f64) -> bool {
    let (time, force) = (&record.time()[..end], &record.force()[..end]);
    end >= FEWEST && force[end - 1] > BEGINS * force_range && falls_to_a_rest(time, force)
}

/// Fewest samples of a hold that begins a record.
const FEWEST: usize = 20;

/// Whether a force is pressed throughout, and stays.
fn is_steady(force: &[f64]) -> bool {
    let level = median(&mut force.to_vec()).abs();
    level > 0.0 && range(force) <= STEADY * level
}

/// Change over a hold, in standard deviations of the noise, from which on it shows that it slows down.
const SHOWS: f64 = 6.0;

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
    // From the first value on: of a reading every 10 min the mean of three hides a third of all that is recorded.
    let turns = range(values) > 1.2 * (last - values[0]).abs().max(whole.abs()) + 10.0 * noise(values);
    let shows = whole.abs() > SHOWS * noise(values);
    found.kind != RelaxationType::None && shows && !turns && half / whole > first_half
}

/// Whether a force falls from its first samples on, ever more slowly, and not to nothing.
fn falls_to_a_rest(time: &[f64], force: &[f64]) -> bool {
    let largest = force.iter().fold(0.0, |most: f64, force| most.max(*force));
    let peak = force.iter().position(|force| *force >= largest).unwrap_or(0);
    let last = mean(&force[force.len() - force.len() / 20 - 1..]);
    let falls = classify_relaxation(force).kind == RelaxationType::TypeI;
    falls && peak <= force.len() / 20 && last > LEFT * largest && slows(time, force, FIRST_HALF_ALONE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segment::{Phase, SegmentOptions, find_phases};

    /// The one hold of a record, if it is one throughout.
    fn held(record: &Record) -> Option<HoldMode> {
        let found = find_phases(record, &SegmentOptions::default()).unwrap();
        match &found.segments[..] {
            [only] if only.phase == Phase::Hold => only.mode,
            _ => None,
        }
    }

    fn read_as(quantity: SourceQuantity) -> [Correction; 1] {
        [Correction::ReadAs { quantity, factor: 1.0 }]
    }

    /// A melt that flows at a constant stress was "no hold: the jaw drifts", its recovery a relaxation.
    #[test]
    fn creep_at_exactly_constant_force_is_a_hold_of_the_force() {
        let time: Vec<f64> = (0..200).map(|i| 0.01 * 1.05f64.powi(i)).collect();
        let flow: Vec<f64> = time.iter().map(|t| 0.02 * t + 1.0 - (-t).exp()).collect();
        let record = |displacement: Vec<f64>| Record::new(time.clone(), Some(displacement), vec![10.0; 200]).unwrap();
        assert_eq!(held(&record(flow.clone())), Some(HoldMode::ForceHeld));
        // One that comes to its end was a ramp and a hold.
        let ends = time.iter().map(|t| 1.0 - (-t).exp()).collect();
        assert_eq!(held(&record(ends)), Some(HoldMode::ForceHeld));
        // There and back is no creep, and a machine goes straight.
        for moves in [|t: f64| if t < 50.0 { t } else { 100.0 - t }, |t: f64| t.min(50.0), |t: f64| t] {
            let record = record(time.iter().copied().map(moves).collect());
            let found = find_phases(&record, &SegmentOptions::default());
            assert!(found.is_err() || held(&record).is_none(), "{found:?}");
        }
    }

    /// G(t) at many samples was "the jaw drifts or reverses without a stop", J(t) a standstill too short.
    #[test]
    fn a_modulus_and_a_compliance_are_holds_by_what_they_are() {
        let time: Vec<f64> = (0..1800).map(|i| 0.2 + f64::from(i)).collect();
        let modulus: Vec<f64> = time.iter().map(|t| 1.43e5 * (1.0 + t).powf(-0.6)).collect();
        let compliance: Vec<f64> = time.iter().map(|t| 1.0 / (1.43e5 * (1.0 + t).powf(-0.6))).collect();
        let relaxes = Record::new(time.clone(), None, modulus).unwrap();
        assert_eq!(held(&relaxes.corrected_before(read_as(SourceQuantity::Modulus))), Some(HoldMode::DisplacementHeld));
        // A melt flows all but straight: only that it is a strain states that no machine moved.
        let flow = time.iter().map(|t| 2e-4 * t).collect();
        let flows = Record::new(time.clone(), Some(flow), vec![10.0; 1800]).unwrap();
        assert_eq!(held(&flows.corrected_before(read_as(SourceQuantity::Strain))), Some(HoldMode::ForceHeld));
        let creeps = Record::new(time, Some(compliance), vec![1.0; 1800]).unwrap();
        assert_eq!(held(&creeps.corrected_before(read_as(SourceQuantity::Compliance))), Some(HoldMode::ForceHeld));
    }
}
