//! How a test is written, its columns, its sampling.

use std::fmt::Write as _;

use palpate_files::contents::Part;
use palpate_files::record_file::{RecordFile, Role};
use palpate_report::number::significant;
use palpate_report::table::{Cell, Table, TableColumn};

/// How one test is written, what stands beside its data, and what the file labels.
pub(super) fn part_facts(part: &Part) -> String {
    let mut out = String::new();
    if let Some(name) = &part.name {
        let _ = writeln!(out, "{name}");
    }
    if !part.written.is_empty() {
        let _ = writeln!(out, "{}", part.written);
    }
    for entry in &part.metadata {
        let unit = entry.unit.as_deref().unwrap_or("");
        let _ = writeln!(out, "  {} = {} {unit}", entry.name, entry.value);
    }
    for label in &part.labels {
        let _ = writeln!(out, "  rows {} to {}: {}", label.start + 1, label.end, label.name);
    }
    out.push('\n');
    out
}

pub(super) fn columns_table(part: &Part, file: Option<&RecordFile>) -> Table {
    let mut table = Table::new("columns", "Columns")
        .column(TableColumn::new("Column", "number", ""))
        .column(TableColumn::new("Name", "name", ""))
        .column(TableColumn::new("Unit", "unit", ""))
        .column(TableColumn::new("First value", "sample", ""))
        .column(TableColumn::new("Used as", "used_as", ""));
    for column in &part.columns {
        let used = file.and_then(|file| file.columns.iter().find(|used| used.number == column.number));
        let role = used.map_or(String::new(), |used| {
            let sign = if used.sign < 0.0 { ", sign turned" } else { "" };
            let what = match used.role {
                Role::Values(quantity) => quantity.to_string(),
                Role::Added(quantity) => format!("added to {quantity}"),
                Role::ClockOf(quantity) => format!("time of {quantity}"),
            };
            format!("{what} in {}{sign}", used.unit)
        });
        table = table.row(vec![
            Cell::Integer(column.number as i64),
            Cell::text(column.name.as_deref().unwrap_or("")),
            Cell::text(column.unit.as_deref().unwrap_or("")),
            Cell::text(column.sample.as_str()),
            Cell::text(role),
        ]);
    }
    table
}

pub(super) fn signal_facts(file: &RecordFile) -> String {
    let record = &file.record;
    let time = record.time();
    let steps = time.windows(2).map(|pair| pair[1] - pair[0]);
    let (low, high) = steps.fold((f64::MAX, 0.0f64), |(low, high), step| (low.min(step), high.max(step)));
    let range = |values: &[f64], factor: f64| {
        let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
        format!("{} to {}", significant(low * factor, 4), significant(high * factor, 4))
    };
    let mut out = format!(
        "{} rows over {} s, every {} s (from {} to {} s)\n",
        file.rows,
        significant(time[time.len() - 1] - time[0], 5),
        significant(record.sample_interval(), 3),
        significant(low, 3),
        significant(high, 3)
    );
    if let Some(start) = file.start {
        let _ = writeln!(out, "time 0 is {start} s since 1970");
    }
    if file.averaged > 1 {
        let _ = writeln!(out, "every sample is the mean of {} successive rows", file.averaged);
    }
    if let Some(displacement) = record.displacement() {
        let _ = writeln!(out, "displacement {} mm", range(displacement, 1e3));
    }
    let _ = writeln!(out, "force {} N", range(record.force(), 1.0));
    if let Some(footer) = &file.ignored.footer {
        let _ =
            writeln!(out, "{} lines after the data were passed over, from line {}", footer.lines, footer.first_line);
    }
    out.push('\n');
    out
}
