//! Tables of compared laws.

use palpate::forecast::{Certainty, Comparison, Ranking, Row, Verdict};
use palpate::laws::Law;

use crate::number::significant;
use crate::result::{ComparedHold, ComparedRecord, LeftOut, word};
use crate::study::findings;
use crate::table::{Cell, Table, TableColumn};
use crate::wrap::wrapped;

const NO_FIT: &str = "could not be fitted";
const NO_FORECAST: &str = "its first part could not be fitted, or leaves nothing to foretell";

/// What the columns mean; told once below all tables.
pub(super) const NOTES: [&str; 3] = [
    "p: numbers of the law (of the spectrum those that the data determine). RMSE: what the fit to the whole hold leaves over, in % of the change.",
    "Errors after fits to the first part of the hold (its share stands above), over all that follows, in % of the change; score: their root mean square.",
    "ΔBIC at the effective number of samples, ΔAICc at all samples, each less the lowest. Merged: terms that the data cannot tell apart.",
];

fn column(heading: impl Into<String>, key: impl Into<String>, unit: &str) -> TableColumn {
    TableColumn::new(heading, key, unit)
}

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

/// Numbers of a law: a whole one, but for a smoothed spectrum.
fn parameters(row: &Row) -> Cell {
    if row.spectrum.is_some() {
        Cell::number(row.numbers, 2)
    } else {
        Cell::Integer(row.numbers as i64)
    }
}

/// The columns of a table of laws, with errors after these cuts (shares of the hold).
fn law_columns(table: Table, cuts: &[f64]) -> Table {
    let mut table = table
        .column(column("Law", "law", ""))
        .column(column("p", "parameters", ""))
        .column(column("RMSE", "rmse_percent", ""))
        .column(column("ΔBIC", "delta_bic", ""))
        .column(column("ΔAICc", "delta_aicc", ""));
    for cut in cuts {
        let heading = format!("{} %", significant(100.0 * cut, 2));
        table = table.column(column(heading, format!("forward_error_at_{cut:.3}_percent"), ""));
    }
    if !cuts.is_empty() {
        table = table.column(column("Score", "forward_score_percent", ""));
    }
    table.column(column("Ended", "termination", ""))
}

fn law_row(row: &Row, comparison: &Comparison, cuts: &[f64]) -> Vec<Cell> {
    let lowest = comparison.rows.iter().filter_map(|row| row.criteria).map(|c| c.aicc).fold(f64::INFINITY, f64::min);
    let aicc = row.criteria.map(|criteria| criteria.aicc - lowest).filter(|delta| delta.is_finite());
    let mut cells = vec![
        Cell::text(row.law.to_string()),
        parameters(row),
        percent(Some(row.rmse / comparison.change), 2, NO_FIT),
        Cell::number_or(row.delta_bic, 3, NO_FIT),
        Cell::number_or(aicc, 3, NO_FIT),
    ];
    for share in cuts {
        let cut = share * comparison.duration;
        let index = comparison.cuts.iter().position(|found| (found - cut).abs() < 1e-9 * comparison.duration);
        let error = index.and_then(|index| row.forward.relative(index, comparison.change));
        cells.push(percent(error, 2, NO_FORECAST));
    }
    if !cuts.is_empty() {
        cells.push(percent(row.forward.score, 2, NO_FORECAST));
    }
    cells.push(ending(row));
    cells
}

/// The laws on one hold, best first.
pub(super) fn laws_of_hold(hold: &ComparedHold) -> Option<Table> {
    let comparison = hold.comparison.as_ref()?;
    let (unit, factor) = hold.quantity.for_people();
    let change = significant(factor * comparison.change, 3);
    let caption = format!(
        "{}: {} samples of {} over {} s, which change it by {}.",
        hold.title(),
        comparison.samples,
        hold.quantity.name(),
        significant(comparison.duration, 4),
        if unit.is_empty() { change } else { format!("{change} {unit}") }
    );
    let cuts: Vec<f64> = comparison.cuts.iter().map(|cut| cut / comparison.duration).collect();
    let table = law_columns(Table::new(format!("laws_hold_{}", hold.number), caption), &cuts);
    Some(comparison.rows.iter().fold(table, |table, row| table.row(law_row(row, comparison, &cuts))))
}

/// The laws on all holds of records, for machines: one row a record, hold and law.
pub(in crate::study) fn laws(records: &[ComparedRecord], cuts: &[f64]) -> Table {
    let table = Table::new("laws", "Every law on every hold.")
        .column(column("Record", "record", ""))
        .column(column("Hold", "hold", ""));
    let mut table = law_columns(table, cuts);
    for record in records {
        for hold in &record.holds {
            for row in hold.comparison.iter().flat_map(|comparison| &comparison.rows) {
                let comparison = hold.comparison.as_ref();
                let mut cells = vec![Cell::text(record.input.called()), Cell::Integer(hold.number as i64)];
                cells.extend(comparison.map(|comparison| law_row(row, comparison, cuts)).unwrap_or_default());
                table = table.row(cells);
            }
        }
    }
    table
}

/// Which law to use on each hold of a record: one row a hold.
pub(in crate::study) fn verdicts(record: &ComparedRecord) -> Option<Table> {
    let mut table = Table::new("verdicts", "Which law to use, hold by hold.")
        .column(column("Hold", "hold", ""))
        .column(column("Law to use", "law", ""))
        .column(column("p", "parameters", ""))
        .column(column("Foretells to", "forward_score_percent", "%"))
        .column(column("Sure", "certainty", ""))
        .column(column("Laws as good", "alike", ""))
        .column(column("Best at cuts", "cuts_won", ""));
    for (hold, comparison) in record.verdicts() {
        let Some(verdict) = &comparison.verdict else { continue };
        let chosen = comparison.rows.iter().find(|row| row.law == verdict.law);
        table = table.row(vec![
            Cell::Integer(hold.number as i64),
            Cell::text(verdict.law.to_string()),
            chosen.map_or(Cell::missing(NO_FIT), parameters),
            percent(chosen.and_then(|row| row.forward.score), 2, "too short to foretell: ranked by BIC"),
            Cell::text(word(verdict.certainty)),
            Cell::Integer(verdict.alike.len() as i64 - 1),
            Cell::text(format!("{} of {}", verdict.cuts_won, comparison.cuts.len())),
        ]);
    }
    (!table.rows.is_empty()).then_some(table)
}

/// Which law to use, for a terminal: the table of all laws where there is one hold, else one row a hold.
pub(in crate::study) fn verdict_text(record: &ComparedRecord) -> String {
    let judged: Vec<_> = record.verdicts().collect();
    match judged.as_slice() {
        [] => String::new(),
        [(hold, comparison)] => {
            let table = laws_of_hold(hold).map(|table| table.to_plain_text()).unwrap_or_default();
            let notes: String = NOTES.iter().map(|note| wrapped(note)).collect();
            let sentence = comparison.sentence().map(|sentence| wrapped(&sentence)).unwrap_or_default();
            format!("{table}{sentence}{notes}\n")
        }
        _ => verdicts(record).map(|table| format!("{}\n", table.to_plain_text())).unwrap_or_default(),
    }
}

/// Compared records as text for a terminal: for each hold the table and what it says, then the findings.
#[must_use]
pub fn comparison_text(records: &[ComparedRecord], left_out: &[LeftOut]) -> String {
    let mut text = String::new();
    for record in records {
        text.push_str(&format!("{}\n\n", record.input.called()));
        for hold in &record.holds {
            match laws_of_hold(hold) {
                Some(table) => text.push_str(&table.to_plain_text()),
                None => text.push_str(&format!("{}: nothing could be fitted.\n", hold.title())),
            }
            if let Some(sentence) = hold.comparison.as_ref().and_then(Comparison::sentence) {
                text.push_str(&wrapped(&sentence));
            }
            text.push('\n');
        }
        let found = findings::plain_of(record);
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

/// One Markdown table of every record and hold, with a column a law.
#[must_use]
pub fn comparison_markdown(records: &[ComparedRecord], left_out: &[LeftOut], laws: &[Law]) -> String {
    let mut table = Table::new("comparison", "")
        .column(column("Record", "record", ""))
        .column(column("Hold", "hold", ""));
    table = laws.iter().fold(table, |table, law| table.column(column(law.to_string(), law.to_string(), "")));
    table = table
        .column(column("Law to use", "law", ""))
        .column(column("Sure", "certainty", ""))
        .column(column("Findings", "findings", ""));
    for record in records {
        for hold in &record.holds {
            table = table.row(overview_row(record, hold, laws));
        }
    }
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
        let median = match scores.len() {
            0 => None,
            count => Some(f64::midpoint(scores[(count - 1) / 2], scores[count / 2])),
        };
        cells.push(Cell::text(median.map_or("–".to_owned(), |median| significant(100.0 * median, 2))));
    }
    Some(cells)
}

/// A file that was left out with the first line of the reason.
pub(super) fn left_out_line(file: &LeftOut) -> String {
    format!("{}: {}", file.path, file.reason.lines().next().unwrap_or_default())
}

fn overview_row(record: &ComparedRecord, hold: &ComparedHold, laws: &[Law]) -> Vec<Cell> {
    let comparison = hold.comparison.as_ref();
    let verdict = comparison.and_then(|comparison| comparison.verdict.as_ref());
    let mut cells = vec![Cell::text(record.input.called()), Cell::Integer(hold.number as i64)];
    for law in laws {
        cells.push(Cell::text(comparison.map_or("–".to_owned(), |comparison| overview(comparison, *law))));
    }
    cells.push(Cell::text(verdict.map_or("–".to_owned(), |verdict| verdict.law.to_string())));
    cells.push(Cell::text(verdict.map_or("–".to_owned(), sure)));
    let mut codes: Vec<String> = record
        .findings
        .iter()
        .chain(&hold.findings)
        .map(|finding| format!("`{}`", finding.code()))
        .collect();
    codes.dedup();
    cells.push(Cell::text(codes.join(", ")));
    cells
}

/// The figure of one law on one hold: forward error in %, or Δ and its excess of BIC; the best in bold.
fn overview(comparison: &Comparison, law: Law) -> String {
    let Some(row) = comparison.rows.iter().find(|row| row.law == law) else {
        return "–".to_owned();
    };
    let Some(figure) = comparison.figure(row) else {
        return "–".to_owned();
    };
    let told = match comparison.ranking {
        Ranking::Forward => significant(100.0 * figure, 2),
        Ranking::Information => format!("Δ{}", significant(figure, 2)),
    };
    let best = comparison.rows.iter().filter(|row| row.is_good()).find_map(|row| comparison.figure(row));
    // What did not end at an optimum is set apart: its figure may be good, its numbers are not.
    let told = if row.is_good() { told } else { format!("({told})") };
    if best == Some(figure) { format!("**{told}**") } else { told }
}

fn sure(verdict: &Verdict) -> String {
    match (verdict.certainty, verdict.alike.len()) {
        (Certainty::Clear | Certainty::Likely, 1) => word(verdict.certainty),
        (certainty, alike) => format!("{}, {} as good", word(certainty), alike - 1),
    }
}
