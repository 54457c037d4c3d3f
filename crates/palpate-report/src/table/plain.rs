//! Tables as aligned text for a terminal.
//!
//! A table that is wider than the terminal breaks its headings over several lines; where that is not enough it goes on below itself
//! with the columns again that tell its rows apart.

use std::collections::HashSet;

use super::{Cell, Table, mark};
use crate::wrap::{extent, indented};

/// Room between columns.
const GUTTER: &str = "  ";

/// One column of text.
struct Column {
    heading: String,
    cells: Vec<String>,
    is_numeric: bool,
    /// Width of its cells, and of its heading or the longest word of that.
    width: usize,
}

pub(crate) fn write(table: &Table, width: usize) -> String {
    let reasons = table.reasons();
    let columns = columns(table, &reasons, width);
    let blocks = blocks(&columns, width);
    let widest = blocks.iter().map(|block| extent_of(&columns, block)).max().unwrap_or(0);
    // Sentences are as wide as the table, but never narrower than they are read.
    let sentence = |text: &str| indented("", 0, widest.clamp(72, 100).min(width), text);

    let mut out = if table.caption.is_empty() { String::new() } else { sentence(&table.caption) };
    for (index, block) in blocks.iter().enumerate() {
        if index > 0 {
            out.push('\n');
        }
        let rule = format!("{}\n", "─".repeat(extent_of(&columns, block)));
        let columns: Vec<&Column> = block.iter().map(|column| &columns[*column]).collect();
        out.push_str(&rule);
        head(&mut out, &columns);
        out.push_str(&rule);
        for row in 0..table.rows.len() {
            line(&mut out, &columns, |column| &column.cells[row]);
        }
        out.push_str(&rule);
    }
    for (i, reason) in reasons.iter().enumerate() {
        out.push_str(&format!("[{}] {reason}\n", mark(i)));
    }
    for note in &table.notes {
        out.push_str(&sentence(note));
    }
    out
}

/// The columns of a table; their headings are broken where the whole would not fit.
fn columns(table: &Table, reasons: &[&str], width: usize) -> Vec<Column> {
    let units = table.units();
    let of = |(index, (unit, factor)): (usize, &(&str, f64))| {
        let heading = table.columns[index].title(unit);
        let cells: Vec<String> =
            (0..table.rows.len()).map(|row| shown(table.cell(row, index), *factor, reasons)).collect();
        let widest = cells.iter().map(|cell| extent(cell)).max().unwrap_or(0);
        Column {
            width: widest.max(extent(&heading)),
            is_numeric: table.is_numeric(index),
            heading,
            cells,
        }
    };
    let mut columns: Vec<Column> = units.iter().enumerate().map(of).collect();
    let all: Vec<usize> = (0..columns.len()).collect();
    if extent_of(&columns, &all) > width {
        for column in &mut columns {
            let words = column.heading.split_whitespace().map(extent).max().unwrap_or(0);
            column.width = column.cells.iter().map(|cell| extent(cell)).fold(words, usize::max);
        }
    }
    columns
}

/// Most columns that a table repeats where it goes on below.
const MOST_KEYS: usize = 3;

/// How many of the first columns differ from row to row taken together, and leave half the width to others; one where none do.
fn keys(columns: &[Column], width: usize) -> usize {
    let rows = columns.first().map_or(0, |column| column.cells.len());
    let differs = |count: &usize| {
        let key = |row: usize| columns[..*count].iter().map(|column| column.cells[row].as_str()).collect::<Vec<_>>();
        let distinct: HashSet<Vec<&str>> = (0..rows).map(key).collect();
        let repeated: Vec<usize> = (0..*count).collect();
        distinct.len() == rows && 2 * extent_of(columns, &repeated) <= width
    };
    (1..=MOST_KEYS.min(columns.len())).find(differs).unwrap_or(1)
}

/// Which columns stand beside each other: all of them where they fit, otherwise those that identify a row with as many as fit, again
/// and again.
fn blocks(columns: &[Column], width: usize) -> Vec<Vec<usize>> {
    let keys = keys(columns, width);
    let mut blocks: Vec<Vec<usize>> = vec![Vec::new()];
    for index in 0..columns.len() {
        let fits = |block: &[usize]| {
            let with: Vec<usize> = block.iter().copied().chain([index]).collect();
            extent_of(columns, &with) <= width
        };
        match blocks.last_mut() {
            Some(block) if block.len() <= keys || fits(block) => block.push(index),
            _ => blocks.push((0..keys).chain([index]).collect()),
        }
    }
    blocks
}

fn extent_of(columns: &[Column], block: &[usize]) -> usize {
    let widths: usize = block.iter().map(|column| columns[*column].width).sum();
    widths + GUTTER.len() * block.len().saturating_sub(1)
}

/// The headings, in as many lines as the longest needs, flush with the cells below.
fn head(out: &mut String, columns: &[&Column]) {
    let broken: Vec<Vec<String>> = columns
        .iter()
        .map(|column| indented("", 0, column.width, &column.heading).lines().map(str::to_owned).collect())
        .collect();
    let deepest = broken.iter().map(Vec::len).max().unwrap_or(0);
    for row in 0..deepest {
        let texts: Vec<&str> = broken
            .iter()
            .map(|lines| (row + lines.len()).checked_sub(deepest).map_or("", |at| lines[at].as_str()))
            .collect();
        aligned(out, columns, &texts);
    }
}

fn line<'a>(out: &mut String, columns: &[&'a Column], cell: impl Fn(&'a Column) -> &'a String) {
    let texts: Vec<&str> = columns.iter().map(|column| cell(column).as_str()).collect();
    aligned(out, columns, &texts);
}

fn aligned(out: &mut String, columns: &[&Column], texts: &[&str]) {
    let padded: Vec<String> = columns
        .iter()
        .zip(texts)
        .map(|(column, text)| {
            let fill = " ".repeat(column.width - extent(text).min(column.width));
            if column.is_numeric { format!("{fill}{text}") } else { format!("{text}{fill}") }
        })
        .collect();
    out.push_str(padded.join(GUTTER).trim_end());
    out.push('\n');
}

/// A cell in one line, with the mark of its reason when it is missing.
fn shown(cell: &Cell, factor: f64, reasons: &[&str]) -> String {
    let text = cell.shown(factor).split_whitespace().collect::<Vec<_>>().join(" ");
    match cell.reason_in(reasons) {
        Some(i) => format!("{text} [{}]", mark(i)),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Cell, Table};
    use super::write;

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
    fn a_wide_table_breaks_its_headings_and_then_goes_on_below() {
        let table = Table::new("t", "")
            .column("Hold", "hold", "")
            .column("Force at the start of the fit", "start_n", "N")
            .column("Force at the end", "end_n", "N")
            .row(vec![Cell::Integer(1), Cell::Number(2.0, 3), Cell::Number(1.0, 3)]);
        assert_eq!(write(&table, 80).lines().count(), 5);
        let narrow = write(&table, 30);
        assert!(narrow.lines().all(|line| line.chars().count() <= 30), "{narrow}");
        assert!(narrow.contains("Force") && narrow.contains("(N)"), "{narrow}");
        let narrower = write(&table, 14);
        assert_eq!(narrower.lines().filter(|line| line.starts_with("   1")).count(), 2, "{narrower}");
    }

    /// Rows of several laws on one hold could not be matched: only the number of the hold was repeated.
    #[test]
    fn what_goes_on_below_repeats_the_columns_that_identify_a_row() {
        let row = |law: &str| vec![Cell::Integer(1), Cell::text(law), Cell::Number(2.0, 3), Cell::Number(3.0, 3)];
        let table = Table::new("t", "")
            .column("Hold", "hold", "")
            .column("Law", "law", "")
            .column("Equilibrium", "equilibrium", "")
            .column("Amplitude", "amplitude", "")
            .row(row("power"))
            .row(row("maxwell"));
        let narrow = write(&table, 28);
        assert_eq!((narrow.matches("power").count(), narrow.matches("Hold").count()), (2, 2), "{narrow}");
    }

    #[test]
    fn a_table_without_columns_is_still_text() {
        assert!(Table::new("none", "").to_plain_text().ends_with('\n'));
    }
}
