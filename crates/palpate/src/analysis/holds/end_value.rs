//! What a fit makes of the value that a hold tends to: the equilibrium of a relaxation, the final displacement of a creep.

use crate::analysis::finding::Finding;
use crate::fit::{Estimate, Fit, ParameterKind};
use crate::laws::Response;
use crate::record::Record;
use crate::statistics::{median, noise, range};

/// Share of a relaxation beyond the end of a hold from which on its equilibrium is extrapolated.
const MUCH: f64 = 0.2;
/// The same of a series of exponentials: less is e^−4 of a last term that has all of the relaxation, which the hold shows as good as whole.
const BY_LAST_TERM: f64 = 0.02;

/// The value that the signal tends to by this fit, and of which response it is; `None` of a law without one.
pub(super) fn end_value(fit: &Fit) -> Option<(&Estimate, Response)> {
    let of = |kind, response| Some((&fit.parameter(kind)?.estimate, response));
    of(ParameterKind::Equilibrium, Response::Relaxation).or_else(|| of(ParameterKind::Final, Response::Creep))
}

/// Where much of the way to the end value lies beyond the `last` time (s) of a hold.
pub(super) fn extrapolated(fit: &Fit, last: f64) -> Option<Finding> {
    let (estimate, response) = end_value(fit)?;
    let [start, end] = [0.0, last].map(|time| fit.predict(time));
    let beyond = (end - estimate.value) / (start - estimate.value);
    // A series knows nothing slower than its last term: what its interval leaves out of the way to its equilibrium, it knows by that alone.
    let unseen = |(low, high): (f64, f64)| (end - estimate.value).abs() > 0.5 * (high - low);
    let by_last_term = fit.law.is_series() && beyond > BY_LAST_TERM && estimate.interval.is_some_and(unseen);
    (beyond > MUCH || by_last_term).then_some(Finding::EquilibriumExtrapolated {
        law: fit.law,
        beyond,
        response,
    })
}

/// Where the equilibrium of a force that presses to the `last` time (s) is one that pulls.
pub(super) fn beyond_zero(fit: &Fit, last: f64) -> Option<Finding> {
    let (estimate, response) = end_value(fit)?;
    let (low, high) = estimate.interval?;
    let end = fit.predict(last);
    // A force below zero that goes on to one above it belongs to a body that is held on to.
    let pulls = response == Response::Relaxation && high < 0.0 && end > 0.0 && (low / end).is_finite();
    pulls.then_some(Finding::EquilibriumBeyondZero {
        law: fit.law,
        share: estimate.value / end,
        interval: (low / end, high / end),
    })
}

/// Where a recovery, not beyond the `original` displacement (m) at its `last` time (s), tends to a height beyond it.
pub(super) fn beyond_original(fit: &Fit, last: f64, original: f64) -> Option<Finding> {
    let (estimate, response) = end_value(fit)?;
    let (low, high) = estimate.interval?;
    let side = (fit.predict(last) - original).signum();
    // Positive beyond the original height.
    let [value, a, b] = [estimate.value, low, high].map(|place| side * (original - place));
    let interval = (a.min(b), a.max(b));
    (response == Response::Creep && interval.0 > 0.0).then_some(Finding::RecoveryBeyondOriginal {
        law: fit.law,
        distance: value,
        interval,
    })
}

/// The displacement (m) of a body before it is loaded; `None` of a record that begins under load.
pub(super) fn original_displacement(record: &Record) -> Option<f64> {
    /// Share of the range of the force, and its noise, within which it counts as none.
    const SHARE: f64 = 1e-3;
    const NOISES: f64 = 5.0;
    let force = record.force();
    let none = (NOISES * noise(force)).max(SHARE * range(force));
    let before = force.iter().take_while(|force| force.abs() <= none).count();
    let places = record.displacement().filter(|_| before > 0)?;
    Some(median(&mut places[..before].to_vec()))
}
