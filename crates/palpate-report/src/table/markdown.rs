//! Tables as Markdown.

use super::Table;

pub(crate) fn write(table: &Table) -> String {
    let units = table.units();
    let heads: Vec<String> = table.columns.iter().zip(&units).map(|(column, (unit, _))| column.title(unit)).collect();
    let rules = (0..table.columns.len()).map(|c| if table.is_numeric(c) { "--:" } else { "---" }.to_owned());
    let mut out = line(heads.into_iter());
    out.push_str(&line(rules));
    for row in 0..table.rows.len() {
        out.push_str(&line((0..table.columns.len()).map(|column| table.cell(row, column).shown(units[column].1))));
    }
    out
}

/// One row; a bar inside a cell would end it.
fn line(cells: impl Iterator<Item = String>) -> String {
    let cells: Vec<String> = cells.map(|cell| cell.replace('|', "\\|").replace('\n', " ")).collect();
    format!("| {} |\n", cells.join(" | "))
}

#[cfg(test)]
mod tests {
    use super::super::{Cell, Table};

    #[test]
    fn numbers_stand_right_and_bars_are_kept() {
        let text = Table::new("t", "")
            .column("Law", "law", "")
            .column("Force", "force_n", "N")
            .row(vec![Cell::text("a|b"), Cell::Number(1.25, 2)])
            .row(vec![Cell::text("**c**"), Cell::missing("none")])
            .to_markdown();
        assert_eq!(text, "| Law | Force (N) |\n| --- | --: |\n| a\\|b | 1.2 |\n| **c** | – |\n");
    }
}
