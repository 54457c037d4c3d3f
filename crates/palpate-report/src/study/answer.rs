//! The answer of an analysis or a comparison, before everything else: as text, as tables and as blocks of a page.

use palpate::fit::{Fit, Parameter, ParameterKind, ParameterRole};
use palpate::laws::Law;

use super::findings::Gathered;
use crate::number::significant;
use crate::page::Block;
use crate::result::{
    Answer, ComparedHold, ComparedRecord, HoldAnswer, ParameterDocument, Parameters, parameter_title, parameters_of,
    percent, word,
};
use crate::table::{Cell, Table};
use crate::word::capitalised;
use crate::wrap::{indented, width, wrapped};

/// Up to so many holds each has its parameters below its formula; more share a table.
const FEW: usize = 3;
/// Findings of the record that belong to the answer.
const MOST_FINDINGS: usize = 2;

/// The answer as text.
pub(super) fn answer_text(record: &ComparedRecord, findings: &[Gathered]) -> String {
    let answer = Answer::new(record);
    let mut text = wrapped(&answer.sentence);
    let few = answer.holds.len() <= FEW;
    for hold in &answer.holds {
        text.push('\n');
        text.push_str(&wrapped(&format!(
            "{}: {} ({}, {:.0} %)",
            hold.title,
            hold.law,
            // What stands against every law goes before how this one compares with the others.
            hold.reservation.as_ref().unwrap_or(&hold.certainty),
            100.0 * hold.probability
        )));
        for line in formula_line(hold).into_iter().chain([hold.statement()]) {
            text.push_str(&indented("  ", 4, width(), &line));
        }
        if few {
            text.push_str(&listed(&hold.parameters));
        }
    }
    if !few {
        text.extend(parameters_of_holds(record, &answer).map(|table| format!("\n{}", table.to_plain_text())));
    }
    for finding in most_severe(findings) {
        text.push_str(&format!("\n{}", wrapped(&finding)));
    }
    text
}

/// The answer as blocks of a page.
pub(super) fn answer_blocks(record: &ComparedRecord, answer: &Answer, findings: &[Gathered]) -> Vec<Block> {
    let mut blocks = vec![Block::paragraph(answer.sentence.clone())];
    blocks.extend(verdicts(answer).map(Block::Table));
    blocks.extend(parameters_of_holds(record, answer).map(Block::Table));
    let lines: Vec<String> = answer
        .holds
        .iter()
        .filter_map(|hold| Some(format!("Hold {}, {}: {}", hold.hold, hold.law, formula_line(hold)?)))
        .collect();
    if !lines.is_empty() {
        blocks.push(Block::List(lines));
    }
    blocks.extend(Some(most_severe(findings)).filter(|found| !found.is_empty()).map(Block::List));
    blocks
}

/// The formula of a hold, and from when t counts.
fn formula_line(hold: &HoldAnswer) -> Option<String> {
    let formula = hold.formula.as_ref()?;
    Some(format!("{formula}, with t from {} s of the record", significant(hold.fit_start_s, 4)))
}

/// Parameters, a line each.
fn listed(parameters: &Parameters) -> String {
    let longest = parameters.keys().map(|name| parameter_title(name).len()).max().unwrap_or(0);
    let line = |(name, parameter): (&String, &ParameterDocument)| {
        let (value, unit) = parameter.shown();
        format!("    {}\n", format!("{:<longest$}  {value} {unit}", parameter_title(name)).trim_end())
    };
    parameters.iter().map(line).collect()
}

/// Which law to use, hold by hold.
pub(super) fn verdicts(answer: &Answer) -> Option<Table> {
    const CAPTION: &str = "Law to use for each hold. Probability: that no law that was compared predicts what follows better by more than a fifth.";
    Table::of("answer", CAPTION, &answer.holds)
        .column("Hold", "hold", "", |hold| Cell::Integer(hold.hold as i64))
        .column("Recommended law", "law", "", |hold| Cell::text(&hold.law))
        .column("Certainty", "certainty", "", |hold| Cell::text(&hold.certainty))
        .column("Probability", "probability_percent", "%", |hold| Cell::Number(100.0 * hold.probability, 2))
        .column("Held-out error", "holdout_error_percent", "%", |hold| {
            let reason = "too short for a held-out error: chosen by BIC";
            Cell::number_or(hold.holdout_error.map(|error| 100.0 * error), 2, reason)
        })
        .column("Not distinguishable from the best", "indistinguishable", "", |hold| {
            Cell::text(if hold.indistinguishable.is_empty() {
                "–".to_owned()
            } else {
                hold.indistinguishable.join(", ")
            })
        })
        .unless_empty()
}

/// The parameters of the law of the record on every hold.
pub(super) fn parameters_of_holds(record: &ComparedRecord, answer: &Answer) -> Option<Table> {
    let law: Law = answer.law.as_ref()?.parse().ok()?;
    let fits = record.holds.iter().filter_map(|hold| {
        let rows = &hold.comparison.as_ref()?.rows;
        let fit = rows.iter().find(|row| row.law == law)?.fit.as_ref().ok()?;
        Some((hold, fit, parameters_of(fit, hold.quantity)))
    });
    let fits: Vec<(&ComparedHold, &Fit, Parameters)> = fits.collect();
    let (_, first, units) = fits.first()?;
    let confidence = fits.iter().find_map(|(_, fit, _)| Some(fit.uncertainty.as_ref()?.confidence)).unwrap_or(0.95);
    let caption = format!("Parameters of {law} on every hold, with {} intervals.", percent(confidence));
    let mut table = Table::of("law_of_record", caption, &fits)
        .column("Hold", "hold", "", |(hold, ..)| Cell::Integer(hold.number as i64));
    let of_interest = |parameter: &&Parameter| {
        parameter.role == ParameterRole::Estimated || parameter.name.kind == ParameterKind::RateCoefficient
    };
    for parameter in first.parameters.iter().filter(of_interest) {
        let name = parameter.name.to_string();
        let unit = units.get(&name).map_or("", |parameter| parameter.unit.as_str());
        table =
            table.estimates(heading(&name), name.clone(), if unit == "1" { "" } else { unit }, |(.., parameters)| {
                parameters.get(&name).map_or(Cell::missing("not determined"), ParameterDocument::cell)
            });
    }
    let ended = |fit: &Fit| Cell::text(word(fit.termination).replace('_', " "));
    Some(table.column("Ended", "termination", "", |(_, fit, _)| ended(fit)).table())
}

/// A parameter as a heading names it: without its unit, which stands behind it.
fn heading(name: &str) -> String {
    capitalised(&parameter_title(name))
}

/// The findings that matter most, cautions and warnings alone.
fn most_severe(findings: &[Gathered]) -> Vec<String> {
    let severe = findings.iter().filter(|finding| finding.severity > palpate::analysis::Severity::Info);
    severe.take(MOST_FINDINGS).map(Gathered::briefly).collect()
}
