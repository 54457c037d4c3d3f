//! How a test is written, its columns, its sampling.

use std::fmt::Write as _;

use palpate::record::{SignalReport, Stamps, Values};
use palpate_files::open::Format;
use palpate_files::record::{RecordFile, Role};
use palpate_files::table::{ColumnInfo, ColumnKind, Part};
use palpate_report::number::{counted, significant};
use palpate_report::table::{Cell, Table};
use palpate_report::wrapped;

/// Most named values that are shown: force curves of an AFM have hundreds.
const MOST_METADATA: usize = 16;

/// Most letters of a name in a table.
const MOST_LETTERS: usize = 48;

/// How one test is written, what stands beside its data, and what the file labels.
pub(super) fn part_facts(part: &Part, format: Format) -> String {
    let mut out = String::new();
    if let Some(name) = &part.name {
        let _ = writeln!(out, "{name}");
    }
    // Where nothing is to be stated beyond the format, it was stated.
    if !part.written.is_empty() && part.written != format.to_string() {
        let _ = writeln!(out, "{}", part.written);
    }
    let shown = if part.metadata.len() > MOST_METADATA { MOST_METADATA - 1 } else { MOST_METADATA };
    for entry in part.metadata.iter().take(shown) {
        let unit = entry.unit.as_ref().map_or(String::new(), |unit| format!(" {unit}"));
        let _ = writeln!(out, "  {} = {}{unit}", entry.name, entry.value);
    }
    if part.metadata.len() > shown {
        let _ = writeln!(out, "  … and {} more named values", part.metadata.len() - shown);
    }
    for label in &part.labels {
        let _ = writeln!(out, "  rows {} to {}: {}", label.start + 1, label.end, label.name);
    }
    out.push('\n');
    out
}

pub(super) fn columns_table(part: &Part, file: Option<&RecordFile>) -> Table {
    Table::of("columns", "Columns", &part.columns)
        .column("Column", "number", "", |column| Cell::Integer(column.number as i64))
        .column("Name", "name", "", |column| Cell::text(short(column.name.as_deref())))
        .column("Unit", "unit", "", |column| Cell::text(short(column.unit.as_deref())))
        .column("First value", "sample", "", |column| Cell::text(column.first_value()))
        .column("Used as", "used_as", "", |column| Cell::text(roles(column, file)))
        .table()
}

/// A name as a table shows it: every row is as wide as the longest.
pub(super) fn short(text: Option<&str>) -> String {
    let mut letters = text.unwrap_or_default().chars();
    let mut short: String = letters.by_ref().take(MOST_LETTERS).collect();
    if letters.next().is_some() {
        short.push('…');
    }
    short
}

/// What a column is used as: one can be force and deflection of a cantilever.
fn roles(column: &ColumnInfo, file: Option<&RecordFile>) -> String {
    let used = file.into_iter().flat_map(|file| &file.columns).filter(|used| used.number == column.number);
    let roles = used.map(|used| {
        let sign = if used.sign < 0.0 { ", sign turned" } else { "" };
        let what = match used.role {
            Role::Values(quantity) => match used.spring_constant {
                Some(spring_constant) => {
                    format!("{quantity}, {} N/m times the deflection,", significant(spring_constant, 4))
                }
                None => quantity.to_string(),
            },
            Role::Added(quantity) => format!("added to {quantity}"),
            Role::Deflection => "deflection, off the displacement,".to_owned(),
            Role::ClockOf(quantity) => format!("time of {quantity}"),
        };
        match column.kind {
            ColumnKind::DateTime => format!("{what}, from a {}", used.unit),
            _ => format!("{what} in {}{sign}", used.unit),
        }
    });
    roles.collect::<Vec<_>>().join("; ")
}

/// What a record is like; where its clocks differ its columns are looked at with both put right.
pub(super) fn signal_facts(file: &RecordFile, aligned: Option<&SignalReport>) -> String {
    let record = &file.record;
    let time = record.time();
    let steps = time.windows(2).map(|pair| pair[1] - pair[0]);
    let (low, high) = steps.fold((f64::MAX, 0.0f64), |(low, high), step| (low.min(step), high.max(step)));
    let range = |values: &[f64], factor: f64| {
        let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
        format!("{} to {}", significant(low * factor, 4), significant(high * factor, 4))
    };
    let [low, usual, high] = [low, record.sample_interval(), high].map(|step| significant(step, 3));
    let varying = if low == high { String::new() } else { format!(" (from {low} to {high} s)") };
    let duration = significant(time[time.len() - 1] - time[0], 5);
    let mut out = format!("{} rows over {duration} s, every {usual} s{varying}\n", file.rows);
    if let Some(start) = file.start {
        // A day has 86,400 s: less is a time of day.
        let since = if start < 86_400.0 { "midnight" } else { "1970" };
        let _ = writeln!(out, "time 0 is {start} s since {since}");
    }
    if let Some(displacement) = record.displacement() {
        let _ = writeln!(out, "displacement {} mm", range(displacement, 1e3));
    }
    let _ = writeln!(out, "force {} N", range(record.force(), 1.0));
    stamp_facts(&mut out, &file.signals.stamps, "");
    if let Some(stamps) = &file.signals.force_stamps {
        stamp_facts(&mut out, stamps, " of the force");
    }
    let values = aligned.unwrap_or(&file.signals);
    if let Some(displacement) = &values.displacement {
        value_facts(&mut out, "displacement", displacement, (1e3, "mm"));
    }
    value_facts(&mut out, "force", &values.force, (1.0, "N"));
    record.corrections().iter().for_each(|done| out.push_str(&wrapped(&format!("done: {done}"))));
    if file.ignored.comments > 0 {
        let _ = writeln!(out, "{} below the header skipped", counted(file.ignored.comments, "comment line"));
    }
    if let Some(footer) = &file.ignored.footer {
        let _ = writeln!(out, "{} lines after the data were skipped, from line {}", footer.lines, footer.first_line);
    }
    out.push('\n');
    out
}

/// What is wrong with time stamps; nothing where all is well.
fn stamp_facts(out: &mut String, stamps: &Stamps, of: &str) {
    if let Some(interval) = stamps.interval.filter(|interval| interval.irregular) {
        let (low, high) = (significant(interval.p5, 3), significant(interval.p95, 3));
        let _ = writeln!(out, "irregular time stamps{of}: nine in ten intervals last {low} to {high} s");
    }
    if let Some(from) = stamps.gaps.from {
        let (count, longest) = (stamps.gaps.count, significant(stamps.gaps.longest, 3));
        let from = significant(from, 5);
        let _ = match count {
            1 => writeln!(out, "a gap in the time stamps{of} of {longest} s from {from} s"),
            _ => writeln!(out, "{count} gaps in the time stamps{of}, the longest {longest} s from {from} s"),
        };
    }
    if stamps.repeated > 0 {
        let _ = match stamps.repeated {
            1 => writeln!(out, "a time stamp{of} repeats the one before"),
            count => writeln!(out, "{count} time stamps{of} repeat the one before"),
        };
    }
    if stamps.reversals.count > 0 {
        let largest = significant(stamps.reversals.largest, 3);
        let _ = match stamps.reversals.count {
            1 => writeln!(out, "a time stamp{of} steps back by {largest} s"),
            count => writeln!(out, "{count} time stamps{of} step back, by up to {largest} s"),
        };
    }
}

/// Rounding, saturation and strays of a column, the same rows that [`Finding::RowsStray`](palpate::analysis::Finding) and repairs count.
fn value_facts(out: &mut String, name: &str, values: &Values, (scale, unit): (f64, &str)) {
    if let Some(step) = values.step {
        let _ = writeln!(out, "{name} in steps of {} {unit}", significant(scale * step, 3));
    }
    if let Some(saturation) = values.saturation.filter(|saturation| saturation.clipped) {
        let level = significant(scale * saturation.level, 4);
        let _ = writeln!(out, "{name} clipped at {level} {unit} in {} rows", saturation.rows);
    }
    if values.strays.count > 0 {
        let zeros = values.strays.zeros;
        let rows = counted(values.strays.count, "outlier");
        let _ = writeln!(out, "{rows} among the rows of the {name}, {zeros} of them zero");
    }
}
