//! The law to use, its certainty, and the cost of others.

use std::cmp::Ordering;

use super::confidence_set::{MARGIN, is_worse, losses};
use super::probability::{NEAR, Signs, probability};
use super::result::{Certainty, Comparison, Ranking, Reservation, Row, Verdict};
use crate::laws::Law;

/// A difference of BIC beyond which the law with the lower one is twenty times as probable, so that they are distinguishable.
pub(super) const EVIDENCE: f64 = 6.0;

/// A difference of BIC beyond which a law is refuted ("very strong" evidence in the scale of Kass and Raftery).
pub(crate) const REFUTED: f64 = 10.0;

/// A law whose forecasts miss by more than this share of the change predicts nothing.
const UNPREDICTIVE: f64 = 1.0 / 3.0;

/// Share of a relaxation that may lie beyond the end of a hold whose forecasts tell laws apart.
const UNFINISHED: f64 = 0.5;

/// Probabilities from which on a choice is likely, and clear.
const PROBABLE: (f64, f64) = (0.75, 0.9);

impl Comparison {
    /// The figure that laws are ranked by: forward error as a share of the change of the signal, or excess of BIC.
    #[must_use]
    pub fn figure(&self, row: &Row) -> Option<f64> {
        match self.ranking {
            Ranking::Forward => row.forward.score,
            Ranking::Information => row.delta_bic,
        }
    }

    /// Those of `rows` that are not distinguishable from the best of them that may be chosen.
    fn indistinguishable<'a>(&self, rows: &[&'a Row], may_be_chosen: impl Fn(&Row) -> bool) -> Vec<&'a Row> {
        let figure = |row: &&&Row| self.figure(row).unwrap_or(f64::INFINITY);
        let candidates = rows.iter().filter(|row| may_be_chosen(row));
        let Some(best) = candidates.min_by(|a, b| figure(a).total_cmp(&figure(b))) else {
            return Vec::new();
        };
        let alike = |row: &&&Row| match self.ranking {
            Ranking::Information => figure(row) - figure(&best) <= EVIDENCE,
            Ranking::Forward => {
                let of = |row: &Row| losses(&row.forward, self.change);
                !is_worse(&of(row), &of(best), MARGIN, rows.len() - 1)
            }
        };
        rows.iter().filter(alike).copied().collect()
    }

    /// Cut points at which the error of a law is within a fifth of the smallest.
    fn count_near_best(&self, row: &Row) -> usize {
        let is_near = |cut: &usize| {
            let at = |row: &Row| row.forward.relative(*cut, self.change);
            let best = self.rows.iter().filter(|row| row.is_good()).filter_map(at).fold(f64::INFINITY, f64::min);
            at(row).is_some_and(|error| error <= NEAR * best)
        };
        (0..self.cuts.len()).filter(is_near).count()
    }
}

/// Of laws that are not distinguishable the one with the lower difference of BIC goes first; the spectrum, which has no parameters to carry to
/// another test, last.
pub(super) fn preferred(a: (Law, f64), b: (Law, f64)) -> Ordering {
    let spectrum = |law: Law| law == Law::Spectrum;
    spectrum(a.0).cmp(&spectrum(b.0)).then(a.1.total_cmp(&b.1))
}

/// Share of the relaxation that is still to come at the end of a hold, by the law of a row; `None` of a law that never levels off.
fn remaining(row: &Row, duration: f64) -> Option<f64> {
    /// Durations after which all has relaxed.
    const AT_LAST: f64 = 1e30;
    let curve = row.fit.as_ref().ok()?.predict_many(&[0.0, duration, AT_LAST * duration]);
    let [first, end, last] = curve[..] else { return None };
    let share = (end - last) / (first - last);
    share.is_finite().then_some(share)
}

/// Judges ranked rows.
pub(super) fn judge(comparison: &Comparison) -> Option<Verdict> {
    let with_figure = || comparison.rows.iter().filter(|row| comparison.figure(row).is_some());
    let any_good = with_figure().any(Row::is_good);
    // The spectrum has no parameters to report; it may refute a law, and gives way to one that it does not refute.
    let is_law = |row: &Row| row.is_good() && row.law != Law::Spectrum;
    let stands = |row: &Row| is_law(row) && row.delta_bic.is_some_and(|bic| bic <= REFUTED);
    let any_stands = with_figure().any(stands);
    let may_be_chosen = |row: &Row| !any_stands || stands(row);
    let usable: Vec<&Row> = with_figure()
        .filter(|row| row.is_good() || !any_good)
        .filter(|row| may_be_chosen(row) || row.law == Law::Spectrum)
        .collect();
    let alike = comparison.indistinguishable(&usable, may_be_chosen);
    let evidence = |row: &Row| row.delta_bic.unwrap_or(f64::INFINITY);
    let chosen = *alike.iter().min_by(|a, b| preferred((a.law, evidence(a)), (b.law, evidence(b))))?;
    let figure = comparison.figure(chosen)?;
    let others = with_figure().filter(|row| row.law != chosen.law);
    let costs = others.filter_map(|row| {
        let other = comparison.figure(row)?;
        Some(match comparison.ranking {
            Ranking::Forward => (row.law, other / figure),
            Ranking::Information => (row.law, other - figure),
        })
    });
    let reservation = match figure {
        // The spectrum is what is left where every law ended at a bound: it is refuted as they are.
        _ if !any_stands && (with_figure().any(is_law) || evidence(chosen) > REFUTED) => Some(Reservation::Refuted),
        error if comparison.ranking == Ranking::Forward && error > UNPREDICTIVE => Some(Reservation::Unpredictive),
        _ => None,
    };
    let signs = chosen.forward.forecasts.iter().flatten().next_back().map(|last| {
        let next = usable.iter().filter(|row| row.law != chosen.law && row.law != Law::Spectrum);
        let least = usable.iter().filter_map(|row| row.forward.score).fold(f64::INFINITY, f64::min);
        Signs {
            last_error: last.rmse,
            evidence: next.map(|row| evidence(row)).fold(f64::INFINITY, f64::min) - evidence(chosen),
            behind: figure / least,
            is_alone: alike.len() == 1,
            noise: comparison.noise,
            change: comparison.change,
        }
    });
    let near_best = comparison.count_near_best(chosen);
    // Another law was better every time that was tried, or cut points lie so early that laws have not parted yet: no more is known than where
    // nothing was tried.
    let says_little = near_best == 0 || remaining(chosen, comparison.duration).is_some_and(|share| share > UNFINISHED);
    let untried = probability(None);
    let probability = match signs.as_ref().filter(|_| comparison.ranking == Ranking::Forward) {
        Some(signs) if says_little => probability(Some(signs)).at_most(untried),
        Some(signs) => probability(Some(signs)),
        None => untried,
    };
    let certainty = match probability.value {
        _ if reservation.is_some() => Certainty::Open,
        value if value >= PROBABLE.1 => Certainty::Clear,
        value if value >= PROBABLE.0 => Certainty::Likely,
        _ => Certainty::Open,
    };
    Some(Verdict {
        law: chosen.law,
        indistinguishable: alike.iter().map(|row| row.law).collect(),
        probability: probability.value,
        probability_range: (probability.low, probability.high),
        certainty,
        reservation,
        cuts_near_best: near_best,
        costs: costs.collect(),
    })
}
