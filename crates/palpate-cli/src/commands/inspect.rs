//! `palpate inspect`: what is in a record.

use std::fmt::Write as _;
use std::path::Path;

use palpate::record::Record;
use palpate::segment::{SegmentOptions, find_contact_of, phases_with};
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
    if let Some(footer) = &file.ignored.footer {
        let _ =
            writeln!(out, "{} lines after the data were passed over, from line {}", footer.lines, footer.first_line);
    }
    out.push('\n');
    out
}

fn phases(
    record: &Record,
    options: &SegmentOptions,
    test: Option<&palpate_files::description::TestDescription>,
) -> String {
    let (record, dropouts) = record.repaired();
    let given = test.map_or_else(Default::default, |test| test.given_holds.as_slice());
    let segmentation = match phases_with(&record, options, given) {
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
    if dropouts > 0 {
        let _ = writeln!(out, "\n{dropouts} rows of the displacement stray alone (dropouts)");
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
    out
}
