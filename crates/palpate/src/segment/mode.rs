//! What the machine holds: the displacement, the force, or neither.

use serde::{Deserialize, Serialize};

use super::levels::range;
use crate::record::Record;
use crate::statistics::{mean, noise};

/// What stays in a hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HoldMode {
    /// The displacement: the force may relax.
    DisplacementHeld,
    /// The force: the displacement creeps.
    ForceHeld,
    /// Both move, if slowly.
    Neither,
}

/// Parts into which a hold is cut to see where it goes.
const PARTS: usize = 10;
/// How many standard errors a change must have to be seen.
const SEEN: f64 = 6.0;
/// Way of the jaw over that in the record, from which on it counts.
const LEAST_SHARE: f64 = 2e-3;
/// How many times farther than the force the jaw goes, both as shares of what they do in the record.
const FARTHER: f64 = 2.0;

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
    if until < from + 3 * PARTS {
        return None;
    }
    let (jaw, force) = (&displacement[from..until], &record.force()[from..until]);
    let (travel, change) = (moved(jaw), moved(force));
    let travelled = travel.abs() / range(displacement);
    let seen = travel.abs() > SEEN * error_of_mean(jaw) && travelled > LEAST_SHARE;
    let changed = change.abs() / range(record.force());
    let uncertain = SEEN * error_of_mean(force) / range(record.force());
    let mode = if seen && travelled > FARTHER * changed.max(uncertain) {
        HoldMode::ForceHeld
    } else if seen && travelled > DRIFTS && changed > uncertain {
        HoldMode::Neither
    } else {
        HoldMode::DisplacementHeld
    };
    Some(Change {
        travel,
        force: change,
        mode,
    })
}

/// Share of its range that a jaw may drift over a hold and still hold the displacement.
const DRIFTS: f64 = 0.01;

/// What is held in samples `from..until`; too short a hold, or one without displacement, counts as one of the displacement.
pub(crate) fn mode(record: &Record, from: usize, until: usize) -> HoldMode {
    change(record, from, until).map_or(HoldMode::DisplacementHeld, |change| change.mode)
}

/// From the first tenth to the last.
fn moved(values: &[f64]) -> f64 {
    let tenth = values.len() / PARTS;
    mean(&values[values.len() - tenth..]) - mean(&values[..tenth])
}

/// Standard error of the mean of a tenth.
fn error_of_mean(values: &[f64]) -> f64 {
    noise(values) / (values.len() as f64 / PARTS as f64).sqrt()
}
