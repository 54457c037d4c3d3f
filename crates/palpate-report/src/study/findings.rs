//! What was found, gathered: one entry for each code, true for every hold that it names.

use palpate::analysis::{Analysis, Finding as RecordFinding, HoldAnalysis, Severity};

use crate::page::Finding;
use crate::result::{ComparedRecord, word};
use crate::spelling::with_flags;
use crate::word::capitalised;
use crate::wrap::{indented, width};

/// Different words for one code that are written out; more are counted.
pub(super) const MOST_LINES: usize = 6;
/// The same for a terminal.
pub(super) const MOST_PLAIN: usize = 2;
/// Places before the further lines of a finding on a terminal.
const INDENT: usize = 9;
/// A force below this share of the largest one of the record is none.
const NO_FORCE: f64 = 0.01;

/// One finding with all the holds that have it; the most severe first.
pub(super) struct Gathered {
    /// How much it matters.
    pub severity: Severity,
    /// Its code.
    pub code: &'static str,
    /// Where it was observed and what: one line for each different text.
    pub lines: Vec<(String, String)>,
    meaning: &'static str,
    remedy: &'static str,
}

impl Gathered {
    /// In a sentence, with the first place where it was observed.
    pub(super) fn briefly(&self) -> String {
        let between = if self.lines.first().is_some_and(|(place, _)| !place.is_empty()) { ", " } else { ": " };
        format!("{}{between}{}.", capitalised(&word(self.severity)), self.placed())
    }

    /// The first place where it was observed, and what.
    pub(super) fn placed(&self) -> String {
        match self.lines.first() {
            Some((place, observed)) if !place.is_empty() => format!("{}: {observed}", place.to_lowercase()),
            Some((_, observed)) => observed.clone(),
            None => String::new(),
        }
    }

    /// As a page shows it.
    pub(super) fn reported(&self) -> Finding {
        let line = |(place, observed): &(String, String)| {
            if place.is_empty() { sentence(observed) } else { format!("{place}: {observed}.") }
        };
        let lines: Vec<String> = self.lines.iter().map(line).collect();
        Finding {
            severity: self.severity,
            code: self.code.to_owned(),
            observation: lines.join("\n"),
            meaning: sentence(self.meaning),
            remedy: sentence(&with_flags(self.remedy)),
        }
    }
}

/// All findings of a record and of its holds.
pub(super) fn gathered(analysis: &Analysis, most: usize) -> Vec<Gathered> {
    let mut observed: Vec<Observed<'_>> = analysis.findings.iter().map(|finding| Observed::of(finding, None)).collect();
    for hold in &analysis.holds {
        let without_area = hold.findings.iter().any(|finding| matches!(finding, RecordFinding::NoContactArea));
        for finding in &hold.findings {
            // That an open contact does not relax goes without saying.
            if !(without_area && matches!(finding, RecordFinding::NoRelaxation { .. })) {
                let mut one = Observed::of(finding, Some(hold.number));
                if matches!(finding, RecordFinding::NoContactArea) && open(analysis, hold) {
                    one.severity = Severity::Info;
                }
                observed.push(one);
            }
        }
    }
    merged(observed, most)
}

/// Findings of a calibrated record, of which `place` is the name among others.
pub(super) fn gathered_at(place: &str, findings: &[RecordFinding]) -> Vec<Gathered> {
    let mut list = merged(findings.iter().map(|finding| Observed::of(finding, None)).collect(), MOST_LINES);
    list.iter_mut().flat_map(|one| &mut one.lines).for_each(|(at, _)| place.clone_into(at));
    list
}

/// One entry for each code, the most severe first.
fn merged(mut observed: Vec<Observed<'_>>, most: usize) -> Vec<Gathered> {
    observed.sort_by_key(|one| one.finding.rank());
    let mut list = Vec::new();
    while let Some(first) = observed.first() {
        let (severity, finding) = (first.severity, first.finding);
        let (alike, rest) = observed
            .into_iter()
            .partition(|other| other.severity == severity && other.finding.code() == finding.code());
        list.push(gather(severity, finding, alike, most));
        observed = rest;
    }
    list.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
    list
}

/// A finding and where it was observed.
struct Observed<'a> {
    severity: Severity,
    finding: &'a RecordFinding,
    hold: Option<usize>,
}

impl<'a> Observed<'a> {
    fn of(finding: &'a RecordFinding, hold: Option<usize>) -> Self {
        Self {
            severity: finding.severity(),
            finding,
            hold,
        }
    }
}

/// Whether there is no force to speak of in a hold.
fn open(analysis: &Analysis, hold: &HoldAnalysis) -> bool {
    let largest = analysis.record.force().iter().fold(0.0, |most: f64, force| most.max(force.abs()));
    hold.force_start.abs().max(hold.force_end.abs()) <= NO_FORCE * largest
}

/// All that say the same as `finding`, with that severity, as one.
fn gather(severity: Severity, finding: &RecordFinding, alike: Vec<Observed<'_>>, most: usize) -> Gathered {
    let (meaning, remedy) = if severity == Severity::Info && matches!(finding, RecordFinding::NoContactArea) {
        (
            "the jaw is back at first touch and the contact is open; such a hold is not fitted",
            "none, if the contact was meant to be open",
        )
    } else {
        (finding.meaning(), finding.remedy())
    };
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for Observed { hold, finding, .. } in alike {
        entry(&mut groups, finding.observation()).extend(hold);
    }
    // A last line that counts the rest is worth it only if it stands for several.
    let cut = if groups.len() > most + 1 { most } else { groups.len() };
    let more: Vec<usize> = groups[cut..].iter().flat_map(|(_, holds)| holds.iter().copied()).collect();
    let mut lines: Vec<(String, String)> =
        groups.into_iter().take(cut).map(|(text, holds)| (holds_named(&holds), text)).collect();
    if !more.is_empty() {
        lines.push((holds_named(&more), "likewise, with values of their own (see the JSON output)".to_owned()));
    }
    Gathered {
        severity,
        code: finding.code(),
        lines,
        meaning,
        remedy,
    }
}

/// What stands beside a key; a new key goes behind the others.
pub(super) fn entry<K: PartialEq, V: Default>(entries: &mut Vec<(K, V)>, key: K) -> &mut V {
    let place = entries.iter().position(|(other, _)| *other == key).unwrap_or(entries.len());
    if place == entries.len() {
        entries.push((key, V::default()));
    }
    &mut entries[place].1
}

/// `Hold 2`, `Holds 1–3, 7`, or nothing for the whole record.
pub(super) fn holds_named(holds: &[usize]) -> String {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    let mut sorted = holds.to_vec();
    sorted.sort_unstable();
    for hold in sorted {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == hold => *last = hold,
            _ => runs.push((hold, hold)),
        }
    }
    let named: Vec<String> = runs
        .iter()
        .map(|(first, last)| match last - first {
            0 => format!("{first}"),
            1 => format!("{first}, {last}"),
            _ => format!("{first}–{last}"),
        })
        .collect();
    match holds.len() {
        0 => String::new(),
        1 => format!("Hold {}", named.join(", ")),
        _ => format!("Holds {}", named.join(", ")),
    }
}

pub(super) fn sentence(text: &str) -> String {
    format!("{}.", capitalised(text))
}

/// All findings of a compared record and of its holds.
pub(super) fn gathered_of(record: &ComparedRecord, most: usize) -> Vec<Gathered> {
    let whole = record.findings.iter().map(|finding| Observed::of(finding, None));
    let of_holds = record
        .holds
        .iter()
        .flat_map(|hold| hold.findings.iter().map(|finding| Observed::of(finding, Some(hold.number))));
    merged(whole.chain(of_holds).collect(), most)
}

/// Findings for a terminal: severity and code, then what was observed where.
pub(super) fn plain(findings: &[Gathered]) -> String {
    let mut text = String::new();
    for finding in findings {
        let mut head = format!("{:<9}{}  ", word(finding.severity), finding.code);
        for (place, observed) in &finding.lines {
            let place = place.replacen("Hold", "hold", 1);
            let reported = if place.is_empty() { observed.clone() } else { format!("{place}: {observed}") };
            text.push_str(&indented(&head, INDENT, width(), &reported));
            head = " ".repeat(INDENT);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observed(finding: &RecordFinding, hold: usize) -> Observed<'_> {
        Observed {
            severity: Severity::Info,
            finding,
            hold: Some(hold),
        }
    }

    #[test]
    fn holds_that_differ_are_reported_apart() {
        let of = |exponents: &[f64]| RecordFinding::ExponentsIndistinguishable {
            exponents: exponents.to_vec(),
        };
        let (low, high) = (of(&[2.0, 3.0]), of(&[5.0, 7.0]));
        let all = vec![observed(&low, 2), observed(&high, 6), observed(&low, 3), observed(&high, 10)];
        let reported = gather(Severity::Info, &low, all, MOST_LINES).reported();
        assert_eq!(
            reported.observation,
            "Holds 2, 3: the exponents 2, 3 are not distinguishable.\nHolds 6, 10: the exponents 5, 7 are not distinguishable."
        );
    }

    #[test]
    fn many_different_texts_are_counted() {
        let findings: Vec<RecordFinding> = (0..12)
            .map(|i| RecordFinding::EquilibriumExtrapolated {
                law: palpate::laws::Law::StandardLinearSolid,
                beyond: 0.2 + 0.05 * f64::from(i),
                response: palpate::laws::Response::Relaxation,
            })
            .collect();
        let all = findings.iter().enumerate().map(|(i, finding)| observed(finding, i + 1)).collect();
        let reported = gather(Severity::Caution, &findings[0], all, MOST_LINES).reported();
        assert_eq!(reported.observation.lines().count(), MOST_LINES + 1);
        assert!(reported.observation.lines().last().is_some_and(|last| last.starts_with("Holds 7–12: likewise")));
    }

    #[test]
    fn lists_of_holds_are_short() {
        assert_eq!(holds_named(&[]), "");
        assert_eq!(holds_named(&[4]), "Hold 4");
        assert_eq!(holds_named(&[7, 1, 2, 3, 9, 10]), "Holds 1–3, 7, 9, 10");
    }
}
