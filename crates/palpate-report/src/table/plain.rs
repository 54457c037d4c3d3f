//! Tables as aligned text for a terminal.

use super::{Cell, Table, mark};
use crate::wrap::{extent, indented};

/// Room between columns.
const GUTTER: &str = "  ";

pub(crate) fn write(table: &Table) -> String {
    let columns = table.columns.len();
    let reasons = table.reasons();
    let heads: Vec<String> = table.columns.iter().map(super::TableColumn::title).collect();
    let row = |row: usize| -> Vec<String> { (0..columns).map(|c| shown(table.cell(row, c), &reasons)).collect() };
    let body: Vec<Vec<String>> = (0..table.rows.len()).map(row).collect();
    let widest = |c: usize| body.iter().map(|row| extent(&row[c])).fold(extent(&heads[c]), usize::max);
    let widths: Vec<usize> = (0..columns).map(widest).collect();
    let right: Vec<bool> = (0..columns).map(|c| table.is_numeric(c)).collect();
    let total = widths.iter().sum::<usize>() + GUTTER.len() * columns.saturating_sub(1);
    // Sentences are as wide as the table, but never narrower than they are read.
    let sentence = |text: &str| indented("", 0, total.clamp(72, 100), text);

    let mut out = if table.caption.is_empty() { String::new() } else { sentence(&table.caption) };
    let rule = format!("{}\n", "─".repeat(total));
    out.push_str(&rule);
    line(&mut out, &heads, &widths, &right);
    out.push_str(&rule);
    for row in &body {
        line(&mut out, row, &widths, &right);
    }
    out.push_str(&rule);
    for (i, reason) in reasons.iter().enumerate() {
        out.push_str(&format!("[{}] {reason}\n", mark(i)));
    }
    for note in &table.notes {
        out.push_str(&sentence(note));
    }
    out
}

/// A cell in one line, with the mark of its reason when it is missing.
fn shown(cell: &Cell, reasons: &[&str]) -> String {
    let text = cell.shown().split_whitespace().collect::<Vec<_>>().join(" ");
    match cell.reason_in(reasons) {
        Some(i) => format!("{text} [{}]", mark(i)),
        None => text,
    }
}

fn line(out: &mut String, cells: &[String], widths: &[usize], right: &[bool]) {
    let padded: Vec<String> = cells
        .iter()
        .zip(widths)
        .zip(right)
        .map(|((cell, width), right)| {
            let fill = " ".repeat(width - extent(cell).min(*width));
            if *right { format!("{fill}{cell}") } else { format!("{cell}{fill}") }
        })
        .collect();
    out.push_str(padded.join(GUTTER).trim_end());
    out.push('\n');
}

#[cfg(test)]
mod tests {
    use super::super::{Cell, Table};

    #[test]
    fn columns_line_up_and_reasons_follow() {
        let text = Table::new("law", "Fitted law.")
            .column("Specimen", "specimen", "")
            .column("Force", "force_n", "N")
            .row(vec![Cell::text("pad\nA"), Cell::Number(-12.5, 3)])
            .row(vec![Cell::text("B"), Cell::missing("no contact")])
            .note("Room temperature.")
            .to_plain_text();
        let expected = "Fitted law.\n\
            ───────────────────\n\
            Specimen  Force (N)\n\
            ───────────────────\n\
            pad A         −12.5\n\
            B             – [a]\n\
            ───────────────────\n\
            [a] no contact\n\
            Room temperature.\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn a_table_without_columns_is_still_text() {
        assert!(Table::new("none", "").to_plain_text().ends_with('\n'));
    }
}
