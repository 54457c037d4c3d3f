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
use crate::table::{Cell, Columns, Table};
use crate::word::capitalised;
use crate::wrap::{indented, width, wrapped};

/// Up to so many holds each has its parameters below its formula; more share a table.
pub(super) const FEW: usize = 3;
/// Findings of the record that belong to the answer.
const MOST_FINDINGS: usize = 2;

/// The answer as text: a paragraph for each hold, or in brief a row.
pub(super) fn answer_text(record: &ComparedRecord, findings: &[Gathered], in_brief: bool) -> String {
    let answer = Answer::new(record);
    let mut text = wrapped(&answer.sentence);
    let few = answer.holds.len() <= FEW;
    if in_brief {
        text.extend(verdicts_in_brief(record, &answer).map(|table| format!("\n{}", table.to_plain_text())));
    }
    for hold in answer.holds.iter().filter(|_| !in_brief) {
        text.push('\n');
        text.push_str(&wrapped(&format!(
            "{}: {} ({}, {:.0} %)",
            hold.title,
            hold.law,
            hold.standing(),
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

/// The answer hold by hold as blocks of a page.
pub(super) fn answer_blocks(record: &ComparedRecord, answer: &Answer) -> Vec<Block> {
    let formula = |hold: &HoldAnswer| Some((hold.title.clone(), formula_line(hold)?));
    let formulas: Vec<(String, String)> = answer.holds.iter().filter_map(formula).collect();
    let mut blocks: Vec<Block> = verdicts(answer).map(Block::Table).into_iter().collect();
    blocks.extend(parameters_of_holds(record, answer).map(Block::Table));
    blocks.extend((!formulas.is_empty()).then_some(Block::Formulas(formulas)));
    blocks
}

/// The formula of a hold, and from when t counts.
fn formula_line(hold: &HoldAnswer) -> Option<String> {
    Some(with_start(hold.formula.as_ref()?, hold.fit_start_s))
}

/// A formula, and from when its t counts, s.
pub(super) fn with_start(formula: &str, start: f64) -> String {
    // To a hundredth of a second, however late in the day.
    let digits = 4.max(start.abs().max(1.0).log10().ceil() as usize + 2);
    format!("{formula}, with t from {} s of the record", significant(start, digits))
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

/// The same in rows that fit a terminal.
fn verdicts_in_brief(record: &ComparedRecord, answer: &Answer) -> Option<Table> {
    const CAPTION: &str = "Law to use for each hold. Others: laws that are not distinguishable from it.";
    let condition = |hold: &HoldAnswer| {
        let compared = record.holds.iter().find(|compared| compared.number == hold.hold);
        Cell::text(compared.map(ComparedHold::condition).unwrap_or_default())
    };
    let certainty = |hold: &HoldAnswer| Cell::text(format!("{}, {:.0} %", hold.standing(), 100.0 * hold.probability));
    Table::of("answer_in_brief", CAPTION, &answer.holds)
        .column("Hold", "hold", "", |hold| Cell::Integer(hold.hold as i64))
        .column("Held", "condition", "", condition)
        .column("Law", "law", "", |hold| Cell::text(&hold.law))
        .column("Certainty", "certainty", "", certainty)
        .column("Held-out error", "holdout_error_percent", "%", |hold| {
            Cell::number_or(hold.holdout_error.map(|error| 100.0 * error), 2, "too short: chosen by BIC")
        })
        .column("Others", "indistinguishable", "", |hold| Cell::Integer(hold.indistinguishable.len() as i64))
        .unless_empty()
}

/// A law fitted to a hold.
pub(super) struct HoldFit<'a> {
    pub hold: &'a ComparedHold,
    pub fit: &'a Fit,
    pub parameters: Parameters,
}

impl<'a> HoldFit<'a> {
    pub(super) fn new(hold: &'a ComparedHold, fit: &'a Fit) -> Self {
        let parameters = parameters_of(fit, hold.quantity);
        Self { hold, fit, parameters }
    }
}

/// The law of the record as it was fitted to each hold.
pub(super) fn fits_of_record<'a>(record: &'a ComparedRecord, answer: &Answer) -> Vec<HoldFit<'a>> {
    let law: Option<Law> = answer.law.as_ref().and_then(|law| law.parse().ok());
    law.map_or_else(Vec::new, |law| fits_of_law(record, law))
}

/// A law that was compared as it was fitted to each hold.
pub(super) fn fits_of_law<'a>(record: &'a ComparedRecord, law: Law) -> Vec<HoldFit<'a>> {
    let fit = |hold: &'a ComparedHold| {
        let rows = &hold.comparison.as_ref()?.rows;
        Some(HoldFit::new(hold, rows.iter().find(|row| row.law == law)?.fit.as_ref().ok()?))
    };
    record.holds.iter().filter_map(fit).collect()
}

/// The parameters of the law of the record on every hold.
pub(super) fn parameters_of_holds(record: &ComparedRecord, answer: &Answer) -> Option<Table> {
    law_table(&fits_of_record(record, answer))
}

/// The parameters of one law on holds.
pub(super) fn law_table(fits: &[HoldFit<'_>]) -> Option<Table> {
    let law = fits.first()?.fit.law;
    let confidence = fits.iter().find_map(|one| Some(one.fit.uncertainty.as_ref()?.confidence)).unwrap_or(0.95);
    let caption = format!("Parameters of {law} on every hold, with {} intervals.", percent(confidence));
    let table = Table::of("law_of_record", caption, fits)
        .column("Hold", "hold", "", |one| Cell::Integer(one.hold.number as i64));
    let value = |one: &HoldFit<'_>, name: &str| {
        one.parameters.get(name).map_or(Cell::missing("not determined"), ParameterDocument::cell)
    };
    let ended = |one: &HoldFit<'_>| Cell::text(word(one.fit.termination).replace('_', " "));
    Some(parameter_columns(table, fits, value).column("Ended", "termination", "", ended).table())
}

/// Adds a column for each parameter that is estimated, and the rate coefficient.
pub(super) fn parameter_columns<'a, T>(
    mut table: Columns<'a, T>,
    fits: &[HoldFit<'_>],
    cell: impl Fn(&T, &str) -> Cell,
) -> Columns<'a, T> {
    let of_interest = |parameter: &&Parameter| {
        parameter.role == ParameterRole::Estimated || parameter.name.kind == ParameterKind::RateCoefficient
    };
    for parameter in fits.iter().take(1).flat_map(|one| one.fit.parameters.iter().filter(of_interest)) {
        let name = parameter.name.to_string();
        let unit = fits[0].parameters.get(&name).map_or("", |parameter| parameter.unit.as_str());
        let unit = if unit == "1" { "" } else { unit };
        table = table.estimates(heading(&name), name.clone(), unit, |row| cell(row, &name));
    }
    table
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
