//! The lowest order that fits best, with the evidence.

use serde::{Deserialize, Serialize};

use super::latency::LatencyFit;
use crate::laws::ExponentChoice;

/// One exponent that was tried.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// n.
    pub exponent: f64,
    /// Whether n was found rather than given.
    pub free: bool,
    /// Root mean square residual, in the unit of the signal.
    pub rmse: f64,
    /// Bayesian information criterion less the lowest of all candidates, at the effective number of samples.
    pub delta_bic: f64,
    /// Whether the residual is as small as the best one, as far as these data can tell.
    pub as_good_as_best: bool,
}

/// What [`select_order`] found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OrderSelection {
    /// All candidates in the order given.
    pub candidates: Vec<Candidate>,
    /// Index of the lowest listed exponent that is as good as the best one.
    pub lowest_order: Option<usize>,
    /// Index of the candidate with the lowest information criterion among those whose fit ended well.
    pub preferred: Option<usize>,
    /// Samples that count as independent in these comparisons.
    pub effective_samples: f64,
}

/// A difference of the criterion that counts as evidence ("positive" in the scale of Kass and Raftery).
const EVIDENCE: f64 = 2.0;

/// Compares fits of one hold with different exponents: the paper's "lowest order which fits the best", made precise.
///
/// BIC = N_e ln(RSS/N) + p ln N_e, with N_e the number of independent samples that the best fit's residuals allow. A listed
/// exponent is as good as the best listed one if its criterion is within 2 of it; the lowest such is `lowest_order`. The
/// preferred candidate has the lowest criterion of all, a free exponent included, which pays for its extra number.
#[must_use]
pub fn select_order(fits: &[LatencyFit]) -> OrderSelection {
    let best = fits.iter().min_by(|a, b| a.residual_square.total_cmp(&b.residual_square));
    let effective = best.map_or(0.0, |fit| fit.effective_samples());
    // Noise-free records leave rounding only; below this share of the signal all residuals are equal.
    let floor = |fit: &LatencyFit| {
        let scale = fit.amplitude().value.abs() + fit.equilibrium().value.abs();
        (1e-9 * scale).powi(2) * fit.samples as f64
    };
    let criterion = |fit: &LatencyFit| {
        let square = fit.residual_square.max(floor(fit));
        effective * (square / fit.samples as f64).ln() + fit.free_numbers() as f64 * effective.ln()
    };
    let listed = |fit: &LatencyFit| matches!(fit.choice(), ExponentChoice::Fixed(_));
    let lowest = fits.iter().map(criterion).fold(f64::INFINITY, f64::min);
    let lowest_listed = fits.iter().filter(|fit| listed(fit)).map(criterion).fold(f64::INFINITY, f64::min);
    let candidates: Vec<Candidate> = fits
        .iter()
        .map(|fit| Candidate {
            exponent: fit.exponent().value,
            free: !listed(fit),
            rmse: fit.rmse,
            delta_bic: criterion(fit) - lowest,
            as_good_as_best: criterion(fit) - lowest_listed <= EVIDENCE,
        })
        .collect();
    let order = |a: &usize, b: &usize| candidates[*a].exponent.total_cmp(&candidates[*b].exponent);
    let lowest_order = (0..fits.len()).filter(|&i| listed(&fits[i]) && candidates[i].as_good_as_best).min_by(order);
    // A fit that ended at the edge of its range has no errors to go with its numbers.
    let any_good = fits.iter().any(|fit| fit.termination.is_good());
    let preferred = (0..fits.len())
        .filter(|&i| fits[i].termination.is_good() || !any_good)
        .min_by(|a, b| candidates[*a].delta_bic.total_cmp(&candidates[*b].delta_bic));
    OrderSelection {
        lowest_order,
        preferred,
        effective_samples: effective,
        candidates,
    }
}
