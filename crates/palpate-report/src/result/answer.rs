//! The answer of an analysis or a comparison: which law for the record and for each hold, with its formula and its parameters.

use std::cmp::Ordering;

use palpate::analysis::{Finding, Severity};
use palpate::fit::Fit;
use palpate::forecast::{Certainty, Comparison, PooledVerdict, Ranking, Reservation, Verdict, name_in_words, pooled};
use palpate::laws::Law;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::compared::{ComparedHold, ComparedRecord};
use super::parameters::{Parameters, parameters_of};
use super::{Quantity, word};
use crate::number::significant;

/// Findings that an answer states for a hold; all others stand below it.
const MOST_FINDINGS: usize = 2;

/// Which law to use for a record, and for each of its holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Answer {
    /// The law for the record as a whole; `null` where none could be fitted.
    pub law: Option<String>,
    /// Other laws that all holds together do not distinguish from the best; `null` for fewer than three holds.
    pub indistinguishable: Option<Vec<String>>,
    /// Holds on which that law is not distinguishable from the best.
    pub holds_agreeing: usize,
    /// Holds on which laws could be compared.
    pub holds_compared: usize,
    /// All that in a sentence.
    pub sentence: String,
    /// The answer for each hold.
    pub holds: Vec<HoldAnswer>,
}

/// Which law to use for a hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HoldAnswer {
    /// Number of the hold, from 1.
    pub hold: usize,
    /// The hold in words.
    pub title: String,
    /// The recommended law.
    pub law: String,
    /// `clear`, `likely` or `open`.
    pub certainty: String,
    /// Probability that no law that was compared predicts what follows better by more than a fifth.
    pub probability: f64,
    /// The law with its values put in; t counts from the start of the fit. `null` for the spectrum.
    pub formula: Option<String>,
    /// Time of the record from which t counts, s.
    pub fit_start_s: f64,
    /// Its parameters with their intervals.
    pub parameters: Parameters,
    /// Why its fit ended.
    pub termination: String,
    /// `refuted` or `unpredictive` where every law is; this one is then the best approximation.
    pub reservation: Option<String>,
    /// Root mean square error of its forecasts beyond the fitted parts, as a share of the change of the signal; `null` where the hold is
    /// too short to hold anything out.
    pub holdout_error: Option<f64>,
    /// Other laws that these data do not distinguish from the best.
    pub indistinguishable: Vec<String>,
    /// What matters most for it.
    pub findings: Vec<String>,
}

impl Answer {
    /// The answer for a record on which laws were compared.
    #[must_use]
    pub fn new(record: &ComparedRecord) -> Self {
        let judged: Vec<_> = record.verdicts().collect();
        let together = pooled_of(record);
        let law = together.as_ref().map_or_else(|| law_of_few(record), |found| Some(found.law));
        let others = together
            .map(|found| found.indistinguishable.into_iter().filter(|other| *other != found.law).collect::<Vec<Law>>());
        let agreeing = judged.iter().filter(|(_, found)| law.is_some_and(|law| alike(found).contains(&law))).count();
        Self {
            law: law.map(|law| law.to_string()),
            indistinguishable: others.as_ref().map(|of| of.iter().map(Law::to_string).collect()),
            holds_agreeing: agreeing,
            holds_compared: judged.len(),
            sentence: sentence(record, law, agreeing, &judged.iter().map(|(_, found)| *found).collect::<Vec<_>>())
                + &others.as_deref().map_or_else(String::new, sentence_of_all),
            holds: judged.iter().filter_map(|(hold, found)| HoldAnswer::new(hold, found)).collect(),
        }
    }
}

impl HoldAnswer {
    /// What stands against every law, which goes before how this one compares with the others, or else that, in words.
    pub(crate) fn standing(&self) -> String {
        self.reservation.as_ref().unwrap_or(&self.certainty).replace('_', " ")
    }

    fn new(hold: &ComparedHold, comparison: &Comparison) -> Option<Self> {
        let verdict = comparison.verdict.as_ref()?;
        let row = comparison.rows.iter().find(|row| row.law == verdict.law)?;
        let fit = row.fit.as_ref().ok().filter(|_| row.spectrum.is_none());
        Some(Self {
            hold: hold.number,
            title: hold.title(),
            law: verdict.law.to_string(),
            certainty: word(verdict.certainty),
            probability: verdict.probability,
            formula: fit.map(|fit| formula(fit, hold.quantity)),
            fit_start_s: hold.fit_start,
            parameters: fit.map(|fit| parameters_of(fit, hold.quantity)).unwrap_or_default(),
            reservation: verdict.reservation.map(word),
            termination: fit.map_or_else(|| "converged".to_owned(), |fit| word(fit.termination)),
            holdout_error: row.forward.score.filter(|_| comparison.ranking == Ranking::Forward),
            indistinguishable: verdict
                .indistinguishable
                .iter()
                .filter(|law| **law != verdict.law)
                .map(Law::to_string)
                .collect(),
            findings: most_severe(&hold.findings),
        })
    }

    /// What the law predicts, how sure the choice is, and which other laws are not distinguishable from the best, in a sentence.
    #[must_use]
    pub fn statement(&self) -> String {
        let mut text = match self.reservation.as_deref() {
            Some("refuted") => {
                "No law describes this hold down to its noise; this is the best approximation. ".to_owned()
            }
            Some("drive_changes") => {
                "The force changes in this hold, and the displacement follows it: a law describes both together. "
                    .to_owned()
            }
            Some(_) => "No law predicts this hold; this one is the closest. ".to_owned(),
            None => String::new(),
        };
        text += &match self.holdout_error {
            Some(error) => {
                format!("Forecasts beyond the fitted parts miss by {} % of the change", significant(100.0 * error, 2))
            }
            None => "The hold is too short, or changes too little, for a held-out error; the BIC decides".to_owned(),
        };
        if !self.indistinguishable.is_empty() {
            text.push_str(&format!("; not distinguishable from the best: {}", self.indistinguishable.join(", ")));
        }
        text.push('.');
        text
    }
}

/// The law with its values put in.
#[must_use]
pub fn formula(fit: &Fit, quantity: Quantity) -> String {
    match quantity {
        Quantity::Strain => fit.curve.formula("ε", ""),
        Quantity::Force => fit.curve.formula("F", "N"),
        Quantity::Displacement => fit.curve.formula("u", "m"),
    }
}

/// The laws that are not distinguishable from the best on a hold.
fn alike(comparison: &Comparison) -> &[Law] {
    comparison.verdict.as_ref().map_or(&[], |verdict| &verdict.indistinguishable)
}

/// The verdict of three holds or more together.
fn pooled_of(record: &ComparedRecord) -> Option<PooledVerdict> {
    pooled(&record.verdicts().map(|(_, found)| found).collect::<Vec<_>>())
}

/// The law for a record: by all holds together, if there are enough.
pub(crate) fn law_of_record(record: &ComparedRecord) -> Option<Law> {
    pooled_of(record).map_or_else(|| law_of_few(record), |found| Some(found.law))
}

/// The law that is not distinguishable from the best on the most holds; of several the one for which the evidence of all holds, the sum of
/// their differences of BIC, is strongest. The spectrum has no parameters to carry to another test and comes last.
fn law_of_few(record: &ComparedRecord) -> Option<Law> {
    let judged: Vec<_> = record.verdicts().collect();
    let mut laws: Vec<Law> = Vec::new();
    for law in judged.iter().flat_map(|(_, found)| alike(found)) {
        if !laws.contains(law) {
            laws.push(*law);
        }
    }
    let holds = |law: Law| judged.iter().filter(|(_, found)| alike(found).contains(&law)).count();
    let rows = |law: Law| judged.iter().filter_map(move |(_, found)| found.rows.iter().find(|row| row.law == law));
    let evidence = |law: Law| rows(law).filter_map(|row| row.delta_bic).sum::<f64>();
    let order = |a: &Law, b: &Law| -> Ordering {
        let last = |law: &Law| *law == Law::Spectrum;
        (last(a).cmp(&last(b))).then(holds(*b).cmp(&holds(*a))).then(evidence(*a).total_cmp(&evidence(*b)))
    };
    laws.into_iter().min_by(order)
}

fn sentence(record: &ComparedRecord, law: Option<Law>, agreeing: usize, judged: &[&Comparison]) -> String {
    let Some(law) = law else {
        return match record.holds.iter().any(|hold| hold.comparison.is_some()) {
            true => {
                "No law can be recommended: no hold has enough samples and change to compare laws on it.".to_owned()
            }
            false => "Laws were not compared.".to_owned(),
        };
    };
    let name = name_in_words(law);
    let compared = judged.len();
    let reservations: Vec<Reservation> = judged
        .iter()
        .filter_map(|found| found.verdict.as_ref().and_then(|verdict| verdict.reservation))
        .collect();
    let what = match &reservations[..] {
        [] => &*open_on_most(judged, law).map_or_else(
            || "Law for this record".to_owned(),
            |open| format!("{open} The first choice for this record"),
        ),
        all if all.contains(&Reservation::DriveChanges) => {
            "In some holds what is held goes on, so that no law there is that of the body alone. The closest for this record"
        }
        all => reserved(all, compared),
    };
    let which = match (agreeing, compared) {
        (_, 1) => "On the one hold compared".to_owned(),
        (agreeing, compared) if agreeing == compared => format!("On all {compared} holds"),
        (agreeing, compared) => format!("On {agreeing} of {compared} holds"),
    };
    format!(
        "{}{what}: {law}, {name}. {which} it is the best law or not distinguishable from the best.",
        by_fit_alone(judged)
    )
}

/// What stands against every law on the holds that have a reservation, of `compared` holds; it stands before the best approximation.
///
/// A hold whose forecasts all miss refutes no law: its noise may hide which one it follows.
fn reserved(reservations: &[Reservation], compared: usize) -> &'static str {
    let refuted = reservations.iter().filter(|one| **one == Reservation::Refuted).count();
    let all = reservations.len() == compared;
    match (refuted, reservations.len() - refuted, all, compared) {
        (0, _, true, 1) => "No law that was compared predicts the rest of this hold. The closest",
        (0, _, true, _) => "No law that was compared predicts the rest of any hold. The closest for this record",
        (0, _, false, _) => "In some holds no law predicts what follows. The best approximation for this record",
        (_, 0, true, _) => "No law that was compared describes this record down to its noise. The best approximation",
        (_, 0, false, _) => "Best approximation for this record, of which some holds refute every law",
        _ => {
            "Some holds refute every law, and in others no law predicts what follows. The best approximation for this record"
        }
    }
}

/// That the law is open, unless it is certain on most holds that name this one; it stands before the choice.
fn open_on_most(judged: &[&Comparison], law: Law) -> Option<String> {
    let verdicts = || judged.iter().filter_map(|found| found.verdict.as_ref());
    let is_open = |verdict: &&Verdict| verdict.certainty == Certainty::Open;
    let (open, all) = (verdicts().filter(is_open).count(), verdicts().count());
    let certain = verdicts().filter(|verdict| verdict.certainty != Certainty::Open && verdict.law == law).count();
    if certain >= open.max(1) {
        return None;
    }
    let most = 100.0 * verdicts().filter(is_open).map(|verdict| verdict.probability).fold(0.0, f64::max);
    let others = match all - open - certain {
        0 => String::new(),
        others => format!(", and {others} favour another law"),
    };
    Some(match (open, all) {
        (_, 1) => format!("Which law to use is open ({most:.0} %)."),
        (open, all) if open == all => {
            format!("Which law to use is open on each of {all} holds ({most:.0} % at the most).")
        }
        (0, _) => "Which law to use differs from hold to hold.".to_owned(),
        (open, all) => format!("Which law to use is open on {open} of {all} holds ({most:.0} % at the most){others}."),
    })
}

/// What the choice rests on where no hold could be held out in part; it stands before the choice.
fn by_fit_alone(judged: &[&Comparison]) -> &'static str {
    let forward = |found: &&Comparison| found.ranking == Ranking::Forward;
    match judged {
        [] => "",
        judged if judged.iter().any(forward) => "",
        [_] => {
            "No part of the hold can be held out (30 samples before the cut and 10 after it, with a change above the noise): the choice \
             rests on how closely laws fit for their parameters (BIC), and nothing shows what they predict. "
        }
        _ => {
            "No part of any hold can be held out (30 samples before the cut and 10 after it, with a change above the noise): the choice \
             rests on how closely laws fit for their parameters (BIC), and nothing shows what they predict. "
        }
    }
}

/// Which other laws all holds together do not distinguish from the best.
fn sentence_of_all(others: &[Law]) -> String {
    if others.is_empty() {
        return " All holds together distinguish it from every other law.".to_owned();
    }
    let names: Vec<String> = others.iter().map(Law::to_string).collect();
    format!(" All holds together do not distinguish it from: {}.", names.join(", "))
}

/// The most severe findings in words, cautions and warnings alone.
fn most_severe(findings: &[Finding]) -> Vec<String> {
    let mut severe: Vec<&Finding> = findings.iter().filter(|finding| finding.severity() > Severity::Info).collect();
    severe.sort_by_key(|finding| finding.rank());
    severe
        .iter()
        .take(MOST_FINDINGS)
        .map(|finding| format!("{}: {}", word(finding.severity()), finding.observation()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hold too noisy for a forecast was stated to refute every law, and a single one to be described by none.
    #[test]
    fn a_hold_that_no_law_predicts_refutes_none() {
        use Reservation::{Refuted, Unpredictive};
        let refutes = |of: &[Reservation], compared| {
            let text = reserved(of, compared);
            (text.contains("refute") || text.contains("down to its noise"), text.contains("predicts"))
        };
        assert_eq!(refutes(&[Unpredictive], 1), (false, true));
        assert_eq!(refutes(&[Unpredictive], 6), (false, true));
        assert_eq!(refutes(&[Unpredictive, Unpredictive], 2), (false, true));
        assert_eq!(refutes(&[Refuted], 1), (true, false));
        assert_eq!(refutes(&[Refuted, Refuted], 6), (true, false));
        assert_eq!(refutes(&[Refuted, Unpredictive], 2), (true, true));
        assert!(reserved(&[Unpredictive], 1).contains("this hold"));
    }
}
