//! Tables as aligned text for a terminal.

use super::{Cell, Table, mark};

/// Room between columns.
const GUTTER: &str = "  ";

pub(crate) fn write(table: &Table) -> String {
    let columns = table.columns.len();
    let reasons = table.reasons();
    let heads: Vec<String> = table.columns.iter().map(super::TableColumn::title).collect();
    let body: Vec<Vec<String>> = (0..table.rows.len())
        .map(|row| (0..columns).map(|c| shown(table.cell(row, c), &reasons)).collect())
        .collect();
    let widths: Vec<usize> = (0..columns)
        .map(|c| {
            let cells = body.iter().map(|row| extent(&row[c]));
            cells.chain([extent(&heads[c])]).max().unwrap_or(0)
        })
        .collect();
    let right: Vec<bool> = (0..columns).map(|c| table.is_numeric(c)).collect();
    let total = widths.iter().sum::<usize>() + GUTTER.len() * columns.saturating_sub(1);

    let mut out = String::new();
    if !table.caption.is_empty() {
        out.push_str(&wrapped(&table.caption, total));
    }
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
        out.push_str(&wrapped(note, total));
    }
    out
}

/// Sentences in lines as wide as the table, but never narrower than they are read.
fn wrapped(text: &str, width: usize) -> String {
    let width = width.clamp(72, 100);
    let (mut out, mut used) = (String::new(), 0);
    for word in text.split_whitespace() {
        let length = extent(word);
        if used > 0 && used + 1 + length > width {
            out.push('\n');
            used = 0;
        } else if used > 0 {
            out.push(' ');
            used += 1;
        }
        out.push_str(word);
        used += length;
    }
    out.push('\n');
    out
}

/// A cell in one line, with the mark of its reason when it is missing.
fn shown(cell: &Cell, reasons: &[&str]) -> String {
    let index = match cell {
        Cell::Missing(reason) => reasons.iter().position(|r| r == reason),
        _ => None,
    };
    let text = cell.shown().split_whitespace().collect::<Vec<_>>().join(" ");
    index.map_or(text.clone(), |i| format!("{text} [{}]", mark(i)))
}

/// Number of places a text takes in a terminal; accents that sit on a letter take none.
fn extent(text: &str) -> usize {
    text.chars().filter(|c| !('\u{300}'..='\u{36F}').contains(c)).count()
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
    use super::super::{Cell, Table, TableColumn};

    #[test]
    fn columns_line_up_and_reasons_follow() {
        let text = Table::new("law", "Fitted law.")
            .column(TableColumn::new("Specimen", "specimen", ""))
            .column(TableColumn::new("Force", "force_n", "N"))
            .row(vec![Cell::text("pad\nA"), Cell::number(-12.5, 3)])
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
