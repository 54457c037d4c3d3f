//! Holds that are none: the force drifts, or the machine holds the force instead of the displacement.

use crate::analysis::finding::Finding;
use crate::record::Record;
use crate::segment::{After, HoldMode, Segment, change};
use crate::statistics::{mean, noise};

/// Parts into which a hold is cut to see where it goes.
const PARTS: usize = 10;

/// How many standard errors a change must have to be seen.
const SEEN: f64 = 6.0;

/// What shows that a hold is not one of constant displacement with a force that relaxes.
pub(super) fn not_a_hold(record: &Record, segment: &Segment) -> Option<Finding> {
    let moved = change(record, segment.start, segment.end);
    match (segment.mode, moved) {
        (Some(HoldMode::ForceHeld), moved) => {
            return Some(Finding::FeedbackControlled {
                travel: moved.map_or(0.0, |moved| moved.travel),
                change: moved.map_or(0.0, |moved| moved.force),
            });
        }
        (Some(HoldMode::Neither), Some(moved)) => {
            return Some(Finding::NothingHeld {
                travel: moved.travel,
                change: moved.force,
            });
        }
        _ => {}
    }
    let force = &record.force()[segment.fit_start..segment.end];
    if force.len() < 3 * PARTS { None } else { drift(record, segment, force) }
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
