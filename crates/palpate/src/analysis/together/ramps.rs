//! Ramps that last longer than what relaxes in the holds behind them.

use crate::analysis::{Finding, HoldAnalysis};
use crate::fit::Fit;
use crate::laws::BasisFunction;
use crate::record::Record;
use crate::segment::{After, ContactPoint, Phase, Segmentation};

/// Share of the amplitude of a step below which what a ramp leaves of it is stated.
const MOST: f64 = 0.5;

/// A term of a smaller share of the relaxation does not count.
const LEAST_TERM: f64 = 0.05;

/// A finding if the recommended law of a hold is a series of exponentials of which the ramp before has let the fastest relax: of the hold that it
/// matters most in.
///
/// Behind a ramp of even speed that lasts T a term of the time constant τ has (τ/T)(1 − exp(−T/τ)) of the amplitude that a step would give it.
pub(in crate::analysis) fn ramp_relaxes(
    record: &Record,
    segmentation: &Segmentation,
    contact: &ContactPoint,
    holds: &[HoldAnalysis],
) -> Option<Finding> {
    let time = record.time();
    let of_hold = |hold: &HoldAnalysis| {
        let verdict = hold.comparison.as_ref()?.verdict.as_ref()?;
        let rows = &hold.comparison.as_ref()?.rows;
        let fit = rows.iter().find(|row| row.law == verdict.law && row.is_good())?.fit.as_ref().ok()?;
        let ramp = segmentation.segments.iter().rfind(|segment| segment.end <= hold.segment.start)?;
        // Through air nothing relaxes.
        let duration = time[hold.segment.start] - time[ramp.start.max(contact.sample.unwrap_or(0))];
        let is_loading = ramp.phase == Phase::Loading && hold.after == Some(After::Loading);
        let time_constant = shortest(fit).filter(|_| is_loading && duration > 0.0)?;
        let share = time_constant / duration * -(-duration / time_constant).exp_m1();
        (share < MOST).then_some(Finding::RampRelaxes {
            hold: hold.number,
            ramp: duration,
            time_constant,
            share,
        })
    };
    let share = |finding: &Finding| match finding {
        Finding::RampRelaxes { share, .. } => *share,
        _ => 1.0,
    };
    holds.iter().filter_map(of_hold).min_by(|a, b| share(a).total_cmp(&share(b)))
}

/// The shortest time constant of a series of exponentials, s.
fn shortest(fit: &Fit) -> Option<f64> {
    let terms = &fit.curve.terms;
    let all: f64 = terms.iter().map(|term| term.amplitude.abs()).sum();
    let is_exponential = terms.iter().all(|term| matches!(term.shape, BasisFunction::Exponential));
    let counting = terms.iter().filter(|term| term.amplitude.abs() > LEAST_TERM * all);
    let rate = counting.filter_map(|term| term.parameters.first()).copied().reduce(f64::max);
    rate.filter(|_| is_exponential).map(|log_rate| (-log_rate).exp())
}
