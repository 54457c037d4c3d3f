//! What the machine holds: the displacement, the force, or neither.

use super::segmentation::HoldMode;
use crate::record::Record;
use crate::statistics::{mean, noise, range};

/// Parts into which a hold is cut to see where it goes.
pub(crate) const PARTS: usize = 10;
/// How many standard errors a change must have to be observed.
pub(crate) const OBSERVED: f64 = 6.0;
/// Way of the jaw over that to the hold, from which on it counts.
const LEAST_SHARE: f64 = 2e-3;
/// How many times farther than the force the jaw goes, both as shares of what they do as they come to the hold.
const FARTHER: f64 = 2.0;

/// How far a jaw goes at least over how far it brings the force, both as shares of what they do as they come to the hold.
const BROUGHT: f64 = 0.2;

/// How far displacement and force go over a hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Change {
    /// Of the jaw, m.
    pub(crate) travel: f64,
    /// Of the force, N.
    pub(crate) force: f64,
    mode: HoldMode,
}

/// What is held in samples `from..until`, and how far both columns go; `None` without displacement, or for too few samples
/// to tell.
pub(crate) fn change(record: &Record, from: usize, until: usize) -> Option<Change> {
    let displacement = record.displacement()?;
    if until < from + PARTS {
        return None;
    }
    // What both do in the hold is measured by what they do as they come to it.
    let around = from.saturating_sub(until - from)..until;
    let scales = [displacement, record.force()].map(|column| range(&column[around.clone()]).max(f64::MIN_POSITIVE));
    let (jaw, force) = (&displacement[from..until], &record.force()[from..until]);
    let late = |column: &[f64]| column[column.len() / 2..].to_vec();
    // What brings a force to where it is held is the jaw; a force that changes while the jaw hardly moves relaxes, though it is steady in the end.
    let [travelled, changed] =
        [(jaw, scales[0]), (force, scales[1])].map(|(column, scale)| moved(column).abs() / scale);
    let mode = match judged([jaw, force], scales) {
        // A controller that falls short at first ends on the force it holds.
        HoldMode::DisplacementHeld | HoldMode::Neither
            if travelled > BROUGHT * changed && judged([&late(jaw), &late(force)], scales) == HoldMode::ForceHeld =>
        {
            HoldMode::ForceHeld
        }
        mode => mode,
    };
    Some(Change {
        travel: across(jaw),
        force: across(force),
        mode,
    })
}

/// What is held in samples `from..until` where it is not known yet whether they are a hold: by what both do in all the record.
pub(super) fn mode_at_large(record: &Record, from: usize, until: usize) -> HoldMode {
    match record.displacement() {
        Some(displacement) if until >= from + PARTS => judged(
            [&displacement[from..until], &record.force()[from..until]],
            [range(displacement), range(record.force())],
        ),
        _ => HoldMode::DisplacementHeld,
    }
}

/// How many times steadier than the jaw a force is that a controller holds, both as shares of what they do as they come to the hold.
const STEADIER: f64 = 10.0;

/// What is held, from jaw and force in the hold, and how far both go as they come to it.
fn judged([jaw, force]: [&[f64]; 2], [way, rise]: [f64; 2]) -> HoldMode {
    let (travelled, changed) = (moved(jaw).abs() / way, moved(force).abs() / rise);
    let uncertain = OBSERVED * error_of_mean(force) / rise;
    // A force that stays ten times as steady as the jaw is held, however little the body creeps.
    let least = LEAST_SHARE.min(STEADIER * changed.max(uncertain));
    let observed = moved(jaw).abs() > OBSERVED * error_of_mean(jaw) && travelled > least;
    if observed && travelled > FARTHER * changed.max(uncertain) {
        HoldMode::ForceHeld
    } else if observed && travelled > DRIFTS && changed > uncertain {
        HoldMode::Neither
    } else {
        HoldMode::DisplacementHeld
    }
}

/// Whether the displacement is not what is held in samples `from..until`, or moves, however little, while the force stays.
pub(crate) fn creeps(record: &Record, from: usize, until: usize) -> bool {
    if mode(record, from, until) != HoldMode::DisplacementHeld {
        return true;
    }
    let Some(displacement) = record.displacement().filter(|_| until >= from + PARTS) else {
        return false;
    };
    let (jaw, force) = (&displacement[from..until], &record.force()[from..until]);
    let is_observed = |column: &[f64]| moved(column).abs() > OBSERVED * error_of_mean(column);
    let [travelled, changed] =
        [(jaw, displacement), (force, record.force())].map(|(of, all)| moved(of).abs() / range(all));
    is_observed(jaw) && (!is_observed(force) || travelled > FARTHER * changed)
}

/// Share of its way to the hold that a jaw may drift over it and still hold the displacement.
const DRIFTS: f64 = 0.01;

/// What is held in samples `from..until`; too short a hold, or one without displacement, counts as one of the displacement.
pub(crate) fn mode(record: &Record, from: usize, until: usize) -> HoldMode {
    change(record, from, until).map_or(HoldMode::DisplacementHeld, |change| change.mode)
}

/// From the first sample to the last, of thousands from the first thousandth to the last.
fn across(values: &[f64]) -> f64 {
    let some = (values.len() / 1000).max(1);
    mean(&values[values.len() - some..]) - mean(&values[..some])
}

/// From the first tenth to the last.
fn moved(values: &[f64]) -> f64 {
    let tenth = values.len() / PARTS;
    mean(&values[values.len() - tenth..]) - mean(&values[..tenth])
}

/// Standard error of the mean of a tenth.
pub(crate) fn error_of_mean(values: &[f64]) -> f64 {
    noise(values) / (values.len() as f64 / PARTS as f64).sqrt()
}
