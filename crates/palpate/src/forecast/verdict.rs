//! The law to use, its certainty, and the cost of others.

use super::result::{Certainty, Comparison, Ranking, Reservation, Row, Verdict};
use crate::laws::Law;

/// Errors within this factor of the best count as alike.
const ALIKE: f64 = 1.5;

/// Of the noise: errors that differ by less are alike too, since the noise of the predicted samples is in all of them.
const SHARE_OF_NOISE: f64 = 0.1;

/// Differences of BIC within which laws are alike ("positive" evidence begins here in the scale of Kass and Raftery).
const EVIDENCE: f64 = 2.0;

/// A difference of BIC beyond which a law is refuted ("very strong" evidence in the scale of Kass and Raftery).
const REFUTED: f64 = 10.0;

/// A choice is more than open only where its forecasts miss by no more than this many standard deviations of the noise, or by this share
/// of the change: on real holds those of no law mostly do, and then the law that was best so far is best in the rest in 3 of 10.
const AT_NOISE: (f64, f64) = (1.25, 1e-4);

/// A law whose forecasts miss by more than this share of the change predicts nothing.
const UNPREDICTIVE: f64 = 1.0 / 3.0;

impl Comparison {
    /// The figure that laws are ranked by: forward error as a share of the change of the signal, or excess of BIC.
    #[must_use]
    pub fn figure(&self, row: &Row) -> Option<f64> {
        match self.ranking {
            Ranking::Forward => row.forward.score,
            Ranking::Information => row.delta_bic,
        }
    }

    /// Whether a figure is as good as another, smaller one.
    fn indistinguishable(&self, figure: f64, best: f64) -> bool {
        match self.ranking {
            Ranking::Forward => figure <= ALIKE * best || figure - best <= SHARE_OF_NOISE * self.noise / self.change,
            Ranking::Information => figure - best <= EVIDENCE,
        }
    }
}

/// Judges ranked rows.
pub(super) fn judge(comparison: &Comparison) -> Option<Verdict> {
    let figures = || comparison.rows.iter().filter_map(|row| comparison.figure(row).map(|figure| (row, figure)));
    let any_good = figures().any(|(row, _)| row.is_good());
    // The spectrum has no parameters to report; it may refute a law, and gives way to one that it does not refute.
    let is_law = |row: &Row| row.is_good() && row.law != Law::Spectrum;
    let stands = move |row: &Row| is_law(row) && row.delta_bic.is_some_and(|bic| bic <= REFUTED);
    let any_stands = figures().any(|(row, _)| stands(row));
    let usable = || {
        let good = figures().filter(move |(row, _)| row.is_good() || !any_good);
        good.filter(move |(row, _)| !any_stands || stands(row) || row.law == Law::Spectrum)
    };
    // Of laws that stand the best one; the spectrum may be as good as it, but not in its place.
    let best = usable().find(|(row, _)| !any_stands || stands(row))?.1;
    let alike: Vec<(&Row, f64)> = usable().filter(|(_, figure)| comparison.indistinguishable(*figure, best)).collect();
    // A spectrum has no parameters to carry to another test, so a law that is not distinguishable from it goes first.
    let (chosen, figure) = *alike.iter().min_by(|(a, one), (b, other)| {
        let spectrum = |row: &Row| row.law == Law::Spectrum;
        let simpler = spectrum(a).cmp(&spectrum(b)).then(a.effective_parameters.total_cmp(&b.effective_parameters));
        simpler.then(one.total_cmp(other))
    })?;
    let others = figures().filter(|(row, _)| row.law != chosen.law);
    let costs = others.map(|(row, other)| match comparison.ranking {
        Ranking::Forward => (row.law, other / figure),
        Ranking::Information => (row.law, other - figure),
    });
    let cuts_won = (0..comparison.cuts.len()).filter(|&cut| wins(comparison, chosen, cut)).count();
    let next = usable().map(|(_, figure)| figure).find(|figure| !comparison.indistinguishable(*figure, best));
    let any_refuted = any_stands && figures().any(|(row, _)| is_law(row) && !stands(row));
    let apart = next.map_or(any_refuted, |next| match comparison.ranking {
        Ranking::Forward => next >= 2.0 * figure,
        Ranking::Information => next - figure >= 10.0,
    });
    // A law that contains the chosen one predicts at least as well; that says nothing against it.
    let alternative = |law: Law| !law.contains(chosen.law);
    let alternatives = usable().filter(|(row, _)| alternative(row.law)).count();
    let alike_alternatives = alike.iter().filter(|(row, _)| alternative(row.law)).count();
    let reservation = match figure {
        _ if !any_stands && figures().any(|(row, _)| is_law(row)) => Some(Reservation::Refuted),
        error if comparison.ranking == Ranking::Forward && error > UNPREDICTIVE => Some(Reservation::Unpredictive),
        _ => None,
    };
    let limit = AT_NOISE.0 * comparison.noise + AT_NOISE.1 * comparison.change;
    let mut forecasts = chosen.forward.forecasts.iter().flatten();
    let at_noise = comparison.ranking == Ranking::Forward && forecasts.all(|forecast| forecast.rmse <= limit);
    let certainty = if reservation.is_some() || !at_noise || 2 * alike_alternatives > alternatives {
        Certainty::Open
    } else if apart && alike_alternatives == 0 && cuts_won == comparison.cuts.len() {
        Certainty::Clear
    } else {
        Certainty::Likely
    };
    Some(Verdict {
        law: chosen.law,
        indistinguishable: alike.iter().map(|(row, _)| row.law).collect(),
        certainty,
        reservation,
        cuts_won,
        costs: costs.collect(),
    })
}

/// Whether a law is best or alike at one cut point.
fn wins(comparison: &Comparison, row: &Row, cut: usize) -> bool {
    let at = |row: &Row| row.forward.relative(cut, comparison.change);
    let best = comparison.rows.iter().filter(|row| row.is_good()).filter_map(at).fold(f64::INFINITY, f64::min);
    at(row).is_some_and(|error| comparison.indistinguishable(error, best))
}
