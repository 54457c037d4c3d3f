//! Tables of compared laws.

use palpate::forecast::{Comparison, Ranking, Row, Verdict};
use palpate::laws::Law;

use crate::number::significant;
use crate::result::{ComparedHold, ComparedRecord, LeftOut, word};
use crate::study::{answer, findings};
use crate::table::{Cell, Columns, Table};
use crate::wrap::wrapped;

const NO_FIT: &str = "could not be fitted";
const NO_FORECAST: &str = "its first part could not be fitted, or no samples follow it";

/// What the columns mean; reported once below all tables.
pub(super) const NOTES: [&str; 3] = [
    "p: parameters of the law (of the spectrum those that the data determine). RMSE: root mean square residual of the fit to the whole hold, in % of the change.",
    "Held-out errors of fits to the first part of the hold (its share heads the column), over all later samples, in % of the change; score: their root mean square.",
    "ΔBIC at the effective number of samples, ΔAICc at all samples, each less the lowest. Merged: terms that are not distinguishable.",
];

fn percent(share: Option<f64>, digits: usize, reason: &str) -> Cell {
    Cell::number_or(share.filter(|share| share.is_finite()).map(|share| 100.0 * share), digits, reason)
}

/// How a fit ended, in a word or two.
fn ending(row: &Row) -> Cell {
    match &row.fit {
        _ if row.spectrum.is_some() => Cell::text("converged"),
        Err(_) => Cell::missing(NO_FIT),
        Ok(fit) => Cell::text(match word(fit.termination).as_str() {
            bound if bound.ends_with("_at_bound") => "at bound".to_owned(),
            "singular" => "merged".to_owned(),
            other => other.replace('_', " "),
        }),
    }
}

fn row_of(comparison: &Comparison, law: Law) -> Option<&Row> {
    comparison.rows.iter().find(|row| row.law == law)
}

/// Parameters of a law: a whole number, but for a smoothed spectrum.
fn parameters(row: &Row) -> Cell {
    if row.spectrum.is_some() {
        Cell::Number(row.effective_parameters, 2)
    } else {
        Cell::Integer(row.effective_parameters as i64)
    }
}

/// A law on a hold of a record.
type LawRow<'a> = (&'a ComparedRecord, &'a ComparedHold, &'a Comparison, &'a Row);

/// Adds the columns of a table of laws, with errors after these cuts (shares of the hold).
fn law_columns<'a>(table: Columns<'a, LawRow<'a>>, cuts: &[f64]) -> Table {
    let mut table = table
        .column("Law", "law", "", |(.., row)| Cell::text(row.law.to_string()))
        .column("p", "parameters", "", |(.., row)| parameters(row))
        .column("RMSE", "rmse_percent", "", |(.., found, row)| percent(Some(row.rmse / found.change), 2, NO_FIT))
        .column("ΔBIC", "delta_bic", "", |(.., row)| Cell::number_or(row.delta_bic, 3, NO_FIT))
        .column("ΔAICc", "delta_aicc", "", |(.., found, row)| {
            let lowest = found.rows.iter().filter_map(|row| row.criteria).map(|c| c.aicc).fold(f64::INFINITY, f64::min);
            let aicc = row.criteria.map(|criteria| criteria.aicc - lowest).filter(|delta| delta.is_finite());
            Cell::number_or(aicc, 3, NO_FIT)
        });
    for share in cuts {
        let heading = format!("{} %", significant(100.0 * share, 2));
        table = table.column(heading, format!("forward_error_at_{share:.3}_percent"), "", |(.., found, row)| {
            let cut = share * found.duration;
            let index = found.cuts.iter().position(|made| (made - cut).abs() < 1e-9 * found.duration);
            percent(index.and_then(|index| row.forward.relative(index, found.change)), 2, NO_FORECAST)
        });
    }
    if !cuts.is_empty() {
        table =
            table.column("Score", "forward_score_percent", "", |(.., row)| percent(row.forward.score, 2, NO_FORECAST));
    }
    table.column("Ended", "termination", "", |(.., row)| ending(row)).table()
}

/// The laws on one hold, best first.
pub(super) fn laws_of_hold(record: &ComparedRecord, hold: &ComparedHold) -> Option<Table> {
    let comparison = hold.comparison.as_ref()?;
    let (unit, factor) = hold.quantity.for_people(comparison.change);
    let change = significant(factor * comparison.change, 3);
    let caption = format!(
        "{}: {} samples of {} over {} s, which change it by {}.",
        hold.title(),
        comparison.samples,
        word(hold.quantity),
        significant(comparison.duration, 4),
        if unit.is_empty() { change } else { format!("{change} {unit}") }
    );
    let cuts: Vec<f64> = comparison.cuts.iter().map(|cut| cut / comparison.duration).collect();
    let rows: Vec<LawRow<'_>> = comparison.rows.iter().map(|row| (record, hold, comparison, row)).collect();
    Some(law_columns(Table::of(format!("laws_hold_{}", hold.number), caption, &rows), &cuts))
}

/// The laws on all holds of records, for machines: one row a record, hold and law.
pub(in crate::study) fn laws(records: &[ComparedRecord], cuts: &[f64]) -> Table {
    let mut rows: Vec<LawRow<'_>> = Vec::new();
    for record in records {
        for hold in &record.holds {
            let found = hold.comparison.iter().flat_map(|found| found.rows.iter().map(move |row| (found, row)));
            rows.extend(found.map(|(found, row)| (record, hold, found, row)));
        }
    }
    let table = Table::of("laws", "Every law on every hold.", &rows)
        .column("Record", "record", "", |(record, ..)| Cell::text(record.input.called()))
        .column("Hold", "hold", "", |(_, hold, ..)| Cell::Integer(hold.number as i64));
    law_columns(table, cuts)
}

/// What a hold will show next, and which law to use for it.
pub(super) fn sentences(comparison: &Comparison) -> impl Iterator<Item = String> {
    comparison.forecast_sentence().into_iter().chain(comparison.sentence())
}

/// All laws on the one hold of a record, for a terminal; nothing where there are several, for which the answer has a line each.
pub(in crate::study) fn verdict_text(record: &ComparedRecord) -> String {
    let judged: Vec<_> = record.verdicts().collect();
    match judged.as_slice() {
        [] => String::new(),
        [(hold, comparison)] => {
            let table = laws_of_hold(record, hold).map(|table| table.to_plain_text()).unwrap_or_default();
            let notes: String = NOTES.iter().map(|note| wrapped(note)).collect();
            let sentences: String = sentences(comparison).map(|sentence| wrapped(&sentence)).collect();
            format!("{table}{sentences}{notes}\n")
        }
        _ => String::new(),
    }
}

/// Compared records as text for a terminal: for each hold the table and what it says, then the findings.
#[must_use]
pub fn comparison_text(records: &[ComparedRecord], left_out: &[LeftOut]) -> String {
    let mut text = String::new();
    for record in records {
        let found = findings::gathered_of(record, findings::MOST_PLAIN);
        text.push_str(&format!("{}\n\n{}\n", record.input.called(), answer::answer_text(record, &found, false)));
        for hold in &record.holds {
            match laws_of_hold(record, hold) {
                Some(table) => text.push_str(&table.to_plain_text()),
                None => text.push_str(&format!("{}: nothing could be fitted.\n", hold.title())),
            }
            hold.comparison.iter().flat_map(sentences).for_each(|sentence| text.push_str(&wrapped(&sentence)));
            text.push('\n');
        }
        let found = findings::plain(&found);
        if !found.is_empty() {
            text.push_str(&format!("Findings\n{found}\n"));
        }
    }
    if records.iter().any(ComparedRecord::has_verdict) {
        NOTES.iter().for_each(|note| text.push_str(&wrapped(note)));
    }
    if !left_out.is_empty() {
        text.push_str(if text.is_empty() { "Left out\n" } else { "\nLeft out\n" });
        left_out.iter().for_each(|file| text.push_str(&wrapped(&left_out_line(file))));
    }
    text
}

/// A record and one of its holds.
type HoldRow<'a> = (&'a ComparedRecord, &'a ComparedHold);

fn hold_rows(records: &[ComparedRecord]) -> Vec<HoldRow<'_>> {
    records.iter().flat_map(|record| record.holds.iter().map(move |hold| (record, hold))).collect()
}

/// Columns of holds: the figure of each law, that of the best written by `best`, and the law to use.
fn hold_columns<'a>(
    rows: &'a [HoldRow<'a>],
    caption: &str,
    laws: &[Law],
    best: fn(String) -> String,
) -> Columns<'a, HoldRow<'a>> {
    let verdict = |hold: &ComparedHold, reported: fn(&Verdict) -> String| {
        let verdict = hold.comparison.as_ref().and_then(|found| found.verdict.as_ref());
        Cell::text(verdict.map_or("–".to_owned(), reported))
    };
    let mut columns = Table::of("comparison", caption, rows)
        .column("Record", "record", "", |(record, _)| Cell::text(record.input.called()))
        .column("Hold", "hold", "", |(_, hold)| Cell::Integer(hold.number as i64));
    for law in laws {
        columns = columns.column(law.to_string(), law.to_string(), "", |(_, hold)| {
            let reported = hold.comparison.as_ref().and_then(|found| overview(found, *law, best));
            Cell::text(reported.unwrap_or("–".to_owned()))
        });
    }
    columns
        .column("Law to use", "law", "", |(_, hold)| verdict(hold, |verdict| verdict.law.to_string()))
        .column("Sure", "certainty", "", |(_, hold)| verdict(hold, sure))
}

/// All holds of several records with the figure of each law, as the page shows them first.
pub(super) fn of_all_records(records: &[ComparedRecord], laws: &[Law]) -> Table {
    let caption = "Held-out error of each law in % of the change (in brackets: not at an optimum; Δ: difference of BIC where the hold is too \
                   short for a prediction), and the law to use.";
    let mut table = hold_columns(&hold_rows(records), caption, laws, |figure| figure).table();
    table.rows.extend(median_row(records, laws));
    table
}

/// One Markdown table of every record and hold, with a column a law.
#[must_use]
pub fn comparison_markdown(records: &[ComparedRecord], left_out: &[LeftOut], laws: &[Law]) -> String {
    let rows = hold_rows(records);
    let mut table = hold_columns(&rows, "", laws, |figure| format!("**{figure}**"))
        .column("Findings", "findings", "", |(record, hold)| {
            let all = record.findings.iter().chain(&hold.findings);
            let mut codes: Vec<String> = all.map(|finding| format!("`{}`", finding.code())).collect();
            codes.dedup();
            Cell::text(codes.join(", "))
        })
        .table();
    table.rows.extend(median_row(records, laws));
    let mut text = if table.rows.is_empty() { String::new() } else { table.to_markdown() };
    if !left_out.is_empty() {
        text.push_str(if text.is_empty() { "Left out:\n\n" } else { "\nLeft out:\n\n" });
        left_out.iter().for_each(|file| text.push_str(&format!("- {}\n", left_out_line(file))));
    }
    text
}

/// The median forward error of each law over the holds that are ranked by it, where there are several.
fn median_row(records: &[ComparedRecord], laws: &[Law]) -> Option<Vec<Cell>> {
    let judged = || records.iter().flat_map(ComparedRecord::verdicts).map(|(_, found)| found);
    let forward: Vec<&Comparison> = judged().filter(|found| found.ranking == Ranking::Forward).collect();
    if forward.len() < 3 {
        return None;
    }
    let mut cells = vec![Cell::text(format!("median of {} holds", forward.len())), Cell::text("")];
    for law in laws {
        let scores = forward.iter().flat_map(|found| &found.rows).filter(|row| row.law == *law);
        let mut scores: Vec<f64> = scores.filter_map(|row| row.forward.score).collect();
        scores.sort_by(f64::total_cmp);
        cells.push(Cell::text(match scores.len() {
            0 => "–".to_owned(),
            count => significant(100.0 * f64::midpoint(scores[(count - 1) / 2], scores[count / 2]), 2),
        }));
    }
    Some(cells)
}

/// A file that was left out with the first line of the reason.
pub(super) fn left_out_line(file: &LeftOut) -> String {
    format!("{}: {}", file.path, file.reason.lines().next().unwrap_or_default())
}

/// The figure of one law on one hold: forward error in %, or Δ and its excess of BIC; the best as `written`.
fn overview(comparison: &Comparison, law: Law, written: fn(String) -> String) -> Option<String> {
    let row = row_of(comparison, law)?;
    let figure = comparison.figure(row)?;
    let reported = match comparison.ranking {
        Ranking::Forward => significant(100.0 * figure, 2),
        Ranking::Information => format!("Δ{}", significant(figure, 2)),
    };
    let best = comparison.rows.iter().filter(|row| row.is_good()).find_map(|row| comparison.figure(row));
    // What did not end at an optimum is set apart: its figure may be good, its parameters are not.
    let reported = if row.is_good() { reported } else { format!("({reported})") };
    Some(if best == Some(figure) { written(reported) } else { reported })
}

fn sure(verdict: &Verdict) -> String {
    // What stands against every law goes before how this one compares with the others.
    let reserved = verdict.reservation.map_or_else(|| word(verdict.certainty), word);
    let sure = format!("{}, {:.0} %", reserved.replace('_', " "), 100.0 * verdict.probability);
    match verdict.indistinguishable.len() {
        1 => sure,
        alike => format!("{sure}, {} not distinguishable", alike - 1),
    }
}
