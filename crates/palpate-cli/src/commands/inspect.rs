//! `palpate inspect`: what is in a record.

use std::fmt::Write as _;
use std::path::Path;

use palpate::analysis::corrected_record;
use palpate::record::{Record, Stamps, Values};
use palpate::segment::{SegmentOptions, find_contact_of, find_phases};
use palpate_files::record_file::{RecordFile, Role};
use palpate_files::text::{self, Layout, LayoutOptions};
use palpate_report::number::significant;
use palpate_report::table::{Cell, Table, TableColumn};

use super::record::{description, record};
use crate::arguments::InspectArguments;
use crate::failure::{Failure, Outcome};
use crate::terminal::print;

pub(crate) fn run(arguments: &InspectArguments) -> Result<Outcome, Failure> {
    let test = description(arguments.test.as_deref())?;
    let options = test.as_ref().map_or_else(LayoutOptions::default, |test| test.layout);
    let layout = text::detect(&arguments.record, &options).map_err(|error| {
        let hint = error.hint();
        Failure::new(error, hint)
    })?;
    let mut out = file_facts(&arguments.record, &layout);
    let file = match record(&arguments.record, test.as_ref()) {
        Ok(file) => file,
        Err(failure) => {
            // The columns help to mend what is wrong.
            out.push_str(&columns_table(&layout, None).to_plain_text());
            print(&out)?;
            return Err(failure);
        }
    };
    out.push_str(&columns_table(&layout, Some(&file)).to_plain_text());
    out.push('\n');
    out.push_str(&signal_facts(&file));
    let segment = test.as_ref().map_or_else(SegmentOptions::default, |test| test.segment);
    out.push_str(&phases(&file.record, &segment, test.as_ref()));
    print(&out)?;
    Ok(Outcome::Done)
}

fn file_facts(path: &Path, layout: &Layout) -> String {
    let mut out = format!(
        "{}\n{} encoding, fields separated by {}, decimal {}, data from line {}\n",
        path.display(),
        layout.encoding,
        layout.delimiter,
        layout.decimal,
        layout.first_data_line
    );
    for entry in &layout.metadata {
        let unit = entry.unit.as_deref().unwrap_or("");
        let _ = writeln!(out, "  {} = {} {unit}", entry.name, entry.value);
    }
    out.push('\n');
    out
}

fn columns_table(layout: &Layout, file: Option<&RecordFile>) -> Table {
    let mut table = Table::new("columns", "Columns")
        .column(TableColumn::new("Column", "number", ""))
        .column(TableColumn::new("Name", "name", ""))
        .column(TableColumn::new("Unit", "unit", ""))
        .column(TableColumn::new("First value", "sample", ""))
        .column(TableColumn::new("Used as", "used_as", ""));
    for column in &layout.columns {
        let used = file.and_then(|file| file.columns.iter().find(|used| used.number == column.number));
        let role = used.map_or(String::new(), |used| {
            let sign = if used.sign < 0.0 { ", sign turned" } else { "" };
            let what = match used.role {
                Role::Values(quantity) => quantity.to_string(),
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

fn signal_facts(file: &RecordFile) -> String {
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
    if let Some(displacement) = record.displacement() {
        let _ = writeln!(out, "displacement {} mm", range(displacement, 1e3));
    }
    let _ = writeln!(out, "force {} N", range(record.force(), 1.0));
    stamp_facts(&mut out, &file.signals.stamps, "");
    if let Some(stamps) = &file.signals.force_stamps {
        stamp_facts(&mut out, stamps, " of the force");
    }
    if let Some(displacement) = &file.signals.displacement {
        value_facts(&mut out, "displacement", displacement, (1e3, "mm"));
    }
    value_facts(&mut out, "force", &file.signals.force, (1.0, "N"));
    for done in record.corrections() {
        let _ = writeln!(out, "done: {done}");
    }
    if let Some(footer) = &file.ignored.footer {
        let _ =
            writeln!(out, "{} lines after the data were passed over, from line {}", footer.lines, footer.first_line);
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
        let _ = writeln!(
            out,
            "{count} gaps in the time stamps{of}, the longest {longest} s from {} s",
            significant(from, 5)
        );
    }
    if stamps.repeated > 0 {
        let _ = writeln!(out, "{} time stamps{of} repeat the one before", stamps.repeated);
    }
    if stamps.reversals.count > 0 {
        let largest = significant(stamps.reversals.largest, 3);
        let _ = writeln!(out, "{} time stamps{of} step back, by up to {largest} s", stamps.reversals.count);
    }
}

/// Rounding, saturation and strays of a column.
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
        let _ = writeln!(out, "{} rows of the {name} stray alone, {zeros} of them to zero", values.strays.count);
    }
}

fn phases(
    record: &Record,
    options: &SegmentOptions,
    test: Option<&palpate_files::description::TestDescription>,
) -> String {
    let asked = test.map(|test| test.corrections.clone()).unwrap_or_default();
    let before = record.corrections().len();
    let record = match corrected_record(record, options, &asked) {
        Ok(record) => record,
        Err(error) => return format!("Corrections: {error}\n"),
    };
    let segmentation = match find_phases(&record, options) {
        Ok(segmentation) => segmentation,
        Err(error) => return format!("Phases: {error}\n"),
    };
    let mut table = Table::new("phases", "Phases")
        .column(TableColumn::new("Phase", "phase", ""))
        .column(TableColumn::new("From", "start_s", "s"))
        .column(TableColumn::new("To", "end_s", "s"))
        .column(TableColumn::new("Samples", "samples", ""))
        .column(TableColumn::new("Displacement", "displacement_mm", "mm"))
        .column(TableColumn::new("Force at start", "force_start_n", "N"))
        .column(TableColumn::new("Force at end", "force_end_n", "N"));
    for segment in &segmentation.segments {
        let last = segment.end - 1;
        let end = record.displacement().map(|displacement| 1e3 * displacement[last]);
        table = table.row(vec![
            Cell::text(format!("{:?}", segment.phase).to_lowercase()),
            Cell::number(record.time()[segment.start], 6),
            Cell::number(record.time()[last], 6),
            Cell::Integer(segment.len() as i64),
            Cell::number_or(end, 4, "not recorded"),
            Cell::number(record.force()[segment.start], 4),
            Cell::number(record.force()[last], 4),
        ]);
    }
    let mut out = table.to_plain_text();
    if record.corrections().len() > before {
        out.push('\n');
    }
    for done in &record.corrections()[before..] {
        let _ = writeln!(out, "done: {done}");
    }
    let body = test.and_then(|test| test.geometry.as_ref()).map(|geometry| (&geometry.shape, geometry.sides));
    let choice = test.map(|test| test.touch).unwrap_or_default();
    let contact = find_contact_of(&record, &segmentation, body, choice);
    if contact.air_travel > 0.0 {
        let _ = writeln!(
            out,
            "\nfirst touch at {} mm, after {} mm through air; force zero {} N",
            significant(1e3 * contact.tare.displacement, 4),
            significant(1e3 * contact.air_travel, 3),
            significant(contact.tare.force, 3)
        );
    }
    if let Some(spread) = contact.spread {
        let rules = contact.estimates.iter();
        let rules = rules.map(|rule| format!("{} {} mm", rule.method.name(), significant(1e3 * rule.displacement, 4)));
        let _ = writeln!(
            out,
            "rules for first touch differ by {} mm: {}",
            significant(1e3 * spread, 2),
            rules.collect::<Vec<_>>().join(", ")
        );
    }
    out
}
