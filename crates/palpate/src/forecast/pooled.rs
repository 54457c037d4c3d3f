//! The law for all holds of a record together.
//!
//! Holds are independent of each other, as stretches of one hold are not. For every law that was fitted on all of them, and on most to an optimum
//! inside its range, the mean logarithm of its mean square forecast errors on a hold is one number a hold (where nothing is held out on three
//! holds, its difference of BIC), and the paired test of `confidence_set.rs` over these numbers says which laws are worse than the best beyond
//! chance; by BIC the sum of the differences has to exceed 6 too, as on one hold.

use super::confidence_set::{MARGIN, is_worse, losses};
use super::result::{Comparison, Ranking, Row};
use super::verdict::{EVIDENCE, REFUTED, preferred};
use crate::laws::Law;
use crate::statistics::mean;

/// Fewer holds say nothing of the scatter between them.
const FEWEST: usize = 3;

/// Which law to use for all holds of a record.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PooledVerdict {
    /// The law with the lowest sum of differences of BIC among those not distinguishable from the best; the spectrum only if it is the only one.
    pub law: Law,
    /// All laws that the holds together do not distinguish from the best, this one included.
    pub indistinguishable: Vec<Law>,
    /// Holds that were counted.
    pub holds: usize,
}

/// Judges laws by all holds together; `None` for fewer than three holds, or where fewer than two laws were fitted on all of them, and on most to an optimum
/// inside their range.
///
/// ```
/// use palpate::fit::Samples;
/// use palpate::forecast::{CompareOptions, compare_laws, pooled};
/// use palpate::test_problems::Rng;
/// let mut random = Rng::new(3);
/// let laws = ["latency:5", "sls", "prony:2"].map(|name| name.parse().unwrap()).to_vec();
/// let options = CompareOptions { laws, ..CompareOptions::default() };
/// let holds: Vec<_> = (0..4)
///     .map(|_| {
///         let times: Vec<f64> = (0..300).map(|i| 0.1 * f64::from(i)).collect();
///         let values: Vec<f64> = times.iter().map(|t| 1.0 + (1.0 + 4.0 * t).powf(-0.25) + 5e-3 * random.normal()).collect();
///         compare_laws(&Samples::new(&times, &values), &options).unwrap()
///     })
///     .collect();
/// let verdict = pooled(&holds.iter().collect::<Vec<_>>()).unwrap();
/// assert_eq!((verdict.law.to_string(), verdict.indistinguishable.len(), verdict.holds), ("latency:5".to_owned(), 1, 4));
/// ```
#[must_use]
pub fn pooled<'a>(comparisons: &[&'a Comparison]) -> Option<PooledVerdict> {
    let judged: Vec<&'a Comparison> = comparisons.iter().filter(|found| found.verdict.is_some()).copied().collect();
    let with_forecasts: Vec<&'a Comparison> =
        judged.iter().filter(|found| found.ranking == Ranking::Forward).copied().collect();
    let (counted, forward) = match with_forecasts.len() >= FEWEST {
        true => (with_forecasts, true),
        false => (judged, false),
    };
    if counted.len() < FEWEST {
        return None;
    }
    let figure = |hold: &Comparison, row: &Row| -> Option<f64> {
        if !forward {
            return row.delta_bic;
        }
        let known: Vec<f64> = losses(&row.forward, hold.change).into_iter().flatten().collect();
        (!known.is_empty()).then(|| mean(&known))
    };
    let pooled = counted[0].rows.iter().filter_map(|first| {
        let fitted = |hold: &&'a Comparison| hold.rows.iter().find(|row| row.law == first.law && row.was_fitted());
        let rows: Vec<&Row> = counted.iter().map(fitted).collect::<Option<_>>()?;
        // A hold may be too short, or relax too little, to show every term of the law of all others.
        if 2 * rows.iter().filter(|row| row.is_good()).count() <= rows.len() {
            return None;
        }
        let figures: Option<Vec<f64>> = counted.iter().zip(&rows).map(|(hold, row)| figure(hold, row)).collect();
        let evidence: f64 = rows.iter().filter_map(|row| row.delta_bic).sum();
        let refuted = rows.iter().filter(|row| row.delta_bic.is_none_or(|bic| bic > REFUTED)).count();
        Some(Pooled {
            law: first.law,
            figures: figures?.into_iter().map(Some).collect(),
            evidence,
            stands: first.law != Law::Spectrum && 2 * refuted <= counted.len(),
        })
    });
    let pooled: Vec<Pooled> = pooled.collect();
    let any_stands = pooled.iter().any(|law| law.stands);
    let usable: Vec<&Pooled> =
        pooled.iter().filter(|law| !any_stands || law.stands || law.law == Law::Spectrum).collect();
    let candidates = usable.iter().filter(|law| !any_stands || law.stands);
    let best = candidates.min_by(|a, b| a.middle().total_cmp(&b.middle()))?;
    // One law says nothing of the others, which were not fitted on all holds.
    if pooled.len() < 2 {
        return None;
    }
    let margin = if forward { MARGIN } else { 1.0 };
    let is_worse = |law: &Pooled| {
        // Without forecasts the penalty for a parameter, which is the same on all holds, is no evidence of its own.
        let has_evidence = forward || law.evidence > best.evidence + EVIDENCE;
        has_evidence && is_worse(&law.figures, &best.figures, margin, usable.len() - 1)
    };
    let alike = usable.iter().filter(|law| !is_worse(law));
    let alike: Vec<&Pooled> = alike.copied().collect();
    let chosen = alike.iter().min_by(|a, b| preferred((a.law, a.evidence), (b.law, b.evidence)))?;
    Some(PooledVerdict {
        law: chosen.law,
        indistinguishable: alike.iter().map(|law| law.law).collect(),
        holds: counted.len(),
    })
}

/// A law on all holds.
struct Pooled {
    law: Law,
    /// One a hold.
    figures: Vec<Option<f64>>,
    /// Sum of the differences of BIC.
    evidence: f64,
    /// Whether no more than half of the holds refute it.
    stands: bool,
}

impl Pooled {
    fn middle(&self) -> f64 {
        let known: Vec<f64> = self.figures.iter().flatten().copied().collect();
        mean(&known)
    }
}
