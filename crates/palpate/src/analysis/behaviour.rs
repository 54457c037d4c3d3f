//! Holds that are none: the force drifts, or the machine holds the force instead of the displacement.

use super::Finding;
use crate::record::Record;
use crate::segment::{After, Segment};
use crate::statistics::{mean, noise};

/// Parts into which a hold is cut to see where it goes.
const PARTS: usize = 10;

/// How many standard errors a change must have to be seen.
const SEEN: f64 = 6.0;

/// What shows that a hold is not one of constant displacement with a force that relaxes.
pub(super) fn not_a_hold(record: &Record, segment: &Segment) -> Option<Finding> {
    let force = &record.force()[segment.fit_start..segment.end];
    if force.len() < 3 * PARTS {
        return None;
    }
    let displacement = record.displacement().map(|all| &all[segment.fit_start..segment.end]);
    feedback(record, force, displacement).or_else(|| drift(record, segment, force))
}

/// Means of ten equal parts.
fn means(values: &[f64]) -> Vec<f64> {
    let bounds: Vec<usize> = (0..=PARTS).map(|i| i * values.len() / PARTS).collect();
    bounds.windows(2).map(|pair| mean(&values[pair[0]..pair[1]])).collect()
}

/// Standard error of such a mean.
fn error_of_mean(values: &[f64]) -> f64 {
    noise(values) / (values.len() as f64 / PARTS as f64).sqrt()
}

fn range(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
    high - low
}

/// The jaw creeps on while the force stands still: as a share of what each does in the whole record, the jaw moves more.
fn feedback(record: &Record, force: &[f64], displacement: Option<&[f64]>) -> Option<Finding> {
    /// Movement in the hold over that in the record, from which on it counts.
    const LEAST_SHARE: f64 = 2e-3;
    let displacement = displacement?;
    let moved = |values: &[f64]| {
        let parts = means(values);
        parts[PARTS - 1] - parts[0]
    };
    let (travel, change) = (moved(displacement), moved(force));
    let travelled = travel.abs() / range(record.displacement()?);
    let changed = change.abs().max(SEEN * error_of_mean(force)) / range(record.force());
    let seen = travel.abs() > SEEN * error_of_mean(displacement) && travelled > LEAST_SHARE;
    (seen && travelled > 2.0 * changed).then_some(Finding::FeedbackControlled { travel, change })
}

/// The force rises in a hold after loading: at once, or again after it has fallen.
fn drift(record: &Record, segment: &Segment, force: &[f64]) -> Option<Finding> {
    /// Of what it fell, and of the force's range in the record.
    const LEAST_SHARES: [f64; 2] = [0.03, 2e-3];
    if segment.after != Some(After::Loading) {
        return None;
    }
    let parts = means(force);
    let lowest = parts.iter().copied().fold(f64::MAX, f64::min);
    let (rise, fall) = (parts[PARTS - 1] - lowest, parts[0] - lowest);
    let seen = rise > SEEN * std::f64::consts::SQRT_2 * error_of_mean(force);
    let matters = rise > LEAST_SHARES[0] * fall && rise > LEAST_SHARES[1] * range(record.force());
    (seen && matters).then_some(Finding::DriftInsteadOfRelaxation { rise, fall })
}
